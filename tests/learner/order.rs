//! The closure of preferences and labels against all preorders.

use std::sync::LazyLock;

use memrep::concept::{Cause, FiniteAtom, Preorder};
use memrep::evidence::{AnswerId, Comparison, Fact};
use proptest::prelude::*;

use crate::brute::{ATOMS, Relation, fact, holds, worlds};

static WORLDS: LazyLock<Vec<(Relation, u8)>> = LazyLock::new(worlds);

fn atoms() -> impl Iterator<Item = FiniteAtom> {
    (0..ATOMS).map(FiniteAtom)
}

fn is_possible(facts: &[Fact<FiniteAtom>]) -> bool {
    WORLDS
        .iter()
        .any(|&world| facts.iter().all(|fact| holds(world, fact)))
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 1500, ..ProptestConfig::default() })]

    /// Told what is true in some world, the order implies a label or an answer
    /// exactly if all worlds in which that is true agree on it.
    #[test]
    fn implies_what_all_worlds_agree_on(
        world in any::<prop::sample::Index>(),
        asked in prop::collection::vec((0..ATOMS, 0..ATOMS), 0..6),
    ) {
        let truth = WORLDS[world.index(WORLDS.len())];
        let mut order = Preorder::default();
        let mut facts = Vec::new();
        for (number, (first, second)) in asked.into_iter().enumerate() {
            let (first, second) = (FiniteAtom(first), FiniteAtom(second));
            let fact = if first == second {
                Fact::Label { atom: first, accepted: truth.1 >> first.0 & 1 == 1 }
            } else {
                Fact::compared(first, second, truth.0.compare(first, second))
            };
            order.add(Some(AnswerId(number as u32)), &fact);
            facts.push(fact);
        }
        let possible: Vec<_> = WORLDS
            .iter()
            .filter(|&&world| facts.iter().all(|fact| holds(world, fact)))
            .collect();
        prop_assert_eq!(order.conflict(), None);
        for atom in atoms() {
            let labels: Vec<bool> = possible.iter().map(|w| w.1 >> atom.0 & 1 == 1).collect();
            let agreed = labels.iter().all(|l| *l == labels[0]).then_some(labels[0]);
            prop_assert_eq!(order.label(&atom), agreed, "{:?} of {:?}", atom, facts);
        }
        for first in atoms() {
            for second in atoms() {
                let answers: Vec<Comparison> =
                    possible.iter().map(|w| w.0.compare(first, second)).collect();
                let agreed = answers.iter().all(|a| *a == answers[0]).then_some(answers[0]);
                prop_assert_eq!(
                    order.comparison(&first, &second), agreed, "{:?} {:?} of {:?}", first, second, facts
                );
            }
        }
    }

    /// A conflict is found exactly if no world is left, and is minimal.
    #[test]
    fn conflicts_are_found_and_minimal(facts in prop::collection::vec(fact(), 0..9)) {
        let mut order = Preorder::default();
        for (number, fact) in facts.iter().enumerate() {
            order.add(Some(AnswerId(number as u32)), fact);
        }
        let Some(conflict) = order.conflict() else {
            prop_assert!(is_possible(&facts), "{:?}", facts);
            return Ok(());
        };
        let blamed = |without: Option<AnswerId>| -> Vec<Fact<FiniteAtom>> {
            let answers = conflict.answers.iter().filter(|a| Some(**a) != without);
            answers.map(|answer| facts[answer.0 as usize].clone()).collect()
        };
        prop_assert!(!is_possible(&blamed(None)), "{:?} of {:?}", conflict, facts);
        for &answer in &conflict.answers {
            prop_assert!(is_possible(&blamed(Some(answer))), "{:?} of {:?}", conflict, facts);
        }
        let labels = blamed(None).iter().any(|fact| matches!(fact, Fact::Label { .. }));
        let equal = blamed(None).iter().any(|fact| matches!(fact, Fact::Equal { .. }));
        let cause = match (labels, equal) {
            (true, _) => Cause::MemRep,
            (false, true) => Cause::Equality,
            (false, false) => Cause::Order,
        };
        prop_assert_eq!(conflict.cause, cause);
    }
}

/// What is known from the start is never blamed, and an answer that brought
/// several facts is blamed once.
#[test]
fn blames_answers_only() {
    let [a, b, c] = [0, 1, 2].map(FiniteAtom);
    let below = |worse, better| Fact::Below { worse, better };
    let mut order = Preorder::default();
    order.add(None, &below(a, b));
    order.add(Some(AnswerId(7)), &below(b, c));
    order.add(Some(AnswerId(7)), &below(c, a));
    let conflict = order.conflict().expect("a ≺ b ≺ c ≺ a is a cycle");
    assert_eq!(conflict.answers, [AnswerId(7)]);
    assert_eq!(conflict.cause, Cause::Order);
}

/// Of several conflicts the one with the fewest answers is told.
#[test]
fn tells_the_smallest() {
    let [a, b, c, d] = [0, 1, 2, 3].map(FiniteAtom);
    let mut order = Preorder::default();
    for (number, (worse, better)) in [(a, b), (b, c), (c, d), (d, a), (d, b)]
        .into_iter()
        .enumerate()
    {
        let fact = Fact::Below { worse, better };
        order.add(Some(AnswerId(number as u32)), &fact);
    }
    let conflict = order.conflict().expect("there are two cycles");
    assert_eq!(conflict.answers, [1, 2, 4].map(AnswerId));
}

/// "Cannot compare" claims nothing, so nothing contradicts it.
#[test]
fn incomparable_never_contradicts() {
    let [a, b] = [0, 1].map(FiniteAtom);
    let mut order = Preorder::default();
    order.add(
        Some(AnswerId(0)),
        &Fact::Incomparable {
            first: a,
            second: b,
        },
    );
    assert_eq!(order.comparison(&b, &a), Some(Comparison::Incomparable));
    order.add(
        Some(AnswerId(1)),
        &Fact::Below {
            worse: a,
            better: b,
        },
    );
    assert_eq!(order.conflict(), None);
    assert_eq!(order.comparison(&b, &a), Some(Comparison::First));
}
