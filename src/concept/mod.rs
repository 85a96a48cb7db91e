//! What can be learned: a class of concepts, seen through the evidence.
//!
//! A class knows which of its concepts are consistent, smallest first, and on
//! which atoms two of them differ. It must not know bandits, costs or people.

mod blame;
mod dfa;
mod finite;
mod monotone;
mod preorder;
mod prior;
mod situated;
mod table;
mod template;

use std::fmt::Debug;
use std::hash::Hash;

use rand::seq::IndexedRandom;
use rand_chacha::ChaCha8Rng;

pub use crate::belief::{End, Ending, Heard};
use crate::belief::{Tally, compared};
use crate::evidence::{AnswerId, Budget, Fact};
pub use crate::identify::{Cause, Contradiction, Failure, Spread, Weighted, Wish};
pub use dfa::DfaClass;
pub use finite::{FiniteAtom, FiniteClass, FiniteClassError, FiniteConcept};
pub use monotone::{
    Behaviour, Corners, Family, LinearError, LinearReward, LinearRewards, MOST_POINTS,
    MonotoneClass, Place, Point,
};
pub use preorder::Preorder;
pub use prior::{Applied, Prior, PriorError};
pub use situated::Situated;
pub use table::{FiniteTable, TableError};
pub use template::{Template, TemplateError};

/// The atoms that are drawn from where a class knows no better distribution.
const DRAWN: usize = 1024;

/// Different concepts of the smallest consistent size.
#[derive(Clone, Debug)]
pub struct Sample<C> {
    /// At least one; no two contain the same atoms; simplest first.
    pub concepts: Vec<C>,
    /// Whether there are no others of this size.
    pub complete: bool,
}

/// A size-indexed class `Φ = Φ₁ ∪ Φ₂ ∪ …` of finite parts (Remark 5.1.2).
pub trait ConceptClass {
    /// One concept `φ`.
    type Concept: Clone + PartialEq + Debug;
    /// One element of the universe.
    type Atom: Clone + Ord + Hash + Debug;

    /// Adds a fact; `None` for one that is known from the start.
    fn add(&mut self, answer: Option<AnswerId>, fact: Fact<Self::Atom>);

    /// Takes back all facts of an answer.
    fn retract(&mut self, answer: AnswerId);

    /// Drops what was worked out so far and only makes the next search quicker: how
    /// far that comes on a budget is then a function of the facts alone.
    fn forget(&mut self) {}

    /// Whether `atom ∈ concept`.
    fn contains(&self, concept: &Self::Concept, atom: &Self::Atom) -> bool;

    /// Up to `count` concepts of the smallest consistent size, a function of the
    /// standing facts and `seed` alone.
    ///
    /// # Errors
    ///
    /// If no concept within the class's bound is consistent, or the budget ends.
    fn sample(
        &mut self,
        count: usize,
        seed: u64,
        budget: &mut Budget,
    ) -> Result<Sample<Self::Concept>, Failure>;

    /// Consistent concepts of several sizes with their chances after all that
    /// was heard, a function of the standing facts and the wish alone.
    ///
    /// # Errors
    ///
    /// As [`Self::sample`].
    fn spread(
        &mut self,
        wish: &Wish<'_, Self::Atom>,
        budget: &mut Budget,
    ) -> Result<Spread<Self::Concept>, Failure>;

    /// How an atom ends in the concept. Unless a class knows more, inside or
    /// outside.
    fn end(&self, concept: &Self::Concept, atom: &Self::Atom) -> End {
        End::new(self.contains(concept, atom), None, 0)
    }

    /// How each of some atoms ends in each of some concepts, by atom and then by
    /// concept: the same as [`Self::end`], for many at once.
    fn ends(&self, concepts: &[&Self::Concept], atoms: &[Self::Atom]) -> Vec<Vec<End>> {
        let of = |atom| {
            concepts
                .iter()
                .map(|concept| self.end(concept, atom))
                .collect()
        };
        atoms.iter().map(of).collect()
    }

    /// Up to `count` of the simplest atoms that `inside` contains and `outside`
    /// does not, simplest first; none exactly if `inside ⊆ outside`.
    fn witnesses(
        &self,
        inside: &Self::Concept,
        outside: &Self::Concept,
        count: usize,
    ) -> Vec<Self::Atom>;

    /// Atoms that are simpler than this one, so that a teacher who shows the
    /// simplest counterexample would have shown them first: all of them, or the
    /// simplest of very many. Unless a class knows more, none.
    fn simpler(&self, atom: &Self::Atom) -> Vec<Self::Atom> {
        let _ = atom;
        Vec::new()
    }

    /// The atoms of the universe, simplest first; endless for infinite ones.
    fn atoms(&self) -> Box<dyn Iterator<Item = Self::Atom> + '_>;

    /// `count` independent draws from the distribution of atoms by which the
    /// hypothesis is checked; none only if there is no atom. Unless a class does
    /// better, the simplest atoms, all alike.
    fn draw(
        &self,
        hypothesis: &Self::Concept,
        count: usize,
        random: &mut ChaCha8Rng,
    ) -> Vec<Self::Atom> {
        let _ = hypothesis;
        let atoms: Vec<Self::Atom> = self.atoms().take(DRAWN).collect();
        let draw = |_| atoms.choose(random).cloned();
        (0..count).filter_map(draw).collect()
    }

    /// The simplest atom, which cannot be shown, that would decide what nothing that
    /// can be shown does about this hypothesis; none where all is decided.
    fn beyond(&self, hypothesis: &Self::Concept) -> Option<Self::Atom> {
        let _ = hypothesis;
        None
    }

    /// The distribution of [`Self::draw`], as a phrase that can stand in
    /// brackets.
    fn drawn_from(&self, hypothesis: &Self::Concept) -> String {
        let _ = hypothesis;
        format!("any of the {DRAWN} simplest, all equally likely")
    }
}

/// What was heard, as each of some concepts sees it.
pub fn tallies<C: ConceptClass + ?Sized>(
    class: &C,
    concepts: &[&C::Concept],
    heard: &[Vec<Heard<C::Atom>>],
) -> Vec<Tally> {
    let facts = || heard.iter().flatten();
    let atoms: Vec<C::Atom> = (facts())
        .flat_map(|Heard { fact, .. }| match (fact, compared(fact)) {
            (Fact::Label { atom, .. }, _) => vec![atom.clone()],
            (_, Some((first, second, _))) => vec![first.clone(), second.clone()],
            (_, None) => Vec::new(),
        })
        .collect();
    let ends = class.ends(concepts, &atoms);
    let mut tallies = vec![Tally::default(); concepts.len()];
    let mut ends = ends.iter();
    for Heard { fact, sure } in facts() {
        if let Fact::Label { accepted, .. } = fact {
            for (tally, end) in tallies.iter_mut().zip(ends.next().into_iter().flatten()) {
                tally.label(end.is_inside() == *accepted, *sure);
            }
        }
        if let Some((.., verdict)) = compared(fact) {
            let pairs = (ends.next().into_iter().flatten()).zip(ends.next().into_iter().flatten());
            for (tally, (&first, &second)) in tallies.iter_mut().zip(pairs) {
                tally.comparison(Ending::of(first, second), verdict, *sure);
            }
        }
    }
    tallies
}
