//! How likely every concept is, given the answers, and how this teacher seems
//! to answer comparisons: each is estimated from the other.

use super::{Answer, tune};
use crate::concept::{ConceptClass, Ending, Odds, Spread};
use crate::evidence::Comparison;

/// Rounds of the estimation; it has settled by then.
const ROUNDS: usize = 4;

/// What is believed of a teacher before any answer, as numbers of answers seen:
/// agreeing with the labels, incomparable.
const DIFFERENT: [f64; 2] = [4.5, 0.5];
/// Strict, tied, incomparable.
const SAME: [f64; 3] = [1.2, 1.0, 0.8];

/// Concepts less likely than this share of the likeliest are forgotten.
const NEGLIGIBLE: f64 = 1e-7;

/// The posterior distribution.
pub(super) struct Posterior<C> {
    /// The likeliest first.
    pub(super) concepts: Vec<C>,
    /// Their chances, which sum to 1.
    pub(super) weights: Vec<f64>,
    /// How this teacher seems to answer.
    pub(super) odds: Odds,
    pub(super) exact: bool,
}

/// What is believed of a teacher before any answer.
pub(super) fn expected_odds() -> Odds {
    odds(DIFFERENT, SAME, SAME)
}

fn odds(different: [f64; 2], place: [f64; 3], label: [f64; 3]) -> Odds {
    let shares = |counts: [f64; 3]| {
        let sum: f64 = counts.iter().sum();
        counts.map(|count| count / sum)
    };
    Odds {
        incomparable: different[1] / (different[0] + different[1]),
        same_place: shares(place),
        same_label: shares(label),
    }
}

impl<C: Clone> Posterior<C> {
    /// The posterior of what is in the spread.
    pub(super) fn new<K>(class: &K, spread: Spread<C>, answers: &[Answer<K::Atom>]) -> Self
    where
        K: ConceptClass<Concept = C>,
    {
        let endings: Vec<Vec<Ending>> = (spread.concepts.iter())
            .map(|weighted| {
                let ending = |(first, second, _): &Answer<K::Atom>| {
                    ending(class, &weighted.concept, first, second)
                };
                answers.iter().map(ending).collect()
            })
            .collect();
        let mut current = expected_odds();
        let mut weights = Vec::new();
        for round in 0..ROUNDS {
            weights = chances(&spread, &endings, answers, &current);
            if round + 1 < ROUNDS && tune("LEARN", 1.0) > 0.0 {
                current = estimate(&weights, &endings, answers);
            }
        }
        let mut order: Vec<usize> = (0..weights.len()).collect();
        order.sort_by(|&one, &other| weights[other].total_cmp(&weights[one]));
        let top = order.first().map_or(0.0, |&place| weights[place]);
        order.retain(|&place| weights[place] >= top * NEGLIGIBLE);
        Self {
            concepts: (order.iter())
                .map(|&place| spread.concepts[place].concept.clone())
                .collect(),
            weights: order.iter().map(|&place| weights[place]).collect(),
            odds: current,
            exact: spread.exact,
        }
    }
}

/// How two atoms end.
pub(super) fn ending<K: ConceptClass>(
    class: &K,
    concept: &K::Concept,
    first: &K::Atom,
    second: &K::Atom,
) -> Ending {
    let place = class.place(concept, first);
    let same = place.is_some() && place == class.place(concept, second);
    Ending::of(
        class.contains(concept, first),
        class.contains(concept, second),
        same,
    )
}

fn chances<A, C>(
    spread: &Spread<C>,
    endings: &[Vec<Ending>],
    answers: &[Answer<A>],
    odds: &Odds,
) -> Vec<f64> {
    let logs: Vec<[f64; 4]> = (answers.iter())
        .map(|(_, _, answer)| Ending::ALL.map(|ending| odds.chance(ending, *answer).ln()))
        .collect();
    let mut weights: Vec<f64> = (spread.concepts.iter().zip(endings))
        .map(|(weighted, endings)| {
            let likelihood: f64 = (endings.iter().zip(&logs))
                .map(|(&ending, logs)| logs[ending as usize])
                .sum();
            weighted.log_weight + likelihood
        })
        .collect();
    let top = weights.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    for weight in &mut weights {
        *weight = (*weight - top).exp();
    }
    let sum: f64 = weights.iter().sum();
    weights.iter_mut().for_each(|weight| *weight /= sum);
    weights
}

/// The odds under which the answers are as expected, seen with these weights.
fn estimate<A>(weights: &[f64], endings: &[Vec<Ending>], answers: &[Answer<A>]) -> Odds {
    let (mut different, mut place, mut label) = (DIFFERENT, SAME, SAME);
    for (weight, endings) in weights.iter().zip(endings) {
        if *weight < 1e-9 {
            continue;
        }
        for (ending, (_, _, answer)) in endings.iter().zip(answers) {
            let (strict, index) = match answer {
                Comparison::First | Comparison::Second => (0, 0),
                Comparison::Equal => (0, 1),
                Comparison::Incomparable => (1, 2),
            };
            match ending {
                Ending::SamePlace => place[index] += weight,
                Ending::SameLabel => label[index] += weight,
                _ => different[strict] += weight,
            }
        }
    }
    odds(different, place, label)
}
