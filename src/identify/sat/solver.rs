//! What the SAT engine asks of a SAT solver, and nothing more.

use std::ops::Not;

use crate::evidence::Budget;

/// A variable or its negation.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(super) struct Lit(u32);

impl Lit {
    /// The literal that is true when variable `index` has this value.
    pub(super) fn new(index: usize, value: bool) -> Self {
        let index = u32::try_from(index).expect("a formula has fewer than 2^31 variables");
        Self(index << 1 | u32::from(!value))
    }

    /// The place of the literal's variable, dense from 0.
    pub(super) fn index(self) -> usize {
        (self.0 >> 1) as usize
    }

    /// Whether the literal is the variable itself, not its negation.
    pub(super) fn is_positive(self) -> bool {
        self.0 & 1 == 0
    }

    /// This literal if `value`, else its negation.
    pub(super) fn when(self, value: bool) -> Self {
        if value { self } else { !self }
    }
}

impl Not for Lit {
    type Output = Self;

    fn not(self) -> Self {
        Self(self.0 ^ 1)
    }
}

/// A value for every variable.
#[derive(Clone, Debug)]
pub(super) struct Model(pub(super) Vec<bool>);

impl Model {
    /// Whether the literal is true. A variable that did not exist at the time
    /// of the model is false.
    pub(super) fn holds(&self, lit: Lit) -> bool {
        self.0.get(lit.index()).copied().unwrap_or(false) == lit.is_positive()
    }
}

/// What a solver found.
#[derive(Clone, Debug)]
pub(super) enum Answer {
    /// All clauses and assumptions hold here.
    Sat(Model),
    /// These of the assumptions cannot hold together. A claim: the caller
    /// verifies it before use.
    Unsat(Vec<Lit>),
    /// The budget ended. The solver can be used as before.
    Unknown,
}

/// The clauses whose building and loading takes one unit of work.
pub(super) const CLAUSES_PER_UNIT: u64 = 2;

/// An incremental SAT solver.
pub(super) trait Solver {
    /// A new variable, as its positive literal. Variables are numbered from 0.
    fn new_var(&mut self) -> Lit;

    /// Demands that one of the literals holds, from now on for ever.
    fn add_clause(&mut self, clause: &[Lit]);

    /// Looks for a model of all clauses in which all assumptions hold.
    ///
    /// Takes at least one unit, so that a loop of solves ends with its budget.
    fn solve(&mut self, assumptions: &[Lit], budget: &mut Budget) -> Answer;
}
