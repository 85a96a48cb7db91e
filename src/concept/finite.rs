//! A class of finitely many concepts over finitely many atoms, given as a table.

use std::collections::BTreeMap;

use rand::seq::SliceRandom;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::blame::blame;
use super::{ConceptClass, Contradiction, Failure, Sample, Spread, Weighted, Wish, tallies};
use crate::belief::Belief;
use crate::evidence::{AnswerId, Budget, Fact};

/// An atom's row in the table of a [`FiniteClass`], from 0; lower is simpler.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct FiniteAtom(pub u32);

/// A concept's column in the table of a [`FiniteClass`], from 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct FiniteConcept(pub u32);

/// Why a table is no class.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum FiniteClassError {
    /// There is no concept.
    #[error("the class has no concept: give at least one")]
    Empty,
    /// A concept does not say of every atom whether it contains it.
    #[error("concept {concept} has {entries} entries for {atoms} atoms: give one entry an atom")]
    Entries {
        /// The concept, from 0.
        concept: usize,
        /// The number of its entries.
        entries: usize,
        /// The number of atoms.
        atoms: usize,
    },
    /// Two concepts contain the same atoms.
    #[error("concepts {first} and {second} contain the same atoms: leave one of them out")]
    Duplicate {
        /// One concept, from 0.
        first: usize,
        /// The other, from 0.
        second: usize,
    },
}

/// One concept of the table.
#[derive(Clone, Debug)]
struct Column {
    size: usize,
    contains: Vec<bool>,
}

/// Concepts given one by one, each with its size.
#[derive(Clone, Debug)]
pub struct FiniteClass {
    atoms: usize,
    columns: Vec<Column>,
    facts: Vec<(Option<AnswerId>, Fact<FiniteAtom>)>,
}

impl FiniteClass {
    /// The class of these concepts, each a size and one entry an atom that says
    /// whether the concept contains it.
    ///
    /// # Errors
    ///
    /// If there is no concept, or one lacks an entry or repeats another.
    pub fn new(
        atoms: usize,
        concepts: impl IntoIterator<Item = (usize, Vec<bool>)>,
    ) -> Result<Self, FiniteClassError> {
        let mut seen = BTreeMap::new();
        let mut columns = Vec::new();
        for (concept, (size, contains)) in concepts.into_iter().enumerate() {
            if contains.len() != atoms {
                return Err(FiniteClassError::Entries {
                    concept,
                    entries: contains.len(),
                    atoms,
                });
            }
            if let Some(first) = seen.insert(contains.clone(), concept) {
                return Err(FiniteClassError::Duplicate {
                    first,
                    second: concept,
                });
            }
            columns.push(Column { size, contains });
        }
        if columns.is_empty() {
            return Err(FiniteClassError::Empty);
        }
        Ok(Self {
            atoms,
            columns,
            facts: Vec::new(),
        })
    }

    /// All concepts of the class.
    pub fn concepts(&self) -> impl ExactSizeIterator<Item = FiniteConcept> + use<> {
        (0..self.columns.len() as u32).map(FiniteConcept)
    }

    /// The size of a concept of this class.
    ///
    /// # Panics
    ///
    /// If the concept belongs to a larger class.
    pub fn size(&self, concept: FiniteConcept) -> usize {
        self.column(concept).size
    }

    fn column(&self, concept: FiniteConcept) -> &Column {
        &self.columns[concept.0 as usize]
    }

    fn is_consistent<'a>(
        &self,
        concept: FiniteConcept,
        mut facts: impl Iterator<Item = &'a Fact<FiniteAtom>>,
    ) -> bool {
        facts.all(|fact| fact.holds(|atom| self.contains(&concept, atom)))
    }

    /// Why nothing is consistent.
    fn contradiction(&self) -> Contradiction {
        let bound = self.columns.iter().map(|c| c.size).max().unwrap_or(0);
        blame(&self.facts, bound, |facts| {
            let consistent = |concept| self.is_consistent(concept, facts.iter().copied());
            Some(self.concepts().any(consistent))
        })
    }
}

impl ConceptClass for FiniteClass {
    type Concept = FiniteConcept;
    type Atom = FiniteAtom;

    fn add(&mut self, answer: Option<AnswerId>, fact: Fact<FiniteAtom>) {
        self.facts.push((answer, fact));
    }

    fn retract(&mut self, answer: AnswerId) {
        self.facts.retain(|(a, _)| *a != Some(answer));
    }

    fn contains(&self, concept: &FiniteConcept, atom: &FiniteAtom) -> bool {
        // An atom beyond the table is in no concept.
        self.column(*concept)
            .contains
            .get(atom.0 as usize)
            .is_some_and(|contained| *contained)
    }

    fn sample(
        &mut self,
        count: usize,
        seed: u64,
        budget: &mut Budget,
    ) -> Result<Sample<FiniteConcept>, Failure> {
        let facts = || self.facts.iter().map(|(_, fact)| fact);
        let mut consistent = Vec::new();
        for concept in self.concepts() {
            if !budget.spend(1) {
                return Err(Failure::OverBudget { at_least: 0 });
            }
            if self.is_consistent(concept, facts()) {
                consistent.push(concept);
            }
        }
        let Some(least) = consistent.iter().map(|&c| self.size(c)).min() else {
            return Err(Failure::Contradiction(self.contradiction()));
        };
        consistent.retain(|&c| self.size(c) == least);
        let complete = consistent.len() <= count;
        let concepts = if complete {
            consistent
        } else {
            let mut random = ChaCha8Rng::seed_from_u64(seed);
            let mut drawn = consistent.partial_shuffle(&mut random, count).0.to_vec();
            drawn.sort_unstable();
            drawn
        };
        Ok(Sample { concepts, complete })
    }

    /// All consistent concepts: a table is never too large to be listed. Those of
    /// one size share the size's prior evenly.
    fn spread(
        &mut self,
        wish: &Wish<'_, FiniteAtom>,
        budget: &mut Budget,
    ) -> Result<Spread<FiniteConcept>, Failure> {
        let least = self.sample(1, wish.seed, budget)?;
        let least = self.size(least.concepts[0]);
        let within = least..least + wish.sizes.max(1);
        let mut of_size: BTreeMap<usize, usize> = BTreeMap::new();
        for column in &self.columns {
            *of_size.entry(column.size).or_default() += 1;
        }
        let is_consistent = |&concept: &FiniteConcept| {
            let facts = self.facts.iter().map(|(_, fact)| fact);
            within.contains(&self.size(concept)) && self.is_consistent(concept, facts)
        };
        let consistent: Vec<FiniteConcept> = self.concepts().filter(is_consistent).collect();
        let tallies = tallies(self, &Vec::from_iter(&consistent), wish.heard);
        let belief = Belief::new(wish.heard.iter().map(Vec::len).sum());
        let weighted = |(concept, tally)| {
            let size = self.size(concept);
            let rank = (size - least) as f64;
            let prior = rank * wish.decay.ln() - (of_size[&size] as f64).ln();
            Weighted {
                concept,
                log_weight: prior + belief.log_chance(tally),
            }
        };
        Ok(Spread {
            concepts: consistent.into_iter().zip(&tallies).map(weighted).collect(),
            exact: true,
            hurried: false,
        })
    }

    fn witnesses(
        &self,
        inside: &FiniteConcept,
        outside: &FiniteConcept,
        count: usize,
    ) -> Vec<FiniteAtom> {
        self.atoms()
            .filter(|atom| self.contains(inside, atom) && !self.contains(outside, atom))
            .take(count)
            .collect()
    }

    fn atoms(&self) -> Box<dyn Iterator<Item = FiniteAtom> + '_> {
        Box::new((0..self.atoms as u32).map(FiniteAtom))
    }

    fn draw(
        &self,
        _hypothesis: &FiniteConcept,
        count: usize,
        random: &mut ChaCha8Rng,
    ) -> Vec<FiniteAtom> {
        if self.atoms == 0 {
            return Vec::new();
        }
        let draw = |_| FiniteAtom(random.random_range(0..self.atoms as u32));
        (0..count).map(draw).collect()
    }

    fn drawn_from(&self, _hypothesis: &FiniteConcept) -> String {
        format!("any of {}, all equally likely", self.atoms)
    }
}
