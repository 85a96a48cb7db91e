//! The three kinds of contradictions are told apart, at once, and small.

use memrep::concept::{Cause, DfaClass, FiniteAtom, FiniteClass, FiniteConcept};
use memrep::evidence::{AnswerId, Comparison};
use memrep::identify::{EngineChoice, Settings};
use memrep::learner::{Learner, Question, Reply, Step, Strategy};
use memrep::oracle::Target;

use crate::finite::config;

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
    let mut learner = finite();
    judge(&mut learner, 0, 2, true);
    compare(&mut learner, 1, (0, 1), Comparison::First);
    compare(&mut learner, 2, (1, 2), Comparison::Equal);
    assert!(matches!(learner.next(), Step::Ask { .. }));
    compare(&mut learner, 3, (0, 2), Comparison::Second);
    assert_eq!(conflict(&mut learner), (vec![1, 2, 3], Cause::Order));
    assert!(learner.retract(AnswerId(2)));
    assert!(matches!(learner.next(), Step::Ask { .. }));
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
