//! The consistent automata of several sizes, each with its prior weight: listed
//! where there are few, otherwise drawn.

use std::collections::BTreeMap;

use automata::{Dfa, Word};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

use super::Sample;
use super::completion::{Table, canonical};
use super::grow::{Grower, Hint};
use super::growth::{Growth, Manner, add_logs};
use super::instance::Instance;
use super::problem::{FactId, Problem};
use super::tree::NodeId;
use crate::evidence::{Budget, Comparison};

/// How two atoms end, as a concept has it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ending {
    /// Only the first is in the concept.
    FirstOnly,
    /// Only the second is.
    SecondOnly,
    /// Both end in the same place of the concept (for automata: a state).
    SamePlace,
    /// Both are in the concept or neither is, but they end in different places.
    SameLabel,
}

impl Ending {
    /// All of them, in the order of their numbers.
    pub const ALL: [Self; 4] = [
        Self::FirstOnly,
        Self::SecondOnly,
        Self::SamePlace,
        Self::SameLabel,
    ];

    /// Of atoms with these labels.
    pub fn of(first: bool, second: bool, same_place: bool) -> Self {
        match (first, second) {
            (true, false) => Self::FirstOnly,
            (false, true) => Self::SecondOnly,
            _ if same_place => Self::SamePlace,
            _ => Self::SameLabel,
        }
    }
}

/// How a teacher is believed to answer comparisons.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Odds {
    /// The chance that two atoms with different labels are called incomparable.
    pub incomparable: f64,
    /// The chances of a strict answer (either way), a tie, and incomparability
    /// for two atoms that end in the same place.
    pub same_place: [f64; 3],
    /// The same for two atoms of one label that end in different places.
    pub same_label: [f64; 3],
}

/// The chance of an answer that no teacher who respects membership gives.
const SLIP: f64 = 1e-9;

impl Odds {
    /// The chance of an answer about atoms that end like this.
    pub fn chance(&self, ending: Ending, answer: Comparison) -> f64 {
        let shared = |odds: &[f64; 3]| match answer {
            Comparison::First | Comparison::Second => odds[0] / 2.0,
            Comparison::Equal => odds[1],
            Comparison::Incomparable => odds[2],
        };
        match (ending, answer) {
            (Ending::SamePlace, _) => shared(&self.same_place),
            (Ending::SameLabel, _) => shared(&self.same_label),
            (_, Comparison::Incomparable) => self.incomparable,
            (Ending::FirstOnly, Comparison::First) | (Ending::SecondOnly, Comparison::Second) => {
                1.0 - self.incomparable
            }
            _ => SLIP,
        }
    }
}

/// What is wanted of a [`Spread`].
#[derive(Clone, Debug)]
pub struct Wish<'a, A> {
    /// The number of sizes, from the smallest consistent one.
    pub sizes: usize,
    /// The prior of a size over that of the size before.
    pub decay: f64,
    /// As many concepts of a size are listed at most.
    pub listed: usize,
    /// As many are drawn otherwise, all sizes together.
    pub draws: usize,
    /// Answers to comparisons, which draws are to heed.
    pub answers: &'a [(A, A, Comparison)],
    /// What the answers are believed to say.
    pub odds: &'a Odds,
    /// Decides what is drawn.
    pub seed: u64,
    /// The work that listing and drawing may do, once a smallest concept is
    /// known. Always as much, so that what an earlier search remembers cannot
    /// show in what is drawn.
    pub work: u64,
}

/// A consistent concept with its weight.
#[derive(Clone, Debug, PartialEq)]
pub struct Weighted<C> {
    /// The concept.
    pub concept: C,
    /// The logarithm of its prior. For a drawn one, divided by the chance with
    /// which it was drawn, so that the sum over the spread of weight times
    /// anything is an unbiased estimate of the sum over all concepts.
    pub log_weight: f64,
}

/// Consistent concepts of several sizes; no two contain the same atoms.
#[derive(Clone, Debug)]
pub struct Spread<C> {
    /// The concepts, in an order that says nothing.
    pub concepts: Vec<Weighted<C>>,
    /// Whether these are all concepts of these sizes.
    pub exact: bool,
    /// Whether the work ended before all draws were made.
    pub hurried: bool,
}

/// Nodes of the search that a listing may take for each automaton wanted.
const NODES_PER_LISTED: u64 = 6;
/// With fewer different automata drawn, those that a search found are taken.
const BARREN: usize = 16;
/// Draws of each manner by which the number of automata of a size is guessed.
const GUESSES: usize = 32;

/// Automata of one size, by table: the sums of their weights.
type Weights = BTreeMap<(Vec<u32>, Vec<bool>), f64>;

/// The spread of the facts `standing`, with which `smallest` are consistent and
/// nothing smaller; nothing with more than `bound` states is wanted. None if no
/// language is consistent.
pub(crate) fn gather(
    problem: &mut Problem,
    standing: &[FactId],
    smallest: &Sample,
    bound: usize,
    wish: &Wish<'_, Word>,
) -> Option<Spread<Dfa>> {
    let mut work = Budget::new(wish.work);
    let budget = &mut work;
    let words: Vec<NodeId> = (wish.answers.iter())
        .flat_map(|(first, second, _)| [first, second])
        .map(|word| problem.insert(word))
        .collect();
    let (instance, nodes) = Instance::with_words(problem, standing, &words)?;
    let hints: Vec<Hint> = (wish.answers.iter().zip(nodes.chunks_exact(2)))
        .map(|(&(_, _, answer), pair)| Hint::new(pair[0], pair[1], answer, wish.odds))
        .collect();
    let least = smallest.automata.first()?.size();
    let most = (least + wish.sizes.max(1) - 1).min(bound.max(least));
    let mut spread = Spread {
        concepts: Vec::new(),
        exact: true,
        hurried: false,
    };
    let mut parts: Vec<Part<'_>> = (least..=most)
        .map(|states| Part::new(&instance, &hints, states, wish.seed))
        .collect();
    for part in &mut parts {
        if part.states == least && smallest.complete {
            part.adopt(&smallest.automata);
            continue;
        }
        part.draw(GUESSES, budget);
        part.try_listing(wish.listed, budget);
        if part.states == least && part.is_barren() {
            // Draws miss them; a search did not. It tells of no more than it
            // found, so the larger sizes may be overrated.
            part.adopt(&smallest.automata);
            spread.exact = false;
        }
    }
    // The sizes that matter get the draws.
    let prior = |part: &Part<'_>| (part.states - least) as f64 * wish.decay.ln();
    let masses: Vec<f64> = (parts.iter())
        .map(|part| prior(part) + part.mass(wish))
        .collect();
    let top = masses.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let shares: Vec<f64> = masses.iter().map(|mass| (mass - top).exp()).collect();
    let all: f64 = shares.iter().sum();
    for (part, share) in parts.iter_mut().zip(shares) {
        if part.listed.is_none() && top > f64::NEG_INFINITY {
            let draws = (wish.draws as f64 * share / all / 2.0).ceil();
            part.draw(draws as usize, budget);
        }
        spread.exact &= part.listed.is_some();
    }
    spread.hurried = budget.is_spent();
    let alphabet = problem.alphabet();
    for part in parts {
        let prior = prior(&part);
        for (table, weight) in part.weights() {
            spread.concepts.push(Weighted {
                concept: canonical(alphabet, &table),
                log_weight: prior + weight,
            });
        }
    }
    Some(spread)
}

/// The automata of one size.
struct Part<'a> {
    states: usize,
    grower: Grower<'a>,
    growths: [Growth; 2],
    rng: ChaCha8Rng,
    /// For each manner the number of draws, also of those that led nowhere.
    draws: [usize; 2],
    /// The weights of what was drawn by each manner, but for the number of
    /// draws.
    drawn: [Weights; 2],
    /// An unbiased estimate of the number of automata, summed over the draws of
    /// the first manner.
    number: f64,
    listed: Option<Weights>,
}

impl<'a> Part<'a> {
    fn new(instance: &'a Instance, hints: &'a [Hint], states: usize, seed: u64) -> Self {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        rng.set_stream(states as u64);
        Self {
            states,
            grower: Grower::new(instance, states, hints),
            growths: Manner::ALL.map(|manner| Growth::new(manner, states, instance.symbols)),
            rng,
            draws: [0; 2],
            drawn: [Weights::new(), Weights::new()],
            number: 0.0,
            listed: None,
        }
    }

    /// So many draws of each manner.
    fn draw(&mut self, draws: usize, budget: &mut Budget) {
        for manner in 0..2 {
            for _ in 0..draws {
                if budget.is_spent() {
                    return;
                }
                self.draws[manner] += 1;
                let growth = &self.growths[manner];
                let dive = self.grower.dive(growth, &mut self.rng, budget);
                let Some(dive) = dive else { continue };
                if manner == 0 {
                    self.number += (-dive.log_chance).exp();
                }
                if !is_minimal(&dive.table) {
                    continue;
                }
                let table = breadth_first(&dive.table);
                let prior = growth.table(&table.0) - dive.log_chance;
                let weight = self.drawn[manner].entry(table).or_insert(f64::NEG_INFINITY);
                *weight = add_logs(*weight, prior);
            }
        }
    }

    /// Lists the automata if there seem to be few.
    fn try_listing(&mut self, most: usize, budget: &mut Budget) {
        let hits = self.drawn.iter().map(BTreeMap::len).sum::<usize>();
        let number = self.number / self.draws[0].max(1) as f64;
        if hits > 0 && number > 2.0 * most as f64 {
            return;
        }
        let nodes = (most as u64 * NODES_PER_LISTED).min(budget.left());
        let mut share = Budget::new(nodes);
        let mut listed = Weights::new();
        let growths = &self.growths;
        let ended = self.grower.list(&mut share, &mut |table| {
            if is_minimal(table) {
                let table = breadth_first(table);
                let weight = prior(growths, &table);
                listed.insert(table, weight);
            }
            listed.len() <= most
        });
        // What was taken of the share is taken of the budget.
        let within = budget.spend(nodes - share.left());
        if ended && within {
            self.listed = Some(listed);
        }
    }

    /// Whether draws lead nowhere.
    fn is_barren(&self) -> bool {
        let hits: usize = self.drawn.iter().map(BTreeMap::len).sum();
        self.listed.is_none() && hits < BARREN
    }

    /// Takes these, which are minimal and numbered breadth first, for all there
    /// are.
    fn adopt(&mut self, automata: &[Dfa]) {
        let weighted = |dfa: &Dfa| {
            let delta = dfa.states().flat_map(|state| {
                let targets = dfa.alphabet().symbols().map(move |a| dfa.next(state, a));
                targets.map(|target| target.index() as u32)
            });
            let table: Table = (
                delta.collect(),
                dfa.states().map(|state| dfa.is_accepting(state)).collect(),
            );
            let weight = self.prior(&table);
            (table, weight)
        };
        self.listed = Some(automata.iter().map(weighted).collect());
    }

    /// The logarithm of a table's prior within its size, but for the outputs.
    fn prior(&self, table: &Table) -> f64 {
        prior(&self.growths, table)
    }

    /// The logarithm of the prior of all these automata together, each times
    /// the chance of the answers.
    fn mass(&self, wish: &Wish<'_, Word>) -> f64 {
        (self.weights().iter())
            .map(|(table, weight)| weight + log_chance(table, wish))
            .fold(f64::NEG_INFINITY, add_logs)
    }

    /// The logarithms of the weights, within this size.
    fn weights(&self) -> Weights {
        let mut weights = Weights::new();
        // Either output of every state is as likely as the other.
        let outputs = -(self.states as f64) * std::f64::consts::LN_2;
        if let Some(listed) = &self.listed {
            weights.clone_from(listed);
            weights.values_mut().for_each(|weight| *weight += outputs);
            return weights;
        }
        for (drawn, &draws) in self.drawn.iter().zip(&self.draws) {
            // Each manner is half of the prior.
            let shift = outputs - std::f64::consts::LN_2 - (draws.max(1) as f64).ln();
            for (table, weight) in drawn {
                let sum = weights.entry(table.clone()).or_insert(f64::NEG_INFINITY);
                *sum = add_logs(*sum, weight + shift);
            }
        }
        weights
    }
}

/// Each manner is half of the prior.
fn prior(growths: &[Growth; 2], (delta, _): &Table) -> f64 {
    let [even, staying] = growths.each_ref().map(|growth| growth.table(delta));
    add_logs(even, staying) - std::f64::consts::LN_2
}

/// The logarithm of the chance of the answers, if this is the concept.
fn log_chance((delta, output): &Table, wish: &Wish<'_, Word>) -> f64 {
    let symbols = delta.len() / output.len();
    let end = |word: &Word| {
        word.iter().fold(0, |state, symbol| {
            delta[state * symbols + symbol.index()] as usize
        })
    };
    let of = |(first, second, answer): &(Word, Word, Comparison)| {
        let (first, second) = (end(first), end(second));
        let ending = Ending::of(output[first], output[second], first == second);
        wish.odds.chance(ending, *answer).ln()
    };
    wish.answers.iter().map(of).sum()
}

/// The same table with its states numbered breadth first.
fn breadth_first((delta, output): &Table) -> Table {
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
fn is_minimal((delta, output): &Table) -> bool {
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
