//! A prefix tree that is being folded into an automaton, with everything that
//! follows from it, and a trail to undo it.
//!
//! This is state merging (the red and blue nodes of Lang's and of Oliveira and
//! Silva's exact searches) with forward checking: what waits at an undefined
//! edge is folded into one tree as soon as it waits there, so that two words
//! whose ends disagree are found out long before their states are decided, and
//! the edge to decide next is the one with the fewest targets into which its
//! tree can still be folded. On dense samples nearly every edge has one.

use super::instance::{Instance, Node};

/// No state, no class, no node, or no edge.
pub(crate) const NONE: u32 = u32::MAX;

/// What is known of a class's output.
const REJECT: u8 = 0;
const ACCEPT: u8 = 1;
const OPEN: u8 = 2;

/// Steps of folding that take as long as one unit of a budget (measured: 20 to
/// 30 ns each).
const STEPS_PER_UNIT: u64 = 40;

/// As many steps as it takes to begin a fold and to undo it.
const STEPS_PER_FOLD: u64 = 3;

/// States whose refutation as a target is remembered: one bit each.
const REMEMBERED: u32 = u64::BITS;

/// A point to which a [`Merged`] can be undone.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Mark(usize);

/// A change, with what was before.
enum Change {
    Child(u32, u32),
    Output(u32),
    Into(Node),
    Ring(Node, u32),
    Head(u32, u32),
    State,
    Refuted(u32, u64),
}

/// An automaton some of whose edges are not defined yet.
///
/// Nodes of the instance are in one *class* if they are known to end in the
/// same state; a class has the number of its first node. Some classes are
/// states. A class that is no state has one class before it, so that these
/// classes form trees, which wait at the states' undefined edges.
pub(crate) struct Merged<'a> {
    instance: &'a Instance,
    limit: u32,
    /// The symbols that occur in the instance: edges of others stay free.
    symbols: Vec<u32>,
    /// By class and symbol that occurs.
    child: Vec<u32>,
    /// By class.
    output: Vec<u8>,
    /// By class: its state.
    state: Vec<u32>,
    /// By state: its class.
    states: Vec<u32>,
    /// By edge: the states to which it cannot lead.
    refuted: Vec<u64>,
    /// Whether there are preferences, for which the next three are kept.
    constrained: bool,
    /// By node: the class it was folded into, or itself.
    into: Vec<u32>,
    /// By node with preferences: the next such node of the same class, in a
    /// ring.
    ring: Vec<u32>,
    /// By class: one node of its ring.
    head: Vec<u32>,
    trail: Vec<Change>,
    /// Steps of folding that are not accounted for.
    steps: u64,
    // Work lists, empty between calls.
    pairs: Vec<(u32, u32)>,
    flips: Vec<u32>,
    undefined: Vec<(u32, u32)>,
    fits: Vec<(u32, u32)>,
}

impl<'a> Merged<'a> {
    /// The automaton of the start state alone, that may grow to `limit` states.
    pub(crate) fn new(instance: &'a Instance, limit: usize) -> Self {
        let nodes = instance.size();
        let mut symbols: Vec<u32> = (1..nodes).map(|node| instance.symbol[node]).collect();
        symbols.sort_unstable();
        symbols.dedup();
        let mut child = vec![NONE; nodes * symbols.len()];
        for node in 0..nodes as Node {
            for next in instance.children(node) {
                let symbol = instance.symbol[next as usize];
                let column = symbols.partition_point(|&other| other < symbol);
                child[node as usize * symbols.len() + column] = next;
            }
        }
        let output = instance.label.iter().map(|&label| match label {
            Some(false) => REJECT,
            Some(true) => ACCEPT,
            None => OPEN,
        });
        let own = |node: Node| {
            if instance.partners(node).is_empty() {
                NONE
            } else {
                node
            }
        };
        let ring: Vec<u32> = (0..nodes as Node).map(own).collect();
        let mut state = vec![NONE; nodes];
        state[0] = 0;
        Self {
            instance,
            limit: limit as u32,
            refuted: vec![0; limit * symbols.len()],
            symbols,
            child,
            output: output.collect(),
            state,
            states: vec![0],
            constrained: ring.iter().any(|&node| node != NONE),
            into: (0..nodes as u32).collect(),
            head: ring.clone(),
            ring,
            trail: Vec::new(),
            steps: 0,
            pairs: Vec::new(),
            flips: Vec::new(),
            undefined: Vec::new(),
            fits: Vec::new(),
        }
    }

    /// The present point of the trail.
    pub(crate) fn mark(&self) -> Mark {
        Mark(self.trail.len())
    }

    /// Forgets everything since `mark`.
    pub(crate) fn undo(&mut self, mark: Mark) {
        while self.trail.len() > mark.0 {
            match self.trail.pop().expect("longer than the mark") {
                Change::Child(slot, before) => self.child[slot as usize] = before,
                Change::Output(class) => self.output[class as usize] = OPEN,
                Change::Into(node) => self.into[node as usize] = node,
                Change::Ring(node, before) => self.ring[node as usize] = before,
                Change::Head(class, before) => self.head[class as usize] = before,
                Change::State => {
                    let class = self.states.pop().expect("a state was added");
                    self.state[class as usize] = NONE;
                }
                Change::Refuted(edge, before) => self.refuted[edge as usize] = before,
            }
        }
    }

    /// The units of work done since the last call, at least 1.
    pub(crate) fn take_work(&mut self) -> u64 {
        let units = self.steps / STEPS_PER_UNIT;
        self.steps %= STEPS_PER_UNIT;
        units.max(1)
    }

    /// The number of states that are in use.
    pub(crate) fn used(&self) -> u32 {
        self.states.len() as u32
    }

    /// The table so far, [`NONE`] where it is undefined; only the rows of used
    /// states. Meaningful when nothing waits.
    pub(crate) fn delta(&self) -> Vec<u32> {
        let mut delta = vec![NONE; self.states.len() * self.instance.symbols];
        for (row, &class) in delta.chunks_mut(self.instance.symbols).zip(&self.states) {
            for (column, &symbol) in self.symbols.iter().enumerate() {
                let target = self.child[class as usize * self.symbols.len() + column];
                if target != NONE {
                    row[symbol as usize] = self.state[target as usize];
                }
            }
        }
        delta
    }

    /// The output of a used state, where it is decided.
    pub(crate) fn output(&self, state: u32) -> Option<bool> {
        match self.output[self.states[state as usize] as usize] {
            REJECT => Some(false),
            ACCEPT => Some(true),
            _ => None,
        }
    }

    /// The implications between outputs that are not decided: if the first
    /// accepts, so does the second. Meaningful when nothing waits.
    pub(crate) fn open_implications(&self) -> Vec<(u32, u32)> {
        let mut open = Vec::new();
        for node in (0..self.instance.size() as Node).filter(|_| self.constrained) {
            for place in self.instance.partners(node) {
                let partner = self.instance.partner(place);
                let (low, high) = (self.find(node), self.find(partner.node));
                let undecided = |class: u32| self.output[class as usize] == OPEN;
                if partner.above && low != high && undecided(low) && undecided(high) {
                    open.push((self.state[low as usize], self.state[high as usize]));
                }
            }
        }
        open
    }

    /// The undefined edge that can lead to the fewest states (fail first), with
    /// those states appended to `targets`, the likeliest first: those that agree
    /// with the most labels, then an unused state. None if nothing waits.
    ///
    /// No target at all means that this automaton cannot be completed.
    pub(crate) fn tightest(&mut self, targets: &mut Vec<u32>) -> Option<u32> {
        let start = targets.len();
        let grows = usize::from(self.used() < self.limit);
        let mut best = None;
        let mut fewest = usize::MAX;
        let mut undefined = std::mem::take(&mut self.undefined);
        let mut fits = std::mem::take(&mut self.fits);
        self.undefined_edges(&mut undefined);
        for &(_, edge) in &undefined {
            fits.clear();
            for target in 0..self.used() {
                // It need not be known how many more targets it has than best.
                if fits.len() + grows >= fewest {
                    break;
                }
                if target < REMEMBERED && self.refuted[edge as usize] >> target & 1 == 1 {
                    continue;
                }
                let mark = self.mark();
                let agreements = self.fold(edge, target);
                self.undo(mark);
                match agreements {
                    Some(agreements) => fits.push((u32::MAX - agreements, target)),
                    None => self.refute(edge, target),
                }
            }
            if fits.len() + grows < fewest {
                fewest = fits.len() + grows;
                best = Some(edge);
                fits.sort_unstable();
                targets.truncate(start);
                targets.extend(fits.iter().map(|&(_, target)| target));
                if fewest <= 1 {
                    break;
                }
            }
        }
        self.undefined = undefined;
        self.fits = fits;
        if best.is_some() && grows == 1 {
            targets.push(self.used());
        }
        best
    }

    /// The edges at which something waits, those first that are known to have
    /// few targets: the others are then soon seen to have more.
    fn undefined_edges(&self, edges: &mut Vec<(u32, u32)>) {
        edges.clear();
        let symbols = self.symbols.len() as u32;
        for (state, &class) in (0..).zip(&self.states) {
            for column in 0..symbols {
                let next = self.child[(class * symbols + column) as usize];
                if next != NONE && self.state[next as usize] == NONE {
                    let edge = state * symbols + column;
                    let refuted = self.refuted[edge as usize].count_ones();
                    edges.push((self.used() - refuted, edge));
                }
            }
        }
        edges.sort_unstable();
    }

    fn refute(&mut self, edge: u32, target: u32) {
        if target < REMEMBERED {
            let before = self.refuted[edge as usize];
            self.trail.push(Change::Refuted(edge, before));
            self.refuted[edge as usize] = before | 1 << target;
        }
    }

    /// Defines an undefined edge at which something waits, to a used state or to
    /// the first unused one; `false` if a fact is violated, and then it must be
    /// undone.
    pub(crate) fn define(&mut self, edge: u32, target: u32) -> bool {
        if target < self.used() {
            return self.fold(edge, target).is_some();
        }
        let class = self.child[self.slot(edge)];
        self.state[class as usize] = target;
        self.states.push(class);
        self.trail.push(Change::State);
        true
    }

    /// The place in `child` of a state's edge.
    fn slot(&self, edge: u32) -> usize {
        let symbols = self.symbols.len() as u32;
        let class = self.states[(edge / symbols) as usize];
        (class * symbols + edge % symbols) as usize
    }

    /// Folds the tree that waits at `edge` into the automaton from state
    /// `target` on. How many labels agree; none if a fact is violated, and then
    /// it must be undone.
    fn fold(&mut self, edge: u32, target: u32) -> Option<u32> {
        self.steps += STEPS_PER_FOLD;
        let slot = self.slot(edge);
        let (class, tree) = (self.states[target as usize], self.child[slot]);
        self.set_child(slot, class);
        self.pairs.clear();
        self.pairs.push((class, tree));
        let symbols = self.symbols.len();
        let mut agreements = 0;
        while let Some((class, tree)) = self.pairs.pop() {
            self.steps += 1;
            agreements += self.unite(class, tree)?;
            for column in 0..symbols {
                let below = self.child[tree as usize * symbols + column];
                if below == NONE {
                    continue;
                }
                let slot = class as usize * symbols + column;
                let beside = self.child[slot];
                if beside == NONE {
                    self.set_child(slot, below);
                } else {
                    self.pairs.push((beside, below));
                }
            }
        }
        Some(agreements)
    }

    fn set_child(&mut self, slot: usize, class: u32) {
        self.trail
            .push(Change::Child(slot as u32, self.child[slot]));
        self.child[slot] = class;
    }

    /// Makes one class of two, without what is below. The number of labels that
    /// agree, 0 or 1; none if a fact is violated.
    fn unite(&mut self, class: u32, other: u32) -> Option<u32> {
        let (one, two) = (self.output[class as usize], self.output[other as usize]);
        if one != OPEN && two != OPEN && one != two {
            return None;
        }
        if self.constrained {
            self.into[other as usize] = class;
            self.trail.push(Change::Into(other));
        }
        if two != OPEN && one == OPEN {
            self.output[class as usize] = two;
            self.trail.push(Change::Output(class));
        }
        if self.constrained {
            // Those whose output is news tell their partners.
            let (ring, tail) = (self.head[class as usize], self.head[other as usize]);
            if one == OPEN && two != OPEN && !self.spread(ring, two)
                || two == OPEN && one != OPEN && !self.spread(tail, one)
            {
                return None;
            }
            self.join(class, ring, tail);
        }
        Some(u32::from(one != OPEN && one == two))
    }

    /// Joins the rings of two classes to that of the first.
    fn join(&mut self, class: u32, ring: u32, tail: u32) {
        if tail == NONE {
            return;
        }
        if ring == NONE {
            self.trail.push(Change::Head(class, NONE));
            self.head[class as usize] = tail;
            return;
        }
        for node in [ring, tail] {
            self.trail
                .push(Change::Ring(node, self.ring[node as usize]));
        }
        self.ring.swap(ring as usize, tail as usize);
    }

    /// Passes on that all nodes of a ring have this output; `false` if a fact is
    /// violated.
    fn spread(&mut self, ring: u32, output: u8) -> bool {
        if ring == NONE {
            return true;
        }
        let instance = self.instance;
        self.flips.clear();
        self.flips.push(ring);
        while let Some(ring) = self.flips.pop() {
            let mut node = ring;
            loop {
                self.steps += 1;
                for place in instance.partners(node) {
                    let partner = instance.partner(place);
                    if partner.above != (output == ACCEPT) {
                        continue;
                    }
                    let class = self.find(partner.node) as usize;
                    if self.output[class] == OPEN {
                        self.output[class] = output;
                        self.trail.push(Change::Output(class as u32));
                        self.flips.push(self.head[class]);
                    } else if self.output[class] != output {
                        return false;
                    }
                }
                node = self.ring[node as usize];
                if node == ring {
                    break;
                }
            }
        }
        true
    }

    /// The class of a node.
    fn find(&self, mut node: Node) -> u32 {
        while self.into[node as usize] != node {
            node = self.into[node as usize];
        }
        node
    }
}
