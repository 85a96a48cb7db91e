//! What was heard, as a prefix tree that grows with every answer. Must not know how
//! tables are judged by it: see [`Plan`].

use automata::Word;

use super::plan::Plan;
use crate::belief::{Heard, Verdict, compared};
use crate::evidence::Fact;

/// A node of the tree. The root is its own parent.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Node {
    pub(super) parent: u32,
    /// The symbol that leads here from the parent.
    pub(super) symbol: u32,
    pub(super) depth: u32,
}

/// A label of a node, and whether it is sure.
#[derive(Clone, Copy, Debug)]
pub(super) struct Labelled {
    pub(super) node: u32,
    pub(super) accepted: bool,
    pub(super) sure: bool,
}

/// What a comparison of two nodes came to, and whether that is sure.
#[derive(Clone, Copy, Debug)]
pub(super) struct Compared {
    pub(super) first: u32,
    pub(super) second: u32,
    pub(super) verdict: Verdict,
    pub(super) sure: bool,
}

/// All that was heard so far.
#[derive(Clone, Debug)]
pub(crate) struct Script {
    symbols: usize,
    /// In the order in which they came, from the root.
    nodes: Vec<Node>,
    /// `children[node * symbols + symbol]`, 0 for none.
    children: Vec<u32>,
    labels: Vec<Labelled>,
    comparisons: Vec<Compared>,
}

impl Script {
    /// Nothing heard.
    pub(crate) fn new(symbols: usize) -> Self {
        Self {
            symbols,
            nodes: vec![Node::default()],
            children: vec![0; symbols],
            labels: Vec::new(),
            comparisons: Vec::new(),
        }
    }

    /// Takes note of one thing more.
    pub(crate) fn add(&mut self, heard: &Heard<Word>) {
        let sure = heard.sure;
        if let Fact::Label { atom, accepted } = &heard.fact {
            let (node, accepted) = (self.insert(atom), *accepted);
            self.labels.push(Labelled {
                node,
                accepted,
                sure,
            });
        }
        if let Some((first, second, verdict)) = compared(&heard.fact) {
            let (first, second) = (self.insert(first), self.insert(second));
            self.comparisons.push(Compared {
                first,
                second,
                verdict,
                sure,
            });
        }
    }

    fn insert(&mut self, word: &Word) -> u32 {
        let mut parent = 0;
        for (depth, symbol) in (1..).zip(word.iter()) {
            let place = parent as usize * self.symbols + symbol.index();
            if self.children[place] == 0 {
                self.children[place] = self.nodes.len() as u32;
                self.children.extend(std::iter::repeat_n(0, self.symbols));
                self.nodes.push(Node {
                    parent,
                    symbol: symbol.index() as u32,
                    depth,
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

    /// How tables are judged by it.
    pub(crate) fn plan(&self) -> Plan {
        Plan::new(self.symbols, &self.nodes, &self.labels, &self.comparisons)
    }
}
