//! What a learner is told at its start.

use serde::{Deserialize, Serialize};

use super::Conformance;

/// How questions are chosen.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Strategy {
    /// A posterior over concepts of several sizes, and the question that is
    /// worth most for its cost.
    Bayes,
    /// The same posterior, and EXP4 over its best question of each kind with two
    /// more experts, who know what the posterior expects of these.
    #[serde(rename = "exp4+")]
    Exp4Plus,
    /// Algorithms 4 to 6 as written.
    Thesis,
    /// The same without comparisons.
    Membership,
}

impl Strategy {
    /// Whether the likeliest concept of several sizes is shown when that is worth
    /// it, and not the last of the smallest size.
    pub(super) fn has_posterior(self) -> bool {
        matches!(self, Self::Bayes | Self::Exp4Plus)
    }
}

/// What a learner is told once, at its start.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Config {
    /// How questions are chosen.
    pub strategy: Strategy,
    /// The cost `a` of a membership query (Eq. 5.2), positive and finite.
    pub membership_cost: f64,
    /// The cost `b` of a comparison (Eq. 5.2), positive; infinite: never asked.
    pub comparison_cost: f64,
    /// The cost of an equivalence query, zero or more and finite. Only
    /// [`Strategy::Bayes`] and [`Strategy::Exp4Plus`] weigh it; the others ask when
    /// one concept is left.
    pub equivalence_cost: f64,
    /// Whether the teacher promises that no counterexample could be shorter, so
    /// that every simpler atom has the label that the hypothesis gives it.
    pub shortest_counterexamples: bool,
    /// Whether answers may be wrong, so that they are evidence and no facts; only
    /// [`Strategy::Bayes`] can do that.
    pub robust: bool,
    /// What is to be claimed at the end; none: the teacher's agreement is enough.
    #[serde(default)]
    pub conformance: Option<Conformance>,
    /// Decides every random choice.
    pub seed: u64,
    /// The work that choosing one question may do.
    pub budget: u64,
}

/// An equivalence query costs as much as so many membership queries, where
/// nothing else is said: a person who judges a whole automaton looks at several
/// behaviours.
pub const EQUIVALENCE_COST: f64 = 4.0;

impl Default for Config {
    fn default() -> Self {
        Self {
            strategy: Strategy::Bayes,
            membership_cost: 4.0,
            comparison_cost: 1.0,
            equivalence_cost: 4.0 * EQUIVALENCE_COST,
            shortest_counterexamples: false,
            robust: false,
            conformance: None,
            seed: 0,
            budget: 2_000_000,
        }
    }
}
