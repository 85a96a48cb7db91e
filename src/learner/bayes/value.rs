//! What a question is worth: the information about the concept that its answer
//! is expected to bring, for its cost.

use super::atoms::{NOWHERE, Table};
use super::entropy;
use crate::belief::Tally;
use crate::concept::{ConceptClass, Ending};
use crate::learner::{Learner, Question, Strategy};

/// A question's information in bits, and its cost.
#[derive(Clone, Copy, Debug)]
pub(super) struct Worth {
    pub(super) bits: f64,
    pub(super) cost: f64,
}

impl Worth {
    fn rate(self) -> f64 {
        self.bits / self.cost
    }
}

/// Less information than this is none.
const NOTHING: f64 = 1e-9;

/// The question that is worth most for its cost, if any is worth something.
pub(super) fn best<C: ConceptClass>(
    learner: &Learner<C>,
    table: &Table<C::Atom>,
) -> Option<(Question<C::Atom, C::Concept>, Worth)> {
    let config = &learner.config;
    let mut best: Option<(Question<C::Atom, C::Concept>, Worth)> = None;
    let beats = |best: &Option<(_, Worth)>, worth: Worth| {
        worth.bits > NOTHING
            && best
                .as_ref()
                .is_none_or(|(_, known)| worth.rate() > known.rate() * (1.0 + 1e-9))
    };
    let accepts: Vec<f64> = (table.labels.iter())
        .map(|labels| mass(labels, &table.weights))
        .collect();
    for (atom, &accept) in table.atoms.iter().zip(&accepts) {
        let worth = Worth {
            bits: entropy(&[accept, 1.0 - accept]),
            cost: config.membership_cost,
        };
        if beats(&best, worth) && learner.evidence.may_judge(atom) {
            best = Some((Question::Membership { atom: atom.clone() }, worth));
        }
    }
    if !config.comparison_cost.is_finite() || config.strategy == Strategy::Membership {
        return best;
    }
    let outlooks = outlooks(table);
    let open = |accept: f64| accept > NOTHING && accept < 1.0 - NOTHING;
    for one in 0..table.atoms.len() {
        for other in 0..one {
            // Labels that are sure on both sides cannot be told apart.
            if !open(accepts[one]) && !open(accepts[other]) {
                continue;
            }
            let worth = Worth {
                bits: comparison(table, &outlooks, other, one),
                cost: config.comparison_cost,
            };
            if beats(&best, worth) {
                let (first, second) = (&table.atoms[other], &table.atoms[one]);
                if learner.evidence.may_compare(first, second) {
                    let (first, second) = (first.clone(), second.clone());
                    best = Some((Question::Comparison { first, second }, worth));
                }
            }
        }
    }
    best
}

/// By the ending of two atoms: the chances of the four answers, and what these
/// leave open in bits; times the chance of the concept.
type Outlook = [[f64; 5]; 4];

/// The outlook of every concept.
fn outlooks<A>(table: &Table<A>) -> Vec<Outlook> {
    let outlook = |(tally, weight): (&Tally, &f64)| {
        Ending::ALL.map(|ending| {
            let odds = tally.odds(ending);
            let [first, second, equal, incomparable] = odds;
            [first, second, equal, incomparable, entropy(&odds)].map(|part| part * weight)
        })
    };
    table.tallies.iter().zip(&table.weights).map(outlook).collect()
}

/// The bits about the concept that the answer to a comparison is expected to
/// bring.
fn comparison<A>(table: &Table<A>, outlooks: &[Outlook], first: usize, second: usize) -> f64 {
    let labels = table.labels[first].iter().zip(&table.labels[second]);
    let places = table.places[first].iter().zip(&table.places[second]);
    let mut sums = [0.0; 5];
    for ((labels, places), outlook) in labels.zip(places).zip(outlooks) {
        let same = places.0 == places.1 && *places.0 != NOWHERE;
        let ending = Ending::of(*labels.0, *labels.1, same);
        for (sum, part) in sums.iter_mut().zip(&outlook[ending as usize]) {
            *sum += part;
        }
    }
    entropy(&sums[..4]) - sums[4]
}

fn mass(labels: &[bool], weights: &[f64]) -> f64 {
    (labels.iter().zip(weights))
        .filter(|(label, _)| **label)
        .map(|(_, weight)| weight)
        .sum()
}
