//! The standing facts in canonical form: what the enumerator reads in its inner
//! loop, and a function of the set of facts alone.

use super::labels::Forced;
use super::problem::{Constraint, FactId, Problem};
use super::tree::NodeId;

/// A node of an [`Instance`]: a prefix of a word that constrains the language.
/// Nodes are numbered in length-lexicographic order of their words.
pub(crate) type Node = u32;

/// One end of a constraint `φ(x) ≤ φ(y)` between two unlabelled words.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Partner {
    /// The word at the other end.
    pub(crate) node: Node,
    /// Whether the other end is the greater one, `y`.
    pub(crate) above: bool,
}

/// The prefix tree of those words that still constrain the language after
/// labels have travelled along preferences.
///
/// Words that only retracted facts speak of are not in it, nor are preferences
/// that forced labels already satisfy; so neither the order of facts nor what
/// was retracted can be seen in it.
#[derive(Debug, PartialEq, Eq)]
pub(crate) struct Instance {
    /// The number of symbols of the alphabet.
    pub(crate) symbols: usize,
    /// `children[first[v]..first[v + 1]]` would be `v`'s children, but because
    /// of the numbering they are simply the nodes `first[v]..first[v + 1]`.
    first_child: Vec<Node>,
    /// The last symbol of each node's word; 0 for the root.
    pub(crate) symbol: Vec<u32>,
    /// The label of each node's word, where it is forced.
    pub(crate) label: Vec<Option<bool>>,
    first_partner: Vec<u32>,
    partners: Vec<Partner>,
    /// How many constrained words pass through each node, at least 1: a guess
    /// of how much is decided when the node's state is.
    pub(crate) weight: Vec<u32>,
}

impl Instance {
    /// The facts `standing` of `problem`; none if no language is consistent.
    pub(crate) fn new(problem: &Problem, standing: &[FactId]) -> Option<Self> {
        let forced = Forced::new(problem, standing);
        if forced.clash() {
            return None;
        }
        let mut edges: Vec<(NodeId, NodeId)> = Vec::new();
        let mut needed = vec![false; problem.tree().size()];
        needed[NodeId::ROOT.index()] = true;
        for &fact in standing {
            let (one, other, both_ways) = match problem.facts()[fact.index()].constraint {
                Constraint::Label(node, _) => {
                    needed[node.index()] = true;
                    continue;
                }
                Constraint::AtMost(low, high) => (low, high, false),
                Constraint::Same(one, other) => (one, other, true),
            };
            match (forced.label(one), forced.label(other)) {
                // Neither is forced: then the preference itself is needed.
                (None, None) if one != other => {
                    edges.push((one, other));
                    if both_ways {
                        edges.push((other, one));
                    }
                }
                // What a preference forces stands in the labels.
                _ => {}
            }
            for end in [one, other] {
                needed[end.index()] |= forced.label(end).is_some();
            }
        }
        for &(low, high) in &edges {
            needed[low.index()] = true;
            needed[high.index()] = true;
        }
        Some(Self::number(problem, &forced, &edges, &needed))
    }

    /// Numbers the needed nodes and their ancestors breadth first.
    fn number(
        problem: &Problem,
        forced: &Forced,
        edges: &[(NodeId, NodeId)],
        needed: &[bool],
    ) -> Self {
        let tree = problem.tree();
        let mut weights: Vec<u32> = needed.iter().map(|&needed| u32::from(needed)).collect();
        for node in tree.nodes().rev() {
            if let Some((parent, _)) = tree.parent(node) {
                weights[parent.index()] += weights[node.index()];
            }
        }
        let mut order = vec![NodeId::ROOT];
        let mut number = vec![0; tree.size()];
        let mut symbol = vec![0];
        let mut first_child = Vec::new();
        let mut next = 0;
        while let Some(&node) = order.get(next) {
            next += 1;
            first_child.push(order.len() as Node);
            for letter in problem.alphabet().symbols() {
                if let Some(child) = tree.child(node, letter)
                    && weights[child.index()] > 0
                {
                    number[child.index()] = order.len() as Node;
                    order.push(child);
                    symbol.push(letter.index() as u32);
                }
            }
        }
        first_child.push(order.len() as Node);

        let mut ends: Vec<(Node, Partner)> = Vec::with_capacity(2 * edges.len());
        for &(low, high) in edges {
            let (low, high) = (number[low.index()], number[high.index()]);
            let (below, above) = (false, true);
            ends.push((low, Partner { node: high, above }));
            ends.push((
                high,
                Partner {
                    node: low,
                    above: below,
                },
            ));
        }
        ends.sort_unstable();
        ends.dedup();
        let mut first_partner = Vec::with_capacity(order.len() + 1);
        let mut at = 0;
        for node in 0..order.len() as Node {
            first_partner.push(at as u32);
            while ends.get(at).is_some_and(|end| end.0 == node) {
                at += 1;
            }
        }
        first_partner.push(at as u32);

        Self {
            symbols: problem.alphabet().len(),
            first_child,
            symbol,
            label: (order.iter())
                .map(|&node| forced.label(node).filter(|_| needed[node.index()]))
                .collect(),
            first_partner,
            partners: ends.into_iter().map(|(_, partner)| partner).collect(),
            weight: order.iter().map(|node| weights[node.index()]).collect(),
        }
    }

    /// The number of nodes, at least 1.
    pub(crate) fn size(&self) -> usize {
        self.symbol.len()
    }

    /// The nodes one symbol further.
    pub(crate) fn children(&self, node: Node) -> std::ops::Range<Node> {
        self.first_child[node as usize]..self.first_child[node as usize + 1]
    }

    /// The preferences that the node's word takes part in.
    pub(crate) fn partners(&self, node: Node) -> std::ops::Range<usize> {
        self.first_partner[node as usize] as usize..self.first_partner[node as usize + 1] as usize
    }

    /// The preference end at a place of [`Self::partners`].
    pub(crate) fn partner(&self, place: usize) -> Partner {
        self.partners[place]
    }
}

#[cfg(test)]
mod tests {
    use automata::{Alphabet, Word};

    use super::*;
    use crate::evidence::Fact;

    fn word(text: &str) -> Word {
        let symbol = |letter| automata::Symbol::new(usize::from(letter == 'b'));
        text.chars().map(symbol).collect()
    }

    fn label(text: &str, accepted: bool) -> Fact<Word> {
        Fact::Label {
            atom: word(text),
            accepted,
        }
    }

    fn below(worse: &str, better: &str) -> Fact<Word> {
        Fact::Below {
            worse: word(worse),
            better: word(better),
        }
    }

    /// The instance of those facts that are marked, given in this order.
    fn instance(facts: &[(bool, Fact<Word>)]) -> Option<Instance> {
        let mut problem = Problem::new(Alphabet::new(["a", "b"]).expect("two names"));
        let standing: Vec<FactId> = (facts.iter())
            .filter_map(|(stands, fact)| problem.add(None, fact).filter(|_| *stands))
            .collect();
        Instance::new(&problem, &standing)
    }

    #[test]
    fn neither_order_nor_retracted_facts_are_seen() {
        let facts = [
            (true, label("ab", true)),
            (true, below("ba", "b")),
            (true, below("aa", "bb")),
        ];
        let expected = instance(&facts).expect("consistent");
        let mut others = facts.to_vec();
        others.reverse();
        others.insert(1, (false, label("bbbb", false)));
        others.push((false, below("ab", "aaa")));
        others.push((true, below("aa", "bb")));
        assert_eq!(instance(&others), Some(expected));
    }

    #[test]
    fn what_labels_settle_is_left_out() {
        let settled = instance(&[
            (true, label("a", true)),
            // Forces `b`.
            (true, below("a", "b")),
            // Says nothing of `ab`, for `b` is accepted.
            (true, below("ab", "b")),
        ])
        .expect("consistent");
        let plain = instance(&[(true, label("a", true)), (true, label("b", true))]);
        assert_eq!(Some(settled), plain);
    }

    #[test]
    fn labels_that_meet_have_no_instance() {
        let facts = [
            (true, label("a", true)),
            (true, below("a", "b")),
            (true, below("b", "bb")),
            (true, label("bb", false)),
        ];
        assert_eq!(instance(&facts), None);
        assert!(instance(&facts[..3]).is_some());
    }
}
