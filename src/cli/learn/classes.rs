//! Targets that are no automata: monotone predicates, tables of concepts, and
//! thresholded linear rewards.

use std::path::Path;
use std::process::ExitCode;

use anyhow::{Context as _, anyhow, bail};
use automata::format::json::Provenance;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use serde::{Deserialize, Serialize};

use super::converse::converse;
use super::teller::{Points, Teller};
use super::{Args, check_options, config, status, summary, teacher};
use crate::cli::files;
use crate::concept::{ConceptClass, FiniteConcept, FiniteTable, LinearReward, MOST_POINTS};
use crate::evidence::Fact;
use crate::learner::{Learner, Strategy};
use crate::oracle::{ClassGoal, MonotoneTarget, ScriptedTeacher};
use crate::task::{BehaviourText, Concept, Rewards, Saved, Task, TaskFile, Universe};

/// The points per axis up to which rewards are looked for, where a file does not
/// say.
const FINEST: usize = 9;

/// Runs the command for such a target; none if the target is none of these.
pub(super) fn run(args: &Args, file: Option<&TaskFile>) -> anyhow::Result<Option<ExitCode>> {
    if let Some(file) = file.filter(|file| file.task.class.is_some()) {
        refuse_words(args)?;
        check_options(args, strategy(args, Some(&file.task)))?;
        return taught(args, file).map(Some);
    }
    let name = args.target.as_str();
    let kinds = ["monotone:", "finite:", "linear:"];
    if kinds.iter().all(|kind| !name.starts_with(kind)) {
        return Ok(None);
    }
    refuse_words(args)?;
    check_options(args, strategy(args, None))?;
    let goal = Goal {
        args,
        task: None,
        format: "memrep-monotone",
    };
    if let Some(target) = MonotoneTarget::named(name, args.seed)? {
        let concept = target.parameter().clone();
        return goal
            .learn(|| target.class(), Vec::new(), concept, &Points)
            .map(Some);
    }
    if let Some(rest) = name.strip_prefix("finite:") {
        let (table, concept) = table(rest, args.seed)?;
        let goal = Goal {
            format: "memrep-finite",
            ..goal
        };
        return goal
            .learn(|| table.class().clone(), Vec::new(), concept, &table)
            .map(Some);
    }
    let path = name.strip_prefix("linear:").unwrap_or(name);
    let (rewards, reward) = rewards(path)?;
    let parameter = rewards.simplest_like(&reward);
    let parameter = parameter.map_err(|message| anyhow!("{path}: {message}"))?;
    let goal = Goal {
        format: "memrep-linear",
        ..goal
    };
    goal.learn(|| rewards.class(), Vec::new(), parameter, &rewards)
        .map(Some)
}

/// Teaches the target of a task that learns no automaton.
fn taught(args: &Args, file: &TaskFile) -> anyhow::Result<ExitCode> {
    let TaskFile { task, universe, .. } = file;
    let goal = |format| Goal {
        args,
        task: Some(task),
        format,
    };
    match (universe, file.target.clone()) {
        (Universe::Monotone(axes), Some(Concept::Parameter(most))) => {
            goal("memrep-monotone").learn(|| axes.class(), task.known(universe), most, axes)
        }
        (Universe::Finite(table), Some(Concept::Named(concept))) => {
            let class = || table.class().clone();
            goal("memrep-finite").learn(class, task.known(universe), concept, table)
        }
        (Universe::Linear(rewards), Some(Concept::Parameter(parameter))) => goal("memrep-linear")
            .learn(|| rewards.class(), task.known(universe), parameter, rewards),
        _ => bail!(
            "{} has no target for a scripted teacher: add `target`, what is to be learned",
            args.target
        ),
    }
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

/// What is taught, and how it is written down.
#[derive(Clone, Copy)]
struct Goal<'a> {
    args: &'a Args,
    task: Option<&'a Task>,
    format: &'a str,
}

impl Goal<'_> {
    /// Teaches a concept of a class to a learner that knows these facts.
    fn learn<C, L>(
        &self,
        class: impl Fn() -> C,
        known: Vec<Fact<C::Atom>>,
        concept: C::Concept,
        teller: &L,
    ) -> anyhow::Result<ExitCode>
    where
        C: ConceptClass,
        L: Teller<Atom = C::Atom, Concept = C::Concept>,
    {
        let args = self.args;
        let strategy = strategy(args, self.task);
        let told = self.task.map(|task| task.costs).unwrap_or_default();
        let mut learner = Learner::new(class(), config(args, strategy, told), known);
        let goal = ClassGoal::new(class(), concept, args.teacher, args.seed);
        let mut teacher = ScriptedTeacher::of(goal, teacher(args));
        let report = converse(args, &mut learner, &mut teacher, teller)?;
        if let (Some(path), Some(learned)) = (&args.save, &report.learned) {
            save(path, self.format, args, teller.concept_line(learned))?;
        }
        let doubts = learner.doubts();
        summary::tell(args, strategy, &args.target, teller, &report, doubts, None)?;
        Ok(status(&report))
    }
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

/// The strategy that was asked for, or the task's, or the usual one.
fn strategy(args: &Args, task: Option<&Task>) -> Strategy {
    let told = args.strategy.or(task.and_then(|task| task.strategy));
    told.unwrap_or(Strategy::Bayes)
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
    behaviours: Vec<BehaviourText>,
}

fn rewards(path: &str) -> anyhow::Result<(Rewards, LinearReward)> {
    let text = files::text(Path::new(path))?;
    let file: RewardFile = serde_json::from_str(&text).with_context(|| path.to_owned())?;
    let reward = LinearReward {
        weights: file.weights,
        threshold: file.threshold,
    };
    let Some(&most) = MOST_POINTS
        .get(reward.weights.len())
        .filter(|_| !reward.weights.is_empty())
    else {
        bail!(
            "{path}: there are {} features: give 1 to {}, which make families of up to four dimensions",
            reward.weights.len(),
            MOST_POINTS.len() - 1
        );
    };
    let finest = file.finest.unwrap_or(FINEST);
    if !(2..=most).contains(&finest) {
        bail!("{path}: `finest` is {finest}: give a number of points per axis from 2 to {most}");
    }
    let features = (1..=reward.weights.len()).map(|place| place.to_string());
    let rewards = Rewards::new(features.collect(), file.behaviours, finest);
    Ok((rewards.with_context(|| path.to_owned())?, reward))
}
