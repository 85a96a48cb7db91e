//! `memrep learn`: teaches a target by a scripted teacher, and tells what it
//! took.

mod check;
mod classes;
mod converse;
mod doubts;
mod situation;
mod summary;
mod teller;
mod trace;
mod values;

use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::Arc;

use anyhow::Context as _;
use automata::Dfa;
use automata::format::json::{Document, Provenance};

use self::converse::converse;
use self::teller::Words;
use self::values::Promise;
use super::files::{self, Content, Format};
use super::output::Output;
use crate::bench::Report;
use crate::concept::DfaClass;
use crate::identify::{EngineChoice, Settings};
use crate::learner::{Config, Conformance, EQUIVALENCE_COST, Learner, Progress, Strategy};
use crate::oracle::{
    Counterexamples, Order, ScriptedTeacher, SituatedTeacher, Target, TargetError, TeacherSettings,
};
use crate::task::{Concept, Costs, Situation, TaskFile};
use crate::world::grid::Labelling;

/// The work that one question may do: a few seconds of search.
const BUDGET: u64 = 2_000_000;

/// Arguments of `memrep learn`.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:
  memrep learn --target tomita:4
  memrep learn --target robot --teacher random --counterexample random --trace
  memrep learn --target tomita:7 --error-rate 0.1 --strategy bayes --robust
  memrep learn --target task.json --membership-cost 8 --save learned.json
  memrep learn --target robot --prior 'avoid R' --prior 'reach Y'
  memrep learn --target robot --prior ry.json --grid room.txt --steps 30
  memrep learn --target examples/tasks/robot-recharge.toml --trace
  memrep learn --target task.json --pool recordings.jsonl --no-empty-word
  memrep learn --target monotone:2:10 --trace
  memrep learn --target finite:manners.csv#polite --strategy thesis
  memrep learn --target tomita:5 --comparison-cost inf --format json
    {\"target\":\"tomita:5\",\"strategy\":\"bayes\",\"seed\":0,\"equivalent\":true,\"states\":4,…}

Targets: tomita:1 to tomita:7 (Tomita's languages over 0 and 1), tomita:3t (the
third in the dissertation's three-state form), zeros:N (no run of more than N
zeros), modulo:K (words over `a` whose length is divisible by K), robot (Fig. 5.2
of the dissertation), random:N and task:N (drawn at random, as in `memrep bench
random` and `tasks`), or the path of an automaton file (json or dot) or of a task
file (toml, or the same in json). A task file tells the world, what is known
beforehand, examples, costs and strategy as well; options override what it tells.

Targets of other classes, about whose options on words nothing can be said:
monotone:D:TICKS (behaviours are points with coordinates from 0 to 1, acceptable
if at most the target in each of D = 1 to 4 dimensions; the target is drawn by the
seed from the grid with TICKS points per axis, or as number N: monotone:D:TICKS:N),
finite:FILE (a table of comma-separated values: a line with the names of concepts,
perhaps a line `size`, and a line a behaviour with 1 under the concepts that
contain it and else 0; the target is drawn by the seed, or named: finite:FILE#NAME),
linear:FILE (JSON with `weights`, `threshold` and `behaviours`, each a `name` and
`features`, a list of numbers from 0 to 1 for every step: acceptable is what is
above the threshold in sum; rewards are looked for on grids with up to `finest`
points per axis). See examples/manners.csv and examples/drives.json. For these,
`size` stands in place of `states`, and --trace has `atom` in place of `word`.

With --conformance, what the teacher agreed with is believed only after random
words were judged: the line `checked` says how far one may trust it. Of a teacher that
errs a wrong judgement may refute what was right; it is found out
and dropped like any other, and the check goes on where it was.

With --prior, --suffices, --grid or --pool only behaviours are asked about whose
label is not settled and that can happen, and the result agrees with the target on
these. Where that leaves something open, a behaviour is told that would decide it.
With --trace --format json, `shown` has the walk or the recording of every question.

Exit status: 0 if the target was learned, 1 if the questions ran out first (also
in the check), 2 if the arguments or a file are at fault.")]
pub(crate) struct Args {
    /// What to learn: a name from the list below, an automaton file, or a task file
    /// with a target.
    #[arg(long, value_name = "T")]
    target: String,
    /// The cost of a membership query, positive; 4 if nothing else is said.
    #[arg(long, value_name = "A", allow_negative_numbers = true, value_parser = values::finite_cost)]
    membership_cost: Option<f64>,
    /// The cost of a comparison, positive; `inf`: never ask one. 1 if nothing else is
    /// said.
    #[arg(long, value_name = "B", allow_negative_numbers = true, value_parser = values::cost)]
    comparison_cost: Option<f64>,
    /// The cost of an equivalence query, 0 or more; four times a membership query
    /// if not given. Strategies bayes and exp4+ show an automaton when that is worth it.
    #[arg(long, value_name = "E", allow_negative_numbers = true, value_parser = values::cost_or_nothing)]
    equivalence_cost: Option<f64>,
    /// How questions are chosen; bayes if nothing else is said.
    #[arg(long, value_name = "S")]
    strategy: Option<Strategy>,
    /// The preference order of the teacher.
    #[arg(long, value_name = "ORDER", default_value = "ordered")]
    teacher: Order,
    /// How the teacher refutes a wrong hypothesis.
    #[arg(long, value_name = "KIND", default_value = "shortest")]
    counterexample: Counterexamples,
    /// The share of membership answers and comparisons that are wrong.
    #[arg(long, value_name = "RATE", default_value = "0", allow_negative_numbers = true, value_parser = values::rate)]
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
    /// Something that holds whatever is learned, and is never asked: a rule
    /// (`avoid X`, `reach Y`, `X before Y`, `never X after Y`) or an automaton
    /// file. May be given several times.
    #[arg(long, value_name = "RULE")]
    prior: Vec<String>,
    /// Something that suffices whatever is learned: a rule or an automaton file.
    /// May be given several times.
    #[arg(long, value_name = "RULE")]
    suffices: Vec<String>,
    /// Ask only about walks through the grid that this text file draws: `S` a
    /// start, `#` a wall, `.` an empty cell, and a symbol of one character a tile
    /// that gives the symbol when it is entered.
    #[arg(long, value_name = "FILE")]
    grid: Option<PathBuf>,
    /// The steps that a walk through the grid has at most; 40 if nothing else is
    /// said.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    steps: Option<u16>,
    /// When a tile of the grid gives its symbol; entry if nothing else is said.
    #[arg(long, value_name = "WHEN")]
    labelling: Option<Labelling>,
    /// Ask only about the recordings in this file of JSON lines, such as
    /// `{"id":"run-1","word":["a","b"]}`.
    #[arg(long, value_name = "FILE", conflicts_with = "grid")]
    pool: Option<PathBuf>,
    /// Print every question with its answer.
    #[arg(long)]
    trace: bool,
    /// Write the learned automaton, with what is known beforehand, or the learned
    /// concept of another class as JSON, to this file (`-`: the standard output).
    #[arg(long, value_name = "FILE")]
    save: Option<PathBuf>,
    /// Write only the part that was learned beside what is known beforehand.
    #[arg(long, value_name = "FILE")]
    save_part: Option<PathBuf>,
    /// How to print.
    #[arg(long, value_name = "FORMAT", default_value = "text")]
    format: Output,
}

/// Runs the command.
pub(crate) fn run(args: &Args) -> anyhow::Result<ExitCode> {
    let file = task_file(args)?;
    if let Some(status) = classes::run(args, file.as_ref())? {
        return Ok(status);
    }
    let target = target(args, file.as_ref())?;
    let task = file.as_ref().map(|file| &file.task);
    let told = task.map(|task| task.costs).unwrap_or_default();
    let strategy = args.strategy.or(task.and_then(|task| task.strategy));
    let strategy = strategy.unwrap_or(Strategy::Bayes);
    check_options(args, strategy)?;
    let nothing_known = args.prior.is_empty()
        && args.suffices.is_empty()
        && task.is_none_or(|task| task.prior.is_empty());
    if args.save_part.is_some() && nothing_known {
        anyhow::bail!(
            "without `--prior` or `--suffices` all is learned: use `--save` in place of `--save-part`"
        );
    }
    let alphabet = target.dfa().alphabet().clone();
    let usual_bound = if args.error_rate > 0.0 && !args.robust {
        8
    } else {
        64
    };
    let settings = Settings {
        engine: EngineChoice::Auto,
        max_states: (args.max_states.map(usize::from))
            .or(file.as_ref().and_then(|file| file.max_states))
            .unwrap_or(usual_bound),
    };
    let config = config(args, strategy, told);
    let teacher = teacher(args);
    let known = target.known().to_vec();
    let mut beyond = None;
    let (report, doubts) = match situation::read(args, &alphabet, file.as_ref())? {
        None => {
            let class = DfaClass::new(alphabet.clone(), settings);
            let mut learner = Learner::new(class, config, known);
            let mut teacher = ScriptedTeacher::new(&target, teacher);
            let words = Words {
                alphabet: alphabet.clone(),
                world: None,
            };
            let report = converse(args, &mut learner, &mut teacher, &words)?;
            (report, learner.doubts().cloned())
        }
        Some(situation) => {
            let class = situation.class(settings)?;
            let Situation { world, prior } = situation;
            let open = prior.open().clone();
            let known = class.examples(&known).context(
                "what is known of the target at the start does not fit; `--no-empty-word` starts with nothing",
            )?;
            let mut learner = Learner::new(class, config, known);
            let mut teacher = SituatedTeacher::new(Arc::clone(&world), open, &target, teacher);
            let words = Words {
                alphabet: alphabet.clone(),
                world: Some(&world),
            };
            let mut report = converse(args, &mut learner, &mut teacher, &words)?;
            beyond = (report.learned.as_ref()).and_then(|part| learner.class().beyond(part));
            if let (Some(path), Some(part)) = (&args.save_part, &report.learned) {
                save(path, "--save-part", &target, args.seed, part)?;
            }
            report.learned = report.learned.map(|part| prior.whole(&part));
            (report, learner.doubts().cloned())
        }
    };
    if let (Some(path), Some(learned)) = (&args.save, &report.learned) {
        save(path, "--save", &target, args.seed, learned)?;
    }
    let words = Words {
        alphabet,
        world: None,
    };
    summary::tell(
        args,
        strategy,
        target.name(),
        &words,
        &report,
        doubts.as_ref(),
        beyond.as_ref(),
    )?;
    Ok(status(&report))
}

/// Refuses what strategy and teacher cannot keep, and what could not be saved.
fn check_options(args: &Args, strategy: Strategy) -> anyhow::Result<()> {
    for path in [&args.save, &args.save_part].into_iter().flatten() {
        files::check_folder(path)?;
    }
    if args.robust && strategy != Strategy::Bayes {
        anyhow::bail!("`--robust` is a part of strategy bayes: add `--strategy bayes`");
    }
    if args.robust && args.conformance.is_some() {
        anyhow::bail!(
            "the check of `--conformance` takes judgements for true, and `--robust` takes none so: give one of the two"
        );
    }
    if args.promise.is_some() && args.counterexample != Counterexamples::Shortest {
        anyhow::bail!(
            "`--promise shortest` would be broken: add `--counterexample shortest`, or drop the promise"
        );
    }
    Ok(())
}

/// What the learner is told, where a task may have told costs.
fn config(args: &Args, strategy: Strategy, told: Costs) -> Config {
    let membership_cost = args.membership_cost.or(told.membership).unwrap_or(4.0);
    Config {
        strategy,
        membership_cost,
        comparison_cost: args.comparison_cost.or(told.comparison).unwrap_or(1.0),
        equivalence_cost: (args.equivalence_cost).unwrap_or(EQUIVALENCE_COST * membership_cost),
        shortest_counterexamples: args.promise.is_some(),
        robust: args.robust,
        conformance: args.conformance,
        seed: args.seed,
        budget: BUDGET,
    }
}

/// How the teacher answers.
fn teacher(args: &Args) -> TeacherSettings {
    TeacherSettings {
        order: args.teacher,
        counterexamples: args.counterexample,
        error_rate: args.error_rate,
        seed: args.seed,
    }
}

/// Whether the target was learned, and borne out where that was asked for.
fn status<C>(report: &Report<C>) -> ExitCode {
    let borne_out = report.check.as_ref().is_none_or(Progress::is_complete);
    if report.learned.is_some() && borne_out {
        ExitCode::SUCCESS
    } else {
        ExitCode::from(1)
    }
}

/// The task in the file that the target names; none if it names none.
fn task_file(args: &Args) -> anyhow::Result<Option<TaskFile>> {
    let path = Path::new(&args.target);
    let is_file = path.exists() && files::is_task(path);
    let is_name = !matches!(Target::named(&args.target), Err(TargetError::Unknown(_)));
    Ok((is_file && !is_name)
        .then(|| TaskFile::open(path))
        .transpose()?)
}

/// The target of this name, or else of this task or file.
fn target(args: &Args, file: Option<&TaskFile>) -> anyhow::Result<Target> {
    let path = Path::new(&args.target);
    let target = match (Target::named(&args.target), file) {
        (Err(TargetError::Unknown(_)), Some(file)) => task_target(&args.target, file)?,
        (Err(error @ TargetError::Unknown(_)), None) => {
            // A path that is not there was more likely meant as a name.
            if path.extension().is_none() && !path.exists() {
                return Err(error.into());
            }
            if !path.exists() {
                anyhow::bail!(
                    "{}: cannot read it: there is no such file, and no target is called so",
                    args.target
                );
            }
            Target::automaton(&args.target, &files::read_automaton(path, None)?.dfa)
        }
        (named, _) => named?,
    };
    Ok(if args.no_empty_word {
        target.without_known()
    } else {
        target
    })
}

/// What the task's file says that the teacher has in mind.
fn task_target(name: &str, file: &TaskFile) -> anyhow::Result<Target> {
    let Some(dfa) = file.target.as_ref().and_then(Concept::automaton) else {
        anyhow::bail!(
            "{name} has no target for a scripted teacher: add `target`, such as `target = [\"avoid X\", \"reach Y\"]`"
        );
    };
    let known = file.task.known(&file.universe);
    Ok(Target::automaton(name, dfa).with_known(known))
}

fn save(
    path: &Path,
    option: &str,
    target: &Target,
    seed: u64,
    learned: &Dfa,
) -> anyhow::Result<()> {
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
        .map_or(Ok(Format::Json), |_| Format::choose(None, path, option))?;
    let text = files::render(&Content::Automaton(document), format)?;
    files::write(path, &text).context("the learned automaton was not saved")
}
