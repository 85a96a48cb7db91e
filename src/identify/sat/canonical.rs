//! The choice of automata that does not depend on what a solver did before.
//!
//! Under a seeded order of the values of every edge and state, edges and states
//! are fixed one after the other, each to its first value with which there
//! still is an automaton. The result is the first automaton of that order, a
//! function of the facts and the seed alone: not of models that the solver
//! happened to find, nor of words whose facts were retracted.

use rand::SeedableRng;
use rand::seq::SliceRandom;
use rand_chacha::ChaCha8Rng;

use super::encoding::{Encoding, Table};
use super::solver::{Answer, Lit, Model, Solver};
use crate::evidence::Budget;

/// What a choice came to.
pub(super) enum Choice {
    /// As many tables as were wanted, or all there are.
    Chosen {
        tables: Vec<Table>,
        /// Whether these are known to be all.
        complete: bool,
    },
    /// There is no automaton; these assumptions cannot hold together.
    None(Vec<Lit>),
    /// The budget ended before the first automaton was chosen.
    OverBudget,
}

/// Chooses up to `count` different tables for which the assumptions hold.
pub(super) fn choose<S: Solver>(
    encoding: &mut Encoding<S>,
    assumptions: &[Lit],
    count: usize,
    seed: u64,
    budget: &mut Budget,
) -> Choice {
    let first = match encoding.solver.solve(assumptions, budget) {
        Answer::Sat(model) => model,
        Answer::Unsat(core) => return Choice::None(core),
        Answer::Unknown => return Choice::OverBudget,
    };
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let mut fixed = assumptions.to_vec();
    // Chosen tables are forbidden while this is assumed, and for good no longer.
    let fresh = encoding.solver.new_var();
    fixed.push(fresh);
    let (mut tables, mut complete) = (Vec::new(), false);
    let mut model = first;
    while let Some(table) = first_table(encoding, &mut fixed, model, &mut rng, budget) {
        let mut clause = vec![!fresh];
        clause.extend(values(encoding, &table).map(|value| !value));
        encoding.solver.add_clause(&clause);
        tables.push(table);
        if count == 1 {
            break;
        }
        // Whether these are all is worth one more solve to whoever wants a few.
        match encoding.solver.solve(&fixed, budget) {
            Answer::Sat(next) => model = next,
            Answer::Unsat(_) => {
                complete = true;
                break;
            }
            Answer::Unknown => break,
        }
        if tables.len() == count {
            break;
        }
    }
    encoding.solver.add_clause(&[!fresh]);
    if tables.is_empty() {
        return Choice::OverBudget;
    }
    Choice::Chosen { tables, complete }
}

/// The literals that make up the table.
fn values<S: Solver>(encoding: &Encoding<S>, table: &Table) -> impl Iterator<Item = Lit> {
    let targets = table.targets.iter().enumerate();
    let accepting = table.accepting.iter().enumerate();
    targets
        .map(|(edge, &j)| encoding.target(edge, j))
        .chain(accepting.map(|(i, &z)| encoding.accepting(i).when(z)))
}

/// The first table under a random order of values, given a model of `fixed`;
/// none if the budget ends. Leaves `fixed` as it was.
fn first_table<S: Solver>(
    encoding: &mut Encoding<S>,
    fixed: &mut Vec<Lit>,
    mut model: Model,
    rng: &mut ChaCha8Rng,
    budget: &mut Budget,
) -> Option<Table> {
    let before = fixed.len();
    for mut cell in cells(encoding) {
        cell.shuffle(rng);
        // The last one that is left needs no solve: some value must hold.
        for &value in &cell {
            fixed.push(value);
            if model.holds(value) {
                break;
            }
            match encoding.solver.solve(fixed, budget) {
                Answer::Sat(better) => {
                    model = better;
                    break;
                }
                Answer::Unsat(_) => {
                    fixed.pop();
                }
                Answer::Unknown => {
                    fixed.truncate(before);
                    return None;
                }
            }
        }
    }
    fixed.truncate(before);
    encoding.table(&model)
}

/// The values of each state's acceptance and of each edge's target, a state's
/// own before its edges, in the order of the states: later ones are then mostly
/// determined by earlier ones.
fn cells<S: Solver>(encoding: &Encoding<S>) -> Vec<Vec<Lit>> {
    let symbols = encoding.edges() / encoding.states();
    let mut cells = Vec::new();
    for i in 0..encoding.states() {
        let accepting = encoding.accepting(i);
        cells.push(vec![accepting, !accepting]);
        for edge in i * symbols..(i + 1) * symbols {
            let targets = (0..encoding.states()).map(|j| encoding.target(edge, j));
            cells.push(targets.collect());
        }
    }
    cells
}
