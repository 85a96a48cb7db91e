//! Reads a pool from JSON lines, as they come.
//!
//! ```json
//! {"id":"run-1","word":["a","b"],"complete":true,"media":{"kind":"video","path":"run-1.mp4"}}
//! {"id":"run-2","word":["a"],"complete":false,"media":{"kind":"frames","paths":["2/0.png","2/1.png"]}}
//! {"id":"run-3","word":[],"media":{"kind":"cells","cells":[[0,0],[0,1]]}}
//! ```
//!
//! `complete` is `true` where it is left out, and `media` may be left out: then
//! the word is shown. Empty lines are passed over.

use std::collections::HashMap;
use std::fmt;
use std::io::Read;

use automata::format::locate;
use automata::{Alphabet, Symbol, Word};
use serde::Deserialize;
use serde_json::Value;

use super::{LONGEST_RECORDING, MOST_RECORDINGS, Media, Pool, Recording};

/// The longest line, in bytes.
const LONGEST_LINE: usize = 1 << 20;
/// The longest name of a recording, in bytes.
const LONGEST_ID: usize = 200;
/// Nodes that a tree of words may have in all: what fits into memory.
const MOST_SYMBOLS: usize = 20_000_000;
/// Read at a time.
const PIECE: usize = 1 << 16;

const EXAMPLE: &str = r#"{"id":"run-1","word":["a","b"],"complete":true}"#;

/// Why there is no pool: where in the file, and what to do.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PoolError {
    /// The line, from 1; none where the file cannot be read at all.
    pub line: Option<usize>,
    /// The column in the line, in bytes from 1.
    pub column: Option<usize>,
    /// The path of the field: `word[3]`.
    pub field: Option<String>,
    /// What is wrong, and what is expected.
    pub message: String,
}

impl PoolError {
    fn whole(message: impl Into<String>) -> Self {
        Self {
            line: None,
            column: None,
            field: None,
            message: message.into(),
        }
    }

    fn field(field: impl Into<String>, message: impl Into<String>) -> Self {
        Self {
            field: Some(field.into()),
            ..Self::whole(message)
        }
    }
}

impl fmt::Display for PoolError {
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

impl std::error::Error for PoolError {}

/// One line.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Line {
    id: String,
    word: Vec<String>,
    #[serde(default = "is_complete")]
    complete: bool,
    #[serde(default)]
    media: Option<Value>,
}

fn is_complete() -> bool {
    true
}

/// Takes a file piece by piece, and holds no more of it than its recordings and
/// the line that is not complete yet.
#[derive(Debug)]
pub struct PoolReader {
    alphabet: Alphabet,
    symbols: HashMap<String, Symbol>,
    recordings: Vec<Recording>,
    /// The line of every name.
    ids: HashMap<String, usize>,
    lengths: usize,
    line: usize,
    rest: Vec<u8>,
}

impl PoolReader {
    /// A reader of words over this alphabet.
    pub fn new(alphabet: Alphabet) -> Self {
        let symbols = alphabet.symbols();
        let named = symbols.map(|symbol| (alphabet.name(symbol).to_owned(), symbol));
        Self {
            symbols: named.collect(),
            alphabet,
            recordings: Vec::new(),
            ids: HashMap::new(),
            lengths: 0,
            line: 0,
            rest: Vec::new(),
        }
    }

    /// Reads a whole file.
    ///
    /// # Errors
    ///
    /// As [`Self::feed`] and [`Self::finish`], or if the file cannot be read.
    pub fn read(alphabet: Alphabet, mut file: impl Read) -> Result<Pool, PoolError> {
        let mut reader = Self::new(alphabet);
        let mut piece = vec![0; PIECE];
        loop {
            let read = file.read(&mut piece).map_err(|error| {
                PoolError::whole(format!("the recordings cannot be read: {error}"))
            })?;
            if read == 0 {
                return reader.finish();
            }
            reader.feed(&piece[..read])?;
        }
    }

    /// Takes the next piece of the file.
    ///
    /// # Errors
    ///
    /// Names the first line that is no recording of this pool; nothing more may
    /// be fed then.
    pub fn feed(&mut self, piece: &[u8]) -> Result<(), PoolError> {
        let mut pieces = piece.split(|byte| *byte == b'\n');
        let last = pieces.next_back().unwrap_or_default();
        for end in pieces {
            self.hold(end)?;
            let line = std::mem::take(&mut self.rest);
            self.line(&line)?;
            // The room that it took serves the next line.
            self.rest = line;
            self.rest.clear();
        }
        self.hold(last)
    }

    /// Ends the file.
    ///
    /// # Errors
    ///
    /// As [`Self::feed`] for its last line, or if there is no recording at all.
    pub fn finish(mut self) -> Result<Pool, PoolError> {
        let line = std::mem::take(&mut self.rest);
        self.line(&line)?;
        if self.recordings.is_empty() {
            let message = format!("there is no recording: give at least one line like {EXAMPLE}");
            return Err(PoolError {
                line: Some(1),
                column: Some(1),
                ..PoolError::whole(message)
            });
        }
        Ok(Pool::new(self.alphabet, self.recordings))
    }

    /// Keeps a part of a line.
    fn hold(&mut self, part: &[u8]) -> Result<(), PoolError> {
        if self.rest.len() + part.len() > LONGEST_LINE {
            return Err(PoolError {
                line: Some(self.line + 1),
                column: Some(LONGEST_LINE + 1),
                ..PoolError::whole(format!(
                    "the line is longer than {LONGEST_LINE} bytes: write one recording a line, and media as paths"
                ))
            });
        }
        self.rest.extend_from_slice(part);
        Ok(())
    }

    fn line(&mut self, line: &[u8]) -> Result<(), PoolError> {
        self.line += 1;
        if line.trim_ascii().is_empty() {
            return Ok(());
        }
        let recording = self.recording(line).map_err(|error| PoolError {
            line: Some(self.line),
            column: error.column.or_else(|| Some(column_of(line, &error))),
            ..error
        })?;
        self.recordings.push(recording);
        Ok(())
    }

    fn recording(&mut self, line: &[u8]) -> Result<Recording, PoolError> {
        if line.trim_ascii_start().first() != Some(&b'{') {
            let message = format!("expected an object like {EXAMPLE}");
            return Err(PoolError::whole(message));
        }
        let line: Line = serde_json::from_slice(line).map_err(|error| not_json(&error))?;
        if line.id.is_empty() || line.id.len() > LONGEST_ID {
            let message = format!(
                "the name has {} bytes: give 1 to {LONGEST_ID}",
                line.id.len()
            );
            return Err(PoolError::field("id", message));
        }
        if let Some(first) = self.ids.get(&line.id) {
            let message = format!(
                "`{}` is the name of line {first} already: give every recording its own",
                line.id
            );
            return Err(PoolError::field("id", message));
        }
        let word = self.word(&line.word)?;
        let media = line.media.map(media).transpose()?;
        self.lengths += word.len();
        if self.recordings.len() >= MOST_RECORDINGS || self.lengths > MOST_SYMBOLS {
            let message = format!(
                "these are too many recordings: give at most {MOST_RECORDINGS}, with {MOST_SYMBOLS} symbols in all"
            );
            return Err(PoolError::whole(message));
        }
        self.ids.insert(line.id.clone(), self.line);
        Ok(Recording {
            id: line.id,
            word,
            complete: line.complete,
            media,
            line: self.line,
        })
    }

    fn word(&self, names: &[String]) -> Result<Word, PoolError> {
        if names.len() > LONGEST_RECORDING {
            let message = format!(
                "the word has {} symbols: give at most {LONGEST_RECORDING}",
                names.len()
            );
            return Err(PoolError::field("word", message));
        }
        let symbols = names.iter().enumerate().map(|(place, name)| {
            self.symbols.get(name).copied().ok_or_else(|| {
                let message = format!(
                    "expected a symbol of the alphabet {}, found {name:?}",
                    self.alphabet
                );
                PoolError::field(format!("word[{place}]"), message)
            })
        });
        symbols.collect()
    }
}

/// Where in its line the field stands that is at fault.
fn column_of(line: &[u8], error: &PoolError) -> usize {
    let text = std::str::from_utf8(line).unwrap_or_default();
    locate(text, error.field.as_deref().unwrap_or_default()) + 1
}

fn media(value: Value) -> Result<Media, PoolError> {
    let media = Media::deserialize(value).map_err(|error| {
        let message = format!(
            r#"{error}; media is {{"kind":"frames","paths":[…]}}, {{"kind":"animation","path":…}}, {{"kind":"video","path":…}} or {{"kind":"cells","cells":[[0,0],…]}}"#
        );
        PoolError::field("media", message)
    })?;
    media
        .check()
        .map_err(|error| PoolError::field(error.field, error.message))?;
    Ok(media)
}

/// Where and why a line is no recording.
fn not_json(error: &serde_json::Error) -> PoolError {
    let text = error.to_string();
    let place = format!(" at line {} column {}", error.line(), error.column());
    let text = text.strip_suffix(&place).unwrap_or(&text);
    PoolError {
        column: Some(error.column().max(1)),
        ..PoolError::whole(format!("{text}: expected an object like {EXAMPLE}"))
    }
}
