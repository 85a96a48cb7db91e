//! Points of the unit cube with rational coordinates: the parameters of concepts,
//! and the corners of bi-partitions.

use std::cmp::Ordering;
use std::fmt;

use serde::{Serialize, Serializer};

/// A point of `[0, 1]^d` whose coordinates are multiples of `1/steps`, in lowest
/// terms, so that equal points are equal.
///
/// The order is by simplicity: fewer coordinates that are not 0, then coarser,
/// then by coordinates.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Point {
    ticks: Vec<u32>,
    /// 0 exactly for the origin, which is on the grid of a single point.
    steps: u32,
}

impl Point {
    /// The point with coordinates `ticks[j] / steps`; the origin for 0 steps.
    ///
    /// # Panics
    ///
    /// If a coordinate is above 1.
    pub fn new(mut ticks: Vec<u32>, steps: u32) -> Self {
        assert!(
            ticks.iter().all(|&tick| tick <= steps),
            "a coordinate of {ticks:?} over {steps} is above 1"
        );
        let divisor = ticks
            .iter()
            .fold(steps, |divisor, &tick| gcd(divisor, tick));
        if ticks.iter().all(|&tick| tick == 0) {
            return Self { ticks, steps: 0 };
        }
        for tick in &mut ticks {
            *tick /= divisor;
        }
        Self {
            ticks,
            steps: steps / divisor,
        }
    }

    /// The number of dimensions.
    pub fn dimensions(&self) -> usize {
        self.ticks.len()
    }

    /// The smallest `i` for which the point is on the uniform grid with `i`
    /// points per axis, `{0, 1/(i−1), …, 1}`; the grid of one point is the origin.
    pub fn size(&self) -> usize {
        self.steps as usize + 1
    }

    /// The coordinates, each in `[0, 1]`.
    pub fn coordinates(&self) -> impl ExactSizeIterator<Item = f64> + '_ {
        self.ticks.iter().map(|&tick| self.coordinate(tick))
    }

    /// The coordinates in units of `1/steps`, and the steps, at least 1.
    pub(super) fn place(&self) -> Place<'_> {
        Place {
            ticks: &self.ticks,
            steps: self.steps.max(1),
        }
    }

    fn coordinate(&self, tick: u32) -> f64 {
        f64::from(tick) / f64::from(self.steps.max(1))
    }

    fn used(&self) -> usize {
        self.ticks.iter().filter(|&&tick| tick > 0).count()
    }
}

impl Ord for Point {
    fn cmp(&self, other: &Self) -> Ordering {
        let key = |point: &Self| (point.used(), point.steps);
        key(self)
            .cmp(&key(other))
            .then_with(|| self.ticks.cmp(&other.ticks))
    }
}

impl PartialOrd for Point {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

/// As fractions: `(1/2, 0, 2/3)`.
impl fmt::Display for Point {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (place, &tick) in self.ticks.iter().enumerate() {
            f.write_str(if place == 0 { "(" } else { ", " })?;
            let divisor = gcd(tick, self.steps).max(1);
            let (over, under) = (tick / divisor, self.steps.max(1) / divisor);
            match (over, under) {
                (0, _) | (_, 1) => write!(f, "{over}")?,
                _ => write!(f, "{over}/{under}")?,
            }
        }
        f.write_str(")")
    }
}

/// As an array of numbers.
impl Serialize for Point {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_seq(self.coordinates())
    }
}

/// A point on a grid that need not be the coarsest it is on.
#[derive(Clone, Copy, Debug)]
pub struct Place<'a> {
    /// The coordinates, in units of `1/steps`.
    pub ticks: &'a [u32],
    /// At least 1.
    pub steps: u32,
}

/// The greatest common divisor; of 0 and a number, the number.
pub(super) fn gcd(one: u32, other: u32) -> u32 {
    if other == 0 {
        one
    } else {
        gcd(other, one % other)
    }
}
