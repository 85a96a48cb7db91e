//! A complete deterministic finite automaton as a dense table.

use serde::{Deserialize, Serialize};

use crate::{Alphabet, Symbol, Word};

/// A state's row in the table of its [`Dfa`], from 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(transparent)]
pub struct StateId(u32);

impl StateId {
    /// The state at row `index`.
    ///
    /// # Panics
    ///
    /// If `index` does not fit in 32 bits.
    pub fn new(index: usize) -> Self {
        Self(u32::try_from(index).expect("an automaton has fewer than 2^32 states"))
    }

    /// The row in the table, from 0.
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// A complete deterministic finite automaton `(Q, Σ, δ, q₀, F)`.
///
/// `==` compares the tables; for equality of languages use
/// [`Dfa::is_equivalent`].
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Dfa {
    alphabet: Alphabet,
    start: StateId,
    accepting: Vec<bool>,
    /// Row-major: `delta[state * |Σ| + symbol]`.
    delta: Vec<StateId>,
}

/// Why a table is no automaton.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum DfaError {
    /// There is no state.
    #[error("the automaton has no state: give at least one")]
    NoStates,
    /// The start state is not a row of the table.
    #[error("the start state {start} does not exist: states are numbered from 0 to {last}", last = states - 1)]
    BadStart {
        /// The start state as given.
        start: usize,
        /// The number of states.
        states: usize,
    },
    /// The table does not have one row for every state.
    #[error("the table must have one row for each of {states} states, and has {rows}")]
    Rows {
        /// The number of rows.
        rows: usize,
        /// The number of states.
        states: usize,
    },
    /// A row does not have one entry for every symbol.
    #[error(
        "row {state} must have one next state for each of {symbols} symbols, and has {entries}"
    )]
    Columns {
        /// The row, from 0.
        state: usize,
        /// The number of its entries.
        entries: usize,
        /// The number of symbols.
        symbols: usize,
    },
    /// The table does not have one entry for every state and symbol.
    #[error(
        "the table must have an entry for each of {states} states and {symbols} symbols, and has {entries}"
    )]
    Entries {
        /// The number of entries.
        entries: usize,
        /// The number of states.
        states: usize,
        /// The number of symbols.
        symbols: usize,
    },
    /// An entry names a state that does not exist.
    #[error(
        "row {state}, symbol {symbol}: state {target} does not exist, states are numbered from 0 to {last}", last = states - 1
    )]
    BadTarget {
        /// The row, from 0.
        state: usize,
        /// The column, from 0.
        symbol: usize,
        /// The entry.
        target: usize,
        /// The number of states.
        states: usize,
    },
}

impl Dfa {
    /// The automaton with this table: `delta[state][symbol]` is the next state,
    /// and `accepting` has one entry a state.
    ///
    /// # Errors
    ///
    /// If the table is not complete or names a state that does not exist.
    pub fn new(
        alphabet: Alphabet,
        start: usize,
        accepting: Vec<bool>,
        delta: &[Vec<usize>],
    ) -> Result<Self, DfaError> {
        let (states, symbols) = (accepting.len(), alphabet.len());
        if start < states && delta.len() != states {
            return Err(DfaError::Rows {
                rows: delta.len(),
                states,
            });
        }
        let is_short_or_long = |row: &Vec<usize>| row.len() != symbols;
        if let Some(state) = delta.iter().position(is_short_or_long) {
            return Err(DfaError::Columns {
                state,
                entries: delta[state].len(),
                symbols,
            });
        }
        Self::from_targets(alphabet, start, accepting, delta.iter().flatten().copied())
    }

    /// The automaton with this table, row by row: `targets` has the next states of
    /// state 0 in the order of the symbols, then those of state 1.
    ///
    /// # Errors
    ///
    /// If the table is not complete or names a state that does not exist.
    pub fn from_targets(
        alphabet: Alphabet,
        start: usize,
        accepting: Vec<bool>,
        targets: impl IntoIterator<Item = usize>,
    ) -> Result<Self, DfaError> {
        let (states, symbols) = (accepting.len(), alphabet.len());
        if states == 0 {
            return Err(DfaError::NoStates);
        }
        if start >= states {
            return Err(DfaError::BadStart { start, states });
        }
        let mut delta = Vec::with_capacity(states * symbols);
        for (entry, target) in targets.into_iter().enumerate() {
            if target >= states {
                return Err(DfaError::BadTarget {
                    state: entry / symbols,
                    symbol: entry % symbols,
                    target,
                    states,
                });
            }
            delta.push(StateId::new(target));
        }
        if delta.len() != states * symbols {
            return Err(DfaError::Entries {
                entries: delta.len(),
                states,
                symbols,
            });
        }
        Ok(Self {
            alphabet,
            start: StateId::new(start),
            accepting,
            delta,
        })
    }

    /// The automaton with a table that the operations of this crate have made,
    /// row-major.
    pub(crate) fn from_table(
        alphabet: Alphabet,
        start: StateId,
        accepting: Vec<bool>,
        delta: Vec<StateId>,
    ) -> Self {
        debug_assert!(start.index() < accepting.len());
        debug_assert_eq!(delta.len(), accepting.len() * alphabet.len());
        debug_assert!(delta.iter().all(|q| q.index() < accepting.len()));
        Self {
            alphabet,
            start,
            accepting,
            delta,
        }
    }

    /// The alphabet over which this automaton reads.
    pub fn alphabet(&self) -> &Alphabet {
        &self.alphabet
    }

    /// The number of states, at least 1.
    pub fn size(&self) -> usize {
        self.accepting.len()
    }

    /// All states in the order of the table.
    pub fn states(&self) -> impl DoubleEndedIterator<Item = StateId> + ExactSizeIterator + use<> {
        (0..self.size()).map(StateId::new)
    }

    /// The state before the first symbol.
    pub fn start(&self) -> StateId {
        self.start
    }

    /// Whether a word that ends in `state` is accepted.
    pub fn is_accepting(&self, state: StateId) -> bool {
        self.accepting[state.index()]
    }

    /// The state after reading `symbol` in `state`.
    pub fn next(&self, state: StateId, symbol: Symbol) -> StateId {
        // A foreign symbol would read another state's row.
        debug_assert!(symbol.index() < self.alphabet.len());
        self.delta[state.index() * self.alphabet.len() + symbol.index()]
    }

    /// The state in which `word` ends.
    pub fn run(&self, word: &Word) -> StateId {
        word.iter()
            .fold(self.start, |state, symbol| self.next(state, symbol))
    }

    /// Whether `word` is in the language.
    pub fn accepts(&self, word: &Word) -> bool {
        self.is_accepting(self.run(word))
    }
}
