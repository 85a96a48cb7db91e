//! What is known beforehand: rules by name or as automata, as they are written and read.

use std::path::Path;

use automata::format::{dot, json};
use automata::{Alphabet, Dfa};
use serde::Serialize;
use serde_json::Value;

use super::automaton::{Automaton, over};
use super::reader::{Faults, Fields, Malformed};
use super::situation::Files;
use crate::concept::{Prior, Template, TemplateError};

/// What is known beforehand, as it is written.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct PriorText {
    /// What holds whatever is learned.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub holds: Vec<Rule>,
    /// What suffices whatever is learned.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub suffices: Vec<Rule>,
}

impl PriorText {
    /// Whether nothing is known.
    pub fn is_empty(&self) -> bool {
        self.holds.is_empty() && self.suffices.is_empty()
    }
}

/// A rule: by name, or as an automaton.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
#[serde(untagged)]
pub enum Rule {
    /// As in `avoid X`.
    Named(String),
    /// An automaton.
    Automaton(Automaton),
}

impl Rule {
    /// The words that keep it.
    pub(super) fn dfa(&self, alphabet: &Alphabet) -> Result<Dfa, Malformed> {
        let fault = |error: &dyn std::fmt::Display| Malformed::new("prior", error.to_string());
        match self {
            Self::Named(text) => {
                let template = Template::parse(text, alphabet).map_err(|error| fault(&error))?;
                Ok(template.dfa(alphabet))
            }
            Self::Automaton(automaton) => automaton.read(alphabet).map_err(|error| fault(&error)),
        }
    }
}

/// The rule at `path`, with its automaton.
pub(super) fn read_rule(
    value: &Value,
    path: &str,
    alphabet: &Alphabet,
    files: Files<'_>,
) -> Result<(Rule, Dfa), Malformed> {
    let fault = |error: &dyn std::fmt::Display| Malformed::new(path, error.to_string());
    if let Some(table) = value.as_object() {
        let dfa = Automaton::inline(table, alphabet).map_err(|error| fault(&error))?;
        return Ok((Rule::Automaton(Automaton::of(&dfa)), dfa));
    }
    let Some(text) = value.as_str() else {
        return Err(fault(&"give a rule as a string, as in `avoid X`"));
    };
    match Template::parse(text, alphabet) {
        Ok(template) => Ok((Rule::Named(text.to_owned()), template.dfa(alphabet))),
        Err(error @ TemplateError::Form(_)) => {
            let named = Path::new(text);
            let (Some(extension), Files::In(_)) = (named.extension(), files) else {
                return Err(fault(&error));
            };
            let file = files.find(text, path)?;
            let content = std::fs::read_to_string(&file).map_err(|error| {
                fault(&format!(
                    "{}: cannot read it, name a file as seen from the task: {error}",
                    file.display()
                ))
            })?;
            let dfa = if extension == "dot" || extension == "gv" {
                dot::read(&content).map_err(|error| error.to_string())
            } else {
                (json::read(&content).map(|document| document.dfa)).map_err(|e| e.to_string())
            };
            let dfa = dfa.map_err(|error| fault(&format!("{}: {error}", file.display())))?;
            let dfa = over(dfa, alphabet).map_err(|error| fault(&error))?;
            Ok((Rule::Automaton(Automaton::of(&dfa)), dfa))
        }
        Err(error) => Err(fault(&error)),
    }
}

/// What stands under `prior`.
pub(super) fn read(
    fields: &Fields<'_>,
    alphabet: &Alphabet,
    files: Files<'_>,
    faults: &mut Faults,
) -> Option<(PriorText, Prior)> {
    let Some(value) = fields.get("prior") else {
        return Some((PriorText::default(), Prior::none(alphabet)));
    };
    let fields = faults.keep(Fields::of(value, "prior"))?;
    let before = faults.0.len();
    faults.0.extend(fields.unknown(&["holds", "suffices"]));
    let mut rules = |key: &str| -> (Vec<Rule>, Vec<Dfa>) {
        let list = faults.keep(fields.list(key)).unwrap_or_default();
        let read = list.iter().enumerate().filter_map(|(i, rule)| {
            let path = format!("{}[{i}]", fields.path_of(key));
            faults.keep(read_rule(rule, &path, alphabet, files))
        });
        read.unzip()
    };
    let (holds, holding) = rules("holds");
    let (suffices, sufficing) = rules("suffices");
    if faults.0.len() > before {
        return None;
    }
    let prior = Prior::new(alphabet, holding, sufficing)
        .map_err(|error| Malformed::new("prior", error.to_string()));
    Some((PriorText { holds, suffices }, faults.keep(prior)?))
}
