//! Sets of cells as bits, so that a step of a whole set is a few shifts.

/// A set of the cells of a grid, row by row. Every row ends with one bit that is
/// never a cell, so that a step over an edge falls on nothing.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(super) struct Cells(Vec<u64>);

impl Cells {
    /// No cell, of a grid with so many bits.
    pub(super) fn none(bits: usize) -> Self {
        Self(vec![0; bits.div_ceil(64)])
    }

    pub(super) fn insert(&mut self, bit: usize) {
        self.0[bit / 64] |= 1 << (bit % 64);
    }

    pub(super) fn contains(&self, bit: usize) -> bool {
        self.0[bit / 64] >> (bit % 64) & 1 == 1
    }

    pub(super) fn is_empty(&self) -> bool {
        self.0.iter().all(|part| *part == 0)
    }

    /// The cells in order.
    pub(super) fn iter(&self) -> impl Iterator<Item = usize> + '_ {
        self.0.iter().enumerate().flat_map(|(place, &part)| {
            let mut left = part;
            std::iter::from_fn(move || {
                let bit = left.trailing_zeros() as usize;
                left &= left.wrapping_sub(1);
                (bit < 64).then_some(place * 64 + bit)
            })
        })
    }

    pub(super) fn add(&mut self, other: &Self) {
        for (part, other) in self.0.iter_mut().zip(&other.0) {
            *part |= other;
        }
    }

    pub(super) fn remove(&mut self, other: &Self) {
        for (part, other) in self.0.iter_mut().zip(&other.0) {
            *part &= !other;
        }
    }

    pub(super) fn keep(&mut self, other: &Self) {
        for (part, other) in self.0.iter_mut().zip(&other.0) {
            *part &= other;
        }
    }

    pub(super) fn meets(&self, other: &Self) -> bool {
        (self.0.iter().zip(&other.0)).any(|(part, other)| part & other != 0)
    }

    pub(super) fn and(&self, other: &Self) -> Self {
        let mut both = self.clone();
        both.keep(other);
        both
    }

    /// The cells that one move leads to from some cell of the set, in a grid whose
    /// rows have so many bits, and bits that are no cells.
    pub(super) fn moved(&self, stride: usize) -> Self {
        let mut moved = Self(vec![0; self.0.len()]);
        for by in [1, stride] {
            let (whole, bits) = (by / 64, by % 64);
            for place in 0..self.0.len() {
                moved.0[place] |= self.part(place, whole, bits) | self.later(place, whole, bits);
            }
        }
        moved
    }

    /// A part of the set whose cells have gone `64 · whole + bits` places on.
    fn part(&self, place: usize, whole: usize, bits: usize) -> u64 {
        let at = |back: usize| place.checked_sub(back).map_or(0, |place| self.0[place]);
        let low = if bits == 0 {
            0
        } else {
            at(whole + 1) >> (64 - bits)
        };
        at(whole) << bits | low
    }

    /// The same of cells that have gone back.
    fn later(&self, place: usize, whole: usize, bits: usize) -> u64 {
        let at = |on: usize| self.0.get(place + on).copied().unwrap_or(0);
        let high = if bits == 0 {
            0
        } else {
            at(whole + 1) << (64 - bits)
        };
        at(whole) >> bits | high
    }
}
