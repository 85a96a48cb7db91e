//! Why a word cannot happen: the step at which the world stands in its way.

use automata::{Symbol, Word};

use super::World;

/// Why a word cannot happen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Obstacle {
    /// It has more symbols than any word of the world.
    TooLong {
        /// The most there are.
        longest: usize,
    },
    /// No walk that gave what comes before can give this next, however long.
    NoWay {
        /// The place of the symbol in the word, from 0.
        place: usize,
        /// The symbol.
        symbol: Symbol,
    },
    /// There is a way, but so far it takes more steps than a walk may make.
    TooFar {
        /// The place of the first symbol that is out of reach, from 0.
        place: usize,
        /// The symbol.
        symbol: Symbol,
        /// The steps that a walk may make.
        steps: usize,
    },
    /// Nothing like it was recorded.
    NotRecorded,
}

impl World {
    /// Why the word cannot happen; none if it can.
    ///
    /// # Panics
    ///
    /// If the word is over a larger alphabet.
    pub fn obstacle(&self, word: &Word) -> Option<Obstacle> {
        if self.is_feasible(word) {
            return None;
        }
        Some(match self {
            Self::Words(words) => Obstacle::TooLong {
                longest: words.longest(),
            },
            Self::Pool(_) => Obstacle::NotRecorded,
            Self::Grid(grid) => {
                let tireless = Self::Grid(grid.tireless());
                match tireless.stop(word) {
                    Some((place, symbol)) => Obstacle::NoWay { place, symbol },
                    // A walk that is cut short gives a beginning of the word.
                    None => match self.stop(word) {
                        Some((place, symbol)) => Obstacle::TooFar {
                            place,
                            symbol,
                            steps: grid.steps(),
                        },
                        None => return None,
                    },
                }
            }
        })
    }

    /// The first symbol up to which the word cannot happen, of a world in which
    /// all beginnings of what can happen can happen.
    fn stop(&self, word: &Word) -> Option<(usize, Symbol)> {
        let symbols: Vec<Symbol> = word.iter().collect();
        let cannot = |length: usize| {
            let beginning = symbols[..length].iter().copied().collect();
            !self.is_feasible(&beginning)
        };
        let (mut can, mut end) = (0, symbols.len());
        if !cannot(end) {
            return None;
        }
        while can + 1 < end {
            let middle = usize::midpoint(can, end);
            if cannot(middle) {
                end = middle;
            } else {
                can = middle;
            }
        }
        Some((can, symbols[can]))
    }
}
