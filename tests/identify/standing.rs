//! A sample is a function of the facts that stand and of the seed: nothing that
//! came before them can be seen in it.

use automata::Word;
use memrep::evidence::{AnswerId, Budget, Fact};
use memrep::identify::{Identifier, Settings};

use super::{ENGINES, identifier, smallest};
use crate::draw::Draw;

/// Shuffles in place.
fn shuffle<T>(draw: &mut Draw, items: &mut [T]) {
    for last in (1..items.len()).rev() {
        items.swap(last, draw.number(last + 1));
    }
}

#[test]
fn a_retracted_fact_is_as_if_it_had_never_been_given() {
    let mut draw = Draw::new(2);
    for number in 0..60 {
        let (alphabet, target, facts) = draw.instance();
        // Facts of another language, and longer words, come and go in between.
        let other = draw.dfa(&alphabet, target.size());
        let passing: Vec<Fact<Word>> = (0..6).map(|_| draw.fact(&other)).collect();
        for engine in ENGINES {
            let mut plain = identifier(engine, &alphabet, 6, &facts);
            let settings = Settings {
                engine,
                max_states: 6,
            };
            let mut busy = Identifier::new(alphabet.clone(), settings);
            for (place, fact) in passing.iter().enumerate() {
                busy.add(Some(AnswerId(1_000 + place as u32)), fact.clone());
            }
            for (place, fact) in facts.iter().enumerate() {
                busy.add(Some(AnswerId(place as u32)), fact.clone());
                if place == facts.len() / 2 {
                    // It may look meanwhile; what it finds does not matter.
                    let _ = busy.smallest(3, number, &mut Budget::new(100_000));
                    busy.retract(AnswerId(1_000));
                    busy.retract(AnswerId(1_001));
                }
            }
            for place in 0..passing.len() {
                busy.retract(AnswerId(1_000 + place as u32));
            }
            let (plain, busy) = (
                smallest(&mut plain, 5, number),
                smallest(&mut busy, 5, number),
            );
            assert_eq!(plain.automata, busy.automata, "{number}: {engine:?}");
            assert_eq!(plain.complete, busy.complete, "{number}: {engine:?}");
        }
    }
}

#[test]
fn the_order_of_facts_cannot_be_seen_in_the_sample() {
    let mut draw = Draw::new(3);
    let mut partial = 0;
    for number in 0..120 {
        let (alphabet, _, mut facts) = draw.instance();
        for engine in ENGINES {
            let mut one = identifier(engine, &alphabet, 6, &facts);
            shuffle(&mut draw, &mut facts);
            let mut other = identifier(engine, &alphabet, 6, &facts);
            let (one, other) = (
                smallest(&mut one, 5, number),
                smallest(&mut other, 5, number),
            );
            assert_eq!(one.automata, other.automata, "{number}: {engine:?}");
            partial += usize::from(!one.complete);
        }
    }
    assert!(partial > 40, "only {partial} samples were a choice");
}

#[test]
fn asking_again_gives_the_same_and_another_seed_something_else() {
    let mut draw = Draw::new(4);
    for engine in ENGINES {
        let (alphabet, facts) = loop {
            let (alphabet, target, facts) = draw.instance();
            let mut identifier = identifier(engine, &alphabet, 6, &facts);
            if target.size() > 2 && !smallest(&mut identifier, 40, 0).complete {
                break (alphabet, facts);
            }
        };
        let mut identifier = identifier(engine, &alphabet, 6, &facts);
        let first = smallest(&mut identifier, 4, 1).automata;
        let another = smallest(&mut identifier, 4, 2).automata;
        assert_ne!(first, another, "{engine:?}");
        assert_eq!(
            first,
            smallest(&mut identifier, 4, 1).automata,
            "{engine:?}"
        );
    }
}
