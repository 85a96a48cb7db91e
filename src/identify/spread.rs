//! The consistent automata of several sizes, each with its chance after what
//! was heard: listed where there are few, otherwise met by particles.

use std::collections::BTreeMap;

use automata::{Alphabet, Dfa, Word};
use smallvec::smallvec;

use super::Sample;
use super::completion::{Small, Table, automaton, breadth_first};
use super::grow::Lister;
use super::instance::Instance;
use super::particles::Posterior;
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

/// All minimal automata of `wish.sizes` sizes, of which the smallest is the
/// smallest consistent one, with their chances; none if that are too many, or it
/// takes too much work to tell. The search begins with one state, whatever an
/// earlier one proved: else what was searched before could show in the answer.
pub(crate) fn list(
    problem: &Problem,
    standing: &[FactId],
    bound: usize,
    wish: &Wish<'_, Word>,
) -> Option<Spread<Dfa>> {
    let instance = Instance::new(problem, standing)?;
    let mut budget = Budget::new(wish.listed as u64 * NODES_PER_LISTED);
    let mut listed: Vec<Table> = Vec::new();
    let mut most = bound;
    let mut states = 1;
    while states <= most {
        let ended = Lister::new(&instance, states).list(&mut budget, &mut |table| {
            if is_minimal(table) {
                listed.push(breadth_first(table));
            }
            listed.len() <= wish.listed
        });
        if !ended {
            return None;
        }
        if most == bound && !listed.is_empty() {
            most = bound.min(states + wish.sizes.max(1) - 1);
        }
        states += 1;
    }
    let posterior = Posterior::new(problem.alphabet().len(), bound, wish);
    let weighted = |table: Table| Weighted {
        log_weight: posterior.log_chance(&table),
        concept: automaton(problem.alphabet(), table),
    };
    Some(Spread {
        concepts: listed.into_iter().map(weighted).collect(),
        exact: true,
        hurried: false,
    })
    .filter(|spread| !spread.concepts.is_empty())
}

/// The automata that chains met, by their shares.
pub(crate) fn met(alphabet: &Alphabet, shares: &BTreeMap<Table, f64>) -> Spread<Dfa> {
    // They were numbered when they were met.
    let weighted = |(table, &share): (&Table, &f64)| Weighted {
        concept: automaton(alphabet, table.clone()),
        log_weight: share.ln(),
    };
    Spread {
        concepts: shares.iter().map(weighted).collect(),
        exact: false,
        hurried: false,
    }
}

/// What a search found, where chains met nothing consistent.
pub(crate) fn found(smallest: &Sample, bound: usize, wish: &Wish<'_, Word>) -> Spread<Dfa> {
    let symbols = (smallest.automata.first()).map_or(1, |dfa| dfa.alphabet().len());
    let posterior = Posterior::new(symbols, bound, wish);
    let weighted = |dfa: &Dfa| Weighted {
        log_weight: posterior.log_chance(&table(dfa)),
        concept: dfa.clone(),
    };
    Spread {
        concepts: smallest.automata.iter().map(weighted).collect(),
        exact: false,
        hurried: true,
    }
}

/// The table of an automaton.
pub(crate) fn table(dfa: &Dfa) -> Table {
    let delta = dfa.states().flat_map(|state| {
        let targets = dfa.alphabet().symbols().map(move |a| dfa.next(state, a));
        targets.map(|target| target.index() as u32)
    });
    let output = dfa.states().map(|state| dfa.is_accepting(state));
    (delta.collect(), output.collect())
}

/// Whether no two states accept the same words: Moore's refinement, which needs
/// no queues for tables this small.
pub(crate) fn is_minimal((delta, output): &Table) -> bool {
    let states = output.len();
    let symbols = delta.len() / states;
    let mut block: Small = output.iter().map(|&accepting| accepting.into()).collect();
    let mut next: Small = smallvec![0; states];
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
            next[state] = if let Some(other) = (0..state).find(same) {
                next[other]
            } else {
                count += 1;
                count - 1
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
