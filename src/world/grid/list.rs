//! The words that can be shown, simplest first: a trajectory grows step by step,
//! and every word is told when the first one is complete.

use std::collections::BTreeMap;

use automata::{Symbol, Word};

use super::super::Listing;
use super::super::machine::Machine;
use super::Grid;
use super::path::Move;

/// The cells that a listing steps on, word by word and step by step, for each
/// word wanted.
const WORK_PER_WORD: usize = 60;

/// A prefix of words, with the place before its last symbol.
struct Prefix {
    before: Option<(usize, Symbol)>,
    /// The machine's state after it.
    state: u32,
    /// The cells reached with exactly this word so far, or that come next.
    seen: Vec<u32>,
    told: bool,
}

/// By cell the fewest turns of a way there, for each heading.
type Front = BTreeMap<(usize, u32), [u32; 5]>;

/// No way has this heading.
const NO_WAY: u32 = u32::MAX;

/// Where the turns of a heading stand.
fn place(heading: Option<Move>) -> usize {
    heading.map_or(4, |heading| heading as usize)
}

impl Grid {
    /// The simplest words that the machine accepts and that can be shown, by the
    /// fewest steps, then the fewest turns, then in the order of words. At least
    /// the words of one number of steps, and then about `most`, all if that is
    /// not too much work.
    pub(in crate::world) fn list(&self, machine: &Machine, most: usize) -> Listing {
        let mut listing = Listing {
            words: Vec::new(),
            complete: true,
        };
        let Some(start) = machine.start() else {
            return listing;
        };
        let mut prefixes = vec![Prefix {
            before: None,
            state: start,
            seen: Vec::new(),
            told: false,
        }];
        let mut children: BTreeMap<(usize, Symbol), usize> = BTreeMap::new();
        let mut front = Front::new();
        for &start in &self.starts {
            front.insert((0, start as u32), [NO_WAY, NO_WAY, NO_WAY, NO_WAY, 0]);
        }
        let mut work = most * WORK_PER_WORD;
        for steps in 0..=self.steps {
            tell(&mut prefixes, &front, machine, &mut listing.words);
            if front.is_empty() || steps == self.steps {
                return listing;
            }
            if listing.words.len() >= most || work < front.len() {
                break;
            }
            work -= front.len();
            front = self.grow(&front, machine, &mut prefixes, &mut children);
        }
        listing.complete = false;
        listing
    }

    fn grow(
        &self,
        front: &Front,
        machine: &Machine,
        prefixes: &mut Vec<Prefix>,
        children: &mut BTreeMap<(usize, Symbol), usize>,
    ) -> Front {
        let mut next = Front::new();
        for (&(prefix, at), turns) in front {
            for by in Move::ALL {
                let Some(to) = self.step(at as usize, by) else {
                    continue;
                };
                let longer = match self.given(to) {
                    None => prefix,
                    Some(symbol) => {
                        let Some(state) = machine.next(prefixes[prefix].state, symbol) else {
                            continue;
                        };
                        *children.entry((prefix, symbol)).or_insert_with(|| {
                            prefixes.push(Prefix {
                                before: Some((prefix, symbol)),
                                state,
                                seen: Vec::new(),
                                told: false,
                            });
                            prefixes.len() - 1
                        })
                    }
                };
                if prefixes[longer].seen.binary_search(&(to as u32)).is_ok() {
                    continue;
                }
                let fewest = next.entry((longer, to as u32)).or_insert([NO_WAY; 5]);
                let headings = Move::ALL[..4].iter().map(|&heading| Some(heading));
                for heading in headings.chain([None]) {
                    let so_far = turns[place(heading)];
                    if so_far != NO_WAY {
                        let fewest = &mut fewest[place(by.heading(heading))];
                        *fewest = (*fewest).min(so_far + by.turns_from(heading));
                    }
                }
            }
        }
        next
    }
}

/// Takes note of the cells that were reached, and tells the words that were
/// completed by that.
fn tell(prefixes: &mut [Prefix], front: &Front, machine: &Machine, words: &mut Vec<Word>) {
    let mut told: BTreeMap<usize, u32> = BTreeMap::new();
    for (&(prefix, at), turns) in front {
        let prefix_of = &mut prefixes[prefix];
        if let Err(place) = prefix_of.seen.binary_search(&at) {
            prefix_of.seen.insert(place, at);
        }
        if !prefix_of.told && machine.is_accepting(prefix_of.state) {
            let fewest = turns.iter().copied().min().unwrap_or(NO_WAY);
            let known = told.entry(prefix).or_insert(fewest);
            *known = fewest.min(*known);
        }
    }
    let mut new: Vec<(u32, Word)> = Vec::with_capacity(told.len());
    for (prefix, turns) in told {
        prefixes[prefix].told = true;
        new.push((turns, spell(prefixes, prefix)));
    }
    new.sort_unstable();
    words.extend(new.into_iter().map(|(_, word)| word));
}

fn spell(prefixes: &[Prefix], mut prefix: usize) -> Word {
    let mut symbols = Vec::new();
    while let Some((before, symbol)) = prefixes[prefix].before {
        symbols.push(symbol);
        prefix = before;
    }
    symbols.reverse();
    Word::from(symbols)
}
