//! What is defined can be undone, whatever it was.

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
            std::iter::successors(some(head), |&node| some(partial.behind[node as usize])).collect()
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
