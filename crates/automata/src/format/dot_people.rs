//! DOT for people: what to hand to Graphviz for a picture.
//!
//! Not for programs, which would misread it: letters that lead the same way
//! share an arrow, the largest group of a state's letters is called
//! "otherwise", and states from which nothing is accepted are not drawn. For
//! programs see [`dot`](super::dot).

use std::collections::BTreeMap;
use std::fmt::Write as _;

use crate::{Dfa, StateId};

/// From how many letters on a group is called "otherwise".
const OTHERWISE: usize = 3;

/// Writes a picture of an automaton.
///
/// Where dead states are hidden, a note says that a letter without an arrow
/// rejects for good, and no group of such a state is called "otherwise": there
/// would be two kinds of other letters.
pub fn write(dfa: &Dfa) -> String {
    let live = dfa.live();
    // An empty language is drawn as it is: there would be nothing left.
    let hides = |q: StateId| live[dfa.start().index()] && !live[q.index()];
    let mut text = String::from(
        "digraph automaton {\n  rankdir=LR;\n  node [shape=circle label=\"\" width=0.4];\n  start [shape=point width=0.1];\n",
    );
    if dfa.states().any(hides) {
        text.push_str("  label=\"A letter without an arrow rejects for good.\";\n");
    }
    let _ = writeln!(text, "  start -> {};", dfa.start().index());
    for state in dfa.states().filter(|&q| !hides(q)) {
        let shape = if dfa.is_accepting(state) {
            " [shape=doublecircle]"
        } else {
            ""
        };
        let _ = writeln!(text, "  {}{shape};", state.index());
        for (target, label) in arrows(dfa, state, &hides) {
            let _ = writeln!(
                text,
                "  {} -> {} [label=\"{label}\"];",
                state.index(),
                target.index()
            );
        }
    }
    text.push_str("}\n");
    text
}

/// The arrows that leave a state, with what is written on them, by target.
fn arrows(dfa: &Dfa, state: StateId, hides: &impl Fn(StateId) -> bool) -> Vec<(StateId, String)> {
    let mut groups: BTreeMap<StateId, Vec<&str>> = BTreeMap::new();
    for symbol in dfa.alphabet().symbols() {
        let letters = groups.entry(dfa.next(state, symbol)).or_default();
        letters.push(dfa.alphabet().name(symbol));
    }
    let all = groups.len() == 1;
    let some_hidden = groups.keys().any(|&q| hides(q));
    // The first of the largest: `max_by_key` would take the last.
    let largest = groups
        .iter()
        .rev()
        .max_by_key(|(_, letters)| letters.len())
        .map(|(&target, _)| target);
    groups
        .into_iter()
        .filter(|(target, _)| !hides(*target))
        .map(|(target, letters)| {
            let many = letters.len() >= OTHERWISE;
            let label = if all && many {
                "any".to_owned()
            } else if many && !some_hidden && largest == Some(target) {
                "otherwise".to_owned()
            } else {
                letters.join(", ")
            };
            (target, label)
        })
        .collect()
}
