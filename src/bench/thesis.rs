//! The experiment of chapter 5's Tables 5.1 to 5.5: every target, at every
//! ratio of costs, over many seeds.

use std::time::Duration;

use super::clock::process_cpu;
use super::trial::{TrialError, teach};
use crate::concept::DfaClass;
use crate::identify::{EngineChoice, Settings};
use crate::learner::{Config, Counts, Learner, Strategy};
use crate::oracle::{
    Counterexamples, Order, ScriptedTeacher, Target, TargetError, TeacherSettings,
};

/// The targets, in the order of the dissertation's tables.
pub const TARGETS: [&str; 14] = [
    "tomita:1",
    "tomita:2",
    "tomita:3",
    "tomita:4",
    "tomita:5",
    "tomita:6",
    "tomita:7",
    "zeros:1",
    "zeros:2",
    "zeros:3",
    "zeros:4",
    "modulo:5",
    "modulo:10",
    "robot",
];

/// The costs of a membership query where a comparison costs 1; none: comparisons
/// are never asked.
pub const COSTS: [Option<u32>; 5] = [Some(1), Some(2), Some(4), Some(8), None];

/// The work that one question may do, and the largest automaton considered.
const BUDGET: u64 = 2_000_000;
const MAX_STATES: usize = 64;

/// More questions than any run should need.
const MAX_QUESTIONS: u32 = 1000;

/// One run of the experiment.
#[derive(Clone, Debug)]
pub struct Run {
    /// The target's name.
    pub target: &'static str,
    /// The cost of a membership query; none where comparisons are never asked.
    pub cost: Option<u32>,
    /// The seed of learner and teacher.
    pub seed: u64,
    /// Whether what was learned is the target.
    pub equivalent: bool,
    /// The questions asked.
    pub counts: Counts,
    /// Questions for which the budget ended.
    pub hurried: u32,
    /// CPU time of choosing each question.
    pub question_times: Vec<Duration>,
}

/// Why the experiment stopped.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ThesisError {
    /// A target's name was not understood.
    #[error(transparent)]
    Target(#[from] TargetError),
    /// A run could not go on.
    #[error("target {target}, seed {seed}: {source}")]
    Trial {
        /// The target's name.
        target: &'static str,
        /// The seed of the run.
        seed: u64,
        /// What went wrong.
        source: TrialError,
    },
}

/// How the dissertation's teacher of a target answers: the robot's has a random
/// order and gives random counterexamples, the others' order is described and
/// their counterexamples, as in the authors' tests, are shortest.
pub fn teacher_of(target: &str, seed: u64) -> TeacherSettings {
    let (order, counterexamples) = if target == "robot" {
        (Order::Random, Counterexamples::Random)
    } else {
        (Order::Ordered, Counterexamples::Shortest)
    };
    TeacherSettings {
        order,
        counterexamples,
        error_rate: 0.0,
        seed,
    }
}

/// Runs everything with the seeds 0 to `trials - 1`, one run after the other, so
/// that the process's CPU time is that of the run. `done` hears of every run.
///
/// # Errors
///
/// If a run cannot be set up.
pub fn run(trials: u64, mut done: impl FnMut(&Run)) -> Result<Vec<Run>, ThesisError> {
    let mut runs = Vec::new();
    for name in TARGETS {
        let target = Target::named(name)?;
        for cost in COSTS {
            for seed in 0..trials {
                let source = |source| ThesisError::Trial {
                    target: name,
                    seed,
                    source,
                };
                let run = one(name, &target, cost, seed).map_err(source)?;
                done(&run);
                runs.push(run);
            }
        }
    }
    Ok(runs)
}

fn one(
    name: &'static str,
    target: &Target,
    cost: Option<u32>,
    seed: u64,
) -> Result<Run, TrialError> {
    let settings = Settings {
        engine: EngineChoice::Auto,
        max_states: MAX_STATES,
    };
    let class = DfaClass::new(target.dfa().alphabet().clone(), settings);
    let config = Config {
        strategy: cost.map_or(Strategy::Membership, |_| Strategy::Thesis),
        membership_cost: cost.map_or(1.0, f64::from),
        comparison_cost: 1.0,
        seed,
        budget: BUDGET,
        ..Config::default()
    };
    let mut learner = Learner::new(class, config, target.known().to_vec());
    let mut teacher = ScriptedTeacher::new(target, teacher_of(name, seed));
    let report = teach(
        &mut learner,
        &mut teacher,
        MAX_QUESTIONS,
        process_cpu,
        |_| {},
    )?;
    let equivalent = report
        .learned
        .is_some_and(|learned| learned.is_equivalent(target.dfa()) == Ok(true));
    Ok(Run {
        target: name,
        cost,
        seed,
        equivalent,
        counts: report.counts,
        hurried: report.hurried,
        question_times: report.question_times,
    })
}
