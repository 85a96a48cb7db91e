//! One suite for all engines of the identifier, through its public door: the
//! same answers as brute force, and as each other.

mod brute;
mod contradictions;
mod draw;
mod limits;
mod spread;
mod standing;

use std::collections::BTreeSet;

use automata::{Alphabet, Dfa, Word};
use brute::Brute;
use draw::Draw;
use memrep::evidence::{AnswerId, Budget, Fact};
use memrep::identify::{EngineChoice, Identifier, Sample, Settings};

/// The engines that the suite runs.
const ENGINES: [EngineChoice; 4] = [
    EngineChoice::Enumerate,
    EngineChoice::Varisat,
    EngineChoice::Batsat,
    EngineChoice::Auto,
];

/// An identifier that knows these facts, fact `i` by answer `i`.
fn identifier(
    engine: EngineChoice,
    alphabet: &Alphabet,
    max_states: usize,
    facts: &[Fact<Word>],
) -> Identifier {
    let settings = Settings { engine, max_states };
    let mut identifier = Identifier::new(alphabet.clone(), settings);
    for (number, fact) in facts.iter().enumerate() {
        identifier.add(Some(AnswerId(number as u32)), fact.clone());
    }
    identifier
}

fn smallest(identifier: &mut Identifier, count: usize, seed: u64) -> Sample {
    identifier
        .smallest(count, seed, &mut Budget::new(20_000_000))
        .expect("the facts come from an automaton within the bound")
}

/// A table that compares and sorts.
fn table(dfa: &Dfa) -> (Vec<usize>, Vec<bool>) {
    let delta = (dfa.states())
        .flat_map(|state| (dfa.alphabet().symbols()).map(move |symbol| (state, symbol)))
        .map(|(state, symbol)| dfa.next(state, symbol).index())
        .collect();
    (
        delta,
        dfa.states().map(|state| dfa.is_accepting(state)).collect(),
    )
}

fn tables(sample: &Sample) -> BTreeSet<(Vec<usize>, Vec<bool>)> {
    let tables: BTreeSet<_> = sample.automata.iter().map(table).collect();
    assert_eq!(
        tables.len(),
        sample.automata.len(),
        "an automaton came twice"
    );
    tables
}

fn holds(dfa: &Dfa, fact: &Fact<Word>) -> bool {
    fact.holds(|word| dfa.accepts(word))
}

/// All smallest automata, or as many as 100 of them.
const ALL: usize = 100;

/// Of 2,000 sets of answers, or of as many as `MEMREP_SETS` says.
#[test]
fn the_smallest_automata_are_those_of_brute_force_and_of_every_engine() {
    let sets = match std::env::var("MEMREP_SETS") {
        Ok(text) => (text.parse()).unwrap_or_else(|e| panic!("MEMREP_SETS={text}: {e}")),
        Err(_) => 2_000,
    };
    let brute = Brute::up_to(3, 3);
    let mut draw = Draw::new(1);
    let (mut by_brute_force, mut larger) = (0, 0);
    for number in 0..sets {
        let (alphabet, target, facts) = draw.instance();
        let expected = brute.smallest(&alphabet, &facts);
        let mut first: Option<(usize, Option<BTreeSet<_>>)> = None;
        for engine in ENGINES {
            let mut identifier = identifier(engine, &alphabet, 8, &facts);
            let sample = smallest(&mut identifier, ALL, number);
            let size = sample.automata[0].size();
            assert!(
                size <= target.size(),
                "instance {number}: {engine:?} missed the target"
            );
            for dfa in &sample.automata {
                assert_eq!(dfa.size(), size);
                assert!(facts.iter().all(|fact| holds(dfa, fact)));
                assert_eq!(dfa, &brute::canonical(dfa), "instance {number}: {engine:?}");
            }
            let found = tables(&sample);
            let complete = sample.complete.then_some(found);
            if let Some(expected) = &expected {
                assert_eq!(size, expected.size, "instance {number}: {engine:?}");
                assert_eq!(sample.complete, expected.tables.len() <= ALL);
                if let Some(found) = &complete {
                    assert_eq!(found, &expected.tables, "instance {number}: {engine:?}");
                } else {
                    assert_eq!(sample.automata.len(), ALL);
                }
                by_brute_force += 1;
            } else {
                assert!(
                    size > 3,
                    "instance {number}: {engine:?} is below brute force"
                );
                larger += 1;
            }
            let first = first.get_or_insert_with(|| (size, complete.clone()));
            assert_eq!(*first, (size, complete), "instance {number}: {engine:?}");
        }
    }
    assert!(
        by_brute_force > 500 && larger > 100,
        "{by_brute_force} {larger}"
    );
}
