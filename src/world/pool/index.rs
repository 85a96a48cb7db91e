//! The words of a pool, packed so that an automaton runs over all of them fast:
//! several symbols are one step.

use automata::{Alphabet, Dfa, Symbol, Word};

use super::super::machine::Machine;

/// The most different blocks.
const BLOCKS: usize = 256;
/// After so many words that did not suffice, the machine is prepared for blocks.
const FEW: usize = 64;
/// Positions that an outline knows.
const POSITIONS: usize = 100;

/// The different words of a pool in order.
#[derive(Clone, Debug)]
pub(super) struct Index {
    words: Vec<Word>,
    symbols: usize,
    /// The symbols of a block.
    width: usize,
    /// The full blocks of all words, one after the other; a block is its symbols
    /// read as a number. And where those of every word end.
    blocks: Vec<u8>,
    ends: Vec<u32>,
}

impl Index {
    /// The index of these words, which differ and come in order.
    pub(super) fn new(words: Vec<Word>, alphabet: &Alphabet) -> Self {
        let symbols = alphabet.len();
        let mut width = 0;
        while symbols > 1 && symbols.pow(width as u32 + 1) <= BLOCKS {
            width += 1;
        }
        let (mut blocks, mut ends) = (Vec::new(), Vec::with_capacity(words.len()));
        for word in &words {
            if width > 0 {
                blocks.extend(word.symbols().chunks_exact(width).map(|block| {
                    let number = |sum: usize, symbol: &Symbol| sum * symbols + symbol.index();
                    block.iter().fold(0, number) as u8
                }));
            }
            ends.push(blocks.len() as u32);
        }
        Self {
            words,
            symbols,
            width,
            blocks,
            ends,
        }
    }

    pub(super) fn words(&self) -> &[Word] {
        &self.words
    }

    /// The places of the words in the language, in order.
    pub(super) fn accepted(&self, machine: Machine) -> impl Iterator<Item = usize> + '_ {
        let useful = if machine.start().is_some() {
            self.words.len()
        } else {
            0
        };
        let mut steps: Option<Vec<u32>> = None;
        (0..useful).filter(move |&place| {
            let word = self.words[place].symbols();
            let mut state = machine.start();
            let mut read = 0;
            if place >= FEW && self.width > 1 {
                let steps = steps.get_or_insert_with(|| machine.blocks(self.width));
                let from = place.checked_sub(1).map_or(0, |before| self.ends[before]);
                let blocks = &self.blocks[from as usize..self.ends[place] as usize];
                read = blocks.len() * self.width;
                state = machine.run_blocks(steps, blocks, self.symbols.pow(self.width as u32));
            }
            for &symbol in &word[read..] {
                state = state.and_then(|state| machine.next(state, symbol));
            }
            state.is_some_and(|state| machine.is_accepting(state))
        })
    }

    /// The words whose lengths, and whose symbols at every place, are those of some
    /// word; none if there are too many places.
    pub(super) fn outline(&self, alphabet: &Alphabet) -> Option<Dfa> {
        let longest = self.words.last().map_or(0, Word::len);
        if longest > POSITIONS {
            return None;
        }
        let nowhere = longest + 1;
        let mut rows = vec![vec![nowhere; alphabet.len()]; longest + 2];
        let mut accepting = vec![false; longest + 2];
        for word in &self.words {
            for (place, symbol) in word.iter().enumerate() {
                rows[place][symbol.index()] = place + 1;
            }
            accepting[word.len()] = true;
        }
        Dfa::new(alphabet.clone(), 0, accepting, &rows).ok()
    }
}
