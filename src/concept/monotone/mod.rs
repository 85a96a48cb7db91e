//! Monotone predicate families (section 5.3 of the dissertation, "Monotone
//! Predicate Families"), by the resolution of the parameter.
//!
//! How the chapter is read. A concept is a parameter `θ ∈ [0, 1]^d`, an atom is a
//! monotone bi-partition of the parameters, and `Φ_i` holds the parameters of the
//! uniform grid with `i` points per axis, `{0, 1/(i−1), …, 1}^d`; the text says
//! that much, and the authors' public code has the same grids. `Φ_1`, which it
//! leaves open, is the origin. The size of a concept is the least `i` whose grid
//! has its parameter, so that the union of all `Φ_i` counts every concept once.
//! Which atoms there are is a matter of the [`Family`]. A counterexample, a
//! "labeled bi-partition separating the concept", is an atom with its label.
//!
//! A preference `x ≺ y` demands `x ∈ φ_θ ⟹ y ∈ φ_θ` as everywhere (Eq. 5.4); that
//! atoms are monotone says nothing about the teacher's preferences.

mod corners;
mod family;
mod linear;
mod point;
mod search;

use std::collections::BTreeSet;
use std::collections::btree_map::{BTreeMap, Entry};

use rand::SeedableRng;
use rand::seq::SliceRandom;
use rand_chacha::ChaCha8Rng;

use self::search::{Consistent, consistent};
use super::blame::blame;
use super::{ConceptClass, Contradiction, End, Failure, Sample, Spread, Weighted, Wish, tallies};
use crate::belief::Belief;
use crate::evidence::{AnswerId, Budget, Fact};
pub use corners::Corners;
pub use family::Family;
pub use linear::{Behaviour, LinearError, LinearReward, LinearRewards};
pub use point::{Place, Point};

/// By dimensions less one: the most points per axis with which questions come
/// within a fraction of a second.
pub const MOST_POINTS: [usize; 4] = [1000, 200, 40, 16];

/// So many parameters of one size are looked at one by one.
const LISTED: u64 = 8192;
/// As many simpler atoms are listed at most.
const SIMPLER: usize = 1000;
/// Slack from 0 to 1 as a merit.
const MERITS: f64 = 1000.0;

/// The concepts of a monotone family, by the resolution of their parameters.
#[derive(Clone, Debug)]
pub struct MonotoneClass<F: Family> {
    family: F,
    finest: usize,
    facts: Vec<(Option<AnswerId>, Fact<F::Atom>)>,
}

impl<F: Family> MonotoneClass<F> {
    /// The concepts of the family with up to `finest` points per axis, at least 1.
    pub fn new(family: F, finest: usize) -> Self {
        Self {
            family,
            finest: finest.max(1),
            facts: Vec::new(),
        }
    }

    /// The family.
    pub fn family(&self) -> &F {
        &self.family
    }

    /// The consistent parameters of the grid of one size.
    fn of_size(&self, size: usize, budget: &mut Budget) -> Option<Consistent> {
        let facts: Vec<_> = self.facts.iter().map(|(_, fact)| fact).collect();
        consistent(&self.family, size, &facts, budget)
    }

    /// The least size with a consistent parameter, and these.
    fn smallest(&self, budget: &mut Budget) -> Result<(usize, Consistent), Failure> {
        for size in 1..=self.finest {
            let found = self.of_size(size, budget);
            let found = found.ok_or(Failure::OverBudget { at_least: size })?;
            if found.count() > 0 {
                return Ok((size, found));
            }
        }
        Err(Failure::Contradiction(self.contradiction(budget)))
    }

    /// Why nothing is consistent; the work that is left bounds how well it is told.
    fn contradiction(&self, budget: &mut Budget) -> Contradiction {
        blame(&self.facts, self.finest, |facts| {
            for size in 1..=self.finest {
                if consistent(&self.family, size, facts, budget)?.count() > 0 {
                    return Some(true);
                }
            }
            Some(false)
        })
    }
}

impl<F: Family> ConceptClass for MonotoneClass<F> {
    type Concept = Point;
    type Atom = F::Atom;

    fn add(&mut self, answer: Option<AnswerId>, fact: Fact<F::Atom>) {
        self.facts.push((answer, fact));
    }

    fn retract(&mut self, answer: AnswerId) {
        self.facts.retain(|(a, _)| *a != Some(answer));
    }

    fn contains(&self, concept: &Point, atom: &F::Atom) -> bool {
        self.family.contains(concept.place(), atom)
    }

    fn sample(
        &mut self,
        count: usize,
        seed: u64,
        budget: &mut Budget,
    ) -> Result<Sample<Point>, Failure> {
        let (_, found) = self.smallest(budget)?;
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let listed = found.count() <= LISTED;
        let parameters = found.draw(LISTED, &mut random);
        let mut seen = BTreeSet::new();
        let is_new = |parameter: &Point| seen.insert(self.family.key(parameter));
        let mut concepts: Vec<Point> = parameters.into_iter().filter(is_new).collect();
        let complete = listed && concepts.len() <= count;
        if concepts.len() > count {
            concepts = concepts.partial_shuffle(&mut random, count).0.to_vec();
        }
        concepts.sort_unstable();
        Ok(Sample { concepts, complete })
    }

    /// All parameters of a grid are equally likely beforehand, and the prior of
    /// the grids falls as the wish has it; a concept that is on several grids, or
    /// has several parameters, has the chances of all. Where there are too many to be
    /// listed they are drawn evenly, and of those the likeliest are kept.
    fn spread(
        &mut self,
        wish: &Wish<'_, F::Atom>,
        budget: &mut Budget,
    ) -> Result<Spread<Point>, Failure> {
        let (least, mut found) = self.smallest(budget)?;
        let belief = Belief::new(wish.heard.iter().map(Vec::len).sum());
        let mut random = ChaCha8Rng::seed_from_u64(wish.seed);
        let mut places: BTreeMap<F::Key, usize> = BTreeMap::new();
        let mut concepts: Vec<Weighted<Point>> = Vec::new();
        let mut exact = true;
        for size in least..(least + wish.sizes.max(1)).min(self.finest + 1) {
            if size > least {
                let Some(further) = self.of_size(size, budget) else {
                    exact = false;
                    break;
                };
                found = further;
            }
            let all = found.count();
            let parameters = found.draw(LISTED, &mut random);
            exact &= all == parameters.len() as u64;
            let stands_for = (all as f64 / parameters.len().max(1) as f64).ln();
            let of_size = (size as f64).ln() * self.family.dimensions() as f64;
            let prior = (size - least) as f64 * wish.decay.ln() - of_size + stands_for;
            let tallies = tallies(self, &Vec::from_iter(&parameters), wish.heard);
            for (concept, tally) in parameters.into_iter().zip(tallies) {
                let log_weight = prior + belief.log_chance(&tally);
                match places.entry(self.family.key(&concept)) {
                    // The same concept by another parameter.
                    Entry::Occupied(place) => {
                        let known = &mut concepts[*place.get()].log_weight;
                        *known = log_sum(*known, log_weight);
                    }
                    Entry::Vacant(place) => {
                        place.insert(concepts.len());
                        concepts.push(Weighted {
                            concept,
                            log_weight,
                        });
                    }
                }
            }
        }
        if concepts.len() > wish.listed {
            exact = false;
            // Among equals chance decides, not the place.
            concepts.shuffle(&mut random);
            concepts.sort_by(|one, other| other.log_weight.total_cmp(&one.log_weight));
            concepts.truncate(wish.listed);
        }
        Ok(Spread {
            concepts,
            exact,
            hurried: false,
        })
    }

    fn end(&self, concept: &Point, atom: &F::Atom) -> End {
        let slack = self.family.slack(concept, atom);
        let inside = self.contains(concept, atom);
        let merit = if inside { slack } else { 1.0 + slack };
        #[expect(clippy::cast_sign_loss, reason = "it is clamped to 0 and above")]
        let merit = (merit.clamp(0.0, 1.0) * MERITS) as u32;
        End::new(inside, None, merit)
    }

    fn witnesses(&self, inside: &Point, outside: &Point, count: usize) -> Vec<F::Atom> {
        self.family.witnesses(inside, outside, count)
    }

    fn simpler(&self, atom: &F::Atom) -> Vec<F::Atom> {
        let simpler = self.family.atoms().take_while(|other| other < atom);
        simpler.take(SIMPLER).collect()
    }

    fn atoms(&self) -> Box<dyn Iterator<Item = F::Atom> + '_> {
        self.family.atoms()
    }

    fn draw(&self, hypothesis: &Point, count: usize, random: &mut ChaCha8Rng) -> Vec<F::Atom> {
        self.family.draw(hypothesis, count, random)
    }

    fn drawn_from(&self, _hypothesis: &Point) -> String {
        self.family.drawn_from()
    }
}

/// The logarithm of the sum of two numbers given by theirs.
fn log_sum(one: f64, other: f64) -> f64 {
    let (high, low) = (one.max(other), one.min(other));
    high + (low - high).exp().ln_1p()
}
