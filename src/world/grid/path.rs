//! A trajectory through a grid: where it begins, and step by step where it leads
//! and what that gives.

use automata::{Symbol, Word};

use super::{Cell, Grid};

/// One step. The order in which moves are preferred where all else is equal.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Move {
    /// To the row above.
    Up,
    /// To the next column.
    Right,
    /// To the row below.
    Down,
    /// To the column before.
    Left,
    /// Nowhere.
    Stay,
}

impl Move {
    /// All of them.
    pub const ALL: [Self; 5] = [Self::Up, Self::Right, Self::Down, Self::Left, Self::Stay];

    /// The quarter turns from a heading (none before the first move) to this
    /// move: to stay is no turn, and to go back is two.
    pub(super) fn turns_from(self, heading: Option<Self>) -> u32 {
        match heading {
            Some(heading) if self != Self::Stay => {
                let apart = (self as u32).abs_diff(heading as u32);
                apart.min(4 - apart)
            }
            _ => 0,
        }
    }

    /// The heading after this move.
    pub(super) fn heading(self, before: Option<Self>) -> Option<Self> {
        if self == Self::Stay {
            before
        } else {
            Some(self)
        }
    }
}

/// A step of a trajectory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Step {
    /// Which way it goes.
    pub by: Move,
    /// Where it ends.
    pub to: Cell,
    /// The symbol that it gives, if any.
    pub gives: Option<Symbol>,
}

/// A way through the grid.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(in crate::world) struct Path {
    pub(super) turns: u32,
    pub(super) word: Word,
    /// The place of its start among the starts.
    pub(super) start: usize,
    pub(super) moves: Vec<Move>,
}

impl Path {
    /// The way that goes nowhere from the start of this place.
    pub(super) fn from(start: usize) -> Self {
        Self {
            turns: 0,
            word: Word::empty(),
            start,
            moves: Vec::new(),
        }
    }

    /// The same with one more step.
    pub(super) fn with(&self, heading: Option<Move>, by: Move, gives: Option<Symbol>) -> Self {
        let mut longer = self.clone();
        longer.turns += by.turns_from(heading);
        if let Some(symbol) = gives {
            longer.word.push(symbol);
        }
        longer.moves.push(by);
        longer
    }

    /// The number of its steps.
    pub(in crate::world) fn steps(&self) -> usize {
        self.moves.len()
    }

    /// The least wandering comes first, then the least word, the first start and
    /// the moves in order.
    pub(super) fn key(&self) -> (u32, &Word, usize, &[Move]) {
        (self.turns, &self.word, self.start, &self.moves)
    }
}

impl Grid {
    /// The cells and steps of a way.
    pub(in crate::world) fn walk(&self, path: &Path) -> (Cell, Vec<Step>) {
        let mut at = self.starts[path.start];
        let from = self.cell(at);
        let mut steps = Vec::with_capacity(path.moves.len());
        for &by in &path.moves {
            // A way is made of steps that can be taken.
            at = self.step(at, by).unwrap_or(at);
            steps.push(Step {
                by,
                to: self.cell(at),
                gives: self.given(at),
            });
        }
        (from, steps)
    }
}
