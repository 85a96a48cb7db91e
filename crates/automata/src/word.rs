//! Finite words, ordered by length and then lexicographically.

use std::cmp::Ordering;

use serde::{Deserialize, Serialize};

use crate::Symbol;

/// A finite sequence of symbols. The empty word is [`Word::default`].
///
/// Words are ordered by length first, then by their symbols' numbers: the
/// *length-lexicographic* order, in which every set of words has a least one.
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Word(Vec<Symbol>);

impl Word {
    /// The word without symbols.
    pub fn empty() -> Self {
        Self::default()
    }

    /// The number of symbols.
    pub fn len(&self) -> usize {
        self.0.len()
    }

    /// Whether this is the empty word.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// The symbols in order.
    pub fn iter(&self) -> impl DoubleEndedIterator<Item = Symbol> + ExactSizeIterator + '_ {
        self.0.iter().copied()
    }

    /// The symbols in order, as a slice.
    pub fn symbols(&self) -> &[Symbol] {
        &self.0
    }

    /// Appends a symbol.
    pub fn push(&mut self, symbol: Symbol) {
        self.0.push(symbol);
    }

    /// This word followed by one more symbol.
    #[must_use]
    pub fn with(&self, symbol: Symbol) -> Self {
        let mut longer = self.clone();
        longer.push(symbol);
        longer
    }
}

impl From<Vec<Symbol>> for Word {
    fn from(symbols: Vec<Symbol>) -> Self {
        Self(symbols)
    }
}

impl From<&[Symbol]> for Word {
    fn from(symbols: &[Symbol]) -> Self {
        Self(symbols.to_vec())
    }
}

impl FromIterator<Symbol> for Word {
    fn from_iter<I: IntoIterator<Item = Symbol>>(symbols: I) -> Self {
        Self(symbols.into_iter().collect())
    }
}

impl Ord for Word {
    fn cmp(&self, other: &Self) -> Ordering {
        self.len()
            .cmp(&other.len())
            .then_with(|| self.0.cmp(&other.0))
    }
}

impl PartialOrd for Word {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}
