//! What was heard, on the nodes of a prefix tree that a table can be run on.

use automata::Word;

use crate::belief::{Ending, Heard, Tally, Verdict, compared};
use crate::evidence::Fact;

/// A node of the tree; parents come before their children.
#[derive(Clone, Copy, Debug)]
struct Node {
    parent: u32,
    symbol: u32,
}

/// No state.
const NOWHERE: u8 = u8::MAX;

/// All that was heard so far.
#[derive(Clone, Debug)]
pub(crate) struct Script {
    symbols: usize,
    nodes: Vec<Node>,
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
            nodes: vec![Node {
                parent: 0,
                symbol: 0,
            }],
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
        word.iter().fold(0, |node, symbol| {
            let place = node as usize * self.symbols + symbol.index();
            if self.children[place] == 0 {
                self.children[place] = self.nodes.len() as u32;
                self.nodes.push(Node {
                    parent: node,
                    symbol: symbol.index() as u32,
                });
                self.children.extend(std::iter::repeat_n(0, self.symbols));
            }
            self.children[place]
        })
    }

    /// The number of things heard.
    pub(crate) fn len(&self) -> usize {
        self.labels.len() + self.comparisons.len()
    }

    /// Where every word ends in the table, and which edges are used.
    pub(crate) fn run(&self, delta: &[u8], at: &mut Vec<u8>, used: &mut Vec<bool>) {
        at.clear();
        at.push(0);
        used.clear();
        used.resize(delta.len(), false);
        for node in &self.nodes[1..] {
            let edge = usize::from(at[node.parent as usize]) * self.symbols + node.symbol as usize;
            used[edge] = true;
            at.push(delta[edge]);
        }
    }

    /// What was heard, as a table with these outputs sees it whose states at the
    /// nodes are `at`. In a rejecting sink words of all kinds end: it is no place
    /// that they share.
    pub(crate) fn tally(&self, delta: &[u8], output: &[bool], at: &[u8]) -> Tally {
        let mut tally = Tally::default();
        let is_sink = |state: &usize| {
            let row = state * self.symbols..(state + 1) * self.symbols;
            !output[*state] && delta[row].iter().all(|&t| usize::from(t) == *state)
        };
        let sink = (0..output.len()).find(is_sink).map_or(NOWHERE, |s| s as u8);
        for &(node, accepted, sure) in &self.labels {
            let out = output[usize::from(at[node as usize])];
            tally.label(out == accepted, sure);
        }
        for &(first, second, verdict, sure) in &self.comparisons {
            let (first, second) = (at[first as usize], at[second as usize]);
            let (one, other) = (output[usize::from(first)], output[usize::from(second)]);
            let same = first == second && first != sink;
            let ending = Ending::of(one, other, same);
            tally.comparison(ending, verdict, sure);
        }
        tally
    }
}
