//! When a hypothesis is worth showing.

use super::posterior::Posterior;
use super::value::Worth;
use super::{entropy, tune};
use crate::learner::Config;

/// Whether the equivalence query about the likeliest concept is worth more for
/// its cost than the best other question.
pub(super) fn is_worth_showing<C>(config: &Config, posterior: &Posterior<C>, other: Worth) -> bool {
    let sure = posterior.weights[0];
    let theta = tune("THETA", 0.0);
    if theta > 0.0 {
        return sure >= theta;
    }
    let cost = tune("EQCOST", 4.0) * config.membership_cost;
    let rate = other.cost / other.bits;
    let doubt = 1.0 - sure;
    doubt * cost < rate * (entropy(&[sure, doubt]) + doubt * tune("CEX", 1.0))
}
