//! What is believed of a teacher: how comparisons are answered, and how often
//! answers are wrong; and how likely answers are under these beliefs.
//!
//! Nobody knows beforehand how a teacher answers where both atoms are in the
//! concept or neither is. Beliefs about that are Dirichlet distributions, and
//! the chance of a series of answers is their integral (the chance of a Pólya
//! urn), so that every concept explains all answers with the teacher that it
//! makes most plausible. Knows neither automata nor learners.

mod ending;
mod tally;

pub use self::ending::{Column, End, Ending, LANES, Place};
pub use self::tally::Tally;
use self::tally::{CELLS, ERRORS, PRIOR, RIGHT, UNTRUE, URNS, WRONG};
use crate::evidence::Fact;

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

/// The logarithm of the chance of something certain that is not true. It is not
/// impossible, so that a search may pass through what it refutes.
const REFUTED: f64 = -9.0;

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
