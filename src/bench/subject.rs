//! What is taught in an experiment: a language, or a monotone predicate.

use crate::oracle::{MonotoneTarget, Target};

/// A target.
#[derive(Clone, Debug)]
pub enum Subject {
    /// A language.
    Language(Target),
    /// A monotone predicate.
    Monotone(MonotoneTarget),
}

impl Subject {
    /// What it is called.
    pub fn name(&self) -> &str {
        match self {
            Self::Language(target) => target.name(),
            Self::Monotone(target) => target.name(),
        }
    }

    /// The number of states, or of points per axis.
    pub fn size(&self) -> usize {
        match self {
            Self::Language(target) => target.dfa().size(),
            Self::Monotone(target) => target.parameter().size(),
        }
    }

    /// The number of symbols, or of dimensions.
    pub fn width(&self) -> usize {
        match self {
            Self::Language(target) => target.dfa().alphabet().len(),
            Self::Monotone(target) => target.dimensions(),
        }
    }

    /// The language, if it is one.
    pub fn language(&self) -> Option<&Target> {
        match self {
            Self::Language(target) => Some(target),
            Self::Monotone(_) => None,
        }
    }
}

impl From<Target> for Subject {
    fn from(target: Target) -> Self {
        Self::Language(target)
    }
}

impl From<MonotoneTarget> for Subject {
    fn from(target: MonotoneTarget) -> Self {
        Self::Monotone(target)
    }
}
