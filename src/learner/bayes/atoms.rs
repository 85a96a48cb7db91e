//! The atoms that questions are made of, and how they end in every concept.

use std::hash::Hash;

use rand::RngExt;
use rand_chacha::ChaCha8Rng;

use super::posterior::Posterior;
use crate::belief::{End, Heard, Tally};
use crate::concept::{ConceptClass, tallies};
use crate::learner::Learner;

/// The simplest atoms of the universe, as many.
const SIMPLEST: usize = 127;
/// Pairs of likely concepts for which an atom that separates them is added, so
/// that whatever can still be told apart is.
const PAIRS: usize = 16;
/// The concepts that questions are weighed with at most.
const CONCEPTS: usize = 200;

/// How atoms end in the likely concepts.
pub(super) struct Table<A> {
    pub(super) atoms: Vec<A>,
    /// By atom and then by concept.
    pub(super) ends: Vec<Vec<End>>,
    /// The chances of these concepts, which sum to 1.
    pub(super) weights: Vec<f64>,
    /// What was heard, as each concept sees it.
    pub(super) tallies: Vec<Tally>,
}

impl<A: Clone + Ord + Hash> Table<A> {
    /// The table for the next question.
    pub(super) fn new<C>(
        learner: &Learner<C>,
        posterior: &Posterior<C::Concept>,
        heard: &[Vec<Heard<A>>],
        random: &mut ChaCha8Rng,
    ) -> Self
    where
        C: ConceptClass<Atom = A>,
    {
        let class = &learner.class;
        let (chosen, weights) = thin(&posterior.weights, random);
        let concepts: Vec<&C::Concept> = chosen
            .iter()
            .map(|&place| &posterior.concepts[place])
            .collect();
        let mut atoms: Vec<A> = class.atoms().take(SIMPLEST).collect();
        let wanted = 1 + learner.evidence.skips();
        let mut separate = |one: &C::Concept, other: &C::Concept| {
            for (inside, outside) in [(one, other), (other, one)] {
                atoms.extend(class.witnesses(inside, outside, wanted));
            }
        };
        for other in concepts.iter().skip(1).take(PAIRS) {
            separate(concepts[0], other);
        }
        for _ in 0..PAIRS.min(concepts.len()) {
            let one = draw(&weights, random);
            let other = draw(&weights, random);
            if one != other {
                separate(concepts[one], concepts[other]);
            }
        }
        atoms.sort_unstable();
        atoms.dedup();
        let ends = class.ends(&concepts, &atoms);
        let tallies = tallies(class, &concepts, heard);
        Self {
            atoms,
            ends,
            weights,
            tallies,
        }
    }
}

fn draw(weights: &[f64], random: &mut ChaCha8Rng) -> usize {
    let mut at = random.random::<f64>();
    let found = weights.iter().position(|weight| {
        at -= weight;
        at < 0.0
    });
    found.unwrap_or(0)
}

/// At most [`CONCEPTS`] of the weights, all if possible: otherwise the large
/// ones as they are, and of the small ones a systematic sample of equal weights.
fn thin(weights: &[f64], random: &mut ChaCha8Rng) -> (Vec<usize>, Vec<f64>) {
    if weights.len() <= CONCEPTS {
        return ((0..weights.len()).collect(), weights.to_vec());
    }
    let mut step = 1.0 / CONCEPTS as f64;
    let mut large = 0;
    // The weights descend; those above the step are kept, which leaves less for
    // the others.
    let mut rest = 1.0;
    while large < CONCEPTS - 1 && weights[large] >= step {
        rest -= weights[large];
        large += 1;
        step = rest / (CONCEPTS - large) as f64;
    }
    let mut chosen: Vec<usize> = (0..large).collect();
    let mut kept = weights[..large].to_vec();
    let mut next = random.random::<f64>() * step;
    let mut sum = 0.0;
    for (place, weight) in weights.iter().enumerate().skip(large) {
        sum += weight;
        if sum > next && chosen.len() < CONCEPTS {
            chosen.push(place);
            kept.push(step);
            next += step;
        }
    }
    let sum: f64 = kept.iter().sum();
    for weight in &mut kept {
        *weight /= sum;
    }
    (chosen, kept)
}
