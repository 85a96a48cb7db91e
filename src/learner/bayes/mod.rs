//! Strategy `bayes`: a posterior over consistent concepts of several sizes, a
//! model of how this teacher answers comparisons, learned on the way, and the
//! question of any kind that is worth most for its cost.

mod atoms;
mod posterior;
mod price;
mod value;

use rand::RngExt;

use self::atoms::Table;
use self::posterior::Posterior;
use super::choose::{Move, ask, equivalence};
use super::{Entry, Learner, Question, Step};
use crate::belief::Heard;
use crate::concept::{ConceptClass, Failure, Wish};
use crate::evidence::Budget;

pub(super) fn tune(name: &str, default: f64) -> f64 {
    std::env::var(name)
        .ok()
        .and_then(|v| v.parse().ok())
        .unwrap_or(default)
}

/// The sizes that are listed, from the smallest consistent one.
const SIZES: usize = 4;
/// The prior of a size over that of the size before.
const DECAY: f64 = 0.5;
/// As many concepts are listed at most.
const LISTED: usize = 1000;

impl<C: ConceptClass> Learner<C> {
    /// The next move by the posterior.
    pub(super) fn weigh(&mut self) -> Move<C> {
        let mut random = self.generator();
        let mut budget = Budget::new(self.config.budget);
        let heard = self.heard();
        let wish = Wish {
            sizes: tune("SIZES", SIZES as f64) as usize,
            decay: tune("DECAY", DECAY),
            listed: tune("LISTED", LISTED as f64) as usize,
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
            let (step, simplest) = self.learn_by_elimination();
            return match step {
                Step::Ask {
                    question, round, ..
                } => (ask(question, round, true), simplest),
                other => (other, simplest),
            };
        }
        let hurried = spread.hurried;
        let posterior = Posterior::new(spread);
        let top = posterior.concepts[0].clone();
        let table = Table::new(self, &posterior, &heard, &mut random);
        let Some((best, worth)) = value::best(self, &table) else {
            return (ask(equivalence(&top), None, hurried), Some(top));
        };
        if std::env::var("TRACE").is_ok() {
            eprintln!(
                "n={} exact={} top={:.3} second={:.3} worth={:?} ask={:?}",
                posterior.weights.len(),
                posterior.exact,
                posterior.weights[0],
                posterior.weights.get(1).unwrap_or(&0.0),
                worth,
                best,
            );
        }
        let question = if price::is_worth_showing(&self.config, &posterior, worth) {
            equivalence(&top)
        } else {
            match best {
                Question::Comparison { first, second } if random.random() => Question::Comparison {
                    first: second,
                    second: first,
                },
                other => other,
            }
        };
        (ask(question, None, hurried), Some(top))
    }

    /// All that was heard: what is known from the start, and then answer by
    /// answer.
    fn heard(&self) -> Vec<Vec<Heard<C::Atom>>> {
        let sure = |fact| Heard { fact, sure: true };
        let given = self.given.iter().cloned().map(sure).collect();
        let answered = self.entries.iter().filter_map(Entry::fact);
        std::iter::once(given)
            .chain(answered.map(|fact| vec![sure(fact)]))
            .collect()
    }
}

/// Entropy of a distribution in bits.
fn entropy(chances: &[f64]) -> f64 {
    -chances
        .iter()
        .filter(|chance| **chance > 0.0)
        .map(|chance| chance * chance.log2())
        .sum::<f64>()
}
