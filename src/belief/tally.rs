//! What a concept makes of the answers of one teacher: how many of each kind.

use super::Verdict;
use super::ending::Ending;

/// The places of [`Tally::counts`]: for atoms with different labels agreeing
/// and incomparable; for the same place, for two inside and for two outside of
/// equal merit strict, equal and incomparable; for failures of which one came
/// later, and for two inside of which one leaves more room, better, worse, equal
/// and incomparable.
pub(super) const CELLS: usize = 19;
/// The cells of one urn each.
pub(super) const URNS: [std::ops::Range<usize>; 6] = [0..2, 2..5, 5..8, 8..11, 11..15, 15..19];
/// What is believed before any answer, as numbers of answers seen. Of most
/// endings less than one answer's worth: whoever compares has habits, and few
/// answers show them.
pub(super) const PRIOR: [f64; CELLS] = [
    1.35, 0.15, // different labels
    0.36, 0.3, 0.24, // the same place
    0.36, 0.3, 0.24, // both inside
    0.36, 0.3, 0.24, // both outside
    0.36, 0.18, 0.24, 0.18, // one failed later
    0.27, 0.27, 0.24, 0.18, // one leaves more room
];
/// Answers that are wrong, and that are right.
pub(super) const ERRORS: [f64; 2] = [0.5, 9.5];

/// After the cells a tally counts unsure answers that are wrong.
pub(super) const WRONG: usize = CELLS;
/// Unsure answers that are right.
pub(super) const RIGHT: usize = CELLS + 1;
/// What is certain and not true.
pub(super) const UNTRUE: usize = CELLS + 2;

/// By cell, and then the others, to the end of a register.
type Counts = [u16; COUNTS];
const COUNTS: usize = 24;

/// The answers of one teacher, as a concept sees them.
#[derive(Clone, Copy, Debug, Default)]
pub struct Tally {
    pub(super) counts: Counts,
}

/// What the answer to a comparison of atoms that end like this counts as: the cell, and
/// whether it is right or wrong of the concept, where it is one of these.
const fn counted(ending: Ending, verdict: Verdict) -> (Option<usize>, Option<bool>) {
    match (ending, verdict) {
        (Ending::SecondOnly, Verdict::Worse) => (Some(0), Some(true)),
        (Ending::FirstOnly, Verdict::Worse)
        | (Ending::FirstOnly | Ending::SecondOnly, Verdict::Equal) => (None, Some(false)),
        (Ending::FirstOnly | Ending::SecondOnly, Verdict::Incomparable) => (Some(1), None),
        (Ending::SamePlace, Verdict::Worse) => (Some(2), None),
        (Ending::SamePlace, Verdict::Equal) => (Some(3), None),
        (Ending::SamePlace, Verdict::Incomparable) => (Some(4), None),
        (Ending::Inside, Verdict::Worse) => (Some(5), None),
        (Ending::Inside, Verdict::Equal) => (Some(6), None),
        (Ending::Inside, Verdict::Incomparable) => (Some(7), None),
        (Ending::Outside, Verdict::Worse) => (Some(8), None),
        (Ending::Outside, Verdict::Equal) => (Some(9), None),
        (Ending::Outside, Verdict::Incomparable) => (Some(10), None),
        (Ending::SecondFurther, Verdict::Worse) => (Some(11), None),
        (Ending::FirstFurther, Verdict::Worse) => (Some(12), None),
        (Ending::FirstFurther | Ending::SecondFurther, Verdict::Equal) => (Some(13), None),
        (Ending::FirstFurther | Ending::SecondFurther, Verdict::Incomparable) => (Some(14), None),
        (Ending::SecondFreer, Verdict::Worse) => (Some(15), None),
        (Ending::FirstFreer, Verdict::Worse) => (Some(16), None),
        (Ending::FirstFreer | Ending::SecondFreer, Verdict::Equal) => (Some(17), None),
        (Ending::FirstFreer | Ending::SecondFreer, Verdict::Incomparable) => (Some(18), None),
    }
}

/// A one wherever something counts that falls into this cell, and that is right of a
/// concept or not, if that is unsure or sure.
const fn ones(cell: Option<usize>, right: Option<bool>, sure: bool) -> Counts {
    let mut ones = [0; COUNTS];
    if let Some(cell) = cell {
        ones[cell] = 1;
    }
    match (right, sure) {
        (Some(false), false) => ones[WRONG] = 1,
        (Some(true), false) => ones[RIGHT] = 1,
        (Some(false), true) => ones[UNTRUE] = 1,
        (Some(true), true) | (None, _) => {}
    }
    ones
}

/// Of answers to comparisons: by ending, by verdict, and by whether they are sure.
const COMPARISONS: [[[Counts; 2]; Verdict::ALL.len()]; Ending::ALL.len()] = {
    let mut table = [[[[0; COUNTS]; 2]; Verdict::ALL.len()]; Ending::ALL.len()];
    let mut ending = 0;
    while ending < Ending::ALL.len() {
        let mut verdict = 0;
        while verdict < Verdict::ALL.len() {
            let (cell, right) = counted(Ending::ALL[ending], Verdict::ALL[verdict]);
            table[ending][verdict] = [ones(cell, right, false), ones(cell, right, true)];
            verdict += 1;
        }
        ending += 1;
    }
    table
};

/// Of labels: by whether they agree with the concept, and by whether they are sure.
const LABELS: [[Counts; 2]; 2] = [
    [
        ones(None, Some(false), false),
        ones(None, Some(false), true),
    ],
    [ones(None, Some(true), false), ones(None, Some(true), true)],
];

impl Tally {
    /// Takes note of a label that agrees with the concept or not.
    #[inline]
    pub fn label(&mut self, agrees: bool, sure: bool) {
        self.add(&LABELS[usize::from(agrees)][usize::from(sure)]);
    }

    /// Takes note of the answer to a comparison of atoms that end like this.
    #[inline]
    pub fn comparison(&mut self, ending: Ending, verdict: Verdict, sure: bool) {
        // No branches, as with endings; and whole registers, since one place is counted
        // at again and again.
        self.add(&COMPARISONS[ending as usize][verdict as usize][usize::from(sure)]);
    }

    #[inline]
    fn add(&mut self, ones: &Counts) {
        for (count, one) in self.counts.iter_mut().zip(ones) {
            *count = count.wrapping_add(*one);
        }
    }

    /// Whether something certain is not true of the concept.
    pub fn is_refuted(&self) -> bool {
        self.counts[UNTRUE] > 0
    }

    /// The expected share of unsure answers that are wrong.
    pub fn error_rate(&self) -> f64 {
        let wrong = f64::from(self.counts[WRONG]) + ERRORS[0];
        let right = f64::from(self.counts[RIGHT]) + ERRORS[1];
        wrong / (wrong + right)
    }

    /// The expected chances of the answers `first`, `second`, `equal` and
    /// `incomparable` to a further comparison, by how its atoms end, if answers
    /// are wrong at the rate `wrong`.
    pub fn odds(&self, ending: Ending, wrong: f64) -> [f64; 4] {
        let share = |urn: usize, cell: usize| {
            let of = |cell: usize| f64::from(self.counts[cell]) + PRIOR[cell];
            of(cell) / URNS[urn].clone().map(of).sum::<f64>()
        };
        let strict = |urn: usize, from: usize| {
            let strict = share(urn, from) / 2.0;
            [strict, strict, share(urn, from + 1), share(urn, from + 2)]
        };
        let directed = |urn: usize, cells: [usize; 4]| cells.map(|cell| share(urn, cell));
        match ending {
            // A wrong answer names the worse one.
            Ending::FirstOnly => [
                share(0, 0) * (1.0 - wrong),
                share(0, 0) * wrong,
                0.0,
                share(0, 1),
            ],
            Ending::SecondOnly => [
                share(0, 0) * wrong,
                share(0, 0) * (1.0 - wrong),
                0.0,
                share(0, 1),
            ],
            Ending::SamePlace => strict(1, 2),
            Ending::Inside => strict(2, 5),
            Ending::Outside => strict(3, 8),
            Ending::FirstFurther => directed(4, [11, 12, 13, 14]),
            Ending::SecondFurther => directed(4, [12, 11, 13, 14]),
            Ending::FirstFreer => directed(5, [15, 16, 17, 18]),
            Ending::SecondFreer => directed(5, [16, 15, 17, 18]),
        }
    }
}
