//! Boolean operations on languages: complement and the product construction.

use crate::explore::Numbering;
use crate::{Alphabet, Dfa, StateId};

/// Two automata (or an automaton and a sample) do not read the same alphabet.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the alphabets differ: {first} and {second}; give both the same symbols in the same order")]
pub struct AlphabetMismatch {
    /// The names of the first, for people: `{a, b}`.
    pub first: String,
    /// The names of the second.
    pub second: String,
}

impl AlphabetMismatch {
    pub(crate) fn new(first: &Alphabet, second: &Alphabet) -> Self {
        Self {
            first: first.to_string(),
            second: second.to_string(),
        }
    }

    /// Refuses two alphabets that differ.
    pub(crate) fn check(first: &Alphabet, second: &Alphabet) -> Result<(), Self> {
        if first == second {
            Ok(())
        } else {
            Err(Self::new(first, second))
        }
    }
}

impl Dfa {
    /// Accepts exactly the words that this automaton rejects. Same states.
    #[must_use]
    pub fn complement(&self) -> Self {
        let accepting = self.states().map(|q| !self.is_accepting(q)).collect();
        let delta = self
            .states()
            .flat_map(|q| self.alphabet().symbols().map(move |a| (q, a)))
            .map(|(q, a)| self.next(q, a))
            .collect();
        Self::from_table(self.alphabet().clone(), self.start(), accepting, delta)
    }

    /// Accepts the words for which `keep(self accepts, other accepts)` holds.
    ///
    /// Runs both side by side. Only pairs of states that some word reaches
    /// become states, numbered canonically; the result need not be minimal.
    ///
    /// # Errors
    ///
    /// If the alphabets differ.
    ///
    /// # Panics
    ///
    /// If 2³² pairs or more are reachable.
    pub fn product(
        &self,
        other: &Self,
        keep: impl Fn(bool, bool) -> bool,
    ) -> Result<Self, AlphabetMismatch> {
        AlphabetMismatch::check(self.alphabet(), other.alphabet())?;
        let width = other.size() as u64;
        let key = |(p, q): (StateId, StateId)| p.index() as u64 * width + q.index() as u64;
        let mut numbers = Numbering::new(self.size() as u64 * width);
        let mut pairs = vec![(self.start(), other.start())];
        numbers.number(key(pairs[0]));
        let mut accepting = Vec::new();
        let mut delta = Vec::new();
        let mut head = 0;
        while let Some(&(p, q)) = pairs.get(head) {
            head += 1;
            accepting.push(keep(self.is_accepting(p), other.is_accepting(q)));
            for symbol in self.alphabet().symbols() {
                let next = (self.next(p, symbol), other.next(q, symbol));
                let (number, new) = numbers.number(key(next));
                if new {
                    pairs.push(next);
                }
                delta.push(StateId::new(number as usize));
            }
        }
        Ok(Self::from_table(
            self.alphabet().clone(),
            StateId::new(0),
            accepting,
            delta,
        ))
    }

    /// Accepts the words that both accept; see [`Dfa::product`].
    ///
    /// # Errors
    ///
    /// If the alphabets differ.
    pub fn and(&self, other: &Self) -> Result<Self, AlphabetMismatch> {
        self.product(other, |p, q| p && q)
    }

    /// Accepts the words that at least one accepts; see [`Dfa::product`].
    ///
    /// # Errors
    ///
    /// If the alphabets differ.
    pub fn or(&self, other: &Self) -> Result<Self, AlphabetMismatch> {
        self.product(other, |p, q| p || q)
    }

    /// Accepts the words on which the two differ; see [`Dfa::product`].
    ///
    /// # Errors
    ///
    /// If the alphabets differ.
    pub fn xor(&self, other: &Self) -> Result<Self, AlphabetMismatch> {
        self.product(other, |p, q| p != q)
    }
}
