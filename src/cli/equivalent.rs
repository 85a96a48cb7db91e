//! `memrep equivalent`: whether two automata accept the same words, and the
//! shortest word on which they differ.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::{anyhow, ensure};
use serde::Serialize;

use super::files::{self, Format};
use super::output::{self, Output};

/// Arguments of `memrep equivalent`.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:
  memrep equivalent task.json learned.dot
  memrep equivalent a.json b.json --format json
    {\"equivalent\":false,\"word\":[\"a\",\"b\"],\"accepted_by\":\"first\"}

Exit status: 0 if the languages are equal, 1 if they differ, 2 if a file or the
arguments are at fault. Symbols go by their names, in whatever order.")]
pub(crate) struct Args {
    /// An automaton (json or dot); `-` is the standard input.
    #[arg(value_name = "A")]
    first: PathBuf,
    /// Another automaton over the same symbols.
    #[arg(value_name = "B")]
    second: PathBuf,
    /// The format of both files, where their extensions do not tell.
    #[arg(long, value_name = "FORMAT")]
    from: Option<Format>,
    /// How to print the answer.
    #[arg(long, value_name = "FORMAT", default_value = "text")]
    format: Output,
}

/// The answer for programs.
#[derive(Serialize)]
struct Answer<'a> {
    equivalent: bool,
    #[serde(skip_serializing_if = "Option::is_none")]
    word: Option<Vec<&'a str>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    accepted_by: Option<&'static str>,
}

/// Runs the command.
pub(crate) fn run(args: &Args) -> anyhow::Result<ExitCode> {
    let both_piped = [&args.first, &args.second]
        .iter()
        .all(|path| path.as_path() == Path::new("-"));
    ensure!(
        !both_piped,
        "the standard input holds one automaton: name a file for A or B"
    );
    let first = files::read_automaton(&args.first, args.from)?.dfa;
    let second = files::read_automaton(&args.second, args.from)?.dfa;
    let alphabet = first.alphabet();
    let difference = second
        .reordered(alphabet)
        .and_then(|second| first.shortest_difference(&second))
        .map_err(|_| {
            anyhow!(
                "{} has the symbols {alphabet} and {} has {}: give each an edge for every symbol of the other to compare them",
                args.first.display(),
                args.second.display(),
                second.alphabet()
            )
        })?;
    let accepted_by_first = difference.as_ref().map(|word| first.accepts(word));
    match args.format {
        Output::Json => {
            let answer = Answer {
                equivalent: difference.is_none(),
                word: difference.as_ref().map(|w| alphabet.spell(w).collect()),
                accepted_by: accepted_by_first.map(|yes| if yes { "first" } else { "second" }),
            };
            output::line(serde_json::to_string(&answer)?)?;
        }
        Output::Text => match difference.as_ref().zip(accepted_by_first) {
            None => output::line("equivalent: both accept the same words")?,
            Some((word, by_first)) => {
                let path = if by_first { &args.first } else { &args.second };
                output::line(format!(
                    "different: {} is accepted by {} only",
                    output::spelled(alphabet, word),
                    path.display()
                ))?;
            }
        },
    }
    Ok(if difference.is_none() {
        ExitCode::SUCCESS
    } else {
        ExitCode::from(1)
    })
}
