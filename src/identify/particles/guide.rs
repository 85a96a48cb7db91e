//! A smallest consistent automaton, searched for where chains disagree: they
//! may all have lost their way among automata too large, and a search cannot.

use automata::{Alphabet, Word};

use super::chain::{Ground, Machine};
use crate::belief::Heard;
use crate::evidence::Budget;
use crate::identify::engine::{Engine, Query, Verdict};
use crate::identify::enumerate::Enumerator;
use crate::identify::problem::{FactId, Problem};
use crate::identify::spread::table;

/// The units of work that a search may take, for every size.
const UNITS: u64 = 20_000;
/// Of so many automata of the smallest size the likeliest is taken.
const CHOICE: usize = 16;

/// All certain facts, and the size that they are known to need.
#[derive(Clone)]
pub(super) struct Guide {
    problem: Problem,
    standing: Vec<FactId>,
    at_least: usize,
}

impl Guide {
    /// Nothing known.
    pub(super) fn new(alphabet: Alphabet) -> Self {
        Self {
            problem: Problem::new(alphabet),
            standing: Vec::new(),
            at_least: 1,
        }
    }

    /// Takes note of one thing more.
    pub(super) fn add(&mut self, heard: &Heard<Word>) {
        if heard.sure {
            self.standing.extend(self.problem.add(None, &heard.fact));
        }
    }

    /// The smallest size that is not known to be too small.
    pub(super) fn at_least(&self) -> usize {
        self.at_least
    }

    /// Forgets all facts, but that they need this size.
    pub(super) fn restart(&mut self, at_least: usize) {
        *self = Self {
            at_least,
            ..Self::new(self.problem.alphabet().clone())
        };
    }

    /// The likeliest of some smallest automata; none if the search takes too long.
    pub(super) fn find(&mut self, ground: &Ground<'_>, seed: u64) -> Option<Machine> {
        while self.at_least <= ground.shape.most() {
            let query = Query {
                problem: &self.problem,
                standing: &self.standing,
                states: self.at_least,
                count: CHOICE,
                seed,
            };
            match Enumerator.search(&query, &mut Budget::new(UNITS)) {
                Verdict::Found { automata, .. } => {
                    let machines = automata.iter().map(|dfa| {
                        let (delta, output) = table(dfa);
                        let delta = delta.iter().map(|&target| target as u8).collect();
                        Machine::new(delta, output, ground)
                    });
                    let chance = |machine: &Machine| machine.log_chance();
                    return machines.max_by(|one, other| chance(one).total_cmp(&chance(other)));
                }
                Verdict::None { .. } => self.at_least += 1,
                Verdict::OverBudget => return None,
            }
        }
        None
    }
}
