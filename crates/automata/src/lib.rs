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
//!   lexicographically; [`Alphabet::words`] lists all of them.
//! - [`Dfa`]: a complete deterministic automaton as a dense table.
//!   - languages: [`Dfa::complement`], [`Dfa::and`], [`Dfa::or`], [`Dfa::xor`],
//!     [`Dfa::product`];
//!   - forms: [`Dfa::minimise`], [`Dfa::canonical`], [`Dfa::reordered`];
//!   - questions: [`Dfa::is_equivalent`], [`Dfa::shortest_difference`],
//!     [`Dfa::is_empty`], [`Dfa::shortest_accepted`], [`Dfa::is_finite`],
//!     [`Dfa::reachable`], [`Dfa::live`];
//!   - words: [`Dfa::accepted_words`] in order, [`Dfa::count_of_length`],
//!     [`Dfa::count_up_to`], and [`Dfa::word_counts`] to draw some uniformly.

mod alphabet;
mod canonical;
mod count;
mod dfa;
mod explore;
mod minimise;
mod product;
mod witness;
mod word;
mod words;

pub use alphabet::{Alphabet, AlphabetError, Symbol, UnknownSymbol};
pub use count::WordCounts;
pub use dfa::{Dfa, DfaError, StateId};
pub use num_bigint::BigUint;
pub use product::AlphabetMismatch;
pub use word::Word;
pub use words::{AcceptedWords, Words};
