//! What is left to be learned as a question is put, and what its answers would
//! tell: for people who want to know why they are asked, and how long it takes.

use serde::{Deserialize, Serialize};

use super::{Learner, Question, Reply, Strategy};
use crate::concept::ConceptClass;
use crate::evidence::Comparison;

/// What is left when a question is put.
#[derive(Clone, Debug)]
pub struct Outlook<C> {
    /// The concepts that could be meant, as far as they are known.
    pub left: Left,
    /// How many of these every answer would rule out; an answer that is not here
    /// would rule out none.
    pub removed: Vec<Removed>,
    /// The two likeliest concepts that the question tells apart; for an
    /// equivalence query the one shown and the likeliest other.
    pub rivals: Option<[C; 2]>,
}

/// The concepts that could be meant.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Left {
    /// How many are known.
    pub concepts: usize,
    /// Whether these are all of the sizes that are weighed; otherwise there are
    /// more than these.
    pub exact: bool,
    /// Bits that would tell which of them is meant; less than what is left where
    /// the concepts are not all.
    pub bits: f64,
    /// The questions that are to be expected, the next one among them; none where
    /// too little is known to say.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub questions: Option<Expected>,
}

/// A number that is not certain.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Expected {
    /// On average.
    pub mean: f64,
    /// Fewer than this in one of ten cases.
    pub low: f64,
    /// More than this in one of ten cases.
    pub high: f64,
}

impl Expected {
    /// From the bits that are left, as strategy `bayes` needed them on the named
    /// targets and the tasks of `examples/tasks` (teachers that know their rule;
    /// 1867 questions of 132 sessions with costs of 4 and 1, and 1 and 1): straight
    /// lines through the means and the tenths by bits. `tests/learner/outlook.rs`
    /// tells how often others are within.
    fn of(bits: f64) -> Self {
        Self {
            mean: 1.5 + 1.6 * bits,
            low: bits.max(1.0),
            high: 5.0 + 2.0 * bits,
        }
    }
}

/// What an answer would rule out.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Removed {
    /// The answer.
    pub answer: Answer,
    /// The number of known concepts that do not fit it.
    pub concepts: usize,
}

/// An answer that rules concepts out.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Answer {
    /// [`Reply::Accept`].
    Accept,
    /// [`Reply::Reject`].
    Reject,
    /// [`Comparison::First`].
    First,
    /// [`Comparison::Second`].
    Second,
    /// [`Comparison::Equal`].
    Equal,
    /// [`Reply::Correct`].
    Correct,
}

impl Answer {
    /// The reply that is meant.
    pub fn reply<A>(self) -> Reply<A> {
        match self {
            Self::Accept => Reply::Accept,
            Self::Reject => Reply::Reject,
            Self::First => Reply::Compared(Comparison::First),
            Self::Second => Reply::Compared(Comparison::Second),
            Self::Equal => Reply::Compared(Comparison::Equal),
            Self::Correct => Reply::Correct,
        }
    }
}

/// The concepts that are weighed for a question.
pub(super) struct Weighed<'a, C> {
    /// The likeliest first.
    pub(super) concepts: &'a [C],
    /// Their chances, which sum to 1.
    pub(super) weights: &'a [f64],
    /// Whether these are all.
    pub(super) exact: bool,
}

impl<C: ConceptClass> Learner<C> {
    /// What is left as this question is put.
    pub(super) fn outlook_on(
        &self,
        question: &Question<C::Atom, C::Concept>,
        weighed: &Weighed<'_, C::Concept>,
    ) -> Outlook<C::Concept> {
        let concepts = weighed.concepts;
        let inside = |atom: &C::Atom| -> Vec<bool> {
            let contained = |concept| self.class.contains(concept, atom);
            concepts.iter().map(contained).collect()
        };
        // What every concept says of the question, and the answers with what they
        // are right about.
        let (said, answers): (Vec<Said>, &[(Answer, Fits)]) = match question {
            Question::Membership { atom } => (
                inside(atom)
                    .into_iter()
                    .map(|label| (label, true))
                    .collect(),
                &[
                    (Answer::Accept, |(label, _)| label),
                    (Answer::Reject, |(label, _)| !label),
                ],
            ),
            Question::Comparison { first, second } => (
                inside(first).into_iter().zip(inside(second)).collect(),
                &[
                    (Answer::First, |(first, second)| first || !second),
                    (Answer::Second, |(first, second)| second || !first),
                    (Answer::Equal, |(first, second)| first == second),
                ],
            ),
            Question::Equivalence { hypothesis } => {
                let shown = |concept: &C::Concept| (concept == hypothesis, true);
                let said = concepts.iter().map(shown).collect();
                (said, &[(Answer::Correct, |(shown, _)| shown)])
            }
        };
        let removed = answers.iter().map(|&(answer, fits)| Removed {
            answer,
            concepts: said.iter().filter(|said| !fits(**said)).count(),
        });
        let other = (said.iter()).position(|&other| told_apart(said[0], other, question));
        Outlook {
            left: weighed.left(self.config.strategy),
            removed: removed.collect(),
            rivals: other.map(|other| [concepts[0].clone(), concepts[other].clone()]),
        }
    }
}

/// What a concept says of the two atoms of a question.
type Said = (bool, bool);

/// Whether an answer fits what a concept says.
type Fits = fn(Said) -> bool;

/// Whether some answer fits one and not the other.
fn told_apart<A, K>(one: Said, other: Said, question: &Question<A, K>) -> bool {
    match question {
        // Both inside and both outside fit the same answers.
        Question::Comparison { .. } => {
            i8::from(one.0) - i8::from(one.1) != i8::from(other.0) - i8::from(other.1)
        }
        Question::Membership { .. } | Question::Equivalence { .. } => one != other,
    }
}

impl<C> Weighed<'_, C> {
    fn left(&self, strategy: Strategy) -> Left {
        let bits = super::bayes::entropy(self.weights);
        Left {
            concepts: self.concepts.len(),
            exact: self.exact,
            bits,
            questions: strategy.has_posterior().then(|| Expected::of(bits)),
        }
    }
}
