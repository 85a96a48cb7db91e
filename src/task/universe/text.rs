//! Behaviours and rules as they are written.

use serde::{Deserialize, Serialize};
use serde_json::Value;

use crate::task::Automaton;

/// A behaviour, under a key that says what it is: `{"word":["a","b"]}`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum AtomText {
    /// The names of symbols, in order.
    Word(Vec<String>),
    /// One number an axis, in the units of the axes.
    Point(Vec<f64>),
    /// The name of a behaviour.
    Item(String),
}

impl AtomText {
    /// The same without its key: `["a","b"]`.
    pub fn bare(&self) -> Value {
        match self {
            Self::Word(names) => names.as_slice().into(),
            Self::Point(values) => values.as_slice().into(),
            Self::Item(name) => name.as_str().into(),
        }
    }
}

/// The same without its key, for [`serde`]'s `with`: `["a","b"]`.
#[derive(Serialize, Deserialize)]
#[serde(remote = "AtomText", untagged)]
pub(crate) enum Bare {
    Word(Vec<String>),
    Point(Vec<f64>),
    Item(String),
}

/// A rule.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum ConceptText {
    /// Acceptable is what is no worse than this on any axis.
    Limits {
        /// One number an axis, in the units of the axes.
        limits: Vec<f64>,
    },
    /// Acceptable is what has a summed reward above the threshold (Eq. 5.7).
    Reward {
        /// One weight a feature, from −1 to 1.
        weights: Vec<f64>,
        /// The threshold.
        threshold: f64,
    },
    /// A concept of a table.
    Named {
        /// What the table calls it.
        concept: String,
    },
    /// An automaton, as in the automaton file. The last: its text may be anything.
    Automaton(Automaton),
}
