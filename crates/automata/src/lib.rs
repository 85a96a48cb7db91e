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
//! - [`Sample`]: labelled words and preferences, as files keep them.
//! - [`mod@format`]: the files in which automata and samples are kept.
//!
//! # A quick look
//!
//! ```
//! use automata::{Alphabet, Dfa, format};
//!
//! let alphabet = Alphabet::new(["wait", "go"])?;
//! // Accepts the words with an odd number of `go`.
//! let odd = Dfa::new(alphabet.clone(), 0, vec![false, true], &[vec![0, 1], vec![1, 0]])?;
//! // Accepts the words that end in `go`.
//! let ends = Dfa::new(alphabet.clone(), 0, vec![false, true], &[vec![0, 1], vec![0, 1]])?;
//!
//! let difference = odd.shortest_difference(&ends)?.expect("they differ");
//! assert_eq!(difference, alphabet.word(["go", "wait"])?);
//!
//! let both = odd.and(&ends)?.minimise();
//! let file = format::json::write(&both.clone().into());
//! assert_eq!(format::json::read(&file)?.dfa, both);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod alphabet;
mod canonical;
mod count;
mod dfa;
mod explore;
pub mod format;
mod minimise;
mod product;
mod sample;
mod witness;
mod word;
mod words;

pub use alphabet::{Alphabet, AlphabetError, Symbol, UnknownSymbol};
pub use count::WordCounts;
pub use dfa::{Dfa, DfaError, StateId};
pub use num_bigint::BigUint;
pub use product::AlphabetMismatch;
pub use sample::{Item, Sample};
pub use word::Word;
pub use words::{AcceptedWords, Words};
