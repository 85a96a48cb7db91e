//! A drive past a parked car (Fig. 5.6): the way, how far it keeps away, and how long
//! it takes.

use std::f64::consts::PI;
use std::fmt::Write as _;

use crate::concept::Point;
use crate::task::Axes;

/// Where the drive begins and ends. Lengths are in units of the drawing, which is 320
/// wide and 176 high.
const ENDS: (f64, f64) = (24.0, 296.0);
/// The middle of the lane in which the drive begins and ends, and the other car is
/// parked.
const LANE: f64 = 128.0;
/// Half the width of a car, and half its length.
const CAR: (f64, f64) = (11.0, 22.0);
/// The gaps that the least and the greatest distance are drawn as.
const GAPS: (f64, f64) = (7.0, 68.0);
/// The way is drawn in so many pieces.
const PIECES: u32 = 68;
/// The most marks that tell the time.
const MARKS: f64 = 40.0;

/// A drive past a parked car.
pub(crate) struct Drive {
    /// The way, as path data.
    pub(crate) way: String,
    /// Where the car is as time goes by.
    pub(crate) marks: Vec<(String, String)>,
    /// How much time passes between two marks.
    pub(crate) between: String,
    /// Where it is when it passes.
    pub(crate) x: f64,
    pub(crate) y: f64,
    /// Where the parked car is.
    pub(crate) parked: f64,
    /// The ends of the gap between them.
    pub(crate) gap: (f64, f64),
    /// How long it takes, as a number.
    pub(crate) lasts: f64,
    /// Time and distance with their units.
    pub(crate) time: String,
    pub(crate) distance: String,
    /// What is seen, in words.
    pub(crate) label: String,
}

impl Drive {
    /// The drive at a point of a time and a distance.
    pub(crate) fn of(axes: &Axes, point: &Point) -> Self {
        let [time, distance] = axes.axes() else {
            return Self::still();
        };
        let values = axes.values(point);
        let nearness = point.coordinates().nth(1).unwrap_or_default();
        let away = if distance.grows_worse() {
            nearness
        } else {
            1.0 - nearness
        };
        let gap = GAPS.0 + away * (GAPS.1 - GAPS.0);
        // From the side of the parked car to the side of the one that passes.
        let height = gap + 2.0 * CAR.0;
        let at = |share: f64| {
            let x = ENDS.0 + share * (ENDS.1 - ENDS.0);
            (
                x,
                LANE - height * f64::midpoint(1.0, (2.0 * PI * (share - 0.5)).cos()),
            )
        };
        let places: Vec<(f64, f64)> = (0..=PIECES)
            .map(|piece| at(f64::from(piece) / f64::from(PIECES)))
            .collect();
        let mut way = String::new();
        for (place, (x, y)) in places.iter().enumerate() {
            let letter = if place == 0 { 'M' } else { 'L' };
            // Writing to a string never fails.
            let _ = write!(way, "{letter}{x:.1} {y:.1}");
        }
        let (step, count) = marks(values[0], time.best.max(time.worst));
        let middle = at(0.5);
        let lasts = values[0].abs();
        let (time, distance) = (time.spell(values[0]), distance.spell(values[1]));
        Self {
            way,
            marks: along(&places, count),
            between: axes.axes()[0].spell(step),
            x: middle.0,
            y: middle.1,
            parked: LANE,
            gap: (LANE - CAR.0, LANE - CAR.0 - gap),
            label: format!(
                "A drive that takes {time} and keeps {distance} away from the parked car."
            ),
            lasts,
            time,
            distance,
        }
    }

    /// Nothing to see.
    fn still() -> Self {
        Self {
            way: String::new(),
            marks: Vec::new(),
            between: String::new(),
            x: ENDS.0,
            y: LANE,
            parked: LANE,
            gap: (LANE, LANE),
            lasts: 0.0,
            time: String::new(),
            distance: String::new(),
            label: String::new(),
        }
    }
}

/// A round amount of time, of which the longest drive has not too many, and how many
/// of them this drive has.
fn marks(time: f64, longest: f64) -> (f64, f64) {
    let least = longest.abs().max(1e-9) / MARKS;
    let power = 10f64.powf(least.log10().floor());
    let rounds = [1.0, 2.0, 5.0, 10.0].map(|round| round * power);
    let step = rounds.into_iter().find(|round| *round >= least);
    let step = step.unwrap_or(10.0 * power);
    (step, (time.abs() / step).max(1.0))
}

/// Places on a way that divide its length into `count` equal parts; the last part may
/// be shorter.
fn along(way: &[(f64, f64)], count: f64) -> Vec<(String, String)> {
    let lengths: Vec<f64> = (way.windows(2))
        .map(|ends| (ends[1].0 - ends[0].0).hypot(ends[1].1 - ends[0].1))
        .collect();
    let part = lengths.iter().sum::<f64>() / count;
    let mut marks = Vec::new();
    let mut next = part;
    let mut gone = 0.0;
    for (ends, length) in way.windows(2).zip(&lengths) {
        while next <= gone + length {
            let share = (next - gone) / length;
            let x = ends[0].0 + share * (ends[1].0 - ends[0].0);
            let y = ends[0].1 + share * (ends[1].1 - ends[0].1);
            marks.push((format!("{x:.1}"), format!("{y:.1}")));
            next += part;
        }
        gone += length;
    }
    marks
}
