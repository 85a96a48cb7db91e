//! The entries of a session's log, with words as arrays of symbol names, so
//! that a log can be read without the program.

use automata::{Alphabet, Dfa, Word};
use serde::{Deserialize, Serialize};

use super::config::Setup;
use crate::evidence::Comparison;
use crate::identify::{Cause, Contradiction};
use crate::learner::{Question, Reply, Round};
use crate::task::{Automaton, Task, Unreadable};

/// The log's format; the first entry names it.
pub const LOG_VERSION: u32 = 1;

/// One entry of a session's log.
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
    /// The teacher agreed with this automaton.
    Done {
        /// What was learned.
        hypothesis: Automaton,
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
    fn of(contradiction: &Contradiction) -> Self {
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
    /// Is this word acceptable?
    Membership {
        /// The word.
        word: Vec<String>,
    },
    /// Which of two words is better?
    Comparison {
        /// One word.
        first: Vec<String>,
        /// The other.
        second: Vec<String>,
    },
    /// Is this the automaton?
    Equivalence {
        /// The automaton.
        hypothesis: Automaton,
    },
}

/// An answer, as the log and the API show it.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(tag = "answer", rename_all = "lowercase")]
pub enum ReplyText {
    /// The word is acceptable.
    Accept,
    /// The word is not acceptable.
    Reject,
    /// The first word is better.
    First,
    /// The second word is better.
    Second,
    /// Both are equally good or bad.
    Equal,
    /// The two cannot be compared.
    Incomparable,
    /// The automaton is right.
    Correct,
    /// No answer.
    Skip,
    /// The automaton is wrong about this word.
    Counterexample {
        /// The word.
        word: Vec<String>,
        /// Whether it is acceptable.
        label: bool,
    },
}

fn names(alphabet: &Alphabet, word: &Word) -> Vec<String> {
    alphabet.spell(word).map(str::to_owned).collect()
}

fn word(alphabet: &Alphabet, names: &[String]) -> Result<Word, Unreadable> {
    alphabet
        .word(names)
        .map_err(|error| Unreadable(error.to_string()))
}

impl QuestionText {
    /// The question in this alphabet's names.
    pub fn of(question: &Question<Word, Dfa>, alphabet: &Alphabet) -> Self {
        match question {
            Question::Membership { atom } => Self::Membership {
                word: names(alphabet, atom),
            },
            Question::Comparison { first, second } => Self::Comparison {
                first: names(alphabet, first),
                second: names(alphabet, second),
            },
            Question::Equivalence { hypothesis } => Self::Equivalence {
                hypothesis: Automaton::of(hypothesis),
            },
        }
    }

    /// The question over this alphabet.
    ///
    /// # Errors
    ///
    /// If a name is not in the alphabet, or the hypothesis is no automaton.
    pub fn read(&self, alphabet: &Alphabet) -> Result<Question<Word, Dfa>, Unreadable> {
        Ok(match self {
            Self::Membership { word: w } => Question::Membership {
                atom: word(alphabet, w)?,
            },
            Self::Comparison { first, second } => Question::Comparison {
                first: word(alphabet, first)?,
                second: word(alphabet, second)?,
            },
            Self::Equivalence { hypothesis } => Question::Equivalence {
                hypothesis: hypothesis.read(alphabet)?,
            },
        })
    }
}

impl ReplyText {
    /// The reply in this alphabet's names.
    pub fn of(reply: &Reply<Word>, alphabet: &Alphabet) -> Self {
        match reply {
            Reply::Accept => Self::Accept,
            Reply::Reject => Self::Reject,
            Reply::Compared(Comparison::First) => Self::First,
            Reply::Compared(Comparison::Second) => Self::Second,
            Reply::Compared(Comparison::Equal) => Self::Equal,
            Reply::Compared(Comparison::Incomparable) => Self::Incomparable,
            Reply::Correct => Self::Correct,
            Reply::Skip => Self::Skip,
            Reply::Counterexample { atom, label } => Self::Counterexample {
                word: names(alphabet, atom),
                label: *label,
            },
        }
    }

    /// The reply over this alphabet.
    ///
    /// # Errors
    ///
    /// If a name is not in the alphabet.
    pub fn read(&self, alphabet: &Alphabet) -> Result<Reply<Word>, Unreadable> {
        Ok(match self {
            Self::Accept => Reply::Accept,
            Self::Reject => Reply::Reject,
            Self::First => Reply::Compared(Comparison::First),
            Self::Second => Reply::Compared(Comparison::Second),
            Self::Equal => Reply::Compared(Comparison::Equal),
            Self::Incomparable => Reply::Compared(Comparison::Incomparable),
            Self::Correct => Reply::Correct,
            Self::Skip => Reply::Skip,
            Self::Counterexample { word: w, label } => Reply::Counterexample {
                atom: word(alphabet, w)?,
                label: *label,
            },
        })
    }
}

impl Event {
    /// The entry that says that these answers cannot stand together.
    pub fn conflict(contradiction: &Contradiction) -> Self {
        Self::Conflict {
            conflict: Conflict::of(contradiction),
        }
    }
}
