//! Budgets end, long searches are short where they can be, and samples are
//! even.

use std::collections::BTreeMap;

use automata::{Alphabet, Dfa, Symbol, Word};
use memrep::evidence::{AnswerId, Budget, Fact};
use memrep::identify::{Cause, EngineChoice, Failure};

use super::{ENGINES, identifier, smallest, table};
use crate::draw::Draw;

#[test]
fn a_hard_instance_ends_with_its_budget_and_the_next_one_is_answered() {
    let mut draw = Draw::new(8);
    let alphabet = Draw::alphabet(2);
    // Labels without a pattern: only large automata can tell them apart.
    let mut facts: Vec<Fact<Word>> = Vec::new();
    while facts.len() < 300 {
        let atom = draw.word(2, 11);
        let accepted = draw.number(2) == 0;
        if !(facts.iter()).any(|fact| matches!(fact, Fact::Label { atom: a, .. } if *a == atom)) {
            facts.push(Fact::Label { atom, accepted });
        }
    }
    for engine in ENGINES {
        let mut identifier = identifier(engine, &alphabet, 60, &facts);
        let mut last = 1;
        for units in [0, 1, 1_000, 50_000] {
            let mut budget = Budget::new(units);
            let failure = identifier.smallest(5, 0, &mut budget);
            let Err(Failure::OverBudget { at_least }) = failure else {
                panic!("{engine:?}: 300 arbitrary labels in {units} units")
            };
            assert!(budget.is_spent(), "{engine:?}");
            assert!(at_least >= last, "{engine:?}: it knew more before");
            last = at_least;
        }
        assert!(last > 3, "{engine:?}: {last}");
        for number in 8..facts.len() {
            identifier.retract(AnswerId(number as u32));
        }
        let sample = smallest(&mut identifier, 5, 0);
        for dfa in &sample.automata {
            assert!(facts[..8].iter().all(|fact| super::holds(dfa, fact)));
        }
    }
}

#[test]
fn forty_states_over_one_letter_are_no_work() {
    for engine in [EngineChoice::Enumerate, EngineChoice::Auto] {
        let facts: Vec<Fact<Word>> = (0..=80)
            .map(|length| Fact::Label {
                atom: std::iter::repeat_n(Symbol::new(0), length).collect(),
                accepted: length % 40 == 0,
            })
            .collect();
        let mut identifier = identifier(engine, &Draw::alphabet(1), 64, &facts);
        let mut budget = Budget::new(20_000);
        let sample = identifier
            .smallest(20, 0, &mut budget)
            .expect("a cycle of 40");
        assert!(sample.complete);
        assert_eq!(sample.automata.len(), 1);
        assert_eq!(sample.automata[0].size(), 40);
    }
}

#[test]
fn ten_states_with_many_labels_are_found_and_smaller_ones_refuted() {
    let mut draw = Draw::new(9);
    for number in 0..4 {
        let alphabet = Draw::alphabet(2);
        let target = draw.dfa(&alphabet, 10);
        let facts: Vec<Fact<Word>> = (0..150)
            .map(|_| draw.word(2, 11))
            .map(|atom| Fact::Label {
                accepted: target.accepts(&atom),
                atom,
            })
            .collect();
        let sizes = [EngineChoice::Enumerate, EngineChoice::Batsat].map(|engine| {
            let mut identifier = identifier(engine, &alphabet, 10, &facts);
            smallest(&mut identifier, 1, 0).automata[0].size()
        });
        assert_eq!(sizes[0], sizes[1], "instance {number}");
    }
}

/// A version space of some size at which the enumerator lists and draws.
fn version_space(draw: &mut Draw, sizes: std::ops::Range<usize>) -> (Alphabet, Vec<Fact<Word>>) {
    loop {
        let (alphabet, target, facts) = draw.instance();
        let mut identifier = identifier(EngineChoice::Enumerate, &alphabet, 6, &facts);
        let all = smallest(&mut identifier, sizes.end, 0);
        if target.size() > 2 && sizes.contains(&all.automata.len()) && all.complete {
            return (alphabet, facts);
        }
    }
}

#[test]
fn samples_of_the_enumerator_are_even() {
    let mut draw = Draw::new(10);
    for _ in 0..4 {
        let (alphabet, facts) = version_space(&mut draw, 20..60);
        let mut identifier = identifier(EngineChoice::Enumerate, &alphabet, 6, &facts);
        let all = smallest(&mut identifier, 60, 0).automata;
        for wanted in [1, 10] {
            let rounds = 1_000;
            let mut counts: BTreeMap<_, usize> = BTreeMap::new();
            for seed in 0..rounds {
                for dfa in smallest(&mut identifier, wanted, seed).automata {
                    *counts.entry(table(&dfa)).or_default() += 1;
                }
            }
            assert_eq!(counts.len(), all.len());
            let mean = rounds as f64 * wanted as f64 / all.len() as f64;
            for count in counts.into_values() {
                // Six standard deviations: some 1,000 counts are looked at.
                let distance = (count as f64 - mean).abs();
                assert!(distance < 6.0 * mean.sqrt(), "{count} instead of {mean}");
            }
        }
    }
}

/// The mean number of edges in which two of the automata differ.
fn spread(automata: &[Dfa]) -> f64 {
    let tables: Vec<Vec<usize>> = automata.iter().map(|dfa| table(dfa).0).collect();
    let mut differences = 0;
    for (number, one) in tables.iter().enumerate() {
        for other in &tables[..number] {
            differences += one.iter().zip(other).filter(|(a, b)| a != b).count();
        }
    }
    differences as f64 / (tables.len() * (tables.len() - 1) / 2) as f64
}

#[test]
fn a_version_space_too_large_to_list_gives_a_mixed_sample_at_once() {
    let mut draw = Draw::new(11);
    let alphabet = Draw::alphabet(4);
    let mut compared = 0;
    for _ in 0..3 {
        let mut identifier = identifier(EngineChoice::Enumerate, &alphabet, 20, &[]);
        let target = draw.dfa(&alphabet, 5);
        for number in 0..50 {
            let atom = draw.word(4, 8);
            let accepted = target.accepts(&atom);
            identifier.add(Some(AnswerId(number)), Fact::Label { atom, accepted });
            let mut budget = Budget::new(60_000);
            let sample = identifier
                .smallest(20, 7, &mut budget)
                .expect("little work");
            assert!(sample.complete || sample.automata.len() == 20);
            if sample.complete || number % 5 != 0 {
                continue;
            }
            let all = smallest(&mut identifier, 1_500, 0);
            if all.complete {
                let (sample, all) = (spread(&sample.automata), spread(&all.automata));
                assert!(sample > 0.8 * all, "{sample} instead of {all}");
                compared += 1;
            }
        }
    }
    assert!(compared > 3, "{compared} samples were compared");
}

#[test]
fn without_facts_there_are_two_languages_and_without_room_there_are_none() {
    for engine in ENGINES {
        let alphabet = Draw::alphabet(3);
        let mut empty = identifier(engine, &alphabet, 5, &[]);
        let sample = smallest(&mut empty, 10, 0);
        assert!(sample.complete);
        assert_eq!(sample.automata.len(), 2, "everything and nothing");

        let labels = [(0, true), (1, false)].map(|(length, accepted)| Fact::Label {
            atom: std::iter::repeat_n(Symbol::new(0), length).collect(),
            accepted,
        });
        let mut cramped = identifier(engine, &alphabet, 1, &labels);
        let failure = cramped.smallest(1, 0, &mut Budget::new(1_000));
        let Err(Failure::Contradiction(contradiction)) = failure else {
            panic!("{engine:?}: two labels in one state")
        };
        assert_eq!(contradiction.cause, Cause::States { bound: 1 });
        assert_eq!(contradiction.answers, [AnswerId(0), AnswerId(1)]);
    }
}
