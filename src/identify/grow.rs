//! All automata of exactly one size, grown edge by edge.

use super::completion::Table;
use super::instance::Instance;
use super::partial::Partial;
use crate::evidence::Budget;

/// An automaton that grows to exactly so many states.
pub(crate) struct Lister<'a> {
    partial: Partial<'a>,
    states: u32,
}

impl<'a> Lister<'a> {
    /// Automata of the facts of the instance with so many states.
    pub(crate) fn new(instance: &'a Instance, states: usize) -> Self {
        Self {
            partial: Partial::new(instance, states),
            states: states as u32,
        }
    }

    fn table(&self) -> Table {
        let outputs = 0..self.partial.used();
        let output = outputs.map(|s| self.partial.output(s) == Some(true));
        (self.partial.delta().to_vec(), output.collect())
    }

    /// Calls `found` with every automaton, each in one numbering; `false` if
    /// the budget ended first or `found` had enough.
    pub(crate) fn list(
        &mut self,
        budget: &mut Budget,
        found: &mut dyn FnMut(&Table) -> bool,
    ) -> bool {
        let mark = self.partial.mark();
        let edge = self
            .partial
            .tightest()
            .or_else(|| self.partial.first_open_edge());
        let Some(edge) = edge else {
            return self.list_outputs(0, budget, found);
        };
        let used = self.partial.used();
        let last = if used < self.states { used } else { used - 1 };
        for target in 0..=last {
            if target < used {
                // Otherwise no edge is left to lead to the states that are missing.
                if used < self.states && self.partial.open_edges() == 1 {
                    continue;
                }
                if !self.partial.may_lead(edge, target) {
                    continue;
                }
            }
            if !budget.spend(1) {
                return false;
            }
            let goes_on = !self.partial.define(edge, target) || self.list(budget, found);
            self.partial.undo(mark);
            if !goes_on {
                return false;
            }
        }
        true
    }

    fn list_outputs(
        &mut self,
        from: u32,
        budget: &mut Budget,
        found: &mut dyn FnMut(&Table) -> bool,
    ) -> bool {
        let open = (from..self.partial.used()).find(|&s| self.partial.output(s).is_none());
        let Some(state) = open else {
            return self.partial.used() != self.states || found(&self.table());
        };
        let mark = self.partial.mark();
        for output in [false, true] {
            if !budget.spend(1) {
                return false;
            }
            let goes_on =
                !self.partial.assume(state, output) || self.list_outputs(state + 1, budget, found);
            self.partial.undo(mark);
            if !goes_on {
                return false;
            }
        }
        true
    }
}
