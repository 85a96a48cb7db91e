//! Does what a plan says: one scripted run after the other, on all cores.

use std::num::NonZeroUsize;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Duration;

use automata::{Dfa, Word};
use rand::SeedableRng;
use rand::seq::SliceRandom;
use rand_chacha::ChaCha8Rng;

use super::clock::thread_cpu;
use super::contender::Contender;
use super::experiment::Plan;
use super::subject::Subject;
use super::trial::{Report, TrialError, teach};
use crate::concept::{DfaClass, Point, PriorError};
use crate::identify::{EngineChoice, Settings};
use crate::learner::{Config, Counts, EQUIVALENCE_COST, Learner, Question};
use crate::oracle::{MonotoneTarget, ScriptedTeacher, SituatedTeacher, Target, TeacherSettings};
use crate::task::Situation;

/// One run.
#[derive(Clone, Debug)]
pub struct Run {
    /// The target's place in the plan.
    pub target: usize,
    /// The key of the contender or rival.
    pub contender: &'static str,
    /// The cost of a membership query; none where comparisons are never asked.
    pub cost: Option<u32>,
    /// The share of wrong answers, in percent.
    pub errors: u32,
    /// The seed of learner and teacher.
    pub seed: u64,
    /// Whether what was learned is the target.
    pub equivalent: bool,
    /// The questions asked.
    pub counts: Counts,
    /// The answers that were dropped.
    pub dropped: u32,
    /// The questions for which the budget ended.
    pub hurried: u32,
    /// CPU time of choosing each question; none for rivals.
    pub question_times: Vec<Duration>,
}

impl Run {
    /// The dissertation's cost (Eq. 5.2), where equivalence queries are free:
    /// `C·memberships + comparisons`.
    pub fn paid(&self) -> f64 {
        self.weight() * f64::from(self.counts.membership) + f64::from(self.counts.comparison)
    }

    /// The all-in cost: the same and `4C` for every equivalence query.
    pub fn all_in(&self) -> f64 {
        self.paid() + EQUIVALENCE_COST * self.weight() * f64::from(self.counts.equivalence)
    }

    /// All questions.
    pub fn questions(&self) -> f64 {
        let Counts {
            membership,
            comparison,
            equivalence,
            conformance,
        } = self.counts;
        f64::from(membership + comparison + equivalence + conformance)
    }

    fn weight(&self) -> f64 {
        self.cost.map_or(1.0, f64::from)
    }
}

/// A run that could not go on.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("target {target}, {contender}, seed {seed}: {source}")]
pub struct RunError {
    target: String,
    contender: &'static str,
    seed: u64,
    source: Box<Fault>,
}

/// Why it could not.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
enum Fault {
    #[error("{0}")]
    Trial(#[from] TrialError),
    #[error("{0}")]
    Prior(#[from] PriorError),
    #[error("question {number} is about a behaviour that is settled or cannot happen")]
    Settled { number: u32 },
}

/// More questions than any run should need.
const MAX_QUESTIONS: u32 = 500;

/// The largest automata considered. Wrong answers look like further states, so
/// where there are some, a bound not far above the targets' sizes finds them out.
const MAX_STATES: usize = 64;
const MAX_STATES_NOISY: usize = 8;

/// The order of the work, which decides nothing but how well it spreads.
const SHUFFLE: u64 = 0;

struct Job {
    target: usize,
    contender: &'static Contender,
    cost: Option<u32>,
    errors: u32,
    seed: u64,
}

fn jobs(plan: &Plan) -> Vec<Job> {
    let mut jobs = Vec::new();
    for target in 0..plan.targets.len() {
        for &cost in &plan.costs {
            for &errors in &plan.errors {
                for &contender in &plan.contenders {
                    jobs.extend(plan.seeds().map(|seed| Job {
                        target,
                        contender,
                        cost,
                        errors,
                        seed,
                    }));
                }
            }
        }
    }
    jobs
}

/// How many runs the plan has.
pub fn size(plan: &Plan) -> u64 {
    jobs(plan).len() as u64
}

/// Runs everything, on so many threads; `done` hears of every run, in any order. The
/// runs come back in the order of the plan.
///
/// # Errors
///
/// If a run cannot go on.
pub fn run(
    plan: &Plan,
    threads: NonZeroUsize,
    done: impl Fn(&Run) + Sync,
) -> Result<Vec<Run>, RunError> {
    let mut jobs: Vec<(usize, Job)> = jobs(plan).into_iter().enumerate().collect();
    // Neighbours are alike: mixed, every core has its share of the long ones
    // and the estimate of the time left is soon right.
    jobs.shuffle(&mut ChaCha8Rng::seed_from_u64(SHUFFLE));
    let next = AtomicUsize::new(0);
    let work = || {
        let mut runs = Vec::new();
        while let Some((place, job)) = jobs.get(next.fetch_add(1, Ordering::Relaxed)) {
            let run = one(plan, job).inspect_err(|_| {
                // What the others have begun they finish, and no more.
                next.store(jobs.len(), Ordering::Relaxed);
            })?;
            done(&run);
            runs.push((*place, run));
        }
        Ok(runs)
    };
    let parts: Vec<Result<Vec<(usize, Run)>, RunError>> = std::thread::scope(|scope| {
        let threads: Vec<_> = (0..threads.get()).map(|_| scope.spawn(work)).collect();
        let ends = threads.into_iter().map(std::thread::ScopedJoinHandle::join);
        ends.map(|end| end.unwrap_or_else(|panic| std::panic::resume_unwind(panic)))
            .collect()
    });
    let parts: Vec<Vec<(usize, Run)>> = parts.into_iter().collect::<Result<_, _>>()?;
    let mut runs: Vec<(usize, Run)> = parts.into_iter().flatten().collect();
    runs.sort_by_key(|&(place, _)| place);
    Ok(runs.into_iter().map(|(_, run)| run).collect())
}

fn one(plan: &Plan, job: &Job) -> Result<Run, RunError> {
    let noisy = plan.errors.iter().any(|&errors| errors > 0);
    let settings = Settings {
        engine: EngineChoice::Auto,
        max_states: if noisy { MAX_STATES_NOISY } else { MAX_STATES },
    };
    let config = job.contender.config(job.cost, job.seed);
    let teacher = TeacherSettings {
        order: plan.order,
        counterexamples: plan.counterexamples,
        error_rate: f64::from(job.errors) / 100.0,
        seed: job.seed,
    };
    let subject = &plan.targets[job.target];
    let run = match subject {
        Subject::Language(case) => {
            let report = match case.situation() {
                None => alone(case.target(), config, settings, teacher),
                Some(situation) => situated(case.target(), situation, config, settings, teacher),
            };
            report.map(|report| done(job, report))
        }
        Subject::Monotone(target) => {
            let report = monotone(target, config, teacher);
            report.map(|report| done(job, report))
        }
    };
    run.map_err(|source| RunError {
        target: subject.name().to_owned(),
        contender: job.contender.key,
        seed: job.seed,
        source: Box::new(source),
    })
}

/// The run that came to this.
fn done<C>(job: &Job, (report, equivalent): (Report<C>, bool)) -> Run {
    Run {
        target: job.target,
        contender: job.contender.key,
        cost: job.cost,
        errors: job.errors,
        seed: job.seed,
        equivalent,
        counts: report.counts,
        dropped: report.dropped,
        hurried: report.hurried,
        question_times: report.question_times,
    }
}

/// A run about a monotone predicate, and whether it ended with the same.
fn monotone(
    target: &MonotoneTarget,
    config: Config,
    teacher: TeacherSettings,
) -> Result<(Report<Point>, bool), Fault> {
    let mut learner = Learner::new(target.class(), config, Vec::new());
    let report = teach(
        &mut learner,
        &mut target.teacher(teacher),
        MAX_QUESTIONS,
        thread_cpu,
        |_| {},
    )?;
    let equivalent = report.learned.as_ref() == Some(target.parameter());
    Ok((report, equivalent))
}

/// A run in which all words can be shown, and whether it ended equivalent.
fn alone(
    target: &Target,
    config: Config,
    settings: Settings,
    teacher: TeacherSettings,
) -> Result<(Report<Dfa>, bool), Fault> {
    let class = DfaClass::new(target.dfa().alphabet().clone(), settings);
    let mut learner = Learner::new(class, config, target.known().to_vec());
    let mut teacher = ScriptedTeacher::new(target, teacher);
    let report = teach(
        &mut learner,
        &mut teacher,
        MAX_QUESTIONS,
        thread_cpu,
        |_| {},
    )?;
    let learned = report.learned.as_ref();
    let equivalent = learned.is_some_and(|dfa| dfa.is_equivalent(target.dfa()) == Ok(true));
    Ok((report, equivalent))
}

/// A run in a situation, and whether what it learned agrees with the target there.
/// That no question is settled or impossible is checked.
fn situated(
    target: &Target,
    situation: &Situation,
    config: Config,
    settings: Settings,
    teacher: TeacherSettings,
) -> Result<(Report<Dfa>, bool), Fault> {
    let class = situation.class(settings)?;
    let known = class.examples(target.known())?;
    let mut learner = Learner::new(class, config, known);
    let open = situation.prior.open().clone();
    let mut teacher = SituatedTeacher::new(Arc::clone(&situation.world), open, target, teacher);
    let mut settled = None;
    let report = teach(
        &mut learner,
        &mut teacher,
        MAX_QUESTIONS,
        thread_cpu,
        |asked| {
            let words = match asked.question {
                Question::Membership { atom } => vec![atom],
                Question::Comparison { first, second } => vec![first, second],
                Question::Equivalence { .. } => Vec::new(),
            };
            let is_open = |word: &&Word| {
                situation.prior.settled(word).is_none() && situation.world.is_feasible(word)
            };
            if !words.iter().all(is_open) {
                settled.get_or_insert(asked.number);
            }
        },
    )?;
    if let Some(number) = settled {
        return Err(Fault::Settled { number });
    }
    let learned = report.learned.as_ref();
    let equivalent = learned.is_some_and(|part| agrees(situation, part, target.dfa()));
    Ok((report, equivalent))
}

/// Whether nothing that is open and can happen tells what was learned from the
/// target.
fn agrees(situation: &Situation, learned: &Dfa, target: &Dfa) -> bool {
    let differ = situation.prior.whole(learned).xor(target);
    let open = differ.and_then(|differ| differ.and(situation.prior.open()));
    open.is_ok_and(|open| !situation.world.has_word(&open))
}
