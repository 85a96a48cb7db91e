//! What is taught in an experiment: a language, or a monotone predicate.

use super::case::Case;
use crate::oracle::{MonotoneTarget, Target};

/// A target, a language with its setting.
#[derive(Clone, Debug)]
pub enum Subject {
    /// A language.
    Language(Box<Case>),
    /// A monotone predicate.
    Monotone(MonotoneTarget),
}

impl Subject {
    /// What it is called.
    pub fn name(&self) -> &str {
        match self {
            Self::Language(case) => case.name(),
            Self::Monotone(target) => target.name(),
        }
    }

    /// The number of states, or of points per axis.
    pub fn size(&self) -> usize {
        match self {
            Self::Language(case) => case.target().dfa().size(),
            Self::Monotone(target) => target.parameter().size(),
        }
    }

    /// The number of symbols, or of dimensions.
    pub fn width(&self) -> usize {
        match self {
            Self::Language(case) => case.target().dfa().alphabet().len(),
            Self::Monotone(target) => target.dimensions(),
        }
    }

    /// The language, if it is one.
    pub fn language(&self) -> Option<&Case> {
        match self {
            Self::Language(case) => Some(case),
            Self::Monotone(_) => None,
        }
    }
}

impl From<Target> for Subject {
    fn from(target: Target) -> Self {
        Self::Language(Box::new(target.into()))
    }
}

impl From<MonotoneTarget> for Subject {
    fn from(target: MonotoneTarget) -> Self {
        Self::Monotone(target)
    }
}

impl From<Case> for Subject {
    fn from(case: Case) -> Self {
        Self::Language(Box::new(case))
    }
}
