//! What is known beforehand: rules by name, examples beside it, and answers that
//! contradict it.

use std::sync::Arc;

use automata::{Alphabet, Dfa, Word};
use memrep::concept::{
    Applied, Cause, ConceptClass, Contradiction, Failure, Prior, PriorError, Situated, Template,
};
use memrep::evidence::{AnswerId, Budget, Fact};
use memrep::learner::{Config, Learner, Question, Reply, Step};
use memrep::world::grid::{GridMap, Labelling};
use memrep::world::{Words, World};

use crate::draw::{self, alphabet, automaton};
use crate::learn::settings;

fn word(alphabet: &Alphabet, names: &str) -> Word {
    alphabet.word(names.chars().map(String::from)).unwrap()
}

fn label(alphabet: &Alphabet, names: &str, accepted: bool) -> Fact<Word> {
    Fact::Label {
        atom: word(alphabet, names),
        accepted,
    }
}

fn rule(alphabet: &Alphabet, text: &str) -> Dfa {
    Template::parse(text, alphabet).unwrap().dfa(alphabet)
}

/// What the rules say, word by word.
#[test]
fn rules_mean_what_they_say() {
    let symbols = alphabet(3);
    let has = |word: &Word, name: &str| {
        let symbol = symbols.symbol(name).unwrap();
        word.iter().position(|other| other == symbol)
    };
    let last = |word: &Word, name: &str| {
        let symbol = symbols.symbol(name).unwrap();
        word.symbols().iter().rposition(|other| *other == symbol)
    };
    for word in symbols.words_up_to(5) {
        let check = |text: &str, expected: bool| {
            assert_eq!(
                rule(&symbols, text).accepts(&word),
                expected,
                "{text}: {word:?}"
            );
        };
        check("avoid a", has(&word, "a").is_none());
        check("reach b", has(&word, "b").is_some());
        let early = has(&word, "b").is_none_or(|b| has(&word, "a").is_some_and(|a| a < b));
        check("a before b", early);
        let late = has(&word, "b").is_some_and(|b| last(&word, "a").is_some_and(|a| a > b));
        check(" never  a after b ", !late);
    }
}

#[test]
fn a_rule_that_is_none_is_named() {
    let symbols = alphabet(2);
    let error = |text: &str| Template::parse(text, &symbols).unwrap_err().to_string();
    assert_eq!(
        error("shun a"),
        "`shun a` is no rule that is known by name: write `avoid X`, `reach Y`, `X before Y` or `never X after Y`, or give an automaton file"
    );
    assert_eq!(
        error("avoid z"),
        "`avoid z`: `z` is not a symbol of the alphabet {a, b}"
    );
    assert_eq!(
        error("a before a"),
        "`a before a` is about one symbol: name two, or write `avoid X`"
    );
}

/// A fact holds of the whole concept exactly if what it says holds of the learned
/// part.
#[test]
fn facts_say_of_the_learned_part_what_they_say_of_the_whole() {
    let symbols = alphabet(2);
    let words: Vec<Word> = symbols.words_up_to(2).collect();
    let mut compared = 0;
    for number in 0..40 {
        let mut random = draw::random(number);
        let [holds, suffices, learned] = [0; 3].map(|_| automaton(&symbols, 3, &mut random));
        let Ok(prior) = Prior::new(&symbols, vec![holds], vec![suffices]) else {
            continue;
        };
        let whole = prior.whole(&learned);
        let mut check = |fact: Fact<Word>| {
            let expected = fact.holds(|word| whole.accepts(word));
            let told = match prior.apply(&fact) {
                Applied::Says(says) => says.holds(|word| {
                    assert_eq!(prior.settled(word), None);
                    learned.accepts(word)
                }),
                Applied::Nothing => true,
                Applied::Contradicts => false,
            };
            assert_eq!(told, expected, "{fact:?}");
            compared += 1;
        };
        for one in &words {
            for accepted in [true, false] {
                let atom = one.clone();
                check(Fact::Label { atom, accepted });
            }
            for other in &words {
                let (first, second) = (one.clone(), other.clone());
                let (worse, better) = (one.clone(), other.clone());
                check(Fact::Below { worse, better });
                check(Fact::Equal { first, second });
            }
        }
    }
    assert!(compared > 1000);
}

fn class(prior: Prior) -> Situated {
    let world = World::Words(Words::new(prior.alphabet().clone(), 50));
    Situated::new(Arc::new(world), prior, settings()).unwrap()
}

#[test]
fn an_example_that_contradicts_is_named_with_its_automaton() {
    let symbols = alphabet(2);
    let holding = vec![rule(&symbols, "reach b"), rule(&symbols, "avoid a")];
    let prior = Prior::new(&symbols, holding, Vec::new()).unwrap();
    let examples = [
        label(&symbols, "b", true),
        label(&symbols, "a", false),
        label(&symbols, "ab", true),
    ];
    let class = class(prior);
    assert_eq!(
        class.examples(&examples).unwrap_err().to_string(),
        "example 3, [a, b], is accepted, and automaton 2 of those that hold rejects it: correct one of them"
    );
    // The second is settled as it should be, and says nothing.
    assert_eq!(class.examples(&examples[..2]).unwrap(), examples[..1]);
}

#[test]
fn an_example_that_cannot_happen_is_named() {
    let symbols = alphabet(2);
    let grid = GridMap::new(&symbols, "S.a.b").grid(symbols.clone(), Labelling::Entry, 9);
    let world = Arc::new(World::Grid(grid.unwrap()));
    let class = Situated::new(Arc::clone(&world), Prior::none(&symbols), settings()).unwrap();
    let error = class.examples(&[label(&symbols, "b", true)]).unwrap_err();
    assert_eq!(
        error.to_string(),
        "example 1, [b], cannot happen in this world: leave it out, or change the world"
    );
    // The b comes only after the a: nothing of the kind can happen.
    let never = rule(&symbols, "avoid a")
        .and(&rule(&symbols, "reach b"))
        .unwrap();
    let prior = Prior::new(&symbols, vec![never], Vec::new()).unwrap();
    let refused = Situated::new(world, prior, settings()).err();
    assert_eq!(refused, Some(PriorError::NothingOpenHere));
}

#[test]
fn an_answer_against_what_is_known_is_a_contradiction_of_its_own() {
    let symbols = alphabet(2);
    let prior = Prior::new(&symbols, vec![rule(&symbols, "avoid a")], Vec::new()).unwrap();
    let mut class = class(prior);
    class.add(Some(AnswerId(1)), label(&symbols, "b", true));
    class.add(Some(AnswerId(2)), label(&symbols, "ab", true));
    let expected = Contradiction {
        answers: vec![AnswerId(2)],
        cause: Cause::MemRep,
        minimal: true,
    };
    let found = class.sample(4, 0, &mut Budget::unlimited()).err();
    assert_eq!(found, Some(Failure::Contradiction(expected)));
    class.retract(AnswerId(2));
    let sample = class.sample(4, 0, &mut Budget::unlimited()).unwrap();
    assert_eq!(sample.concepts.len(), 1);
    // What is worse than nothing acceptable, and what is better than something
    // acceptable, has its label.
    class.add(
        Some(AnswerId(3)),
        Fact::Below {
            worse: word(&symbols, "bb"),
            better: word(&symbols, "a"),
        },
    );
    let sample = class.sample(4, 0, &mut Budget::unlimited()).unwrap();
    for concept in sample.concepts {
        assert!(!concept.accepts(&word(&symbols, "bb")));
    }
}

/// Where all that can happen is known, one concept is left, and the teacher is
/// asked to confirm it.
#[test]
fn the_learner_stops_when_the_world_separates_nothing_more() {
    let symbols = alphabet(2);
    let map = GridMap::new(&symbols, "S.a");
    let grid = map.grid(symbols.clone(), Labelling::Entry, 2).unwrap();
    let world = Arc::new(World::Grid(grid));
    for strategy in [
        memrep::learner::Strategy::Bayes,
        memrep::learner::Strategy::Thesis,
    ] {
        // Two behaviours can happen: nothing, and one `a`.
        let class = Situated::new(Arc::clone(&world), Prior::none(&symbols), settings()).unwrap();
        let known = [label(&symbols, "", true), label(&symbols, "a", false)];
        let known = class.examples(&known).unwrap();
        let config = Config {
            strategy,
            ..Config::default()
        };
        let mut learner = Learner::new(class, config, known);
        let Step::Ask { question, .. } = learner.next() else {
            panic!("something is asked");
        };
        let Question::Equivalence { hypothesis } = &question else {
            panic!("nothing is left to be asked but whether it is right: {question:?}");
        };
        // What else there could be, this world does not show.
        let beyond = learner.class().beyond(hypothesis).unwrap();
        assert!(!world.is_feasible(&beyond), "{beyond:?}");
        learner
            .record(AnswerId(1), question.clone(), None, Reply::Correct)
            .unwrap();
        assert!(matches!(learner.next(), Step::Done { .. }));
    }
}
