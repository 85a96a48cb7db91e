//! Random automata for the property tests.

#![allow(dead_code, reason = "each test file uses a part")]

use automata::{Alphabet, Dfa, Symbol, Word};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// The generator of a test's numbered case.
pub(crate) fn generator(seed: u64) -> ChaCha8Rng {
    ChaCha8Rng::seed_from_u64(seed)
}

/// The alphabet `a`, `b`, … of `symbols` names.
pub(crate) fn alphabet(symbols: usize) -> Alphabet {
    Alphabet::new(["a", "b", "c", "d", "e"].into_iter().take(symbols)).unwrap()
}

/// A complete automaton with 1 to `max_states` states over `alphabet`, every
/// entry of the table, the start and the acceptance uniform.
pub(crate) fn dfa(alphabet: &Alphabet, max_states: usize, random: &mut ChaCha8Rng) -> Dfa {
    let states = random.random_range(1..=max_states);
    let delta: Vec<Vec<usize>> = (0..states)
        .map(|_| {
            (0..alphabet.len())
                .map(|_| random.random_range(0..states))
                .collect()
        })
        .collect();
    let accepting = (0..states).map(|_| random.random_bool(0.5)).collect();
    let start = random.random_range(0..states);
    Dfa::new(alphabet.clone(), start, accepting, &delta).unwrap()
}

/// A word of `0..=longest` symbols, uniform in its length.
pub(crate) fn word(alphabet: &Alphabet, longest: usize, random: &mut ChaCha8Rng) -> Word {
    let length = random.random_range(0..=longest);
    (0..length)
        .map(|_| Symbol::new(random.random_range(0..alphabet.len())))
        .collect()
}
