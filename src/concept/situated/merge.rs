//! Concepts that nothing tells apart are one: the simplest stands for them, and
//! their chances add up.

use std::collections::HashMap;

use automata::{Dfa, Word};
use rand::SeedableRng;
use rand::seq::SliceRandom;
use rand_chacha::ChaCha8Rng;

use super::Situated;
use crate::concept::{Failure, Sample, Spread, Weighted};
use crate::evidence::Budget;

/// For every concept that is wanted so many are searched for, as some are one; and
/// then so many times more, as often as this.
const SPARE: usize = 4;
const ROUNDS: usize = 3;

impl Situated {
    /// As [`ConceptClass::sample`](crate::concept::ConceptClass::sample).
    pub(super) fn sample_merged(
        &mut self,
        count: usize,
        seed: u64,
        budget: &mut Budget,
    ) -> Result<Sample<Dfa>, Failure> {
        let mut wanted = count;
        let mut found = self.one_round(wanted, seed, budget)?;
        for _ in 0..ROUNDS {
            if found.1 || found.0.len() >= count {
                break;
            }
            wanted *= SPARE;
            match self.one_round(wanted, seed, budget) {
                Ok(more) => found = more,
                // What is known already is good enough.
                Err(Failure::OverBudget { .. }) => break,
                Err(failure) => return Err(failure),
            }
        }
        let (mut concepts, complete) = found;
        let complete = complete && concepts.len() <= count;
        if concepts.len() > count {
            let mut random = ChaCha8Rng::seed_from_u64(seed);
            let mut places: Vec<usize> = (0..concepts.len()).collect();
            let mut places = places.partial_shuffle(&mut random, count).0.to_vec();
            places.sort_unstable();
            concepts = places
                .into_iter()
                .map(|place| concepts[place].clone())
                .collect();
        }
        Ok(Sample {
            concepts: concepts.into_iter().map(|(dfa, _)| dfa).collect(),
            complete,
        })
    }

    /// What is left of so many concepts, and whether these are all.
    fn one_round(
        &mut self,
        wanted: usize,
        seed: u64,
        budget: &mut Budget,
    ) -> Result<(Vec<(Dfa, f64)>, bool), Failure> {
        let sample = self.learned.sample(wanted, seed, budget)?;
        let unweighted = sample.concepts.into_iter().map(|dfa| (dfa, 0.0));
        Ok((self.merge(unweighted), sample.complete))
    }

    pub(super) fn merge_spread(&mut self, spread: Spread<Dfa>) -> Spread<Dfa> {
        let weighted = spread.concepts.into_iter();
        let merged = self.merge(weighted.map(|one| (one.concept, one.log_weight)));
        Spread {
            concepts: merged
                .into_iter()
                .map(|(concept, log_weight)| Weighted {
                    concept,
                    log_weight,
                })
                .collect(),
            ..spread
        }
    }

    /// One concept of every class, in the order in which the classes come, with the
    /// logarithm of the sum of the weights.
    fn merge(&mut self, concepts: impl Iterator<Item = (Dfa, f64)>) -> Vec<(Dfa, f64)> {
        let mut places: HashMap<usize, usize> = HashMap::new();
        let mut merged: Vec<(Dfa, f64)> = Vec::new();
        for (mut concept, log_weight) in concepts {
            let class = self.class_of(&concept);
            let place = *places.entry(class).or_insert(merged.len());
            let Some((stands, sum)) = merged.get_mut(place) else {
                merged.push((concept, log_weight));
                continue;
            };
            *sum = add_logs(*sum, log_weight);
            if simplicity(&concept) < simplicity(stands) {
                std::mem::swap(stands, &mut concept);
            }
        }
        merged
    }

    fn class_of(&mut self, concept: &Dfa) -> usize {
        let mut classes = std::mem::take(&mut self.classes);
        let class = classes.class_of(concept, &self.catalogue, |one, other| {
            self.separate(one, other)
        });
        self.classes = classes;
        class
    }

    /// A feasible open word on which the two differ.
    pub(super) fn separate(&self, one: &Dfa, other: &Dfa) -> Option<Word> {
        let listed = self.catalogue.difference(one, other);
        if listed.is_some() || self.catalogue.is_complete() {
            return listed.cloned();
        }
        let differ = super::product(one, other, |one, other| one != other);
        let framed = super::product(&differ, &self.frame, |differ, frame| differ && frame);
        if framed.is_empty() {
            return None;
        }
        let open = self.open_difference(one, other);
        self.world.simplest(&open, 1).pop()
    }
}

/// Fewer states, and then fewer edges that lead elsewhere.
fn simplicity(dfa: &Dfa) -> (usize, usize) {
    let edges = dfa.states().flat_map(|state| {
        let symbols = dfa.alphabet().symbols();
        symbols.map(move |symbol| dfa.next(state, symbol) != state)
    });
    (dfa.size(), edges.filter(|leads| *leads).count())
}

/// `ln(eᵃ + eᵇ)`.
fn add_logs(a: f64, b: f64) -> f64 {
    let (more, less) = if a > b { (a, b) } else { (b, a) };
    if less == f64::NEG_INFINITY {
        more
    } else {
        more + (less - more).exp().ln_1p()
    }
}
