//! Thresholded linear rewards as a monotone family (Eq. 5.7).

use rand::seq::IndexedRandom;
use rand_chacha::ChaCha8Rng;

use super::family::Family;
use super::point::{Place, Point};

/// A behaviour's place in [`LinearRewards`], from 0; lower is simpler.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Behaviour(pub u32);

/// Accepts the behaviours whose summed reward is above a threshold:
/// `Σ w · f(i) > δ`.
#[derive(Clone, Debug, PartialEq)]
pub struct LinearReward {
    /// `w`, one weight a feature, each in `[−1, 1]`.
    pub weights: Vec<f64>,
    /// `δ`.
    pub threshold: f64,
}

/// Why something is no family of linear rewards, or no member of it.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum LinearError {
    /// There is nothing to learn from.
    #[error("there is no behaviour: give at least one, with at least one step and one feature")]
    Empty,
    /// A step has another number of features than the first one of all.
    #[error(
        "behaviour {behaviour}, step {step} has {found} features, and the first step of all has {expected}: give every step the same features"
    )]
    Features {
        /// The behaviour, from 1.
        behaviour: usize,
        /// Its step, from 1.
        step: usize,
        /// The number of its features.
        found: usize,
        /// The number that was expected.
        expected: usize,
    },
    /// A feature is not in its range.
    #[error(
        "behaviour {behaviour}, step {step}, feature {feature} is {value}: give numbers from 0 to 1"
    )]
    Range {
        /// The behaviour, from 1.
        behaviour: usize,
        /// Its step, from 1.
        step: usize,
        /// The feature, from 1.
        feature: usize,
        /// What it is.
        value: f64,
    },
    /// A reward has another number of weights than there are features.
    #[error("there are {found} weights for {expected} features: give one weight a feature")]
    Weights {
        /// The number of weights.
        found: usize,
        /// The number of features.
        expected: usize,
    },
    /// A weight is not in its range.
    #[error("weight {weight} is {value}: give numbers from -1 to 1")]
    Weight {
        /// The weight, from 1.
        weight: usize,
        /// What it is.
        value: f64,
    },
    /// The threshold is not in its range.
    #[error(
        "the threshold is {value}: give a number from -{bound} to {bound}, the most that a sum can be"
    )]
    Threshold {
        /// What it is.
        value: f64,
        /// How far from 0 it may be.
        bound: f64,
    },
}

/// The thresholded linear rewards over some behaviours, as a monotone family.
///
/// A behaviour is a sequence of feature vectors `f(i) ∈ [0, 1]^d`, and a reward
/// looks at nothing but their sum. By Eq. 5.7 a reward is a parameter of `d + 1`
/// dimensions, of which a greater one accepts *less*; the order of the chapter has
/// a greater one accept more, so every dimension is reflected (as in Example 9):
///
/// `θ_j = (1 + w_j)/2` for `j ≤ d`, and `θ_{d+1} = (1 − δ/(dN))/2`.
///
/// `N` is the number of steps of the longest behaviour. The chapter's `δ ∈ [−d, d]`
/// holds all thresholds that matter only for `N = 1`, and is the same then.
#[derive(Clone, Debug)]
pub struct LinearRewards {
    features: usize,
    longest: usize,
    /// By behaviour and feature.
    sums: Vec<Vec<f64>>,
}

impl LinearRewards {
    /// The rewards of these behaviours, each given as its steps' features.
    ///
    /// # Errors
    ///
    /// If there is none, or a feature is missing or not from 0 to 1.
    pub fn new(behaviours: &[Vec<Vec<f64>>]) -> Result<Self, LinearError> {
        let steps = || behaviours.iter().flatten();
        let features = steps().next().map_or(0, Vec::len);
        if features == 0 {
            return Err(LinearError::Empty);
        }
        for (behaviour, steps) in behaviours.iter().enumerate() {
            for (step, values) in steps.iter().enumerate() {
                let (behaviour, step) = (behaviour + 1, step + 1);
                if values.len() != features {
                    return Err(LinearError::Features {
                        behaviour,
                        step,
                        found: values.len(),
                        expected: features,
                    });
                }
                let mut values = values.iter().copied().enumerate();
                if let Some((place, value)) = values.find(|(_, v)| !(0.0..=1.0).contains(v)) {
                    return Err(LinearError::Range {
                        behaviour,
                        step,
                        feature: place + 1,
                        value,
                    });
                }
            }
        }
        let sum = |steps: &Vec<Vec<f64>>| {
            let of = |feature: usize| steps.iter().map(|step| step[feature]).sum();
            (0..features).map(of).collect()
        };
        Ok(Self {
            features,
            longest: behaviours.iter().map(Vec::len).max().unwrap_or(0),
            sums: behaviours.iter().map(sum).collect(),
        })
    }

    /// The behaviours.
    pub fn behaviours(&self) -> impl ExactSizeIterator<Item = Behaviour> + use<> {
        (0..self.sums.len() as u32).map(Behaviour)
    }

    /// `dN`: no sum of rewards is further from 0, and no threshold need be.
    pub fn bound(&self) -> f64 {
        (self.features * self.longest) as f64
    }

    /// Whether the reward accepts the behaviour.
    ///
    /// # Errors
    ///
    /// If it has not one weight a feature, or a number out of its range.
    pub fn accepts(
        &self,
        reward: &LinearReward,
        behaviour: Behaviour,
    ) -> Result<bool, LinearError> {
        self.parameter(reward)?;
        let sum = self.sums[behaviour.0 as usize].iter();
        let total: f64 = sum
            .zip(&reward.weights)
            .map(|(sum, weight)| sum * weight)
            .sum();
        Ok(total > reward.threshold)
    }

    /// The parameter of a reward (Eq. 5.7, reflected); on no grid, maybe.
    ///
    /// # Errors
    ///
    /// If it has not one weight a feature, or a number out of its range.
    pub fn parameter(&self, reward: &LinearReward) -> Result<Vec<f64>, LinearError> {
        let LinearReward { weights, threshold } = reward;
        if weights.len() != self.features {
            return Err(LinearError::Weights {
                found: weights.len(),
                expected: self.features,
            });
        }
        let mut numbered = weights.iter().copied().enumerate();
        if let Some((place, value)) = numbered.find(|(_, w)| !(-1.0..=1.0).contains(w)) {
            return Err(LinearError::Weight {
                weight: place + 1,
                value,
            });
        }
        let bound = self.bound();
        if !(-bound..=bound).contains(threshold) {
            return Err(LinearError::Threshold {
                value: *threshold,
                bound,
            });
        }
        let weights = weights.iter().map(|weight| f64::midpoint(1.0, *weight));
        let threshold = f64::midpoint(1.0, -threshold / bound);
        Ok(weights.chain([threshold]).collect())
    }

    /// The reward of a parameter: Eq. 5.7 the other way round.
    pub fn reward(&self, parameter: &Point) -> LinearReward {
        let mut weights: Vec<f64> = parameter.coordinates().map(|at| 2.0 * at - 1.0).collect();
        // Not its negation, which has a zero below zero.
        let threshold = 0.0 - weights.pop().unwrap_or(0.0) * self.bound();
        LinearReward { weights, threshold }
    }
}

impl Family for LinearRewards {
    type Atom = Behaviour;
    type Key = Vec<bool>;

    fn dimensions(&self) -> usize {
        self.features + 1
    }

    /// Everything times the steps, so that little is rounded; sums are no less
    /// than 0, and a sum of products that grow never falls by rounding.
    fn contains(&self, parameter: Place<'_>, atom: &Behaviour) -> bool {
        let steps = f64::from(parameter.steps);
        let scaled = |tick: &u32| 2.0 * f64::from(*tick) - steps;
        let (threshold, weights) = parameter.ticks.split_last().expect("d + 1 is at least 2");
        let sums = self.sums[atom.0 as usize].iter();
        let total: f64 = sums
            .zip(weights)
            .map(|(sum, tick)| sum * scaled(tick))
            .sum();
        total > -scaled(threshold) * self.bound()
    }

    fn slack(&self, parameter: &Point, atom: &Behaviour) -> f64 {
        let reward = self.reward(parameter);
        let sums = self.sums[atom.0 as usize].iter();
        let total: f64 = sums
            .zip(&reward.weights)
            .map(|(sum, weight)| sum * weight)
            .sum();
        (total - reward.threshold) / (2.0 * self.bound())
    }

    fn key(&self, parameter: &Point) -> Vec<bool> {
        let contains = |atom| self.contains(parameter.place(), &atom);
        self.behaviours().map(contains).collect()
    }

    fn witnesses(&self, inside: &Point, outside: &Point, count: usize) -> Vec<Behaviour> {
        let (inside, outside) = (inside.place(), outside.place());
        self.behaviours()
            .filter(|atom| self.contains(inside, atom) && !self.contains(outside, atom))
            .take(count)
            .collect()
    }

    fn atoms(&self) -> Box<dyn Iterator<Item = Behaviour> + '_> {
        Box::new(self.behaviours())
    }

    fn draw(&self, _: &Point, count: usize, random: &mut ChaCha8Rng) -> Vec<Behaviour> {
        let all: Vec<Behaviour> = self.behaviours().collect();
        let draw = |_| all.choose(random).copied();
        (0..count).filter_map(draw).collect()
    }

    fn drawn_from(&self) -> String {
        format!("any of {} behaviours, all equally likely", self.sums.len())
    }
}
