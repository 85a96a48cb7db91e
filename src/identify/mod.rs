//! The smallest DFAs consistent with labelled words and preferences.
//!
//! Knows words and facts; it must not know who asks, or why.

mod engine;
mod problem;
mod tree;

use automata::{Alphabet, Dfa, Word};

use crate::evidence::{AnswerId, Budget, Fact};

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
    /// A minimal set of answers: without any one of them the rest can stand.
    /// In ascending order. Empty if the facts known at the start (those without
    /// an answer) are contradictory by themselves.
    pub answers: Vec<AnswerId>,
    /// Why they cannot stand.
    pub cause: Cause,
}

/// Why facts cannot stand together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cause {
    /// A cycle of preferences of which at least one is strict: no preorder at
    /// all agrees. It is found by [`crate::concept::Preorder`]; an identifier,
    /// which reads `≺` as Eq. 5.4 does, never reports it.
    Order,
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
    /// Minimal and canonically numbered; each of another language; at least one.
    pub automata: Vec<Dfa>,
    /// Whether there are no others of this size.
    pub complete: bool,
}

/// An incremental search for the smallest consistent automata: facts come and
/// go, and what was learned from the others is kept.
pub struct Identifier {}

impl Identifier {
    /// A search over all DFAs with this alphabet.
    pub fn new(alphabet: Alphabet, settings: Settings) -> Self {
        let _ = (alphabet, settings);
        unimplemented!()
    }

    /// Adds a fact. `None` for one that is known from the start and can never
    /// be retracted; several facts may carry the same answer.
    pub fn add(&mut self, answer: Option<AnswerId>, fact: Fact<Word>) {
        let _ = (answer, fact);
        unimplemented!()
    }

    /// Takes back all facts of an answer.
    pub fn retract(&mut self, answer: AnswerId) {
        let _ = answer;
        unimplemented!()
    }

    /// Up to `count` different automata of the smallest consistent size.
    ///
    /// If there are more, it is a random sample, and a function of the standing
    /// facts and `seed` alone: not of the order in which facts came, of what
    /// was retracted, or of what was asked before.
    ///
    /// # Errors
    ///
    /// If no automaton within the bound is consistent, or the budget ends.
    pub fn smallest(
        &mut self,
        count: usize,
        seed: u64,
        budget: &mut Budget,
    ) -> Result<Sample, Failure> {
        let _ = (count, seed, budget);
        unimplemented!()
    }
}
