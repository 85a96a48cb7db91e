//! Concept classes beside automata, as tasks tell them.

use serde::Serialize;
use serde_json::Value;

use super::reader::{Faults, Fields, Malformed};
use super::situation::Files;
use super::universe::{Axes, Axis, BehaviourText, Picture, Rewards, Universe};
use crate::concept::{FiniteTable, MOST_POINTS};

/// The points per axis of limits where a task does not tell.
const POINTS: usize = 33;
/// The points per axis of rewards where a task does not tell.
const FINEST: usize = 9;
/// The most behaviours with features.
const MOST_BEHAVIOURS: usize = 2000;
/// The longest table, in bytes.
const LONGEST_TABLE: u64 = 1 << 20;

/// What is learned in place of an automaton, as it is written.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(tag = "kind", rename_all = "lowercase")]
pub enum ClassText {
    /// Limits on what is measured: a monotone predicate family.
    Monotone {
        /// What is measured: one to four things.
        axes: Vec<Axis>,
        /// The points an axis has on the finest grid.
        ticks: usize,
        /// How behaviours are drawn.
        #[serde(skip_serializing_if = "Option::is_none")]
        picture: Option<Picture>,
    },
    /// One of the concepts of a table.
    Finite {
        /// The table, as comma-separated values.
        table: String,
    },
    /// A thresholded linear reward.
    Linear {
        /// What the features are called.
        features: Vec<String>,
        /// The points an axis of parameters has on the finest grid.
        finest: usize,
        /// The behaviours.
        behaviours: Vec<BehaviourText>,
    },
}

impl ClassText {
    /// The universe that is written.
    ///
    /// # Errors
    ///
    /// If it was put together by hand.
    pub(super) fn universe(&self) -> Result<Universe, Malformed> {
        let fault = |path: &str, error: &dyn std::fmt::Display| {
            Malformed::new(format!("class.{path}"), error.to_string())
        };
        match self {
            Self::Monotone {
                axes,
                ticks,
                picture,
            } => Ok(Universe::Monotone(Axes::new(
                axes.clone(),
                *ticks,
                *picture,
            ))),
            Self::Finite { table } => {
                let table = FiniteTable::read(table).map_err(|error| fault("table", &error))?;
                Ok(Universe::Finite(table))
            }
            Self::Linear {
                features,
                finest,
                behaviours,
            } => Rewards::new(features.clone(), behaviours.clone(), *finest)
                .map(Universe::Linear)
                .map_err(|error| fault("behaviours", &error)),
        }
    }
}

/// What stands under `class`; none, and at least one fault is kept, if it is none.
pub(super) fn read(
    value: &Value,
    files: Files<'_>,
    faults: &mut Faults,
) -> Option<(ClassText, Universe)> {
    let fields = faults.keep(Fields::of(value, "class"))?;
    let kind = faults.keep(fields.text("kind", 60))?.unwrap_or_default();
    let text = match kind.as_str() {
        "monotone" => read_axes(&fields, faults)?,
        "finite" => {
            faults.0.extend(fields.unknown(&["kind", "table"]));
            let table = faults.keep(read_table(&fields, files))?;
            ClassText::Finite { table }
        }
        "linear" => read_rewards(&fields, faults)?,
        _ => {
            faults.0.push(Malformed::new(
                fields.path_of("kind"),
                format!("`{kind}` is no class of rules: give `monotone`, `finite` or `linear`, or leave `class` out to learn an automaton"),
            ));
            return None;
        }
    };
    let universe = faults.keep(text.universe())?;
    Some((text, universe))
}

fn read_axes(fields: &Fields<'_>, faults: &mut Faults) -> Option<ClassText> {
    faults
        .0
        .extend(fields.unknown(&["kind", "axes", "ticks", "picture"]));
    let list = faults.keep(fields.required_list(
        "axes",
        "name what is measured, as in `[{\"name\": \"time\", \"unit\": \"s\", \"best\": 10, \"worst\": 60}]`",
    ))?;
    let Some(most) = list
        .len()
        .checked_sub(1)
        .and_then(|last| MOST_POINTS.get(last))
    else {
        faults.0.push(Malformed::new(
            "class.axes",
            format!(
                "there are {} axes: give 1 to {}",
                list.len(),
                MOST_POINTS.len()
            ),
        ));
        return None;
    };
    let mut axes: Vec<Axis> = Vec::new();
    for (place, value) in list.iter().enumerate() {
        let path = format!("class.axes[{place}]");
        let axis = faults.keep(read_axis(value, &path))?;
        if axes.iter().any(|other| other.name == axis.name) {
            let message = format!(
                "`{}` is the name of another axis too: give each its own",
                axis.name
            );
            faults
                .0
                .push(Malformed::new(format!("{path}.name"), message));
        }
        axes.push(axis);
    }
    let ticks = faults.keep(fields.whole("ticks", 2, *most))?;
    let picture = match faults.keep(fields.text("picture", 60))?.as_deref() {
        None => None,
        Some("passing") if axes.len() == 2 => Some(Picture::Passing),
        Some("passing") => {
            faults.0.push(Malformed::new(
                "class.picture",
                "`passing` draws a time and a distance: give these two axes, in this order",
            ));
            return None;
        }
        Some(other) => {
            faults.0.push(Malformed::new(
                "class.picture",
                format!("there is no picture `{other}`: give `passing`, or leave it out"),
            ));
            return None;
        }
    };
    Some(ClassText::Monotone {
        axes,
        ticks: ticks.unwrap_or(POINTS.min(*most)),
        picture,
    })
}

fn read_axis(value: &Value, path: &str) -> Result<Axis, Malformed> {
    let fields = Fields::of(value, path)?;
    fields.only(&["name", "unit", "best", "worst"])?;
    let name = fields.text("name", 60)?;
    let name = name.ok_or_else(|| Malformed::new(path, "this axis has no `name`: give it one"))?;
    let unit = fields.text("unit", 20)?.unwrap_or_default();
    let number = |key: &str| {
        let number = fields.get(key).and_then(Value::as_f64);
        let number = number.filter(|number| number.abs() <= 1e9);
        number.ok_or_else(|| {
            Malformed::new(
                fields.path_of(key),
                format!("give the {key} {name} that is asked about, as a number"),
            )
        })
    };
    let (best, worst) = (number("best")?, number("worst")?);
    if (best - worst).abs() < 1e-6 {
        return Err(Malformed::new(
            fields.path_of("worst"),
            "the worst is the best: let there be something between them",
        ));
    }
    Ok(Axis {
        name,
        unit,
        best,
        worst,
    })
}

/// The table itself, or the file that it is in.
fn read_table(fields: &Fields<'_>, files: Files<'_>) -> Result<String, Malformed> {
    let path = fields.path_of("table");
    let text = fields.get("table").and_then(Value::as_str);
    let Some(text) = text else {
        return Err(Malformed::new(
            path,
            "give the table as text, a line a behaviour, or name the file that it is in",
        ));
    };
    if text.contains('\n') {
        return Ok(text.to_owned());
    }
    let file = files.find(text, &path)?;
    let fault = |error: &dyn std::fmt::Display| {
        Malformed::new(path.as_str(), format!("{}: {error}", file.display()))
    };
    let size = std::fs::metadata(&file)
        .map_err(|error| fault(&error))?
        .len();
    if size > LONGEST_TABLE {
        return Err(fault(&format!(
            "it has {size} bytes: give at most {LONGEST_TABLE}"
        )));
    }
    std::fs::read_to_string(&file).map_err(|error| fault(&error))
}

fn read_rewards(fields: &Fields<'_>, faults: &mut Faults) -> Option<ClassText> {
    faults
        .0
        .extend(fields.unknown(&["kind", "features", "finest", "behaviours"]));
    let list = faults.keep(fields.required_list(
        "features",
        "name the features, as in `[\"speed\", \"nearness\"]`",
    ))?;
    let Some(most) = MOST_POINTS.get(list.len()).filter(|_| !list.is_empty()) else {
        let message = format!(
            "there are {} features: give 1 to {}",
            list.len(),
            MOST_POINTS.len() - 1
        );
        faults.0.push(Malformed::new("class.features", message));
        return None;
    };
    let features: Option<Vec<String>> =
        (list.iter().map(|name| name.as_str().map(str::to_owned))).collect();
    let Some(features) = features else {
        faults.0.push(Malformed::new(
            "class.features",
            "give the names of the features as strings",
        ));
        return None;
    };
    let finest = faults.keep(fields.whole("finest", 2, *most))?;
    let list = faults.keep(fields.required_list(
        "behaviours",
        "give the behaviours, as in `[{\"name\": \"creeps\", \"features\": [[0.2, 0.0], [0.2, 0.1]]}]`",
    ))?;
    if list.len() > MOST_BEHAVIOURS {
        let message = format!(
            "there are {} behaviours: give at most {MOST_BEHAVIOURS}",
            list.len()
        );
        faults.0.push(Malformed::new("class.behaviours", message));
        return None;
    }
    let mut behaviours: Vec<BehaviourText> = Vec::new();
    for (place, value) in list.iter().enumerate() {
        let path = format!("class.behaviours[{place}]");
        let behaviour = faults.keep(read_behaviour(value, &path))?;
        if behaviours.iter().any(|other| other.name == behaviour.name) {
            let message = format!(
                "`{}` is the name of another behaviour too: give each its own",
                behaviour.name
            );
            faults
                .0
                .push(Malformed::new(format!("{path}.name"), message));
        }
        behaviours.push(behaviour);
    }
    Some(ClassText::Linear {
        features,
        finest: finest.unwrap_or(FINEST.min(*most)),
        behaviours,
    })
}

fn read_behaviour(value: &Value, path: &str) -> Result<BehaviourText, Malformed> {
    let fields = Fields::of(value, path)?;
    fields.only(&["name", "features"])?;
    let name = fields.text("name", 120)?;
    let name =
        name.ok_or_else(|| Malformed::new(path, "this behaviour has no `name`: give it one"))?;
    let features = fields.get("features").cloned().unwrap_or_default();
    let features = serde_json::from_value(features).map_err(|_| {
        Malformed::new(
            fields.path_of("features"),
            "give a list a step, of one number a feature, as in `[[0.2, 0.0], [0.2, 0.1]]`",
        )
    })?;
    Ok(BehaviourText { name, features })
}
