//! How a session's learner is set up: read from a request, kept in the log.

use serde::{Deserialize, Serialize};

use crate::learner::{Config, EQUIVALENCE_COST, Strategy};
use crate::task::{Fields, Malformed, Task, read_cost, read_strategy};

/// The work that choosing one question may do, where nothing else is said: a
/// few seconds at most.
pub const DEFAULT_BUDGET: u64 = 500_000;

/// The learner's configuration in a form that survives JSON, in which there is
/// no infinite number.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Setup {
    /// How questions are chosen.
    pub strategy: Strategy,
    /// The cost of a membership query.
    pub membership_cost: f64,
    /// The cost of a comparison; `None` (`"inf"` outside) where none is asked.
    #[serde(with = "cost")]
    pub comparison_cost: f64,
    /// Decides every random choice.
    pub seed: u64,
    /// The work that choosing one question may do.
    pub budget: u64,
}

/// The keys of [`Setup::with`].
pub const KEYS: [&str; 4] = ["membership_cost", "comparison_cost", "strategy", "seed"];

impl Default for Setup {
    fn default() -> Self {
        Self {
            strategy: Strategy::Bayes,
            membership_cost: 4.0,
            comparison_cost: 1.0,
            seed: 0,
            budget: DEFAULT_BUDGET,
        }
    }
}

impl Setup {
    /// The usual one, and what the task tells instead.
    pub fn of(task: &Task) -> Self {
        let usual = Self::default();
        Self {
            strategy: task.strategy.unwrap_or(usual.strategy),
            membership_cost: task.costs.membership.unwrap_or(usual.membership_cost),
            comparison_cost: task.costs.comparison.unwrap_or(usual.comparison_cost),
            ..usual
        }
    }

    /// This one, and what the optional keys of a request that creates a session
    /// tell instead.
    ///
    /// # Errors
    ///
    /// Names the key whose value cannot be taken, and what can.
    pub fn with(&self, fields: &Fields<'_>) -> Result<Self, Malformed> {
        let usual = self;
        let membership_cost =
            read_cost(fields, "membership_cost", false)?.unwrap_or(usual.membership_cost);
        let comparison_cost =
            read_cost(fields, "comparison_cost", true)?.unwrap_or(usual.comparison_cost);
        let strategy = read_strategy(fields)?.unwrap_or(usual.strategy);
        let seed = match fields.get("seed") {
            None => usual.seed,
            Some(value) => value.as_u64().ok_or_else(|| {
                Malformed::new("seed", "give a whole number from 0 to 18446744073709551615")
            })?,
        };
        Ok(Self {
            strategy,
            membership_cost,
            comparison_cost,
            seed,
            budget: usual.budget,
        })
    }

    /// What the learner is told.
    pub fn config(&self) -> Config {
        Config {
            strategy: self.strategy,
            membership_cost: self.membership_cost,
            comparison_cost: self.comparison_cost,
            equivalence_cost: EQUIVALENCE_COST * self.membership_cost,
            seed: self.seed,
            budget: self.budget,
            ..Config::default()
        }
    }
}

/// A cost as a number, or `"inf"`.
mod cost {
    use serde::{Deserialize, Deserializer, Serialize, Serializer, de::Error};

    #[derive(Serialize, Deserialize)]
    #[serde(untagged)]
    enum Form {
        Finite(f64),
        Named(String),
    }

    #[expect(
        clippy::trivially_copy_pass_by_ref,
        reason = "serde hands over references"
    )]
    pub(super) fn serialize<S: Serializer>(cost: &f64, serializer: S) -> Result<S::Ok, S::Error> {
        if cost.is_finite() {
            Form::Finite(*cost).serialize(serializer)
        } else {
            Form::Named("inf".to_owned()).serialize(serializer)
        }
    }

    pub(super) fn deserialize<'de, D: Deserializer<'de>>(from: D) -> Result<f64, D::Error> {
        match Form::deserialize(from)? {
            Form::Finite(cost) => Ok(cost),
            Form::Named(name) if name == "inf" => Ok(f64::INFINITY),
            Form::Named(name) => Err(D::Error::custom(format!("`{name}` is no cost"))),
        }
    }
}

#[cfg(test)]
mod tests {
    use serde_json::{Value, json};

    use super::*;

    fn read(value: &Value) -> Result<Setup, Malformed> {
        Setup::default().with(&Fields::of(value, "").unwrap())
    }

    #[test]
    fn an_infinite_cost_survives_the_log() {
        let setup =
            read(&json!({"comparison_cost": "inf", "membership_cost": 2, "seed": u64::MAX}))
                .unwrap();
        let text = serde_json::to_string(&setup).unwrap();
        assert!(text.contains("\"inf\""), "{text}");
        assert_eq!(setup, serde_json::from_str(&text).unwrap());
    }

    #[test]
    fn every_strategy_has_a_name() {
        for (name, strategy) in [
            ("bayes", Strategy::Bayes),
            ("exp4+", Strategy::Exp4Plus),
            ("thesis", Strategy::Thesis),
            ("membership", Strategy::Membership),
        ] {
            let setup = read(&json!({"strategy": name})).unwrap();
            assert_eq!(setup.strategy, strategy);
            assert_eq!(serde_json::to_value(&setup).unwrap()["strategy"], name);
        }
    }

    #[test]
    fn bad_values_are_named() {
        for (input, path) in [
            (json!({"membership_cost": 0}), "membership_cost"),
            (json!({"membership_cost": "inf"}), "membership_cost"),
            (json!({"comparison_cost": -1}), "comparison_cost"),
            (json!({"comparison_cost": "many"}), "comparison_cost"),
            (json!({"strategy": "psychic"}), "strategy"),
            (json!({"seed": -3}), "seed"),
        ] {
            assert_eq!(read(&input).unwrap_err().path, path);
        }
    }
}
