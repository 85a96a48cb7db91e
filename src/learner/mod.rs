//! Which question to ask next: Algorithms 4, 5 and 6 of chapter 5, whatever the
//! concept class.
//!
//! A [`Learner`] is a fold over answered questions. It is pure: what it asks
//! next depends on its [`Config`] and on the answers that stand, and on nothing
//! else. It must not know async, clocks, files, SQL or HTML.

use serde::{Deserialize, Serialize};

use crate::concept::{ConceptClass, Contradiction};
use crate::evidence::{AnswerId, Comparison, Fact};

/// How questions are chosen.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Strategy {
    /// Algorithms 4 to 6 as written.
    Thesis,
    /// The same without comparisons.
    Membership,
}

/// What a learner is told once, at its start.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Config {
    /// How questions are chosen.
    pub strategy: Strategy,
    /// The cost `a` of a membership query (Eq. 5.2), positive and finite.
    pub membership_cost: f64,
    /// The cost `b` of a comparison (Eq. 5.2), positive; infinite: never asked.
    pub comparison_cost: f64,
    /// Decides every random choice.
    pub seed: u64,
    /// The work that choosing one question may do.
    pub budget: u64,
}

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
    #[error("this reply does not fit a {question} question: {expected}")]
    WrongKind {
        /// The kind of the question.
        question: &'static str,
        /// The replies that fit.
        expected: &'static str,
    },
    /// The hypothesis already gives the atom this label.
    #[error("this is no counterexample: the hypothesis already gives it that label")]
    NoCounterexample,
}

/// What the bandit must remember of the round in which a question was chosen
/// (Algorithm 5), so that the answer alone completes the round.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Round {}

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
    /// The teacher agreed with this concept.
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
}

/// The learner: evidence in, question out.
pub struct Learner<C: ConceptClass> {
    class: C,
    config: Config,
}

impl<C: ConceptClass> Learner<C> {
    /// A learner that knows `known` from the start.
    pub fn new(class: C, config: Config, known: Vec<Fact<C::Atom>>) -> Self {
        let _ = known;
        Self { class, config }
    }

    /// Folds in an answered question. `answer` is a number not used before.
    ///
    /// # Errors
    ///
    /// If the reply does not fit the question; nothing has changed then.
    pub fn record(
        &mut self,
        answer: AnswerId,
        question: Question<C::Atom, C::Concept>,
        round: Option<Round>,
        reply: Reply<C::Atom>,
    ) -> Result<(), ReplyError> {
        let _ = (answer, question, round, reply, &self.class, &self.config);
        unimplemented!()
    }

    /// Takes an answer back, as if its question had never been asked; `false`
    /// if no such answer stands.
    pub fn retract(&mut self, answer: AnswerId) -> bool {
        let _ = answer;
        unimplemented!()
    }

    /// The next move: a function of the configuration and the answers that
    /// stand (in the order in which they were recorded).
    pub fn next(&mut self) -> Step<C::Atom, C::Concept> {
        unimplemented!()
    }

    /// The standing answers, by kind.
    pub fn counts(&self) -> Counts {
        unimplemented!()
    }
}
