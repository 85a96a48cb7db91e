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

use super::entropy;
use super::value::Worth;
use crate::learner::Config;

/// What a counterexample tells, in membership queries whose answers are right.
const COUNTEREXAMPLE: f64 = 1.0;
/// The same where answers may be wrong: nothing else is certain then.
const CERTAIN_COUNTEREXAMPLE: f64 = 1.5;
/// A doubted answer tells this share of a certain one at least: nobody could be
/// taught by coin flips.
const LEAST_TOLD: f64 = 0.1;

/// Whether the equivalence query about the likeliest concept, right with the
/// chance `right`, is worth more for its cost than the best other question, if
/// answers are wrong at the rate `wrong`.
pub(super) fn is_worth_showing(config: &Config, right: f64, other: Worth, wrong: f64) -> bool {
    let doubt = (1.0 - right).max(0.0);
    let unsure = entropy(&[doubt, 1.0 - doubt]);
    if unsure <= 0.0 {
        return true;
    }
    // Of what is to be known about whether the hypothesis is right, the share
    // that the question tells.
    let refuted = (other.bits / unsure).min(1.0);
    let told = if wrong > 0.0 {
        // By the capacity of a binary symmetric channel.
        let capacity = 1.0 - entropy(&[wrong, 1.0 - wrong]);
        CERTAIN_COUNTEREXAMPLE / capacity.max(LEAST_TOLD)
    } else {
        COUNTEREXAMPLE
    };
    let spared = config.equivalence_cost - told * config.membership_cost;
    doubt * refuted * spared <= right * other.cost
}
