//! Counts accepted words exactly, finds one by its rank, and draws one
//! uniformly.

use num_bigint::BigUint;
use rand::Rng;

use crate::{Dfa, StateId, Word};

/// How many words of each length an automaton accepts from each of its states,
/// up to a longest length: what counting, ranking and sampling need.
///
/// Holds `(longest + 1) · |Q|` numbers of up to `longest · log₂|Σ|` bits.
#[derive(Clone, Debug)]
pub struct WordCounts<'a> {
    dfa: &'a Dfa,
    /// `rows[k][q]`: the number of words of `k` symbols accepted from `q`.
    rows: Vec<Vec<BigUint>>,
}

impl Dfa {
    /// Counts the accepted words of each length from 0 to `longest`.
    pub fn word_counts(&self, longest: usize) -> WordCounts<'_> {
        let mut rows = Vec::with_capacity(longest + 1);
        rows.push(self.words_of_no_symbol());
        for length in 0..longest {
            rows.push(self.one_longer(&rows[length]));
        }
        WordCounts { dfa: self, rows }
    }

    /// The number of accepted words of exactly `length` symbols.
    pub fn count_of_length(&self, length: usize) -> BigUint {
        let mut row = self.words_of_no_symbol();
        for _ in 0..length {
            row = self.one_longer(&row);
        }
        row.swap_remove(self.start().index())
    }

    /// The number of accepted words of at most `length` symbols.
    pub fn count_up_to(&self, length: usize) -> BigUint {
        let start = self.start().index();
        let mut row = self.words_of_no_symbol();
        let mut sum = row[start].clone();
        for _ in 0..length {
            row = self.one_longer(&row);
            sum += &row[start];
        }
        sum
    }

    /// For every state, the number of accepted words without symbols.
    fn words_of_no_symbol(&self) -> Vec<BigUint> {
        self.states()
            .map(|q| BigUint::from(u8::from(self.is_accepting(q))))
            .collect()
    }

    /// For every state, the number of accepted words that are one symbol longer
    /// than those counted in `row`.
    fn one_longer(&self, row: &[BigUint]) -> Vec<BigUint> {
        self.states()
            .map(|q| {
                let symbols = self.alphabet().symbols();
                symbols.map(|a| &row[self.next(q, a).index()]).sum()
            })
            .collect()
    }
}

impl WordCounts<'_> {
    /// The greatest length that was counted.
    pub fn longest(&self) -> usize {
        self.rows.len() - 1
    }

    /// The number of accepted words of exactly `length` symbols.
    ///
    /// # Panics
    ///
    /// If `length` is beyond [`WordCounts::longest`].
    pub fn of_length(&self, length: usize) -> &BigUint {
        &self.rows[length][self.dfa.start().index()]
    }

    /// The number of accepted words of at most [`WordCounts::longest`] symbols.
    pub fn total(&self) -> BigUint {
        (0..self.rows.len()).map(|n| self.of_length(n)).sum()
    }

    /// The accepted word of `length` symbols before which `rank` others stand
    /// in lexicographic order; `None` if there are not that many.
    ///
    /// # Panics
    ///
    /// If `length` is beyond [`WordCounts::longest`].
    pub fn word_of_length(&self, length: usize, mut rank: BigUint) -> Option<Word> {
        if rank >= *self.of_length(length) {
            return None;
        }
        let mut state: StateId = self.dfa.start();
        let mut word = Word::empty();
        for left in (0..length).rev() {
            for symbol in self.dfa.alphabet().symbols() {
                let next = self.dfa.next(state, symbol);
                let here = &self.rows[left][next.index()];
                if rank < *here {
                    word.push(symbol);
                    state = next;
                    break;
                }
                rank -= here;
            }
        }
        Some(word)
    }

    /// The accepted word before which `rank` others stand in
    /// length-lexicographic order; `None` if there are not that many of at most
    /// [`WordCounts::longest`] symbols.
    pub fn word(&self, mut rank: BigUint) -> Option<Word> {
        for length in 0..self.rows.len() {
            let here = self.of_length(length);
            if rank < *here {
                return self.word_of_length(length, rank);
            }
            rank -= here;
        }
        None
    }

    /// An accepted word of exactly `length` symbols, each equally likely;
    /// `None` if there is none.
    ///
    /// # Panics
    ///
    /// If `length` is beyond [`WordCounts::longest`].
    pub fn sample_of_length(&self, length: usize, random: &mut impl Rng) -> Option<Word> {
        let rank = below(self.of_length(length), random)?;
        self.word_of_length(length, rank)
    }

    /// An accepted word of at most [`WordCounts::longest`] symbols, each word
    /// (not each length) equally likely; `None` if there is none.
    pub fn sample(&self, random: &mut impl Rng) -> Option<Word> {
        let rank = below(&self.total(), random)?;
        self.word(rank)
    }
}

/// A number below `bound`, each equally likely; `None` if `bound` is 0.
///
/// Draws as many bits as the bound has and starts again where they are too
/// large, which happens less than half of the time; a remainder would favour
/// small numbers. Takes 32 bits at a time, so that a seed gives the same
/// numbers on every machine.
fn below(bound: &BigUint, random: &mut impl Rng) -> Option<BigUint> {
    let bits = bound.bits();
    if bits == 0 {
        return None;
    }
    let digits = bits.div_ceil(32) as usize;
    let spare = digits as u64 * 32 - bits;
    loop {
        let mut drawn: Vec<u32> = (0..digits).map(|_| random.next_u32()).collect();
        if let Some(top) = drawn.last_mut() {
            *top >>= spare;
        }
        let number = BigUint::new(drawn);
        if number < *bound {
            return Some(number);
        }
    }
}
