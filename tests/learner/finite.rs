//! The learner on small finite classes: it ends with the target, and asks
//! nothing in vain.

use std::sync::LazyLock;

use memrep::concept::{ConceptClass, FiniteAtom, FiniteClass, FiniteConcept};
use memrep::evidence::{AnswerId, Comparison, Fact};
use memrep::learner::{Config, Learner, Question, Step, Strategy};
use proptest::prelude::*;

use crate::brute::{ATOMS, Relation, class, holds, preorders, worlds};
use crate::teacher::{TableTeacher, reply};

pub(crate) static WORLDS: LazyLock<Vec<(Relation, u8)>> = LazyLock::new(worlds);
pub(crate) static PREORDERS: LazyLock<Vec<Relation>> = LazyLock::new(preorders);

/// More questions than there are membership queries, comparisons and wrong
/// hypotheses.
const CAP: u32 = ATOMS + ATOMS * (ATOMS - 1) / 2 + 20;

pub(crate) fn config(strategy: Strategy, seed: u64) -> Config {
    Config {
        strategy,
        membership_cost: 4.0,
        comparison_cost: 1.0,
        seed,
        budget: 1_000_000,
        ..Config::default()
    }
}

pub(crate) fn set_of(class: &FiniteClass, concept: FiniteConcept) -> u8 {
    (0..ATOMS)
        .filter(|atom| class.contains(&concept, &FiniteAtom(*atom)))
        .fold(0, |set, atom| set | 1 << atom)
}

/// The facts that each possible answer to the question would bring.
pub(crate) fn outcomes(question: &Question<FiniteAtom, FiniteConcept>) -> Vec<Fact<FiniteAtom>> {
    match *question {
        Question::Membership { atom } => [true, false]
            .map(|accepted| Fact::Label { atom, accepted })
            .to_vec(),
        Question::Comparison { first, second } => [
            Comparison::First,
            Comparison::Second,
            Comparison::Equal,
            Comparison::Incomparable,
        ]
        .map(|answer| Fact::compared(first, second, answer))
        .to_vec(),
        Question::Equivalence { .. } => Vec::new(),
    }
}

/// The concepts of the smallest consistent size.
fn version_space(class: &FiniteClass, facts: &[Fact<FiniteAtom>]) -> Vec<FiniteConcept> {
    let consistent: Vec<FiniteConcept> = class
        .concepts()
        .filter(|c| {
            facts
                .iter()
                .all(|f| f.holds(|atom| class.contains(c, atom)))
        })
        .collect();
    let least = consistent.iter().map(|c| class.size(*c)).min();
    consistent
        .into_iter()
        .filter(|c| Some(class.size(*c)) == least)
        .collect()
}

/// Teaches `target` under `order` and checks every question on the way.
fn teach(class: &FiniteClass, target: FiniteConcept, order: Relation, config: Config) {
    let infinite = config.comparison_cost.is_infinite();
    let strategy = config.strategy;
    let mut learner = Learner::new(class.clone(), config, Vec::new());
    let mut teacher = TableTeacher::new(class, target, order);
    let mut facts = Vec::new();
    for number in 0..CAP {
        let (question, round) = match learner.next() {
            Step::Ask {
                question,
                round,
                hurried,
            } => {
                assert!(!hurried, "the budget is ample");
                (question, round)
            }
            Step::Done { hypothesis } => {
                assert_eq!(hypothesis, target);
                return;
            }
            Step::Conflict(conflict) => panic!("{conflict:?} of {facts:?}"),
        };
        let space = version_space(class, &facts);
        let hypothesis = learner.hypothesis().expect("the budget is ample");
        assert!(space.contains(hypothesis), "{hypothesis:?} of {facts:?}");
        if let Question::Comparison { .. } = question {
            assert!(strategy == Strategy::Thesis && !infinite);
        }
        match &question {
            Question::Equivalence { hypothesis } => {
                assert_eq!(space, [*hypothesis], "the last of its size");
            }
            question => {
                let possible = outcomes(question)
                    .iter()
                    .filter(|outcome| {
                        WORLDS.iter().any(|&world| {
                            facts
                                .iter()
                                .chain([*outcome])
                                .all(|fact| holds(world, fact))
                        })
                    })
                    .count();
                assert!(possible > 1, "{question:?} is implied by {facts:?}");
                let useful = outcomes(question).iter().any(|outcome| {
                    let mut more = facts.clone();
                    more.push(outcome.clone());
                    version_space(class, &more) != space
                });
                assert!(useful, "{question:?} changes nothing after {facts:?}");
            }
        }
        let reply = reply(&mut teacher, &question);
        learner
            .record(AnswerId(number), question, round, reply)
            .expect("the reply fits");
        facts.extend(
            learner
                .entries()
                .last()
                .and_then(memrep::learner::Entry::fact),
        );
    }
    panic!("not learned after {CAP} questions: {facts:?}");
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 150, ..ProptestConfig::default() })]

    #[test]
    fn learns_every_target(
        class in class(),
        order in any::<prop::sample::Index>(),
        seed in any::<u64>(),
        costs in prop::sample::select(vec![(1.0, 1.0), (8.0, 1.0), (1.0, 4.0), (4.0, f64::INFINITY)]),
        strategy in prop::sample::select(vec![Strategy::Thesis, Strategy::Membership]),
    ) {
        for target in class.concepts() {
            let set = set_of(&class, target);
            let fitting: Vec<Relation> =
                PREORDERS.iter().copied().filter(|o| o.respects(set)).collect();
            let config = Config {
                membership_cost: costs.0,
                comparison_cost: costs.1,
                ..config(strategy, seed)
            };
            teach(&class, target, fitting[order.index(fitting.len())], config);
        }
    }
}
