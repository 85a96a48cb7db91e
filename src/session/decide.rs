//! What a person or a script wants to do, checked against where the session
//! stands, and turned into the entry to append.

use automata::Word;

use super::event::{Event, ReplyText};
use super::panel::{MAX_ANSWERS, MAX_NAME, MAX_PEOPLE};
use super::{Position, Session};
use crate::evidence::Comparison;
use crate::learner::{Question, Reply};
use crate::task::{Atom, Concept, MAX_STATES, Universe};
use crate::world::Obstacle;

/// What becomes of a wish.
#[expect(
    clippy::large_enum_variant,
    reason = "nearly every decision is to append, and none is kept"
)]
#[derive(Clone, Debug, PartialEq)]
pub enum Decision {
    /// It is new: append this entry.
    Append(Event),
    /// It was done before: nothing to append, and this is where it led.
    Already(Position),
}

/// Why a wish cannot be granted; the text says what to do instead.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Refusal {
    /// The question is not open any more.
    #[error("question {number} is closed: {now}")]
    Closed {
        /// The question.
        number: u32,
        /// What is open instead.
        now: String,
    },
    /// There has been no such question.
    #[error("there is no question {number}: {now}")]
    Unknown {
        /// The question.
        number: u32,
        /// What is open instead.
        now: String,
    },
    /// There is no standing answer of this number.
    #[error("question {number} has no standing answer{}", if *withdrawn { ": it was withdrawn" } else { " yet" })]
    NotStanding {
        /// The question.
        number: u32,
        /// Whether there was one.
        withdrawn: bool,
    },
    /// The answer belongs to another kind of question.
    #[error("this answer does not fit question {number}, {kind}: answer {fitting}")]
    Unfit {
        /// The question.
        number: u32,
        /// Its kind, for people.
        kind: &'static str,
        /// The answers that fit.
        fitting: &'static str,
    },
    /// The hypothesis already treats the behaviour so.
    #[error(
        "this is no counterexample: the rule shown already {} that; give a behaviour that it treats wrongly",
        if *label { "accepts" } else { "rejects" }
    )]
    NoCounterexample {
        /// The label that was claimed.
        label: bool,
    },
    /// The behaviour cannot be shown.
    #[error(
        "this cannot happen in the world of the task, so it says nothing here: {why}; give a behaviour that can"
    )]
    Infeasible {
        /// What stands in its way.
        why: String,
    },
    /// What is known beforehand says the opposite.
    #[error(
        "what is known beforehand says that this is {}, whatever is learned: give another behaviour, or have the task changed",
        if *label { "not acceptable" } else { "acceptable" }
    )]
    Settled {
        /// The label that was claimed.
        label: bool,
    },
    /// The sheet beside the rule has another number of behaviours.
    #[error(
        "the sheet of this rule has {drawn} behaviours: say that all {drawn} were looked at, or leave `looked` out"
    )]
    Looked {
        /// How many.
        drawn: u32,
    },
    /// A rule shown long ago cannot be declared right afterwards.
    #[error(
        "the rule of question {number} was refuted by a later look: withdraw this answer instead, and the question comes again if it is still open"
    )]
    Outdated {
        /// The question.
        number: u32,
    },
    /// There is nothing to take back.
    #[error("there is no answer to take back yet")]
    NothingToUndo,
    /// A question wants no so many answers.
    #[error("a question wants from 1 to {MAX_ANSWERS} answers")]
    BadAnswers,
    /// Nobody is called that.
    #[error("give a name of 1 to {MAX_NAME} characters")]
    BadName,
    /// A name of which some is not shown, or turns round what stands beside it.
    #[error(
        "there are control characters in this name, which cannot be shown: type it anew without them"
    )]
    UnshownName,
    /// Nobody comes back by a new link.
    #[error("this person was asked to leave: invite them anew")]
    Dismissed,
    /// There are enough people.
    #[error("a session has at most {MAX_PEOPLE} people: begin another one of the same task")]
    TooManyPeople,
    /// The person does not answer here, or not any more.
    #[error("this link does not answer here any more: ask whoever sent it for a new one")]
    NoPerson,
    /// The person has answered it otherwise.
    #[error("you have answered question {number} before: withdraw that answer to give another")]
    Said {
        /// The question.
        number: u32,
    },
    /// The answer needs the rule on the table.
    #[error("only the owner of the session says whether a rule is right")]
    OwnersAnswer,
    /// There is no bound on states.
    #[error(
        "this task learns no automaton, so it has no bound on states: withdraw or change an answer"
    )]
    NoBound,
    /// The bound cannot be set to this.
    #[error("give a bound larger than {now} and at most {MAX_STATES}")]
    BadBound {
        /// The bound as it is.
        now: usize,
    },
}

/// The replies to a question that need no further words.
fn plain_replies(question: &Question<Atom, Concept>) -> Vec<Reply<Atom>> {
    let compared = Reply::Compared;
    match question {
        Question::Membership { .. } => vec![Reply::Accept, Reply::Reject, Reply::Skip],
        Question::Comparison { .. } => vec![
            compared(Comparison::First),
            compared(Comparison::Second),
            compared(Comparison::Equal),
            compared(Comparison::Incomparable),
            Reply::Skip,
        ],
        Question::Equivalence { .. } => vec![Reply::Correct],
    }
}

impl Session {
    /// Somebody answers the question of this number.
    ///
    /// # Errors
    ///
    /// If the question is not open, or the reply does not fit it.
    pub fn answer(&self, number: u32, reply: &Reply<Atom>) -> Result<Decision, Refusal> {
        if !self.is_open(number) {
            return match self.answer_to(number) {
                Some(standing) if standing.reply == *reply => Ok(Decision::Already(
                    standing
                        .then
                        .clone()
                        .unwrap_or_else(|| self.position().clone()),
                )),
                _ => Err(self.not_open(number)),
            };
        }
        self.check_fit(number, reply)?;
        Ok(Decision::Append(Event::Answered {
            number,
            reply: ReplyText::of(reply, self.universe()),
        }))
    }

    /// Somebody withdraws the answer to the question of this number.
    ///
    /// # Errors
    ///
    /// If it was never answered.
    pub fn retract(&self, number: u32) -> Result<Decision, Refusal> {
        if self.answer_to(number).is_some() {
            Ok(Decision::Append(Event::Retracted { number }))
        } else if self.withdrawn.contains(&number) {
            Ok(Decision::Already(self.position().clone()))
        } else {
            Err(self.not_standing(number))
        }
    }

    /// Somebody withdraws the last standing answer.
    ///
    /// # Errors
    ///
    /// If no answer stands.
    pub fn undo(&self) -> Result<Decision, Refusal> {
        match self.standing().last() {
            Some(last) => self.retract(last.number),
            None => Err(Refusal::NothingToUndo),
        }
    }

    /// Somebody replaces the answer to the question of this number.
    ///
    /// # Errors
    ///
    /// If no answer stands there, or the new one does not fit.
    pub fn change(&self, number: u32, reply: &Reply<Atom>) -> Result<Decision, Refusal> {
        let Some(standing) = self.answer_to(number) else {
            return Err(self.not_standing(number));
        };
        if standing.reply == *reply {
            return Ok(Decision::Already(self.position().clone()));
        }
        if *reply == Reply::Correct {
            return Err(Refusal::Outdated { number });
        }
        self.check_fit(number, reply)?;
        Ok(Decision::Append(Event::Changed {
            number,
            reply: ReplyText::of(reply, self.universe()),
        }))
    }

    /// Somebody allows more states.
    ///
    /// # Errors
    ///
    /// If that is fewer than now, or beyond all bounds.
    pub fn enlarge(&self, max_states: usize) -> Result<Decision, Refusal> {
        let now = self.task().max_states;
        if !matches!(self.universe(), Universe::Words { .. }) {
            return Err(Refusal::NoBound);
        }
        if max_states == now {
            return Ok(Decision::Already(self.position().clone()));
        }
        if max_states < now || max_states > MAX_STATES {
            return Err(Refusal::BadBound { now });
        }
        Ok(Decision::Append(Event::Enlarged { max_states }))
    }

    /// The entries that may well be appended next, those that people decide for
    /// most often first: every answer that needs no further words, and in a
    /// conflict all that may mend it.
    pub fn foreseen(&self) -> Vec<Event> {
        match self.position() {
            Position::Thinking | Position::Done(_) => Vec::new(),
            // Who of several people answers what is not to be foreseen.
            Position::Asking(_) if self.panel().is_shared() => Vec::new(),
            Position::Asking(number) => {
                let Some(asked) = self.asked(*number) else {
                    return Vec::new();
                };
                let replies = plain_replies(&asked.question).into_iter();
                let answered = replies.map(|reply| Event::Answered {
                    number: *number,
                    reply: ReplyText::of(&reply, self.universe()),
                });
                answered.collect()
            }
            Position::Conflict(conflict) => {
                let mended = conflict
                    .answers
                    .iter()
                    .flat_map(|&number| self.mended(number));
                mended.collect()
            }
        }
    }

    /// The entries that take this answer back, or give another in its place.
    fn mended(&self, number: u32) -> Vec<Event> {
        let Some(asked) = self.asked(number) else {
            return Vec::new();
        };
        let replies = plain_replies(&asked.question).into_iter();
        let changes = replies
            .filter(|reply| *reply != Reply::Skip)
            .filter_map(|reply| match self.change(number, &reply) {
                Ok(Decision::Append(event)) => Some(event),
                _ => None,
            });
        std::iter::once(Event::Retracted { number })
            .chain(changes)
            .collect()
    }

    /// Whether a reply fits the question of this number, which was asked.
    pub(super) fn check_fit(&self, number: u32, reply: &Reply<Atom>) -> Result<(), Refusal> {
        let Some(asked) = self.asked(number) else {
            return Err(self.not_open(number));
        };
        let (kind, fitting) = match (&asked.question, reply) {
            (Question::Membership { .. }, Reply::Accept | Reply::Reject | Reply::Skip)
            | (Question::Comparison { .. }, Reply::Compared(_) | Reply::Skip)
            | (Question::Equivalence { .. }, Reply::Correct) => return Ok(()),
            (Question::Equivalence { hypothesis }, Reply::Counterexample { atom, label }) => {
                return self.check_counterexample(hypothesis, atom, *label);
            }
            (Question::Membership { .. }, _) => {
                ("which judges one behaviour", "`accept`, `reject` or `skip`")
            }
            (Question::Comparison { .. }, _) => (
                "which compares two behaviours",
                "`first`, `second`, `equal`, `incomparable` or `skip`",
            ),
            (Question::Equivalence { .. }, _) => {
                ("which shows a rule", "`correct` or `counterexample`")
            }
        };
        Err(Refusal::Unfit {
            number,
            kind,
            fitting,
        })
    }

    /// Whether the behaviour refutes the learned part, and may.
    fn check_counterexample(
        &self,
        learned: &Concept,
        atom: &Atom,
        label: bool,
    ) -> Result<(), Refusal> {
        let mut says = self.universe().accepts(learned, atom);
        if let (Some(situation), Atom::Word(word)) = (self.situation(), atom) {
            if !situation.world.is_feasible(word) {
                let why = self.hindered(word);
                return Err(Refusal::Infeasible { why });
            }
            match situation.prior.settled(word) {
                Some(settled) if settled != label => return Err(Refusal::Settled { label }),
                settled => says = settled.unwrap_or(says),
            }
        }
        if says == label {
            Err(Refusal::NoCounterexample { label })
        } else {
            Ok(())
        }
    }

    /// What stands in the way of a word that cannot happen, as a part of a sentence.
    fn hindered(&self, word: &Word) -> String {
        let task = self.task();
        let step = |place: usize, symbol| format!("step {} ({})", place + 1, task.text(symbol));
        match self.world().and_then(|world| world.obstacle(word)) {
            Some(Obstacle::TooLong { longest }) => {
                format!(
                    "it has {} steps, and at most {longest} can happen",
                    word.len()
                )
            }
            Some(Obstacle::NoWay { place, symbol }) => {
                let step = step(place, symbol);
                format!(
                    "from where it is by then, no way leads to {step} without touching something else"
                )
            }
            Some(Obstacle::TooFar {
                place,
                symbol,
                steps,
            }) => {
                let step = step(place, symbol);
                format!("a walk makes at most {steps} moves, and {step} is farther than that")
            }
            Some(Obstacle::NotRecorded) | None => "there is no recording of it".to_owned(),
        }
    }

    pub(super) fn not_open(&self, number: u32) -> Refusal {
        let now = self.describe_now();
        if self.asked(number).is_some() {
            Refusal::Closed { number, now }
        } else {
            Refusal::Unknown { number, now }
        }
    }

    pub(super) fn not_standing(&self, number: u32) -> Refusal {
        if self.asked(number).is_none() {
            return self.not_open(number);
        }
        Refusal::NotStanding {
            number,
            withdrawn: self.withdrawn.contains(&number),
        }
    }

    /// What can be done now, as the end of a sentence.
    fn describe_now(&self) -> String {
        match self.position() {
            Position::Thinking => "the next one is being chosen, ask again".to_owned(),
            Position::Asking(number) => format!("question {number} is open now"),
            Position::Conflict(conflict) if conflict.answers.is_empty() => {
                "what was known at the start needs more states, allow more of them".to_owned()
            }
            Position::Conflict(conflict) => {
                let numbers: Vec<String> = conflict.answers.iter().map(u32::to_string).collect();
                format!(
                    "the answers to {} cannot all be true, withdraw or change one of them",
                    numbers.join(", ")
                )
            }
            Position::Done(_) => "the session is done, undo to go on".to_owned(),
        }
    }
}
