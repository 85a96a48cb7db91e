//! One teaching session: a fold over its append-only log.
//!
//! A [`Session`] is what its [`Event`]s say, in their order, and nothing else:
//! the same log gives the same page on every machine. It is pure: it must not
//! know how the log is stored, who asks, or what time it is.
//!
//! An answer goes `decide` → (append) → [`Session::apply`] → [`Session::think`]
//! → (append) → [`Session::apply`]: what the learner makes of an answer is an
//! entry of its own, so that it is computed once and shown for ever after.

mod agreement;
mod config;
mod decide;
mod describe;
mod event;
mod explain;
mod fold;
mod panel;
mod people;
mod pupil;
mod ready;
mod rule;
mod samples;

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

pub use agreement::Agreement;
pub use config::{DEFAULT_BUDGET, KEYS as SETUP_KEYS, Setup};
pub use decide::{Decision, Refusal};
pub use event::{Conflict, ConflictCause, Event, LOG_VERSION, QuestionText, ReplyText};
pub use panel::{
    MAX_ANSWERS, MAX_NAME, MAX_PEOPLE, Opinion, Panel, Person, Pooling, Record, Terms,
};
pub use ready::{NAMES as READY_NAMES, offered, ready};
pub use samples::{Claim, RISK, SHEET, Samples};

use self::pupil::Pupil;
use crate::evidence::Stop;
use crate::identify::Contradiction;
use crate::learner::{Counts, Left, Question, Removed, Reply, Round, Step};
pub use crate::task::{
    Atom, AtomText, Automaton, Concept, ConceptText, DEFAULT_STATES, Example, Fields, MAX_EXAMPLES,
    MAX_STATES, MAX_SYMBOLS, MAX_WORD, Malformed, SymbolText, Task, Universe, read_word,
};
use crate::world::World;

/// A question that was put at some time.
#[derive(Clone, Debug)]
pub struct Asked {
    /// The question.
    pub question: Question<Atom, Concept>,
    /// Whether the budget ended before the best one was found.
    pub hurried: bool,
    /// What was left to be learned as it was put, where that is known.
    pub left: Option<Left>,
    /// How many of the concepts left every answer would rule out.
    pub removed: Vec<Removed>,
    round: Option<Round>,
}

/// An answer that stands.
#[derive(Clone, Debug)]
pub struct Standing {
    /// The number of the question that it answers.
    pub number: u32,
    /// The answer.
    pub reply: Reply<Atom>,
    /// Of an agreement, how many behaviours beside the rule were looked at; none
    /// where that was not said.
    pub looked: Option<u32>,
    /// What the learner did next, once it has; none for a mended answer.
    then: Option<Position>,
}

/// Where a session stands.
#[derive(Clone, Debug, PartialEq)]
pub enum Position {
    /// The learner has yet to [think](Session::think).
    Thinking,
    /// The question of this number is open.
    Asking(u32),
    /// Some standing answers contradict each other.
    Conflict(Conflict),
    /// The teacher agreed with this rule, or the part of it that is learned.
    Done(Concept),
}

/// A log that cannot be folded: it was not written by this program, or by a
/// version that means something else by it.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("entry {entry} of the log cannot be read: {message}")]
pub struct Corrupt {
    /// The entry, from 0.
    pub entry: u64,
    /// What is wrong with it.
    pub message: String,
}

/// One teaching session.
pub struct Session {
    task: Task,
    setup: Setup,
    universe: Universe,
    learner: Box<dyn Pupil>,
    asked: BTreeMap<u32, Asked>,
    /// The questions that can be answered: one, unless several people do.
    open: BTreeSet<u32>,
    panel: Panel,
    standing: Vec<Standing>,
    withdrawn: BTreeSet<u32>,
    position: Position,
    /// The answer whose outcome is next, if an answer is what led to it.
    awaiting: Option<u32>,
    entries: u64,
}

impl Session {
    /// The first entry of a new session's log.
    pub fn created(task: Task, setup: Setup) -> Event {
        Event::Created {
            log: LOG_VERSION,
            memrep: env!("CARGO_PKG_VERSION").to_owned(),
            task: Box::new(task),
            setup,
        }
    }

    /// Folds a whole log.
    ///
    /// # Errors
    ///
    /// Names the first entry that makes no sense.
    pub fn replay(events: &[Event]) -> Result<Self, Corrupt> {
        Self::replay_in(None, events)
    }

    /// Folds a whole log, in this world where its task's is an
    /// [upload](Task::upload).
    ///
    /// # Errors
    ///
    /// Names the first entry that makes no sense.
    pub fn replay_in(world: Option<Arc<World>>, events: &[Event]) -> Result<Self, Corrupt> {
        let corrupt = |message: &str| Corrupt {
            entry: 0,
            message: message.to_owned(),
        };
        let Some((first, rest)) = events.split_first() else {
            return Err(corrupt("the log is empty"));
        };
        let Event::Created {
            log, task, setup, ..
        } = first
        else {
            return Err(corrupt("it does not create the session"));
        };
        if *log != LOG_VERSION {
            return Err(corrupt(&format!(
                "it is of version {log}, and this memrep reads version {LOG_VERSION}: use the memrep that wrote it"
            )));
        }
        let fresh = Self::new(Task::clone(task), setup.clone(), world);
        let mut session = fresh.map_err(|message| corrupt(&message))?;
        for event in rest {
            session.apply(event)?;
        }
        Ok(session)
    }

    fn new(task: Task, setup: Setup, world: Option<Arc<World>>) -> Result<Self, String> {
        let universe = task.universe_in(world);
        let universe = universe.map_err(|error| error.to_string())?;
        Ok(Self {
            learner: pupil::new(&task, &universe, &setup)?,
            universe,
            task,
            setup,
            asked: BTreeMap::new(),
            open: BTreeSet::new(),
            panel: Panel::default(),
            standing: Vec::new(),
            withdrawn: BTreeSet::new(),
            position: Position::Thinking,
            awaiting: None,
            entries: 1,
        })
    }

    /// Folds in the next entry of the log.
    ///
    /// # Errors
    ///
    /// If the entry makes no sense here; the session must not be used further.
    pub fn apply(&mut self, event: &Event) -> Result<(), Corrupt> {
        self.fold(event).map_err(|message| Corrupt {
            entry: self.entries,
            message,
        })?;
        self.entries += 1;
        Ok(())
    }

    /// What the learner makes of the standing answers: the entry to append
    /// while the session is [`Position::Thinking`], `None` otherwise.
    ///
    /// This is the only work here that takes time, at most the budget.
    pub fn think(&mut self) -> Option<Event> {
        self.think_until(&Stop::default())
    }

    /// The same, or nothing, and soon, once `stop` is set: the session is then
    /// thinking still.
    pub fn think_until(&mut self, stop: &Stop) -> Option<Event> {
        if self.position != Position::Thinking {
            return None;
        }
        Some(match self.learner.next_until(stop)? {
            Step::Ask {
                question,
                round,
                hurried,
            } => {
                let (left, removed) = match self.learner.outlook() {
                    Some(outlook) => (Some(outlook.left), outlook.removed),
                    None => (None, Vec::new()),
                };
                Event::Asked {
                    number: self.next_number(),
                    question: QuestionText::of(&question, &self.universe),
                    round,
                    hurried,
                    left,
                    removed,
                }
            }
            Step::Conflict(contradiction) => Event::Conflict {
                conflict: self.conflict(&contradiction),
            },
            Step::Done { hypothesis } => Event::Done {
                hypothesis: self.universe.rule(&hypothesis),
            },
        })
    }

    /// A session that stands where this one does, to try out what would follow.
    #[must_use]
    pub fn fork(&self) -> Self {
        Self {
            task: self.task.clone(),
            setup: self.setup.clone(),
            universe: self.universe.clone(),
            learner: self.learner.fork(),
            asked: self.asked.clone(),
            open: self.open.clone(),
            panel: self.panel.clone(),
            standing: self.standing.clone(),
            withdrawn: self.withdrawn.clone(),
            position: self.position.clone(),
            awaiting: self.awaiting,
            entries: self.entries,
        }
    }

    /// Two concepts that the open question tells apart, the likeliest first; none
    /// where no question is open, and where there is only one. Takes as long as
    /// [`Self::think`], unless that was just done.
    pub fn rivals(&mut self) -> Option<[Concept; 2]> {
        if !matches!(self.position, Position::Asking(_)) {
            return None;
        }
        self.learner.next_until(&Stop::default());
        self.learner.outlook()?.rivals
    }

    /// A contradiction of this session: only automata have a bound that can be raised.
    fn conflict(&self, contradiction: &Contradiction) -> Conflict {
        let conflict = Conflict::of(contradiction);
        let bound = conflict
            .bound
            .filter(|_| self.universe.alphabet().is_some());
        Conflict { bound, ..conflict }
    }

    fn next_number(&self) -> u32 {
        self.asked.last_key_value().map_or(1, |(last, _)| last + 1)
    }

    /// What is taught, with the bound on states as it is now.
    pub fn task(&self) -> &Task {
        &self.task
    }

    /// How questions are chosen.
    pub fn setup(&self) -> &Setup {
        &self.setup
    }

    /// The behaviours of the task, and the rules that can be learned of them.
    pub fn universe(&self) -> &Universe {
        &self.universe
    }

    /// Where the session stands.
    pub fn position(&self) -> &Position {
        &self.position
    }

    /// The number of log entries folded, which is the number of the next one.
    pub fn entries(&self) -> u64 {
        self.entries
    }

    /// A question by its number.
    pub fn asked(&self, number: u32) -> Option<&Asked> {
        self.asked.get(&number)
    }

    /// The standing answers, in the order in which they were given.
    pub fn standing(&self) -> &[Standing] {
        &self.standing
    }

    /// The standing answer to the question of this number.
    pub fn answer_to(&self, number: u32) -> Option<&Standing> {
        self.standing.iter().find(|s| s.number == number)
    }

    /// The standing answers by kind; skipped questions count nowhere.
    pub fn counts(&self) -> Counts {
        self.learner.counts()
    }
}
