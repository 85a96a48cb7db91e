//! Where behaviours come from: which words can be shown, and how they look.
//!
//! A [`World`] is a language of feasible words, a finder of witnesses, and a
//! picture: everything up to a length ([`Words`]), what a walk through a grid can
//! step on ([`Grid`]), or what was recorded ([`Pool`]). It knows automata, and must
//! not know learners.

pub mod grid;
mod machine;
mod obstacle;
pub mod pool;
mod shown;
mod words;

use automata::{Alphabet, Dfa, Word};
use rand_chacha::ChaCha8Rng;

use self::grid::{ATTEMPTS, Cell, Grid, Step};
use self::machine::Machine;
pub use self::obstacle::Obstacle;
use self::pool::{Pool, Recording};
pub use self::shown::Shown;
pub use self::words::Words;

/// A language of feasible words, a finder of witnesses, and a picture.
///
/// Every world has an order of simplicity: by the length of words, or by the steps
/// and then the turns of the simplest trajectory; then in the order of words.
#[derive(Clone, Debug)]
pub enum World {
    /// Everything up to a length.
    Words(Words),
    /// Walks through a grid.
    Grid(Grid),
    /// What was recorded.
    Pool(Pool),
}

/// What is shown for a word.
#[derive(Clone, Debug, PartialEq)]
pub enum Trajectory<'a> {
    /// The word itself.
    Word(Word),
    /// A walk, which gives exactly the word.
    Walk {
        /// Where it begins.
        from: Cell,
        /// Its steps.
        steps: Vec<Step>,
    },
    /// A recording of the word.
    Recording(&'a Recording),
}

/// Words in the order of simplicity; there is none before the last of them that is
/// left out.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Listing {
    /// The words.
    pub words: Vec<Word>,
    /// Whether these are all.
    pub complete: bool,
}

impl World {
    /// The symbols of its words.
    pub fn alphabet(&self) -> &Alphabet {
        match self {
            Self::Words(words) => words.alphabet(),
            Self::Grid(grid) => grid.alphabet(),
            Self::Pool(pool) => pool.alphabet(),
        }
    }

    /// Whether the word can be shown.
    ///
    /// # Panics
    ///
    /// Here and below, if a word or automaton is over a larger alphabet.
    pub fn is_feasible(&self, word: &Word) -> bool {
        match self {
            Self::Words(words) => word.len() <= words.longest(),
            Self::Grid(grid) => grid.has_word(&Machine::of_word(word, grid.alphabet().len())),
            Self::Pool(pool) => pool.recording(word).is_some(),
        }
    }

    /// What is shown for the word: the simplest trajectory that is exactly this
    /// word; none if it is not feasible.
    pub fn trajectory(&self, word: &Word) -> Option<Trajectory<'_>> {
        match self {
            Self::Words(words) => {
                (word.len() <= words.longest()).then(|| Trajectory::Word(word.clone()))
            }
            Self::Grid(grid) => {
                let path = grid.find(&Machine::of_word(word, grid.alphabet().len()))?;
                let (from, steps) = grid.walk(&path);
                Some(Trajectory::Walk { from, steps })
            }
            Self::Pool(pool) => pool.recording(word).map(Trajectory::Recording),
        }
    }

    /// Whether some feasible word is in the language.
    pub fn has_word(&self, language: &Dfa) -> bool {
        match self {
            Self::Grid(grid) => grid.has_word(&Machine::new(language)),
            Self::Words(_) | Self::Pool(_) => self.words_in(language).next().is_some(),
        }
    }

    /// Up to `count` of the simplest feasible words in the language, simplest
    /// first.
    pub fn simplest(&self, language: &Dfa, count: usize) -> Vec<Word> {
        self.words_in(language).take(count).collect()
    }

    /// About `most` of the simplest feasible words in the language, all if there
    /// are no more, and fewer where that takes too much work.
    pub fn list(&self, language: &Dfa, most: usize) -> Listing {
        match self {
            Self::Grid(grid) => grid.list(&Machine::new(language), most),
            Self::Words(_) | Self::Pool(_) => {
                let mut words = self.simplest(language, most + 1);
                let complete = words.len() <= most;
                words.truncate(most);
                Listing { words, complete }
            }
        }
    }

    /// All feasible words in the language, simplest first. In a grid every word
    /// costs a search; [`Self::list`] is faster for many.
    pub fn words_in<'a>(&'a self, language: &'a Dfa) -> Box<dyn Iterator<Item = Word> + 'a> {
        match self {
            Self::Words(words) => Box::new(words.words_in(language)),
            Self::Grid(grid) => Box::new(grid.words_in(language)),
            Self::Pool(pool) => Box::new(pool.words_in(language)),
        }
    }

    /// Up to `count` independent draws of feasible words in the language (fewer
    /// only if there is none), of about `longest` symbols at most where the world
    /// has longer ones; [`Self::drawn_from`] says how.
    pub fn draw(
        &self,
        language: &Dfa,
        longest: usize,
        count: usize,
        random: &mut ChaCha8Rng,
    ) -> Vec<Word> {
        match self {
            Self::Words(words) => words.draw(language, longest, count, random),
            Self::Grid(grid) => grid.draw(language, longest, count, random),
            Self::Pool(pool) => pool.draw(language, count, random),
        }
    }

    /// The distribution of [`Self::draw`], as a phrase.
    pub fn drawn_from(&self, longest: usize) -> String {
        match self {
            Self::Words(words) => format!(
                "words of up to {} symbols, every length and every word of a length equally likely",
                longest.min(words.longest())
            ),
            Self::Grid(_) => format!(
                "tours of up to {longest} tiles, every number of tiles, every symbol that can come next and every tile of it equally likely; where {ATTEMPTS} tours miss, one of the simplest behaviours"
            ),
            Self::Pool(_) => "recordings, all that differ equally likely".to_owned(),
        }
    }

    /// How far the simplest trajectory with this word goes: its steps, or the
    /// symbols where there is no more to it; none if it is not feasible.
    pub fn effort(&self, word: &Word) -> Option<usize> {
        match self {
            Self::Words(_) | Self::Pool(_) => self.is_feasible(word).then(|| word.len()),
            Self::Grid(grid) => {
                let path = grid.find(&Machine::of_word(word, grid.alphabet().len()))?;
                Some(path.steps())
            }
        }
    }

    /// A language that has every feasible word, and may have others; none if a
    /// simple one would have all words.
    pub fn outline(&self) -> Option<Dfa> {
        match self {
            Self::Words(_) => None,
            Self::Grid(grid) => grid.outline(),
            Self::Pool(pool) => pool.outline(),
        }
    }
}
