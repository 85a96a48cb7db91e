//! The smallest DFAs consistent with labelled words and preferences.
//!
//! Knows words and facts; it must not know who asks, or why.

mod completion;
mod contradiction;
mod ends;
mod engine;
mod enumerate;
mod grow;
mod growing;
mod growth;
mod identifier;
mod instance;
mod labels;
mod merged;
mod partial;
mod particles;
mod problem;
mod sat;
mod spread;
mod tree;

use automata::Dfa;

use crate::evidence::AnswerId;
pub use ends::{end, ends};
pub use identifier::Identifier;
pub use spread::{Spread, Weighted, Wish};

/// Which engine answers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum EngineChoice {
    /// The enumerator where it reaches, `varisat` beyond.
    #[default]
    Auto,
    /// The plain enumerator of canonically numbered DFAs.
    Enumerate,
    /// SAT by `varisat`.
    Varisat,
    /// SAT by `batsat`.
    Batsat,
}

/// How an [`Identifier`] works.
#[derive(Clone, Debug)]
pub struct Settings {
    /// The engine.
    pub engine: EngineChoice,
    /// The largest number of states to consider, at least 1.
    pub max_states: usize,
}

/// Facts that cannot stand together.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Contradiction {
    /// A minimal set of answers: without any one of them its rest can stand (with
    /// more states than the bound, unless the bound is the cause).
    /// In ascending order. Empty if the facts known at the start (those without
    /// an answer) are contradictory by themselves.
    pub answers: Vec<AnswerId>,
    /// Why they cannot stand.
    pub cause: Cause,
    /// Whether it is proved that no answer can be left out. If not, the budget
    /// ended on the way; the answers cannot all stand in any case.
    pub minimal: bool,
}

/// Why facts cannot stand together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cause {
    /// A cycle of strict preferences: no preorder at all agrees. It is found by
    /// [`crate::concept::Preorder`]; an identifier, which reads `≺` as Eq. 5.4
    /// does, reports neither this nor [`Self::Equality`].
    Order,
    /// Atoms that are equally good, of which a strict preference sets one above
    /// the other, directly or by way of others.
    Equality,
    /// An accepted word below a rejected one (or a word with two labels): no
    /// language at all is consistent.
    MemRep,
    /// Some automaton is consistent, but none with this many states or fewer.
    States {
        /// The bound, [`Settings::max_states`].
        bound: usize,
    },
}

/// Why there is no automaton to return.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Failure {
    /// The facts contradict each other.
    Contradiction(Contradiction),
    /// The budget ended first.
    OverBudget {
        /// No automaton with fewer states is consistent.
        at_least: usize,
    },
}

/// Different automata of the smallest consistent size.
#[derive(Clone, Debug)]
pub struct Sample {
    /// Minimal and numbered breadth first; each of another language; at least
    /// one. Simplest first: most self-loops, then by the table.
    pub automata: Vec<Dfa>,
    /// Whether there are no others of this size.
    pub complete: bool,
}
