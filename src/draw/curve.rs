//! How an arrow runs: smooth through its points, straight out of one circle
//! and straight into the other.
//!
//! The points of a layered layout go on in one direction, so that the height is
//! a function of the place, and is interpolated as one: piecewise cubic and
//! monotone wherever the points are (Fritsch and Butland, 1984). An arrow then
//! never swings beyond the points that it was given, where others may run.

use std::ops::{Add, Mul, Sub};

/// The radius of a circle, in pixels.
pub(super) const RADIUS: f64 = 22.0;

/// How far a loop rises above its circle, in pixels.
pub(super) const LOOP_HEIGHT: f64 = 34.0;

/// The length of an arrow's head, in pixels.
pub(super) const HEAD: f64 = 9.0;

/// The free space between an arrow's point and the line of the circle.
const GAP: f64 = 1.5;

/// The steepest slope with which an arrow leaves a circle or reaches one.
const STEEPEST: f64 = 1.2;

/// A place or a direction in the picture, in pixels, y downwards.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Point {
    /// To the right.
    pub(super) x: f64,
    /// Downwards.
    pub(super) y: f64,
}

impl Point {
    /// The point at `x`, `y`.
    pub(super) fn new(x: f64, y: f64) -> Self {
        Self { x, y }
    }

    fn length(self) -> f64 {
        self.x.hypot(self.y)
    }

    /// This direction with length 1; to the right where it has none.
    fn unit(self) -> Self {
        let length = self.length();
        if length < 1e-9 {
            Self::new(1.0, 0.0)
        } else {
            self * (1.0 / length)
        }
    }

    /// The direction at this angle, clockwise from the right.
    fn at_angle(angle: f64) -> Self {
        Self::new(angle.cos(), angle.sin())
    }
}

impl Add for Point {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self::new(self.x + other.x, self.y + other.y)
    }
}

impl Sub for Point {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self::new(self.x - other.x, self.y - other.y)
    }
}

impl Mul<f64> for Point {
    type Output = Self;
    fn mul(self, factor: f64) -> Self {
        Self::new(self.x * factor, self.y * factor)
    }
}

/// A cubic Bézier curve: from the end of the one before, by two control
/// points, to its end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Piece {
    /// Pulls at the beginning.
    pub(super) first: Point,
    /// Pulls at the end.
    pub(super) second: Point,
    /// The end.
    pub(super) end: Point,
}

/// A line with a head.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Curve {
    /// Where the line starts.
    pub(super) start: Point,
    /// Its pieces; the last ends at the foot of the head.
    pub(super) pieces: Vec<Piece>,
    /// The tip of the head.
    pub(super) tip: Point,
    /// The direction of the head, of length 1.
    pub(super) heading: Point,
}

impl Curve {
    /// The arrow from the circle around `from` through `through` to the circle
    /// around `to`. It aims past the centres by `aside` pixels, downwards where
    /// that is positive, so that a way there and the way back do not meet.
    pub(super) fn between(from: Point, through: &[Point], to: Point, aside: f64) -> Self {
        let below = Point::new(0.0, aside);
        let mut stops = vec![from + below];
        stops.extend_from_slice(through);
        stops.push(to + below);
        let last = stops.len() - 1;
        let directions = directions(&stops);
        let heading = directions[last];
        let tip = to + offset(heading, -1.0, RADIUS + GAP, aside);
        stops[0] = from + offset(directions[0], 1.0, RADIUS, aside);
        stops[last] = tip - heading * (HEAD - 1.0);
        let pieces = (1..=last)
            .map(|i| {
                let way = stops[i] - stops[i - 1];
                // A third of the way along, but no longer than half of it where
                // the direction is steep.
                let pull = |direction: Point| {
                    let along = (way.x / direction.x).abs() / 3.0;
                    direction * along.min(way.length() / 2.0)
                };
                Piece {
                    first: stops[i - 1] + pull(directions[i - 1]),
                    second: stops[i] - pull(directions[i]),
                    end: stops[i],
                }
            })
            .collect();
        Self {
            start: stops[0],
            pieces,
            tip,
            heading,
        }
    }

    /// The loop on top of the circle around `centre`.
    pub(super) fn looping(centre: Point) -> Self {
        let leave = Point::at_angle((-118.0_f64).to_radians());
        let enter = Point::at_angle((-62.0_f64).to_radians());
        let reach = LOOP_HEIGHT * 1.32;
        let lean = |side: f64| Point::new(side * 0.42, -1.0).unit();
        let tip = centre + enter * (RADIUS + GAP);
        let heading = lean(1.0) * -1.0;
        let start = centre + leave * RADIUS;
        let end = tip - heading * (HEAD - 1.0);
        Self {
            start,
            pieces: vec![Piece {
                first: start + lean(-1.0) * reach,
                second: end + lean(1.0) * (reach - HEAD),
                end,
            }],
            tip,
            heading,
        }
    }

    /// The short arrow from nowhere into the start's circle.
    pub(super) fn entering(centre: Point) -> Self {
        let heading = Point::new(1.0, 0.0);
        let tip = centre - heading * (RADIUS + GAP);
        let start = tip - heading * 34.0;
        let end = tip - heading * (HEAD - 1.0);
        Self {
            start,
            pieces: vec![Piece {
                first: start,
                second: end,
                end,
            }],
            tip,
            heading,
        }
    }
}

/// Where a line in this direction, `aside` pixels below the centre of a circle,
/// meets the circle: before the centre or behind it.
fn offset(direction: Point, sign: f64, radius: f64, aside: f64) -> Point {
    let below = Point::new(-direction.y, direction.x) * direction.x.signum();
    let along = (radius * radius - aside * aside).max(0.0).sqrt();
    direction * (sign * along) + below * aside
}

/// How an arrow runs at each of its stops, as directions of length 1.
fn directions(stops: &[Point]) -> Vec<Point> {
    let last = stops.len() - 1;
    let ways: Vec<Point> = stops.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let side = (stops[last].x - stops[0].x).signum();
    // A layout of layers does not turn round; if it did, chords would do.
    if ways.iter().any(|way| way.x * side < 1.0) {
        let chord = |i: usize| stops[(i + 1).min(last)] - stops[i.saturating_sub(1)];
        return (0..=last).map(|i| chord(i).unit()).collect();
    }
    let slopes: Vec<f64> = ways.iter().map(|way| way.y / way.x).collect();
    (0..=last)
        .map(|i| {
            let slope = if i == 0 {
                outer(&ways, &slopes, 0, 1)
            } else if i == last {
                outer(&ways, &slopes, last - 1, last.saturating_sub(2))
            } else {
                inner(&ways[i - 1..=i], &slopes[i - 1..=i])
            };
            (Point::new(1.0, slope) * side).unit()
        })
        .collect()
}

/// The slope between two pieces: 0 at a summit, and otherwise a mean that the
/// flatter one governs.
fn inner(ways: &[Point], slopes: &[f64]) -> f64 {
    if slopes[0] * slopes[1] <= 0.0 {
        return 0.0;
    }
    let (before, after) = (ways[0].x.abs(), ways[1].x.abs());
    let (first, second) = (before + 2.0 * after, 2.0 * before + after);
    (first + second) / (first / slopes[0] + second / slopes[1])
}

/// The slope at the outer end of the piece `end`, beside which is `beside`: that
/// of a parabola, but never on the other side of the chord, nor much steeper than
/// it, which would make a hook, nor so steep that the arrow would come from where
/// a loop is.
fn outer(ways: &[Point], slopes: &[f64], end: usize, beside: usize) -> f64 {
    if slopes.len() == 1 {
        return slopes[0];
    }
    let (near, far) = (ways[end].x.abs(), ways[beside].x.abs());
    let slope = ((2.0 * near + far) * slopes[end] - near * slopes[beside]) / (near + far);
    if slope * slopes[end] <= 0.0 {
        return 0.0;
    }
    let most = STEEPEST.min(1.5 * slopes[end].abs());
    slope.clamp(-most, most)
}
