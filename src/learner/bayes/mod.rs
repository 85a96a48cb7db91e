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
use super::{Entry, Learner, Question, Reply, Step};
use crate::concept::{ConceptClass, Failure, Odds, Wish};
use crate::evidence::{Budget, Comparison, Fact};

pub(super) fn tune(name: &str, default: f64) -> f64 {
    std::env::var(name)
        .ok()
        .and_then(|v| v.parse().ok())
        .unwrap_or(default)
}

/// The sizes that are considered, from the smallest consistent one.
const SIZES: usize = 4;
/// The prior of a size over that of the size before.
const DECAY: f64 = 0.5;
/// As many concepts of a size are listed at most.
const LISTED: usize = 2000;
/// As many are drawn otherwise.
const DRAWS: usize = 1000;
/// The work of listing and drawing: some tens of milliseconds.
const WORK: u64 = 60_000;

/// An answered comparison.
type Answer<A> = (A, A, Comparison);

impl<C: ConceptClass> Learner<C> {
    /// The next move by the posterior.
    pub(super) fn weigh(&mut self) -> Move<C> {
        let mut random = self.generator();
        let mut budget = Budget::new(self.config.budget);
        let answers = self.comparisons();
        let wish = Wish {
            sizes: tune("SIZES", SIZES as f64) as usize,
            decay: tune("DECAY", DECAY),
            listed: tune("LISTED", LISTED as f64) as usize,
            draws: tune("DRAWS", DRAWS as f64) as usize,
            answers: &answers,
            odds: &posterior::expected_odds(),
            seed: random.random(),
            work: tune("WORK", WORK as f64) as u64,
        };
        let spread = match self.class.spread(&wish, &mut budget) {
            Ok(spread) => spread,
            Err(Failure::Contradiction(conflict)) => return (Step::Conflict(conflict), None),
            Err(Failure::OverBudget { .. }) => return self.without_candidates(random.random()),
        };
        let hurried = spread.hurried;
        let posterior = Posterior::new(&self.class, spread, &answers);
        let top = posterior.concepts[0].clone();
        let table = Table::new(self, &posterior, &mut random);
        let (best, worth) = match value::best(self, &posterior, &table) {
            Some(best) => best,
            None => return (ask(equivalence(&top), None, hurried), Some(top)),
        };
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
        if std::env::var("TRACE").is_ok() {
            eprintln!(
                "n={} exact={} top={:.3} second={:.3} worth={:?} odds={:?} ask={:?}",
                posterior.weights.len(),
                posterior.exact,
                posterior.weights[0],
                posterior.weights.get(1).unwrap_or(&0.0),
                worth,
                posterior.odds,
                question
            );
        }
        (ask(question, None, hurried), Some(top))
    }

    /// All comparisons that were answered, and those known from the start.
    fn comparisons(&self) -> Vec<Answer<C::Atom>> {
        let given = self.given.iter().filter_map(|fact| match fact {
            Fact::Label { .. } => None,
            Fact::Below { worse, better } => {
                Some((worse.clone(), better.clone(), Comparison::Second))
            }
            Fact::Equal { first, second } => {
                Some((first.clone(), second.clone(), Comparison::Equal))
            }
            Fact::Incomparable { first, second } => {
                Some((first.clone(), second.clone(), Comparison::Incomparable))
            }
        });
        let answered = self.entries.iter().filter_map(|entry: &Entry<_, _>| {
            match (&entry.question, &entry.reply) {
                (Question::Comparison { first, second }, Reply::Compared(answer)) => {
                    Some((first.clone(), second.clone(), *answer))
                }
                _ => None,
            }
        });
        given.chain(answered).collect()
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

/// The chances of the four answers about atoms that end in the same place.
fn of_shared(shared: &[f64; 3]) -> [f64; 4] {
    [shared[0] / 2.0, shared[0] / 2.0, shared[1], shared[2]]
}

/// The three distributions of answers: different labels (as better, worse),
/// same place, same label.
fn distributions(odds: &Odds) -> ([f64; 2], [f64; 4], [f64; 4]) {
    (
        [1.0 - odds.incomparable, odds.incomparable],
        of_shared(&odds.same_place),
        of_shared(&odds.same_label),
    )
}
