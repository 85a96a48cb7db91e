//! What shows a word, for programs: a walk's cells, or a recording's name.

use automata::Word;
use serde::Serialize;

use super::{Trajectory, World};

/// What shows a word.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Shown<'a> {
    /// The rows and columns of a walk's cells, from its start; both from 0.
    Walk(Vec<[usize; 2]>),
    /// The recording of this name.
    Recording(&'a str),
}

impl World {
    /// What shows the word; none where words are shown as they are, and if it is not
    /// feasible.
    pub fn shown(&self, word: &Word) -> Option<Shown<'_>> {
        match self.trajectory(word)? {
            Trajectory::Word(_) => None,
            Trajectory::Walk { from, steps } => {
                let cells = std::iter::once(from).chain(steps.iter().map(|step| step.to));
                Some(Shown::Walk(cells.map(|at| [at.row, at.column]).collect()))
            }
            Trajectory::Recording(recording) => Some(Shown::Recording(&recording.id)),
        }
    }
}
