//! A sample of the posterior over automata of several sizes, carried on from
//! answer to answer: Markov chains at several temperatures that exchange their
//! places (parallel tempering: Geyer, "Markov chain Monte Carlo maximum
//! likelihood", 1991).

mod chain;
mod guide;
mod memo;
mod places;
mod plan;
mod script;
mod shape;
mod visits;

use std::collections::BTreeMap;
use std::sync::Arc;

use automata::{Alphabet, Word};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

use self::chain::{Ground, Machine, Mover, is_drawn};
use self::guide::Guide;
use self::places::Places;
pub(crate) use self::plan::Pace;
use self::plan::Plan;
use self::script::Script;
use self::shape::Shape;
use self::visits::Visits;
use super::completion::Table;
use super::spread::Wish;
use crate::belief::{Belief, Heard};
use crate::evidence::Stop;

/// The powers to which the likelihood is raised: hot chains roam, and bring the
/// cold ones what they find.
const LEVELS: [f64; 8] = [1.0, 0.8, 0.62, 0.47, 0.35, 0.25, 0.17, 0.1];
/// Of so many of the levels what is visited counts.
const COLD: usize = 3;
/// Chains of each level.
const LADDERS: usize = 8;
/// Moves of a cold chain, and of another, before it may exchange its place.
const LEG: [usize; 2] = [24, 12];
/// Such legs of every chain before the ladders are looked at.
const LEGS: usize = 16;
/// They go on, at most so many times as long, until that many ladders came to
/// automata whose likeliest is within this logarithm of the likeliest of all.
const MOST: usize = 6;
const AGREEING: usize = 5;
const NEAR: f64 = 3.0;
/// So many steps of words on tables are taken after an answer, more or less: where
/// what was heard is long, chains go on for fewer legs, and less often.
const STEPS: usize = 150_000_000;
/// Fewer legs than these are never made.
const FEWEST: usize = 4;
/// After so many answers in a row on which they never did, they are astray.
const PATIENCE: usize = 12;
/// A ladder is stuck if the best automaton in it is less likely than that of
/// another by this logarithm.
const HOPELESS: f64 = 6.0;
/// The largest automata that are considered.
const LARGEST: usize = 40;

/// The chains, and what they have heard.
#[derive(Clone)]
pub(crate) struct Particles {
    symbols: usize,
    seed: u64,
    decay: f64,
    shape: Shape,
    heard: Vec<Vec<Heard<Word>>>,
    script: Script,
    belief: Belief,
    guide: Guide,
    /// The stage at the start and after every answer, so that an answer can be
    /// taken back; clones share what they have in common.
    past: Vec<Arc<Stage>>,
    /// The consistent automata met since the last answer, with their shares of the
    /// posterior, up to a number that all share.
    met: BTreeMap<Table, f64>,
}

/// What goes on from one answer to the next.
struct Stage {
    /// The table at which every chain is, by ladder and level.
    places: Places,
    /// The size that the guide knows to be needed.
    at_least: usize,
    /// Of the last answers, on how many in a row the ladders disagreed.
    astray: usize,
}

impl Particles {
    /// Chains that heard nothing.
    pub(crate) fn new(alphabet: &Alphabet, most: usize, decay: f64, seed: u64) -> Self {
        let symbols = alphabet.len();
        let trivial = |chain: usize| {
            let accepts = (chain % LEVELS.len()).is_multiple_of(2);
            (vec![0; symbols], vec![accepts])
        };
        let places = Places::new(symbols, (0..LADDERS * LEVELS.len()).map(trivial));
        Self {
            symbols,
            seed,
            decay,
            shape: Shape::new(symbols, most.min(LARGEST), decay),
            heard: Vec::new(),
            script: Script::new(symbols),
            belief: Belief::new(0),
            guide: Guide::new(alphabet.clone()),
            past: vec![Arc::new(Stage {
                places,
                at_least: 1,
                astray: 0,
            })],
            met: BTreeMap::new(),
        }
    }

    /// Whether these chains can go on to what is wished.
    pub(crate) fn serve(&self, wish: &Wish<'_, Word>) -> bool {
        self.seed == wish.seed && self.decay.to_bits() == wish.decay.to_bits()
    }

    /// Hears `heard`, answer by answer; what was heard before and is not in it is
    /// forgotten. Where that leads does not depend on what was heard before.
    /// `false` if it was stopped before all was heard.
    pub(crate) fn hear(&mut self, heard: &[Vec<Heard<Word>>], stop: &Stop) -> bool {
        let mut common = (self.heard.iter().zip(heard))
            .take_while(|(one, other)| one == other)
            .count();
        if common < self.heard.len() {
            // What was met after the last common answer is not kept: it is heard
            // once more.
            common = common.saturating_sub(1);
            self.met.clear();
            self.heard.truncate(common);
            self.past.truncate(common + 1);
            self.script = Script::new(self.symbols);
            self.guide.restart(self.past[common].at_least);
            for heard in self.heard.iter().flatten() {
                self.script.add(heard);
                self.guide.add(heard);
            }
        }
        for answer in &heard[common..] {
            if stop.is_set() {
                return false;
            }
            self.heard.push(answer.clone());
            for heard in answer {
                self.script.add(heard);
                self.guide.add(heard);
            }
            self.belief = Belief::new(self.script.len());
            let (stage, met) = self.travel();
            self.past.push(Arc::new(stage));
            self.met = met;
        }
        true
    }

    /// Where all chains come to from where they were, and what they meet.
    fn travel(&mut self) -> (Stage, BTreeMap<Table, f64>) {
        let mut rng = ChaCha8Rng::seed_from_u64(self.seed);
        rng.set_stream(self.heard.len() as u64);
        let plan = self.script.plan();
        let ground = Ground {
            shape: &self.shape,
            plan: &plan,
            belief: &self.belief,
            symbols: self.symbols,
        };
        let start = self.past.last().expect("the start is never taken back");
        let mut at = start.places.tables();
        let mut machines: Vec<[Machine; LEVELS.len()]> = (0..LADDERS)
            .map(|_| {
                std::array::from_fn(|_| {
                    let (delta, output) = at.next().expect("every chain is somewhere");
                    Machine::new(delta, output, &ground)
                })
            })
            .collect();
        let mut mover = Mover::new(&ground);
        let mut visits = Visits::default();
        let mut guiding = None;
        let (rounds, legs) = effort(plan.nodes());
        for _ in 0..rounds {
            for (number, ladder) in machines.iter_mut().enumerate() {
                let mut visit = |machine: &Machine| visits.add(number, machine);
                travel(ladder, legs, &mut mover, &ground, &mut rng, &mut visit);
            }
            if visits.agree() {
                break;
            }
            let guide = &mut self.guide;
            let found = guiding.get_or_insert_with(|| guide.find(&ground, self.seed));
            if let Some(found) = found {
                follow(&mut machines, found);
            }
        }
        let astray = if visits.agree() { 0 } else { start.astray + 1 };
        let met = visits.shares();
        migrate(&mut machines);
        let place = |machine: Machine| (machine.delta, machine.output);
        let stage = Stage {
            places: Places::new(self.symbols, machines.into_iter().flatten().map(place)),
            at_least: self.guide.at_least(),
            astray,
        };
        (stage, met)
    }

    /// Whether the chains found no likely place for so long that nothing should be
    /// built on what they met.
    pub(crate) fn are_astray(&self) -> bool {
        self.past
            .last()
            .is_some_and(|stage| stage.astray >= PATIENCE)
    }

    /// The consistent automata met since the last answer, with their shares of the
    /// posterior, up to a number that all share.
    pub(crate) fn met(&self) -> &BTreeMap<Table, f64> {
        &self.met
    }
}

/// How often the chains may go on, and for how many legs each time, where what was
/// heard is a tree with so many nodes.
fn effort(nodes: usize) -> (usize, usize) {
    let leg = LADDERS * (COLD * LEG[0] + (LEVELS.len() - COLD) * LEG[1]) * nodes;
    let legs = STEPS / leg.max(1);
    let rounds = (legs / LEGS).clamp(1, MOST);
    (rounds, legs.clamp(FEWEST, LEGS))
}

/// Lets the chains of a ladder make their moves, so many legs, and shows where the
/// cold ones come to.
fn travel(
    ladder: &mut [Machine; LEVELS.len()],
    legs: usize,
    mover: &mut Mover,
    ground: &Ground<'_>,
    rng: &mut ChaCha8Rng,
    visit: &mut impl FnMut(&Machine),
) {
    for leg in 0..legs {
        for (level, machine) in ladder.iter_mut().enumerate() {
            let cold = level < COLD;
            for step in 0..LEG[usize::from(!cold)] {
                let moved = mover.step(machine, LEVELS[level], ground, rng);
                if cold && (moved || step == 0) {
                    visit(machine);
                }
            }
        }
        // Neighbours exchange their places, even and odd in turn.
        for level in (leg % 2..LEVELS.len() - 1).step_by(2) {
            let gain = ladder[level + 1].standing.likelihood - ladder[level].standing.likelihood;
            let chance = (LEVELS[level] - LEVELS[level + 1]) * gain;
            if is_drawn(chance, rng) {
                ladder.swap(level, level + 1);
            }
        }
    }
}

/// The chance of the likeliest machine of a ladder, as a logarithm.
fn best(ladder: &[Machine; LEVELS.len()]) -> f64 {
    (ladder.iter().map(Machine::log_chance)).fold(f64::NEG_INFINITY, f64::max)
}

/// The places of the ladders that are worst off and best off.
fn extremes(machines: &[[Machine; LEVELS.len()]]) -> Option<[usize; 2]> {
    let order =
        |one: &usize, other: &usize| best(&machines[*one]).total_cmp(&best(&machines[*other]));
    let worst = (0..machines.len()).min_by(order)?;
    Some([worst, (0..machines.len()).max_by(order)?])
}

/// Lets the ladder that is worst off go on from what the guide found.
fn follow(machines: &mut [[Machine; LEVELS.len()]], found: &Machine) {
    if let Some([worst, _]) = extremes(machines)
        && found.log_chance() - best(&machines[worst]) > HOPELESS
    {
        machines[worst][0] = found.clone();
    }
}

/// Lets the ladder that is worst off start from where the best one is.
fn migrate(machines: &mut [[Machine; LEVELS.len()]]) {
    if let Some([worst, top]) = extremes(machines)
        && best(&machines[top]) - best(&machines[worst]) > HOPELESS
    {
        let top = machines[top].clone();
        machines[worst] = top;
    }
}

/// The logarithm of the number of ways to number all states but the first.
fn numberings(states: usize) -> f64 {
    (1..states).map(|n| (n as f64).ln()).sum()
}

/// The posterior of single automata.
pub(crate) struct Posterior {
    symbols: usize,
    shape: Shape,
    plan: Plan,
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
            plan: script.plan(),
        }
    }

    /// The logarithm of the chance of a minimal automaton, up to a number that
    /// all share.
    pub(crate) fn log_chance(&self, (delta, output): &Table) -> f64 {
        let ground = Ground {
            shape: &self.shape,
            plan: &self.plan,
            belief: &self.belief,
            symbols: self.symbols,
        };
        if output.len() > self.shape.most() {
            // Beyond, larger ones are given no chance beside smaller ones.
            return f64::from(u8::MAX) * -(output.len() as f64);
        }
        let delta = delta.iter().map(|&target| target as u8).collect();
        Machine::new(delta, output.clone(), &ground).log_chance() + numberings(output.len())
    }
}
