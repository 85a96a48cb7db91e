//! Replies that do not fit are refused, and change nothing.

use memrep::concept::{FiniteAtom, FiniteClass, FiniteConcept};
use memrep::evidence::{AnswerId, Comparison};
use memrep::learner::{Learner, Question, Reply, ReplyError, Step, Strategy};

use crate::finite::config;

/// `{}` and `{0}`, of which the learner must ask for the one atom.
fn learner() -> Learner<FiniteClass> {
    let class = FiniteClass::new(2, [(1, vec![false, false]), (1, vec![true, false])]).unwrap();
    Learner::new(class, config(Strategy::Thesis, 0), Vec::new())
}

fn refuse(question: Question<FiniteAtom, FiniteConcept>, reply: Reply<FiniteAtom>) -> ReplyError {
    let mut learner = learner();
    let step = learner.next();
    let error = learner
        .record(AnswerId(0), question, None, reply)
        .expect_err("the reply does not fit");
    assert!(learner.entries().is_empty());
    assert_eq!(learner.next(), step);
    error
}

#[test]
fn the_wrong_kind_is_refused() {
    let atom = FiniteAtom(0);
    let membership = || Question::Membership { atom };
    let comparison = || Question::Comparison {
        first: atom,
        second: FiniteAtom(1),
    };
    let equivalence = || Question::Equivalence {
        hypothesis: FiniteConcept(0),
    };
    let cases = [
        (membership(), Reply::Correct),
        (membership(), Reply::Compared(Comparison::Equal)),
        (membership(), Reply::Counterexample { atom, label: true }),
        (comparison(), Reply::Accept),
        (comparison(), Reply::Correct),
        (equivalence(), Reply::Reject),
        (equivalence(), Reply::Skip),
    ];
    for (question, reply) in cases {
        let error = refuse(question, reply);
        assert!(matches!(error, ReplyError::WrongKind { .. }), "{error}");
    }
}

#[test]
fn a_counterexample_must_be_one() {
    let question = Question::Equivalence {
        hypothesis: FiniteConcept(0),
    };
    let atom = FiniteAtom(0);
    let error = refuse(question, Reply::Counterexample { atom, label: false });
    assert_eq!(error, ReplyError::NoCounterexample);
}

#[test]
fn a_number_is_used_once() {
    let mut learner = learner();
    let Step::Ask {
        question, round, ..
    } = learner.next()
    else {
        panic!("two concepts are left");
    };
    learner
        .record(AnswerId(4), question.clone(), round, Reply::Skip)
        .unwrap();
    let error = learner
        .record(AnswerId(4), question, None, Reply::Accept)
        .unwrap_err();
    assert_eq!(error, ReplyError::UsedNumber(4));
    assert_eq!(learner.entries().len(), 1);
}

/// The one atom that tells the concepts apart is skipped: what is left is to
/// show one of them.
#[test]
fn all_skipped_leads_to_an_equivalence_query() {
    let mut learner = learner();
    let mut number = 0;
    let hypothesis = loop {
        match learner.next() {
            Step::Ask {
                question: Question::Equivalence { hypothesis },
                ..
            } => break hypothesis,
            Step::Ask {
                question, round, ..
            } => learner
                .record(AnswerId(number), question, round, Reply::Skip)
                .unwrap(),
            other => panic!("{other:?}"),
        }
        number += 1;
        assert!(number < 5, "it keeps asking what is skipped");
    };
    let question = Question::Equivalence { hypothesis };
    let reply = Reply::Correct;
    learner.record(AnswerId(9), question, None, reply).unwrap();
    assert_eq!(learner.next(), Step::Done { hypothesis });
    assert_eq!(learner.counts().membership, 0, "skipped is not answered");
}
