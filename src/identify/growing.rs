//! What the two kinds of partial automata have in common, so that one walk goes
//! through either.

use super::completion::Leaf;
use super::instance::Instance;
use super::merged::{self, Merged};
use super::partial::{self, Partial};

/// A partial automaton that grows edge by edge and can be undone.
pub(crate) trait Growing<'a> {
    /// A point to which it can be undone.
    type Mark: Copy;

    /// The automaton of the start state alone, that may grow to `limit` states.
    fn start(instance: &'a Instance, limit: usize) -> Self;

    /// The present point.
    fn mark(&self) -> Self::Mark;

    /// Forgets everything since `mark`.
    fn undo(&mut self, mark: Self::Mark);

    /// The edge to define next, with the states it may lead to appended to
    /// `targets`, perhaps none. None if there is no edge to define.
    fn choose(&mut self, targets: &mut Vec<u32>) -> Option<u32>;

    /// Defines the edge; `false` if a fact is violated, and then it must be
    /// undone.
    fn define(&mut self, edge: u32, target: u32) -> bool;

    /// The units of work since the last call, at least 1.
    fn take_work(&mut self) -> u64;

    /// What this stands for when no edge is to be defined.
    fn leaf(&self) -> Leaf;
}

impl<'a> Growing<'a> for Partial<'a> {
    type Mark = partial::Mark;

    fn start(instance: &'a Instance, limit: usize) -> Self {
        Self::new(instance, limit)
    }

    fn mark(&self) -> Self::Mark {
        self.mark()
    }

    fn undo(&mut self, mark: Self::Mark) {
        self.undo(mark);
    }

    fn choose(&mut self, targets: &mut Vec<u32>) -> Option<u32> {
        let edge = self.tightest()?;
        let used = self.used();
        targets.extend((0..used).filter(|&target| self.may_lead(edge, target)));
        if used < self.limit() {
            targets.push(used);
        }
        Some(edge)
    }

    fn define(&mut self, edge: u32, target: u32) -> bool {
        self.define(edge, target)
    }

    fn take_work(&mut self) -> u64 {
        1
    }

    fn leaf(&self) -> Leaf {
        Leaf::new(
            self.delta().into(),
            (0..self.used()).map(|state| self.output(state)).collect(),
            self.open_implications().collect(),
        )
    }
}

impl<'a> Growing<'a> for Merged<'a> {
    type Mark = merged::Mark;

    fn start(instance: &'a Instance, limit: usize) -> Self {
        Self::new(instance, limit)
    }

    fn mark(&self) -> Self::Mark {
        self.mark()
    }

    fn undo(&mut self, mark: Self::Mark) {
        self.undo(mark);
    }

    fn choose(&mut self, targets: &mut Vec<u32>) -> Option<u32> {
        self.tightest(targets)
    }

    fn define(&mut self, edge: u32, target: u32) -> bool {
        self.define(edge, target)
    }

    fn take_work(&mut self) -> u64 {
        self.take_work()
    }

    fn leaf(&self) -> Leaf {
        Leaf::new(
            self.delta().into(),
            (0..self.used()).map(|state| self.output(state)).collect(),
            self.open_implications(),
        )
    }
}
