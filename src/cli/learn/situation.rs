//! `--prior`, `--suffices`, `--grid` and `--pool`: what is known beforehand, and where
//! behaviours come from.

use std::fs::File;
use std::path::Path;
use std::sync::Arc;

use anyhow::Context as _;
use automata::{Alphabet, Dfa};

use super::Args;
use crate::cli::files;
use crate::concept::{Prior, Template, TemplateError};
use crate::task::{LONGEST, STEPS, Situation, TaskFile, WorldText};
use crate::world::grid::{Grid, GridMap};
use crate::world::pool::{Pool, PoolReader};
use crate::world::{Words, World};

/// The situation that the arguments and the task file describe; none if they
/// describe none.
pub(super) fn read(
    args: &Args,
    alphabet: &Alphabet,
    file: Option<&TaskFile>,
) -> anyhow::Result<Option<Situation>> {
    let told = told(args, file)?;
    let everywhere = args.grid.is_none() && args.pool.is_none();
    if everywhere && args.prior.is_empty() && args.suffices.is_empty() {
        return Ok(told);
    }
    let rules = |texts: &[String], option: &str| -> anyhow::Result<Vec<Dfa>> {
        let rule = |text: &String| {
            rule(text, alphabet).with_context(|| format!("`{option} {text}` is not usable"))
        };
        texts.iter().map(rule).collect()
    };
    let mut holding = rules(&args.prior, "--prior")?;
    let mut sufficing = rules(&args.suffices, "--suffices")?;
    if let Some(told) = &told {
        if args.prior.is_empty() {
            holding = told.prior.holding().to_vec();
        }
        if args.suffices.is_empty() {
            sufficing = told.prior.sufficing().to_vec();
        }
    }
    let world = match (&args.grid, &args.pool, told) {
        (Some(path), ..) => Arc::new(World::Grid(grid(path, alphabet, args, file)?)),
        (None, Some(path), _) => Arc::new(World::Pool(pool(path, alphabet)?)),
        (None, None, Some(told)) => told.world,
        (None, None, None) => Arc::new(World::Words(Words::new(alphabet.clone(), LONGEST))),
    };
    Ok(Some(Situation {
        world,
        prior: Prior::new(alphabet, holding, sufficing)?,
    }))
}

/// What the file tells, with the arguments that override a part of its grid.
fn told(args: &Args, file: Option<&TaskFile>) -> anyhow::Result<Option<Situation>> {
    if args.grid.is_some() || (args.steps.is_none() && args.labelling.is_none()) {
        return Ok(file.and_then(|file| file.universe.situation().cloned()));
    }
    let mut task = file.map(|file| file.task.clone());
    let world = task.as_mut().and_then(|task| task.world.as_mut());
    let Some(WorldText::Grid {
        steps, labelling, ..
    }) = world
    else {
        anyhow::bail!("`--steps` and `--labelling` are about a grid: add `--grid FILE`");
    };
    *steps = args.steps.map_or(*steps, usize::from);
    *labelling = args.labelling.unwrap_or(*labelling);
    let situation = task.map(|task| task.situation()).transpose();
    Ok(situation
        .context("the grid of the task does not allow this")?
        .flatten())
}

/// A rule by name, or else the automaton of a file.
fn rule(text: &str, alphabet: &Alphabet) -> anyhow::Result<Dfa> {
    match Template::parse(text, alphabet) {
        Ok(template) => Ok(template.dfa(alphabet)),
        Err(error @ TemplateError::Form(_)) => {
            let path = Path::new(text);
            // A file that is not there was more likely meant as a rule.
            if path.extension().is_none() && !path.exists() {
                return Err(error.into());
            }
            Ok(files::read_automaton(path, None)?.dfa)
        }
        Err(error) => Err(error.into()),
    }
}

fn grid(
    path: &Path,
    alphabet: &Alphabet,
    args: &Args,
    file: Option<&TaskFile>,
) -> anyhow::Result<Grid> {
    let name = path.display();
    let text = std::fs::read_to_string(path)
        .with_context(|| format!("`--grid {name}` cannot be read as text"))?;
    let mut map = GridMap::new(alphabet, &text);
    if let Some(file) = file {
        map.marks = file.task.marks().collect();
    }
    let labelling = args.labelling.unwrap_or_default();
    let steps = args.steps.map_or(STEPS, usize::from);
    map.grid(alphabet.clone(), labelling, steps)
        .with_context(|| format!("`--grid {name}` is no grid for this task"))
}

fn pool(path: &Path, alphabet: &Alphabet) -> anyhow::Result<Pool> {
    let name = path.display();
    let file = File::open(path).with_context(|| format!("`--pool {name}` cannot be read"))?;
    PoolReader::read(alphabet.clone(), file)
        .with_context(|| format!("`--pool {name}` is no pool for this task"))
}
