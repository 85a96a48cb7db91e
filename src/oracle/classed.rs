//! Any concept of any class as what a scripted teacher has in mind.

use std::fmt;
use std::hash::{Hash, Hasher};

use rand::seq::IndexedRandom;
use rand_chacha::ChaCha8Rng;

use super::order::{compare_places, drawn_place, mixed};
use super::scripted::Goal;
use super::{Counterexamples, Order};
use crate::concept::ConceptClass;
use crate::evidence::Comparison;

/// So many atoms are drawn at a time in search of a counterexample.
const DRAWN: usize = 64;
/// One of so many of the simplest counterexamples is given where none is drawn.
const SIMPLEST: usize = 16;

/// A concept of a class. The class knows nothing but its universe.
///
/// The order [`Order::Ordered`] is the cost-based one of Examples 3 and 5, as far
/// as the class knows one ([`ConceptClass::end`]): what is accepted is above what
/// is rejected; of two that are rejected the better is closer to being accepted,
/// and of two that are accepted the one that leaves more room. All else is a tie.
pub struct ClassGoal<C: ConceptClass> {
    class: C,
    concept: C::Concept,
    order: Order,
    seed: u64,
}

impl<C: ConceptClass> ClassGoal<C> {
    /// This concept, with an order of this kind; the seed decides a random one.
    pub fn new(class: C, concept: C::Concept, order: Order, seed: u64) -> Self {
        Self {
            class,
            concept,
            order,
            seed,
        }
    }
}

impl<C: ConceptClass> fmt::Debug for ClassGoal<C> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("ClassGoal")
            .field("concept", &self.concept)
            .field("order", &self.order)
            .field("seed", &self.seed)
            .finish_non_exhaustive()
    }
}

impl<C: ConceptClass> Goal for ClassGoal<C> {
    type Atom = C::Atom;
    type Concept = C::Concept;

    fn contains(&self, atom: &C::Atom) -> bool {
        self.class.contains(&self.concept, atom)
    }

    fn compare(&self, first: &C::Atom, second: &C::Atom) -> Comparison {
        match self.order {
            Order::Ordered => {
                let [first, second] = [first, second].map(|atom| {
                    let end = self.class.end(&self.concept, atom);
                    (end.is_inside(), end.merit())
                });
                match first.cmp(&second) {
                    std::cmp::Ordering::Less => Comparison::Second,
                    std::cmp::Ordering::Equal => Comparison::Equal,
                    std::cmp::Ordering::Greater => Comparison::First,
                }
            }
            Order::Random => {
                let [first, second] = [first, second].map(|atom| {
                    let mut fingerprint = Fingerprint(mixed(0, self.seed));
                    atom.hash(&mut fingerprint);
                    drawn_place(fingerprint.finish(), self.contains(atom))
                });
                compare_places(first, second)
            }
        }
    }

    fn refute(
        &self,
        hypothesis: &C::Concept,
        counterexamples: Counterexamples,
        random: &mut ChaCha8Rng,
    ) -> Option<C::Atom> {
        let simplest = |count| {
            let one = self.class.witnesses(&self.concept, hypothesis, count);
            let other = self.class.witnesses(hypothesis, &self.concept, count);
            let mut both = [one, other].concat();
            both.sort_unstable();
            both
        };
        if counterexamples == Counterexamples::Shortest {
            return simplest(1).into_iter().next();
        }
        let simplest = simplest(SIMPLEST);
        if simplest.is_empty() {
            return None;
        }
        let differs = |atom: &C::Atom| self.contains(atom) != self.class.contains(hypothesis, atom);
        let mut drawn = self.class.draw(hypothesis, DRAWN, random);
        drawn.extend(self.class.draw(&self.concept, DRAWN, random));
        drawn.retain(differs);
        // Two that differ little differ on few atoms.
        drawn
            .choose(random)
            .or_else(|| simplest.choose(random))
            .cloned()
    }
}

/// A hash that is the same on every machine.
struct Fingerprint(u64);

impl Hasher for Fingerprint {
    fn write(&mut self, bytes: &[u8]) {
        for &byte in bytes {
            self.write_u64(u64::from(byte));
        }
    }

    fn write_u8(&mut self, item: u8) {
        self.write_u64(u64::from(item));
    }

    fn write_u32(&mut self, item: u32) {
        self.write_u64(u64::from(item));
    }

    fn write_u64(&mut self, item: u64) {
        self.0 = mixed(self.0, item);
    }

    fn write_usize(&mut self, item: usize) {
        self.write_u64(item as u64);
    }

    fn finish(&self) -> u64 {
        self.0
    }
}
