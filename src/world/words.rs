//! The world in which everything can happen, up to a length.

use automata::{Alphabet, Dfa, Word};
use rand::seq::IndexedRandom;
use rand_chacha::ChaCha8Rng;

/// All words up to a length.
#[derive(Clone, Debug)]
pub struct Words {
    alphabet: Alphabet,
    longest: usize,
}

impl Words {
    /// The words of up to `longest` symbols.
    pub fn new(alphabet: Alphabet, longest: usize) -> Self {
        Self { alphabet, longest }
    }

    /// The symbols.
    pub fn alphabet(&self) -> &Alphabet {
        &self.alphabet
    }

    /// The length of the longest words.
    pub fn longest(&self) -> usize {
        self.longest
    }

    pub(super) fn words_in<'a>(&self, language: &'a Dfa) -> impl Iterator<Item = Word> + use<'a> {
        let longest = self.longest;
        let words = language.accepted_words();
        words.take_while(move |word| word.len() <= longest)
    }

    /// Every length up to the least of `longest` and the world's own that some
    /// word has is as likely, and then every word.
    pub(super) fn draw(
        &self,
        language: &Dfa,
        longest: usize,
        count: usize,
        random: &mut ChaCha8Rng,
    ) -> Vec<Word> {
        let words = language.word_counts(longest.min(self.longest));
        let lengths: Vec<usize> = (0..=words.longest())
            .filter(|&length| words.of_length(length).bits() > 0)
            .collect();
        let draw = |_| words.sample_of_length(*lengths.choose(random)?, random);
        (0..count).filter_map(draw).collect()
    }
}
