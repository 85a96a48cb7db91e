//! All small automata, tried one by one.

use std::collections::BTreeSet;

use automata::{Alphabet, Dfa, Word};
use memrep::evidence::Fact;

use super::{holds, table};
use crate::draw::Draw;

/// Every automaton, numbered breadth first, by letters and states.
pub(crate) struct Brute {
    /// `all[letters - 1][states - 1]`.
    all: Vec<Vec<Vec<Dfa>>>,
}

/// The smallest consistent automata.
pub(crate) struct Smallest {
    pub(crate) size: usize,
    pub(crate) tables: BTreeSet<(Vec<usize>, Vec<bool>)>,
}

impl Brute {
    pub(crate) fn up_to(letters: usize, states: usize) -> Self {
        let all = |letters| (1..=states).map(|states| every(letters, states)).collect();
        Self {
            all: (1..=letters).map(all).collect(),
        }
    }

    /// None if it is larger than was tried.
    pub(crate) fn smallest(&self, alphabet: &Alphabet, facts: &[Fact<Word>]) -> Option<Smallest> {
        (self.all[alphabet.len() - 1].iter().enumerate()).find_map(|(below, automata)| {
            let tables: BTreeSet<_> = (automata.iter())
                .filter(|dfa| facts.iter().all(|fact| holds(dfa, fact)))
                .map(table)
                .collect();
            (!tables.is_empty()).then_some(Smallest {
                size: below + 1,
                tables,
            })
        })
    }
}

fn every(letters: usize, states: usize) -> Vec<Dfa> {
    let alphabet = Draw::alphabet(letters);
    let edges = letters * states;
    let tables = states.pow(edges as u32);
    let mut found = Vec::new();
    for number in 0..tables {
        let targets: Vec<usize> = (0..edges)
            .scan(number, |rest, _| {
                let target = *rest % states;
                *rest /= states;
                Some(target)
            })
            .collect();
        let delta: Vec<Vec<usize>> = targets.chunks(letters).map(<[usize]>::to_vec).collect();
        let make = |outputs: usize| {
            let accepting = (0..states).map(|state| outputs >> state & 1 == 1).collect();
            Dfa::new(alphabet.clone(), 0, accepting, &delta).expect("a complete table")
        };
        let dfa = make(0);
        if canonical(&dfa) == dfa {
            found.extend((0..1 << states).map(make));
        }
    }
    found
}

/// The reachable part, numbered breadth first.
pub(crate) fn canonical(dfa: &Dfa) -> Dfa {
    let mut order = vec![dfa.start()];
    let mut at = 0;
    while let Some(&state) = order.get(at) {
        at += 1;
        for symbol in dfa.alphabet().symbols() {
            let next = dfa.next(state, symbol);
            if !order.contains(&next) {
                order.push(next);
            }
        }
    }
    let number = |state| {
        order
            .iter()
            .position(|&s| s == state)
            .expect("it is reachable")
    };
    let delta: Vec<Vec<usize>> = (order.iter())
        .map(|&state| {
            let next = |symbol| number(dfa.next(state, symbol));
            dfa.alphabet().symbols().map(next).collect()
        })
        .collect();
    let accepting = order.iter().map(|&state| dfa.is_accepting(state)).collect();
    Dfa::new(dfa.alphabet().clone(), 0, accepting, &delta).expect("all targets are numbered")
}
