//! The automaton file: `memrep-dfa`, version 1.
//!
//! ```json
//! {"format":"memrep-dfa","version":1,"alphabet":["a","b"],"states":2,"start":0,"accepting":[1],"delta":[[1,0],[1,1]]}
//! ```
//!
//! `delta[state][symbol]` is the next state; every state has a row and every
//! row an entry for each symbol. `name` and `provenance` may be there too; any
//! other key is refused by its name, for it may carry a meaning that this
//! version does not know.

use serde::de::{Error as _, IgnoredAny};
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use serde_json::Value;

use super::ReadError;
use crate::{Alphabet, AlphabetError, Dfa, DfaError, StateId};

/// What every automaton file says in `format`.
const FORMAT: &str = "memrep-dfa";

/// The version that is written, and the only one that is read.
const VERSION: u64 = 1;

/// What to do about a file that is JSON but no automaton file.
const HINT: &str = r#"; an automaton file is of the form {"format":"memrep-dfa","version":1,"alphabet":["a"],"states":1,"start":0,"accepting":[],"delta":[[0]]}"#;

/// An automaton with its name and where it comes from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Document {
    /// The automaton.
    pub dfa: Dfa,
    /// What people call it.
    pub name: Option<String>,
    /// Where it comes from.
    pub provenance: Option<Provenance>,
}

/// Where an automaton comes from.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Provenance {
    /// The version of the program that made it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub version: Option<String>,
    /// The seed of its generator.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub seed: Option<u64>,
    /// The digest of the log of answers from which it was learned.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub digest: Option<String>,
}

impl From<Dfa> for Document {
    fn from(dfa: Dfa) -> Self {
        Self {
            dfa,
            name: None,
            provenance: None,
        }
    }
}

/// The file as it stands; keys are written in this order.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    format: String,
    version: u64,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    name: Option<String>,
    alphabet: Vec<String>,
    states: usize,
    start: usize,
    accepting: Vec<usize>,
    delta: Vec<Vec<usize>>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    provenance: Option<Provenance>,
}

/// Reads an automaton file.
///
/// # Errors
///
/// With line and column, and with the path of the field where a value makes no
/// automaton.
pub fn read(text: &str) -> Result<Document, ReadError> {
    // The version comes first: the keys of another one are not unknown, they
    // are another version's.
    let json = |error| ReadError::json(&error, HINT);
    expect_object(text, HINT)?;
    let header: Header = serde_json::from_str(text).map_err(json)?;
    header.check().map_err(|e| e.placed_in(text))?;
    // Read again from the text and not from a value, for the sake of places and of
    // memory.
    let file: File = serde_json::from_str(text).map_err(|e| ReadError::json(&e, HINT))?;
    Document::try_from(file).map_err(|e| e.placed_in(text))
}

/// Writes an automaton file: one line.
#[expect(clippy::missing_panics_doc, reason = "this can always be written")]
pub fn write(document: &Document) -> String {
    let file = File::from(document);
    let mut text = serde_json::to_string(&file).expect("strings and numbers are always JSON");
    text.push('\n');
    text
}

/// Refuses what is no JSON, or no object: an array would pass for one with its keys in
/// order. `hint` says what to do about it.
pub(super) fn expect_object(text: &str, hint: &str) -> Result<(), ReadError> {
    let read: Result<IgnoredAny, _> = serde_json::from_str(text);
    read.map_err(|e| ReadError::json(&e, hint))?;
    let found = match text.trim_start().bytes().next() {
        Some(b'{') => return Ok(()),
        Some(b'[') => "an array",
        Some(b'"') => "a string",
        Some(b'n') => "null",
        Some(b't' | b'f') => "true or false",
        _ => "a number",
    };
    let message = format!("expected an object, found {found}{hint}");
    Err(ReadError::at(1, 1, message))
}

/// What of a file says of which format and version it is.
#[derive(Deserialize)]
struct Header {
    #[serde(default, deserialize_with = "present")]
    format: Option<Value>,
    #[serde(default, deserialize_with = "present")]
    version: Option<Value>,
    provenance: Option<Value>,
}

/// Keeps a `null` that is there apart from a key that is not.
fn present<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<Value>, D::Error> {
    Value::deserialize(deserializer).map(Some)
}

impl Header {
    /// Of an object.
    fn of(value: &Value) -> Self {
        let key = |key: &str| value.get(key).cloned();
        Self {
            format: key("format"),
            version: key("version"),
            provenance: key("provenance"),
        }
    }

    /// Refuses what is not of this format and version.
    fn check(&self) -> Result<(), ReadError> {
        let missing = |key: &str| ReadError::field(key, format!("the key is missing{HINT}"));
        let format = self.format.as_ref().ok_or_else(|| missing("format"))?;
        if format != FORMAT {
            let message = format!("expected \"{FORMAT}\", found {format}{HINT}");
            return Err(ReadError::field("format", message));
        }
        let version = self.version.as_ref().ok_or_else(|| missing("version"))?;
        if version != VERSION {
            let message = format!(
                "expected {VERSION}, found {version}: another version of memrep wrote this file, convert it there"
            );
            return Err(ReadError::field("version", message));
        }
        match &self.provenance {
            Some(Value::Object(_) | Value::Null) | None => Ok(()),
            Some(other) => {
                let message = format!("expected an object, found {}", kind(other));
                Err(ReadError::field("provenance", message))
            }
        }
    }
}

/// What a JSON value is, for people.
fn kind(value: &Value) -> &'static str {
    match value {
        Value::Null => "null",
        Value::Bool(_) => "true or false",
        Value::Number(_) => "a number",
        Value::String(_) => "a string",
        Value::Array(_) => "an array",
        Value::Object(_) => "an object",
    }
}

/// The field in which a list of names is no alphabet.
pub(super) fn alphabet_error(error: &AlphabetError) -> ReadError {
    let path = match &error {
        AlphabetError::BadName { position, .. } => format!("alphabet[{position}]"),
        AlphabetError::Duplicate { second, .. } => format!("alphabet[{second}]"),
        AlphabetError::Empty | AlphabetError::TooLarge(_) => "alphabet".to_owned(),
    };
    ReadError::field(path, error.to_string())
}

/// The field in which a table is no automaton.
fn dfa_error(error: &DfaError) -> ReadError {
    let path = match error {
        DfaError::NoStates => "states".to_owned(),
        DfaError::BadStart { .. } => "start".to_owned(),
        DfaError::Rows { .. } | DfaError::Entries { .. } => "delta".to_owned(),
        DfaError::Columns { state, .. } => format!("delta[{state}]"),
        DfaError::BadTarget { state, symbol, .. } => format!("delta[{state}][{symbol}]"),
    };
    ReadError::field(path, error.to_string())
}

impl TryFrom<File> for Document {
    type Error = ReadError;

    fn try_from(file: File) -> Result<Self, ReadError> {
        let alphabet = Alphabet::new(file.alphabet).map_err(|e| alphabet_error(&e))?;
        // Before anything of this size is made: the number may be a slip.
        let (rows, states) = (file.delta.len(), file.states);
        if rows != states {
            return Err(dfa_error(&DfaError::Rows { rows, states }));
        }
        if states == 0 {
            return Err(dfa_error(&DfaError::NoStates));
        }
        let mut accepting = vec![false; states];
        for (place, &state) in file.accepting.iter().enumerate() {
            let path = format!("accepting[{place}]");
            let Some(accepts) = accepting.get_mut(state) else {
                let message = format!(
                    "state {state} does not exist: states are numbered from 0 to {}",
                    states - 1
                );
                return Err(ReadError::field(path, message));
            };
            if std::mem::replace(accepts, true) {
                let message = format!("state {state} stands twice: name it once");
                return Err(ReadError::field(path, message));
            }
        }
        let dfa =
            Dfa::new(alphabet, file.start, accepting, &file.delta).map_err(|e| dfa_error(&e))?;
        Ok(Self {
            dfa,
            name: file.name,
            provenance: file.provenance,
        })
    }
}

impl From<&Dfa> for File {
    fn from(dfa: &Dfa) -> Self {
        let row = |state| {
            let symbols = dfa.alphabet().symbols();
            symbols.map(|a| dfa.next(state, a).index()).collect()
        };
        let accepting = dfa.states().filter(|&q| dfa.is_accepting(q));
        Self {
            format: FORMAT.to_owned(),
            version: VERSION,
            name: None,
            alphabet: dfa.alphabet().names().map(str::to_owned).collect(),
            states: dfa.size(),
            start: dfa.start().index(),
            accepting: accepting.map(StateId::index).collect(),
            delta: dfa.states().map(row).collect(),
            provenance: None,
        }
    }
}

impl From<&Document> for File {
    fn from(document: &Document) -> Self {
        Self {
            name: document.name.clone(),
            provenance: document.provenance.clone(),
            ..Self::from(&document.dfa)
        }
    }
}

/// As the object of an automaton file.
impl Serialize for Dfa {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        File::from(self).serialize(serializer)
    }
}

/// From the object of an automaton file, whose name and provenance are left out.
impl<'de> Deserialize<'de> for Dfa {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let value = Value::deserialize(deserializer)?;
        if !value.is_object() {
            let message = format!("expected an object, found {}{HINT}", kind(&value));
            return Err(D::Error::custom(ReadError::at(1, 1, message)));
        }
        Header::of(&value).check().map_err(D::Error::custom)?;
        let file: File = serde_json::from_value(value).map_err(D::Error::custom)?;
        let document = Document::try_from(file).map_err(D::Error::custom)?;
        Ok(document.dfa)
    }
}
