//! Targets of monotone families: parameters drawn at random, the same for the same
//! number everywhere.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::{ClassGoal, ScriptedTeacher, TeacherSettings};
use crate::concept::{Corners, MOST_POINTS, MonotoneClass, Point};

/// A parameter of a uniform grid, to be taught.
#[derive(Clone, Debug)]
pub struct MonotoneTarget {
    name: String,
    family: Corners,
    points: usize,
    parameter: Point,
}

/// Why a name is no such target.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "target `{0}`: give monotone:D:TICKS with D from 1 to 4 dimensions and TICKS from 2 points per axis, up to 1000, 200, 40 and 16 points for 1, 2, 3 and 4 dimensions, and perhaps :N for the target drawn as number N"
)]
pub struct MonotoneError(String);

/// What names of these targets begin with.
const PREFIX: &str = "monotone:";

impl MonotoneTarget {
    /// Parameter `number` of those drawn evenly from the uniform grid with so many
    /// points per axis.
    ///
    /// # Panics
    ///
    /// If there is no dimension or no point.
    pub fn draw(dimensions: usize, points: usize, number: u64) -> Self {
        let mut random = ChaCha8Rng::seed_from_u64(number);
        let steps = points as u32 - 1;
        let ticks = (0..dimensions).map(|_| random.random_range(0..=steps));
        let parameter = Point::new(ticks.collect(), steps);
        Self {
            name: format!("{PREFIX}{dimensions}:{points}:{number}"),
            family: Corners::new(dimensions, points),
            points,
            parameter,
        }
    }

    /// The target that `monotone:D:TICKS` or `monotone:D:TICKS:N` names, drawn as
    /// number `N` or else as `number`; none if the name is of another kind.
    ///
    /// # Errors
    ///
    /// If it has not two or three numbers after the colon, each in its range.
    pub fn named(name: &str, number: u64) -> Result<Option<Self>, MonotoneError> {
        let Some(parameters) = name.strip_prefix(PREFIX) else {
            return Ok(None);
        };
        let read = || {
            let mut parts = parameters.split(':');
            let dimensions: usize = parts.next()?.parse().ok()?;
            let points: usize = parts.next()?.parse().ok()?;
            let number = parts
                .next()
                .map_or(Some(number), |part| part.parse().ok())?;
            let most = MOST_POINTS.get(dimensions.checked_sub(1)?)?;
            let fits = (2..=*most).contains(&points) && parts.next().is_none();
            fits.then(|| Self::draw(dimensions, points, number))
        };
        let target = read().ok_or_else(|| MonotoneError(name.to_owned()))?;
        Ok(Some(target))
    }

    /// What it is called, with its number.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The number of dimensions.
    pub fn dimensions(&self) -> usize {
        self.parameter.dimensions()
    }

    /// The points per axis of the grid it was drawn from.
    pub fn points(&self) -> usize {
        self.points
    }

    /// The parameter that was drawn.
    pub fn parameter(&self) -> &Point {
        &self.parameter
    }

    /// What a learner learns it from: the grids up to its own, and nothing known.
    pub fn class(&self) -> MonotoneClass<Corners> {
        MonotoneClass::new(self.family.clone(), self.points)
    }

    /// A teacher of it.
    pub fn teacher(
        &self,
        settings: TeacherSettings,
    ) -> ScriptedTeacher<ClassGoal<MonotoneClass<Corners>>> {
        let TeacherSettings { order, seed, .. } = settings;
        let goal = ClassGoal::new(self.class(), self.parameter.clone(), order, seed);
        ScriptedTeacher::of(goal, settings)
    }
}
