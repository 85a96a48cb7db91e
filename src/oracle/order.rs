//! Which of two words a scripted teacher likes better: membership-respecting
//! preorders (Definition 5.1.1) over all words.

use std::cmp::Ordering;

use automata::{Dfa, StateId, Word};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::target::sink;
use crate::evidence::Comparison;

/// Which preference order a teacher has.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Order {
    /// The order that the dissertation made for the Tomita languages.
    #[default]
    Ordered,
    /// A fixed random one.
    Random,
}

/// A membership-respecting preorder over all words.
#[derive(Clone, Debug)]
pub struct PreferenceOrder {
    target: Dfa,
    sink: Option<StateId>,
    kind: Kind,
}

#[derive(Clone, Debug)]
enum Kind {
    Ordered,
    Random { seed: u64 },
}

/// Of ten thousand words, how many belong to the second strand of a random
/// order: with this share `q`, `2q(1 − q)` is a tenth.
const SECOND_STRAND: u32 = 528;

/// Of a thousand words on some level of a random order or above it, how many are
/// above it. With this share `r`, two words of a label lie on the same level
/// with probability `(1 − r) / (1 + r)`, so that of all pairs with equal labels
/// a third is strictly ordered (as section 5.3 has it), and more than half ties.
const NEXT_LEVEL: u32 = 227;

impl PreferenceOrder {
    /// The order of this kind that respects membership in the language of
    /// `target`. The seed decides a random one.
    pub fn new(order: Order, target: &Dfa, seed: u64) -> Self {
        let target = target.minimise();
        Self {
            sink: sink(&target),
            target,
            kind: match order {
                Order::Ordered => Kind::Ordered,
                Order::Random => Kind::Random { seed },
            },
        }
    }

    /// Which of the two is better.
    pub fn compare(&self, first: &Word, second: &Word) -> Comparison {
        compare_places(self.place(first), self.place(second))
    }

    /// A word's strand (words of different strands are incomparable) and its
    /// place in it. The order is a disjoint union of total preorders, and so a
    /// preorder; had the tenth of incomparable pairs been drawn pair by pair, it
    /// would not be transitive.
    fn place(&self, word: &Word) -> (u8, Place) {
        match self.kind {
            Kind::Ordered => (0, self.ordered(word)),
            Kind::Random { seed } => self.random(word, seed),
        }
    }

    /// Section 5.3, "Tomita languages", read as a total preorder. Accepted words
    /// are above rejected ones. Of two rejected words the one that falls into
    /// the sink (the state from which nothing is accepted) later is better, and
    /// one that never does is better still; of two that never do, the one whose
    /// longest accepted prefix is longer. Of two accepted words the better is
    /// the one that has more accepted extensions by two symbols. All else is a
    /// tie.
    fn ordered(&self, word: &Word) -> Place {
        let dfa = &self.target;
        if dfa.accepts(word) {
            let end = dfa.run(word);
            let extensions = dfa.alphabet().symbols().flat_map(|a| {
                let middle = dfa.next(end, a);
                dfa.alphabet().symbols().map(move |b| (middle, b))
            });
            let accepted = extensions.filter(|&(q, b)| dfa.is_accepting(dfa.next(q, b)));
            return Place::Accepted(accepted.count());
        }
        let mut state = dfa.start();
        // One more than the length of the longest accepted prefix; 0 for none.
        let mut prefix = usize::from(dfa.is_accepting(state));
        for (read, symbol) in word.iter().enumerate() {
            if Some(state) == self.sink {
                return Place::Sunk(read);
            }
            state = dfa.next(state, symbol);
            if dfa.is_accepting(state) {
                prefix = read + 2;
            }
        }
        if Some(state) == self.sink {
            Place::Sunk(word.len())
        } else {
            Place::Rejected(prefix)
        }
    }

    /// A strand and a level drawn for this word alone, whatever was asked
    /// before.
    fn random(&self, word: &Word, seed: u64) -> (u8, Place) {
        drawn_place(fingerprint(seed, word), self.target.accepts(word))
    }
}

/// The place in a random order of an atom with this fingerprint.
pub(super) fn drawn_place(fingerprint: u64, accepted: bool) -> (u8, Place) {
    let mut random = ChaCha8Rng::seed_from_u64(fingerprint);
    let strand = u8::from(random.random_ratio(SECOND_STRAND, 10_000));
    let mut level = 0;
    while random.random_ratio(NEXT_LEVEL, 1000) {
        level += 1;
    }
    let place = if accepted {
        Place::Accepted(level)
    } else {
        Place::Rejected(level)
    };
    (strand, place)
}

/// The answer that places give, each with its strand.
pub(super) fn compare_places(first: (u8, Place), second: (u8, Place)) -> Comparison {
    if first.0 != second.0 {
        return Comparison::Incomparable;
    }
    match first.1.cmp(&second.1) {
        Ordering::Less => Comparison::Second,
        Ordering::Equal => Comparison::Equal,
        Ordering::Greater => Comparison::First,
    }
}

/// A level of a total preorder; a later variant is better.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Place {
    /// Rejected, in the sink after so many symbols.
    Sunk(usize),
    /// Rejected otherwise.
    Rejected(usize),
    /// Accepted.
    Accepted(usize),
}

/// A number that differs for different words and seeds, but for chance.
fn fingerprint(seed: u64, word: &Word) -> u64 {
    word.iter().fold(mixed(0, seed), |hash, symbol| {
        mixed(hash, symbol.index() as u64 + 1)
    })
}

/// A hash with one more item: the finaliser of `SplitMix64`.
pub(super) fn mixed(hash: u64, item: u64) -> u64 {
    let mix = |mut z: u64| {
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    };
    mix(hash
        .wrapping_add(0x9e37_79b9_7f4a_7c15)
        .wrapping_add(mix(item)))
}
