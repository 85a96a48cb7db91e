//! `memrep identify`: the smallest automata consistent with a sample.

use std::fmt::Write as _;
use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Duration;

use automata::format::json;
use automata::{Dfa, Item};
use clap::ValueEnum;
use indicatif::{ProgressBar, ProgressStyle};
use serde::Serialize;

use super::files::{self, Format, ItemLine};
use super::output::{self, Output};
use crate::concept::Preorder;
use crate::evidence::{AnswerId, Budget, Fact};
use crate::identify::{Cause, Contradiction, EngineChoice, Failure, Identifier, Sample, Settings};

/// Arguments of `memrep identify`.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:
  memrep identify words.abb
  memrep identify answers.jsonl --count 5
  memrep identify answers.jsonl --max-states 8 --format json > learned.json
  memrep convert words.abb - --to jsonl | memrep identify - --from jsonl

A sample is an Abbadingo file (.abb) or JSON lines (.jsonl):
  {\"word\":[\"a\",\"b\"],\"label\":true}
  {\"worse\":[\"a\"],\"better\":[\"b\"]}
  {\"equal\":[[\"a\"],[\"b\"]]}

Exit status: 0 if an automaton was found; 1 if there is none, and then the lines
that contradict each other are named, or if the budget ended; 2 if the file or
the arguments are at fault.")]
pub(crate) struct Args {
    /// The sample (abb or jsonl); `-` is the standard input.
    #[arg(value_name = "FILE")]
    file: PathBuf,
    /// The format of FILE, where its extension does not tell.
    #[arg(long, value_name = "FORMAT")]
    from: Option<Format>,
    /// What searches.
    #[arg(long, value_name = "SOLVER", default_value = "auto")]
    solver: Solver,
    /// The largest number of states to try; without it, there is no limit.
    #[arg(long, value_name = "N", value_parser = at_least_one)]
    max_states: Option<usize>,
    /// As many different automata of the smallest size as there are, up to N.
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = at_least_one)]
    count: usize,
    /// Which automata are chosen where there are more than `--count`.
    #[arg(long, value_name = "SEED", default_value_t = 0)]
    seed: u64,
    /// The steps after which the search gives up; a million take about half a
    /// second.
    #[arg(long, value_name = "STEPS", default_value_t = 200_000_000)]
    budget: u64,
    /// How to print the automata.
    #[arg(long, value_name = "FORMAT", default_value = "text")]
    format: Output,
}

/// The names of [`EngineChoice`] in the shell.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Solver {
    /// The enumerator first, then SAT.
    Auto,
    /// The enumerator of automata alone.
    Enumerate,
    /// SAT by varisat.
    Varisat,
    /// SAT by batsat.
    Batsat,
}

impl From<Solver> for EngineChoice {
    fn from(solver: Solver) -> Self {
        match solver {
            Solver::Auto => Self::Auto,
            Solver::Enumerate => Self::Enumerate,
            Solver::Varisat => Self::Varisat,
            Solver::Batsat => Self::Batsat,
        }
    }
}

/// Parses a number that may not be 0.
fn at_least_one(text: &str) -> Result<usize, String> {
    match text.parse() {
        Ok(0) => Err("expected at least 1".to_owned()),
        Ok(number) => Ok(number),
        Err(_) => Err("expected a whole number, 1 or more".to_owned()),
    }
}

/// Why there is no automaton, for programs.
#[derive(Serialize)]
#[serde(rename_all = "snake_case")]
enum Nothing {
    /// These lines cannot all hold.
    Contradiction {
        lines: Vec<usize>,
        minimal: bool,
        /// The bound, if a larger one would do.
        #[serde(skip_serializing_if = "Option::is_none")]
        max_states: Option<usize>,
        /// `membership` or `states`.
        cause: &'static str,
    },
    /// The budget ended.
    OverBudget { at_least: usize },
}

/// Runs the command.
pub(crate) fn run(args: &Args) -> anyhow::Result<ExitCode> {
    let (sample, lines) = files::read_sample(&args.file, args.from)?;
    let settings = Settings {
        engine: args.solver.into(),
        max_states: args.max_states.unwrap_or(usize::MAX),
    };
    let mut identifier = Identifier::new(sample.alphabet().clone(), settings);
    for (place, item) in sample.items().iter().enumerate() {
        if let Some(fact) = fact(item) {
            identifier.add(Some(AnswerId(u32::try_from(place)?)), fact);
        }
    }
    warn_of_order(&sample, &lines)?;
    let mut budget = Budget::new(args.budget);
    let progress = progress();
    let found = identifier.smallest_watched(args.count, args.seed, &mut budget, &mut |states| {
        progress.set_message(format!("trying {}", count(states, "state")));
    });
    progress.finish_and_clear();
    match found {
        Ok(sample) => {
            print(&sample, args.format)?;
            Ok(ExitCode::SUCCESS)
        }
        Err(failure) => {
            explain(&failure, &lines, args.format)?;
            Ok(ExitCode::from(1))
        }
    }
}

/// Tells on the standard error of comparisons that no order agrees with. They do
/// not keep an automaton from being consistent (Definition 5.1.2 looks at labels
/// alone), but whoever gave them slipped.
fn warn_of_order(sample: &automata::Sample, lines: &[ItemLine]) -> anyhow::Result<()> {
    let mut order = Preorder::default();
    for (place, item) in sample.items().iter().enumerate() {
        match fact(item) {
            None | Some(Fact::Label { .. }) => {}
            Some(fact) => order.add(Some(AnswerId(u32::try_from(place)?)), &fact),
        }
    }
    let Some(conflict) = order.conflict() else {
        return Ok(());
    };
    output::note(format_args!(
        "warning: no order agrees with these lines. {} What is found treats them all alike.",
        output::because(conflict.cause, &output::AUTOMATA)
    ));
    for answer in &conflict.answers {
        let line = &lines[answer.0 as usize];
        output::note(format_args!("  line {}: {}", line.number, line.text));
    }
    Ok(())
}

/// What an item says of the language; none if nothing.
fn fact(item: &Item) -> Option<Fact<automata::Word>> {
    Some(match item.clone() {
        Item::Label { word, accepted } => Fact::Label {
            atom: word,
            accepted,
        },
        Item::Below { worse, better } => Fact::Below { worse, better },
        Item::Equal { first, second } => Fact::Equal { first, second },
        Item::Unknown { .. } => return None,
    })
}

/// A line on the standard error that shows what is being tried, if somebody
/// looks at it.
fn progress() -> ProgressBar {
    let progress = ProgressBar::new_spinner().with_style(
        ProgressStyle::with_template("{spinner} {msg} ({elapsed})")
            .unwrap_or_else(|_| ProgressStyle::default_spinner()),
    );
    progress.enable_steady_tick(Duration::from_millis(100));
    progress
}

fn print(sample: &Sample, format: Output) -> anyhow::Result<()> {
    if format == Output::Json {
        for dfa in &sample.automata {
            output::line(json::write(&dfa.clone().into()).trim_end())?;
        }
        return Ok(());
    }
    let states = sample.automata.first().map_or(0, Dfa::size);
    let size = count(states, "state");
    let found = sample.automata.len();
    output::line(match (found, sample.complete) {
        (1, true) => format!("The smallest automaton has {size}, and no other has as few."),
        (_, true) => format!("The smallest automata have {size}: there are {found}."),
        (1, false) => format!("One of the smallest automata; they have {size}."),
        (_, false) => format!("{found} of the smallest automata; they have {size}."),
    })?;
    for dfa in &sample.automata {
        output::line("")?;
        table(dfa)?;
    }
    output::line("")?;
    output::line("> the state to start in   * accepting")
}

/// One row a state, one column a symbol.
fn table(dfa: &Dfa) -> anyhow::Result<()> {
    let digits = (dfa.size() - 1).to_string().len();
    let widths: Vec<usize> = (dfa.alphabet().names())
        .map(|name| name.len().max(digits))
        .collect();
    let cells = |cells: Vec<String>| {
        let mut line = String::new();
        for (cell, &width) in cells.iter().zip(&widths) {
            // Writing to a string cannot fail.
            let _ = write!(line, "  {cell:>width$}");
        }
        line
    };
    let names = cells(dfa.alphabet().names().map(str::to_owned).collect());
    output::line(format!("   {:digits$} |{names}", ""))?;
    for state in dfa.states() {
        let start = if state == dfa.start() { '>' } else { ' ' };
        let accepting = if dfa.is_accepting(state) { '*' } else { ' ' };
        let nexts = (dfa.alphabet().symbols()).map(|s| dfa.next(state, s).index().to_string());
        let nexts = cells(nexts.collect());
        let state = state.index();
        output::line(format!("{start}{accepting} {state:digits$} |{nexts}"))?;
    }
    Ok(())
}

/// Says why there is no automaton.
fn explain(failure: &Failure, lines: &[ItemLine], format: Output) -> anyhow::Result<()> {
    if format == Output::Json {
        let nothing = match failure {
            Failure::Contradiction(contradiction) => Nothing::Contradiction {
                lines: (contradiction.answers.iter())
                    .map(|answer| lines[answer.0 as usize].number)
                    .collect(),
                minimal: contradiction.minimal,
                max_states: match contradiction.cause {
                    Cause::Order | Cause::Equality | Cause::MemRep => None,
                    Cause::States { bound } => Some(bound),
                },
                cause: output::cause(contradiction.cause),
            },
            Failure::OverBudget { at_least } => Nothing::OverBudget {
                at_least: *at_least,
            },
        };
        return output::line(serde_json::to_string(&nothing)?);
    }
    match failure {
        Failure::Contradiction(contradiction) => name_lines(contradiction, lines),
        Failure::OverBudget { at_least } => output::line(format!(
            "The budget ended: an automaton needs {} or more. Give more steps by `--budget`.",
            count(*at_least, "state")
        )),
    }
}

fn name_lines(contradiction: &Contradiction, lines: &[ItemLine]) -> anyhow::Result<()> {
    output::line(match contradiction.cause {
        cause @ (Cause::Order | Cause::Equality | Cause::MemRep) => {
            format!(
                "No automaton of any size: these lines contradict each other. {}",
                output::because(cause, &output::AUTOMATA)
            )
        }
        Cause::States { bound } => format!(
            "No automaton with {} or fewer: these lines together need more. Raise `--max-states`, or drop one of them.",
            count(bound, "state")
        ),
    })?;
    for answer in &contradiction.answers {
        let line = &lines[answer.0 as usize];
        output::line(format!("  line {}: {}", line.number, line.text))?;
    }
    output::line(if contradiction.minimal {
        "Without any one of them, the others can hold."
    } else {
        "The budget ended before it was clear whether all of them are needed."
    })
}

/// A number with its noun.
fn count(number: usize, noun: &str) -> String {
    format!("{number} {noun}{}", if number == 1 { "" } else { "s" })
}
