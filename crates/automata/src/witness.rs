//! Finds the least word that is accepted, or on which two automata differ.

use crate::explore::Numbering;
use crate::{Alphabet, AlphabetMismatch, Dfa, Symbol, Word};

/// The length-lexicographically least word that leads from `start` to a goal.
///
/// A breadth-first search that takes symbols in declared order discovers every
/// node by its least word, and nodes in the order of these words: the first
/// goal it discovers has the least word of all.
fn least_word<N: Copy>(
    alphabet: &Alphabet,
    start: N,
    mut numbers: Numbering,
    key: impl Fn(N) -> u64,
    next: impl Fn(N, Symbol) -> N,
    goal: impl Fn(N) -> bool,
) -> Option<Word> {
    if goal(start) {
        return Some(Word::empty());
    }
    numbers.number(key(start));
    // Every discovered node with the place of its predecessor in this list.
    let mut nodes = vec![(start, None::<(usize, Symbol)>)];
    let mut head = 0;
    while let Some(&(node, _)) = nodes.get(head) {
        for symbol in alphabet.symbols() {
            let found = next(node, symbol);
            if !numbers.number(key(found)).1 {
                continue;
            }
            if goal(found) {
                let mut back = vec![symbol];
                let mut place = head;
                while let Some((before, symbol)) = nodes[place].1 {
                    back.push(symbol);
                    place = before;
                }
                back.reverse();
                return Some(Word::from(back));
            }
            nodes.push((found, Some((head, symbol))));
        }
        head += 1;
    }
    None
}

impl Dfa {
    /// The length-lexicographically least accepted word; `None` if no word is
    /// accepted.
    pub fn shortest_accepted(&self) -> Option<Word> {
        least_word(
            self.alphabet(),
            self.start(),
            Numbering::new(self.size() as u64),
            |q| q.index() as u64,
            |q, symbol| self.next(q, symbol),
            |q| self.is_accepting(q),
        )
    }

    /// Whether no word is accepted.
    pub fn is_empty(&self) -> bool {
        self.shortest_accepted().is_none()
    }

    /// The length-lexicographically least word that exactly one of the two
    /// accepts; `None` if they accept the same words.
    ///
    /// Breadth-first over reachable pairs of states: at most
    /// `|self| · |other| · |Σ|` steps.
    ///
    /// # Errors
    ///
    /// If the alphabets differ.
    pub fn shortest_difference(&self, other: &Self) -> Result<Option<Word>, AlphabetMismatch> {
        AlphabetMismatch::check(self.alphabet(), other.alphabet())?;
        let width = other.size() as u64;
        Ok(least_word(
            self.alphabet(),
            (self.start(), other.start()),
            Numbering::new(self.size() as u64 * width),
            |(p, q)| p.index() as u64 * width + q.index() as u64,
            |(p, q), symbol| (self.next(p, symbol), other.next(q, symbol)),
            |(p, q)| self.is_accepting(p) != other.is_accepting(q),
        ))
    }

    /// Whether both accept the same words.
    ///
    /// # Errors
    ///
    /// If the alphabets differ.
    pub fn is_equivalent(&self, other: &Self) -> Result<bool, AlphabetMismatch> {
        Ok(self.shortest_difference(other)?.is_none())
    }
}
