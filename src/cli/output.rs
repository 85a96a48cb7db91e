//! What commands print on the standard output: words for people, or one JSON
//! object a line for programs.

use std::io::Write as _;

use anyhow::Context as _;
use automata::{Alphabet, Word};
use clap::ValueEnum;

/// For whom a command prints.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(crate) enum Output {
    /// For people.
    #[default]
    Text,
    /// For programs: one JSON object a line.
    Json,
}

/// Prints a line.
///
/// Unlike `println!` it reports a closed pipe instead of panicking.
pub(crate) fn line(text: impl std::fmt::Display) -> anyhow::Result<()> {
    writeln!(std::io::stdout(), "{text}").context("the standard output: cannot write to it")
}

/// A word for people: its symbols with spaces between.
pub(crate) fn spelled(alphabet: &Alphabet, word: &Word) -> String {
    if word.is_empty() {
        return "the empty word".to_owned();
    }
    let symbols: Vec<&str> = alphabet.spell(word).collect();
    format!("`{}`", symbols.join(" "))
}
