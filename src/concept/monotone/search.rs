//! The consistent parameters of one grid, found box by box.
//!
//! Every atom is monotone in the parameter. So an atom that the least parameter of
//! a box contains is in all concepts of the box, and one that the greatest does
//! not contain is in none: whole boxes are taken or left, and only those through
//! which the boundary of some answer goes are split.

use std::collections::BTreeSet;

use rand::RngExt;
use rand_chacha::ChaCha8Rng;

use super::family::Family;
use super::point::{Place, Point};
use crate::evidence::{Budget, Fact};

/// Parameters from `low` to `high`, both included.
struct Cell {
    low: Vec<u32>,
    high: Vec<u32>,
}

impl Cell {
    fn volume(&self) -> u64 {
        let lengths = self.low.iter().zip(&self.high);
        lengths
            .map(|(low, high)| u64::from(high - low) + 1)
            .product()
    }

    /// The parameter of this number, below the volume.
    fn at(&self, mut number: u64, steps: u32) -> Point {
        let mut ticks = self.low.clone();
        for (tick, high) in ticks.iter_mut().zip(&self.high).rev() {
            let length = u64::from(high - *tick) + 1;
            *tick += (number % length) as u32;
            number /= length;
        }
        Point::new(ticks, steps)
    }

    /// Both halves along the longest side; none for a single parameter.
    fn split(&self) -> Option<[Self; 2]> {
        let length = |side: &usize| self.high[*side] - self.low[*side];
        let side = (0..self.low.len()).rev().max_by_key(length)?;
        if length(&side) == 0 {
            return None;
        }
        let middle = self.low[side] + length(&side) / 2;
        let (mut low, mut high) = (self.low.clone(), self.high.clone());
        high[side] = middle;
        low[side] = middle + 1;
        let lower = Self {
            low: self.low.clone(),
            high,
        };
        let upper = Self {
            low,
            high: self.high.clone(),
        };
        Some([lower, upper])
    }
}

/// The consistent parameters of a grid.
pub(super) struct Consistent {
    cells: Vec<Cell>,
    steps: u32,
}

impl Consistent {
    /// How many there are.
    pub(super) fn count(&self) -> u64 {
        self.cells.iter().map(Cell::volume).sum()
    }

    /// All of them, or `count` drawn evenly; in a fixed order.
    pub(super) fn draw(&self, count: u64, random: &mut ChaCha8Rng) -> Vec<Point> {
        let all = self.count();
        let numbers: Vec<u64> = if all <= count {
            (0..all).collect()
        } else {
            // Floyd's way to draw without repetition.
            let mut drawn = BTreeSet::new();
            for last in all - count..all {
                if !drawn.insert(random.random_range(0..=last)) {
                    drawn.insert(last);
                }
            }
            drawn.into_iter().collect()
        };
        let mut points = Vec::with_capacity(numbers.len());
        let mut numbers = numbers.into_iter().peekable();
        let mut before = 0;
        for cell in &self.cells {
            let after = before + cell.volume();
            while let Some(number) = numbers.next_if(|&number| number < after) {
                points.push(cell.at(number - before, self.steps));
            }
            before = after;
        }
        points
    }
}

/// Finds them among the grid's `size` points per axis; none if the budget ends.
pub(super) fn consistent<F: Family>(
    family: &F,
    size: usize,
    facts: &[&Fact<F::Atom>],
    budget: &mut Budget,
) -> Option<Consistent> {
    let top = size.saturating_sub(1) as u32;
    let whole = Cell {
        low: vec![0; family.dimensions()],
        high: vec![top; family.dimensions()],
    };
    let steps = top.max(1);
    let mut cells = Vec::new();
    let mut open = vec![(whole, facts.to_vec())];
    while let Some((cell, facts)) = open.pop() {
        if !budget.spend(1 + facts.len() as u64 / 8) {
            return None;
        }
        let Some(unsettled) = unsettled(family, &cell, steps, &facts) else {
            continue;
        };
        match cell.split() {
            Some(halves) if !unsettled.is_empty() => {
                let [lower, upper] = halves;
                open.push((upper, unsettled.clone()));
                open.push((lower, unsettled));
            }
            // Of a single parameter nothing is unsettled.
            _ => cells.push(cell),
        }
    }
    Some(Consistent { cells, steps })
}

/// The facts that hold for some parameters of the cell, as far as its extremes
/// tell, and not for others; none if some fact holds for no parameter.
fn unsettled<'a, F: Family>(
    family: &F,
    cell: &Cell,
    steps: u32,
    facts: &[&'a Fact<F::Atom>],
) -> Option<Vec<&'a Fact<F::Atom>>> {
    let place = |ticks| Place { ticks, steps };
    let inside = |atom: &F::Atom| {
        if family.contains(place(&cell.low), atom) {
            Some(true)
        } else if family.contains(place(&cell.high), atom) {
            None
        } else {
            Some(false)
        }
    };
    let mut unsettled = Vec::new();
    for &fact in facts {
        let holds = match fact {
            Fact::Label { atom, accepted } => inside(atom).map(|inside| inside == *accepted),
            Fact::Below { worse, better } => match (inside(worse), inside(better)) {
                (Some(false), _) | (_, Some(true)) => Some(true),
                (Some(true), Some(false)) => Some(false),
                _ => None,
            },
            Fact::Equal { first, second } => match (inside(first), inside(second)) {
                (Some(first), Some(second)) => Some(first == second),
                _ => None,
            },
            Fact::Incomparable { .. } => Some(true),
        };
        match holds {
            Some(true) => {}
            Some(false) => return None,
            None => unsettled.push(fact),
        }
    }
    Some(unsettled)
}
