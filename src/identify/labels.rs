//! How labels travel along preferences: what facts say about every word before
//! any automaton is considered.

use super::problem::{Constraint, FactId, Problem};
use super::tree::NodeId;

/// The labels that facts force on words, whatever the automaton.
///
/// Facts of the form `φ(x) ≤ φ(y)` make a graph; acceptance travels along its
/// edges and rejection against them. Some language is consistent exactly if no
/// word is reached by both.
pub(crate) struct Forced {
    accepted: Vec<bool>,
    rejected: Vec<bool>,
}

impl Forced {
    /// What the facts `standing` force on the nodes of the problem's tree.
    pub(crate) fn new(problem: &Problem, standing: &[FactId]) -> Self {
        let size = problem.tree().size();
        let mut forced = Self {
            accepted: vec![false; size],
            rejected: vec![false; size],
        };
        let mut edges: Vec<(NodeId, NodeId)> = Vec::new();
        let (mut up, mut down) = (Vec::new(), Vec::new());
        for &fact in standing {
            match problem.facts()[fact.index()].constraint {
                Constraint::Label(node, true) => up.push(node),
                Constraint::Label(node, false) => down.push(node),
                Constraint::AtMost(low, high) => edges.push((low, high)),
                Constraint::Same(one, other) => edges.extend([(one, other), (other, one)]),
            }
        }
        edges.sort_unstable();
        spread(&mut forced.accepted, up, &edges);
        for edge in &mut edges {
            *edge = (edge.1, edge.0);
        }
        edges.sort_unstable();
        spread(&mut forced.rejected, down, &edges);
        forced
    }

    /// Whether no language at all is consistent.
    pub(crate) fn clash(&self) -> bool {
        (self.accepted.iter().zip(&self.rejected))
            .any(|(&accepted, &rejected)| accepted && rejected)
    }

    /// The label that every consistent language gives to the node's word; none
    /// if there are both kinds of languages. Meaningless after a clash.
    pub(crate) fn label(&self, node: NodeId) -> Option<bool> {
        match (self.accepted[node.index()], self.rejected[node.index()]) {
            (true, _) => Some(true),
            (_, true) => Some(false),
            _ => None,
        }
    }
}

/// Marks everything that `from` reaches along `edges`, which are sorted.
fn spread(marks: &mut [bool], mut from: Vec<NodeId>, edges: &[(NodeId, NodeId)]) {
    while let Some(node) = from.pop() {
        if std::mem::replace(&mut marks[node.index()], true) {
            continue;
        }
        let start = edges.partition_point(|&(source, _)| source < node);
        let reached = edges[start..].iter().take_while(|edge| edge.0 == node);
        from.extend(reached.map(|edge| edge.1));
    }
}
