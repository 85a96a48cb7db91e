//! `memrep learn`: teaches a target by a scripted teacher, and tells what it
//! took.

mod check;
mod doubts;
mod trace;

use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Duration;

use anyhow::Context as _;
use automata::Dfa;
use automata::format::json::{Document, Provenance};
use clap::ValueEnum;
use indicatif::ProgressBar;
use serde::Serialize;

use super::files::{self, Content, Format};
use super::output::{self, Output};
use crate::bench::{Report, percentile, process_cpu, teach};
use crate::concept::DfaClass;
use crate::identify::{EngineChoice, Settings};
use crate::learner::{Config, Conformance, Doubts, EQUIVALENCE_COST, Learner, Progress, Strategy};
use crate::oracle::{
    Counterexamples, Order, ScriptedTeacher, Target, TargetError, TeacherSettings,
};

/// The work that one question may do: a few seconds of search.
const BUDGET: u64 = 2_000_000;

/// Arguments of `memrep learn`.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:
  memrep learn --target tomita:4
  memrep learn --target robot --teacher random --counterexample random --trace
  memrep learn --target tomita:7 --error-rate 0.1 --strategy bayes --robust
  memrep learn --target task.json --membership-cost 8 --save learned.json
  memrep learn --target tomita:5 --comparison-cost inf --format json
    {\"target\":\"tomita:5\",\"strategy\":\"bayes\",\"seed\":0,\"equivalent\":true,\"states\":4,…}

Targets: tomita:1 to tomita:7 (Tomita's languages over 0 and 1), tomita:3t (the
third in the dissertation's three-state form), zeros:N (no run of more than N
zeros), modulo:K (words over `a` whose length is divisible by K), robot (Fig. 5.2
of the dissertation), random:N and task:N (drawn at random, as in `memrep bench
random` and `tasks`), or the path of an automaton file (json or dot).

With --conformance, what the teacher agreed with is believed only after random
words were judged: the line `checked` says how far one may trust it. Of a teacher that
errs a wrong judgement may refute what was right; it is found out
and dropped like any other, and the check goes on where it was.

Exit status: 0 if the target was learned, 1 if the questions ran out first (also
in the check), 2 if the arguments or a file are at fault.")]
pub(crate) struct Args {
    /// What to learn: a name from the list below, or an automaton file.
    #[arg(long, value_name = "T")]
    target: String,
    /// The cost of a membership query, positive.
    #[arg(long, value_name = "A", default_value = "4", allow_negative_numbers = true, value_parser = finite_cost)]
    membership_cost: f64,
    /// The cost of a comparison, positive; `inf`: never ask one.
    #[arg(long, value_name = "B", default_value = "1", allow_negative_numbers = true, value_parser = cost)]
    comparison_cost: f64,
    /// The cost of an equivalence query, 0 or more; four times a membership query
    /// if not given. Strategies bayes and exp4+ show an automaton when that is worth it.
    #[arg(long, value_name = "E", allow_negative_numbers = true, value_parser = cost_or_nothing)]
    equivalence_cost: Option<f64>,
    /// How questions are chosen.
    #[arg(long, value_name = "S", default_value = "bayes")]
    strategy: Strategy,
    /// The preference order of the teacher.
    #[arg(long, value_name = "ORDER", default_value = "ordered")]
    teacher: Order,
    /// How the teacher refutes a wrong hypothesis.
    #[arg(long, value_name = "KIND", default_value = "shortest")]
    counterexample: Counterexamples,
    /// The share of membership answers and comparisons that are wrong.
    #[arg(long, value_name = "RATE", default_value = "0", allow_negative_numbers = true, value_parser = rate)]
    error_rate: f64,
    /// Take answers for evidence and not for facts: any may be wrong, how many
    /// are is learned on the way, and what seems wrong is asked in other words.
    /// Counterexamples count as true. Needs `--strategy bayes`.
    #[arg(long)]
    robust: bool,
    /// What the teacher promises: `shortest`, that no counterexample could be
    /// shorter. Needs `--counterexample shortest`.
    #[arg(long, value_name = "WHAT")]
    promise: Option<Promise>,
    /// After the teacher has agreed, have random words judged until what was
    /// learned is wrong about at most a share EPS of them, with confidence
    /// 1 - DELTA; as in `0.05,0.05`.
    #[arg(long, value_name = "EPS,DELTA", allow_hyphen_values = true, value_parser = check::read)]
    conformance: Option<Conformance>,
    /// Decides every random choice of learner and teacher.
    #[arg(long, value_name = "N", default_value = "0")]
    seed: u64,
    /// Give up after so many questions.
    #[arg(long, value_name = "N", default_value = "1000")]
    max_questions: u32,
    /// The largest automaton to consider, in states; 64 if not given, and 8
    /// where the teacher errs (unless `--robust`): wrong answers look like
    /// further states, and a bound not far above the target's size finds them
    /// out.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    max_states: Option<u16>,
    /// Start with nothing known; otherwise the label of the empty word is known
    /// for the Tomita languages, `zeros` and `modulo`, and eleven words for
    /// `robot`.
    #[arg(long)]
    no_empty_word: bool,
    /// Print every question with its answer.
    #[arg(long)]
    trace: bool,
    /// Write the learned automaton to this file (`-`: the standard output).
    #[arg(long, value_name = "FILE")]
    save: Option<PathBuf>,
    /// How to print.
    #[arg(long, value_name = "FORMAT", default_value = "text")]
    format: Output,
}

/// A cost that may be infinite.
fn cost(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(cost) if cost > 0.0 => Ok(cost),
        _ => Err("give a positive number, or `inf`".to_owned()),
    }
}

fn finite_cost(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(cost) if cost > 0.0 && cost.is_finite() => Ok(cost),
        _ => Err("give a positive number".to_owned()),
    }
}

fn cost_or_nothing(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(cost) if cost >= 0.0 && cost.is_finite() => Ok(cost),
        _ => Err("give a number, 0 or more".to_owned()),
    }
}

/// What a teacher may promise.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Promise {
    /// No counterexample could be shorter.
    Shortest,
}

fn rate(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(rate) if (0.0..=1.0).contains(&rate) => Ok(rate),
        _ => Err("give a number from 0 to 1".to_owned()),
    }
}

impl ValueEnum for Strategy {
    fn value_variants<'a>() -> &'a [Self] {
        &[Self::Bayes, Self::Exp4Plus, Self::Thesis, Self::Membership]
    }

    fn to_possible_value(&self) -> Option<clap::builder::PossibleValue> {
        Some(match self {
            Self::Bayes => clap::builder::PossibleValue::new("bayes")
                .help("the question of any kind that is worth most for its cost"),
            Self::Exp4Plus => clap::builder::PossibleValue::new("exp4+")
                .help("the posterior of bayes, and a bandit over its best question of each kind"),
            Self::Thesis => clap::builder::PossibleValue::new("thesis")
                .help("Algorithms 4 to 6 of the dissertation's chapter 5"),
            Self::Membership => {
                clap::builder::PossibleValue::new("membership").help("the same without comparisons")
            }
        })
    }
}

impl ValueEnum for Order {
    fn value_variants<'a>() -> &'a [Self] {
        &[Self::Ordered, Self::Random]
    }

    fn to_possible_value(&self) -> Option<clap::builder::PossibleValue> {
        Some(match self {
            Self::Ordered => clap::builder::PossibleValue::new("ordered")
                .help("by prefixes and extensions, as for Tomita's languages in chapter 5"),
            Self::Random => clap::builder::PossibleValue::new("random")
                .help("fixed and random, a tenth of the pairs incomparable"),
        })
    }
}

impl ValueEnum for Counterexamples {
    fn value_variants<'a>() -> &'a [Self] {
        &[Self::Shortest, Self::Random]
    }

    fn to_possible_value(&self) -> Option<clap::builder::PossibleValue> {
        Some(match self {
            Self::Shortest => clap::builder::PossibleValue::new("shortest").help("a shortest word"),
            Self::Random => clap::builder::PossibleValue::new("random")
                .help("any word of a random length, mostly up to 10"),
        })
    }
}

/// Runs the command.
pub(crate) fn run(args: &Args) -> anyhow::Result<ExitCode> {
    if args.robust && args.strategy != Strategy::Bayes {
        anyhow::bail!("`--robust` is a part of strategy bayes: add `--strategy bayes`");
    }
    if args.promise.is_some() && args.counterexample != Counterexamples::Shortest {
        anyhow::bail!(
            "`--promise shortest` would be broken: add `--counterexample shortest`, or drop the promise"
        );
    }
    let target = target(args)?;
    let alphabet = target.dfa().alphabet().clone();
    let usual_bound = if args.error_rate > 0.0 && !args.robust {
        8
    } else {
        64
    };
    let settings = Settings {
        engine: EngineChoice::Auto,
        max_states: usize::from(args.max_states.unwrap_or(usual_bound)),
    };
    let config = Config {
        strategy: args.strategy,
        membership_cost: args.membership_cost,
        comparison_cost: args.comparison_cost,
        equivalence_cost: (args.equivalence_cost)
            .unwrap_or(EQUIVALENCE_COST * args.membership_cost),
        shortest_counterexamples: args.promise.is_some(),
        robust: args.robust,
        conformance: args.conformance,
        seed: args.seed,
        budget: BUDGET,
    };
    let class = DfaClass::new(alphabet.clone(), settings);
    let mut learner = Learner::new(class, config, target.known().to_vec());
    let mut teacher = ScriptedTeacher::new(
        &target,
        TeacherSettings {
            order: args.teacher,
            counterexamples: args.counterexample,
            error_rate: args.error_rate,
            seed: args.seed,
        },
    );
    // Drawn only on a terminal, and only where the trace does not tell anyway.
    let progress = if args.trace {
        ProgressBar::hidden()
    } else {
        ProgressBar::new_spinner()
    };
    progress.enable_steady_tick(Duration::from_millis(200));
    let mut printed = Ok(());
    // The check and the batch of the last claim told.
    let mut told = (0, 0);
    let report = teach(
        &mut learner,
        &mut teacher,
        args.max_questions,
        process_cpu,
        |asked| {
            progress.set_message(match asked.check {
                None => format!("{} questions asked", asked.number),
                Some(check) => format!(
                    "{} questions asked; {} of {} random words judged",
                    asked.number, check.judged, check.needed
                ),
            });
            if args.trace && printed.is_ok() {
                printed = check::batch(args.format, asked, &mut told)
                    .and_then(|()| trace::line(args.format, &alphabet, asked));
            }
        },
    );
    progress.finish_and_clear();
    printed?;
    let report = report?;
    if args.trace {
        let mut conflicts = report.conflicts.iter();
        conflicts.try_for_each(|dropped| trace::conflict(args.format, dropped))?;
    }
    if let (Some(path), Some(learned)) = (&args.save, &report.learned) {
        save(path, &target, args.seed, learned)?;
    }
    tell(args, &target, &report, learner.doubts())?;
    let borne_out = report.check.as_ref().is_none_or(Progress::is_complete);
    Ok(if report.learned.is_some() && borne_out {
        ExitCode::SUCCESS
    } else {
        ExitCode::from(1)
    })
}

/// The target of this name, or else of this file.
fn target(args: &Args) -> anyhow::Result<Target> {
    let path = PathBuf::from(&args.target);
    let target = match Target::named(&args.target) {
        Err(error @ TargetError::Unknown(_)) => {
            // A path that is not there was more likely meant as a name.
            if path.extension().is_none() && !path.exists() {
                return Err(error.into());
            }
            let document = files::read_automaton(&path, None)?;
            Target::automaton(&args.target, &document.dfa)
        }
        named => named?,
    };
    Ok(if args.no_empty_word {
        target.without_known()
    } else {
        target
    })
}

fn save(path: &Path, target: &Target, seed: u64, learned: &Dfa) -> anyhow::Result<()> {
    let document = Document {
        dfa: learned.clone(),
        name: Some(target.name().to_owned()),
        provenance: Some(Provenance {
            version: Some(env!("CARGO_PKG_VERSION").to_owned()),
            seed: Some(seed),
            digest: None,
        }),
    };
    let format = path
        .extension()
        .map_or(Ok(Format::Json), |_| Format::choose(None, path, "--save"))?;
    let text = files::render(&Content::Automaton(document), format)?;
    files::write(path, &text).context("the learned automaton was not saved")
}

/// What `--format json` prints last.
#[derive(Serialize)]
struct Summary<'a> {
    target: &'a str,
    strategy: Strategy,
    seed: u64,
    equivalent: bool,
    /// The number of states learned.
    states: Option<usize>,
    membership: u32,
    comparison: u32,
    equivalence: u32,
    cost: f64,
    dropped: u32,
    /// The share of the answers that seem wrong, and which these are.
    #[serde(skip_serializing_if = "Option::is_none")]
    wrong: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    doubted: Option<Vec<u32>>,
    hurried: u32,
    #[serde(skip_serializing_if = "Option::is_none")]
    conformance: Option<check::Checked>,
    question_ms: Milliseconds,
    cpu_s: f64,
}

/// The CPU time that choosing a question took.
#[derive(Serialize)]
struct Milliseconds {
    p50: f64,
    p95: f64,
    max: f64,
}

impl Milliseconds {
    fn of(times: &[Duration]) -> Self {
        let at = |percent| rounded(percentile(times, percent).as_secs_f64() * 1e3);
        Self {
            p50: at(50),
            p95: at(95),
            max: at(100),
        }
    }
}

/// To three places, as more would be noise.
fn rounded(number: f64) -> f64 {
    (number * 1e3).round() / 1e3
}

fn tell(
    args: &Args,
    target: &Target,
    report: &Report<Dfa>,
    doubts: Option<&Doubts>,
) -> anyhow::Result<()> {
    let counts = report.counts;
    let times = Milliseconds::of(&report.question_times);
    if args.format == Output::Json {
        let summary = Summary {
            target: target.name(),
            strategy: args.strategy,
            seed: args.seed,
            equivalent: report.learned.is_some(),
            states: report.learned.as_ref().map(Dfa::size),
            membership: counts.membership,
            comparison: counts.comparison,
            equivalence: counts.equivalence,
            cost: report.cost,
            dropped: report.dropped,
            wrong: doubts.map(|doubts| rounded(doubts.error_rate)),
            doubted: doubts.map(|doubts| doubts::doubted(doubts).collect()),
            hurried: report.hurried,
            conformance: (report.check.as_ref())
                .map(|check| check::Checked::of(check, counts.conformance)),
            question_ms: times,
            cpu_s: rounded(report.cpu.as_secs_f64()),
        };
        return output::line(serde_json::to_string(&summary)?);
    }
    match &report.learned {
        Some(learned) => output::line(format!(
            "learned: {} with {} states",
            target.name(),
            learned.size()
        ))?,
        None => output::line(format!(
            "not learned: {} within {} questions; allow more by `--max-questions`",
            target.name(),
            args.max_questions
        ))?,
    }
    if let Some(check) = &report.check {
        check::tell(check, args.max_questions)?;
    }
    let judged = match (args.conformance, counts.conformance) {
        (None, _) => String::new(),
        (Some(_), 1) => ", 1 judgement to check the result".to_owned(),
        (Some(_), judged) => format!(", {judged} judgements to check the result"),
    };
    output::line(format!(
        "asked: {} membership queries, {} comparisons, {} equivalence queries{judged}",
        counts.membership, counts.comparison, counts.equivalence
    ))?;
    output::line(format!(
        "cost: {} (equivalence queries{} not counted)",
        report.cost,
        if args.conformance.is_some() {
            " and the check"
        } else {
            ""
        }
    ))?;
    if report.dropped > 0 {
        output::line(format!(
            "dropped: {} answers that contradicted others",
            report.dropped
        ))?;
    }
    if let Some(doubts) = doubts {
        doubts::tell(doubts)?;
    }
    output::line(format!(
        "CPU time: {} ms a question (median; 95 % within {} ms)",
        times.p50, times.p95
    ))
}
