//! What questions cost and how they are chosen, as tasks and requests tell it.

use serde::{Serialize, Serializer};
use serde_json::Value;

use super::reader::{Fields, Malformed};
use crate::learner::Strategy;

/// What questions cost, where it is told.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Costs {
    /// Of a membership query; positive.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub membership: Option<f64>,
    /// Of a comparison; positive, infinite where none is to be asked.
    #[serde(skip_serializing_if = "Option::is_none", serialize_with = "write")]
    pub comparison: Option<f64>,
}

impl Costs {
    /// Whether nothing is told.
    pub fn are_untold(&self) -> bool {
        self.membership.is_none() && self.comparison.is_none()
    }

    /// What stands under `costs`.
    pub(super) fn read(fields: &Fields<'_>) -> Result<Self, Malformed> {
        let Some(value) = fields.get("costs") else {
            return Ok(Self::default());
        };
        let fields = Fields::of(value, "costs")?;
        fields.only(&["membership", "comparison"])?;
        Ok(Self {
            membership: read_cost(&fields, "membership", false)?,
            comparison: read_cost(&fields, "comparison", true)?,
        })
    }
}

/// The cost under `key`; `"inf"` only where it may be infinite.
///
/// # Errors
///
/// If it is something else.
pub fn read_cost(
    fields: &Fields<'_>,
    key: &str,
    may_be_infinite: bool,
) -> Result<Option<f64>, Malformed> {
    let Some(value) = fields.get(key) else {
        return Ok(None);
    };
    let number = value.as_f64().filter(|n| n.is_finite() && *n > 0.0);
    let (cost, hint) = if may_be_infinite {
        let infinite = (value.as_str() == Some("inf")).then_some(f64::INFINITY);
        (
            number.or(infinite),
            "give a number greater than 0, as in `1`, or `\"inf\"` for no comparisons",
        )
    } else {
        (number, "give a number greater than 0, as in `4`")
    };
    match cost {
        Some(cost) => Ok(Some(cost)),
        None => Err(Malformed::new(fields.path_of(key), hint)),
    }
}

/// The strategy under `strategy`.
///
/// # Errors
///
/// If no strategy is called so.
pub fn read_strategy(fields: &Fields<'_>) -> Result<Option<Strategy>, Malformed> {
    let Some(value) = fields.get("strategy") else {
        return Ok(None);
    };
    let strategy = serde_json::from_value(value.clone()).map_err(|_| {
        Malformed::new(
            fields.path_of("strategy"),
            "this strategy is unknown: give `\"bayes\"`, `\"exp4+\"`, `\"thesis\"` or \
             `\"membership\"`",
        )
    })?;
    Ok(Some(strategy))
}

/// A cost as a number, or `"inf"`.
#[expect(clippy::ref_option, reason = "serde hands over references")]
fn write<S: Serializer>(cost: &Option<f64>, serializer: S) -> Result<S::Ok, S::Error> {
    match cost {
        Some(cost) if cost.is_finite() => serializer.serialize_f64(*cost),
        Some(_) => Value::from("inf").serialize(serializer),
        None => serializer.serialize_none(),
    }
}
