//! What a question is worth: the information about the concept that its answer
//! is expected to bring, for its cost.

use super::atoms::{NOWHERE, Table};
use super::posterior::Posterior;
use super::{distributions, entropy, tune};
use crate::concept::ConceptClass;
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
    posterior: &Posterior<C::Concept>,
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
    let (different, place, label) = distributions(&posterior.odds);
    let entropies = (entropy(&different), entropy(&place), entropy(&label));
    let trust = tune("TRUST", 1.0);
    for one in 0..table.atoms.len() {
        for other in 0..one {
            // Labels that are sure on both sides cannot be told apart.
            let open = |accept: f64| accept > NOTHING && accept < 1.0 - NOTHING;
            if !open(accepts[one]) && !open(accepts[other]) {
                continue;
            }
            let [first, second, placed, labelled] = endings(table, other, one);
            let differ = first + second;
            let mut answers = [
                first * different[0],
                second * different[0],
                0.0,
                differ * different[1],
            ];
            let mut alike = [0.0; 4];
            for index in 0..4 {
                alike[index] = placed * place[index] + labelled * label[index];
                answers[index] += alike[index];
            }
            let noise = differ * entropies.0;
            let bits = entropy(&answers) - noise - placed * entropies.1 - labelled * entropies.2;
            // What the answer says about labels alone. Whether two atoms end in
            // the same place is worth something only beside it: otherwise
            // questions about places could go on for ever.
            let same = placed + labelled;
            let about_labels = if same > 0.0 {
                let shares = alike.map(|chance| chance / same);
                entropy(&answers) - noise - same * entropy(&shares)
            } else {
                bits
            };
            let worth = Worth {
                bits: bits.min(2.0 * about_labels) * trust,
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

fn mass(labels: &[bool], weights: &[f64]) -> f64 {
    (labels.iter().zip(weights))
        .filter(|(label, _)| **label)
        .map(|(_, weight)| weight)
        .sum()
}

/// The chances of the four endings of two atoms.
fn endings<A>(table: &Table<A>, first: usize, second: usize) -> [f64; 4] {
    let mut masses = [0.0; 8];
    let labels = table.labels[first].iter().zip(&table.labels[second]);
    let places = table.places[first].iter().zip(&table.places[second]);
    for ((labels, places), weight) in labels.zip(places).zip(&table.weights) {
        let same = places.0 == places.1 && *places.0 != NOWHERE;
        let code = usize::from(*labels.0) + 2 * usize::from(*labels.1) + 4 * usize::from(same);
        masses[code] += weight;
    }
    [
        masses[1],
        masses[2],
        masses[4] + masses[7],
        masses[0] + masses[3],
    ]
}
