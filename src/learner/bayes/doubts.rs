//! Where answers may be wrong: which of them seem so, and how many.

use crate::belief::{Ending, Tally, Verdict, compared};
use crate::concept::ConceptClass;
use crate::evidence::{AnswerId, Fact};
use crate::learner::{Entry, Learner, Strategy};

/// How often a teacher seems to be wrong, and where.
#[derive(Clone, Debug, PartialEq)]
pub struct Doubts {
    /// The share of membership answers and comparisons that seem to be wrong,
    /// from 0 to 1.
    pub error_rate: f64,
    /// The answers that may be wrong, the most doubtful first.
    pub answers: Vec<Doubt>,
}

/// An answer in doubt.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Doubt {
    /// The answer.
    pub answer: AnswerId,
    /// The chance that it is wrong, above 0 and at most 1.
    pub chance: f64,
}

/// Less doubt than this is none.
const DOUBTLESS: f64 = 0.01;

impl<C: ConceptClass> Learner<C> {
    /// Whether answers may be wrong. The other strategies know only facts.
    pub(in crate::learner) fn doubts_answers(&self) -> bool {
        self.config.robust && self.config.strategy == Strategy::Bayes
    }

    /// What an entry says for certain.
    pub(in crate::learner) fn certain(
        &self,
        entry: &Entry<C::Atom, C::Concept>,
    ) -> Option<Fact<C::Atom>> {
        if self.doubts_answers() && entry.is_doubtful() {
            return None;
        }
        entry.fact()
    }

    /// Takes note of which answers were wrong, if the concept is the right one.
    pub(in crate::learner) fn look_back(&mut self, concept: &C::Concept) {
        if !self.doubts_answers() {
            return;
        }
        let answers = (self.entries.iter())
            .filter(|entry| entry.is_doubtful() && entry.fact().is_some())
            .count();
        let mut doubts = self.doubt(std::slice::from_ref(concept), &[1.0], 0.0);
        doubts.error_rate = doubts.answers.len() as f64 / answers.max(1) as f64;
        self.doubts = Some(doubts);
    }

    /// How likely every answer is wrong, by concepts with these chances.
    pub(super) fn doubt(
        &self,
        concepts: &[C::Concept],
        weights: &[f64],
        error_rate: f64,
    ) -> Doubts {
        let chance = |fact: &Fact<C::Atom>| -> f64 {
            (concepts.iter().zip(weights))
                .filter(|(concept, _)| is_wrong(&self.class, concept, fact))
                .map(|(_, weight)| weight)
                .sum()
        };
        let doubtful = self.entries.iter().filter(|entry| entry.is_doubtful());
        let mut answers: Vec<Doubt> = doubtful
            .filter_map(|entry| {
                let chance = chance(&entry.fact()?);
                let answer = entry.answer;
                (chance > DOUBTLESS).then_some(Doubt { answer, chance })
            })
            .collect();
        answers.sort_by(|one, other| {
            let by_chance = other.chance.total_cmp(&one.chance);
            by_chance.then(one.answer.cmp(&other.answer))
        });
        Doubts {
            error_rate,
            answers,
        }
    }
}

/// Whether no teacher who respects membership in the concept says so.
fn is_wrong<C: ConceptClass>(class: &C, concept: &C::Concept, fact: &Fact<C::Atom>) -> bool {
    if let Some((first, second, Verdict::Equal)) = compared(fact) {
        let ending = Ending::of(class.end(concept, first), class.end(concept, second));
        return matches!(ending, Ending::FirstOnly | Ending::SecondOnly);
    }
    !fact.holds(|atom| class.contains(concept, atom))
}

/// The share of answers that are expected to be wrong, by concepts with these
/// chances.
pub(super) fn error_rate(tallies: &[Tally], weights: &[f64]) -> f64 {
    (tallies.iter().zip(weights))
        .map(|(tally, weight)| tally.error_rate() * weight)
        .sum()
}
