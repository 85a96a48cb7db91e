//! The entries of a session's log, with words as arrays of symbol names, so
//! that a log can be read without the program.

use serde::{Deserialize, Serialize};

use super::config::Setup;
use super::panel::Terms;
use crate::evidence::Comparison;
use crate::identify::{Cause, Contradiction};
use crate::learner::{Left, Question, Removed, Reply, Round};
use crate::task::{Atom, AtomText, Bare, Concept, ConceptText, Task, Universe, Unreadable};

/// The log's format; the first entry names it.
pub const LOG_VERSION: u32 = 1;

/// One entry of a session's log.
#[expect(
    clippy::large_enum_variant,
    reason = "questions are the large entries, and half of all entries are questions"
)]
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "event", rename_all = "lowercase")]
pub enum Event {
    /// Always the first entry, and only that.
    Created {
        /// [`LOG_VERSION`].
        log: u32,
        /// The version of memrep that wrote it.
        memrep: String,
        /// What is taught.
        task: Box<Task>,
        /// How questions are chosen.
        setup: Setup,
    },
    /// A question was put; it is open until it is answered or another entry
    /// makes the learner think again.
    Asked {
        /// Its number; they only grow.
        number: u32,
        /// The question.
        #[serde(flatten)]
        question: QuestionText,
        /// What the bandit must remember of it.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        round: Option<Round>,
        /// Whether the budget ended before the best question was found.
        #[serde(default, skip_serializing_if = "std::ops::Not::not")]
        hurried: bool,
        /// What was left to be learned; logs of before it was told have none.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        left: Option<Left>,
        /// What every answer would rule out.
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        removed: Vec<Removed>,
    },
    /// The open question was answered.
    Answered {
        /// The question's number.
        number: u32,
        /// The answer.
        #[serde(flatten)]
        reply: ReplyText,
    },
    /// A standing answer was withdrawn, as if its question had not been asked.
    Retracted {
        /// The question's number.
        number: u32,
    },
    /// A standing answer was replaced, in its place.
    Changed {
        /// The question's number.
        number: u32,
        /// The new answer.
        #[serde(flatten)]
        reply: ReplyText,
    },
    /// What several people are to answer, and how that becomes one answer.
    Terms {
        /// What the owner chose.
        #[serde(flatten)]
        terms: Terms,
    },
    /// Somebody was invited to answer.
    Invited {
        /// Their number, from 1.
        person: u32,
        /// As the owner calls them.
        name: String,
        /// The name of the session that is theirs alone, where they have one.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        session: Option<String>,
    },
    /// Somebody is not to answer any more; what they said stays.
    Dismissed {
        /// Their number.
        person: u32,
    },
    /// One of several people answered an open question.
    Said {
        /// The question's number.
        number: u32,
        /// The person's.
        person: u32,
        /// The answer.
        #[serde(flatten)]
        reply: ReplyText,
        /// How long it took in milliseconds, as the person's browser says.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        took: Option<u64>,
    },
    /// One of several people took their answer back.
    Unsaid {
        /// The question's number.
        number: u32,
        /// The person's.
        person: u32,
    },
    /// Somebody was asked once more what they had answered, and this was said.
    Repeated {
        /// The question's number.
        number: u32,
        /// The person's.
        person: u32,
        /// The answer, to the question as it was asked the first time.
        #[serde(flatten)]
        reply: ReplyText,
    },
    /// More states were allowed.
    Enlarged {
        /// The new bound.
        max_states: usize,
    },
    /// The standing answers turned out to contradict each other.
    Conflict {
        /// How.
        #[serde(flatten)]
        conflict: Conflict,
    },
    /// The teacher agreed with this rule.
    Done {
        /// What was learned.
        hypothesis: ConceptText,
    },
}

/// Standing answers that contradict each other.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Conflict {
    /// The answers, by question number, ascending; empty if what was known at
    /// the start cannot stand by itself.
    pub answers: Vec<u32>,
    /// Why they cannot stand together.
    pub cause: ConflictCause,
    /// With [`ConflictCause::States`], the bound that no automaton keeps: a
    /// larger one would resolve the conflict.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub bound: Option<usize>,
    /// Whether it is proved that none of the answers can be left out.
    pub minimal: bool,
}

/// Why answers cannot stand together.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum ConflictCause {
    /// Something would be better than itself.
    Order,
    /// Things that are equally good would not be. Logs of before this cause was
    /// told apart have [`Self::Order`] for it.
    Equality,
    /// Something acceptable would be worse than something that is not.
    Membership,
    /// Every automaton that fits has more states than are allowed.
    States,
}

impl Conflict {
    /// In the numbers of answers, with the bound where one was met.
    pub(super) fn of(contradiction: &Contradiction) -> Self {
        let (cause, bound) = match contradiction.cause {
            Cause::Order => (ConflictCause::Order, None),
            Cause::Equality => (ConflictCause::Equality, None),
            Cause::MemRep => (ConflictCause::Membership, None),
            Cause::States { bound } => (ConflictCause::States, Some(bound)),
        };
        Self {
            answers: contradiction.answers.iter().map(|id| id.0).collect(),
            cause,
            bound,
            minimal: contradiction.minimal,
        }
    }
}

/// A question, as the log and the API show it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "lowercase")]
pub enum QuestionText {
    /// Is this behaviour acceptable?
    Membership {
        /// The behaviour.
        #[serde(flatten)]
        atom: AtomText,
    },
    /// Which of two behaviours is better?
    Comparison {
        /// One behaviour.
        #[serde(with = "Bare")]
        first: AtomText,
        /// The other.
        #[serde(with = "Bare")]
        second: AtomText,
    },
    /// Is this the rule?
    Equivalence {
        /// The rule.
        hypothesis: ConceptText,
    },
}

/// An answer, as the log and the API show it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "answer", rename_all = "lowercase")]
pub enum ReplyText {
    /// The behaviour is acceptable.
    Accept,
    /// The behaviour is not acceptable.
    Reject,
    /// The first behaviour is better.
    First,
    /// The second behaviour is better.
    Second,
    /// Both are equally good or bad.
    Equal,
    /// The two cannot be compared.
    Incomparable,
    /// The rule is right.
    Correct {
        /// How many behaviours of its sheet were looked at and found to be treated
        /// rightly: all of them, if that is said. Older logs say nothing of it.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        looked: Option<u32>,
    },
    /// No answer.
    Skip,
    /// The rule is wrong about this behaviour.
    Counterexample {
        /// The behaviour.
        #[serde(flatten)]
        atom: AtomText,
        /// Whether it is acceptable.
        label: bool,
    },
}

impl QuestionText {
    /// The question as this universe writes it.
    pub fn of(question: &Question<Atom, Concept>, universe: &Universe) -> Self {
        match question {
            Question::Membership { atom } => Self::Membership {
                atom: universe.text(atom),
            },
            Question::Comparison { first, second } => Self::Comparison {
                first: universe.text(first),
                second: universe.text(second),
            },
            Question::Equivalence { hypothesis } => Self::Equivalence {
                hypothesis: universe.rule(hypothesis),
            },
        }
    }

    /// The question about this universe.
    ///
    /// # Errors
    ///
    /// If it is about something else.
    pub fn read(&self, universe: &Universe) -> Result<Question<Atom, Concept>, Unreadable> {
        Ok(match self {
            Self::Membership { atom } => Question::Membership {
                atom: universe.parse(atom)?,
            },
            Self::Comparison { first, second } => Question::Comparison {
                first: universe.parse(first)?,
                second: universe.parse(second)?,
            },
            Self::Equivalence { hypothesis } => Question::Equivalence {
                hypothesis: universe.parse_rule(hypothesis)?,
            },
        })
    }
}

impl ReplyText {
    /// The reply as this universe writes it.
    pub fn of(reply: &Reply<Atom>, universe: &Universe) -> Self {
        match reply {
            Reply::Accept => Self::Accept,
            Reply::Reject => Self::Reject,
            Reply::Compared(Comparison::First) => Self::First,
            Reply::Compared(Comparison::Second) => Self::Second,
            Reply::Compared(Comparison::Equal) => Self::Equal,
            Reply::Compared(Comparison::Incomparable) => Self::Incomparable,
            Reply::Correct => Self::Correct { looked: None },
            Reply::Skip => Self::Skip,
            Reply::Counterexample { atom, label } => Self::Counterexample {
                atom: universe.text(atom),
                label: *label,
            },
        }
    }

    /// The reply about this universe.
    ///
    /// # Errors
    ///
    /// If it is about something else.
    pub fn read(&self, universe: &Universe) -> Result<Reply<Atom>, Unreadable> {
        Ok(match self {
            Self::Accept => Reply::Accept,
            Self::Reject => Reply::Reject,
            Self::First => Reply::Compared(Comparison::First),
            Self::Second => Reply::Compared(Comparison::Second),
            Self::Equal => Reply::Compared(Comparison::Equal),
            Self::Incomparable => Reply::Compared(Comparison::Incomparable),
            Self::Correct { .. } => Reply::Correct,
            Self::Skip => Reply::Skip,
            Self::Counterexample { atom, label } => Reply::Counterexample {
                atom: universe.parse(atom)?,
                label: *label,
            },
        })
    }
}
