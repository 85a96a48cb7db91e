//! How likely every concept is.

use crate::concept::Spread;

/// Concepts less likely than this share of the likeliest are forgotten.
const NEGLIGIBLE: f64 = 1e-7;

/// The posterior distribution.
pub(super) struct Posterior<C> {
    /// The likeliest first.
    pub(super) concepts: Vec<C>,
    /// Their chances, which sum to 1.
    pub(super) weights: Vec<f64>,
}

impl<C> Posterior<C> {
    /// The posterior of what is in the spread.
    pub(super) fn new(spread: Spread<C>) -> Self {
        let mut weighted = spread.concepts;
        weighted.sort_by(|one, other| other.log_weight.total_cmp(&one.log_weight));
        let top = weighted
            .first()
            .map_or(0.0, |likeliest| likeliest.log_weight);
        let share = |log_weight: f64| (log_weight - top).exp();
        weighted.retain(|concept| share(concept.log_weight) >= NEGLIGIBLE);
        let sum: f64 = weighted
            .iter()
            .map(|concept| share(concept.log_weight))
            .sum();
        Self {
            weights: (weighted.iter())
                .map(|concept| share(concept.log_weight) / sum)
                .collect(),
            concepts: weighted
                .into_iter()
                .map(|concept| concept.concept)
                .collect(),
        }
    }
}
