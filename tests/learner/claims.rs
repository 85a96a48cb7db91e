//! What a check after the last agreement allows to claim is true as often as is
//! said, and no more is claimed.

use memrep::concept::{ConceptClass, FiniteClass, FiniteConcept};
use memrep::evidence::AnswerId;
use memrep::learner::{
    Config, Conformance, ConformanceError, Learner, Progress, Question, Reply, Step, Strategy,
};

use crate::finite::config;

pub(crate) fn checked(epsilon: f64, delta: f64, seed: u64) -> Config {
    Config {
        conformance: Some(Conformance::new(epsilon, delta).unwrap()),
        ..config(Strategy::Thesis, seed)
    }
}

/// The number is the least with which the risk is small enough.
#[test]
fn as_many_are_needed_as_the_formula_says() {
    for epsilon in [0.5, 0.2, 0.05, 0.01] {
        for delta in [0.5, 0.05, 0.001] {
            let conformance = Conformance::new(epsilon, delta).unwrap();
            let mut risks = 0.0;
            for round in 1..30u32 {
                let share = delta / f64::from(round * (round + 1));
                risks += share;
                let mut chance = 1.0;
                let mut needed = 0;
                while chance > share {
                    chance *= 1.0 - epsilon;
                    needed += 1;
                }
                assert_eq!(
                    conformance.needed(round),
                    needed,
                    "{epsilon} {delta} {round}"
                );
            }
            assert!(risks < delta, "the checks share the risk");
        }
    }
    assert_eq!(Conformance::new(0.05, 0.05).unwrap().needed(1), 72);
}

#[test]
fn what_cannot_be_claimed_is_refused() {
    for wrong in [0.0, 1.0, -0.1, 1.5, f64::NAN, f64::INFINITY] {
        let refused = Conformance::new(wrong, 0.1).unwrap_err();
        assert!(matches!(refused, ConformanceError::Epsilon(_)), "{refused}");
        let refused = Conformance::new(0.1, wrong).unwrap_err();
        assert!(matches!(refused, ConformanceError::Delta(_)), "{refused}");
    }
    let refused = Conformance::new(1e-12, 0.1).unwrap_err();
    assert!(matches!(refused, ConformanceError::TooMany { .. }));
    let text = serde_json::to_string(&Conformance::new(0.1, 0.2).unwrap()).unwrap();
    let read: Conformance = serde_json::from_str(&text).unwrap();
    assert_eq!(read, Conformance::new(0.1, 0.2).unwrap());
    serde_json::from_str::<Conformance>(r#"{"epsilon":0.1,"delta":2}"#).unwrap_err();
}

/// Twenty atoms, and nothing or the first two of them.
pub(crate) fn twenty() -> (FiniteClass, FiniteConcept) {
    let columns = [0, 2].map(|inside| (inside + 1, (0..20).map(|atom| atom < inside).collect()));
    let class = FiniteClass::new(20, columns).unwrap();
    let target = class.concepts().nth(1).unwrap();
    (class, target)
}

/// Over many seeds, a concept that is wrong about a tenth passes a check for
/// just less as often as chance has it, at most in a share `δ / 2` of them; the
/// claims made on the way are false no more often. Where it fails, what is
/// learned then is right and is checked with the next share.
#[test]
fn what_is_wrong_passes_seldom() {
    let (class, target) = twenty();
    let (epsilon, delta) = (0.0999, 0.2);
    let conformance = Conformance::new(epsilon, delta).unwrap();
    let runs = 2000;
    let (mut passed, mut claimed) = (0, 0);
    for seed in 0..runs {
        let mut learner = Learner::new(class.clone(), checked(epsilon, delta, seed), Vec::new());
        let mut false_claim = false;
        let mut number = 0;
        let learned = loop {
            let step = learner.next();
            let progress = learner.conformance().cloned();
            let claim = progress.as_ref().and_then(Progress::claim);
            let wrong = learner.hypothesis() != Some(&target);
            false_claim |= wrong && claim.is_some_and(|claim| claim.share < 0.1);
            let (question, reply) = match step {
                Step::Done { hypothesis } => {
                    let progress = progress.expect("it was checked");
                    assert!(progress.is_complete());
                    assert_eq!(progress.round, if hypothesis == target { 2 } else { 1 });
                    assert_eq!(progress.needed, conformance.needed(progress.round));
                    break hypothesis;
                }
                Step::Conflict(conflict) => panic!("{conflict:?}"),
                Step::Ask { question, .. } => {
                    let reply = match &question {
                        Question::Membership { atom } if class.contains(&target, atom) => {
                            Reply::Accept
                        }
                        Question::Membership { .. } => Reply::Reject,
                        // The teacher agrees with whatever is shown.
                        Question::Equivalence { .. } => Reply::Correct,
                        Question::Comparison { .. } => panic!("one concept of a size"),
                    };
                    (question, reply)
                }
            };
            learner
                .record(AnswerId(number), question, None, reply)
                .unwrap();
            number += 1;
        };
        passed += u32::from(learned != target);
        claimed += u32::from(false_claim);
        assert_eq!(learner.counts().membership, 0);
        assert_eq!(learner.counts().comparison, 0);
    }
    let expected = 0.9f64.powf(f64::from(conformance.needed(1)));
    assert!(expected <= delta / 2.0 * 1.01);
    let runs = runs as f64;
    let deviation = (runs * expected * (1.0 - expected)).sqrt();
    let bounds = runs * expected - 4.0 * deviation..runs * expected + 4.0 * deviation;
    assert!(
        bounds.contains(&f64::from(passed)),
        "{passed} passed: {bounds:?}"
    );
    assert!(
        f64::from(claimed) < bounds.end,
        "{claimed} false claims: {bounds:?}"
    );
}

/// The sentence says the share, the confidence, and what both are relative to,
/// and claims less rather than more.
#[test]
fn the_claim_is_one_sentence() {
    let claim = |epsilon, delta, judged, skipped| {
        let conformance = Conformance::new(epsilon, delta).unwrap();
        let progress = Progress {
            conformance,
            round: 1,
            needed: conformance.needed(1),
            judged,
            skipped,
            atoms: "words".to_owned(),
        };
        (
            progress.batch(),
            progress
                .claim()
                .map(|claim| (claim.share, claim.to_string())),
        )
    };
    assert_eq!(claim(0.05, 0.05, 9, 0), ((1, 8), None));
    let (batch, said) = claim(0.05, 0.05, 47, 0);
    let (share, text) = said.unwrap();
    assert_eq!(batch, (5, 8));
    assert!((1.0 - share).powi(40) <= 0.025 + 1e-12);
    assert_eq!(
        text,
        "wrong about at most 8.9 % of random behaviours, with 95 % confidence, if no answer is wrong: \
         it was right about all 40 that were drawn (words)"
    );
    let (_, said) = claim(0.05, 0.001, 149, 1);
    let (share, text) = said.unwrap();
    assert!(share <= 0.05);
    assert!(text.contains("at most 5 % of"), "{text}");
    assert!(text.contains("99.9 % confidence"), "{text}");
    assert!(text.ends_with("1 was skipped"), "{text}");
}
