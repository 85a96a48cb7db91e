//! Words over a finite alphabet, deterministic finite automata over them, and
//! the files in which both are kept.
//!
//! This crate is the ground floor: it knows no solver, no learner, no web and
//! no clock, and the only randomness in it is the generator that a caller
//! passes in.
//!
//! # Layout
//!
//! - [`Alphabet`], [`Symbol`]: named symbols and their dense numbers.
//! - [`Word`]: a finite sequence of symbols, ordered by length, then
//!   lexicographically.
//! - [`Dfa`]: a complete deterministic automaton as a dense table.

mod alphabet;
mod dfa;
mod word;

pub use alphabet::{Alphabet, AlphabetError, Symbol, UnknownSymbol};
pub use dfa::{Dfa, DfaError, StateId};
pub use word::Word;
