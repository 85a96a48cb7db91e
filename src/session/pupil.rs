//! The learner of a session: over all words, or in a world beside what is known
//! beforehand.

use automata::{Alphabet, Dfa, Word};

use super::Setup;
use crate::concept::{DfaClass, Situated};
use crate::evidence::AnswerId;
use crate::identify::{EngineChoice, Settings};
use crate::learner::{Counts, Learner, Question, Reply, Round, Step};
use crate::task::{Situation, Task};

/// Both learn automata over words; only which words they ask about differs.
pub(super) enum Pupil {
    Anywhere(Box<Learner<DfaClass>>),
    Situated(Box<Learner<Situated>>),
}

impl Pupil {
    /// A learner that was told no answer yet.
    ///
    /// # Errors
    ///
    /// If what is known at the start does not fit the situation, of a task that was
    /// not read but put together.
    pub(super) fn new(
        task: &Task,
        situation: Option<&Situation>,
        setup: &Setup,
        alphabet: &Alphabet,
    ) -> Result<Self, String> {
        let settings = Settings {
            engine: EngineChoice::Auto,
            max_states: task.max_states,
        };
        let known = task.known(alphabet);
        let Some(situation) = situation else {
            let class = DfaClass::new(alphabet.clone(), settings);
            let learner = Learner::new(class, setup.config(), known);
            return Ok(Self::Anywhere(Box::new(learner)));
        };
        let class = situation
            .class(settings)
            .map_err(|error| error.to_string())?;
        let known = class.examples(&known).map_err(|error| error.to_string())?;
        let learner = Learner::new(class, setup.config(), known);
        Ok(Self::Situated(Box::new(learner)))
    }

    pub(super) fn next(&mut self) -> Step<Word, Dfa> {
        match self {
            Self::Anywhere(learner) => learner.next(),
            Self::Situated(learner) => learner.next(),
        }
    }

    pub(super) fn record(
        &mut self,
        answer: AnswerId,
        question: Question<Word, Dfa>,
        round: Option<Round>,
        reply: Reply<Word>,
    ) -> Result<(), String> {
        match self {
            Self::Anywhere(learner) => learner.record(answer, question, round, reply),
            Self::Situated(learner) => learner.record(answer, question, round, reply),
        }
        .map_err(|error| error.to_string())
    }

    pub(super) fn retract(&mut self, answer: AnswerId) -> bool {
        match self {
            Self::Anywhere(learner) => learner.retract(answer),
            Self::Situated(learner) => learner.retract(answer),
        }
    }

    /// What nothing that can be shown tells about this hypothesis.
    pub(super) fn beyond(&self, hypothesis: &Dfa) -> Option<Word> {
        match self {
            Self::Anywhere(_) => None,
            Self::Situated(learner) => learner.class().beyond(hypothesis),
        }
    }

    pub(super) fn counts(&self) -> Counts {
        match self {
            Self::Anywhere(learner) => learner.counts(),
            Self::Situated(learner) => learner.counts(),
        }
    }
}
