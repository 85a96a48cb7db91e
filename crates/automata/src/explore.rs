//! Walks the states of an automaton: which can be reached, which can still
//! accept, and whether the language is finite.

use std::collections::HashMap;

use crate::{Dfa, StateId};

/// Gives keys the numbers 0, 1, 2, … in the order in which they come.
///
/// A flat table where the keys are few, since nearly all automata here are
/// small and a hash of every pair would be most of the work; a hash map beyond.
pub(crate) struct Numbering {
    dense: Vec<u32>,
    sparse: HashMap<u64, u32>,
    count: u32,
}

/// Marks a key without a number in the flat table.
const UNNUMBERED: u32 = u32::MAX;

/// The largest flat table, in keys (16 MiB).
const DENSE_KEYS: u64 = 1 << 22;

impl Numbering {
    /// No key below `bound` has a number yet.
    pub(crate) fn new(bound: u64) -> Self {
        let dense = if bound <= DENSE_KEYS {
            vec![UNNUMBERED; bound as usize]
        } else {
            Vec::new()
        };
        Self {
            dense,
            sparse: HashMap::new(),
            count: 0,
        }
    }

    /// The number of `key`, and whether it came for the first time.
    pub(crate) fn number(&mut self, key: u64) -> (u32, bool) {
        let next = self.count;
        let slot = if self.dense.is_empty() {
            self.sparse.entry(key).or_insert(UNNUMBERED)
        } else {
            &mut self.dense[key as usize]
        };
        let new = *slot == UNNUMBERED;
        if new {
            *slot = next;
            self.count += 1;
        }
        (*slot, new)
    }
}

/// How long the words of a language get.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Extent {
    /// There is no word.
    NoWord,
    /// There is a word of this length and none that is longer.
    Longest(usize),
    /// For every length there is a word that is longer.
    Unbounded,
}

impl Dfa {
    /// The states that some word reaches, in breadth-first order from the start
    /// (symbols in declared order): the order of their length-lexicographically
    /// least access words.
    pub fn reachable(&self) -> Vec<StateId> {
        let mut seen = vec![false; self.size()];
        seen[self.start().index()] = true;
        let mut order = vec![self.start()];
        let mut head = 0;
        while let Some(&state) = order.get(head) {
            head += 1;
            for symbol in self.alphabet().symbols() {
                let next = self.next(state, symbol);
                if !std::mem::replace(&mut seen[next.index()], true) {
                    order.push(next);
                }
            }
        }
        order
    }

    /// For every state, whether some word leads from it to acceptance.
    ///
    /// The others are *dead*: once there, no word is accepted any more.
    pub fn live(&self) -> Vec<bool> {
        let mut sources = vec![Vec::new(); self.size()];
        for state in self.states() {
            for symbol in self.alphabet().symbols() {
                sources[self.next(state, symbol).index()].push(state);
            }
        }
        let mut live: Vec<bool> = self.states().map(|q| self.is_accepting(q)).collect();
        let mut open: Vec<StateId> = self.states().filter(|&q| self.is_accepting(q)).collect();
        while let Some(state) = open.pop() {
            for &source in &sources[state.index()] {
                if !std::mem::replace(&mut live[source.index()], true) {
                    open.push(source);
                }
            }
        }
        live
    }

    /// How long accepted words get.
    pub(crate) fn extent(&self) -> Extent {
        let live = self.live();
        if !live[self.start().index()] {
            return Extent::NoWord;
        }
        // Peel off useful states that no useful state leads to any more
        // (Kahn 1962). What is left over lies on or behind a cycle.
        let useful: Vec<StateId> = self
            .reachable()
            .into_iter()
            .filter(|q| live[q.index()])
            .collect();
        let mut incoming = vec![0usize; self.size()];
        for &state in &useful {
            for symbol in self.alphabet().symbols() {
                incoming[self.next(state, symbol).index()] += 1;
            }
        }
        if incoming[self.start().index()] > 0 {
            return Extent::Unbounded;
        }
        let mut depth = vec![0usize; self.size()];
        let mut open = vec![self.start()];
        let mut peeled = 0;
        let mut longest = 0;
        while let Some(state) = open.pop() {
            peeled += 1;
            if self.is_accepting(state) {
                longest = longest.max(depth[state.index()]);
            }
            for symbol in self.alphabet().symbols() {
                let next = self.next(state, symbol).index();
                if !live[next] {
                    continue;
                }
                depth[next] = depth[next].max(depth[state.index()] + 1);
                incoming[next] -= 1;
                if incoming[next] == 0 {
                    open.push(StateId::new(next));
                }
            }
        }
        if peeled == useful.len() {
            Extent::Longest(longest)
        } else {
            Extent::Unbounded
        }
    }

    /// Whether only finitely many words are accepted.
    pub fn is_finite(&self) -> bool {
        self.extent() != Extent::Unbounded
    }
}
