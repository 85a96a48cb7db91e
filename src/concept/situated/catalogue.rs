//! The simplest words that can be shown and are open, as a tree: what tells two
//! concepts apart is nearly always among them.

use std::collections::HashMap;

use automata::{Dfa, StateId, Symbol, Word};

use crate::world::World;

/// The most words.
const WORDS: usize = 1000;
/// The most nodes of the tree; long words need many.
const NODES: usize = 4000;
/// If the world lists fewer words than this, the others are searched for.
const SEARCHED: usize = 128;

/// The simplest words, simplest first.
pub(super) struct Catalogue {
    words: Vec<Word>,
    /// Whether there are no others.
    complete: bool,
    /// The parent and the symbol of every node, in the order in which the words
    /// need them; and of every word its last node and how many it needs.
    parents: Vec<u32>,
    symbols: Vec<Symbol>,
    ends: Vec<(u32, u32)>,
}

impl Catalogue {
    /// The simplest words of the language that the world can show.
    pub(super) fn new(world: &World, language: &Dfa) -> Self {
        let mut listing = world.list(language, WORDS);
        if !listing.complete && listing.words.len() < SEARCHED {
            listing.words = world.simplest(language, SEARCHED);
            listing.complete = listing.words.len() < SEARCHED;
        }
        let mut catalogue = Self {
            words: Vec::new(),
            complete: listing.complete,
            parents: vec![0],
            symbols: vec![Symbol::new(0)],
            ends: Vec::new(),
        };
        let mut children: HashMap<(u32, Symbol), u32> = HashMap::new();
        for word in listing.words {
            if catalogue.parents.len() > NODES {
                catalogue.complete = false;
                break;
            }
            let mut node = 0;
            for symbol in word.iter() {
                node = *children.entry((node, symbol)).or_insert_with(|| {
                    catalogue.parents.push(node);
                    catalogue.symbols.push(symbol);
                    catalogue.parents.len() as u32 - 1
                });
            }
            let needed = catalogue.parents.len() as u32;
            catalogue.ends.push((node, needed));
            catalogue.words.push(word);
        }
        catalogue
    }

    pub(super) fn words(&self) -> &[Word] {
        &self.words
    }

    pub(super) fn is_complete(&self) -> bool {
        self.complete
    }

    /// Whether the automaton accepts them, word by word.
    fn labels(&self, dfa: &Dfa) -> impl Iterator<Item = bool> {
        let mut states: Vec<StateId> = Vec::with_capacity(self.parents.len());
        states.push(dfa.start());
        self.ends.iter().map(move |&(end, needed)| {
            for node in states.len()..needed as usize {
                let before = states[self.parents[node] as usize];
                states.push(dfa.next(before, self.symbols[node]));
            }
            dfa.is_accepting(states[end as usize])
        })
    }

    /// The words that `inside` accepts and `outside` rejects.
    pub(super) fn witnesses(&self, inside: &Dfa, outside: &Dfa) -> impl Iterator<Item = &Word> {
        let labels = self.labels(inside).zip(self.labels(outside));
        labels
            .zip(&self.words)
            .filter(|((inside, outside), _)| *inside && !outside)
            .map(|(_, word)| word)
    }

    /// The labels of the first `count` words, as bits.
    pub(super) fn signature(&self, dfa: &Dfa, count: usize) -> Vec<u64> {
        let count = count.min(self.words.len());
        let mut bits = vec![0; count.div_ceil(64)];
        for (place, label) in self.labels(dfa).take(count).enumerate() {
            bits[place / 64] |= u64::from(label) << (place % 64);
        }
        bits
    }

    /// The first word on which the two differ.
    pub(super) fn difference(&self, one: &Dfa, other: &Dfa) -> Option<&Word> {
        let mut labels = self.labels(one).zip(self.labels(other));
        let place = labels.position(|(one, other)| one != other)?;
        self.words.get(place)
    }
}
