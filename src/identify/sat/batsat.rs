//! The solver `batsat`, stopped through its callback.

use std::cell::Cell;

use batsat::{Callbacks, ClauseKind, SolverInterface, lbool};

use super::solver::{Answer, CLAUSES_PER_UNIT, Lit, Model, Solver};
use crate::evidence::{Budget, Stop};

/// The units of work that one decision takes (measured, as are the next ones,
/// on formulas of 9 to 14 states: a unit is then one to two µs).
const UNITS_PER_DECISION: u64 = 3;

/// The units that one conflict takes, and those for every literal of the clause
/// learned from it.
const UNITS_PER_CONFLICT: u64 = 30;
const UNITS_PER_LITERAL: u64 = 2;

/// Counts work, and stops the solver when there has been enough.
struct Meter {
    /// The solver asks from behind a shared reference whether to stop.
    left: Cell<u64>,
    stop: Stop,
}

impl Meter {
    fn take(&self, units: u64) {
        self.left.set(self.left.get().saturating_sub(units));
    }
}

impl Callbacks for Meter {
    fn on_new_clause(&mut self, clause: &[batsat::Lit], _: ClauseKind) {
        self.take(UNITS_PER_CONFLICT + UNITS_PER_LITERAL * clause.len() as u64);
    }

    /// Asked at every decision. Once true it stays true until the next solve,
    /// as the solver asks twice.
    fn stop(&self) -> bool {
        self.take(UNITS_PER_DECISION);
        self.left.get() == 0 || self.stop.is_set()
    }
}

/// A `batsat` solver.
pub(super) struct Batsat {
    solver: batsat::Solver<Meter>,
    variables: usize,
    /// Clauses since the last solve.
    added: u64,
    clause: Vec<batsat::Lit>,
}

impl Batsat {
    /// A solver without variables and clauses.
    pub(super) fn new() -> Self {
        let meter = Meter {
            left: Cell::new(u64::MAX),
            stop: Stop::default(),
        };
        Self {
            solver: batsat::Solver::new(batsat::SolverOpts::default(), meter),
            variables: 0,
            added: 0,
            clause: Vec::new(),
        }
    }

    fn lit(&mut self, lit: Lit) -> batsat::Lit {
        let index = u32::try_from(lit.index()).expect("a literal's index comes from 32 bits");
        batsat::Lit::new(self.solver.var_of_int(index), lit.is_positive())
    }
}

impl Solver for Batsat {
    fn new_var(&mut self) -> Lit {
        self.solver.new_var_default();
        self.variables += 1;
        Lit::new(self.variables - 1, true)
    }

    fn add_clause(&mut self, clause: &[Lit]) {
        self.added += 1;
        let mut translated = std::mem::take(&mut self.clause);
        translated.clear();
        for &lit in clause {
            let lit = self.lit(lit);
            translated.push(lit);
        }
        // What it returns, whether a contradiction has shown, the next solve
        // says as well.
        self.solver.add_clause_reuse(&mut translated);
        self.clause = translated;
    }

    fn solve(&mut self, assumptions: &[Lit], budget: &mut Budget) -> Answer {
        let added = std::mem::take(&mut self.added);
        if !budget.spend(1 + added / CLAUSES_PER_UNIT) {
            return Answer::Unknown;
        }
        let assumptions: Vec<_> = assumptions.iter().map(|&lit| self.lit(lit)).collect();
        let allowed = budget.left();
        let meter = self.solver.cb_mut();
        meter.left.set(allowed);
        meter.stop = budget.stop().clone();
        let result = self.solver.solve_limited(&assumptions);
        let used = allowed - self.solver.cb().left.get();
        // Cannot fail: no more is used than was allowed.
        let _ = budget.spend(used);
        if result == lbool::TRUE {
            let values = self.solver.get_model().iter();
            Answer::Sat(Model(values.map(|&value| value == lbool::TRUE).collect()))
        } else if result == lbool::FALSE {
            // The solver names the negations of the assumptions.
            let core = self.solver.unsat_core().iter();
            Answer::Unsat(
                core.map(|lit| Lit::new(lit.var().idx() as usize, !lit.sign()))
                    .collect(),
            )
        } else {
            Answer::Unknown
        }
    }
}
