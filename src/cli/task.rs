//! `memrep task`: checks task files, and writes one to begin with.

use std::fs::OpenOptions;
use std::io::{ErrorKind, Write as _};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::{Context as _, bail};
use automata::{Alphabet, Symbol};
use clap::Subcommand;
use serde::Serialize;

use super::files;
use super::output::{self, Output, counted, spelled};
use crate::concept::Template;
use crate::task::{Concept, Situation, TEMPLATE, TaskFile, Universe, WorldText};
use crate::world::World;

/// So many of the behaviours that are left open are counted.
const COUNTED: usize = 1000;

/// Arguments of `memrep task`.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Say what is wrong with a task file, or what it is about.
    Check(Check),
    /// Write a commented task file to begin with.
    New(New),
}

/// Arguments of `memrep task check`.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:
  memrep task check examples/tasks/robot-recharge.toml
  memrep task check my-task.toml --format json
    {\"file\":\"my-task.toml\",\"line\":12,\"column\":9,\"path\":\"world.map[3][2]\",\"message\":…}

Every fault is a line `FILE:LINE:COLUMN: where in the task: what is wrong`, in the
order of the file; they go to the standard error, with --format json to the
standard output.

Exit status: 0 if the task can be taught, 2 if anything is at fault.")]
struct Check {
    /// The task file: TOML, or the same in JSON.
    #[arg(value_name = "FILE")]
    file: PathBuf,
    /// How to print.
    #[arg(long, value_name = "FORMAT", default_value = "text")]
    format: Output,
}

/// Arguments of `memrep task new`.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:
  memrep task new my-task.toml
  memrep task new > my-task.toml

A file that is there is left as it is. The new one passes `memrep task check`, and
`memrep learn --target FILE` teaches it; its comments say what can be changed.

Exit status: 0 if it was written, 2 if not.")]
struct New {
    /// The file to write; the standard output if not given.
    #[arg(value_name = "FILE", default_value = "-")]
    file: PathBuf,
}

/// Runs the command.
pub(crate) fn run(args: &Args) -> anyhow::Result<ExitCode> {
    match &args.command {
        Command::Check(args) => check(args),
        Command::New(args) => new(&args.file),
    }
}

fn new(path: &Path) -> anyhow::Result<ExitCode> {
    if path == Path::new("-") {
        files::write(path, TEMPLATE)?;
        return Ok(ExitCode::SUCCESS);
    }
    let name = path.display();
    let file = OpenOptions::new().write(true).create_new(true).open(path);
    match file {
        Ok(mut file) => (file.write_all(TEMPLATE.as_bytes()))
            .with_context(|| format!("{name}: cannot write it"))?,
        Err(error) if error.kind() == ErrorKind::AlreadyExists => {
            bail!("{name} is there already, and was left as it is: give another name")
        }
        Err(error) => return Err(error).with_context(|| format!("{name}: cannot write it")),
    }
    output::note(format_args!(
        "{name} is written: change it, and run `memrep task check {name}`"
    ));
    Ok(ExitCode::SUCCESS)
}

/// A fault, for programs.
#[derive(Serialize)]
struct FaultLine<'a> {
    file: &'a Path,
    #[serde(skip_serializing_if = "Option::is_none")]
    line: Option<usize>,
    #[serde(skip_serializing_if = "Option::is_none")]
    column: Option<usize>,
    path: &'a str,
    message: &'a str,
}

/// What a task is about, for programs.
#[derive(Serialize)]
struct Summary<'a> {
    file: &'a Path,
    name: &'a str,
    symbols: Vec<&'a str>,
    world: &'static str,
    /// Symbols that nothing in the world shows.
    never_shown: Vec<&'a str>,
    examples: usize,
    /// Behaviours that can happen and are not settled beforehand; none where they
    /// are too many to count.
    open: Option<usize>,
    /// The simplest of them.
    simplest: Vec<Vec<&'a str>>,
    /// The states of the target.
    #[serde(skip_serializing_if = "Option::is_none")]
    target: Option<usize>,
}

fn check(args: &Check) -> anyhow::Result<ExitCode> {
    let file = match TaskFile::open(&args.file) {
        Ok(file) => file,
        Err(unusable) if args.format == Output::Json => {
            for fault in &unusable.faults {
                output::line(serde_json::to_string(&FaultLine {
                    file: &args.file,
                    line: fault.line,
                    column: fault.column,
                    path: &fault.path,
                    message: &fault.message,
                })?)?;
            }
            return Ok(ExitCode::from(2));
        }
        Err(unusable) => {
            output::note(unusable);
            return Ok(ExitCode::from(2));
        }
    };
    tell(args, &file)?;
    Ok(ExitCode::SUCCESS)
}

fn tell(args: &Check, file: &TaskFile) -> anyhow::Result<()> {
    let target = (file.target.as_ref()).map(|target| match target {
        Concept::Automaton(dfa) => dfa.minimise().size(),
        other => file.universe.size(other),
    });
    let Universe::Words {
        alphabet,
        situation,
    } = &file.universe
    else {
        return tell_class(args, file, target);
    };
    let task = &file.task;
    let open = (situation.as_ref()).map(|Situation { world, prior }| {
        let listing = world.list(prior.open(), COUNTED);
        let number = listing.complete.then_some(listing.words.len());
        (number, listing.words)
    });
    let (number, words) = open.unwrap_or_default();
    let never_shown = match situation {
        Some(situation) => never_shown(&situation.world, alphabet),
        None => Vec::new(),
    };
    if args.format == Output::Json {
        let spell = |word| alphabet.spell(word).collect();
        return output::line(serde_json::to_string(&Summary {
            file: &args.file,
            name: &task.name,
            symbols: alphabet.names().collect(),
            world: match task.world {
                None | Some(WorldText::Words { .. }) => "words",
                Some(WorldText::Grid { .. }) => "grid",
                Some(WorldText::Pool { .. }) => "pool",
            },
            never_shown,
            examples: task.examples.len(),
            open: number,
            simplest: words.iter().take(3).map(spell).collect(),
            target,
        })?);
    }
    let symbols: Vec<String> = (task.symbols.iter())
        .map(|symbol| match &symbol.word {
            Some(word) if *word != symbol.name => format!("{} ({word})", symbol.name),
            _ => symbol.name.clone(),
        })
        .collect();
    output::line(format!("{}: this task can be taught", args.file.display()))?;
    output::line(format!("title:    {}", task.title))?;
    output::line(format!("symbols:  {}", symbols.join(", ")))?;
    output::line(format!("world:    {}", world_in_words(situation.as_ref())))?;
    if !never_shown.is_empty() {
        let names = never_shown.join(", ");
        output::line(format!("          nothing in it shows {names}"))?;
    }
    output::line(format!("examples: {}", task.examples.len()))?;
    let simplest: Vec<String> = (words.iter().take(3))
        .map(|word| spelled(alphabet, word))
        .collect();
    output::line(match (situation.is_some(), number) {
        (false, _) => "open:     every behaviour".to_owned(),
        (true, Some(number)) => {
            let behaviours = counted(number, "behaviour", "behaviours");
            format!(
                "open:     {behaviours}, the simplest: {}",
                simplest.join(", ")
            )
        }
        (true, None) => format!(
            "open:     more than {} behaviours, the simplest: {}",
            words.len(),
            simplest.join(", ")
        ),
    })?;
    match target {
        Some(states) => output::line(format!(
            "target:   an automaton with {}, for `memrep learn`",
            counted(states, "state", "states")
        )),
        None => output::line("target:   none, so `memrep learn` cannot teach it by itself"),
    }
}

/// What a task that learns no automaton is about, for programs.
#[derive(Serialize)]
struct ClassSummary<'a> {
    file: &'a Path,
    name: &'a str,
    class: &'static str,
    examples: usize,
    /// The size of the target.
    #[serde(skip_serializing_if = "Option::is_none")]
    target: Option<usize>,
}

fn tell_class(args: &Check, file: &TaskFile, target: Option<usize>) -> anyhow::Result<()> {
    let (class, about) = match &file.universe {
        Universe::Words { .. } => ("words", String::new()),
        Universe::Monotone(axes) => {
            let ranges: Vec<String> = (axes.axes().iter())
                .map(|axis| {
                    let (best, worst) = (axis.spell(axis.best), axis.spell(axis.worst));
                    format!("{} from {best} to {worst}", axis.name)
                })
                .collect();
            let points = axes.points();
            (
                "monotone",
                format!(
                    "limits on {}, up to {points} points per axis",
                    ranges.join(" and ")
                ),
            )
        }
        Universe::Finite(table) => (
            "finite",
            format!(
                "one of {} over {}",
                counted(table.class().concepts().len(), "concept", "concepts"),
                counted(table.atoms().len(), "behaviour", "behaviours")
            ),
        ),
        Universe::Linear(rewards) => (
            "linear",
            format!(
                "rewards that weigh {}, over {}",
                rewards.features().join(" and "),
                counted(rewards.behaviours().len(), "behaviour", "behaviours")
            ),
        ),
    };
    let task = &file.task;
    if args.format == Output::Json {
        return output::line(serde_json::to_string(&ClassSummary {
            file: &args.file,
            name: &task.name,
            class,
            examples: task.examples.len(),
            target,
        })?);
    }
    output::line(format!("{}: this task can be taught", args.file.display()))?;
    output::line(format!("title:    {}", task.title))?;
    output::line(format!("class:    {class}, {about}"))?;
    output::line(format!("examples: {}", task.examples.len()))?;
    output::line(match target {
        Some(size) => format!("target:   a rule of size {size}, for `memrep learn`"),
        None => "target:   none, so `memrep learn` cannot teach it by itself".to_owned(),
    })
}

fn world_in_words(situation: Option<&Situation>) -> String {
    match situation.map(|situation| &*situation.world) {
        None => "all sequences".to_owned(),
        Some(World::Words(words)) => {
            let longest = counted(words.longest(), "symbol", "symbols");
            format!("all sequences of up to {longest}")
        }
        Some(World::Grid(grid)) => format!(
            "a grid of {} × {} cells with {}, walks of up to {}",
            grid.rows(),
            grid.columns(),
            counted(grid.starts().len(), "start", "starts"),
            counted(grid.steps(), "step", "steps")
        ),
        Some(World::Pool(pool)) => format!(
            "{}, {} of them different",
            counted(pool.recordings().len(), "recording", "recordings"),
            pool.different()
        ),
    }
}

/// The symbols that no feasible word has.
fn never_shown<'a>(world: &World, alphabet: &'a Alphabet) -> Vec<&'a str> {
    let unseen = |symbol: &Symbol| !world.has_word(&Template::Reach(*symbol).dfa(alphabet));
    let symbols = alphabet.symbols().filter(unseen);
    symbols.map(|symbol| alphabet.name(symbol)).collect()
}
