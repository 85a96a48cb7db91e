//! One Markov chain over numbered tables, whose stationary distribution is the
//! posterior: Metropolis and Hastings' moves, among them some between sizes
//! (Green's reversible jumps).

use rand::RngExt;
use rand_chacha::ChaCha8Rng;

use super::script::Script;
use super::shape::Shape;
use crate::belief::{Belief, Tally};

/// A complete table all of whose states are reachable, with what it makes of
/// what was heard.
#[derive(Clone, Debug)]
pub(crate) struct Machine {
    pub(crate) delta: Vec<u8>,
    pub(crate) output: Vec<bool>,
    /// The state at every node of the script.
    at: Vec<u8>,
    /// Whether a word uses the edge.
    used: Vec<bool>,
    /// Room to work in.
    progress: Vec<u32>,
    pub(crate) tally: Tally,
    /// The logarithms of prior and likelihood.
    prior: f64,
    pub(crate) likelihood: f64,
}

/// What all chains share.
pub(crate) struct Ground<'a> {
    pub(crate) shape: &'a Shape,
    pub(crate) script: &'a Script,
    pub(crate) belief: &'a Belief,
    pub(crate) symbols: usize,
}

impl Machine {
    pub(crate) fn new(delta: Vec<u8>, output: Vec<bool>, ground: &Ground<'_>) -> Self {
        let mut machine = Self {
            delta,
            output,
            at: Vec::new(),
            used: Vec::new(),
            progress: Vec::new(),
            tally: Tally::default(),
            prior: 0.0,
            likelihood: 0.0,
        };
        machine.prior = ground.shape.log_prior(&machine.delta, machine.states());
        machine.hear(ground);
        machine
    }

    /// The logarithm of its share of the posterior, up to a number that all
    /// share.
    pub(crate) fn log_chance(&self) -> f64 {
        self.prior + self.likelihood
    }

    pub(crate) fn states(&self) -> usize {
        self.output.len()
    }

    /// Judges anew what was heard.
    pub(crate) fn hear(&mut self, ground: &Ground<'_>) {
        ground.script.run(&self.delta, &mut self.at, &mut self.used);
        self.judge(ground);
    }

    fn judge(&mut self, ground: &Ground<'_>) {
        self.tally = (ground.script).tally(&self.delta, &self.output, &self.at, &mut self.progress);
        self.likelihood = ground.belief.log_chance(&self.tally);
    }
}

/// Moves a machine.
#[derive(Default)]
pub(crate) struct Mover {
    spare: Option<Machine>,
    reached: Vec<bool>,
    stack: Vec<u8>,
}

impl Mover {
    /// One step of the chain.
    pub(crate) fn step(
        &mut self,
        machine: &mut Machine,
        power: f64,
        ground: &Ground<'_>,
        rng: &mut ChaCha8Rng,
    ) -> bool {
        let mut other = self.spare.take().unwrap_or_else(|| machine.clone());
        other.delta.clone_from(&machine.delta);
        other.output.clone_from(&machine.output);
        let kind: u32 = rng.random_range(0..100);
        let bonus = match kind {
            0..50 => redirect(&mut other, rng),
            50..60 => swap(&mut other, ground.symbols, rng),
            60..75 => {
                let state = rng.random_range(0..other.states());
                other.output[state] ^= true;
                Some(0.0)
            }
            75..88 => split(&mut other, ground, rng),
            _ => merge(&mut other, ground.symbols, rng),
        };
        let accepted = bonus.is_some_and(|bonus| {
            let moved = other.delta != machine.delta;
            if moved && !self.is_reachable(&other, ground.symbols) {
                return false;
            }
            other.prior = if moved {
                ground.shape.log_prior(&other.delta, other.states())
            } else {
                machine.prior
            };
            let allowed = bonus + other.prior - machine.prior;
            let unheard = other.states() == machine.states()
                && (machine.delta.iter().zip(&other.delta).zip(&machine.used))
                    .all(|((old, new), used)| old == new || !used);
            if unheard {
                other.at.clone_from(&machine.at);
                other.used.clone_from(&machine.used);
                other.judge(ground);
            } else {
                other.hear(ground);
            }
            let draw = rng.random::<f64>().ln();
            draw < allowed + power * (other.likelihood - machine.likelihood)
        });
        if accepted {
            std::mem::swap(machine, &mut other);
        }
        self.spare = Some(other);
        accepted
    }

    fn is_reachable(&mut self, machine: &Machine, symbols: usize) -> bool {
        let states = machine.states();
        self.reached.clear();
        self.reached.resize(states, false);
        self.reached[0] = true;
        self.stack.clear();
        self.stack.push(0);
        let mut count = 1;
        while let Some(state) = self.stack.pop() {
            let row = usize::from(state) * symbols;
            for &target in &machine.delta[row..row + symbols] {
                let reached = &mut self.reached[usize::from(target)];
                if !*reached {
                    *reached = true;
                    count += 1;
                    self.stack.push(target);
                }
            }
        }
        count == states
    }
}

/// Lets one edge lead elsewhere.
fn redirect(machine: &mut Machine, rng: &mut ChaCha8Rng) -> Option<f64> {
    let states = machine.states();
    if states == 1 {
        return None;
    }
    let edge = rng.random_range(0..machine.delta.len());
    let target = rng.random_range(0..states - 1) as u8;
    let old = machine.delta[edge];
    machine.delta[edge] = target + u8::from(target >= old);
    Some(0.0)
}

/// Swaps the targets of two edges with one symbol.
fn swap(machine: &mut Machine, symbols: usize, rng: &mut ChaCha8Rng) -> Option<f64> {
    let states = machine.states();
    let symbol = rng.random_range(0..symbols);
    let one = rng.random_range(0..states) * symbols + symbol;
    let other = rng.random_range(0..states) * symbols + symbol;
    machine.delta.swap(one, other);
    (machine.delta[one] != machine.delta[other]).then_some(0.0)
}

/// Gives one edge a target of its own that is a copy of the old one. The
/// language stays, so that what comes of the copy is found step by step.
fn split(machine: &mut Machine, ground: &Ground<'_>, rng: &mut ChaCha8Rng) -> Option<f64> {
    let states = machine.states();
    let symbols = ground.symbols;
    if states == ground.shape.most() {
        return None;
    }
    let edge = rng.random_range(0..machine.delta.len());
    let place = rng.random_range(1..=states);
    let target = usize::from(machine.delta[edge]);
    let row = target * symbols;
    for symbol in 0..symbols {
        machine.delta.push(machine.delta[row + symbol]);
    }
    machine.output.push(machine.output[target]);
    machine.delta[edge] = states as u8;
    exchange(machine, symbols, place, states);
    // There are as many times fewer ways to undo this as to do it as there are
    // symbols.
    Some((symbols as f64).ln())
}

/// The reverse of [`split`].
fn merge(machine: &mut Machine, symbols: usize, rng: &mut ChaCha8Rng) -> Option<f64> {
    let last = machine.states() - 1;
    if last == 0 {
        return None;
    }
    let place = rng.random_range(1..=last);
    exchange(machine, symbols, place, last);
    let other = rng.random_range(0..last);
    let (row, copy) = (other * symbols, last * symbols);
    let mut edges = (0..machine.delta.len()).filter(|&e| usize::from(machine.delta[e]) == last);
    let edge = edges.next().filter(|&edge| edge < copy)?;
    if edges.next().is_some() || machine.output[other] != machine.output[last] {
        return None;
    }
    machine.delta[edge] = other as u8;
    if machine.delta[row..row + symbols] != machine.delta[copy..copy + symbols] {
        return None;
    }
    machine.delta.truncate(copy);
    machine.output.truncate(last);
    Some(-(symbols as f64).ln())
}

/// Exchanges the numbers of two states, neither of them the start.
fn exchange(machine: &mut Machine, symbols: usize, one: usize, other: usize) {
    if one == other {
        return;
    }
    machine.output.swap(one, other);
    for symbol in 0..symbols {
        machine
            .delta
            .swap(one * symbols + symbol, other * symbols + symbol);
    }
    for target in &mut machine.delta {
        if usize::from(*target) == one {
            *target = other as u8;
        } else if usize::from(*target) == other {
            *target = one as u8;
        }
    }
}
