//! What commands print on the standard output: words for people, or one JSON
//! object a line for programs.

use std::fmt::Display;
use std::io::Write as _;

use anyhow::Context as _;
use automata::{Alphabet, Word};
use clap::ValueEnum;

use crate::identify::Cause;

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
pub(crate) fn line(text: impl Display) -> anyhow::Result<()> {
    writeln!(std::io::stdout(), "{text}").context("the standard output: cannot write to it")
}

/// Prints a line about what is done: it stays done where that cannot be printed, which
/// is told instead.
#[cfg(feature = "server")]
pub(crate) fn done(text: impl Display) {
    if let Err(error) = line(text) {
        note(format_args!("it is done, but {error:#}"));
    }
}

/// Tells people something beside the result, on the standard error.
///
/// Unlike `eprintln!` it does not panic where nobody reads that: what was to be done is
/// done all the same.
pub(crate) fn note(text: impl Display) {
    let _ = writeln!(std::io::stderr(), "{text}");
}

/// Whether a command failed because nobody reads its standard output any more.
pub(crate) fn is_closed(error: &anyhow::Error) -> bool {
    let causes = error
        .chain()
        .filter_map(|cause| cause.downcast_ref::<std::io::Error>());
    causes
        .map(std::io::Error::kind)
        .any(|kind| kind == std::io::ErrorKind::BrokenPipe)
}

/// So many of something, for people: "1 state", "2 states".
pub(crate) fn counted(
    number: impl Copy + Display + PartialEq + From<u8>,
    one: &str,
    more: &str,
) -> String {
    let name = if number == 1.into() { one } else { more };
    format!("{number} {name}")
}

/// A word for people: its symbols with spaces between.
pub(crate) fn spelled(alphabet: &Alphabet, word: &Word) -> String {
    if word.is_empty() {
        return "the empty word".to_owned();
    }
    let symbols: Vec<&str> = alphabet.spell(word).collect();
    format!("`{}`", symbols.join(" "))
}

/// A cause's name for programs.
pub(crate) fn cause(cause: Cause) -> &'static str {
    match cause {
        Cause::Order => "order",
        Cause::Equality => "equality",
        Cause::MemRep => "membership",
        Cause::States { .. } => "states",
    }
}

/// What the atoms and concepts of a class are called.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Nouns {
    /// The key of an atom in JSON lines.
    pub(crate) key: Key,
    /// One atom.
    pub(crate) atom: &'static str,
    /// Several atoms.
    pub(crate) atoms: &'static str,
    /// One concept, without its article.
    pub(crate) concept: &'static str,
}

/// The key of an atom in JSON lines.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Key {
    Word,
    Atom,
}

/// Those of automata.
pub(crate) const AUTOMATA: Nouns = Nouns {
    key: Key::Word,
    atom: "word",
    atoms: "words",
    concept: "automaton",
};

/// Those of any other class, where it has none of its own.
pub(crate) const CONCEPTS: Nouns = Nouns {
    key: Key::Atom,
    atom: "behaviour",
    atoms: "behaviours",
    concept: "concept",
};

/// Why answers, "they", cannot stand together.
pub(crate) fn because(cause: Cause, nouns: &Nouns) -> String {
    match cause {
        Cause::Order => "Followed round, they say that something is better than itself.".to_owned(),
        Cause::Equality => format!(
            "They say of the same two {} that they are equally good, and that one is better.",
            nouns.atoms
        ),
        Cause::MemRep => format!(
            "They accept a {} that is no better than one that they reject.",
            nouns.atom
        ),
        Cause::States { bound } if nouns.key == Key::Atom => {
            format!("No concept of size {bound} or less fits them.")
        }
        Cause::States { bound: 1 } => "No automaton with 1 state fits them.".to_owned(),
        Cause::States { bound } => {
            format!("No automaton with {bound} states or fewer fits them.")
        }
    }
}
