//! `memrep convert`: an automaton or a sample in another format.

use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::Context as _;
use automata::Alphabet;

use super::files::{self, Content, Format};
use super::output;

/// Arguments of `memrep convert`.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:
  memrep convert task.json task.dot                     for AALpy or AutomataLib
  memrep convert task.json task.svg
  memrep convert task.json - --to dot-people | dot -Tpng -o task.png
  memrep convert learned.dot task.json
  memrep convert words.abb words.jsonl
  memrep convert - words.abb --from jsonl < answers.txt

Exit status: 0 if OUT was written, 2 if IN or the arguments are at fault.")]
pub(crate) struct Args {
    /// The file to read; `-` is the standard input.
    #[arg(value_name = "IN")]
    input: PathBuf,
    /// The file to write; `-` is the standard output.
    #[arg(value_name = "OUT")]
    output: PathBuf,
    /// The format of IN, where its extension does not tell.
    #[arg(long, value_name = "FORMAT")]
    from: Option<Format>,
    /// The format of OUT, where its extension does not tell.
    #[arg(long, value_name = "FORMAT")]
    to: Option<Format>,
}

/// Runs the command.
pub(crate) fn run(args: &Args) -> anyhow::Result<ExitCode> {
    let format = Format::choose(args.to, &args.output, "--to")?;
    let content = files::read(&args.input, args.from)?;
    let text = files::render(&content, format)
        .with_context(|| format!("cannot write {}", args.output.display()))?;
    files::write(&args.output, &text)?;
    if let (Content::Sample(sample), Format::Abb) = (&content, format) {
        note_lost_names(sample.alphabet());
    }
    Ok(ExitCode::SUCCESS)
}

/// Says which number stands for which symbol, unless that is its name.
fn note_lost_names(alphabet: &Alphabet) {
    let names = || alphabet.names().enumerate();
    if names().any(|(place, name)| name != place.to_string()) {
        let table: Vec<String> = names()
            .map(|(place, name)| format!("{place} = {name}"))
            .collect();
        output::note(format_args!(
            "note: Abbadingo has no names of symbols, keep these: {}",
            table.join(", ")
        ));
    }
}
