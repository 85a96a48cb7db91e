//! What was heard, on the nodes of a prefix tree that a table can be run on.

use automata::Word;

use super::LARGEST;
use crate::belief::{Ending, Heard, Place, Tally, Verdict, compared};
use crate::evidence::Fact;

/// A node of the tree but its root.
#[derive(Clone, Copy, Debug)]
struct Node {
    number: u32,
    parent: u32,
    symbol: u32,
}

/// No state.
const NOWHERE: u8 = u8::MAX;

/// The words of a script on a table.
#[derive(Clone, Debug, Default)]
pub(crate) struct Run {
    at: Vec<At>,
    /// By state, what ends of words there have in common: in acceptance, how many words
    /// of two symbols lead on to it.
    places: Vec<Place>,
}

/// A node of a [`Run`]: its state, and above that how long its word did well.
#[derive(Clone, Copy, Debug, Default)]
struct At(u32);

impl At {
    fn new(state: u8, progress: u32) -> Self {
        Self(progress << u8::BITS | u32::from(state))
    }

    fn state(self) -> usize {
        usize::from(self.0 as u8)
    }

    fn progress(self) -> u32 {
        self.0 >> u8::BITS
    }
}

/// All that was heard so far.
#[derive(Clone, Debug)]
pub(crate) struct Script {
    symbols: usize,
    /// The nodes by depth, from 1. Those of a depth do not wait for each other, and a
    /// processor steps on several at once.
    levels: Vec<Vec<Node>>,
    /// The number of nodes, the root among them.
    nodes: usize,
    /// `children[node * symbols + symbol]`, 0 for none.
    children: Vec<u32>,
    labels: Vec<(u32, bool, bool)>,
    comparisons: Vec<(u32, u32, Verdict, bool)>,
}

impl Script {
    /// Nothing heard.
    pub(crate) fn new(symbols: usize) -> Self {
        Self {
            symbols,
            levels: Vec::new(),
            nodes: 1,
            children: vec![0; symbols],
            labels: Vec::new(),
            comparisons: Vec::new(),
        }
    }

    /// Takes note of one thing more.
    pub(crate) fn add(&mut self, heard: &Heard<Word>) {
        if let Fact::Label { atom, accepted } = &heard.fact {
            let node = self.insert(atom);
            self.labels.push((node, *accepted, heard.sure));
        }
        if let Some((first, second, verdict)) = compared(&heard.fact) {
            let (first, second) = (self.insert(first), self.insert(second));
            self.comparisons.push((first, second, verdict, heard.sure));
        }
    }

    fn insert(&mut self, word: &Word) -> u32 {
        let mut parent = 0;
        for (depth, symbol) in word.iter().enumerate() {
            let place = parent as usize * self.symbols + symbol.index();
            if self.children[place] == 0 {
                let number = self.nodes as u32;
                self.nodes += 1;
                self.children[place] = number;
                self.children.extend(std::iter::repeat_n(0, self.symbols));
                if self.levels.len() == depth {
                    self.levels.push(Vec::new());
                }
                self.levels[depth].push(Node {
                    number,
                    parent,
                    symbol: symbol.index() as u32,
                });
            }
            parent = self.children[place];
        }
        parent
    }

    /// The number of things heard.
    pub(crate) fn len(&self) -> usize {
        self.labels.len() + self.comparisons.len()
    }

    /// The number of different beginnings of words heard.
    pub(crate) fn nodes(&self) -> usize {
        self.nodes
    }

    /// Runs every word on the table: where it ends, and how long it did well.
    pub(crate) fn run(&self, delta: &[u8], output: &[bool], run: &mut Run) {
        let is_sink = |state: &usize| {
            let row = state * self.symbols..(state + 1) * self.symbols;
            !output[*state] && delta[row].iter().all(|&t| usize::from(t) == *state)
        };
        let sink = (0..output.len()).find(is_sink).map_or(NOWHERE, |s| s as u8);
        run.at.resize(self.nodes, At::default());
        let step = |state: u8, depth| Step {
            depth,
            accepting: output[usize::from(state)],
            sunk: state == sink,
        };
        if !self.comparisons.is_empty() {
            run.survey(self.symbols, delta, output);
        }
        run.at[0] = At::new(0, step(0, 0).progress(None));
        for (depth, nodes) in (1..).zip(&self.levels) {
            for node in nodes {
                let parent = run.at[node.parent as usize];
                let state = delta[parent.state() * self.symbols + node.symbol as usize];
                let progress = step(state, depth).progress(Some(parent.progress()));
                run.at[node.number as usize] = At::new(state, progress);
            }
        }
    }

    /// What was heard, as a table with these outputs sees it after its [`Run`].
    pub(crate) fn tally(&self, output: &[bool], run: &Run) -> Tally {
        let mut tally = Tally::default();
        for &(node, accepted, sure) in &self.labels {
            let out = output[run.at[node as usize].state()];
            tally.label(out == accepted, sure);
        }
        if self.comparisons.is_empty() {
            return tally;
        }
        let end = |node: u32| {
            let at = run.at[node as usize];
            run.places[at.state()].end(at.progress())
        };
        for &(first, second, verdict, sure) in &self.comparisons {
            tally.comparison(Ending::of(end(first), end(second)), verdict, sure);
        }
        tally
    }
}

impl Run {
    /// Looks at the places of a table.
    fn survey(&mut self, symbols: usize, delta: &[u8], output: &[bool]) {
        let mut ways = [0_u32; LARGEST];
        let rows = || delta.chunks_exact(symbols);
        for (ways, row) in ways.iter_mut().zip(rows()) {
            *ways = row
                .iter()
                .map(|&to| u32::from(output[usize::from(to)]))
                .sum();
        }
        self.places.clear();
        for (state, (row, &accepting)) in (0..).zip(rows().zip(output)) {
            self.places.push(if accepting {
                Place::inside(state, row.iter().map(|&to| ways[usize::from(to)]).sum())
            } else {
                Place::outside(state)
            });
        }
    }
}

/// One step of a word's run.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Step {
    /// How many symbols were read.
    pub(crate) depth: u32,
    /// Whether the state that was reached accepts.
    pub(crate) accepting: bool,
    /// Whether it is a rejecting sink.
    pub(crate) sunk: bool,
}

/// More than the length of any word; what comes after it fits beside a state.
const AFLOAT: u32 = 1 << 16;

impl Step {
    /// How long the word did well (section 5.3, "Tomita languages"): until it
    /// fell into a rejecting sink; what never did comes after all that did, by
    /// its longest accepted prefix.
    pub(crate) fn progress(self, before: Option<u32>) -> u32 {
        // No branches: this is what chains spend most of their time on.
        let limit = if self.sunk { self.depth } else { u32::MAX };
        let reached = AFLOAT + self.depth + 1;
        let least = if self.accepting { reached } else { 0 };
        before.unwrap_or(AFLOAT).min(limit).max(least)
    }
}
