//! Where arrows touch a circle: near where they would like to, clear of the
//! loop on top, and far enough apart that every head can be told from the next.

use super::curve::{Point, swing};
use super::layout::Plan;
use super::sketch::Sketch;

/// The angle between two arrows at a circle, in degrees.
const APART: f64 = 25.0;

/// The angles that a loop leaves free, in degrees clockwise from the right.
const BESIDE_LOOP: (f64, f64) = (-36.0, 216.0);

/// How much more a place weighs that cannot be moved.
const FIXED: f64 = 1e6;

/// The angles, in degrees clockwise from the right, at which an arrow touches
/// its two circles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Ports {
    /// At the circle that it leaves.
    pub(super) leave: f64,
    /// At the circle in which it ends.
    pub(super) enter: f64,
}

/// A wish to touch a circle at an angle.
struct Wish {
    angle: f64,
    weight: f64,
    /// The arrow, and whether this is its end; nothing for the start's arrow.
    whose: Option<(usize, bool)>,
}

/// The ports of a sketch's arrows, in their order.
pub(super) fn ports(sketch: &Sketch, plan: &Plan) -> Vec<Ports> {
    let mut ports: Vec<Ports> = (sketch.arrows.iter().zip(&plan.routes))
        .map(|(arrow, route)| {
            let (from, to) = (plan.centres[arrow.from], plan.centres[arrow.to]);
            wanted(from, &route.through, to)
        })
        .collect();
    for (index, state) in sketch.states.iter().enumerate() {
        let mut wishes = Vec::new();
        for (arrow, port) in sketch.arrows.iter().zip(&ports).enumerate() {
            let (arrow, (line, port)) = (arrow, port);
            let mut wish = |angle, end| {
                wishes.push(Wish {
                    angle,
                    weight: 1.0,
                    whose: Some((arrow, end)),
                });
            };
            if line.from == index {
                wish(port.leave, false);
            } else if line.to == index {
                wish(port.enter, true);
            }
        }
        if index == 0 {
            wishes.push(Wish {
                angle: 180.0,
                weight: FIXED,
                whose: None,
            });
        }
        spread(&mut wishes, state.looping.is_some());
        for wish in wishes {
            match wish.whose {
                Some((arrow, false)) => ports[arrow].leave = wish.angle,
                Some((arrow, true)) => ports[arrow].enter = wish.angle,
                None => {}
            }
        }
    }
    ports
}

/// Where an arrow through these points would touch if it were alone: so that
/// its first and its last piece are parts of circles.
fn wanted(from: Point, through: &[Point], to: Point) -> Ports {
    let (Some(&first), Some(&last)) = (through.first(), through.last()) else {
        let angle = (to - from).degrees();
        return Ports {
            leave: angle,
            enter: angle + 180.0,
        };
    };
    let second = through.get(1).copied().unwrap_or(to);
    let before = through.iter().rev().nth(1).copied().unwrap_or(from);
    let at_first = (first - from).direction() + (second - first).direction();
    let at_last = (last - before).direction() + (to - last).direction();
    Ports {
        leave: swing(first - from, at_first).degrees(),
        enter: swing(to - last, at_last).degrees() + 180.0,
    }
}

/// Moves the wishes at one circle apart, as little as possible in the sum of
/// squares (isotonic regression by pooling adjacent violators).
fn spread(wishes: &mut [Wish], looping: bool) {
    if wishes.is_empty() {
        return;
    }
    // Where the circle is cut open to a line: at the loop, or else in the
    // widest gap.
    let cut = if looping { -90.0 } else { widest_gap(wishes) };
    for wish in wishes.iter_mut() {
        wish.angle = cut + (wish.angle - cut).rem_euclid(360.0);
    }
    wishes.sort_by(|a, b| a.angle.total_cmp(&b.angle));
    let gaps = (wishes.len() - 1) as f64;
    let (low, high) = if looping {
        BESIDE_LOOP
    } else {
        (cut, cut + 360.0)
    };
    let apart = APART.min((high - low) / (gaps + 1.0));

    // Blocks of neighbours: mean of the wishes less what the gaps take, weight
    // and number.
    let mut blocks: Vec<(f64, f64, usize)> = Vec::new();
    for (position, wish) in wishes.iter().enumerate() {
        let mut block = (wish.angle - apart * position as f64, wish.weight, 1);
        while let Some(&(mean, weight, number)) = blocks.last() {
            if mean < block.0 {
                break;
            }
            blocks.pop();
            let sum = weight + block.1;
            block = (
                (mean * weight + block.0 * block.1) / sum,
                sum,
                number + block.2,
            );
        }
        blocks.push(block);
    }
    let means =
        (blocks.into_iter()).flat_map(|(mean, _, number)| std::iter::repeat_n(mean, number));
    for (position, (wish, mean)) in wishes.iter_mut().zip(means).enumerate() {
        let bounded = if looping {
            mean.clamp(low, high - apart * gaps)
        } else {
            mean
        };
        wish.angle = bounded + apart * position as f64;
    }
}

/// The middle of the widest angle without a wish, in degrees.
fn widest_gap(wishes: &[Wish]) -> f64 {
    let mut angles: Vec<f64> = (wishes.iter())
        .map(|wish| wish.angle.rem_euclid(360.0))
        .collect();
    angles.sort_by(f64::total_cmp);
    let next = angles.iter().skip(1).copied();
    let around = angles.first().map(|first| first + 360.0);
    (angles.iter().zip(next.chain(around)))
        .map(|(&angle, next)| (next - angle, angle.midpoint(next)))
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .map_or(0.0, |(_, middle)| middle)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn spread_angles(angles: &[f64], looping: bool) -> Vec<f64> {
        let mut wishes: Vec<Wish> = (angles.iter())
            .map(|&angle| Wish {
                angle,
                weight: 1.0,
                whose: None,
            })
            .collect();
        spread(&mut wishes, looping);
        // The same direction has many angles; these are from -90 on.
        let turn = |angle: f64| (angle + 90.0).rem_euclid(360.0) - 90.0;
        wishes.into_iter().map(|wish| turn(wish.angle)).collect()
    }

    #[test]
    fn arrows_keep_apart_and_clear_of_the_loop() {
        assert_eq!(spread_angles(&[0.0, 90.0], false), [0.0, 90.0]);
        assert_eq!(spread_angles(&[10.0, 10.0], false), [-2.5, 22.5]);
        assert_eq!(spread_angles(&[-80.0, -60.0], true), [-36.0, -11.0]);
        let crowded = spread_angles(&[0.0; 20], true);
        assert!(crowded.windows(2).all(|pair| pair[1] - pair[0] > 12.0));
        assert!(crowded[0] >= -36.0 && crowded[19] <= 216.0);
    }
}
