//! A sample of the posterior over automata of several sizes, carried on from
//! answer to answer: sequential Monte Carlo with Markov chain moves (Chopin,
//! "A sequential particle filter method for static models", 2002).

mod chain;
mod script;
mod shape;

use std::collections::BTreeMap;

use automata::{Dfa, Word};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use self::chain::{Ground, Machine, Mover};
use self::script::Script;
pub(crate) use self::script::Step;
use self::shape::Shape;
use super::completion::Table;
use super::spread::{Wish, breadth_first, is_minimal};
use crate::belief::{Belief, Heard};

/// How many machines there are.
const PARTICLES: usize = 128;
/// Rounds of moves after every answer; in all but the first two each particle is
/// counted.
const ROUNDS: usize = 10;
const SETTLING: usize = 2;
/// Moves of all particles together after every answer, for each edge of one.
const MOVES: usize = 4_000;
/// The largest automata that particles consider.
const LARGEST: usize = 40;

/// The particles, and what they have heard.
pub(crate) struct Particles {
    symbols: usize,
    seed: u64,
    decay: f64,
    shape: Shape,
    heard: Vec<Vec<Heard<Word>>>,
    script: Script,
    belief: Belief,
    machines: Vec<Machine>,
    /// How often each automaton was met in the last answer's rounds.
    counts: BTreeMap<Table, u32>,
}

impl Particles {
    /// Particles that heard nothing.
    pub(crate) fn new(symbols: usize, most: usize, decay: f64, seed: u64) -> Self {
        let mut particles = Self {
            symbols,
            seed,
            decay,
            shape: Shape::new(symbols, most.min(LARGEST), decay),
            heard: Vec::new(),
            script: Script::new(symbols),
            belief: Belief::new(0),
            machines: Vec::new(),
            counts: BTreeMap::new(),
        };
        let ground = particles.ground();
        let mut machines = Vec::new();
        for number in 0..PARTICLES {
            machines.push(Machine::new(
                vec![0; symbols],
                vec![number % 2 == 0],
                &ground,
            ));
        }
        particles.machines = machines;
        particles
    }

    fn ground(&self) -> Ground<'_> {
        Ground {
            shape: &self.shape,
            script: &self.script,
            belief: &self.belief,
            symbols: self.symbols,
        }
    }

    /// Whether what was heard is the beginning of this.
    pub(crate) fn precede(&self, wish: &Wish<'_, Word>) -> bool {
        self.seed == wish.seed
            && self.decay.to_bits() == wish.decay.to_bits()
            && wish.heard.starts_with(&self.heard)
    }

    /// Hears what is new in `heard`, answer by answer: where that leads does not
    /// depend on when it was heard.
    pub(crate) fn hear(&mut self, heard: &[Vec<Heard<Word>>]) {
        for answer in &heard[self.heard.len()..] {
            self.heard.push(answer.clone());
            for heard in answer {
                self.script.add(heard);
            }
            self.belief = Belief::new(self.script.len());
            self.weigh();
            let mut machines = std::mem::take(&mut self.machines);
            self.counts = self.travel(&mut machines);
            self.machines = machines;
        }
    }

    /// How often automata are met on the way from these, which are consistent;
    /// it has no part in what the particles come to.
    pub(crate) fn visit(&self, automata: &[Dfa]) -> BTreeMap<Table, u32> {
        let ground = self.ground();
        let small = automata
            .iter()
            .filter(|dfa| dfa.size() <= ground.shape.most());
        let machine = |dfa: &Dfa| {
            let (delta, output) = table(dfa);
            Machine::new(delta.iter().map(|&t| t as u8).collect(), output, &ground)
        };
        let mut machines: Vec<Machine> = small.map(machine).collect();
        let found = machines.len().min(PARTICLES);
        for place in found..if found == 0 { 0 } else { PARTICLES } {
            machines.push(machines[place % found].clone());
        }
        self.travel(&mut machines)
    }

    fn rng(&self) -> ChaCha8Rng {
        let mut rng = ChaCha8Rng::seed_from_u64(self.seed);
        rng.set_stream(self.heard.len() as u64);
        rng
    }

    /// Hears, and draws the particles anew by how well they explain what is new.
    fn weigh(&mut self) {
        let mut machines = std::mem::take(&mut self.machines);
        let before: Vec<f64> = machines.iter().map(|m| m.likelihood).collect();
        let ground = self.ground();
        for machine in &mut machines {
            machine.hear(&ground);
        }
        let gains: Vec<f64> = (machines.iter().zip(before))
            .map(|(machine, before)| machine.likelihood - before)
            .collect();
        let top = gains.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let weights: Vec<f64> = gains.iter().map(|gain| (gain - top).exp()).collect();
        let step = weights.iter().sum::<f64>() / machines.len() as f64;
        let mut next = self.rng().random::<f64>() * step;
        let mut sum = 0.0;
        let mut drawn = Vec::with_capacity(machines.len());
        for (machine, weight) in machines.iter().zip(weights) {
            sum += weight;
            while sum > next && drawn.len() < machines.len() {
                drawn.push(machine.clone());
                next += step;
            }
        }
        while drawn.len() < machines.len() {
            drawn.push(machines[machines.len() - 1].clone());
        }
        self.machines = drawn;
    }

    /// Moves all machines and counts where they are.
    fn travel(&self, machines: &mut [Machine]) -> BTreeMap<Table, u32> {
        let mut rng = self.rng();
        let _: f64 = rng.random();
        let mut counts = BTreeMap::new();
        let ground = self.ground();
        let mut mover = Mover::default();
        let moves: usize = std::env::var("MOVES")
            .ok()
            .and_then(|v| v.parse().ok())
            .unwrap_or(MOVES);
        let edges: usize = machines.iter().map(|machine| machine.delta.len()).sum();
        let moves = moves * edges / PARTICLES / PARTICLES / ROUNDS;
        for round in 0..ROUNDS {
            for machine in &mut *machines {
                for _ in 0..moves {
                    mover.step(machine, &ground, &mut rng);
                }
                if round >= SETTLING && !machine.tally.is_refuted() {
                    let delta = machine.delta.iter().map(|&t| u32::from(t)).collect();
                    let table: Table = (delta, machine.output.clone());
                    if is_minimal(&table) {
                        *counts.entry(breadth_first(&table)).or_insert(0) += 1;
                    }
                }
            }
        }
        counts
    }

    /// The automata met, with how often.
    pub(crate) fn met(&self) -> &BTreeMap<Table, u32> {
        &self.counts
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

/// The posterior of single automata.
pub(crate) struct Posterior {
    symbols: usize,
    shape: Shape,
    script: Script,
    belief: Belief,
}

impl Posterior {
    /// After all that was heard.
    pub(crate) fn new(symbols: usize, most: usize, wish: &Wish<'_, Word>) -> Self {
        let mut script = Script::new(symbols);
        for heard in wish.heard.iter().flatten() {
            script.add(heard);
        }
        Self {
            symbols,
            shape: Shape::new(symbols, most.min(LARGEST), wish.decay),
            belief: Belief::new(script.len()),
            script,
        }
    }

    /// The logarithm of the chance of a minimal automaton, up to a number that
    /// all share.
    pub(crate) fn log_chance(&self, (delta, output): &Table) -> f64 {
        let ground = Ground {
            shape: &self.shape,
            script: &self.script,
            belief: &self.belief,
            symbols: self.symbols,
        };
        if output.len() > self.shape.most() {
            // Beyond, larger ones are given no chance beside smaller ones.
            return f64::from(u8::MAX) * -(output.len() as f64);
        }
        let delta = delta.iter().map(|&target| target as u8).collect();
        let numberings: f64 = (1..output.len()).map(|n| (n as f64).ln()).sum();
        Machine::new(delta, output.clone(), &ground).log_chance() + numberings
    }
}
