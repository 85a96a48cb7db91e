//! Minimises an automaton: Hopcroft's partition refinement.
//!
//! J. Hopcroft, "An n log n algorithm for minimizing states in a finite
//! automaton" (1971), with the invariant of T. Knuutila, "Re-describing an
//! algorithm by Hopcroft" (2001): of the two halves of a block, the smaller is
//! enough to split by, unless the whole still waits in the list.
//!
//! `O(|Σ| n log n)` steps. Its weakness: it reads transitions backwards, so it
//! holds the inverse table (`|Σ| n` entries) and a waiting flag for every block
//! and symbol; and for the handful of states that a person's task has, building
//! these costs more than the refinement. Moore's quadratic rounds need neither,
//! but fall behind on the automata with thousands of states that products give.

use crate::{Dfa, StateId, Symbol};

impl Dfa {
    /// The smallest automaton with the same language, canonically numbered.
    ///
    /// It is unique: two automata over one alphabet accept the same words
    /// exactly if their minimal automata are `==`.
    #[must_use]
    pub fn minimise(&self) -> Self {
        let dfa = self.canonical();
        let blocks = Partition::coarsest(&dfa).block_of;
        // States come in breadth-first order, so a block's first state has the
        // least access word of the block: numbering blocks by their first
        // states is the canonical numbering of the quotient.
        let mut number_of = vec![None; dfa.size()];
        let mut firsts = Vec::new();
        let mut class = Vec::with_capacity(dfa.size());
        for state in dfa.states() {
            let number = *number_of[blocks[state.index()]].get_or_insert_with(|| {
                firsts.push(state);
                StateId::new(firsts.len() - 1)
            });
            class.push(number);
        }
        let accepting = firsts.iter().map(|&q| dfa.is_accepting(q)).collect();
        let mut delta = Vec::with_capacity(firsts.len() * dfa.alphabet().len());
        for &state in &firsts {
            for symbol in dfa.alphabet().symbols() {
                delta.push(class[dfa.next(state, symbol).index()]);
            }
        }
        Self::from_table(dfa.alphabet().clone(), StateId::new(0), accepting, delta)
    }
}

/// A partition of the states into blocks `0, 1, …`, refined in place.
struct Partition {
    /// All states, those of one block side by side.
    states: Vec<usize>,
    /// Where each state stands in `states`.
    place: Vec<usize>,
    /// The block of each state.
    block_of: Vec<usize>,
    /// Each block's range of `states`.
    range: Vec<(usize, usize)>,
    /// How many states at the front of each block are marked.
    marked: Vec<usize>,
}

impl Partition {
    /// The coarsest partition that keeps accepting states apart from others and
    /// that every symbol respects: the classes of Myhill and Nerode.
    fn coarsest(dfa: &Dfa) -> Self {
        let mut partition = Self::whole(dfa.size());
        for state in dfa.states().filter(|&q| dfa.is_accepting(q)) {
            partition.mark(state.index());
        }
        let symbols = dfa.alphabet().len();
        // Whether a block waits to be split by, for a symbol.
        let mut waits = vec![false; symbols];
        let mut list = Vec::new();
        if let Some(new) = partition.split(0) {
            waits.resize(2 * symbols, false);
            let smaller = partition.smaller(0, new);
            for symbol in 0..symbols {
                waits[smaller * symbols + symbol] = true;
                list.push((smaller, symbol));
            }
        }
        let inverse = Inverse::of(dfa);
        let mut touched = Vec::new();
        while let Some((splitter, symbol)) = list.pop() {
            waits[splitter * symbols + symbol] = false;
            let (from, to) = partition.range[splitter];
            // Marking moves states within `states`, so the splitter is copied.
            let members = partition.states[from..to].to_vec();
            for target in members {
                for &source in inverse.sources(target, symbol) {
                    let block = partition.block_of[source];
                    if partition.mark(source) {
                        touched.push(block);
                    }
                }
            }
            for block in touched.drain(..) {
                let Some(new) = partition.split(block) else {
                    continue;
                };
                waits.resize((new + 1) * symbols, false);
                let smaller = partition.smaller(block, new);
                for symbol in 0..symbols {
                    let part = if waits[block * symbols + symbol] {
                        new
                    } else {
                        smaller
                    };
                    waits[part * symbols + symbol] = true;
                    list.push((part, symbol));
                }
            }
        }
        partition
    }

    /// All of `size` states in one block.
    fn whole(size: usize) -> Self {
        Self {
            states: (0..size).collect(),
            place: (0..size).collect(),
            block_of: vec![0; size],
            range: vec![(0, size)],
            marked: vec![0],
        }
    }

    /// Marks a state; whether it is the first marked one of its block.
    fn mark(&mut self, state: usize) -> bool {
        let block = self.block_of[state];
        let border = self.range[block].0 + self.marked[block];
        let place = self.place[state];
        if place < border {
            return false;
        }
        let other = self.states[border];
        self.states.swap(place, border);
        self.place[state] = border;
        self.place[other] = place;
        self.marked[block] += 1;
        self.marked[block] == 1
    }

    /// Moves the marked states of a block to a new one and clears the marks;
    /// `None` if all or none are marked.
    fn split(&mut self, block: usize) -> Option<usize> {
        let (from, to) = self.range[block];
        let border = from + std::mem::take(&mut self.marked[block]);
        if border == from || border == to {
            return None;
        }
        let new = self.range.len();
        self.range[block] = (border, to);
        self.range.push((from, border));
        self.marked.push(0);
        for &state in &self.states[from..border] {
            self.block_of[state] = new;
        }
        Some(new)
    }

    /// The one of two blocks that has fewer states.
    fn smaller(&self, first: usize, second: usize) -> usize {
        let len = |block: usize| self.range[block].1 - self.range[block].0;
        if len(second) < len(first) {
            second
        } else {
            first
        }
    }
}

/// The transitions read backwards.
struct Inverse {
    symbols: usize,
    /// Where the sources of `target * |Σ| + symbol` begin in `sources`.
    offset: Vec<usize>,
    sources: Vec<usize>,
}

impl Inverse {
    fn of(dfa: &Dfa) -> Self {
        let symbols = dfa.alphabet().len();
        let slot = |q: StateId, a: Symbol| dfa.next(q, a).index() * symbols + a.index();
        let mut offset = vec![0; dfa.size() * symbols + 1];
        for state in dfa.states() {
            for symbol in dfa.alphabet().symbols() {
                offset[slot(state, symbol) + 1] += 1;
            }
        }
        for i in 1..offset.len() {
            offset[i] += offset[i - 1];
        }
        let mut free = offset.clone();
        let mut sources = vec![0; dfa.size() * symbols];
        for state in dfa.states() {
            for symbol in dfa.alphabet().symbols() {
                let place = &mut free[slot(state, symbol)];
                sources[*place] = state.index();
                *place += 1;
            }
        }
        Self {
            symbols,
            offset,
            sources,
        }
    }

    /// The states from which `symbol` leads to `target`.
    fn sources(&self, target: usize, symbol: usize) -> &[usize] {
        let slot = target * self.symbols + symbol;
        &self.sources[self.offset[slot]..self.offset[slot + 1]]
    }
}
