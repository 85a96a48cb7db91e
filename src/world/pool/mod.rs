//! The world of recordings: only the trajectories that were uploaded can be
//! shown.

mod media;
mod reader;

use automata::{Alphabet, Dfa, Symbol, Word};
use rand::seq::IndexedRandom;
use rand_chacha::ChaCha8Rng;

use super::machine::Machine;
pub use media::{Media, MediaError};
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
}

/// Uploaded trajectories, as a tree of their words.
#[derive(Clone, Debug)]
pub struct Pool {
    alphabet: Alphabet,
    recordings: Vec<Recording>,
    /// The different words in order, each with the recording that is shown.
    words: Vec<(Word, usize)>,
    /// The nodes of the tree in the order in which the words need them; the
    /// parent and the symbol of each.
    parents: Vec<u32>,
    symbols: Vec<Symbol>,
    /// For every word, its last node and how many nodes the words up to it need.
    ends: Vec<(u32, u32)>,
}

impl Pool {
    /// The pool of these recordings, whose words are over the alphabet and whose
    /// names differ: [`PoolReader`] has seen to that.
    fn new(alphabet: Alphabet, recordings: Vec<Recording>) -> Self {
        let mut order: Vec<usize> = (0..recordings.len()).collect();
        // What is complete is shown rather than a prefix that looks the same.
        order.sort_by_key(|&at| (&recordings[at].word, !recordings[at].complete, at));
        let mut words: Vec<(Word, usize)> = Vec::new();
        for at in order {
            let word = &recordings[at].word;
            if words.last().is_none_or(|(last, _)| last != word) {
                words.push((word.clone(), at));
            }
        }
        let mut pool = Self {
            alphabet,
            recordings,
            words,
            parents: vec![0],
            symbols: vec![Symbol::new(0)],
            ends: Vec::new(),
        };
        pool.plant();
        pool
    }

    /// Builds the tree. Words of one length come in lexicographic order, so that
    /// the children of a node come in the order of their symbols for each length.
    fn plant(&mut self) {
        let symbols = self.alphabet.len();
        let mut children: Vec<u32> = vec![0; symbols];
        for (word, _) in &self.words {
            let mut node = 0_u32;
            for symbol in word.iter() {
                let slot = node as usize * symbols + symbol.index();
                if children[slot] == 0 {
                    children[slot] = self.parents.len() as u32;
                    self.parents.push(node);
                    self.symbols.push(symbol);
                    children.resize(children.len() + symbols, 0);
                }
                node = children[slot];
            }
            self.ends.push((node, self.parents.len() as u32));
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
        let found = self.words.binary_search_by(|(known, _)| known.cmp(word));
        found.ok().map(|at| &self.recordings[self.words[at].1])
    }

    /// The number of different words.
    pub fn different(&self) -> usize {
        self.words.len()
    }

    /// The places of the words in the language, in order.
    fn accepted(&self, machine: Machine) -> impl Iterator<Item = usize> + '_ {
        // The machine's state after every node so far.
        let mut states: Vec<Option<u32>> = vec![machine.start()];
        let useful = if machine.start().is_some() {
            self.ends.len()
        } else {
            0
        };
        let ends = self.ends[..useful].iter().enumerate();
        ends.filter_map(move |(place, &(end, needed))| {
            for node in states.len()..needed as usize {
                let before = states[self.parents[node] as usize];
                states.push(before.and_then(|state| machine.next(state, self.symbols[node])));
            }
            states[end as usize]
                .is_some_and(|state| machine.is_accepting(state))
                .then_some(place)
        })
    }

    pub(super) fn words_in(&self, language: &Dfa) -> impl Iterator<Item = Word> + use<'_> {
        let found = self.accepted(Machine::new(language));
        found.map(|place| self.words[place].0.clone())
    }

    /// Every different word is as likely.
    pub(super) fn draw(
        &self,
        language: &Dfa,
        count: usize,
        random: &mut ChaCha8Rng,
    ) -> Vec<Word> {
        let places: Vec<usize> = self.accepted(Machine::new(language)).collect();
        let draw = |_| Some(self.words[*places.choose(random)?].0.clone());
        (0..count).filter_map(draw).collect()
    }
}
