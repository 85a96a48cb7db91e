//! A partial automaton that grows edge by edge, with everything that follows
//! from it, and a trail to undo it.

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

    /// The output of a used state, where it is decided.
    pub(crate) fn output(&self, state: u32) -> Option<bool> {
        match self.output[state as usize] {
            REJECT => Some(false),
            ACCEPT => Some(true),
            _ => None,
        }
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

    /// Decides the output of a used state; `false` if a fact is violated, and
    /// then it must be undone.
    pub(crate) fn assume(&mut self, state: u32, accepting: bool) -> bool {
        let consistent = self.decide(state, u8::from(accepting));
        self.flips.clear();
        consistent
    }

    /// The implications between outputs that are not decided: if the first
    /// accepts, so does the second.
    pub(crate) fn open_implications(&self) -> impl Iterator<Item = (u32, u32)> + '_ {
        let open = |state: u32| self.output[state as usize] == OPEN;
        (self.implied.iter().copied()).filter(move |&(source, target)| open(source) && open(target))
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

    /// Sets a state's output and what it implies.
    fn decide(&mut self, state: u32, output: u8) -> bool {
        let known = self.output[state as usize];
        if known != OPEN {
            return known == output;
        }
        self.output[state as usize] = output;
        self.outputs.push(state);
        self.flips.push(state);
        while let Some(state) = self.flips.pop() {
            let mut link = if output == ACCEPT {
                self.newest[state as usize].0
            } else {
                self.newest[state as usize].1
            };
            while link != NONE {
                let (source, target) = self.implied[link as usize];
                let (same_source, same_target) = self.before[link as usize];
                let reached = if output == ACCEPT {
                    link = same_source;
                    target
                } else {
                    link = same_target;
                    source
                };
                match self.output[reached as usize] {
                    OPEN => {
                        self.output[reached as usize] = output;
                        self.outputs.push(reached);
                        self.flips.push(reached);
                    }
                    known if known == output => {}
                    _ => return false,
                }
            }
        }
        true
    }

    /// Adds that `source`'s acceptance implies `target`'s.
    fn imply(&mut self, source: u32, target: u32) -> bool {
        match (self.output[source as usize], self.output[target as usize]) {
            (REJECT, _) | (_, ACCEPT) => true,
            (ACCEPT, _) => self.decide(target, ACCEPT),
            (_, REJECT) => self.decide(source, REJECT),
            _ => {
                let link = self.implied.len() as u32;
                self.implied.push((source, target));
                self.before.push((
                    self.newest[source as usize].0,
                    self.newest[target as usize].1,
                ));
                self.newest[source as usize].0 = link;
                self.newest[target as usize].1 = link;
                true
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use automata::{Alphabet, Symbol, Word};
    use proptest::prelude::*;

    use super::*;
    use crate::evidence::Fact;
    use crate::identify::problem::{FactId, Problem};

    /// Everything but the room that vectors keep.
    fn snapshot(partial: &Partial<'_>) -> String {
        // Nodes and edges that are out of use keep what they last held.
        let waiting: Vec<Vec<Node>> = (partial.head.iter())
            .map(|&head| {
                let some = |node: Node| Some(node).filter(|&node| node != NONE);
                std::iter::successors(some(head), |&node| some(partial.behind[node as usize]))
                    .collect()
            })
            .collect();
        let places = (&partial.delta, &partial.output, &partial.state, waiting);
        let counts = (&partial.weight, &partial.labelled, &partial.beyond);
        let outputs = (&partial.implied, &partial.before, &partial.newest);
        let trails = (&partial.edges, &partial.placed, &partial.waits);
        let work = (&partial.outputs, &partial.arrivals, &partial.flips);
        format!(
            "{} {places:?} {counts:?} {outputs:?} {trails:?} {work:?}",
            partial.used
        )
    }

    fn word() -> impl Strategy<Value = Word> {
        proptest::collection::vec(0..2_usize, 0..6)
            .prop_map(|symbols| symbols.into_iter().map(Symbol::new).collect())
    }

    fn fact() -> impl Strategy<Value = Fact<Word>> {
        prop_oneof![
            (word(), any::<bool>()).prop_map(|(atom, accepted)| Fact::Label { atom, accepted }),
            (word(), word()).prop_map(|(worse, better)| Fact::Below { worse, better }),
            (word(), word()).prop_map(|(first, second)| Fact::Equal { first, second }),
        ]
    }

    proptest! {
        /// Whatever was defined, and whether or not it was consistent, undoing
        /// leaves nothing behind; and a glance never refuses what is possible.
        #[test]
        fn undoing_restores_everything(
            facts in proptest::collection::vec(fact(), 0..12),
            steps in proptest::collection::vec(0..4_u32, 0..8),
        ) {
            let mut problem = Problem::new(Alphabet::new(["a", "b"]).expect("two names"));
            let standing: Vec<FactId> =
                facts.iter().filter_map(|fact| problem.add(None, fact)).collect();
            let Some(instance) = Instance::new(&problem, &standing) else { return Ok(()) };
            let mut partial = Partial::new(&instance, 3);
            let mut points = vec![(partial.mark(), snapshot(&partial))];
            for step in steps {
                let Some(edge) = partial.tightest() else { break };
                let target = step.min(partial.used()).min(partial.limit() - 1);
                let glance = target == partial.used() || partial.may_lead(edge, target);
                let fits = partial.define(edge, target);
                prop_assert!(glance || !fits);
                if fits {
                    points.push((partial.mark(), snapshot(&partial)));
                } else if let Some((mark, before)) = points.last() {
                    partial.undo(*mark);
                    prop_assert_eq!(&snapshot(&partial), before);
                }
            }
            for (mark, before) in points.into_iter().rev() {
                partial.undo(mark);
                prop_assert_eq!(snapshot(&partial), before);
            }
        }
    }
}
