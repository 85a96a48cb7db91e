//! What the three engines have in common.

use automata::Dfa;

use super::problem::{FactId, Problem};
use crate::evidence::Budget;

/// What a search found.
#[derive(Clone, Debug)]
pub(crate) enum Verdict {
    /// At least one automaton: canonically numbered, each of another language.
    Found {
        /// As many as were asked for, or all there are.
        automata: Vec<Dfa>,
        /// Whether these are all automata of this size.
        complete: bool,
    },
    /// There is no such automaton. The facts are a claim of the engine, to be
    /// verified before use: some subset of the given facts that suffices.
    None {
        /// Facts that are contradictory by themselves, perhaps not minimal.
        core: Vec<FactId>,
    },
    /// The budget ended before even one automaton was found.
    OverBudget,
}

/// What is asked of an engine.
pub(crate) struct Query<'a> {
    /// The words and facts.
    pub(crate) problem: &'a Problem,
    /// The facts that stand, ascending. All others are to be ignored.
    pub(crate) standing: &'a [FactId],
    /// Automata with at most this many states. The caller knows that one fewer
    /// is impossible whenever it asks for more than one automaton.
    pub(crate) states: usize,
    /// How many different automata are wanted, at least 1.
    pub(crate) count: usize,
    /// Decides which ones, if there are more. The choice is a function of the
    /// standing facts and the seed alone, whatever the engine did before.
    pub(crate) seed: u64,
}

/// A search for consistent automata.
///
/// An engine may keep what it learns between searches over the same growing
/// [`Problem`].
pub(crate) trait Engine {
    /// Answers the query within the budget.
    fn search(&mut self, query: &Query<'_>, budget: &mut Budget) -> Verdict;
}
