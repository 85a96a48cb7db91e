//! Trajectories drawn at random: from tile to tile, each time to any symbol that
//! can come next.

use automata::{Dfa, Symbol, Word};
use rand::RngExt;
use rand::seq::IndexedRandom;
use rand_chacha::ChaCha8Rng;

use super::{Cells, Grid, Labelling};

/// Tours that are made for a word that is wanted.
pub(in crate::world) const ATTEMPTS: usize = 64;
/// The simplest words that are drawn from where all tours missed.
const SIMPLEST: usize = 16;

impl Grid {
    /// Draws words of the language: tours until one has such a word, or else one of
    /// the simplest words.
    pub(in crate::world) fn draw(
        &self,
        language: &Dfa,
        longest: usize,
        count: usize,
        random: &mut ChaCha8Rng,
    ) -> Vec<Word> {
        let mut simplest: Option<Vec<Word>> = None;
        let draw = |_| {
            for _ in 0..ATTEMPTS {
                let tiles = random.random_range(0..=longest);
                let word = self.tour(tiles, random);
                if language.accepts(&word) {
                    return Some(word);
                }
            }
            let simplest =
                simplest.get_or_insert_with(|| self.words_in(language).take(SIMPLEST).collect());
            simplest.choose(random).cloned()
        };
        (0..count).map_while(draw).collect()
    }

    /// The word of a tour to so many tiles, or to fewer where the steps do not
    /// suffice: of the symbols that can come next any is as likely, and then any
    /// tile that gives it; the way there is a shortest one.
    fn tour(&self, tiles: usize, random: &mut ChaCha8Rng) -> Word {
        let mut word = Word::empty();
        let mut at = *self.starts.choose(random).expect("a grid has a start");
        let mut left = self.steps;
        for _ in 0..tiles {
            let reached = self.tiles_around(at, left);
            let mut symbols: Vec<usize> = Vec::new();
            for (symbol, tiles) in reached.iter().enumerate() {
                if !tiles.is_empty() {
                    symbols.push(symbol);
                }
            }
            let Some(&symbol) = symbols.choose(random) else {
                break;
            };
            let drawn = random.random_range(0..reached[symbol].len());
            let (tile, steps) = reached[symbol][drawn];
            word.push(Symbol::new(symbol));
            at = tile;
            left -= steps;
        }
        word
    }

    /// By symbol the tiles that can be the next to give one, with the steps there.
    fn tiles_around(&self, at: usize, most: usize) -> Vec<Vec<(usize, usize)>> {
        let mut reached = vec![Vec::new(); self.alphabet.len()];
        let mut seen = Cells::none(self.bits());
        let mut front = Cells::none(self.bits());
        front.insert(at);
        // What was left can be entered again, so the cell itself is not seen yet.
        for steps in 1..=most {
            let mut next = front.moved(self.stride());
            if steps == 1 && self.labelling == Labelling::EveryStep {
                next.insert(at);
            }
            next.remove(&seen);
            for (tiles, cells) in reached.iter_mut().zip(&self.coloured) {
                let entered = next.and(cells);
                tiles.extend(entered.iter().map(|tile| (tile, steps)));
                seen.add(&entered);
            }
            next.keep(&self.blank);
            seen.add(&next);
            front = next;
            if front.is_empty() {
                break;
            }
        }
        reached
    }
}
