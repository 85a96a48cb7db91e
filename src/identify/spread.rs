//! The consistent automata of several sizes, each with its chance after what
//! was heard: listed where there are few, otherwise met by particles.

use automata::{Dfa, Word};

use super::Sample;
use super::completion::{Table, canonical};
use super::grow::Lister;
use super::instance::Instance;
use super::particles::{Particles, Posterior, table};
use super::problem::{FactId, Problem};
use crate::belief::Heard;
use crate::evidence::Budget;

/// What is wanted of a [`Spread`].
#[derive(Clone, Debug)]
pub struct Wish<'a, A> {
    /// The number of sizes that are listed, from the smallest consistent one.
    pub sizes: usize,
    /// The prior of a size over that of the size before.
    pub decay: f64,
    /// As many concepts are listed at most.
    pub listed: usize,
    /// What was heard, answer by answer.
    pub heard: &'a [Vec<Heard<A>>],
    /// Decides what is drawn.
    pub seed: u64,
}

/// A consistent concept with its weight.
#[derive(Clone, Debug, PartialEq)]
pub struct Weighted<C> {
    /// The concept.
    pub concept: C,
    /// The logarithm of its chance, up to a number that all concepts share.
    pub log_weight: f64,
}

/// Consistent concepts of several sizes; no two contain the same atoms.
#[derive(Clone, Debug)]
pub struct Spread<C> {
    /// The concepts, in an order that says nothing.
    pub concepts: Vec<Weighted<C>>,
    /// Whether these are all concepts of these sizes.
    pub exact: bool,
    /// Whether the concepts were found in another way than wanted.
    pub hurried: bool,
}

/// Nodes of the search that a listing may take for each automaton wanted.
const NODES_PER_LISTED: u64 = 6;
/// With fewer counts of consistent automata, those that a search found are
/// taken for a start.
const BARREN: u32 = 100;

/// The spread of the facts `standing`, with which `smallest` are consistent and
/// nothing smaller; nothing with more than `bound` states is wanted.
pub(crate) fn gather(
    problem: &Problem,
    standing: &[FactId],
    smallest: &Sample,
    bound: usize,
    particles: &mut Option<Particles>,
    wish: &Wish<'_, Word>,
) -> Spread<Dfa> {
    let symbols = problem.alphabet().len();
    let moving = match particles.take() {
        Some(known) if known.precede(wish.heard, wish.decay, wish.seed) => known,
        _ => Particles::new(symbols, bound, wish.decay, wish.seed),
    };
    let moving = particles.insert(moving);
    moving.hear(wish.heard);
    let named = |(table, log_weight): (Table, f64)| Weighted {
        concept: canonical(problem.alphabet(), &table),
        log_weight,
    };
    if let Some(listed) = list(problem, standing, smallest, bound, wish) {
        let posterior = Posterior::new(symbols, bound, wish);
        let weighted = listed.into_iter().map(|table| {
            let weight = posterior.log_chance(&table);
            (table, weight)
        });
        return Spread {
            concepts: weighted.map(named).collect(),
            exact: true,
            hurried: false,
        };
    }
    let mut counts = moving.met().clone();
    let hurried = counts.values().sum::<u32>() < BARREN;
    if hurried {
        for (table, count) in moving.visit(&smallest.automata) {
            *counts.entry(table).or_insert(0) += count;
        }
    }
    if counts.is_empty() {
        counts.extend(smallest.automata.iter().map(|dfa| (table(dfa), 1)));
    }
    let counts = counts.into_iter();
    Spread {
        concepts: counts.map(|(table, count)| named((table, f64::from(count).ln()))).collect(),
        exact: false,
        hurried,
    }
}

/// All minimal automata of so many sizes, if there are few.
fn list(
    problem: &Problem,
    standing: &[FactId],
    smallest: &Sample,
    bound: usize,
    wish: &Wish<'_, Word>,
) -> Option<Vec<Table>> {
    let least = smallest.automata.first()?.size();
    if !smallest.complete || wish.listed == 0 {
        return None;
    }
    let mut listed: Vec<Table> = smallest.automata.iter().map(table).collect();
    let instance = Instance::new(problem, standing)?;
    let mut budget = Budget::new(wish.listed as u64 * NODES_PER_LISTED);
    for states in least + 1..=(least + wish.sizes.max(1) - 1).min(bound) {
        let ended = Lister::new(&instance, states).list(&mut budget, &mut |table| {
            if is_minimal(table) {
                listed.push(breadth_first(table));
            }
            listed.len() <= wish.listed
        });
        if !ended {
            return None;
        }
    }
    Some(listed)
}

/// The same table with its states numbered breadth first.
pub(crate) fn breadth_first((delta, output): &Table) -> Table {
    let symbols = delta.len() / output.len();
    let mut order = vec![0_u32];
    let mut number = vec![u32::MAX; output.len()];
    number[0] = 0;
    let mut next = 0;
    while let Some(&state) = order.get(next) {
        next += 1;
        let row = state as usize * symbols;
        for &target in &delta[row..row + symbols] {
            if number[target as usize] == u32::MAX {
                number[target as usize] = order.len() as u32;
                order.push(target);
            }
        }
    }
    let mut table = (
        Vec::with_capacity(delta.len()),
        Vec::with_capacity(output.len()),
    );
    for &state in &order {
        let row = state as usize * symbols;
        let targets = delta[row..row + symbols].iter();
        table
            .0
            .extend(targets.map(|&target| number[target as usize]));
        table.1.push(output[state as usize]);
    }
    table
}

/// Whether no two states accept the same words: Moore's refinement, which needs
/// no queues for tables this small.
pub(crate) fn is_minimal((delta, output): &Table) -> bool {
    let states = output.len();
    let symbols = delta.len() / states;
    let mut block: Vec<u32> = output
        .iter()
        .map(|&accepting| u32::from(accepting))
        .collect();
    let mut next = vec![0; states];
    let mut blocks = 0;
    loop {
        let mut count = 0;
        for state in 0..states {
            let same = |other: &usize| {
                block[*other] == block[state]
                    && (0..symbols).all(|symbol| {
                        block[delta[other * symbols + symbol] as usize]
                            == block[delta[state * symbols + symbol] as usize]
                    })
            };
            next[state] = match (0..state).find(same) {
                Some(other) => next[other],
                None => {
                    count += 1;
                    count - 1
                }
            };
        }
        if count as usize == states {
            return true;
        }
        if count == blocks {
            return false;
        }
        blocks = count;
        std::mem::swap(&mut block, &mut next);
    }
}
