//! Targets that are no automata: monotone predicates, tables of concepts, and
//! thresholded linear rewards.

use std::path::Path;
use std::process::ExitCode;

use anyhow::{Context as _, bail};
use automata::format::json::Provenance;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use serde::{Deserialize, Serialize};

use super::converse::converse;
use super::teller::{Points, Rewards, Teller};
use super::{Args, check_options, config, status, summary, teacher};
use crate::cli::files;
use crate::concept::{
    ConceptClass, Failure, FiniteConcept, FiniteTable, LinearReward, LinearRewards, MonotoneClass,
};
use crate::evidence::{Budget, Fact};
use crate::learner::{Learner, Strategy};
use crate::oracle::{ClassGoal, MonotoneTarget, ScriptedTeacher};
use crate::task::Costs;

/// The points per axis up to which rewards are looked for, where a file does not
/// say.
const FINEST: usize = 9;
/// The most that a file may say, by the number of features less one.
const MOST: [usize; 3] = [200, 40, 16];

/// Runs the command for such a target; none if the target is none of these.
pub(super) fn run(args: &Args) -> anyhow::Result<Option<ExitCode>> {
    let name = args.target.as_str();
    let kinds = ["monotone:", "finite:", "linear:"];
    if kinds.iter().all(|kind| !name.starts_with(kind)) {
        return Ok(None);
    }
    refuse_words(args)?;
    check_options(args, strategy(args))?;
    if let Some(target) = MonotoneTarget::named(name, args.seed)? {
        let class = || target.class();
        let parameter = target.parameter().clone();
        return learn(args, "memrep-monotone", class, parameter, &Points).map(Some);
    }
    if let Some(rest) = name.strip_prefix("finite:") {
        let (table, concept) = table(rest, args.seed)?;
        let class = || table.class().clone();
        return learn(args, "memrep-finite", class, concept, &table).map(Some);
    }
    let path = name.strip_prefix("linear:").unwrap_or(name);
    let (rewards, finest, reward) = rewards(path)?;
    let class = || MonotoneClass::new(rewards.family.clone(), finest);
    let mut known = class();
    for atom in rewards.family.behaviours() {
        let accepted = rewards.family.accepts(&reward, atom)?;
        known.add(None, Fact::Label { atom, accepted });
    }
    // The simplest parameter that accepts the same.
    let parameter = match known.sample(1, 0, &mut Budget::unlimited()) {
        Ok(sample) => sample.concepts.into_iter().next(),
        Err(Failure::Contradiction(_) | Failure::OverBudget { .. }) => None,
    };
    let Some(parameter) = parameter else {
        bail!(
            "{path}: no reward on a grid with up to {finest} points per axis accepts the same behaviours as this one: raise `finest`"
        );
    };
    learn(args, "memrep-linear", class, parameter, &rewards).map(Some)
}

/// Refuses options that are about words.
fn refuse_words(args: &Args) -> anyhow::Result<()> {
    let options = [
        ("--prior", !args.prior.is_empty()),
        ("--suffices", !args.suffices.is_empty()),
        ("--grid", args.grid.is_some()),
        ("--pool", args.pool.is_some()),
        ("--max-states", args.max_states.is_some()),
        ("--no-empty-word", args.no_empty_word),
        ("--save-part", args.save_part.is_some()),
    ];
    match options.iter().find(|(_, given)| *given) {
        Some((option, _)) => bail!(
            "`{option}` is about words and automata, and `{}` has none: leave it out",
            args.target
        ),
        None => Ok(()),
    }
}

/// Teaches a concept of a class.
fn learn<C, L>(
    args: &Args,
    format: &str,
    class: impl Fn() -> C,
    concept: C::Concept,
    teller: &L,
) -> anyhow::Result<ExitCode>
where
    C: ConceptClass,
    L: Teller<Atom = C::Atom, Concept = C::Concept>,
{
    let mut learner = Learner::new(
        class(),
        config(args, strategy(args), Costs::default()),
        Vec::new(),
    );
    let goal = ClassGoal::new(class(), concept, args.teacher, args.seed);
    let mut teacher = ScriptedTeacher::of(goal, teacher(args));
    let report = converse(args, &mut learner, &mut teacher, teller)?;
    if let (Some(path), Some(learned)) = (&args.save, &report.learned) {
        save(path, format, args, teller.concept_line(learned))?;
    }
    let doubts = learner.doubts();
    summary::tell(
        args,
        strategy(args),
        &args.target,
        teller,
        &report,
        doubts,
        None,
    )?;
    Ok(status(&report))
}

/// A learned concept as a file.
#[derive(Serialize)]
struct Saved<'a, C> {
    format: &'a str,
    version: u32,
    name: &'a str,
    concept: C,
    provenance: Provenance,
}

fn save(path: &Path, format: &str, args: &Args, concept: impl Serialize) -> anyhow::Result<()> {
    let extension = path.extension().and_then(|extension| extension.to_str());
    if extension.is_some_and(|extension| !extension.eq_ignore_ascii_case("json")) {
        bail!(
            "{}: what was learned here is written as JSON only: give `--save` a name that ends in .json",
            path.display()
        );
    }
    let saved = Saved {
        format,
        version: 1,
        name: &args.target,
        concept,
        provenance: Provenance {
            version: Some(env!("CARGO_PKG_VERSION").to_owned()),
            seed: Some(args.seed),
            digest: None,
        },
    };
    let text = format!("{}\n", serde_json::to_string(&saved)?);
    files::write(path, &text).context("the learned concept was not saved")
}

/// The strategy that was asked for, or the usual one: no file tells another.
fn strategy(args: &Args) -> Strategy {
    args.strategy.unwrap_or(Strategy::Bayes)
}

/// The table of a file, and the concept of it that is named after a `#` or drawn.
fn table(target: &str, seed: u64) -> anyhow::Result<(FiniteTable, FiniteConcept)> {
    let (path, name) = match target.rsplit_once('#') {
        // A file of that very name comes first.
        Some((path, name)) if !Path::new(target).exists() => (path, Some(name)),
        _ => (target, None),
    };
    let text = files::text(Path::new(path))?;
    let table = FiniteTable::read(&text).with_context(|| path.to_owned())?;
    let mut concepts: Vec<FiniteConcept> = table.class().concepts().collect();
    let concept = if let Some(name) = name {
        table.named(name).with_context(|| {
            let names: Vec<&str> = concepts.iter().map(|&c| table.concept(c)).collect();
            format!(
                "{path} has no concept `{name}`: give one of {}",
                names.join(", ")
            )
        })?
    } else {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        concepts.swap_remove(random.random_range(0..concepts.len()))
    };
    Ok((table, concept))
}

/// A file of behaviours and a reward.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RewardFile {
    weights: Vec<f64>,
    threshold: f64,
    #[serde(default)]
    finest: Option<usize>,
    behaviours: Vec<Named>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Named {
    name: String,
    features: Vec<Vec<f64>>,
}

fn rewards(path: &str) -> anyhow::Result<(Rewards, usize, LinearReward)> {
    let text = files::text(Path::new(path))?;
    let file: RewardFile = serde_json::from_str(&text).with_context(|| path.to_owned())?;
    let (names, features): (Vec<String>, Vec<Vec<Vec<f64>>>) = (file.behaviours.into_iter())
        .map(|behaviour| (behaviour.name, behaviour.features))
        .unzip();
    let family = LinearRewards::new(&features).with_context(|| path.to_owned())?;
    let reward = LinearReward {
        weights: file.weights,
        threshold: file.threshold,
    };
    family.parameter(&reward).with_context(|| path.to_owned())?;
    let Some(&most) = MOST.get(reward.weights.len() - 1) else {
        bail!(
            "{path}: there are {} features: give 1 to {}, which make families of up to four dimensions",
            reward.weights.len(),
            MOST.len()
        );
    };
    let finest = file.finest.unwrap_or(FINEST);
    if !(2..=most).contains(&finest) {
        bail!("{path}: `finest` is {finest}: give a number of points per axis from 2 to {most}");
    }
    Ok((Rewards { family, names }, finest, reward))
}
