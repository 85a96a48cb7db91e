//! What goes to and fro between a learner and its teacher: questions, replies,
//! the learner's next move, and the answered question that is kept.

use serde::{Deserialize, Serialize};

use super::Round;
use crate::concept::Contradiction;
use crate::evidence::{AnswerId, Comparison, Fact};

/// A question to the teacher.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Question<A, C> {
    /// Is this atom acceptable?
    Membership {
        /// The atom to judge.
        atom: A,
    },
    /// Which of the two is better?
    Comparison {
        /// One atom.
        first: A,
        /// The other.
        second: A,
    },
    /// Is this the concept?
    Equivalence {
        /// The concept shown.
        hypothesis: C,
    },
}

/// A teacher's reply to a [`Question`].
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Reply<A> {
    /// The atom belongs to the concept.
    Accept,
    /// The atom does not belong to the concept.
    Reject,
    /// What the comparison came to.
    Compared(Comparison),
    /// The hypothesis is the concept.
    Correct,
    /// The hypothesis is wrong about this atom.
    Counterexample {
        /// The atom.
        atom: A,
        /// Whether the concept contains it; the hypothesis says otherwise.
        label: bool,
    },
    /// No answer; ask something else. Not for equivalence queries.
    Skip,
}

/// Why a reply was not taken.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ReplyError {
    /// The reply belongs to another kind of question.
    #[error("this reply does not fit a question of {question}: {expected}")]
    WrongKind {
        /// The kind of the question.
        question: &'static str,
        /// The replies that fit.
        expected: &'static str,
    },
    /// The hypothesis already gives the atom this label.
    #[error("this is no counterexample: the hypothesis already gives it that label")]
    NoCounterexample,
    /// The number belongs to an answer that stands.
    #[error("answer {0} was given already: retract it before giving another")]
    UsedNumber(u32),
}

/// The learner's next move.
#[derive(Clone, Debug, PartialEq)]
pub enum Step<A, C> {
    /// Ask this; hand `round` back with the reply.
    Ask {
        /// The question.
        question: Question<A, C>,
        /// The bandit's round, where the bandit chose the question.
        round: Option<Round>,
        /// Whether the budget ended, so that the question is good enough
        /// rather than the one the strategy would have found.
        hurried: bool,
    },
    /// The answers that stand contradict each other; one must be retracted.
    Conflict(Contradiction),
    /// The teacher agreed with this concept, and as many judgements as were asked
    /// for ([`Config::conformance`](super::Config::conformance)) have borne it out.
    Done {
        /// The concept learned.
        hypothesis: C,
    },
}

/// How many questions were answered.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Counts {
    /// Membership queries.
    pub membership: u32,
    /// Comparisons.
    pub comparison: u32,
    /// Equivalence queries.
    pub equivalence: u32,
    /// Atoms judged to check a concept that the teacher had agreed with; they
    /// are not among the membership queries.
    #[serde(default)]
    pub conformance: u32,
}

impl Counts {
    /// Counts an answer; `checks` if it belongs to a check.
    pub fn add<A, C>(&mut self, question: &Question<A, C>, checks: bool) {
        *match question {
            Question::Membership { .. } if checks => &mut self.conformance,
            Question::Membership { .. } => &mut self.membership,
            Question::Comparison { .. } => &mut self.comparison,
            Question::Equivalence { .. } => &mut self.equivalence,
        } += 1;
    }
}

/// An answered question.
#[derive(Clone, Debug, PartialEq)]
pub struct Entry<A, C> {
    /// Its number.
    pub answer: AnswerId,
    /// What was asked.
    pub question: Question<A, C>,
    /// The bandit's round, as [`Step::Ask`] gave it.
    pub round: Option<Round>,
    /// What the teacher replied.
    pub reply: Reply<A>,
}

impl<A: Clone, C> Entry<A, C> {
    /// What the entry says about the concept or the order; none for an agreed
    /// hypothesis and for a skipped question.
    pub fn fact(&self) -> Option<Fact<A>> {
        let label = |atom: &A, accepted| Fact::Label {
            atom: atom.clone(),
            accepted,
        };
        match (&self.question, &self.reply) {
            (Question::Membership { atom }, Reply::Accept) => Some(label(atom, true)),
            (Question::Membership { atom }, Reply::Reject) => Some(label(atom, false)),
            (Question::Comparison { first, second }, Reply::Compared(answer)) => {
                Some(Fact::compared(first.clone(), second.clone(), *answer))
            }
            (
                Question::Equivalence { .. },
                Reply::Counterexample {
                    atom,
                    label: accepted,
                },
            ) => Some(label(atom, *accepted)),
            _ => None,
        }
    }
}

impl<A, C> Entry<A, C> {
    /// Whether the reply is one that may be wrong where any may be: who shows a
    /// counterexample has looked at the hypothesis.
    pub(super) fn is_doubtful(&self) -> bool {
        !matches!(self.question, Question::Equivalence { .. })
    }
}
