//! What answers imply about the preference order and about membership,
//! whatever the concept class: closure under transitivity, and contradictions.

use std::cmp::Reverse;
use std::collections::{BTreeMap, BTreeSet, BinaryHeap};
use std::hash::Hash;

use super::{Cause, Contradiction};
use crate::evidence::{AnswerId, Comparison, Fact};

/// `from ≼ to`, as one answer says it.
#[derive(Clone, Copy, Debug)]
struct Edge {
    from: usize,
    to: usize,
    strict: bool,
    answer: Option<AnswerId>,
}

/// The preference order as far as facts tell it, and the labels that follow
/// under Definition 5.1.1.
///
/// An incomparable pair is remembered so that neither it nor any pair that is
/// incomparable because of it is asked. It never contradicts anything: a person
/// who cannot tell has claimed nothing.
#[derive(Clone, Debug)]
pub struct Preorder<A> {
    ids: BTreeMap<A, usize>,
    edges: Vec<Edge>,
    /// Edge numbers by the node that they leave.
    above: Vec<Vec<usize>>,
    /// Edge numbers by the node that they enter.
    below: Vec<Vec<usize>>,
    labels: Vec<(usize, bool, Option<AnswerId>)>,
    incomparable: BTreeSet<(usize, usize)>,
}

impl<A> Default for Preorder<A> {
    fn default() -> Self {
        Self {
            ids: BTreeMap::new(),
            edges: Vec::new(),
            above: Vec::new(),
            below: Vec::new(),
            labels: Vec::new(),
            incomparable: BTreeSet::new(),
        }
    }
}

impl<A: Clone + Ord + Hash> Preorder<A> {
    /// Adds a fact; `None` for one that is known from the start.
    pub fn add(&mut self, answer: Option<AnswerId>, fact: &Fact<A>) {
        match fact {
            Fact::Label { atom, accepted } => {
                let node = self.node(atom);
                self.labels.push((node, *accepted, answer));
            }
            Fact::Below { worse, better } => {
                let (from, to) = (self.node(worse), self.node(better));
                self.edge(from, to, true, answer);
            }
            Fact::Equal { first, second } => {
                let (from, to) = (self.node(first), self.node(second));
                self.edge(from, to, false, answer);
                self.edge(to, from, false, answer);
            }
            Fact::Incomparable { first, second } => {
                let (first, second) = (self.node(first), self.node(second));
                self.incomparable
                    .insert((first.min(second), first.max(second)));
            }
        }
    }

    /// Whether the facts imply that `atom` is accepted or rejected.
    pub fn label(&self, atom: &A) -> Option<bool> {
        let &node = self.ids.get(atom)?;
        let around = Around::new(self, node);
        let labelled = |reached: &[bool], accepted: bool| {
            self.labels
                .iter()
                .any(|&(node, label, _)| label == accepted && reached[node])
        };
        if labelled(&around.below, true) {
            Some(true)
        } else if labelled(&around.above, false) {
            Some(false)
        } else {
            None
        }
    }

    /// The answer that the facts imply to a comparison of the two.
    pub fn comparison(&self, first: &A, second: &A) -> Option<Comparison> {
        if first == second {
            return Some(Comparison::Equal);
        }
        let (&first, &second) = (self.ids.get(first)?, self.ids.get(second)?);
        let first = Around::new(self, first);
        let second = Around::new(self, second);
        match (first.above[second.node], second.above[first.node]) {
            (true, true) => Some(Comparison::Equal),
            (true, false) => Some(Comparison::Second),
            (false, true) => Some(Comparison::First),
            (false, false) => (self.excludes(&first, &second) && self.excludes(&second, &first))
                .then_some(Comparison::Incomparable),
        }
    }

    /// Whether `lower ≼ upper` would make two incomparable atoms comparable, or
    /// put an accepted atom below a rejected one.
    fn excludes(&self, lower: &Around, upper: &Around) -> bool {
        let between = |x: usize, y: usize| lower.below[x] && upper.above[y];
        let labelled = |accepted| {
            let labels = self.labels.iter();
            labels
                .filter(move |(_, label, _)| *label == accepted)
                .map(|&(node, ..)| node)
        };
        let mut pairs = self.incomparable.iter();
        pairs.any(|&(x, y)| between(x, y) || between(y, x))
            || labelled(true).any(|x| labelled(false).any(|y| between(x, y)))
    }

    /// The simplest atom that was given this label itself, for which `fits`.
    pub fn simplest_labelled(&self, accepted: bool, fits: impl Fn(&A) -> bool) -> Option<&A> {
        let nodes: BTreeSet<usize> = self
            .labels
            .iter()
            .filter(|(_, label, _)| *label == accepted)
            .map(|&(node, ..)| node)
            .collect();
        self.ids
            .iter()
            .find(|(atom, node)| nodes.contains(node) && fits(atom))
            .map(|(atom, _)| atom)
    }

    /// A minimal set of answers that cannot stand together: first a cycle of
    /// preferences, then an accepted atom below a rejected one. Of each kind
    /// one with the fewest answers.
    pub fn conflict(&self) -> Option<Contradiction> {
        let answers = self.cycle().or_else(|| self.misplaced())?;
        // The fewest facts are the fewest answers unless one answer brought
        // several facts; then some of these answers may be superfluous.
        let mut minimal = answers.clone();
        for answer in answers {
            let rest: BTreeSet<AnswerId> =
                minimal.iter().copied().filter(|&a| a != answer).collect();
            if self.restricted(&rest).is_contradictory() {
                minimal = rest;
            }
        }
        let cause = self.restricted(&minimal).cause();
        Some(Contradiction {
            answers: minimal.into_iter().collect(),
            cause,
            minimal: true,
        })
    }

    /// Whether no set of atoms at all is consistent with the facts.
    pub(crate) fn misplaces_membership(&self) -> bool {
        self.misplaced().is_some()
    }

    fn is_contradictory(&self) -> bool {
        self.cycle().is_some() || self.misplaces_membership()
    }

    /// Why these facts, which are contradictory, cannot stand.
    fn cause(&self) -> Cause {
        if self.part(|_| true, |edge| edge.strict).cycle().is_some() {
            Cause::Order
        } else if self.cycle().is_some() {
            Cause::Equality
        } else {
            Cause::MemRep
        }
    }

    /// The same with the facts known from the start and those of `answers` only.
    fn restricted(&self, answers: &BTreeSet<AnswerId>) -> Self {
        let keeps = |answer: Option<AnswerId>| answer.is_none_or(|a| answers.contains(&a));
        self.part(keeps, |_| true)
    }

    /// The same with the labels and edges of some answers, and of these edges
    /// some.
    fn part(
        &self,
        keeps: impl Fn(Option<AnswerId>) -> bool,
        keeps_edge: impl Fn(&Edge) -> bool,
    ) -> Self {
        let mut restricted = Self {
            ids: self.ids.clone(),
            above: vec![Vec::new(); self.ids.len()],
            below: vec![Vec::new(); self.ids.len()],
            labels: self.labels.clone(),
            ..Self::default()
        };
        restricted.labels.retain(|&(.., answer)| keeps(answer));
        let edges = self.edges.iter().filter(|edge| keeps(edge.answer));
        for edge in edges.filter(|edge| keeps_edge(edge)) {
            restricted.edge(edge.from, edge.to, edge.strict, edge.answer);
        }
        restricted
    }

    fn node(&mut self, atom: &A) -> usize {
        if let Some(&node) = self.ids.get(atom) {
            return node;
        }
        let node = self.ids.len();
        self.ids.insert(atom.clone(), node);
        self.above.push(Vec::new());
        self.below.push(Vec::new());
        node
    }

    fn edge(&mut self, from: usize, to: usize, strict: bool, answer: Option<AnswerId>) {
        self.above[from].push(self.edges.len());
        self.below[to].push(self.edges.len());
        self.edges.push(Edge {
            from,
            to,
            strict,
            answer,
        });
    }

    /// The nodes that are reached from `start` by going up, or down; `start`
    /// itself is one.
    fn closure(&self, start: usize, up: bool) -> Vec<bool> {
        let mut reached = vec![false; self.ids.len()];
        reached[start] = true;
        let mut open = vec![start];
        while let Some(node) = open.pop() {
            let edges = if up { &self.above } else { &self.below };
            for &edge in &edges[node] {
                let edge = self.edges[edge];
                let next = if up { edge.to } else { edge.from };
                if !reached[next] {
                    reached[next] = true;
                    open.push(next);
                }
            }
        }
        reached
    }

    /// The answers on a cycle with a strict preference that has the fewest.
    fn cycle(&self) -> Option<BTreeSet<AnswerId>> {
        self.edges
            .iter()
            .filter(|edge| edge.strict)
            .filter_map(|edge| {
                let sources = [(edge.to, edge.answer)];
                let paths = self.cheapest_paths(&sources);
                let found = paths[edge.from].as_ref()?;
                Some((found.cost, self.answers_on(&paths, edge.from)))
            })
            .min_by_key(|(cost, _)| *cost)
            .map(|(_, answers)| answers)
    }

    /// The answers that put an accepted atom below (or on) a rejected one, as
    /// few as possible.
    fn misplaced(&self) -> Option<BTreeSet<AnswerId>> {
        let sources: Vec<_> = self
            .labels
            .iter()
            .filter(|(_, accepted, _)| *accepted)
            .map(|&(node, _, answer)| (node, answer))
            .collect();
        let paths = self.cheapest_paths(&sources);
        self.labels
            .iter()
            .filter(|(_, accepted, _)| !accepted)
            .filter_map(|&(node, _, answer)| {
                let cost = paths[node].as_ref()?.cost + weight(answer);
                Some((cost, node, answer))
            })
            .min_by_key(|(cost, ..)| *cost)
            .map(|(_, node, answer)| {
                let mut answers = self.answers_on(&paths, node);
                answers.extend(answer);
                answers
            })
    }

    /// For every node the way up to it, from any source, on the fewest answers.
    /// A source comes with the answer that made it one.
    fn cheapest_paths(&self, sources: &[(usize, Option<AnswerId>)]) -> Vec<Option<Arrival>> {
        let mut arrivals: Vec<Option<Arrival>> = vec![None; self.ids.len()];
        let mut open = BinaryHeap::new();
        for &(node, answer) in sources {
            let cost = weight(answer);
            if arrivals[node].as_ref().is_none_or(|a| cost < a.cost) {
                arrivals[node] = Some(Arrival {
                    cost,
                    by: By::Source(answer),
                });
                open.push(Reverse((cost, node)));
            }
        }
        while let Some(Reverse((cost, node))) = open.pop() {
            if arrivals[node].as_ref().is_none_or(|a| a.cost < cost) {
                continue;
            }
            for &number in &self.above[node] {
                let edge = self.edges[number];
                let cost = cost + weight(edge.answer);
                if arrivals[edge.to].as_ref().is_none_or(|a| cost < a.cost) {
                    arrivals[edge.to] = Some(Arrival {
                        cost,
                        by: By::Edge(number),
                    });
                    open.push(Reverse((cost, edge.to)));
                }
            }
        }
        arrivals
    }

    fn answers_on(&self, arrivals: &[Option<Arrival>], end: usize) -> BTreeSet<AnswerId> {
        let mut answers = BTreeSet::new();
        let mut node = end;
        while let Some(arrival) = &arrivals[node] {
            match arrival.by {
                By::Source(answer) => {
                    answers.extend(answer);
                    break;
                }
                By::Edge(number) => {
                    answers.extend(self.edges[number].answer);
                    node = self.edges[number].from;
                }
            }
        }
        answers
    }
}

/// A node with all that is known to be at most, and at least, as good.
struct Around {
    node: usize,
    below: Vec<bool>,
    above: Vec<bool>,
}

impl Around {
    fn new<A: Clone + Ord + Hash>(order: &Preorder<A>, node: usize) -> Self {
        Self {
            node,
            below: order.closure(node, false),
            above: order.closure(node, true),
        }
    }
}

/// The cheapest known way to a node.
#[derive(Clone, Debug)]
struct Arrival {
    cost: usize,
    by: By,
}

/// The last part of a way.
#[derive(Clone, Copy, Debug)]
enum By {
    Source(Option<AnswerId>),
    Edge(usize),
}

/// What is known from the start costs nothing: it cannot be taken back.
fn weight(answer: Option<AnswerId>) -> usize {
    usize::from(answer.is_some())
}
