//! Rules that are no automata, as files.

use automata::format::json::Provenance;
use serde::Serialize;
use serde_json::{Value, json};

use super::{Concept, Universe};

/// A learned concept as a file.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Saved<'a, C> {
    /// `memrep-monotone`, `memrep-finite` or `memrep-linear`.
    pub format: &'a str,
    /// Of the format.
    pub version: u32,
    /// What was taught.
    pub name: &'a str,
    /// The concept.
    pub concept: C,
    /// Where it comes from.
    pub provenance: Provenance,
}

impl Universe {
    /// A rule as a file.
    pub fn saved<'a>(
        &self,
        concept: &Concept,
        name: &'a str,
        provenance: Provenance,
    ) -> Saved<'a, Value> {
        let (format, written) = match (self, concept) {
            (Self::Monotone(axes), Concept::Parameter(most)) => (
                "memrep-monotone",
                json!({
                    "size": most.size(),
                    "parameter": most,
                    "limits": axes.values(most),
                    "axes": axes.axes(),
                }),
            ),
            (Self::Linear(rewards), Concept::Parameter(parameter)) => {
                let reward = rewards.reward(parameter);
                let concept = json!({
                    "size": parameter.size(),
                    "weights": reward.weights,
                    "threshold": reward.threshold,
                });
                ("memrep-linear", concept)
            }
            (Self::Finite(table), Concept::Named(named)) => {
                ("memrep-finite", json!(table.concept(*named)))
            }
            (_, other) => ("memrep-dfa", json!(self.rule(other))),
        };
        Saved {
            format,
            version: 1,
            name,
            concept: written,
            provenance,
        }
    }
}
