//! The family of a geometric picture: an atom is a corner, and the concepts that
//! contain it are those whose parameter is beyond it in every dimension.

use rand::RngExt;
use rand_chacha::ChaCha8Rng;

use super::family::Family;
use super::point::{Place, Point, gcd};

/// Of atoms that use several dimensions so many are looked at for witnesses.
const WALKED: usize = 4096;

/// Atoms `x ∈ [0, 1]^d` with `Θ⁺ = {θ | θ ≥ x}`, so that `φ_θ = {x | x ≤ θ}`.
///
/// This is Example 9: what a drive asks of a passenger's patience and of the
/// passenger's nerve is a point, and acceptable is what asks no more than `θ` of
/// either. Other bi-partitions could be asked about as well, but would separate
/// nothing that corners do not: whatever any bi-partition tells apart is told
/// apart by a corner.
#[derive(Clone, Debug)]
pub struct Corners {
    dimensions: usize,
    finest: u32,
}

impl Corners {
    /// In so many dimensions; the coordinates of atoms are multiples of `1/s`,
    /// `s` being at most `finest` points per axis less one.
    ///
    /// # Panics
    ///
    /// If there is no dimension or no point.
    pub fn new(dimensions: usize, finest: usize) -> Self {
        assert!(dimensions > 0, "a point has at least one dimension");
        assert!(finest > 0, "a grid has at least one point");
        Self {
            dimensions,
            finest: (finest as u32).saturating_sub(1).max(1),
        }
    }

    /// The point at which only this dimension is not 0.
    fn on_axis(&self, axis: usize, tick: u32, steps: u32) -> Point {
        let mut ticks = vec![0; self.dimensions];
        ticks[axis] = tick;
        Point::new(ticks, steps)
    }

    /// All points of a grid in lowest terms with so many coordinates that are not
    /// 0, simplest first.
    fn of_grid(&self, used: usize, steps: u32) -> impl Iterator<Item = Point> + use<> {
        let dimensions = self.dimensions;
        let mut next = Some(vec![0; dimensions]);
        let walk = std::iter::from_fn(move || {
            let ticks = next.take()?;
            let mut after = ticks.clone();
            // Counts in base `steps + 1`, the last coordinate fastest.
            let side = (0..dimensions).rev().find(|&side| after[side] < steps);
            if let Some(side) = side {
                after[side] += 1;
                after[side + 1..].fill(0);
                next = Some(after);
            }
            Some(ticks)
        });
        walk.filter(move |ticks| {
            let uses = ticks.iter().filter(|&&tick| tick > 0).count() == used;
            uses && ticks
                .iter()
                .fold(steps, |divisor, &tick| gcd(divisor, tick))
                == 1
        })
        .map(move |ticks| Point::new(ticks, steps))
    }

    fn points(&self, fewest: usize) -> impl Iterator<Item = Point> + use<> {
        let (family, finest) = (self.clone(), self.finest);
        let origin = (fewest == 0).then(|| Point::new(vec![0; self.dimensions], 0));
        let used = fewest.max(1)..=self.dimensions;
        let others = used.flat_map(move |used| {
            let family = family.clone();
            (1..=finest).flat_map(move |steps| family.of_grid(used, steps))
        });
        origin.into_iter().chain(others)
    }
}

/// `parameter ≥ atom` in every dimension, exactly.
fn is_beyond(parameter: Place<'_>, atom: Place<'_>) -> bool {
    let scaled = |tick: u32, by: u32| u64::from(tick) * u64::from(by);
    let mut ticks = parameter.ticks.iter().zip(atom.ticks);
    ticks.all(|(&high, &low)| scaled(high, atom.steps) >= scaled(low, parameter.steps))
}

impl Family for Corners {
    type Atom = Point;
    type Key = Point;

    fn dimensions(&self) -> usize {
        self.dimensions
    }

    fn contains(&self, parameter: Place<'_>, atom: &Point) -> bool {
        is_beyond(parameter, atom.place())
    }

    fn slack(&self, parameter: &Point, atom: &Point) -> f64 {
        let each = parameter.coordinates().zip(atom.coordinates());
        each.map(|(high, low)| high - low).fold(1.0, f64::min)
    }

    fn key(&self, parameter: &Point) -> Point {
        parameter.clone()
    }

    fn witnesses(&self, inside: &Point, outside: &Point, count: usize) -> Vec<Point> {
        let (high, low) = (inside.place(), outside.place());
        let mut found: Vec<Point> = Vec::new();
        for steps in 1..=self.finest {
            if found.len() >= count {
                break;
            }
            let floor = |place: Place<'_>, axis: usize| {
                (u64::from(place.ticks[axis]) * u64::from(steps) / u64::from(place.steps)) as u32
            };
            // The last axis first: the order is by coordinates.
            for axis in (0..self.dimensions).rev() {
                let between = floor(low, axis) + 1..=floor(high, axis);
                let lowest_terms = between.filter(|&tick| gcd(steps, tick) == 1);
                found.extend(lowest_terms.map(|tick| self.on_axis(axis, tick, steps)));
            }
        }
        if found.is_empty() {
            return found;
        }
        // Several dimensions are used only where that is not enough.
        if found.len() < count {
            let separates = |atom: &Point| self.contains(high, atom) && !self.contains(low, atom);
            let further = self.points(2).take(WALKED).filter(separates);
            found.extend(further.take(count - found.len()));
        }
        found.truncate(count);
        found
    }

    fn atoms(&self) -> Box<dyn Iterator<Item = Point> + '_> {
        Box::new(self.points(0))
    }

    /// Half of them anywhere on the finest grid, and half on it where the
    /// hypothesis accepts: of all points, a strict hypothesis accepts next to none.
    fn draw(&self, hypothesis: &Point, count: usize, random: &mut ChaCha8Rng) -> Vec<Point> {
        let place = hypothesis.place();
        let draw = |_| {
            let inside = random.random::<bool>();
            let ticks = place.ticks.iter().map(|&tick| {
                let below = u64::from(tick) * u64::from(self.finest) / u64::from(place.steps);
                let top = if inside { below as u32 } else { self.finest };
                random.random_range(0..=top)
            });
            Point::new(ticks.collect(), self.finest)
        };
        (0..count).map(draw).collect()
    }

    fn drawn_from(&self) -> String {
        format!(
            "points of the grid with {} points per axis, half of them from anywhere and half from where it accepts",
            self.finest + 1
        )
    }
}
