//! What a session's automaton comes to: the part that is learned, and the whole beside
//! what is known beforehand.

use automata::{Dfa, Word};

use super::{Position, Session};
use crate::learner::Question;
use crate::world::World;

impl Session {
    /// The world of the task; none where it is all words, shown as they are.
    pub fn world(&self) -> Option<&World> {
        self.situation.as_ref().map(|situation| &*situation.world)
    }

    /// Whether something is known beforehand, beside which the rest is learned.
    pub fn has_prior(&self) -> bool {
        !self.task.prior.is_empty()
    }

    /// The whole automaton, of which this is the part that is learned beside what is
    /// known beforehand: the part is what the learner asks about and the log has.
    pub fn whole(&self, learned: &Dfa) -> Dfa {
        match &self.situation {
            Some(situation) if self.has_prior() => situation.prior.whole(learned),
            _ => learned.clone(),
        }
    }

    /// The automaton on show as a [whole](Self::whole): the one asked about, or the
    /// one agreed on.
    ///
    /// Between those there is none: the last one shown was refuted.
    pub fn hypothesis(&self) -> Option<Dfa> {
        self.learned().map(|learned| self.whole(learned))
    }

    /// A behaviour that would decide what nothing in the world of the task does about
    /// the learned part, once the teacher has agreed with it; none where all is
    /// decided.
    pub fn beyond(&self) -> Option<Word> {
        match &self.position {
            Position::Done(learned) => self.learner.beyond(learned),
            _ => None,
        }
    }

    /// The part of [`Self::hypothesis`] that is learned.
    pub fn learned(&self) -> Option<&Dfa> {
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
