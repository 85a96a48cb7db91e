//! Automata of exactly one size, grown edge by edge: drawn one at a time with
//! the chance of the draw, or listed.

use rand::RngExt;
use rand_chacha::ChaCha8Rng;

use super::completion::Table;
use super::growth::Growth;
use super::instance::{Instance, Node};
use super::partial::Partial;
use super::spread::{Ending, Odds};
use crate::evidence::{Budget, Comparison};

/// A comparison that was answered, with what the answer speaks for.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Hint {
    pub(crate) first: Node,
    pub(crate) second: Node,
    /// By [`Ending`]: the logarithm of how much likelier the answer is than it
    /// would be if nothing was known of how the words end.
    pub(crate) log_odds: [f64; Ending::ALL.len()],
}

impl Hint {
    /// What an answer about two words speaks for.
    pub(crate) fn new(first: Node, second: Node, answer: Comparison, odds: &Odds) -> Self {
        let chances = Ending::ALL.map(|ending| odds.chance(ending, answer));
        let mean = chances.iter().sum::<f64>() / chances.len() as f64;
        Self {
            first,
            second,
            log_odds: chances.map(|chance| (chance / mean).ln()),
        }
    }
}

/// One way to go on.
#[derive(Clone, Copy, Debug)]
struct Way {
    target: u32,
    /// The output that a new state gets at once.
    output: Option<bool>,
    /// Logarithm.
    weight: f64,
}

/// An automaton that grows to exactly so many states.
pub(crate) struct Grower<'a> {
    partial: Partial<'a>,
    symbols: usize,
    states: u32,
    hints: &'a [Hint],
    ways: Vec<Way>,
}

/// An automaton that was drawn.
pub(crate) struct Dive {
    pub(crate) table: Table,
    /// The logarithm of the chance with which this table was drawn.
    pub(crate) log_chance: f64,
}

impl<'a> Grower<'a> {
    pub(crate) fn new(instance: &'a Instance, states: usize, hints: &'a [Hint]) -> Self {
        Self {
            partial: Partial::new(instance, states),
            symbols: instance.symbols,
            states: states as u32,
            hints,
            ways: Vec::new(),
        }
    }

    /// One automaton, drawn edge by edge, from what `growth` and the hints make
    /// likely among all that violates nothing yet; none if that led nowhere or
    /// the budget ended.
    pub(crate) fn dive(
        &mut self,
        growth: &Growth,
        rng: &mut ChaCha8Rng,
        budget: &mut Budget,
    ) -> Option<Dive> {
        let start = self.partial.mark();
        let log_chance = self.descend(growth, rng, budget);
        let dive = log_chance.map(|log_chance| Dive {
            table: self.table(),
            log_chance,
        });
        self.partial.undo(start);
        dive
    }

    fn descend(
        &mut self,
        growth: &Growth,
        rng: &mut ChaCha8Rng,
        budget: &mut Budget,
    ) -> Option<f64> {
        let mut log_chance = 0.0;
        if self.partial.output(0).is_none() && !self.hints.is_empty() {
            log_chance += self.decide(0, rng)?;
        }
        while let Some(edge) = self.partial.tightest() {
            log_chance += self.lead(edge, growth, rng, budget)?;
        }
        // No word waits any more: nothing can go wrong.
        while let Some(edge) = self.partial.first_open_edge() {
            let used = self.partial.used();
            if used == self.states && growth.is_even() {
                let target = rng.random_range(0..used);
                log_chance -= f64::from(used).ln();
                self.partial.define(edge, target);
            } else {
                log_chance += self.lead_freely(edge, growth, rng);
            }
        }
        for state in 0..self.partial.used() {
            if self.partial.output(state).is_none() {
                log_chance += self.decide(state, rng)?;
            }
        }
        Some(log_chance)
    }

    /// Defines an edge at which nothing waits; the logarithm of its chance.
    fn lead_freely(&mut self, edge: u32, growth: &Growth, rng: &mut ChaCha8Rng) -> f64 {
        let used = self.partial.used();
        let state = edge / self.symbols as u32;
        let open = self.partial.open_edges();
        let all = growth.completion(used as usize, open);
        let after = growth.completion(used as usize, open - 1);
        let mut at = rng.random::<f64>();
        let mut chosen = None;
        for target in 0..used {
            let log_chance = growth.old(target == state) + after - all;
            let chance = log_chance.exp();
            if chance > 0.0 {
                chosen = Some((target, log_chance));
                if at < chance {
                    break;
                }
                at -= chance;
            }
            if target + 1 == used && used < self.states {
                let log_chance = growth.born(used as usize, open) - all;
                if log_chance > f64::NEG_INFINITY {
                    chosen = Some((used, log_chance));
                }
            }
        }
        let (target, log_chance) = chosen.expect("an edge can lead somewhere");
        self.partial.define(edge, target);
        log_chance
    }

    /// Defines an edge at which words wait.
    fn lead(
        &mut self,
        edge: u32,
        growth: &Growth,
        rng: &mut ChaCha8Rng,
        budget: &mut Budget,
    ) -> Option<f64> {
        let used = self.partial.used();
        let state = edge / self.symbols as u32;
        let open = self.partial.open_edges();
        let mark = self.partial.mark();
        let after = growth.completion(used as usize, open - 1);
        self.ways.clear();
        let last = if used < self.states { used } else { used - 1 };
        for target in 0..=last {
            let weight = if target == used {
                growth.born(used as usize, open)
            } else if self.partial.may_lead(edge, target) {
                growth.old(target == state) + after
            } else {
                continue;
            };
            if weight == f64::NEG_INFINITY {
                continue;
            }
            if !budget.spend(1) {
                return None;
            }
            if self.partial.define(edge, target) {
                let open_output = target == used && self.partial.output(used).is_none();
                if open_output && !self.hints.is_empty() {
                    let born = self.partial.mark();
                    for output in [false, true] {
                        if self.partial.assume(used, output) {
                            let weight = weight - std::f64::consts::LN_2 + self.hinted();
                            let output = Some(output);
                            self.ways.push(Way {
                                target,
                                output,
                                weight,
                            });
                        }
                        self.partial.undo(born);
                    }
                } else {
                    let weight = weight + self.hinted();
                    let output = None;
                    self.ways.push(Way {
                        target,
                        output,
                        weight,
                    });
                }
            }
            self.partial.undo(mark);
        }
        let (way, log_chance) = pick(&self.ways, rng)?;
        let fits = self.partial.define(edge, way.target);
        debug_assert!(fits, "it did before");
        if let Some(output) = way.output {
            let fits = self.partial.assume(way.target, output);
            debug_assert!(fits, "it did before");
        }
        Some(log_chance)
    }

    /// Draws an output that is open.
    fn decide(&mut self, state: u32, rng: &mut ChaCha8Rng) -> Option<f64> {
        let mark = self.partial.mark();
        self.ways.clear();
        for output in [false, true] {
            if self.partial.assume(state, output) {
                let weight = self.hinted();
                let output = Some(output);
                self.ways.push(Way {
                    target: state,
                    output,
                    weight,
                });
            }
            self.partial.undo(mark);
        }
        let (way, log_chance) = pick(&self.ways, rng)?;
        self.partial.assume(state, way.output == Some(true));
        Some(log_chance)
    }

    /// What the hints say about the partial automaton, as far as they can tell.
    fn hinted(&self) -> f64 {
        let of = |hint: &Hint| {
            let first = self.partial.place_of(hint.first)?;
            let second = self.partial.place_of(hint.second)?;
            let ending = if first == second {
                Ending::SamePlace
            } else {
                let first = self.partial.output(first)?;
                Ending::of(first, self.partial.output(second)?, false)
            };
            Some(hint.log_odds[ending as usize])
        };
        self.hints.iter().filter_map(of).sum()
    }

    fn table(&self) -> Table {
        let outputs = 0..self.partial.used();
        let output = outputs.map(|s| self.partial.output(s) == Some(true));
        (self.partial.delta().to_vec(), output.collect())
    }

    /// Calls `found` with every automaton, each in one numbering; `false` if
    /// the budget ended first or `found` had enough.
    pub(crate) fn list(
        &mut self,
        budget: &mut Budget,
        found: &mut dyn FnMut(&Table) -> bool,
    ) -> bool {
        let mark = self.partial.mark();
        let edge = self
            .partial
            .tightest()
            .or_else(|| self.partial.first_open_edge());
        let Some(edge) = edge else {
            return self.list_outputs(0, budget, found);
        };
        let used = self.partial.used();
        let last = if used < self.states { used } else { used - 1 };
        for target in 0..=last {
            if target < used {
                // Otherwise no edge is left to lead to the states that are missing.
                if used < self.states && self.partial.open_edges() == 1 {
                    continue;
                }
                if !self.partial.may_lead(edge, target) {
                    continue;
                }
            }
            if !budget.spend(1) {
                return false;
            }
            let goes_on = !self.partial.define(edge, target) || self.list(budget, found);
            self.partial.undo(mark);
            if !goes_on {
                return false;
            }
        }
        true
    }

    fn list_outputs(
        &mut self,
        from: u32,
        budget: &mut Budget,
        found: &mut dyn FnMut(&Table) -> bool,
    ) -> bool {
        let open = (from..self.partial.used()).find(|&s| self.partial.output(s).is_none());
        let Some(state) = open else {
            return self.partial.used() != self.states || found(&self.table());
        };
        let mark = self.partial.mark();
        for output in [false, true] {
            if !budget.spend(1) {
                return false;
            }
            let goes_on =
                !self.partial.assume(state, output) || self.list_outputs(state + 1, budget, found);
            self.partial.undo(mark);
            if !goes_on {
                return false;
            }
        }
        true
    }
}

/// One of the ways, with the logarithm of its chance.
fn pick(ways: &[Way], rng: &mut ChaCha8Rng) -> Option<(Way, f64)> {
    let most = ways.iter().map(|way| way.weight).reduce(f64::max)?;
    let sum: f64 = ways.iter().map(|way| (way.weight - most).exp()).sum();
    if let [only] = ways {
        return Some((*only, 0.0));
    }
    let mut at = rng.random::<f64>() * sum;
    let last = ways.last()?;
    let way = ways
        .iter()
        .find(|way| {
            at -= (way.weight - most).exp();
            at < 0.0
        })
        .unwrap_or(last);
    Some((*way, way.weight - most - sum.ln()))
}
