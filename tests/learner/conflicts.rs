//! The four kinds of contradictions are told apart, at once, and small.

use automata::{Alphabet, Dfa, Word};
use memrep::concept::{Cause, DfaClass, FiniteAtom, FiniteClass, FiniteConcept};
use memrep::evidence::{AnswerId, Comparison, Fact};
use memrep::identify::{EngineChoice, Settings};
use memrep::learner::{Learner, Question, Reply, Step, Strategy};
use memrep::oracle::Target;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use crate::finite::config;
use crate::implied::is_possible;

fn finite() -> Learner<FiniteClass> {
    let columns = (0..8u8).map(|set| (1, (0..3).map(|atom| set >> atom & 1 == 1).collect()));
    let class = FiniteClass::new(3, columns).unwrap();
    Learner::new(class, config(Strategy::Thesis, 0), Vec::new())
}

fn judge(learner: &mut Learner<FiniteClass>, number: u32, atom: u32, accept: bool) {
    let atom = FiniteAtom(atom);
    let reply = if accept { Reply::Accept } else { Reply::Reject };
    let question = Question::Membership { atom };
    learner
        .record(AnswerId(number), question, None, reply)
        .unwrap();
}

fn compare(learner: &mut Learner<FiniteClass>, number: u32, pair: (u32, u32), answer: Comparison) {
    let question = Question::Comparison {
        first: FiniteAtom(pair.0),
        second: FiniteAtom(pair.1),
    };
    learner
        .record(AnswerId(number), question, None, Reply::Compared(answer))
        .unwrap();
}

fn conflict(learner: &mut Learner<FiniteClass>) -> (Vec<u32>, Cause) {
    let Step::Conflict(conflict) = learner.next() else {
        panic!("there is no conflict");
    };
    assert!(conflict.minimal);
    (
        conflict.answers.iter().map(|a| a.0).collect(),
        conflict.cause,
    )
}

#[test]
fn a_cycle_is_told_and_mended() {
    let answers = [
        (Comparison::First, Cause::Order),
        (Comparison::Equal, Cause::Equality),
    ];
    for (middle, cause) in answers {
        let mut learner = finite();
        judge(&mut learner, 0, 2, true);
        compare(&mut learner, 1, (0, 1), Comparison::First);
        compare(&mut learner, 2, (1, 2), middle);
        assert!(matches!(learner.next(), Step::Ask { .. }));
        compare(&mut learner, 3, (0, 2), Comparison::Second);
        assert_eq!(conflict(&mut learner), (vec![1, 2, 3], cause));
        assert!(learner.retract(AnswerId(2)));
        assert!(matches!(learner.next(), Step::Ask { .. }));
    }
}

/// All tables with at most two states over two symbols.
fn small_automata(alphabet: &Alphabet) -> Vec<Dfa> {
    let mut all = Vec::new();
    for states in 1..=2usize {
        for code in 0..states.pow(2 * states as u32) << states {
            let mut rest = code >> states;
            let mut next = || {
                let state = rest % states;
                rest /= states;
                state
            };
            let delta: Vec<Vec<usize>> = (0..states).map(|_| vec![next(), next()]).collect();
            let accepting = (0..states).map(|state| code >> state & 1 == 1).collect();
            all.push(Dfa::new(alphabet.clone(), 0, accepting, &delta).unwrap());
        }
    }
    assert_eq!(all.len(), 2 + 64);
    all
}

/// Why facts cannot stand, by trying; none if they can.
fn trouble(facts: &[Fact<Word>], automata: &[Dfa]) -> Option<Cause> {
    let part = |keeps: fn(&Fact<Word>) -> bool| -> Vec<Fact<Word>> {
        facts.iter().filter(|fact| keeps(fact)).cloned().collect()
    };
    let strict = part(|fact| matches!(fact, Fact::Below { .. }));
    let order = part(|fact| matches!(fact, Fact::Below { .. } | Fact::Equal { .. }));
    // Who cannot tell has claimed nothing.
    let claims = part(|fact| !matches!(fact, Fact::Incomparable { .. }));
    let fits = |dfa: &Dfa| {
        claims
            .iter()
            .all(|fact| fact.holds(|word| dfa.accepts(word)))
    };
    if !is_possible(&strict) {
        Some(Cause::Order)
    } else if !is_possible(&order) {
        Some(Cause::Equality)
    } else if !is_possible(&claims) {
        Some(Cause::MemRep)
    } else {
        (!automata.iter().any(fits)).then_some(Cause::States { bound: 2 })
    }
}

/// After any answers to any questions there is a conflict exactly if they cannot
/// stand. What is blamed cannot stand for the cause told, holds no answer too
/// many, and has no part in what was given.
#[test]
fn every_contradiction_is_found_at_once_and_minimal() {
    let alphabet = Alphabet::new(["a", "b"]).unwrap();
    let automata = small_automata(&alphabet);
    let words: Vec<Word> = alphabet.words_up_to(2).collect();
    let given = [
        Fact::Label {
            atom: words[0].clone(),
            accepted: true,
        },
        Fact::Below {
            worse: words[1].clone(),
            better: words[2].clone(),
        },
    ];
    let mut seen = [0; 4];
    for seed in 0..60 {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let settings = Settings {
            engine: EngineChoice::Auto,
            max_states: 2,
        };
        let class = DfaClass::new(alphabet.clone(), settings);
        let strategy = [Strategy::Thesis, Strategy::Membership][random.random_range(0..2)];
        let mut learner = Learner::new(class, config(strategy, seed), given.to_vec());
        for number in 0..25 {
            let mut word = || words[random.random_range(0..words.len())].clone();
            let (first, second) = (word(), word());
            let (question, reply) = if first == second || random.random_ratio(1, 4) {
                let reply = [Reply::Accept, Reply::Reject][random.random_range(0..2)].clone();
                (Question::Membership { atom: first }, reply)
            } else {
                let answer = [
                    Comparison::First,
                    Comparison::Second,
                    Comparison::Equal,
                    Comparison::Incomparable,
                ][random.random_range(0..4)];
                (
                    Question::Comparison { first, second },
                    Reply::Compared(answer),
                )
            };
            learner
                .record(AnswerId(number), question, None, reply)
                .unwrap();
            loop {
                let step = learner.next();
                let facts = |keeps: &dyn Fn(AnswerId) -> bool| -> Vec<Fact<Word>> {
                    let standing = learner.entries().iter().filter(|e| keeps(e.answer));
                    let answered = standing.filter_map(memrep::learner::Entry::fact);
                    given.iter().cloned().chain(answered).collect()
                };
                let all = facts(&|_| true);
                let Step::Conflict(conflict) = step else {
                    assert_eq!(trouble(&all, &automata), None, "{all:?}");
                    break;
                };
                let blamed = |without: Option<AnswerId>| {
                    facts(&|a| Some(a) != without && conflict.answers.contains(&a))
                };
                assert!(conflict.minimal && !conflict.answers.is_empty());
                assert_eq!(trouble(&blamed(None), &automata), Some(conflict.cause));
                // Without any one the others can stand, at least if more states
                // are allowed where that was not the trouble.
                let bounded = matches!(conflict.cause, Cause::States { .. });
                for &answer in &conflict.answers {
                    let rest = trouble(&blamed(Some(answer)), &automata);
                    let stands = match rest {
                        None => true,
                        Some(Cause::States { .. }) => !bounded,
                        Some(_) => false,
                    };
                    assert!(stands, "{conflict:?} without {answer:?}: {rest:?}");
                }
                seen[match conflict.cause {
                    Cause::Order => 0,
                    Cause::Equality => 1,
                    Cause::MemRep => 2,
                    Cause::States { .. } => 3,
                }] += 1;
                let place = random.random_range(0..conflict.answers.len());
                assert!(learner.retract(conflict.answers[place]));
            }
        }
    }
    assert!(seen.iter().all(|count| *count > 10), "{seen:?}");
}

#[test]
fn an_accepted_atom_below_a_rejected_one_is_told() {
    let mut learner = finite();
    judge(&mut learner, 0, 0, true);
    compare(&mut learner, 1, (0, 1), Comparison::Second);
    compare(&mut learner, 2, (2, 1), Comparison::First);
    judge(&mut learner, 3, 2, false);
    assert_eq!(conflict(&mut learner), (vec![0, 1, 2, 3], Cause::MemRep));
}

#[test]
fn a_bound_that_is_too_small_is_told() {
    let target = Target::named("tomita:5").unwrap();
    let settings = Settings {
        engine: EngineChoice::Auto,
        max_states: 3,
    };
    let class = DfaClass::new(target.dfa().alphabet().clone(), settings);
    let mut learner = Learner::new(class, config(Strategy::Membership, 0), Vec::new());
    let words = target.dfa().alphabet().words_up_to(4);
    for (number, atom) in words.enumerate() {
        let reply = if target.dfa().accepts(&atom) {
            Reply::Accept
        } else {
            Reply::Reject
        };
        let question = Question::Membership { atom };
        learner
            .record(AnswerId(number as u32), question, None, reply)
            .unwrap();
    }
    let Step::Conflict(conflict) = learner.next() else {
        panic!("no automaton with three states does this");
    };
    assert_eq!(conflict.cause, Cause::States { bound: 3 });
    assert!(conflict.minimal);
    // Minimal: after taking back any one of them, the others can stand.
    for &answer in &conflict.answers {
        let settings = Settings {
            engine: EngineChoice::Auto,
            max_states: 3,
        };
        let class = DfaClass::new(target.dfa().alphabet().clone(), settings);
        let mut rest = Learner::new(class, config(Strategy::Membership, 0), Vec::new());
        for entry in learner.entries() {
            if entry.answer != answer && conflict.answers.contains(&entry.answer) {
                rest.record(
                    entry.answer,
                    entry.question.clone(),
                    None,
                    entry.reply.clone(),
                )
                .unwrap();
            }
        }
        let step = rest.next();
        assert!(!matches!(step, Step::Conflict(_)), "without {answer:?}");
    }
}

/// The table's own bound, where every set respects the order.
#[test]
fn no_concept_in_the_table_is_told() {
    let class = FiniteClass::new(2, [(1, vec![true, true]), (4, vec![false, false])]).unwrap();
    let mut learner = Learner::new(class, config(Strategy::Thesis, 0), Vec::new());
    judge(&mut learner, 5, 0, true);
    judge(&mut learner, 6, 1, false);
    let expected = (vec![5, 6], Cause::States { bound: 4 });
    assert_eq!(conflict(&mut learner), expected);
    let hypothesis = FiniteConcept(0);
    assert_eq!(learner.hypothesis(), None);
    assert!(learner.retract(AnswerId(6)));
    let question = Question::Equivalence { hypothesis };
    let step = learner.next();
    assert!(matches!(step, Step::Ask { question: q, .. } if q == question));
}
