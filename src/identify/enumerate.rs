//! The plain enumerator: depth-first search over canonically numbered automata.
//!
//! States are numbered in the order of their first use and the next edge is the
//! undefined one that is likely to fail first, so every automaton is met once.
//! Small automata grow from words that are placed one by one ([`Partial`]),
//! larger ones from a prefix tree that is folded ([`Merged`]), where a step takes
//! ten times as long and saves up to a thousand. This beats SAT by one to three
//! orders of magnitude; as its time grows with `states^(states * symbols)` in
//! the worst case, it stops at a budget.

use std::collections::BTreeSet;

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::completion::{Leaf, Table, canonical};
use super::engine::{Engine, Query, Verdict};
use super::growing::Growing;
use super::instance::Instance;
use super::merged::Merged;
use super::partial::Partial;
use crate::evidence::Budget;

/// Nodes after which a listing gives way to random dives, if it has found
/// [`SPARSE`] leaves.
const LISTING: u64 = 3_000;
/// With fewer leaves, it goes on for so many more nodes.
const SPARSE_LISTING: u64 = 12_000;
/// With that many leaves in [`LISTING`] nodes, dives find one in about 200 nodes.
const SPARSE: usize = 150;
/// Nodes that the dives of one search may take together.
const DIVES: u64 = 4_000;
/// Nodes that listing goes on for at a time where dives found too few.
const FINISHING: u64 = 20_000;

/// The largest number of states for which words are placed one by one, unless
/// that finds nothing soon: listing a version space is then faster. Beyond, and
/// where nearly everything is refuted, folding is.
const PLACED_STATES: usize = 8;

/// The enumerator. It keeps nothing between searches.
#[derive(Debug, Default)]
pub(crate) struct Enumerator;

impl Engine for Enumerator {
    fn search(&mut self, query: &Query<'_>, budget: &mut Budget) -> Verdict {
        let Some(instance) = Instance::new(query.problem, query.standing) else {
            return Verdict::None {
                core: query.standing.to_vec(),
            };
        };
        // A small version space is listed, and then drawn from evenly.
        if query.states <= PLACED_STATES {
            let mut leaves = Leaves::default();
            let mut listing = Walk::<Partial<'_>>::new(&instance, query.states);
            let ended = leaves.gather(&mut listing, LISTING, budget);
            if ended || leaves.len() > 0 {
                return answer(&instance, query, leaves, listing, ended, budget);
            }
        }
        let mut leaves = Leaves::default();
        let mut listing = Walk::<Merged<'_>>::new(&instance, query.states);
        let ended = leaves.gather(&mut listing, LISTING, budget);
        answer(&instance, query, leaves, listing, ended, budget)
    }
}

/// Answers the query, given the first leaves of a listing and whether these are
/// all.
fn answer<'a, G: Growing<'a>>(
    instance: &'a Instance,
    query: &Query<'_>,
    mut leaves: Leaves,
    mut listing: Walk<'a, G>,
    mut ended: bool,
    budget: &mut Budget,
) -> Verdict {
    let mut rng = ChaCha8Rng::seed_from_u64(query.seed);
    if !ended && leaves.len() < SPARSE {
        // Dives would mostly miss.
        ended = leaves.gather(&mut listing, SPARSE_LISTING, budget);
    }
    if !ended && leaves.len() == 0 {
        // A hard one: to the first leaf, whatever it takes.
        match listing.descend(&mut Limits::units(u64::MAX), budget, None) {
            Reached::Leaf => leaves.push(listing.leaf()),
            Reached::End => ended = true,
            Reached::Limit => return Verdict::OverBudget,
        }
    }
    if ended && leaves.len() == 0 {
        return Verdict::None {
            core: query.standing.to_vec(),
        };
    }
    let mut found = BTreeSet::new();
    if !ended {
        dive::<G>(instance, query, &mut found, &mut rng, budget);
        while found.len() < query.count && !ended {
            ended = leaves.gather(&mut listing, FINISHING, budget);
            if leaves.total >= query.count as u128 || budget.is_spent() {
                break;
            }
        }
    }
    let mut automata = Vec::new();
    if ended {
        automata = leaves.draw(query.count, &mut rng);
    } else {
        automata.extend(found);
        for table in leaves.draw(query.count, &mut rng) {
            if automata.len() < query.count && !automata.contains(&table) {
                automata.push(table);
            }
        }
    }
    let alphabet = query.problem.alphabet();
    Verdict::Found {
        complete: ended && leaves.total <= query.count as u128,
        automata: automata
            .iter()
            .map(|table| canonical(alphabet, table))
            .collect(),
    }
}

/// Random descents, each to its first leaf, until there are enough different
/// automata or the nodes are spent.
fn dive<'a, G: Growing<'a>>(
    instance: &'a Instance,
    query: &Query<'_>,
    found: &mut BTreeSet<Table>,
    rng: &mut ChaCha8Rng,
    budget: &mut Budget,
) {
    let mut walk = Walk::<G>::new(instance, query.states);
    // A descent that meets a barren subtree is better begun anew.
    let patience = 8 * (query.states * instance.symbols) as u64 + 32;
    let mut left = DIVES;
    while found.len() < query.count && left > 0 {
        walk.restart();
        let mut limits = Limits {
            units: left,
            edges: patience,
        };
        let reached = walk.descend(&mut limits, budget, Some(rng));
        left = limits.units.min(left - 1);
        if reached == Reached::Leaf {
            found.insert(walk.leaf().draw(rng));
        }
        if budget.is_spent() {
            return;
        }
    }
}

/// Where a walk stopped.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Reached {
    /// At an automaton in which all words run.
    Leaf,
    /// Everything has been seen.
    End,
    /// At the limits, or the budget is spent.
    Limit,
}

/// How far a walk may go.
struct Limits {
    /// Units of work.
    units: u64,
    /// Edges defined, whether they stayed so or not.
    edges: u64,
}

impl Limits {
    /// As far as these units of work go.
    fn units(units: u64) -> Self {
        Self {
            units,
            edges: u64::MAX,
        }
    }
}

/// A choice of a [`Walk`]: where one edge leads.
struct Choice<M> {
    edge: u32,
    /// The targets to try are `values[next..end]`.
    next: u32,
    end: u32,
    mark: M,
}

/// A depth-first walk through the partial automata that can be resumed.
struct Walk<'a, G: Growing<'a>> {
    partial: G,
    choices: Vec<Choice<G::Mark>>,
    values: Vec<u32>,
    /// Whether the partial automaton is a new one, to be looked at.
    fresh: bool,
}

impl<'a, G: Growing<'a>> Walk<'a, G> {
    fn new(instance: &'a Instance, states: usize) -> Self {
        Self {
            partial: G::start(instance, states),
            choices: Vec::with_capacity(states * instance.symbols),
            values: Vec::new(),
            fresh: true,
        }
    }

    /// Back to the root.
    fn restart(&mut self) {
        if let Some(choice) = self.choices.first() {
            self.partial.undo(choice.mark);
        }
        self.choices.clear();
        self.values.clear();
        self.fresh = true;
    }

    /// The leaf at which the walk stands.
    fn leaf(&self) -> Leaf {
        self.partial.leaf()
    }

    /// The next leaf, trying targets in random order if there is a generator.
    fn descend(
        &mut self,
        limits: &mut Limits,
        budget: &mut Budget,
        mut rng: Option<&mut ChaCha8Rng>,
    ) -> Reached {
        loop {
            if self.fresh {
                self.fresh = false;
                if !self.choose(rng.as_deref_mut()) {
                    return Reached::Leaf;
                }
            }
            let Some(choice) = self.choices.last_mut() else {
                return Reached::End;
            };
            self.partial.undo(choice.mark);
            if choice.next == choice.end {
                self.choices.pop();
                let end = self.choices.last().map_or(0, |choice| choice.end);
                self.values.truncate(end as usize);
                continue;
            }
            let target = self.values[choice.next as usize];
            if limits.units == 0 || limits.edges == 0 || budget.is_spent() {
                return Reached::Limit;
            }
            choice.next += 1;
            self.fresh = self.partial.define(choice.edge, target);
            let work = self.partial.take_work();
            limits.units = limits.units.saturating_sub(work);
            limits.edges -= 1;
            // That it is spent is noticed before the next step.
            let _ = budget.spend(work);
        }
    }

    /// Takes up the next edge to define; `false` if there is none.
    fn choose(&mut self, rng: Option<&mut ChaCha8Rng>) -> bool {
        let start = self.values.len();
        let Some(edge) = self.partial.choose(&mut self.values) else {
            return false;
        };
        if let Some(rng) = rng {
            let values = &mut self.values[start..];
            for last in (1..values.len()).rev() {
                values.swap(last, rng.random_range(0..=last as u32) as usize);
            }
        }
        self.choices.push(Choice {
            edge,
            next: start as u32,
            end: self.values.len() as u32,
            mark: self.partial.mark(),
        });
        true
    }
}

/// The leaves that a listing has met.
#[derive(Default)]
struct Leaves {
    leaves: Vec<Leaf>,
    /// The automata they stand for, saturating.
    total: u128,
}

impl Leaves {
    fn len(&self) -> usize {
        self.leaves.len()
    }

    fn push(&mut self, leaf: Leaf) {
        self.total = self.total.saturating_add(leaf.count());
        self.leaves.push(leaf);
    }

    /// Goes on with a listing for some more units; whether it came to its end.
    fn gather<'a, G: Growing<'a>>(
        &mut self,
        listing: &mut Walk<'a, G>,
        units: u64,
        budget: &mut Budget,
    ) -> bool {
        let mut limits = Limits::units(units);
        loop {
            match listing.descend(&mut limits, budget, None) {
                Reached::Leaf => self.push(listing.leaf()),
                Reached::End => return true,
                Reached::Limit => return false,
            }
        }
    }

    /// `count` different automata, or all; every set is as likely as any other.
    fn draw(&self, count: usize, rng: &mut ChaCha8Rng) -> Vec<Table> {
        // Where most would be drawn, refusing repetitions takes long.
        if self.total <= 2 * count as u128 {
            let mut all = Vec::new();
            for leaf in &self.leaves {
                leaf.all(&mut all);
            }
            let wanted = count.min(all.len());
            for place in 0..wanted {
                let other = rng.random_range(place as u32..all.len() as u32);
                all.swap(place, other as usize);
            }
            all.truncate(wanted);
            return all;
        }
        let heights = self.heights();
        let mut drawn = BTreeSet::new();
        while drawn.len() < count {
            let place = match &heights {
                Heights::Exact(heights) => {
                    let at = rng.random_range(0..self.total);
                    heights.partition_point(|&height| height <= at)
                }
                Heights::Rounded(heights) => {
                    let top = heights.last().copied().unwrap_or(0.0);
                    let at = rng.random::<f64>() * top;
                    heights.partition_point(|&height| height <= at)
                }
            };
            // Rounding may put a draw at the very top.
            let place = place.min(self.leaves.len() - 1);
            drawn.insert(self.leaves[place].draw(rng));
        }
        drawn.into_iter().collect()
    }

    /// For each leaf, how many automata it and those before stand for.
    fn heights(&self) -> Heights {
        if self.total < u128::MAX {
            let mut height = 0;
            let add = |leaf: &Leaf| {
                height += leaf.count();
                height
            };
            return Heights::Exact(self.leaves.iter().map(add).collect());
        }
        // Too many for numbers: shares of the leaf with the most free edges.
        let free = |leaf: &Leaf| leaf.free_edges();
        let most = self.leaves.iter().map(free).max().unwrap_or(0);
        let mut height = 0.0;
        let add = |leaf: &Leaf| {
            let mut share = leaf.output_count() as f64;
            for _ in leaf.free_edges()..most {
                share /= leaf.states() as f64;
            }
            height += share;
            height
        };
        Heights::Rounded(self.leaves.iter().map(add).collect())
    }
}

/// Running totals of the leaves, see [`Leaves::heights`].
enum Heights {
    Exact(Vec<u128>),
    Rounded(Vec<f64>),
}
