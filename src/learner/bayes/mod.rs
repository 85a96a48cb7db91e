//! Strategy `bayes`: a posterior over consistent concepts of several sizes, a
//! model of how this teacher answers comparisons, learned on the way, and the
//! question of any kind that is worth most for its cost. Strategy `exp4+` differs
//! in that a bandit chooses the kind.

mod arms;
mod atoms;
mod doubts;
mod posterior;
mod price;
mod value;

use rand::RngExt;
use rand_chacha::ChaCha8Rng;

use self::atoms::Table;
pub use self::doubts::{Doubt, Doubts};
use self::posterior::Posterior;
use super::choose::{Move, ask, equivalence};
use super::outlook::Weighed;
use super::{Learner, Question, Step, Strategy};
use crate::belief::Heard;
use crate::concept::{ConceptClass, Failure, Wish};
use crate::evidence::{Budget, Stop};

/// The sizes that are listed, from the smallest consistent one.
const SIZES: usize = 4;
/// The prior of a size over that of the size before.
const DECAY: f64 = 0.5;
/// As many concepts are listed at most.
const LISTED: usize = 1000;

impl<C: ConceptClass> Learner<C> {
    /// The next move by the posterior.
    pub(super) fn weigh(&mut self, stop: &Stop) -> Move<C> {
        let mut random = self.generator();
        let mut budget = Budget::until(self.config.budget, stop);
        let heard = self.heard();
        let wish = Wish {
            sizes: SIZES,
            decay: DECAY,
            listed: LISTED,
            heard: &heard,
            seed: self.config.seed,
        };
        let spread = match self.class.spread(&wish, &mut budget) {
            Ok(spread) => spread,
            Err(Failure::Contradiction(conflict)) => return (Step::Conflict(conflict), None),
            Err(Failure::OverBudget { .. }) => return self.without_candidates(random.random()),
        };
        if spread.hurried {
            // Nothing likely was found: these are consistent and no more. The
            // way of Algorithm 4 needs nothing else.
            let (step, simplest) = self.learn_by_elimination(stop);
            return match step {
                Step::Ask {
                    question, round, ..
                } => (ask(question, round, true), simplest),
                other => (other, simplest),
            };
        }
        let (exact, known) = (spread.exact, spread.concepts.len());
        let posterior = Posterior::new(spread);
        let top = posterior.concepts[0].clone();
        let table = Table::new(self, &posterior, &heard, &mut random);
        let wrong = if self.doubts_answers() {
            let rate = doubts::error_rate(&table.tallies, &table.weights);
            let (concepts, weights) = (&posterior.concepts, &posterior.weights);
            self.doubts = Some(self.doubt(concepts, weights, rate));
            rate
        } else {
            0.0
        };
        let mut arms = value::best(self, &table, wrong);
        let better = value::better::<C>(&arms);
        let better = better.and_then(|arm| Some((arm, arms[arm].as_ref()?.1)));
        let worth_asking = better.filter(|&(_, worth)| {
            !price::is_worth_showing(&self.config, posterior.weights[0], worth, wrong)
        });
        let chosen = worth_asking.and_then(|(arm, _)| {
            for (question, _) in arms.iter_mut().flatten() {
                mirror(question, &mut random);
            }
            if self.config.strategy == Strategy::Exp4Plus {
                self.bet_on_arms(&table, arms, arm, &mut random)
            } else {
                arms[arm].take().map(|(question, _)| (question, None))
            }
        });
        let (question, round) = chosen.unwrap_or_else(|| (equivalence(&top), None));
        let weighed = Weighed {
            concepts: &posterior.concepts,
            weights: &posterior.weights,
            exact: exact && posterior.concepts.len() == known,
        };
        self.outlook = Some(self.outlook_on(&question, &weighed));
        (ask(question, round, false), Some(top))
    }

    /// All that was heard: what is known from the start, and then answer by
    /// answer.
    fn heard(&self) -> Vec<Vec<Heard<C::Atom>>> {
        let sure = |fact| Heard { fact, sure: true };
        let given = self.given.iter().cloned().map(sure).collect();
        let doubting = self.doubts_answers();
        let answered = self.entries.iter().filter_map(|entry| {
            let said = Heard {
                fact: entry.fact()?,
                sure: !(doubting && entry.is_doubtful()),
            };
            let promised = self.promised(entry).into_iter().map(sure);
            Some(std::iter::once(said).chain(promised).collect())
        });
        std::iter::once(given).chain(answered).collect()
    }
}

/// Shows the atoms of a comparison in an order that is drawn, so that the place
/// says nothing and a habit of choosing the first does no harm.
fn mirror<A, K>(question: &mut Question<A, K>, random: &mut ChaCha8Rng) {
    if let Question::Comparison { first, second } = question
        && random.random()
    {
        std::mem::swap(first, second);
    }
}

/// Entropy of a distribution in bits.
pub(super) fn entropy(chances: &[f64]) -> f64 {
    -chances
        .iter()
        .filter(|chance| **chance > 0.0)
        .map(|chance| chance * chance.log2())
        .sum::<f64>()
}
