//! Who can answer without a person: scripted teachers and their targets.
//!
//! A teacher knows its target and a preference order over atoms. It must not
//! know learners.

mod classed;
mod counterexample;
mod drawn;
mod monotone;
mod order;
mod scripted;
mod situated;
mod target;

pub use classed::ClassGoal;
pub use counterexample::Counterexamples;
pub use drawn::Shape;
pub(crate) use drawn::minimal;
pub use monotone::{MonotoneError, MonotoneTarget};
pub use order::{Order, PreferenceOrder};
pub use scripted::{Goal, Language, ScriptedTeacher, TeacherSettings};
pub use situated::SituatedTeacher;
pub use target::{Target, TargetError};

use crate::evidence::Comparison;

/// Answers the three kinds of questions.
pub trait Teacher {
    /// One element of the universe.
    type Atom;
    /// One concept.
    type Concept;

    /// Whether the atom is acceptable.
    fn membership(&mut self, atom: &Self::Atom) -> bool;

    /// Whether a judgement or a comparison may be wrong. Counterexamples never are.
    fn may_err(&self) -> bool {
        true
    }

    /// Which of the two is better.
    fn comparison(&mut self, first: &Self::Atom, second: &Self::Atom) -> Comparison;

    /// An atom about which the hypothesis is wrong, with its true label; none if
    /// it is right about all.
    fn counterexample(&mut self, hypothesis: &Self::Concept) -> Option<(Self::Atom, bool)>;
}
