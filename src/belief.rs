//! What is believed of a teacher: how comparisons are answered, and how often
//! answers are wrong; and how likely answers are under these beliefs.
//!
//! Nobody knows beforehand how a teacher answers where both atoms are in the
//! concept or neither is. Beliefs about that are Dirichlet distributions, and
//! the chance of a series of answers is their integral (the chance of a Pólya
//! urn), so that every concept explains all answers with the teacher that it
//! makes most plausible. Knows neither automata nor learners.

use crate::evidence::Fact;

/// How an atom ends in a concept.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct End {
    /// Whether the concept contains the atom.
    pub inside: bool,
    /// A number for the place in which it ends (for automata: the state), none
    /// where nothing finer is known than inside and outside. Atoms of one place
    /// have one label.
    pub place: Option<u32>,
    /// Of an atom outside, how long it did well: more is longer. Teachers often
    /// prefer the failure that came later. Of an atom inside, how much room it
    /// leaves: more is more ways to go on well. Teachers often prefer it to one
    /// after which little is allowed.
    pub merit: u32,
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
        let order =
            usize::from(first.merit > second.merit) | usize::from(first.merit < second.merit) << 1;
        let same = usize::from(first.place.is_some()) & usize::from(first.place == second.place);
        ENDINGS[usize::from(first.inside)][usize::from(second.inside)][order][same]
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

/// By whether the first is in the concept, whether the second is, which has more merit
/// (a bit for each), and whether they end in the same place.
const ENDINGS: [[[[Ending; 2]; 4]; 2]; 2] = {
    let mut endings = [[[[Ending::SamePlace; 2]; 4]; 2]; 2];
    let mut number = 0;
    while number < 32 {
        let [first, second, same] = [number >> 4, number >> 3 & 1, number & 1];
        let order = number >> 1 & 3;
        endings[first][second][order][same] = Ending::told(
            [first == 1, second == 1],
            [order & 1 == 1, order & 2 == 2],
            same == 1,
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

/// The answers of one teacher, as a concept sees them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Tally {
    counts: [u16; CELLS],
    /// Unsure answers that are wrong, and right.
    errors: [u16; 2],
    /// What is certain and not true.
    refuted: u16,
}

impl Tally {
    /// Takes note of a label that agrees with the concept or not.
    pub fn label(&mut self, agrees: bool, sure: bool) {
        self.certain(agrees, sure);
    }

    /// Takes note of the answer to a comparison of atoms that end like this.
    #[inline]
    pub fn comparison(&mut self, ending: Ending, verdict: Verdict, sure: bool) {
        let cell = match (ending, verdict) {
            (Ending::SamePlace, Verdict::Worse) => 2,
            (Ending::SamePlace, Verdict::Equal) => 3,
            (Ending::SamePlace, Verdict::Incomparable) => 4,
            (Ending::Inside, Verdict::Worse) => 5,
            (Ending::Inside, Verdict::Equal) => 6,
            (Ending::Inside, Verdict::Incomparable) => 7,
            (Ending::Outside, Verdict::Worse) => 8,
            (Ending::Outside, Verdict::Equal) => 9,
            (Ending::Outside, Verdict::Incomparable) => 10,
            (Ending::SecondFurther, Verdict::Worse) => 11,
            (Ending::FirstFurther, Verdict::Worse) => 12,
            (Ending::FirstFurther | Ending::SecondFurther, Verdict::Equal) => 13,
            (Ending::FirstFurther | Ending::SecondFurther, Verdict::Incomparable) => 14,
            (Ending::SecondFreer, Verdict::Worse) => 15,
            (Ending::FirstFreer, Verdict::Worse) => 16,
            (Ending::FirstFreer | Ending::SecondFreer, Verdict::Equal) => 17,
            (Ending::FirstFreer | Ending::SecondFreer, Verdict::Incomparable) => 18,
            (_, Verdict::Incomparable) => 1,
            (Ending::SecondOnly, Verdict::Worse) => {
                self.certain(true, sure);
                0
            }
            (Ending::FirstOnly, Verdict::Worse) | (_, Verdict::Equal) => {
                return self.certain(false, sure);
            }
        };
        self.counts[cell] += 1;
    }

    fn certain(&mut self, right: bool, sure: bool) {
        if sure {
            self.refuted += u16::from(!right);
        } else {
            self.errors[usize::from(right)] += 1;
        }
    }

    /// Whether something certain is not true of the concept.
    pub fn is_refuted(&self) -> bool {
        self.refuted > 0
    }

    /// The expected share of unsure answers that are wrong.
    pub fn error_rate(&self) -> f64 {
        let [wrong, right] = [0, 1].map(|kind| f64::from(self.errors[kind]) + ERRORS[kind]);
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
        let mut sum = f64::from(tally.refuted) * REFUTED;
        for (urn, cells) in URNS.iter().enumerate() {
            let mut all = 0;
            for cell in cells.clone() {
                let count = usize::from(tally.counts[cell]);
                sum += self.cells[count][cell];
                all += count;
            }
            sum -= self.urns[all][urn];
        }
        let [wrong, right] = tally.errors.map(usize::from);
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
