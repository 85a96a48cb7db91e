//! When a hypothesis is worth showing.
//!
//! One more question before it costs `c`, and that is lost only if the
//! hypothesis is right: otherwise the answer was needed anyway. In return it
//! may refute a hypothesis that is wrong, and so spare the equivalence query,
//! less what a counterexample would have told. So the hypothesis is shown once
//!
//! `wrong · refuted · (E − a) ≤ right · c`,
//!
//! with `E` and `a` the costs of an equivalence and a membership query.

use super::posterior::Posterior;
use super::value::Worth;
use super::{entropy, tune};
use crate::learner::Config;

/// What a counterexample tells, in membership queries.
const COUNTEREXAMPLE: f64 = 1.0;
/// How much likelier to be wrong a likeliest concept is than the posterior has
/// it, as the prior and the model of the teacher are not quite right.
const OVERCONFIDENCE: f64 = 2.0;

/// Whether the equivalence query about the likeliest concept is worth more for
/// its cost than the best other question.
pub(super) fn is_worth_showing<C>(config: &Config, posterior: &Posterior<C>, other: Worth) -> bool {
    let doubt = (1.0 - posterior.weights[0]).max(0.0);
    let unsure = entropy(&[doubt, 1.0 - doubt]);
    if unsure <= 0.0 {
        return true;
    }
    // Of what is to be known about whether the hypothesis is right, the share
    // that the question tells.
    let refuted = (other.bits / unsure).min(1.0);
    let wrong = (doubt * tune("OVER", OVERCONFIDENCE)).min(1.0);
    let spared = config.equivalence_cost - tune("CEX", COUNTEREXAMPLE) * config.membership_cost;
    wrong * refuted * spared <= (1.0 - wrong) * other.cost
}
