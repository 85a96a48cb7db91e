//! Strategy `exp4+`: the best question of each kind as the arms of the bandit.
//!
//! What the posterior expects is right only as far as its model of the teacher
//! is. A bandit asks the other kind now and then whatever the model says, so that
//! a teacher who leaves the model cannot keep it at questions that teach nothing.

use std::hash::Hash;

use rand_chacha::ChaCha8Rng;

use super::atoms::Table;
use super::value::Best;
use crate::belief::{End, Ending};
use crate::concept::ConceptClass;
use crate::learner::choose::{Arm, Chosen};
use crate::learner::experts::{Losses, PosteriorAdvice};
use crate::learner::{Config, Learner, Question};

impl<C: ConceptClass> Learner<C> {
    /// Lets the bandit choose between the best questions of each kind, of which
    /// that of the arm `better` is worth more for its cost.
    pub(super) fn bet_on_arms(
        &self,
        table: &Table<C::Atom>,
        best: [Option<Best<C>>; 2],
        better: usize,
        random: &mut ChaCha8Rng,
    ) -> Option<Chosen<C>> {
        let rates = [&best[0], &best[1]].map(|best| Some(best.as_ref()?.1.rate()));
        let arms = best.map(|best| -> Option<Arm<C>> {
            let (question, _) = best?;
            let losses = losses(&self.config, table, &question)?;
            Some((question, losses))
        });
        let advice = PosteriorAdvice::new(rates, better);
        self.pull(arms, Some(advice), random)
    }
}

/// The losses of a question about atoms of the table; none of an equivalence
/// query, which is no arm.
///
/// Eq. 5.3 has the share of concepts that an answer leaves. Here concepts are not
/// equally likely, and hardly an answer refutes one for good: an answer is more
/// likely by some than by others. So a concept is left with its chance, times the
/// chance of the answer by this concept over that by the concept which expects the
/// answer most: the share that rejection sampling would keep. Where an answer is
/// certain by the concepts it does not refute, as to a membership query, this is
/// the chance of what it leaves, and if these are equally likely, Eq. 5.3.
fn losses<A: Clone + Ord + Hash, K>(
    config: &Config,
    table: &Table<A>,
    question: &Question<A, K>,
) -> Option<Losses> {
    let ends = |atom: &A| -> Option<&[End]> {
        let place = table.atoms.binary_search(atom).ok()?;
        Some(&table.ends[place])
    };
    match question {
        Question::Membership { atom } => {
            let concepts = ends(atom)?.iter().zip(&table.weights);
            let inside = concepts.filter(|(end, _)| end.is_inside());
            let accept = inside.map(|(_, weight)| weight).sum::<f64>().min(1.0);
            Some(Losses::of_membership(config, accept, 1.0 - accept))
        }
        Question::Comparison { first, second } => {
            let mut likely = [0.0; 4];
            let mut most = [0.0_f64; 4];
            let concepts = table.tallies.iter().zip(&table.weights);
            for ((&first, &second), (tally, &weight)) in
                ends(first)?.iter().zip(ends(second)?).zip(concepts)
            {
                let odds = tally.odds(Ending::of(first, second), 0.0);
                for ((likely, most), chance) in likely.iter_mut().zip(&mut most).zip(odds) {
                    *likely += weight * chance;
                    *most = most.max(chance);
                }
            }
            let share = |answer: usize| {
                if most[answer] > 0.0 {
                    (likely[answer] / most[answer]).min(1.0)
                } else {
                    0.0
                }
            };
            let shares = std::array::from_fn(share);
            Some(Losses::of_comparison(config, shares))
        }
        Question::Equivalence { .. } => None,
    }
}
