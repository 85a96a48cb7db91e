//! The files in which automata and samples are kept: one module a format.
//!
//! | module | holds | read | write |
//! |---|---|---|---|
//! | [`json`] | an automaton, with its name and where it comes from | yes | yes |
//! | [`dot`] | an automaton, for programs: `AALpy`, `AutomataLib` | yes | yes |
//! | [`dot_people`] | an automaton, for people: Graphviz | no | yes |
//! | [`hoa`] | an automaton, for tools of ω-automata: Spot, Owl | no | yes |
//! | [`abbadingo`] | labelled words | yes | yes |
//! | [`jsonl`] | labelled words and preferences | yes | yes |
//!
//! What a module writes and reads, it reads back equal. A format that cannot
//! say something refuses to write it, with a [`WriteError`] that tells the way
//! out; [`abbadingo`] alone forgets one thing, the names of symbols.

pub mod abbadingo;
pub mod dot;
pub mod dot_people;
pub mod hoa;
pub mod json;
pub mod jsonl;
mod locate;

use std::fmt;

pub use locate::locate;

/// Why a text is not of the format: where, what was expected, what was found.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ReadError {
    line: Option<usize>,
    column: Option<usize>,
    field: Option<String>,
    message: String,
}

impl ReadError {
    /// At a place in the text; both numbers from 1.
    pub(crate) fn at(line: usize, column: usize, message: impl Into<String>) -> Self {
        Self {
            line: Some(line),
            column: Some(column),
            field: None,
            message: message.into(),
        }
    }

    /// In a field of a JSON value, named by its path: `delta[2][0]`.
    pub(crate) fn field(path: impl Into<String>, message: impl Into<String>) -> Self {
        Self {
            line: None,
            column: None,
            field: Some(path.into()),
            message: message.into(),
        }
    }

    /// Where `serde_json` stopped, in words for people who know JSON but not
    /// Rust, followed by `hint` where the text is JSON of another form.
    pub(crate) fn json(error: &serde_json::Error, hint: &str) -> Self {
        let text = error.to_string();
        let place = format!(" at line {} column {}", error.line(), error.column());
        let mut message = text
            .strip_suffix(&place)
            .unwrap_or(&text)
            .replace("expected usize", "expected a whole number, 0 or more")
            .replace("expected u64", "expected a whole number, 0 or more")
            .replace("expected a sequence", "expected an array")
            .replace("EOF while parsing", "the text ends within")
            .replace("trailing characters", "expected the end, found more");
        if message.starts_with("unknown field") {
            message.push_str("; remove it");
        } else if error.is_data() {
            message.push_str(hint);
        } else if error.is_eof() {
            message.push_str(": it is cut short");
        }
        Self::at(error.line().max(1), error.column().max(1), message)
    }

    /// The same error, on a line of a file whose lines are read one by one.
    #[must_use]
    pub(crate) fn on_line(mut self, line: usize) -> Self {
        self.line = Some(line);
        self
    }

    /// The same error, with the place of its field in this JSON text.
    #[must_use]
    pub(crate) fn placed_in(mut self, text: &str) -> Self {
        if let (Some(path), None) = (&self.field, self.column) {
            let (line, column) = locate::place(text, locate(text, path));
            self.line = self.line.or(Some(line));
            self.column = Some(column);
        }
        self
    }

    /// The line, from 1, where the format has lines.
    pub fn line(&self) -> Option<usize> {
        self.line
    }

    /// The column in its line, from 1: bytes in JSON, characters elsewhere.
    pub fn column(&self) -> Option<usize> {
        self.column
    }

    /// The path of the field in its JSON value: `delta[2][0]`.
    pub fn path(&self) -> Option<&str> {
        self.field.as_deref()
    }

    /// What was expected and what was found, without the place.
    pub fn message(&self) -> &str {
        &self.message
    }
}

impl fmt::Display for ReadError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(line) = self.line {
            write!(f, "line {line}")?;
            if let Some(column) = self.column {
                write!(f, ", column {column}")?;
            }
            f.write_str(if self.field.is_some() { ", " } else { ": " })?;
        }
        if let Some(field) = &self.field {
            write!(f, "`{field}`: ")?;
        }
        f.write_str(&self.message)
    }
}

impl std::error::Error for ReadError {}

/// Why something cannot be written in a format.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum WriteError {
    /// Abbadingo has labels only.
    #[error(
        "item {item} is a preference, and the Abbadingo format has labelled words only: write JSONL instead"
    )]
    Preference {
        /// The item's place in the sample, from 1.
        item: usize,
    },
    /// Readers of DOT take names of digits for numbers.
    #[error(
        "symbols `{first}` and `{second}` are the same number to the programs that read this dialect of DOT: rename one, or write JSON instead"
    )]
    SameNumber {
        /// One symbol's name.
        first: String,
        /// The other's.
        second: String,
    },
    /// HOA names all symbols on every edge.
    #[error(
        "the alphabet has {symbols} symbols, and the HOA writer stops at {max}: every symbol becomes a proposition that every edge names; write JSON instead"
    )]
    TooManySymbols {
        /// The number of symbols.
        symbols: usize,
        /// The largest number that is written.
        max: usize,
    },
}
