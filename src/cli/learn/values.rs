//! What the arguments of `memrep learn` may be: numbers in their bounds, and
//! names.

use clap::ValueEnum;
use clap::builder::PossibleValue;

use crate::learner::Strategy;
use crate::oracle::{Counterexamples, Order};
use crate::world::grid::Labelling;

/// A cost that may be infinite.
pub(super) fn cost(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(cost) if cost > 0.0 => Ok(cost),
        _ => Err("give a positive number, or `inf`".to_owned()),
    }
}

pub(super) fn finite_cost(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(cost) if cost > 0.0 && cost.is_finite() => Ok(cost),
        _ => Err("give a positive number".to_owned()),
    }
}

pub(super) fn cost_or_nothing(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(cost) if cost >= 0.0 && cost.is_finite() => Ok(cost),
        _ => Err("give a number, 0 or more".to_owned()),
    }
}

/// What a teacher may promise.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum Promise {
    /// No counterexample could be shorter.
    Shortest,
}

pub(super) fn rate(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(rate) if (0.0..=1.0).contains(&rate) => Ok(rate),
        _ => Err("give a number from 0 to 1".to_owned()),
    }
}

impl ValueEnum for Strategy {
    fn value_variants<'a>() -> &'a [Self] {
        &[Self::Bayes, Self::Exp4Plus, Self::Thesis, Self::Membership]
    }

    fn to_possible_value(&self) -> Option<PossibleValue> {
        Some(match self {
            Self::Bayes => PossibleValue::new("bayes")
                .help("the question of any kind that is worth most for its cost"),
            Self::Exp4Plus => PossibleValue::new("exp4+")
                .help("the posterior of bayes, and a bandit over its best question of each kind"),
            Self::Thesis => PossibleValue::new("thesis")
                .help("Algorithms 4 to 6 of the dissertation's chapter 5"),
            Self::Membership => {
                PossibleValue::new("membership").help("the same without comparisons")
            }
        })
    }
}

impl ValueEnum for Order {
    fn value_variants<'a>() -> &'a [Self] {
        &[Self::Ordered, Self::Random]
    }

    fn to_possible_value(&self) -> Option<PossibleValue> {
        Some(match self {
            Self::Ordered => PossibleValue::new("ordered")
                .help("by prefixes and extensions, as for Tomita's languages in chapter 5"),
            Self::Random => PossibleValue::new("random")
                .help("fixed and random, a tenth of the pairs incomparable"),
        })
    }
}

impl ValueEnum for Counterexamples {
    fn value_variants<'a>() -> &'a [Self] {
        &[Self::Shortest, Self::Random]
    }

    fn to_possible_value(&self) -> Option<PossibleValue> {
        Some(match self {
            Self::Shortest => PossibleValue::new("shortest").help("a shortest word"),
            Self::Random => {
                PossibleValue::new("random").help("any word of a random length, mostly up to 10")
            }
        })
    }
}

impl ValueEnum for Labelling {
    fn value_variants<'a>() -> &'a [Self] {
        &[Self::Entry, Self::EveryStep]
    }

    fn to_possible_value(&self) -> Option<PossibleValue> {
        Some(match self {
            Self::Entry => PossibleValue::new("entry").help("when it is entered"),
            Self::EveryStep => PossibleValue::new("every-step")
                .help("with every step that ends on it, also with one that stays"),
        })
    }
}
