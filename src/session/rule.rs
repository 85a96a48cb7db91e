//! What a session's rule comes to: the part that is learned, and the whole beside what
//! is known beforehand.

use super::{Position, Session};
use crate::learner::Question;
use crate::task::{Atom, Concept, Situation};
use crate::world::World;

impl Session {
    /// The world of the task; none where it is all words, shown as they are, or none
    /// at all.
    pub fn world(&self) -> Option<&World> {
        self.situation().map(|situation| &*situation.world)
    }

    /// The world and what is known beforehand; none if there is neither.
    pub(super) fn situation(&self) -> Option<&Situation> {
        self.universe.situation()
    }

    /// Whether something is known beforehand, beside which the rest is learned.
    pub fn has_prior(&self) -> bool {
        !self.task.prior.is_empty()
    }

    /// The whole rule, of which this is the part that is learned beside what is known
    /// beforehand: the part is what the learner asks about and the log has.
    pub fn whole(&self, learned: &Concept) -> Concept {
        match (self.situation(), learned) {
            (Some(situation), Concept::Automaton(learned)) if self.has_prior() => {
                Concept::Automaton(situation.prior.whole(learned))
            }
            _ => learned.clone(),
        }
    }

    /// The rule on show as a [whole](Self::whole): the one asked about, or the one
    /// agreed on.
    ///
    /// Between those there is none: the last one shown was refuted.
    pub fn hypothesis(&self) -> Option<Concept> {
        self.learned().map(|learned| self.whole(learned))
    }

    /// The [whole](Self::whole) rule that was asked about last, whatever became of it.
    pub fn last_shown(&self) -> Option<Concept> {
        let mut asked = self.asked.values().rev();
        asked.find_map(|asked| match &asked.question {
            Question::Equivalence { hypothesis } => Some(self.whole(hypothesis)),
            _ => None,
        })
    }

    /// A behaviour that would decide what nothing in the world of the task does about
    /// the learned part, once the teacher has agreed with it; none where all is
    /// decided.
    pub fn beyond(&self) -> Option<Atom> {
        match &self.position {
            Position::Done(learned) => self.learner.beyond(learned),
            _ => None,
        }
    }

    /// The part of [`Self::hypothesis`] that is learned.
    pub fn learned(&self) -> Option<&Concept> {
        match &self.position {
            Position::Done(hypothesis) => Some(hypothesis),
            Position::Asking(number) => match &self.asked.get(number)?.question {
                Question::Equivalence { hypothesis } => Some(hypothesis),
                _ => None,
            },
            Position::Thinking | Position::Conflict(_) => None,
        }
    }
}
