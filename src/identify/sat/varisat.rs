//! The solver `varisat` on a thread of its own, stopped through its proof.
//!
//! `varisat` 0.2.2 is not `Send` and cannot be interrupted. It does stop when
//! the proof that it writes along the way can no longer be written, and the
//! length of that proof is a deterministic measure of its work: one step for
//! every clause learned, with the clauses that it came from. A solver that was
//! stopped so is of no further use; the clauses are kept here, and the next
//! solve loads them into a new one.

use std::cell::{Cell, RefCell};
use std::io;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::rc::Rc;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread;

use varisat::ExtendFormula;

use super::solver::{Answer, CLAUSES_PER_UNIT, Lit, Model, Solver};
use crate::evidence::{Budget, Stop};

/// The bytes of proof that are one unit of work (measured on formulas of 9 to
/// 14 states: a unit is then one to two µs).
const BYTES_PER_UNIT: u64 = 3;

/// A `varisat` solver.
pub(super) struct Varisat {
    variables: usize,
    clauses: Clauses,
    /// How many of the clauses were paid for.
    charged: usize,
    /// How many of the clauses the worker already has.
    sent: usize,
    worker: Option<Worker>,
}

/// Clauses, one after the other.
#[derive(Clone, Default)]
struct Clauses {
    literals: Vec<Lit>,
    /// Where each clause ends.
    ends: Vec<usize>,
}

impl Clauses {
    fn push(&mut self, clause: &[Lit]) {
        self.literals.extend_from_slice(clause);
        self.ends.push(self.literals.len());
    }

    fn iter(&self) -> impl Iterator<Item = &[Lit]> {
        let starts = std::iter::once(0).chain(self.ends.iter().copied());
        starts
            .zip(&self.ends)
            .map(|(start, &end)| &self.literals[start..end])
    }

    /// The clauses from the `first` on.
    fn tail(&self, first: usize) -> Self {
        let start = if first == 0 { 0 } else { self.ends[first - 1] };
        Self {
            literals: self.literals[start..].to_vec(),
            ends: self.ends[first..].iter().map(|end| end - start).collect(),
        }
    }
}

impl Varisat {
    /// A solver without variables and clauses.
    pub(super) fn new() -> Self {
        Self {
            variables: 0,
            clauses: Clauses::default(),
            charged: 0,
            sent: 0,
            worker: None,
        }
    }
}

impl Solver for Varisat {
    fn new_var(&mut self) -> Lit {
        self.variables += 1;
        Lit::new(self.variables - 1, true)
    }

    fn add_clause(&mut self, clause: &[Lit]) {
        self.clauses.push(clause);
    }

    fn solve(&mut self, assumptions: &[Lit], budget: &mut Budget) -> Answer {
        let added = (self.clauses.ends.len() - self.charged) as u64;
        self.charged = self.clauses.ends.len();
        if !budget.spend(1 + added / CLAUSES_PER_UNIT) {
            return Answer::Unknown;
        }
        let worker = if let Some(worker) = self.worker.take() {
            worker
        } else {
            self.sent = 0;
            let Some(worker) = Worker::start() else {
                return Answer::Unknown;
            };
            worker
        };
        let allowed = budget.left().saturating_mul(BYTES_PER_UNIT);
        let task = Task {
            variables: self.variables,
            clauses: self.clauses.tail(self.sent),
            assumptions: assumptions.to_vec(),
            allowed,
            stop: budget.stop().clone(),
        };
        self.sent = self.clauses.ends.len();
        let Some(Done { answer, left }) = worker.solve(task) else {
            // The solver panicked. Its clauses are still here, and a new one
            // begins with the next solve; to the caller it gave up.
            let _ = budget.spend(budget.left());
            return Answer::Unknown;
        };
        if let Answer::Unknown = answer {
            let _ = budget.spend(budget.left());
        } else {
            let _ = budget.spend((allowed - left) / BYTES_PER_UNIT);
            self.worker = Some(worker);
        }
        answer
    }
}

/// One solve, with what is new since the last.
struct Task {
    variables: usize,
    clauses: Clauses,
    assumptions: Vec<Lit>,
    /// The bytes of proof that may be written.
    allowed: u64,
    stop: Stop,
}

/// What came of a task.
struct Done {
    answer: Answer,
    /// The bytes of proof that were not written.
    left: u64,
}

/// The thread on which the solver lives. It ends when this is dropped, or with
/// the first task that stops or breaks the solver.
struct Worker {
    tasks: Sender<Task>,
    done: Receiver<Done>,
}

impl Worker {
    /// A thread with a new solver; none if the system has no thread to give.
    fn start() -> Option<Self> {
        let (tasks, inbox) = channel::<Task>();
        let (outbox, done) = channel();
        thread::Builder::new()
            .name("varisat".to_owned())
            .spawn(move || {
                // A panic ends the thread, and the closed channel tells of it.
                let _ = catch_unwind(AssertUnwindSafe(|| work(&inbox, &outbox)));
            })
            .ok()?;
        Some(Self { tasks, done })
    }

    /// What comes of the task; none if the solver panicked.
    fn solve(&self, task: Task) -> Option<Done> {
        self.tasks.send(task).ok()?;
        self.done.recv().ok()
    }
}

/// Solves one task after the other with one solver.
fn work(inbox: &Receiver<Task>, outbox: &Sender<Done>) {
    let meter = Meter::default();
    let mut solver = varisat::Solver::new();
    // The other formats panic on assumptions.
    solver.write_proof(meter.clone(), varisat::solver::ProofFormat::Varisat);
    let mut variables = Vec::new();
    while let Ok(task) = inbox.recv() {
        // Loading clauses writes too, and has to be done however long they are.
        meter.left.set(u64::MAX);
        meter.stop.replace(Stop::default());
        while variables.len() < task.variables {
            variables.push(solver.new_var());
        }
        let translate = |lit: &Lit| variables[lit.index()].lit(lit.is_positive());
        for clause in task.clauses.iter() {
            let clause: Vec<_> = clause.iter().map(translate).collect();
            solver.add_clause(&clause);
        }
        let assumptions: Vec<_> = task.assumptions.iter().map(translate).collect();
        solver.assume(&assumptions);
        meter.left.set(task.allowed);
        meter.stop.replace(task.stop);
        let answer = answer(&mut solver, task.variables);
        let stopped = matches!(answer, Answer::Unknown);
        let done = Done {
            answer,
            left: meter.left.get(),
        };
        if outbox.send(done).is_err() || stopped {
            break;
        }
    }
    // Dropping the solver closes the proof, which need not succeed.
}

/// Solves and reads the result.
fn answer(solver: &mut varisat::Solver<'_>, variables: usize) -> Answer {
    match solver.solve() {
        Ok(true) => {
            let mut values = vec![false; variables];
            for lit in solver.model().unwrap_or_default() {
                if let Some(value) = values.get_mut(lit.index()) {
                    *value = lit.is_positive();
                }
            }
            Answer::Sat(Model(values))
        }
        Ok(false) => {
            let core = solver.failed_core().unwrap_or_default().iter();
            Answer::Unsat(
                core.map(|lit| Lit::new(lit.index(), lit.is_positive()))
                    .collect(),
            )
        }
        Err(_) => Answer::Unknown,
    }
}

/// Swallows a proof until it is longer than allowed, or nobody wants the answer.
#[derive(Clone)]
struct Meter {
    left: Rc<Cell<u64>>,
    stop: Rc<RefCell<Stop>>,
}

impl Default for Meter {
    fn default() -> Self {
        Self {
            left: Rc::new(Cell::new(u64::MAX)),
            stop: Rc::default(),
        }
    }
}

impl io::Write for Meter {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let left = self.left.get().checked_sub(bytes.len() as u64);
        if let Some(left) = left.filter(|_| !self.stop.borrow().is_set()) {
            self.left.set(left);
            Ok(bytes.len())
        } else {
            self.left.set(0);
            Err(io::Error::other("the budget is spent"))
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}
