//! The prefix tree of all words that evidence speaks of.

use automata::{Symbol, Word};

/// A node of a [`PrefixTree`]; the root, the empty word, is 0. Every node's
/// parent has a smaller number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) struct NodeId(u32);

impl NodeId {
    /// The empty word.
    pub(crate) const ROOT: Self = Self(0);

    /// The node's place, dense from 0.
    pub(crate) fn index(self) -> usize {
        self.0 as usize
    }
}

/// A tree that only grows: one node for every prefix of an inserted word.
#[derive(Clone, Debug)]
pub(crate) struct PrefixTree {
    symbols: usize,
    /// Row-major: `children[node * symbols + symbol]`.
    children: Vec<Option<NodeId>>,
    /// The parent and the symbol that leads here; none for the root.
    parents: Vec<Option<(NodeId, Symbol)>>,
}

impl PrefixTree {
    /// The tree of the empty word alone, over an alphabet of `symbols` symbols.
    pub(crate) fn new(symbols: usize) -> Self {
        Self {
            symbols,
            children: vec![None; symbols],
            parents: vec![None],
        }
    }

    /// The node of `word`, grown if need be.
    pub(crate) fn insert(&mut self, word: &Word) -> NodeId {
        word.iter().fold(NodeId::ROOT, |node, symbol| {
            let slot = node.index() * self.symbols + symbol.index();
            if let Some(child) = self.children[slot] {
                return child;
            }
            let child =
                NodeId(u32::try_from(self.parents.len()).expect("fewer than 2^32 prefixes"));
            self.children[slot] = Some(child);
            self.parents.push(Some((node, symbol)));
            self.children
                .extend(std::iter::repeat_n(None, self.symbols));
            child
        })
    }

    /// The number of nodes, at least 1.
    pub(crate) fn size(&self) -> usize {
        self.parents.len()
    }

    /// All nodes, parents before children.
    pub(crate) fn nodes(&self) -> impl DoubleEndedIterator<Item = NodeId> + use<> {
        (0..self.size() as u32).map(NodeId)
    }

    /// The node one symbol further.
    pub(crate) fn child(&self, node: NodeId, symbol: Symbol) -> Option<NodeId> {
        self.children[node.index() * self.symbols + symbol.index()]
    }

    /// The node one symbol before, and that symbol; none for the root.
    pub(crate) fn parent(&self, node: NodeId) -> Option<(NodeId, Symbol)> {
        self.parents[node.index()]
    }
}
