//! The world of recordings: only the trajectories that were uploaded can be
//! shown.

mod index;
mod media;
mod reader;

use automata::{Alphabet, Dfa, Word};
use rand::seq::IndexedRandom;
use rand_chacha::ChaCha8Rng;

use self::index::Index;
use super::machine::Machine;
pub use media::{Media, MediaError, extent};
pub use reader::{PoolError, PoolReader};

/// The most recordings of a pool.
pub const MOST_RECORDINGS: usize = 100_000;
/// The most symbols of a recording.
pub const LONGEST_RECORDING: usize = 1000;

/// One uploaded trajectory.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Recording {
    /// Its name, unique in its pool.
    pub id: String,
    /// What happens in it.
    pub word: Word,
    /// Whether this is all that happened; otherwise it was cut off, and the word
    /// is a prefix.
    pub complete: bool,
    /// What there is to see of it.
    pub media: Option<Media>,
    /// The line of the file that it stood on, from 1.
    pub line: usize,
}

/// Uploaded trajectories.
#[derive(Clone, Debug)]
pub struct Pool {
    alphabet: Alphabet,
    recordings: Vec<Recording>,
    /// The different words, and for each the recording that is shown.
    index: Index,
    shown: Vec<usize>,
}

impl Pool {
    /// The pool of these recordings, whose words are over the alphabet and whose
    /// names differ: [`PoolReader`] has seen to that.
    fn new(alphabet: Alphabet, recordings: Vec<Recording>) -> Self {
        let mut order: Vec<usize> = (0..recordings.len()).collect();
        // What is complete is shown rather than a prefix that looks the same.
        order.sort_by_key(|&at| (&recordings[at].word, !recordings[at].complete, at));
        order.dedup_by_key(|at| &recordings[*at].word);
        let words = order.iter().map(|&at| recordings[at].word.clone());
        Self {
            index: Index::new(words.collect(), &alphabet),
            shown: order,
            recordings,
            alphabet,
        }
    }

    /// The symbols of the words.
    pub fn alphabet(&self) -> &Alphabet {
        &self.alphabet
    }

    /// All recordings, in the order of the upload.
    pub fn recordings(&self) -> &[Recording] {
        &self.recordings
    }

    /// The recording that is shown for a word: of several one that is complete,
    /// and of these the first uploaded.
    pub fn recording(&self, word: &Word) -> Option<&Recording> {
        let found = self.index.words().binary_search(word);
        found.ok().map(|at| &self.recordings[self.shown[at]])
    }

    /// The number of different words.
    pub fn different(&self) -> usize {
        self.shown.len()
    }

    pub(super) fn words_in(&self, language: &Dfa) -> impl Iterator<Item = Word> + use<'_> {
        let found = self.index.accepted(Machine::new(language));
        found.map(|place| self.index.words()[place].clone())
    }

    /// Every different word is as likely.
    pub(super) fn draw(&self, language: &Dfa, count: usize, random: &mut ChaCha8Rng) -> Vec<Word> {
        let places: Vec<usize> = self.index.accepted(Machine::new(language)).collect();
        let draw = |_| Some(self.index.words()[*places.choose(random)?].clone());
        (0..count).filter_map(draw).collect()
    }

    pub(super) fn outline(&self) -> Option<Dfa> {
        self.index.outline(&self.alphabet)
    }
}
