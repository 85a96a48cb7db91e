//! What the learner computes, by trying everything: all preorders and all sets
//! of a few atoms.

use memrep::concept::{FiniteAtom, FiniteClass};
use memrep::evidence::{Comparison, Fact};
use proptest::prelude::*;

/// How many atoms there are where everything is tried.
pub(crate) const ATOMS: u32 = 4;

/// `below[x]` has bit `y` set if `x ≼ y`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Relation([u8; ATOMS as usize]);

impl Relation {
    pub(crate) fn compare(self, first: FiniteAtom, second: FiniteAtom) -> Comparison {
        let up = self.0[first.0 as usize] >> second.0 & 1 == 1;
        let down = self.0[second.0 as usize] >> first.0 & 1 == 1;
        match (up, down) {
            (true, true) => Comparison::Equal,
            (true, false) => Comparison::Second,
            (false, true) => Comparison::First,
            (false, false) => Comparison::Incomparable,
        }
    }

    fn is_transitive(self) -> bool {
        (0..ATOMS as usize).all(|x| {
            (0..ATOMS as usize).all(|y| self.0[x] >> y & 1 == 0 || self.0[y] & !self.0[x] == 0)
        })
    }

    /// Definition 5.1.1 for the set whose members are the bits of `set`.
    pub(crate) fn respects(self, set: u8) -> bool {
        (0..ATOMS as usize).all(|x| set >> x & 1 == 0 || self.0[x] & !set == 0)
    }
}

/// All 355 preorders on four atoms.
pub(crate) fn preorders() -> Vec<Relation> {
    let relations = (0u32..1 << (ATOMS * (ATOMS - 1))).map(|bits| {
        let mut rest = bits;
        let mut below = [0u8; ATOMS as usize];
        for (x, row) in below.iter_mut().enumerate() {
            for y in 0..ATOMS as usize {
                if x == y {
                    *row |= 1 << y;
                } else {
                    *row |= ((rest & 1) as u8) << y;
                    rest >>= 1;
                }
            }
        }
        Relation(below)
    });
    let found: Vec<Relation> = relations.filter(|r| r.is_transitive()).collect();
    assert_eq!(found.len(), 355, "the number of topologies on four points");
    found
}

/// All worlds: a preorder and a set that it respects.
pub(crate) fn worlds() -> Vec<(Relation, u8)> {
    preorders()
        .into_iter()
        .flat_map(|order| (0..1u8 << ATOMS).map(move |set| (order, set)))
        .filter(|(order, set)| order.respects(*set))
        .collect()
}

/// Whether a fact is true in a world.
pub(crate) fn holds(world: (Relation, u8), fact: &Fact<FiniteAtom>) -> bool {
    let (order, set) = world;
    match fact {
        Fact::Label { atom, accepted } => (set >> atom.0 & 1 == 1) == *accepted,
        Fact::Below { worse, better } => order.compare(*worse, *better) == Comparison::Second,
        Fact::Equal { first, second } => order.compare(*first, *second) == Comparison::Equal,
        Fact::Incomparable { first, second } => {
            order.compare(*first, *second) == Comparison::Incomparable
        }
    }
}

/// A random fact about four atoms.
pub(crate) fn fact() -> impl Strategy<Value = Fact<FiniteAtom>> {
    let atom = || (0..ATOMS).prop_map(FiniteAtom);
    prop_oneof![
        2 => (atom(), any::<bool>()).prop_map(|(atom, accepted)| Fact::Label { atom, accepted }),
        3 => (atom(), atom()).prop_map(|(worse, better)| Fact::Below { worse, better }),
        1 => (atom(), atom()).prop_map(|(first, second)| Fact::Equal { first, second }),
    ]
}

/// A class of some sets of four atoms, with sizes from 1 to 3.
pub(crate) fn class() -> impl Strategy<Value = FiniteClass> {
    let concept = (1usize..=3, 0..1u8 << ATOMS);
    proptest::collection::vec(concept, 1..14).prop_map(|mut concepts| {
        concepts.sort_by_key(|(_, set)| *set);
        concepts.dedup_by_key(|(_, set)| *set);
        let columns = concepts
            .into_iter()
            .map(|(size, set)| (size, (0..ATOMS).map(|atom| set >> atom & 1 == 1).collect()));
        FiniteClass::new(ATOMS as usize, columns).expect("the sets differ")
    })
}
