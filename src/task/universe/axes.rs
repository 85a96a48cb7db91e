//! What is measured of a behaviour, in the units in which people measure it.

use serde::Serialize;

use crate::concept::{ConceptClass as _, Corners, MonotoneClass, Point};

/// How far from a point of a grid a number may be and still be that point. Points
/// of the finest grids are a thousand times as far apart.
const NEAR: f64 = 1e-9;

/// One thing that is measured.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Axis {
    /// What it is called.
    pub name: String,
    /// What it is measured in; may be empty.
    pub unit: String,
    /// What everybody accepts.
    pub best: f64,
    /// What is the worst that is asked about.
    pub worst: f64,
}

impl Axis {
    /// The number at a coordinate, 0 at the best and 1 at the worst.
    pub fn value(&self, coordinate: f64) -> f64 {
        let range = self.worst - self.best;
        // Twelve digits of the range: more than any grid has points, and fewer than
        // sums of binary fractions get wrong.
        let digits = 12.0 - range.abs().log10().floor();
        let scale = 10f64.powi(digits.clamp(-300.0, 300.0) as i32);
        let value = self.best + coordinate * range;
        let rounded = (value * scale).round() / scale;
        if rounded.is_finite() { rounded } else { value }
    }

    fn coordinate(&self, value: f64) -> f64 {
        (value - self.best) / (self.worst - self.best)
    }

    /// Whether more of it is worse.
    pub fn grows_worse(&self) -> bool {
        self.best < self.worst
    }

    /// A number on it for people, with its unit.
    pub fn spell(&self, value: f64) -> String {
        let number = rounded(value, (self.worst - self.best).abs());
        match self.unit.as_str() {
            "" => number,
            unit => format!("{number} {unit}"),
        }
    }
}

/// A number with as many digits as tell thousandths of a range apart, and no zeros
/// at the end.
fn rounded(value: f64, range: f64) -> String {
    let digits = (3.0 - range.log10().floor()).clamp(0.0, 9.0);
    #[expect(clippy::cast_sign_loss, reason = "it is clamped to 0 and above")]
    let text = format!("{value:.*}", digits as usize);
    if text.contains('.') {
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        text
    }
}

/// How the behaviours of some axes are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Picture {
    /// A car that passes a parked one (Fig. 5.6): the first axis is the time that it
    /// takes, the second how far it keeps away.
    Passing,
}

/// The axes of a monotone family (Example 9): a behaviour is a point, and a rule
/// accepts what is no worse than its limit on any axis.
#[derive(Clone, Debug)]
pub struct Axes {
    each: Vec<Axis>,
    points: usize,
    picture: Option<Picture>,
    class: MonotoneClass<Corners>,
}

/// Why numbers are no behaviour: which of them, and what to give.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{message}")]
pub struct OffGrid {
    axis: Option<usize>,
    message: String,
}

impl OffGrid {
    /// The place of the number that is meant, from 0; none if it is their number.
    pub fn axis(&self) -> Option<usize> {
        self.axis
    }
}

impl Axes {
    /// Axes with up to so many points each, at least 2.
    ///
    /// # Panics
    ///
    /// If there is no axis or no point.
    pub fn new(axes: Vec<Axis>, points: usize, picture: Option<Picture>) -> Self {
        Self {
            class: MonotoneClass::new(Corners::new(axes.len(), points), points),
            each: axes,
            points,
            picture,
        }
    }

    /// The axes, in order.
    pub fn axes(&self) -> &[Axis] {
        &self.each
    }

    /// The points an axis has on the finest grid.
    pub fn points(&self) -> usize {
        self.points
    }

    /// How behaviours are drawn; none where their numbers say all.
    pub fn picture(&self) -> Option<Picture> {
        self.picture
    }

    /// The class of the limits; nothing is known of them yet.
    pub fn class(&self) -> MonotoneClass<Corners> {
        self.class.clone()
    }

    /// How far apart the points of the finest grid are on an axis.
    pub fn step(&self, axis: &Axis) -> f64 {
        (axis.worst - axis.best).abs() / (self.points - 1) as f64
    }

    pub(super) fn accepts(&self, most: &Point, point: &Point) -> bool {
        self.class.contains(most, point)
    }

    /// A point in the units of the axes.
    pub fn values(&self, point: &Point) -> Vec<f64> {
        let axes = self.each.iter().zip(point.coordinates());
        axes.map(|(axis, coordinate)| axis.value(coordinate))
            .collect()
    }

    /// A point in a line, for people.
    pub fn spell(&self, point: &Point) -> String {
        let numbers = self.each.iter().zip(self.values(point));
        let numbers: Vec<String> = numbers
            .map(|(axis, value)| format!("{} {}", axis.name, axis.spell(value)))
            .collect();
        format!("({})", numbers.join(", "))
    }

    /// The point of these numbers, one an axis.
    ///
    /// # Errors
    ///
    /// If a number is missing, beyond the ends of its axis, or on no grid.
    pub fn point(&self, values: &[f64]) -> Result<Point, OffGrid> {
        let coordinates = self.coordinates(values)?;
        snap(&coordinates, self.points).ok_or_else(|| self.between(values, &coordinates))
    }

    /// The point of the finest grid that is nearest to these numbers, for what people
    /// type.
    ///
    /// # Errors
    ///
    /// If a number is missing, or beyond the ends of its axis.
    pub fn nearest(&self, values: &[f64]) -> Result<Point, OffGrid> {
        let steps = (self.points - 1) as u32;
        let tick = |at: f64| {
            #[expect(clippy::cast_sign_loss, reason = "it is from 0 to the steps")]
            let tick = (at.clamp(0.0, 1.0) * f64::from(steps)).round() as u32;
            tick
        };
        let coordinates = self.coordinates(values)?;
        Ok(Point::new(
            coordinates.into_iter().map(tick).collect(),
            steps,
        ))
    }

    /// The numbers as shares of the way from the best to the worst.
    fn coordinates(&self, values: &[f64]) -> Result<Vec<f64>, OffGrid> {
        if values.len() != self.each.len() {
            return Err(OffGrid {
                axis: None,
                message: self.expected(),
            });
        }
        let coordinates: Vec<f64> = (self.each.iter().zip(values))
            .map(|(axis, value)| axis.coordinate(*value))
            .collect();
        let inside = |at: &f64| (-NEAR..=1.0 + NEAR).contains(at);
        if let Some(place) = coordinates.iter().position(|at| !inside(at)) {
            let axis = &self.each[place];
            return Err(OffGrid {
                axis: Some(place),
                message: format!(
                    "{} is no {}: give one from {} to {}",
                    axis.spell(values[place]),
                    axis.name,
                    axis.spell(axis.best.min(axis.worst)),
                    axis.spell(axis.best.max(axis.worst))
                ),
            });
        }
        Ok(coordinates)
    }

    /// Why numbers within the ends of their axes are on no grid.
    fn between(&self, values: &[f64], coordinates: &[f64]) -> OffGrid {
        let steps = (self.points - 1) as f64;
        let off = |at: &f64| (at * steps - (at * steps).round()).abs() > NEAR * steps;
        let place = coordinates.iter().position(off).unwrap_or(0);
        let axis = &self.each[place];
        let below = (coordinates[place] * steps).floor();
        // Unrounded: what is given has to be exact.
        let near = [below, below + 1.0].map(|tick| axis.value(tick / steps));
        OffGrid {
            axis: Some(place),
            message: format!(
                "{} is between two steps of {}: give {} or {}",
                axis.spell(values[place]),
                axis.name,
                near[0],
                near[1]
            ),
        }
    }

    /// What a behaviour is, for whoever gave something else.
    pub fn expected(&self) -> String {
        let names: Vec<String> = (self.each.iter())
            .map(|axis| match axis.unit.as_str() {
                "" => axis.name.clone(),
                unit => format!("{} in {unit}", axis.name),
            })
            .collect();
        format!("give one number an axis: [{}]", names.join(", "))
    }

    /// What a rule with this limit accepts, axis by axis.
    pub fn described(&self, most: &Point) -> Vec<String> {
        let axes = self.each.iter().zip(most.coordinates());
        axes.map(|(axis, coordinate)| {
            let value = axis.spell(axis.value(coordinate));
            match (coordinate < 1.0, axis.grows_worse()) {
                (false, _) => format!("any {}", axis.name),
                (true, true) => format!("{} of at most {value}", axis.name),
                (true, false) => format!("{} of at least {value}", axis.name),
            }
        })
        .collect()
    }
}

/// The point of the coarsest grid with at most so many points an axis that has these
/// coordinates; none if no grid has them.
pub(super) fn snap(coordinates: &[f64], points: usize) -> Option<Point> {
    (1..points).find_map(|steps| {
        let scale = steps as f64;
        let ticks = coordinates.iter().map(|at| {
            let tick = (at * scale).round();
            let near = (at - tick / scale).abs() <= NEAR;
            #[expect(clippy::cast_sign_loss, reason = "it is from 0 to the steps")]
            (near && (0.0..=scale).contains(&tick)).then_some(tick as u32)
        });
        Some(Point::new(ticks.collect::<Option<_>>()?, steps as u32))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn drive() -> Axes {
        let axis = |name: &str, unit: &str, best, worst| Axis {
            name: name.to_owned(),
            unit: unit.to_owned(),
            best,
            worst,
        };
        let axes = vec![
            axis("time", "s", 10.0, 58.0),
            axis("distance", "m", 3.0, 0.2),
        ];
        Axes::new(axes, 33, None)
    }

    #[test]
    fn every_point_comes_back_from_its_numbers() {
        let axes = drive();
        for steps in 1..33 {
            for (one, other) in (0..=steps).zip((0..=steps).rev()) {
                let point = Point::new(vec![one, other], steps);
                let text = serde_json::to_string(&axes.values(&point)).unwrap();
                let read: Vec<f64> = serde_json::from_str(&text).unwrap();
                assert_eq!(axes.point(&read), Ok(point));
            }
        }
    }

    #[test]
    fn numbers_have_no_tail_of_digits() {
        let axes = drive();
        for ticks in 0..=14 {
            let point = Point::new(vec![0, ticks], 14);
            let text = axes.values(&point)[1].to_string();
            assert!(text.len() <= 3, "{text}");
        }
        assert_eq!(
            axes.values(&Point::new(vec![1, 14], 14))[1].to_string(),
            "0.2"
        );
    }

    #[test]
    fn other_numbers_are_told_what_to_be() {
        let axes = drive();
        for (values, axis, part) in [
            (vec![20.0], None, "[time in s, distance in m]"),
            (
                vec![9.0, 1.0],
                Some(0),
                "9 s is no time: give one from 10 s to 58 s",
            ),
            (vec![10.0, 3.5], Some(1), "3.5 m is no distance"),
            (vec![10.7, 3.0], Some(0), "give 10 or 11.5"),
            (vec![f64::NAN, 3.0], Some(0), "is no time"),
        ] {
            let error = axes.point(&values).unwrap_err();
            assert_eq!(error.axis(), axis);
            assert!(error.to_string().contains(part), "{error}");
        }
    }

    #[test]
    fn limits_are_told_by_their_sense() {
        let told = drive().described(&Point::new(vec![1, 2], 2));
        assert_eq!(told, ["time of at most 34 s", "any distance"]);
        let told = drive().described(&Point::new(vec![4, 1], 4));
        assert_eq!(told, ["any time", "distance of at least 2.3 m"]);
    }
}
