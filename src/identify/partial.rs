//! A partial automaton that grows edge by edge, with everything that follows
//! from it, and a trail to undo it.

mod outputs;
#[cfg(test)]
mod tests;

use super::instance::{Instance, Node};

/// No state, no node, or no edge.
pub(crate) const NONE: u32 = u32::MAX;

/// As many pairs of edges and symbols are looked ahead to at most.
const LARGEST_GLANCE: usize = 1 << 20;

/// What is known of a state's output.
const REJECT: u8 = 0;
const ACCEPT: u8 = 1;
const OPEN: u8 = 2;

/// A point to which a [`Partial`] can be undone.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Mark {
    used: u32,
    edges: u32,
    placed: u32,
    waits: u32,
    outputs: u32,
    implied: u32,
}

/// An automaton some of whose edges are not defined yet.
///
/// Every node of the instance whose path is defined is *placed* in its state;
/// the others *wait* at the first undefined edge of their path, or below a node
/// that waits. An edge is the number `state * symbols + symbol`.
pub(crate) struct Partial<'a> {
    instance: &'a Instance,
    limit: u32,
    symbols: u32,
    used: u32,
    delta: Vec<u32>,
    output: Vec<u8>,
    state: Vec<u32>,
    /// The newest node that waits at an edge, and for each node the one before.
    head: Vec<u32>,
    behind: Vec<u32>,
    /// The weight of the nodes that wait at an edge.
    weight: Vec<u32>,
    /// How many of them are labelled, by label.
    labelled: Vec<[u32; 2]>,
    /// How many of their children are, by label, at `edge * glance + symbol`.
    beyond: Vec<[u32; 2]>,
    /// The number of symbols; 0 if that would make `beyond` too large.
    glance: usize,
    /// Implications between outputs: of the source's acceptance to the target's.
    implied: Vec<(u32, u32)>,
    /// For each implication the one before with the same source, and target.
    before: Vec<(u32, u32)>,
    newest: Vec<(u32, u32)>,
    // Trails.
    edges: Vec<u32>,
    placed: Vec<Node>,
    waits: Vec<u32>,
    outputs: Vec<u32>,
    // Work lists, empty between calls.
    arrivals: Vec<(Node, u32)>,
    flips: Vec<u32>,
}

impl<'a> Partial<'a> {
    /// The automaton of the start state alone, that may grow to `limit` states.
    pub(crate) fn new(instance: &'a Instance, limit: usize) -> Self {
        let edges = limit * instance.symbols;
        let nodes = instance.size();
        let glance = if edges * instance.symbols <= LARGEST_GLANCE {
            instance.symbols
        } else {
            0
        };
        let mut partial = Self {
            instance,
            limit: limit as u32,
            symbols: instance.symbols as u32,
            used: 1,
            delta: vec![NONE; edges],
            output: vec![OPEN; limit],
            state: vec![NONE; nodes],
            head: vec![NONE; edges],
            behind: vec![NONE; nodes],
            weight: vec![0; edges],
            labelled: vec![[0; 2]; edges],
            beyond: vec![[0; 2]; edges * glance],
            glance,
            implied: Vec::new(),
            before: Vec::new(),
            newest: vec![(NONE, NONE); limit],
            edges: Vec::with_capacity(edges),
            placed: Vec::with_capacity(nodes),
            waits: Vec::with_capacity(nodes),
            outputs: Vec::with_capacity(limit),
            arrivals: Vec::with_capacity(nodes),
            flips: Vec::with_capacity(limit),
        };
        partial.arrivals.push((0, 0));
        let fits = partial.settle();
        debug_assert!(fits, "one node in one state contradicts nothing");
        partial
    }

    /// The present point of the trail.
    pub(crate) fn mark(&self) -> Mark {
        Mark {
            used: self.used,
            edges: self.edges.len() as u32,
            placed: self.placed.len() as u32,
            waits: self.waits.len() as u32,
            outputs: self.outputs.len() as u32,
            implied: self.implied.len() as u32,
        }
    }

    /// Forgets everything since `mark`.
    pub(crate) fn undo(&mut self, mark: Mark) {
        self.used = mark.used;
        for edge in self.edges.drain(mark.edges as usize..) {
            self.delta[edge as usize] = NONE;
        }
        for node in self.placed.drain(mark.placed as usize..) {
            self.state[node as usize] = NONE;
        }
        for state in self.outputs.drain(mark.outputs as usize..) {
            self.output[state as usize] = OPEN;
        }
        while self.waits.len() > mark.waits as usize {
            let edge = self.waits.pop().expect("longer than the mark") as usize;
            let node = self.head[edge] as usize;
            self.head[edge] = self.behind[node];
            self.weight[edge] -= self.instance.weight[node];
            if let Some(label) = self.instance.label[node] {
                self.labelled[edge][usize::from(label)] -= 1;
            }
            if self.glance > 0 {
                for child in self.instance.children(node as Node) {
                    if let Some(label) = self.instance.label[child as usize] {
                        let symbol = self.instance.symbol[child as usize] as usize;
                        self.beyond[edge * self.glance + symbol][usize::from(label)] -= 1;
                    }
                }
            }
        }
        while self.implied.len() > mark.implied as usize {
            let (source, target) = self.implied.pop().expect("longer than the mark");
            let (same_source, same_target) = self.before.pop().expect("as many as `implied`");
            self.newest[source as usize].0 = same_source;
            self.newest[target as usize].1 = same_target;
        }
    }

    /// The number of states that are in use.
    pub(crate) fn used(&self) -> u32 {
        self.used
    }

    /// The number of states that may be.
    pub(crate) fn limit(&self) -> u32 {
        self.limit
    }

    /// The table so far, [`NONE`] where it is undefined; only the rows of used
    /// states.
    pub(crate) fn delta(&self) -> &[u32] {
        &self.delta[..(self.used * self.symbols) as usize]
    }

    /// The number of edges of used states that are not defined.
    pub(crate) fn open_edges(&self) -> usize {
        (self.used * self.symbols) as usize - self.edges.len()
    }

    /// The first edge of a used state that is not defined.
    pub(crate) fn first_open_edge(&self) -> Option<u32> {
        let place = self.delta().iter().position(|&target| target == NONE);
        place.map(|edge| edge as u32)
    }

    /// The undefined edge that is likely to fail first: most waits at it for
    /// every state it may lead to. None if every node is placed.
    pub(crate) fn tightest(&self) -> Option<u32> {
        let mut best = None;
        let (mut best_weight, mut best_targets) = (0_u64, 1_u64);
        for edge in 0..self.used * self.symbols {
            let weight = u64::from(self.weight[edge as usize]);
            if weight == 0 || self.delta[edge as usize] != NONE {
                continue;
            }
            // Targets are counted only as long as the edge may still be best.
            let mut targets = u64::from(self.used < self.limit);
            for target in 0..self.used {
                targets += u64::from(self.may_lead(edge, target));
                if targets > 1 && weight * best_targets <= best_weight * targets {
                    break;
                }
            }
            if targets <= 1 {
                return Some(edge);
            }
            if weight * best_targets > best_weight * targets {
                best = Some(edge);
                (best_weight, best_targets) = (weight, targets);
            }
        }
        best
    }

    /// Whether the labels that wait at `edge`, and one symbol beyond, allow it
    /// to lead to a used state: a glance that spares most of the vain calls of
    /// [`Self::define`].
    pub(crate) fn may_lead(&self, edge: u32, target: u32) -> bool {
        let fits = |output: u8, labelled: [u32; 2]| match output {
            REJECT => labelled[1] == 0,
            ACCEPT => labelled[0] == 0,
            _ => true,
        };
        if !fits(self.output[target as usize], self.labelled[edge as usize]) {
            return false;
        }
        let row = (target * self.symbols) as usize;
        let beyond = edge as usize * self.glance;
        let nexts = &self.delta[row..row + self.glance];
        (nexts.iter())
            .zip(&self.beyond[beyond..beyond + self.glance])
            .all(|(&next, &labelled)| next == NONE || fits(self.output[next as usize], labelled))
    }

    /// Defines an undefined edge, to a used state or to the first unused one;
    /// `false` if a fact is violated, and then it must be undone.
    pub(crate) fn define(&mut self, edge: u32, target: u32) -> bool {
        debug_assert!(target <= self.used && target < self.limit);
        debug_assert_eq!(self.delta[edge as usize], NONE);
        self.used = self.used.max(target + 1);
        self.delta[edge as usize] = target;
        self.edges.push(edge);
        let mut node = self.head[edge as usize];
        while node != NONE {
            self.arrivals.push((node, target));
            node = self.behind[node as usize];
        }
        self.settle()
    }

    /// Places all arrivals and what follows them.
    fn settle(&mut self) -> bool {
        while let Some((node, state)) = self.arrivals.pop() {
            if !self.place(node, state) {
                self.arrivals.clear();
                self.flips.clear();
                return false;
            }
        }
        true
    }

    fn place(&mut self, node: Node, state: u32) -> bool {
        let instance = self.instance;
        self.state[node as usize] = state;
        self.placed.push(node);
        if let Some(label) = instance.label[node as usize]
            && !self.decide(state, u8::from(label))
        {
            return false;
        }
        for place in instance.partners(node) {
            let partner = instance.partner(place);
            let other = self.state[partner.node as usize];
            if other == NONE || other == state {
                continue;
            }
            let consistent = if partner.above {
                self.imply(state, other)
            } else {
                self.imply(other, state)
            };
            if !consistent {
                return false;
            }
        }
        for child in instance.children(node) {
            let edge = (state * self.symbols + instance.symbol[child as usize]) as usize;
            let target = self.delta[edge];
            if target == NONE {
                if !self.wait(child, edge) {
                    return false;
                }
            } else {
                self.arrivals.push((child, target));
            }
        }
        true
    }

    /// Lets a node wait at an undefined edge; `false` if it cannot share a state
    /// with the others that wait there.
    fn wait(&mut self, node: Node, edge: usize) -> bool {
        let instance = self.instance;
        self.behind[node as usize] = self.head[edge];
        self.head[edge] = node;
        self.weight[edge] += instance.weight[node as usize];
        self.waits.push(edge as u32);
        let mut compatible = true;
        let mut count = |labelled: &mut [u32; 2], label: Option<bool>| {
            if let Some(label) = label {
                labelled[usize::from(label)] += 1;
                compatible &= labelled[usize::from(!label)] == 0;
            }
        };
        count(&mut self.labelled[edge], instance.label[node as usize]);
        if self.glance > 0 {
            for child in instance.children(node) {
                let symbol = instance.symbol[child as usize] as usize;
                let labelled = &mut self.beyond[edge * self.glance + symbol];
                count(labelled, instance.label[child as usize]);
            }
        }
        compatible
    }
}
