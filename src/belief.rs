//! What is believed of a teacher: how comparisons are answered, and how often
//! answers are wrong; and how likely answers are under these beliefs.
//!
//! Nobody knows beforehand how a teacher answers where both atoms are in the
//! concept or neither is. Beliefs about that are Dirichlet distributions, and
//! the chance of a series of answers is their integral (the chance of a Pólya
//! urn), so that every concept explains all answers with the teacher that it
//! makes most plausible. Knows neither automata nor learners.

use std::fmt;

use crate::evidence::Fact;

/// How an atom ends in a concept, in the eight bytes that let millions of them be
/// compared for a question.
#[derive(Clone, Copy, PartialEq, Eq)]
pub struct End(u64);

/// Below the bit for what is inside, the merit; below that the place.
const PLACE_BITS: u32 = 31;
const NO_PLACE: u64 = 0;

impl End {
    /// `place` is a number for the place in which the atom ends, below 2³¹ − 1 (for
    /// automata: the state), none where nothing finer is known than inside and
    /// outside. Atoms of one place have one label.
    ///
    /// `merit` is, of an atom outside, how long it did well: more is longer. Teachers
    /// often prefer the failure that came later. Of an atom inside it is how much room
    /// it leaves: more is more ways to go on well. Teachers often prefer it to one
    /// after which little is allowed.
    #[inline]
    pub fn new(inside: bool, place: Option<u32>, merit: u32) -> Self {
        let place = place.map_or(NO_PLACE, |place| u64::from(place) + 1);
        debug_assert!(place >> PLACE_BITS == 0, "places are few");
        Self(u64::from(inside) << 63 | u64::from(merit) << PLACE_BITS | place)
    }

    /// Whether the concept contains the atom.
    #[inline]
    pub fn is_inside(self) -> bool {
        self.0 >> 63 == 1
    }

    /// How well it did, as [`Self::new`] was told.
    #[inline]
    pub fn merit(self) -> u32 {
        (self.0 >> PLACE_BITS) as u32
    }

    fn place(self) -> u64 {
        self.0 & ((1 << PLACE_BITS) - 1)
    }
}

impl fmt::Debug for End {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let place = self.place().checked_sub(1);
        (formatter.debug_struct("End"))
            .field("inside", &self.is_inside())
            .field("place", &place)
            .field("merit", &self.merit())
            .finish()
    }
}

/// How two atoms end, as a concept has it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ending {
    /// Only the first is in the concept.
    FirstOnly,
    /// Only the second is.
    SecondOnly,
    /// Both end in the same place.
    SamePlace,
    /// Both are in the concept, in different places of equal merit.
    Inside,
    /// Neither is in the concept, in different places of equal merit.
    Outside,
    /// Neither is in the concept, and the first did well for longer.
    FirstFurther,
    /// Neither is in the concept, and the second did well for longer.
    SecondFurther,
    /// Both are in the concept, and the first leaves more room.
    FirstFreer,
    /// Both are in the concept, and the second leaves more room.
    SecondFreer,
}

impl Ending {
    /// All of them, in the order of their numbers.
    pub const ALL: [Self; 9] = [
        Self::FirstOnly,
        Self::SecondOnly,
        Self::SamePlace,
        Self::Inside,
        Self::Outside,
        Self::FirstFurther,
        Self::SecondFurther,
        Self::FirstFreer,
        Self::SecondFreer,
    ];

    /// Of two atoms that end like this.
    #[inline]
    pub fn of(first: End, second: End) -> Self {
        // No branches: nobody can guess them, and all that is believed asks this.
        let order = usize::from(first.merit() > second.merit())
            | usize::from(first.merit() < second.merit()) << 1;
        let same =
            usize::from(first.place() != NO_PLACE) & usize::from(first.place() == second.place());
        let inside = usize::from(first.is_inside()) << 1 | usize::from(second.is_inside());
        ENDINGS[inside << 3 | order << 1 | same]
    }

    /// Of two atoms in the concept or not, of which the first has more merit, or the
    /// second, or neither, and which end in the same place or not.
    const fn told([first, second]: [bool; 2], more: [bool; 2], same: bool) -> Self {
        match ((first, second), more) {
            ((true, false), _) => Self::FirstOnly,
            ((false, true), _) => Self::SecondOnly,
            ((false, false), [true, _]) => Self::FirstFurther,
            ((false, false), [_, true]) => Self::SecondFurther,
            ((true, true), [true, _]) => Self::FirstFreer,
            ((true, true), [_, true]) => Self::SecondFreer,
            _ if same => Self::SamePlace,
            ((true, true), _) => Self::Inside,
            ((false, false), _) => Self::Outside,
        }
    }
}

/// By the bits of whether the first is in the concept, whether the second is, whether
/// the second has more merit, whether the first has, and whether they end in the same
/// place.
const ENDINGS: [Ending; 32] = {
    let mut endings = [Ending::SamePlace; 32];
    let mut number = 0;
    while number < 32 {
        endings[number] = Ending::told(
            [number >> 4 == 1, number >> 3 & 1 == 1],
            [number >> 1 & 1 == 1, number >> 2 & 1 == 1],
            number & 1 == 1,
        );
        number += 1;
    }
    endings
};

/// Something a teacher said.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Heard<A> {
    /// What was said.
    pub fact: Fact<A>,
    /// Whether it is certainly true.
    pub sure: bool,
}

/// What a comparison came to, seen from its first atom.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// The first is worse.
    Worse,
    /// Neither is better.
    Equal,
    /// They cannot be compared.
    Incomparable,
}

impl Verdict {
    /// All of them, in the order of their numbers.
    pub const ALL: [Self; 3] = [Self::Worse, Self::Equal, Self::Incomparable];
}

/// The places of [`Tally::counts`]: for atoms with different labels agreeing
/// and incomparable; for the same place, for two inside and for two outside of
/// equal merit strict, equal and incomparable; for failures of which one came
/// later, and for two inside of which one leaves more room, better, worse, equal
/// and incomparable.
const CELLS: usize = 19;
/// The cells of one urn each.
const URNS: [std::ops::Range<usize>; 6] = [0..2, 2..5, 5..8, 8..11, 11..15, 15..19];
/// What is believed before any answer, as numbers of answers seen. Of most
/// endings less than one answer's worth: whoever compares has habits, and few
/// answers show them.
const PRIOR: [f64; CELLS] = [
    1.35, 0.15, // different labels
    0.36, 0.3, 0.24, // the same place
    0.36, 0.3, 0.24, // both inside
    0.36, 0.3, 0.24, // both outside
    0.36, 0.18, 0.24, 0.18, // one failed later
    0.27, 0.27, 0.24, 0.18, // one leaves more room
];
/// Answers that are wrong, and that are right.
const ERRORS: [f64; 2] = [0.5, 9.5];
/// The logarithm of the chance of something certain that is not true. It is not
/// impossible, so that a search may pass through what it refutes.
const REFUTED: f64 = -9.0;

/// Where a tally counts unsure answers that are wrong and that are right, what is
/// certain and not true, and what nobody asks for.
const WRONG: usize = CELLS;
const RIGHT: usize = CELLS + 1;
const UNTRUE: usize = CELLS + 2;
const IDLE: usize = CELLS + 3;

/// The answers of one teacher, as a concept sees them.
#[derive(Clone, Copy, Debug, Default)]
pub struct Tally {
    /// By cell, and then the others.
    counts: [u16; IDLE + 1],
}

/// Where an answer counts: its cell, and what it says of the concept by whether it is
/// unsure or sure.
#[derive(Clone, Copy)]
struct Places {
    cell: u8,
    said: [u8; 2],
}

impl Places {
    /// Of an answer to a comparison of atoms that end like this.
    const fn of(ending: Ending, verdict: Verdict) -> Self {
        let (cell, right) = match (ending, verdict) {
            (Ending::SecondOnly, Verdict::Worse) => (0, Some(true)),
            (Ending::FirstOnly, Verdict::Worse)
            | (Ending::FirstOnly | Ending::SecondOnly, Verdict::Equal) => (IDLE, Some(false)),
            (Ending::FirstOnly | Ending::SecondOnly, Verdict::Incomparable) => (1, None),
            (Ending::SamePlace, Verdict::Worse) => (2, None),
            (Ending::SamePlace, Verdict::Equal) => (3, None),
            (Ending::SamePlace, Verdict::Incomparable) => (4, None),
            (Ending::Inside, Verdict::Worse) => (5, None),
            (Ending::Inside, Verdict::Equal) => (6, None),
            (Ending::Inside, Verdict::Incomparable) => (7, None),
            (Ending::Outside, Verdict::Worse) => (8, None),
            (Ending::Outside, Verdict::Equal) => (9, None),
            (Ending::Outside, Verdict::Incomparable) => (10, None),
            (Ending::SecondFurther, Verdict::Worse) => (11, None),
            (Ending::FirstFurther, Verdict::Worse) => (12, None),
            (Ending::FirstFurther | Ending::SecondFurther, Verdict::Equal) => (13, None),
            (Ending::FirstFurther | Ending::SecondFurther, Verdict::Incomparable) => (14, None),
            (Ending::SecondFreer, Verdict::Worse) => (15, None),
            (Ending::FirstFreer, Verdict::Worse) => (16, None),
            (Ending::FirstFreer | Ending::SecondFreer, Verdict::Equal) => (17, None),
            (Ending::FirstFreer | Ending::SecondFreer, Verdict::Incomparable) => (18, None),
        };
        Self {
            cell: cell as u8,
            said: match right {
                Some(right) => said(right),
                None => [IDLE as u8; 2],
            },
        }
    }
}

/// Where something counts that is right of a concept or not, by whether it is unsure
/// or sure.
const fn said(right: bool) -> [u8; 2] {
    if right {
        [RIGHT as u8, IDLE as u8]
    } else {
        [WRONG as u8, UNTRUE as u8]
    }
}

/// By ending and verdict.
const PLACES: [[Places; Verdict::ALL.len()]; Ending::ALL.len()] = {
    let mut places =
        [[Places::of(Ending::Inside, Verdict::Equal); Verdict::ALL.len()]; Ending::ALL.len()];
    let mut ending = 0;
    while ending < Ending::ALL.len() {
        let mut verdict = 0;
        while verdict < Verdict::ALL.len() {
            places[ending][verdict] = Places::of(Ending::ALL[ending], Verdict::ALL[verdict]);
            verdict += 1;
        }
        ending += 1;
    }
    places
};

impl Tally {
    /// Takes note of a label that agrees with the concept or not.
    #[inline]
    pub fn label(&mut self, agrees: bool, sure: bool) {
        self.count(said(agrees)[usize::from(sure)]);
    }

    /// Takes note of the answer to a comparison of atoms that end like this.
    #[inline]
    pub fn comparison(&mut self, ending: Ending, verdict: Verdict, sure: bool) {
        // No branches, as with endings.
        let places = &PLACES[ending as usize][verdict as usize];
        self.count(places.cell);
        self.count(places.said[usize::from(sure)]);
    }

    fn count(&mut self, place: u8) {
        let count = &mut self.counts[usize::from(place)];
        *count = count.wrapping_add(1);
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

/// The chances of answers under the beliefs about teachers.
#[derive(Clone, Debug)]
pub struct Belief {
    /// By cell and number of answers: `ln(a (a+1) … (a+n−1))`.
    cells: Vec<[f64; CELLS]>,
    urns: Vec<[f64; URNS.len()]>,
    errors: Vec<[f64; 2]>,
    answers: Vec<f64>,
}

impl Belief {
    /// For series of so many answers at most.
    pub fn new(most: usize) -> Self {
        let mut belief = Self {
            cells: vec![[0.0; CELLS]],
            urns: vec![[0.0; URNS.len()]],
            errors: vec![[0.0; 2]],
            answers: vec![0.0],
        };
        for n in 0..most {
            let seen = n as f64;
            let mut cells = belief.cells[n];
            for (cell, prior) in PRIOR.iter().enumerate() {
                cells[cell] += (prior + seen).ln();
                // Either way round is as likely.
                if cell == 2 || cell == 5 || cell == 8 {
                    cells[cell] -= std::f64::consts::LN_2;
                }
            }
            let mut urns = belief.urns[n];
            for (urn, cells) in URNS.iter().enumerate() {
                urns[urn] += (PRIOR[cells.clone()].iter().sum::<f64>() + seen).ln();
            }
            let mut errors = belief.errors[n];
            for (sum, prior) in errors.iter_mut().zip(ERRORS) {
                *sum += (prior + seen).ln();
            }
            let answers = belief.answers[n] + (ERRORS.iter().sum::<f64>() + seen).ln();
            belief.cells.push(cells);
            belief.urns.push(urns);
            belief.errors.push(errors);
            belief.answers.push(answers);
        }
        belief
    }

    /// The logarithm of the chance of these answers.
    ///
    /// # Panics
    ///
    /// If there are more than [`Self::new`] was told.
    pub fn log_chance(&self, tally: &Tally) -> f64 {
        let mut sum = f64::from(tally.counts[UNTRUE]) * REFUTED;
        for (urn, cells) in URNS.iter().enumerate() {
            let mut all = 0;
            for cell in cells.clone() {
                let count = usize::from(tally.counts[cell]);
                sum += self.cells[count][cell];
                all += count;
            }
            sum -= self.urns[all][urn];
        }
        let [wrong, right] = [WRONG, RIGHT].map(|place| usize::from(tally.counts[place]));
        sum + self.errors[wrong][0] + self.errors[right][1] - self.answers[wrong + right]
    }
}

/// The comparison that a fact reports, as its atoms and what it came to.
pub fn compared<A>(fact: &Fact<A>) -> Option<(&A, &A, Verdict)> {
    match fact {
        Fact::Label { .. } => None,
        Fact::Below { worse, better } => Some((worse, better, Verdict::Worse)),
        Fact::Equal { first, second } => Some((first, second, Verdict::Equal)),
        Fact::Incomparable { first, second } => Some((first, second, Verdict::Incomparable)),
    }
}
