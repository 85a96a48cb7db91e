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
use crate::world::grid::{Grid, GridMap};
use crate::world::pool::{Pool, PoolReader};
use crate::world::{Words, World};

/// Without a grid all words up to this length can be shown.
const LONGEST: usize = 1000;

/// What is asked about.
pub(super) struct Situation {
    pub(super) world: Arc<World>,
    pub(super) prior: Prior,
}

/// The situation that the arguments describe; none if they describe none.
pub(super) fn read(args: &Args, alphabet: &Alphabet) -> anyhow::Result<Option<Situation>> {
    let everywhere = args.grid.is_none() && args.pool.is_none();
    if everywhere && args.prior.is_empty() && args.suffices.is_empty() {
        return Ok(None);
    }
    let rules = |texts: &[String], option: &str| -> anyhow::Result<Vec<Dfa>> {
        let rule = |text: &String| {
            rule(text, alphabet).with_context(|| format!("`{option} {text}` is not usable"))
        };
        texts.iter().map(rule).collect()
    };
    let holding = rules(&args.prior, "--prior")?;
    let sufficing = rules(&args.suffices, "--suffices")?;
    let world = match (&args.grid, &args.pool) {
        (Some(path), _) => World::Grid(grid(path, alphabet, args)?),
        (None, Some(path)) => World::Pool(pool(path, alphabet)?),
        (None, None) => World::Words(Words::new(alphabet.clone(), LONGEST)),
    };
    Ok(Some(Situation {
        world: Arc::new(world),
        prior: Prior::new(alphabet, holding, sufficing)?,
    }))
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

fn grid(path: &Path, alphabet: &Alphabet, args: &Args) -> anyhow::Result<Grid> {
    let name = path.display();
    let text = std::fs::read_to_string(path)
        .with_context(|| format!("`--grid {name}` cannot be read as text"))?;
    let map = GridMap::new(alphabet, &text);
    map.grid(alphabet.clone(), args.labelling, args.steps.into())
        .with_context(|| format!("`--grid {name}` is no grid for this task"))
}

fn pool(path: &Path, alphabet: &Alphabet) -> anyhow::Result<Pool> {
    let name = path.display();
    let file = File::open(path).with_context(|| format!("`--pool {name}` cannot be read"))?;
    PoolReader::read(alphabet.clone(), file)
        .with_context(|| format!("`--pool {name}` is no pool for this task"))
}
