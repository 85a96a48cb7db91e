//! One Markov chain over numbered tables, whose stationary distribution is the
//! posterior: Metropolis and Hastings' moves, among them some between sizes
//! (Green's reversible jumps).

use rand::RngExt;
use rand_chacha::ChaCha8Rng;

use super::LARGEST;
use super::memo::{self, Memo};
use super::plan::{Plan, Run};
use super::shape::Shape;
use crate::belief::Belief;

/// A complete table all of whose states are reachable, and how it stands.
#[derive(Clone, Debug)]
pub(crate) struct Machine {
    pub(crate) delta: Vec<u8>,
    pub(crate) output: Vec<bool>,
    pub(crate) standing: Standing,
}

/// How a table stands to what is believed and to what was heard.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Standing {
    /// The logarithm of its prior.
    prior: f64,
    /// The logarithm of the likelihood.
    pub(crate) likelihood: f64,
    /// Whether something certain is not true of it.
    pub(crate) refuted: bool,
}

/// What all chains share.
pub(crate) struct Ground<'a> {
    pub(crate) shape: &'a Shape,
    pub(crate) plan: &'a Plan,
    pub(crate) belief: &'a Belief,
    pub(crate) symbols: usize,
}

impl Ground<'_> {
    /// How a table stands all of whose states are reachable.
    fn judge(&self, delta: &[u8], output: &[bool], run: &mut Run) -> Standing {
        let tally = self.plan.tally(delta, output, run);
        Standing {
            prior: self.shape.log_prior(delta, output.len()),
            likelihood: self.belief.log_chance(&tally),
            refuted: tally.is_refuted(),
        }
    }
}

impl Machine {
    pub(crate) fn new(delta: Vec<u8>, output: Vec<bool>, ground: &Ground<'_>) -> Self {
        let standing = ground.judge(&delta, &output, &mut Run::default());
        Self {
            delta,
            output,
            standing,
        }
    }

    /// The logarithm of its share of the posterior, up to a number that all
    /// share.
    pub(crate) fn log_chance(&self) -> f64 {
        self.standing.prior + self.standing.likelihood
    }

    pub(crate) fn states(&self) -> usize {
        self.output.len()
    }
}

/// Of a new state's edges, the share that is copied.
const COPIED: f64 = 0.6;
/// The chance that a new state's output is copied.
const SAME_OUTPUT: f64 = 0.7;

/// Moves machines on one ground.
pub(crate) struct Mover {
    spare: Option<Machine>,
    run: Run,
    odds: Odds,
    /// None of what not all states of can be reached.
    memo: Memo<Option<Standing>, 12>,
}

impl Mover {
    pub(crate) fn new(ground: &Ground<'_>) -> Self {
        Self {
            spare: None,
            run: Run::default(),
            odds: Odds::new(ground),
            memo: Memo::default(),
        }
    }

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
            50..58 => swap(&mut other, ground.symbols, rng),
            58..70 => {
                let state = rng.random_range(0..other.states());
                other.output[state] ^= true;
                Some(0.0)
            }
            70..85 => split(&mut other, ground, &self.odds, rng),
            _ => merge(&mut other, ground.symbols, &self.odds, rng),
        };
        let accepted = bonus.is_some_and(|bonus| {
            let Some(standing) = self.judge(&other, ground) else {
                return false;
            };
            let allowed = bonus + standing.prior - machine.standing.prior;
            let gained = standing.likelihood - machine.standing.likelihood;
            other.standing = standing;
            is_drawn(allowed + power * gained, rng)
        });
        if accepted {
            std::mem::swap(machine, &mut other);
        }
        self.spare = Some(other);
        accepted
    }

    /// How a table stands that may have been judged before: chains come back to what
    /// they refused. None if not all of its states are reachable.
    fn judge(&mut self, machine: &Machine, ground: &Ground<'_>) -> Option<Standing> {
        let key = memo::key(&machine.delta, &machine.output);
        if let Some(known) = key.and_then(|key| self.memo.get(key)) {
            return known;
        }
        let standing = is_reachable(machine, ground.symbols)
            .then(|| ground.judge(&machine.delta, &machine.output, &mut self.run));
        if let Some(key) = key {
            self.memo.keep(key, standing);
        }
        standing
    }
}

/// Whether what has a chance of this logarithm happens; where that is not below zero,
/// it does.
pub(super) fn is_drawn(log_chance: f64, rng: &mut ChaCha8Rng) -> bool {
    // In any case, so that what is drawn later does not go by it.
    let drawn = rng.random::<f64>();
    log_chance >= 0.0 || drawn.ln() < log_chance
}

/// Whether every state can be reached from the first.
fn is_reachable(machine: &Machine, symbols: usize) -> bool {
    const { assert!(LARGEST < u64::BITS as usize) };
    let mut reached: u64 = 1;
    let mut left = reached;
    while left != 0 {
        let row = left.trailing_zeros() as usize * symbols;
        let row = &machine.delta[row..row + symbols];
        let targets = row.iter().fold(0, |targets, &to| targets | 1 << to);
        left = (left & (left - 1)) | (targets & !reached);
        reached |= targets;
    }
    reached.count_ones() as usize == machine.states()
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

/// Lets some of the edges into a state lead to a new one, whose row is partly a
/// copy of the old state's and partly drawn.
fn split(
    machine: &mut Machine,
    ground: &Ground<'_>,
    odds: &Odds,
    rng: &mut ChaCha8Rng,
) -> Option<f64> {
    let states = machine.states();
    let symbols = ground.symbols;
    if states == ground.shape.most() {
        return None;
    }
    let old = rng.random_range(0..states);
    let leads_there = |target: &&mut u8| usize::from(**target) == old;
    let into = machine.delta.iter_mut().filter(leads_there).count();
    if into == 0 {
        return None;
    }
    let row = old * symbols..(old + 1) * symbols;
    machine.delta.extend_from_within(row);
    let (before, new) = machine.delta.split_at_mut(states * symbols);
    let mut edges = before.iter_mut().filter(leads_there);
    let mut moved = 0;
    if rng.random() {
        if let Some(edge) = edges.nth(rng.random_range(0..into)) {
            *edge = states as u8;
        }
        moved = 1;
    } else {
        for edge in edges {
            if rng.random() {
                *edge = states as u8;
                moved += 1;
            }
        }
    }
    if moved == 0 {
        return None;
    }
    for target in new {
        if rng.random::<f64>() >= COPIED {
            *target = rng.random_range(0..=states) as u8;
        } else if usize::from(*target) == old && rng.random() {
            *target = states as u8;
        }
    }
    let output = machine.output[old] ^ (rng.random::<f64>() >= SAME_OUTPUT);
    machine.output.push(output);
    let chance = odds.split_chance(machine, symbols, old, [moved, into]);
    exchange(machine, symbols, rng.random_range(1..=states), states);
    Some(-chance)
}

/// The reverse of [`split`].
fn merge(machine: &mut Machine, symbols: usize, odds: &Odds, rng: &mut ChaCha8Rng) -> Option<f64> {
    let last = machine.states() - 1;
    if last == 0 {
        return None;
    }
    exchange(machine, symbols, rng.random_range(1..=last), last);
    let old = rng.random_range(0..last);
    let mut moved = 0;
    let mut into = 0;
    for edge in 0..last * symbols {
        let target = usize::from(machine.delta[edge]);
        moved += usize::from(target == last);
        into += usize::from(target == last || target == old);
    }
    let chance = odds.split_chance(machine, symbols, old, [moved, into]);
    for target in &mut machine.delta {
        if usize::from(*target) == last {
            *target = old as u8;
        }
    }
    machine.delta.truncate(last * symbols);
    machine.output.truncate(last);
    Some(chance)
}

/// The logarithms of the chances of what [`split`] draws: it is asked for at every
/// third step.
struct Odds {
    /// Of the edges that were moved, by the number of those that might have been and by
    /// whether it was one only.
    moved: Vec<[f64; 2]>,
    /// Of a new state's edge, by the number of states with it, and by how many halves of
    /// the copied edge lead where it does.
    edge: Vec<[f64; 3]>,
    /// Of its output, by whether that is copied.
    output: [f64; 2],
}

impl Odds {
    fn new(ground: &Ground<'_>) -> Self {
        let most = ground.shape.most();
        let moved = |into: usize| {
            let into = into as f64;
            [0.0, 0.5 / into].map(|one: f64| (one + 0.5 * (-into).exp2()).ln())
        };
        let edge = |states: usize| {
            let drawn = (1.0 - COPIED) / states as f64;
            [0.0, 0.5, 1.0].map(|copy: f64| (COPIED * copy + drawn).ln())
        };
        Self {
            moved: (0..=most * ground.symbols).map(moved).collect(),
            edge: (0..=most).map(edge).collect(),
            output: [1.0 - SAME_OUTPUT, SAME_OUTPUT].map(f64::ln),
        }
    }

    /// The logarithm of the chance with which [`split`] draws the last state of a
    /// machine from state `old`, which had so many edges into it, of which so many were
    /// moved.
    fn split_chance(
        &self,
        machine: &Machine,
        symbols: usize,
        old: usize,
        [moved, into]: [usize; 2],
    ) -> f64 {
        let last = machine.states() - 1;
        let mut chance = self.moved[into][usize::from(moved == 1)];
        let edge = &self.edge[machine.states()];
        let row = &machine.delta[old * symbols..(old + 1) * symbols];
        let new = &machine.delta[last * symbols..];
        for (&target, &copied) in new.iter().zip(row) {
            let (target, copied) = (usize::from(target), usize::from(copied));
            // An edge of the old state that was moved had led to itself.
            let halves = if copied == old || copied == last {
                usize::from(target == old || target == last)
            } else {
                2 * usize::from(target == copied)
            };
            chance += edge[halves];
        }
        let same = machine.output[last] == machine.output[old];
        chance + self.output[usize::from(same)]
    }
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
