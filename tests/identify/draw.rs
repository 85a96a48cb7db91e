//! Random instances with a known target.

use automata::{Alphabet, Dfa, Symbol, Word};
use memrep::evidence::Fact;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// A source of random instances.
pub(crate) struct Draw {
    rng: ChaCha8Rng,
}

impl Draw {
    pub(crate) fn new(seed: u64) -> Self {
        Self {
            rng: ChaCha8Rng::seed_from_u64(seed),
        }
    }

    /// A number from 0 to `below` - 1.
    pub(crate) fn number(&mut self, below: usize) -> usize {
        self.rng.random_range(0..below as u32) as usize
    }

    pub(crate) fn alphabet(letters: usize) -> Alphabet {
        Alphabet::new(["a", "b", "c", "d"].into_iter().take(letters)).expect("four good names")
    }

    pub(crate) fn word(&mut self, letters: usize, longest: usize) -> Word {
        let length = self.number(longest + 1);
        (0..length)
            .map(|_| Symbol::new(self.number(letters)))
            .collect()
    }

    pub(crate) fn dfa(&mut self, alphabet: &Alphabet, states: usize) -> Dfa {
        let row = |draw: &mut Self| (0..alphabet.len()).map(|_| draw.number(states)).collect();
        let delta: Vec<Vec<usize>> = (0..states).map(|_| row(self)).collect();
        let accepting = (0..states).map(|_| self.rng.random()).collect();
        Dfa::new(alphabet.clone(), 0, accepting, &delta).expect("targets are below `states`")
    }

    /// A fact that holds of `target`.
    pub(crate) fn fact(&mut self, target: &Dfa) -> Fact<Word> {
        let letters = target.alphabet().len();
        let longest = if letters == 1 { 9 } else { 6 };
        let (one, other) = (self.word(letters, longest), self.word(letters, longest));
        match (
            self.number(10),
            target.accepts(&one),
            target.accepts(&other),
        ) {
            (0..4, accepted, _) => Fact::Label {
                atom: one,
                accepted,
            },
            (4..7, true, false) => Fact::Below {
                worse: other,
                better: one,
            },
            (4..7, ..) => Fact::Below {
                worse: one,
                better: other,
            },
            (7..9, same, too) if same == too => Fact::Equal {
                first: one,
                second: other,
            },
            _ => Fact::Incomparable {
                first: one,
                second: other,
            },
        }
    }

    /// An alphabet of up to 3 letters, a target of up to 5 states, and facts
    /// that hold of it.
    pub(crate) fn instance(&mut self) -> (Alphabet, Dfa, Vec<Fact<Word>>) {
        let alphabet = Self::alphabet(1 + self.number(3));
        let states = 1 + self.number(5);
        let target = self.dfa(&alphabet, states);
        let most = if self.number(2) == 0 { 12 } else { 60 };
        let count = self.number(most);
        let facts = (0..count).map(|_| self.fact(&target)).collect();
        (alphabet, target, facts)
    }
}
