//! Behaviours with names and features, and the rewards that weigh them.

use serde::{Deserialize, Serialize};

use super::axes::snap;
use crate::concept::{
    Behaviour, ConceptClass as _, Family as _, LinearError, LinearReward, LinearRewards,
    MonotoneClass, Point,
};
use crate::evidence::{Budget, Fact};

/// One behaviour, as it is written.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BehaviourText {
    /// What it is called.
    pub name: String,
    /// One list a step, of one number a feature from 0 to 1.
    pub features: Vec<Vec<f64>>,
}

/// Behaviours, and the thresholded linear rewards over their features (Eq. 5.7).
#[derive(Clone, Debug)]
pub struct Rewards {
    features: Vec<String>,
    behaviours: Vec<BehaviourText>,
    class: MonotoneClass<LinearRewards>,
    finest: usize,
}

impl Rewards {
    /// Of these features, with parameters on grids of up to `finest` points an axis.
    ///
    /// # Errors
    ///
    /// As [`LinearRewards::new`], or if the features are not as many as their names.
    pub fn new(
        features: Vec<String>,
        behaviours: Vec<BehaviourText>,
        finest: usize,
    ) -> Result<Self, LinearError> {
        let steps: Vec<Vec<Vec<f64>>> = (behaviours
            .iter()
            .map(|behaviour| behaviour.features.clone()))
        .collect();
        let family = LinearRewards::new(&steps)?;
        let found = family.dimensions() - 1;
        if found != features.len() {
            return Err(LinearError::Weights {
                found: features.len(),
                expected: found,
            });
        }
        Ok(Self {
            features,
            behaviours,
            class: MonotoneClass::new(family, finest),
            finest,
        })
    }

    /// The family of its rewards.
    pub fn family(&self) -> &LinearRewards {
        self.class.family()
    }

    /// The points an axis of parameters has on the finest grid.
    pub fn finest(&self) -> usize {
        self.finest
    }

    /// The class of its rewards; nothing is known of them yet.
    pub fn class(&self) -> MonotoneClass<LinearRewards> {
        self.class.clone()
    }

    /// What the features are called.
    pub fn features(&self) -> &[String] {
        &self.features
    }

    /// The behaviours, in their order.
    pub fn behaviours(&self) -> &[BehaviourText] {
        &self.behaviours
    }

    /// What the behaviours are called.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.behaviours
            .iter()
            .map(|behaviour| behaviour.name.as_str())
    }

    /// What a behaviour is called.
    ///
    /// # Panics
    ///
    /// If it is of a larger family.
    pub fn name(&self, behaviour: Behaviour) -> &str {
        &self.behaviours[behaviour.0 as usize].name
    }

    /// The reward of a parameter.
    pub fn reward(&self, parameter: &Point) -> LinearReward {
        self.family().reward(parameter)
    }

    /// The simplest parameter that accepts the same behaviours as the reward.
    ///
    /// # Errors
    ///
    /// If the reward is no member of the family, or no grid has such a parameter.
    pub fn simplest_like(&self, reward: &LinearReward) -> Result<Point, String> {
        let mut known = self.class();
        for atom in self.family().behaviours() {
            let accepted = self.family().accepts(reward, atom);
            let accepted = accepted.map_err(|error| error.to_string())?;
            known.add(None, Fact::Label { atom, accepted });
        }
        let sample = known.sample(1, 0, &mut Budget::unlimited());
        sample.ok().and_then(|sample| sample.concepts.into_iter().next()).ok_or_else(|| {
            format!(
                "no reward on a grid with up to {} points per axis accepts the same behaviours as this one: raise `finest`",
                self.finest
            )
        })
    }

    pub(super) fn accepts(&self, parameter: &Point, behaviour: Behaviour) -> bool {
        self.class.contains(parameter, &behaviour)
    }

    pub(super) fn parameter(&self, weights: &[f64], threshold: f64) -> Result<Point, String> {
        let reward = LinearReward {
            weights: weights.to_vec(),
            threshold,
        };
        let parameter = self.family().parameter(&reward);
        let parameter = parameter.map_err(|error| error.to_string())?;
        snap(&parameter, self.finest).ok_or_else(|| {
            format!(
                "this reward is on no grid with up to {} points",
                self.finest
            )
        })
    }
}
