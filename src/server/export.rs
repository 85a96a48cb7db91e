//! The forms in which a learned automaton can be taken away.

use automata::Dfa;

use super::error::WebError;
use crate::session::{Automaton, Malformed, Task};

/// A file format for automata.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Format {
    /// The automaton file.
    Json,
}

impl Format {
    /// The format of this name.
    pub(crate) fn named(name: &str) -> Result<Self, Malformed> {
        match name {
            "json" => Ok(Self::Json),
            _ => Err(Malformed::new(
                "format",
                format!("there is no format `{name}`: give `json`"),
            )),
        }
    }

    /// The usual end of a file's name.
    pub(crate) fn extension(self) -> &'static str {
        match self {
            Self::Json => "json",
        }
    }

    /// The media type.
    pub(crate) fn media_type(self) -> &'static str {
        match self {
            Self::Json => "application/json",
        }
    }
}

/// A name for a download, of harmless characters only.
pub(crate) fn file_name(task: &Task, extension: &str) -> String {
    let stem: String = task
        .name
        .chars()
        .map(|c| if c.is_ascii_alphanumeric() { c } else { '-' })
        .collect();
    format!("{stem}.{extension}")
}

/// The automaton in this format.
pub(crate) fn write(dfa: &Dfa, _task: &Task, format: Format) -> Result<String, WebError> {
    match format {
        Format::Json => serde_json::to_string(&Automaton::of(dfa)).map_err(WebError::internal),
    }
}
