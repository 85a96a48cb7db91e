//! What a teacher's answers say about the concept being taught, whatever its
//! class. Knows neither automata nor learners.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use serde::{Deserialize, Serialize};

/// The number of an answered question; facts carry it so that an answer can be
/// retracted, and so that a contradiction can name answers.
///
/// Numbers are given by the session and never used twice.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(transparent)]
pub struct AnswerId(pub u32);

/// The four answers to a comparison of two atoms (section 5.1 of the
/// dissertation: `≻`, `≺`, `≡`, `∥`, seen from the first).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Comparison {
    /// The first is better.
    First,
    /// The second is better.
    Second,
    /// Both are equally good or bad.
    Equal,
    /// The two cannot be compared.
    Incomparable,
}

impl Comparison {
    /// The same answer, had the two atoms been shown the other way round.
    #[must_use]
    pub fn mirrored(self) -> Self {
        match self {
            Self::First => Self::Second,
            Self::Second => Self::First,
            same => same,
        }
    }
}

/// One thing that is known about the concept `φ` and the preference order.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum Fact<A> {
    /// `φ(atom) = accepted`.
    Label {
        /// The atom that was judged.
        atom: A,
        /// Whether it belongs to the concept.
        accepted: bool,
    },
    /// `worse ≺ better`, hence `φ(worse) ≤ φ(better)` (Definition 5.1.1).
    Below {
        /// The atom that is worse.
        worse: A,
        /// The atom that is better.
        better: A,
    },
    /// `first ≡ second`, hence `φ(first) = φ(second)`.
    Equal {
        /// One atom.
        first: A,
        /// The other.
        second: A,
    },
    /// `first ∥ second`: says nothing about `φ`, but need not be asked again.
    Incomparable {
        /// One atom.
        first: A,
        /// The other.
        second: A,
    },
}

impl<A> Fact<A> {
    /// What the answer to a comparison of `first` with `second` says.
    pub fn compared(first: A, second: A, answer: Comparison) -> Self {
        match answer {
            Comparison::First => Self::Below {
                worse: second,
                better: first,
            },
            Comparison::Second => Self::Below {
                worse: first,
                better: second,
            },
            Comparison::Equal => Self::Equal { first, second },
            Comparison::Incomparable => Self::Incomparable { first, second },
        }
    }

    /// Whether a concept that contains exactly the atoms for which `contains`
    /// holds is consistent with this fact (Definition 5.1.2).
    pub fn holds(&self, mut contains: impl FnMut(&A) -> bool) -> bool {
        match self {
            Self::Label { atom, accepted } => contains(atom) == *accepted,
            Self::Below { worse, better } => !contains(worse) || contains(better),
            Self::Equal { first, second } => contains(first) == contains(second),
            Self::Incomparable { .. } => true,
        }
    }
}

/// Ends a computation whose result nobody wants any more. Clones are the same stop.
///
/// What comes of a computation that was stopped means nothing, and nor does the
/// state in which it leaves whatever did the work.
#[derive(Clone, Debug, Default)]
pub struct Stop(Arc<AtomicBool>);

impl Stop {
    /// Ends the work, soon.
    pub fn set(&self) {
        self.0.store(true, Ordering::Relaxed);
    }

    /// Whether the work is to end.
    pub fn is_set(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}

/// How much work a computation may still do.
///
/// Work is counted in steps of the solvers, never in seconds, so that the same
/// input stops at the same place on every machine. One unit is one node of the
/// enumerator; the SAT engines convert their own steps to about the same time.
#[derive(Clone, Debug)]
pub struct Budget {
    left: u64,
    stop: Stop,
}

impl Budget {
    /// A budget of `units` of work.
    pub fn new(units: u64) -> Self {
        Self::until(units, &Stop::default())
    }

    /// A budget of `units` of work, all of which are gone once `stop` is set.
    pub fn until(units: u64, stop: &Stop) -> Self {
        Self {
            left: units,
            stop: stop.clone(),
        }
    }

    /// A budget that never ends.
    pub fn unlimited() -> Self {
        Self::new(u64::MAX)
    }

    /// Takes `units`; `false`, and nothing left, if there were not that many.
    #[must_use]
    pub fn spend(&mut self, units: u64) -> bool {
        if self.stop.is_set() {
            self.left = 0;
            return false;
        }
        if self.left == u64::MAX {
            return true;
        }
        let enough = self.left >= units;
        self.left = self.left.saturating_sub(units);
        enough
    }

    /// The units that are left.
    pub fn left(&self) -> u64 {
        self.left
    }

    /// Whether nothing is left.
    pub fn is_spent(&self) -> bool {
        self.left == 0 || self.stop.is_set()
    }

    /// What ends the work before the units are gone.
    pub fn stop(&self) -> &Stop {
        &self.stop
    }
}
