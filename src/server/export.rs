//! The forms in which a learned automaton can be taken away.

use automata::Dfa;
use automata::format::{dot, dot_people, hoa, json};

use super::error::WebError;
use crate::draw::{self, Captions, Marks};
use crate::session::{Concept, Malformed, Task, Universe};

/// A file format for automata.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Format {
    /// The automaton file.
    Json,
    /// DOT for programs.
    Dot,
    /// DOT for people.
    DotPeople,
    /// HOA.
    Hoa,
    /// A drawing.
    Svg,
}

/// What the result page offers: format, title, what it is for.
pub(crate) const OFFERED: [(Format, &str, &str); 5] = [
    (
        Format::Json,
        "JSON",
        "the automaton, for programs and for memrep itself",
    ),
    (Format::Svg, "SVG", "the drawing"),
    (Format::Dot, "DOT", "for AALpy, AutomataLib and LearnLib"),
    (
        Format::DotPeople,
        "DOT for people",
        "the drawing, for Graphviz",
    ),
    (Format::Hoa, "HOA", "for Spot, Owl and PRISM"),
];

impl Format {
    /// The format of this name.
    pub(crate) fn named(name: &str) -> Result<Self, Malformed> {
        OFFERED
            .iter()
            .map(|&(format, ..)| format)
            .find(|format| format.name() == name)
            .ok_or_else(|| {
                let names: Vec<&str> = OFFERED.iter().map(|(format, ..)| format.name()).collect();
                Malformed::new(
                    "format",
                    format!(
                        "there is no format `{name}`: give one of {}",
                        names.join(", ")
                    ),
                )
            })
    }

    /// Its name in the API.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Json => "json",
            Self::Dot => "dot",
            Self::DotPeople => "dot-people",
            Self::Hoa => "hoa",
            Self::Svg => "svg",
        }
    }

    /// The end of a file's name, which tells formats apart.
    pub(crate) fn extension(self) -> &'static str {
        match self {
            Self::DotPeople => "people.dot",
            other => other.name(),
        }
    }

    /// The media type.
    pub(crate) fn media_type(self) -> &'static str {
        match self {
            Self::Json => "application/json",
            Self::Dot | Self::DotPeople => "text/vnd.graphviz; charset=utf-8",
            Self::Hoa => "text/plain; charset=utf-8",
            Self::Svg => "image/svg+xml",
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
pub(crate) fn write(dfa: &Dfa, task: &Task, format: Format) -> Result<String, WebError> {
    let cannot = |error: &dyn std::fmt::Display| WebError::TooLargeToShow(error.to_string());
    match format {
        Format::Json => Ok(json::write(&json::Document {
            dfa: dfa.clone(),
            name: Some(task.title.clone()),
            provenance: Some(json::Provenance {
                version: Some(env!("CARGO_PKG_VERSION").to_owned()),
                ..json::Provenance::default()
            }),
        })),
        Format::Dot => dot::write(dfa).map_err(|e| cannot(&e)),
        Format::DotPeople => Ok(dot_people::write(dfa)),
        Format::Hoa => hoa::write(dfa).map_err(|e| cannot(&e)),
        Format::Svg => draw::document(dfa, &captions(task)).map_err(|error| {
            let remedy = "which the session's page has, or Graphviz with `format=dot-people`";
            WebError::TooLargeToShow(format!("{error}, {remedy}"))
        }),
    }
}

/// The rule as JSON, in the form of its class.
pub(crate) fn concept(
    concept: &Concept,
    universe: &Universe,
    task: &Task,
) -> Result<String, WebError> {
    if let Concept::Automaton(dfa) = concept {
        return write(dfa, task, Format::Json);
    }
    let provenance = json::Provenance {
        version: Some(env!("CARGO_PKG_VERSION").to_owned()),
        ..json::Provenance::default()
    };
    let saved = universe.saved(concept, &task.title, provenance);
    let text = serde_json::to_string(&saved).map_err(WebError::internal)?;
    Ok(format!("{text}\n"))
}

/// The drawing to be put into a page; `None` where it would be unreadable.
pub(crate) fn drawing(dfa: &Dfa, task: &Task, marks: &Marks) -> Option<String> {
    draw::svg(dfa, &captions(task), marks).ok()
}

/// The words of a drawing.
pub(crate) fn captions(task: &Task) -> Captions {
    Captions {
        title: Some(task.title.clone()),
        words: task
            .symbols
            .iter()
            .filter_map(|symbol| Some((symbol.name.clone(), symbol.word.clone()?)))
            .collect(),
        phrases: true,
    }
}
