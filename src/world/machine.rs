//! An automaton as the searches run it: without the states that lead nowhere.

use automata::{Dfa, StateId, Symbol, Word};

/// Marks a step after which no word is accepted any more.
const DEAD: u32 = u32::MAX;

/// The useful states of an automaton.
pub(super) struct Machine {
    symbols: usize,
    start: Option<u32>,
    accepting: Vec<bool>,
    /// By state and then by symbol.
    next: Vec<u32>,
}

impl Machine {
    /// The machine of this language.
    pub(super) fn new(language: &Dfa) -> Self {
        let live = language.live();
        let useful: Vec<StateId> = language
            .reachable()
            .into_iter()
            .filter(|state| live[state.index()])
            .collect();
        let mut number = vec![DEAD; language.size()];
        for (new, old) in useful.iter().enumerate() {
            number[old.index()] = new as u32;
        }
        let steps = useful.iter().flat_map(|&state| {
            let symbols = language.alphabet().symbols();
            symbols.map(move |symbol| language.next(state, symbol))
        });
        let start = number[language.start().index()];
        Self {
            symbols: language.alphabet().len(),
            start: (start != DEAD).then_some(start),
            accepting: useful.iter().map(|&q| language.is_accepting(q)).collect(),
            next: steps.map(|state| number[state.index()]).collect(),
        }
    }

    /// The machine that accepts one word, over so many symbols.
    pub(super) fn of_word(word: &Word, symbols: usize) -> Self {
        let mut next = vec![DEAD; (word.len() + 1) * symbols];
        for (place, symbol) in word.iter().enumerate() {
            next[place * symbols + symbol.index()] = place as u32 + 1;
        }
        let mut accepting = vec![false; word.len()];
        accepting.push(true);
        Self {
            symbols,
            start: Some(0),
            accepting,
            next,
        }
    }

    /// The number of states.
    pub(super) fn size(&self) -> usize {
        self.accepting.len()
    }

    /// The state before the first symbol; none if no word is accepted.
    pub(super) fn start(&self) -> Option<u32> {
        self.start
    }

    pub(super) fn is_accepting(&self, state: u32) -> bool {
        self.accepting[state as usize]
    }

    /// The state after a symbol; none where no word is accepted any more.
    #[inline]
    pub(super) fn next(&self, state: u32, symbol: Symbol) -> Option<u32> {
        let next = self.next[state as usize * self.symbols + symbol.index()];
        (next != DEAD).then_some(next)
    }

    /// The states that the symbol leads to this one from.
    pub(super) fn before(&self, state: u32, symbol: Symbol) -> impl Iterator<Item = u32> + '_ {
        let column = (0..self.size()).map(move |q| self.next[q * self.symbols + symbol.index()]);
        column
            .enumerate()
            .filter(move |(_, next)| *next == state)
            .map(|(before, _)| before as u32)
    }

    /// The state after each block of so many symbols, by state and then by block: a
    /// block is its symbols read as a number.
    pub(super) fn blocks(&self, width: usize) -> Vec<u32> {
        let mut steps: Vec<u32> = (0..self.size() as u32).collect();
        for _ in 0..width {
            let longer = steps.iter().flat_map(|&state| {
                (0..self.symbols).map(move |symbol| {
                    if state == DEAD {
                        DEAD
                    } else {
                        self.next[state as usize * self.symbols + symbol]
                    }
                })
            });
            steps = longer.collect();
        }
        steps
    }

    /// The state after these blocks, of which there are so many different ones.
    pub(super) fn run_blocks(&self, steps: &[u32], blocks: &[u8], different: usize) -> Option<u32> {
        let mut state = self.start?;
        for &block in blocks {
            state = steps[state as usize * different + usize::from(block)];
            if state == DEAD {
                return None;
            }
        }
        Some(state)
    }
}
