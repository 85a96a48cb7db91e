//! How an arrow runs: smooth through its points, straight out of one circle
//! and straight into the other.

use std::ops::{Add, Mul, Sub};

/// The radius of a circle, in pixels.
pub(super) const RADIUS: f64 = 22.0;

/// How far a loop rises above its circle, in pixels.
pub(super) const LOOP_HEIGHT: f64 = 34.0;

/// The length of an arrow's head, in pixels.
pub(super) const HEAD: f64 = 9.0;

/// The free space between an arrow's point and the line of the circle.
const GAP: f64 = 1.5;

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

    fn angle(self) -> f64 {
        self.y.atan2(self.x)
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
    /// around `to`.
    pub(super) fn between(from: Point, through: &[Point], to: Point) -> Self {
        let mut stops = vec![from];
        stops.extend_from_slice(through);
        stops.push(to);
        let last = stops.len() - 1;
        // Inner directions are parallel to the line between the neighbours.
        let mut directions: Vec<Point> = (0..=last)
            .map(|i| (stops[(i + 1).min(last)] - stops[i.saturating_sub(1)]).unit())
            .collect();
        if last > 1 {
            directions[0] = swing(stops[1] - from, directions[1]);
            directions[last] = swing(to - stops[last - 1], directions[last - 1]);
        }
        let heading = directions[last];
        let tip = to - heading * (RADIUS + GAP);
        stops[0] = from + directions[0] * RADIUS;
        stops[last] = tip - heading * (HEAD - 1.0);
        let pieces = (1..=last)
            .map(|i| {
                let third = (stops[i] - stops[i - 1]).length() / 3.0;
                Piece {
                    first: stops[i - 1] + directions[i - 1] * third,
                    second: stops[i] - directions[i] * third,
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

/// The direction at the outer end of `chord` that makes, with `inner` at its
/// other end, a piece of a circle: as far from the chord on the other side.
/// Bounded, so that an arrow never leaves its circle backwards.
fn swing(chord: Point, inner: Point) -> Point {
    use std::f64::consts::{FRAC_PI_4, PI, TAU};
    let mut turn = chord.angle() - inner.angle();
    if turn > PI {
        turn -= TAU;
    } else if turn < -PI {
        turn += TAU;
    }
    Point::at_angle(chord.angle() + turn.clamp(-FRAC_PI_4, FRAC_PI_4))
}
