//! Contradictory answers are told small: brute force finds each of them
//! necessary.

use std::collections::{BTreeMap, BTreeSet};

use automata::{Alphabet, Word};
use memrep::evidence::{AnswerId, Budget, Fact};
use memrep::identify::{Cause, Contradiction, EngineChoice, Failure, Identifier, Settings};

use super::ENGINES;
use crate::brute::Brute;
use crate::draw::Draw;

/// Facts with their answers.
type Answered = Vec<(Option<AnswerId>, Fact<Word>)>;

/// Whether any language is consistent: labels are carried along facts until
/// nothing changes.
fn some_language(facts: &[Fact<Word>]) -> bool {
    let mut labels: BTreeMap<&Word, bool> = BTreeMap::new();
    loop {
        let mut news: Vec<(&Word, bool)> = Vec::new();
        let known = |word: &Word| labels.get(word).copied();
        for fact in facts {
            match fact {
                Fact::Label { atom, accepted } => news.push((atom, *accepted)),
                Fact::Below { worse, better } => {
                    if known(worse) == Some(true) {
                        news.push((better, true));
                    }
                    if known(better) == Some(false) {
                        news.push((worse, false));
                    }
                }
                Fact::Equal { first, second } => {
                    news.extend(known(first).map(|label| (second, label)));
                    news.extend(known(second).map(|label| (first, label)));
                }
                Fact::Incomparable { .. } => {}
            }
        }
        let mut changed = false;
        for (word, label) in news {
            match labels.insert(word, label) {
                Some(other) if other != label => return false,
                Some(_) => {}
                None => changed = true,
            }
        }
        if !changed {
            return true;
        }
    }
}

fn with_answers(facts: &Answered, answers: &BTreeSet<AnswerId>) -> Vec<Fact<Word>> {
    (facts.iter())
        .filter(|(answer, _)| answer.is_none_or(|answer| answers.contains(&answer)))
        .map(|(_, fact)| fact.clone())
        .collect()
}

fn identifier(
    engine: EngineChoice,
    alphabet: &Alphabet,
    max_states: usize,
    facts: &Answered,
) -> Identifier {
    let settings = Settings { engine, max_states };
    let mut identifier = Identifier::new(alphabet.clone(), settings);
    for (answer, fact) in facts {
        identifier.add(*answer, fact.clone());
    }
    identifier
}

/// Facts of a language and some that contradict it: a few known from the start,
/// some answers with two facts.
fn noisy(draw: &mut Draw) -> (Alphabet, Answered) {
    let alphabet = Draw::alphabet(1 + draw.number(2));
    let target = draw.dfa(&alphabet, 4);
    let other = draw.dfa(&alphabet, 4);
    let mut facts = Vec::new();
    let mut answer = 0;
    for _ in 0..4 + draw.number(26) {
        let source = if draw.number(8) == 0 { &other } else { &target };
        let fact = draw.fact(source);
        match draw.number(10) {
            0 => facts.push((None, fact)),
            1 => facts.push((Some(AnswerId(answer)), fact)),
            _ => {
                answer += 1;
                facts.push((Some(AnswerId(answer)), fact));
            }
        }
    }
    (alphabet, facts)
}

#[test]
fn contradictions_are_true_and_minimal() {
    let brute = Brute::up_to(2, 3);
    let mut draw = Draw::new(5);
    let (mut by_labels, mut by_states, mut none) = (0, 0, 0);
    for number in 0..400 {
        let (alphabet, facts) = noisy(&mut draw);
        let bound = 1 + draw.number(3);
        let fits = |facts: &[Fact<Word>]| {
            (brute.smallest(&alphabet, facts)).is_some_and(|smallest| smallest.size <= bound)
        };
        let everything: BTreeSet<AnswerId> = facts.iter().filter_map(|fact| fact.0).collect();
        let all = with_answers(&facts, &everything);
        for engine in ENGINES {
            let mut identifier = identifier(engine, &alphabet, bound, &facts);
            let found = identifier.smallest(1, number, &mut Budget::new(10_000_000));
            let Err(failure) = found else {
                assert!(fits(&all), "{number}: {engine:?} overlooks a contradiction");
                none += 1;
                continue;
            };
            let Failure::Contradiction(Contradiction {
                answers,
                cause,
                minimal,
            }) = failure
            else {
                panic!("{number}: {engine:?}: such a budget is enough")
            };
            assert!(minimal);
            assert!(answers.is_sorted());
            let stands: &dyn Fn(&[Fact<Word>]) -> bool = match cause {
                Cause::MemRep => {
                    by_labels += 1;
                    &some_language
                }
                Cause::States { bound: told } => {
                    by_states += 1;
                    assert_eq!(told, bound);
                    assert!(some_language(&all), "{number}: {engine:?}");
                    &fits
                }
                Cause::Order | Cause::Equality => {
                    panic!("{number}: {engine:?}: orders are not looked at")
                }
            };
            let answers: BTreeSet<AnswerId> = answers.into_iter().collect();
            let told = with_answers(&facts, &answers);
            assert!(!stands(&told), "{number}: {engine:?}: these can stand");
            for answer in &answers {
                let mut rest = answers.clone();
                rest.remove(answer);
                let rest = with_answers(&facts, &rest);
                assert!(
                    stands(&rest),
                    "{number}: {engine:?}: {answer:?} is needless"
                );
            }
        }
    }
    assert!(
        by_labels > 100 && by_states > 100 && none > 100,
        "{by_labels} {by_states} {none}"
    );
}

#[test]
fn a_larger_bound_resolves_what_the_bound_caused_and_nothing_else() {
    let mut draw = Draw::new(6);
    for _ in 0..60 {
        let (alphabet, facts) = noisy(&mut draw);
        let asked = |max_states| {
            identifier(EngineChoice::Auto, &alphabet, max_states, &facts).smallest(
                1,
                0,
                &mut Budget::new(10_000_000),
            )
        };
        if let Err(Failure::Contradiction(contradiction)) = asked(2) {
            // Thirty words of up to nine symbols have fewer prefixes than this.
            match contradiction.cause {
                Cause::MemRep => assert!(asked(300).is_err()),
                Cause::States { .. } => assert!(asked(300).is_ok()),
                Cause::Order | Cause::Equality => panic!("orders are not looked at"),
            }
        }
    }
}

/// `worse ≺ better` over one letter, words given by their lengths.
fn below(worse: usize, better: usize) -> Fact<Word> {
    Fact::Below {
        worse: power(worse),
        better: power(better),
    }
}

fn label(length: usize, accepted: bool) -> Fact<Word> {
    Fact::Label {
        atom: power(length),
        accepted,
    }
}

fn power(length: usize) -> Word {
    std::iter::repeat_n(automata::Symbol::new(0), length).collect()
}

fn told(facts: &Answered, max_states: usize) -> Contradiction {
    let failure = identifier(EngineChoice::Auto, &Draw::alphabet(1), max_states, facts)
        .smallest(1, 0, &mut Budget::new(1_000_000))
        .expect_err("the facts are contradictory");
    match failure {
        Failure::Contradiction(contradiction) => contradiction,
        Failure::OverBudget { .. } => panic!("they are few"),
    }
}

#[test]
fn the_shortest_chain_of_preferences_is_told() {
    let answer = |number| Some(AnswerId(number));
    let facts = vec![
        (answer(1), label(0, true)),
        (answer(2), below(0, 1)),
        (answer(3), below(1, 2)),
        (answer(4), below(2, 3)),
        (answer(5), below(0, 4)),
        (answer(6), below(4, 3)),
        (answer(7), label(3, false)),
    ];
    let contradiction = told(&facts, 9);
    assert_eq!(contradiction.cause, Cause::MemRep);
    assert_eq!(contradiction.answers, [1, 5, 6, 7].map(AnswerId));
}

#[test]
fn what_is_known_from_the_start_is_never_blamed() {
    let known = vec![(None, label(1, true)), (None, label(1, false))];
    assert!(told(&known, 9).answers.is_empty());

    let mut facts: Answered = (0..4).map(|n| (None, label(n, n == 3))).collect();
    facts.push((Some(AnswerId(8)), label(4, true)));
    let contradiction = told(&facts, 2);
    assert_eq!(contradiction.cause, Cause::States { bound: 2 });
    assert!(contradiction.answers.is_empty());
    // Accepting 3 and 4 but no less takes the known facts and the answer.
    facts.push((None, label(5, false)));
    let contradiction = told(&facts, 4);
    assert_eq!(contradiction.answers, [AnswerId(8)]);
}

#[test]
fn over_budget_the_set_is_true_but_perhaps_not_minimal() {
    let mut draw = Draw::new(7);
    let alphabet = Draw::alphabet(2);
    let facts: Answered = loop {
        let target = draw.dfa(&alphabet, 9);
        let facts: Answered = (0..120)
            .map(|number| (Some(AnswerId(number)), draw.fact(&target)))
            .collect();
        let mut identifier = identifier(EngineChoice::Batsat, &alphabet, 4, &facts);
        if identifier
            .smallest(1, 0, &mut Budget::new(3_000_000))
            .is_err()
        {
            break facts;
        }
    };
    let mut sizes = Vec::new();
    for exponent in 0..22 {
        let mut identifier = identifier(EngineChoice::Enumerate, &alphabet, 3, &facts);
        let mut budget = Budget::new(1 << exponent);
        let Err(Failure::Contradiction(contradiction)) = identifier.smallest(1, 0, &mut budget)
        else {
            assert!(
                sizes.is_empty(),
                "a smaller budget proved that 3 states are too few"
            );
            continue;
        };
        let kept: BTreeSet<AnswerId> = contradiction.answers.iter().copied().collect();
        let mut again = Identifier::new(
            alphabet.clone(),
            Settings {
                engine: EngineChoice::Batsat,
                max_states: 3,
            },
        );
        for (answer, fact) in &facts {
            if answer.is_none_or(|answer| kept.contains(&answer)) {
                again.add(None, fact.clone());
            }
        }
        assert!(again.smallest(1, 0, &mut Budget::new(3_000_000)).is_err());
        sizes.push((kept.len(), contradiction.minimal));
    }
    assert!(
        sizes.is_sorted_by(|less, more| less.0 >= more.0),
        "{sizes:?}"
    );
    assert!(sizes.last().is_some_and(|last| last.1), "{sizes:?}");
    assert!(!sizes[0].1, "{sizes:?}");
}
