//! Losses (Eq. 5.3), and the experts: one fears the worst answer, one remembers
//! what each kind of question came to, and two know what the posterior expects.

use serde::{Deserialize, Serialize};

use super::exp4::{Arms, COMPARISON, Exp4, MEMBERSHIP, softmax};
use super::{Config, Reply, Strategy};
use crate::evidence::Comparison;

/// The temperature of the experts' softmax, in units of loss. It makes the better
/// of two typical arms (a question that halves the concepts, against one that may
/// leave them all at the same cost) about seven times as probable as the other.
///
/// Losses lie in `[0, 1]`, so at 1, the authors' choice, advice hardly departs
/// from a coin's, and over Tomita's languages the share of membership queries
/// hardly depends on the costs, unlike in Tables 5.1 and 5.3. At 0.1 comparisons
/// that teach nothing are asked in long rows as soon as they are the cheaper
/// kind. In between, the tables' trade-off appears; the value was picked by it.
const TEMPERATURE: f64 = 0.25;

/// The temperature of the informed expert's softmax, as a share of the larger
/// worth. An arm that is worth half as much for its cost is pulled once in eight
/// times, whatever the unit of costs and however little is left to learn.
const KEENNESS: f64 = 0.25;

/// The loss that each answer to a question would mean: the share of the
/// concepts that it leaves, times the question's cost, divided by the larger of
/// the costs (Eq. 5.3). In `[0, 1]`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "lowercase")]
pub enum Losses {
    /// Of a membership query.
    Membership {
        /// If the atom is accepted.
        accept: f64,
        /// If it is rejected.
        reject: f64,
    },
    /// Of a comparison.
    Comparison {
        /// If the first is better.
        first: f64,
        /// If the second is better.
        second: f64,
        /// If both are equal.
        equal: f64,
        /// If they cannot be compared: nothing that refutes anything was learned,
        /// and the cost paid.
        incomparable: f64,
    },
}

impl Losses {
    /// The losses of a membership query that would leave these shares.
    pub(super) fn of_membership(config: &Config, accept: f64, reject: f64) -> Self {
        let price = price(config, config.membership_cost);
        Self::Membership {
            accept: price * accept,
            reject: price * reject,
        }
    }

    /// The losses of a comparison whose answers `first`, `second`, `equal` and
    /// `incomparable` would leave these shares.
    pub(super) fn of_comparison(config: &Config, shares: [f64; 4]) -> Self {
        let price = price(config, config.comparison_cost);
        let [first, second, equal, incomparable] = shares.map(|share| price * share);
        Self::Comparison {
            first,
            second,
            equal,
            incomparable,
        }
    }

    /// The arm that was pulled.
    pub(super) fn arm(&self) -> usize {
        match self {
            Self::Membership { .. } => MEMBERSHIP,
            Self::Comparison { .. } => COMPARISON,
        }
    }

    /// The loss that an answer brought; none for one that is no answer to this
    /// kind of question, and for a skipped question, which taught nothing about
    /// the arm.
    pub fn of<A>(&self, reply: &Reply<A>) -> Option<f64> {
        match (self, reply) {
            (Self::Membership { accept, .. }, Reply::Accept) => Some(*accept),
            (Self::Membership { reject, .. }, Reply::Reject) => Some(*reject),
            (
                Self::Comparison {
                    first,
                    second,
                    equal,
                    incomparable,
                },
                Reply::Compared(answer),
            ) => Some(match answer {
                Comparison::First => *first,
                Comparison::Second => *second,
                Comparison::Equal => *equal,
                Comparison::Incomparable => *incomparable,
            }),
            _ => None,
        }
    }

    /// The worst loss. That of an incomparable pair is left out: it is the whole
    /// cost or nearly so, and would hide every difference between pairs.
    pub(super) fn worst(&self) -> f64 {
        match self {
            Self::Membership { accept, reject } => accept.max(*reject),
            Self::Comparison {
                first,
                second,
                equal,
                ..
            } => first.max(*second).max(*equal),
        }
    }
}

/// `c / max(a, b)`. An infinite comparison cost means that there are no
/// comparisons, and so the maximum is over what is asked at all.
fn price(config: &Config, cost: f64) -> f64 {
    let largest = if config.comparison_cost.is_finite() {
        config.membership_cost.max(config.comparison_cost)
    } else {
        config.membership_cost
    };
    cost / largest
}

/// What the bandit must remember of the round in which a question was chosen
/// (Algorithm 5), so that the answer alone completes the round.
///
/// Arms are in the order membership query, comparison.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Round {
    /// The probabilities with which the pessimistic expert would pull each arm.
    pub pessimistic: Arms,
    /// The same of the historical expert.
    pub historical: Arms,
    /// The same of the experts who know the posterior; none where there was no
    /// posterior or nobody to know it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub posterior: Option<PosteriorAdvice>,
    /// The probabilities with which the arms were pulled.
    pub probabilities: Arms,
    /// The loss that each answer to the chosen question means.
    pub losses: Losses,
}

/// What the two experts of strategy `exp4+` advise, who know how much the answer
/// to each question is expected to tell.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct PosteriorAdvice {
    /// The informed expert's: the more an arm is worth for its cost, the more
    /// probable.
    pub informed: Arms,
    /// The steadfast expert's: always the arm that is worth more.
    pub steadfast: Arms,
}

impl PosteriorAdvice {
    /// On two arms that are worth so much for their cost (none for an arm that is
    /// not on offer), the better of which is known.
    pub(super) fn new(rates: [Option<f64>; 2], better: usize) -> Self {
        let largest = rates.iter().flatten().copied().fold(0.0, f64::max);
        let keen = |rate: f64| rate / largest / KEENNESS;
        let mut steadfast = [0.0; 2];
        steadfast[better] = 1.0;
        Self {
            informed: softmax(rates.map(|rate| rate.map_or(f64::NEG_INFINITY, keen))),
            steadfast,
        }
    }
}

/// The experts' memory and the bandit's weights: a fold over rounds.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Bandit {
    exp4: Exp4,
    /// The sum of the losses that each arm incurred, and their number.
    incurred: [(f64, u32); 2],
}

impl Bandit {
    /// Before the first round.
    pub(super) fn new(strategy: Strategy) -> Self {
        let experts = match strategy {
            Strategy::Exp4Plus => 4,
            Strategy::Bayes | Strategy::Thesis | Strategy::Membership => 2,
        };
        Self {
            exp4: Exp4::new(experts),
            incurred: [(0.0, 0); 2],
        }
    }

    /// The round in which one of the arms is pulled, given the losses of their
    /// answers (none for an arm that is not on offer) and a number drawn
    /// uniformly from 0 to 1; none if nothing is on offer.
    pub(super) fn pull(
        &self,
        arms: [Option<Losses>; 2],
        posterior: Option<PosteriorAdvice>,
        drawn: f64,
    ) -> Option<Round> {
        let worst = arms.map(|arm| arm.as_ref().map(Losses::worst));
        let mean: [Option<f64>; 2] = std::array::from_fn(|arm| {
            // An arm that was never pulled has no history: its worst loss is
            // all that is known of it.
            let (sum, pulls) = self.incurred[arm];
            worst[arm].map(|worst| {
                if pulls == 0 {
                    worst
                } else {
                    sum / f64::from(pulls)
                }
            })
        });
        let (pessimistic, historical) = (advice(worst), advice(mean));
        let advice = all(pessimistic, historical, posterior);
        let offered = arms.map(|arm| arm.is_some());
        let probabilities = self.exp4.probabilities(&advice, offered);
        let arm = usize::from(drawn >= probabilities[MEMBERSHIP]);
        Some(Round {
            pessimistic,
            historical,
            posterior,
            probabilities,
            losses: arms[arm].or(arms[1 - arm])?,
        })
    }

    /// Completes a round.
    pub(super) fn learn<A>(&mut self, round: &Round, reply: &Reply<A>) {
        let arm = round.losses.arm();
        let Some(loss) = round.losses.of(reply) else {
            return;
        };
        // A round read from a damaged log must not poison the weights.
        if round.probabilities[arm].is_nan() || round.probabilities[arm] <= 0.0 {
            return;
        }
        let advice = all(round.pessimistic, round.historical, round.posterior);
        self.exp4.update(&advice, round.probabilities, arm, loss);
        self.incurred[arm].0 += loss;
        self.incurred[arm].1 += 1;
    }
}

/// The advice of all who gave any, in the order of the experts.
fn all(pessimistic: Arms, historical: Arms, posterior: Option<PosteriorAdvice>) -> Vec<Arms> {
    let mut advice = vec![pessimistic, historical];
    if let Some(PosteriorAdvice {
        informed,
        steadfast,
    }) = posterior
    {
        advice.extend([informed, steadfast]);
    }
    advice
}

/// The softmax of the losses with their sign turned, so that a small loss has a
/// large probability; an arm that is not offered has none.
fn advice(losses: [Option<f64>; 2]) -> Arms {
    softmax(losses.map(|loss| loss.map_or(f64::NEG_INFINITY, |loss| -loss / TEMPERATURE)))
}
