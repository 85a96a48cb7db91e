//! The strategy by posterior: it ends with the target, asks nothing that is
//! implied, and is a fold like the others.

use automata::{Alphabet, Dfa};
use memrep::bench::{process_cpu, teach};
use memrep::concept::{DfaClass, FiniteConcept};
use memrep::evidence::AnswerId;
use memrep::identify::{EngineChoice, Settings};
use memrep::learner::{Config, Entry, Learner, Question, Step, Strategy};
use memrep::oracle::{Counterexamples, Order, ScriptedTeacher, Target, TeacherSettings};
use proptest::prelude::*;

use crate::brute::{Relation, class, holds};
use crate::finite::{PREORDERS, WORLDS, config, outcomes, set_of};
use crate::teacher::{TableTeacher, reply};

fn automata(target: &Target) -> DfaClass {
    let settings = Settings {
        engine: EngineChoice::Auto,
        max_states: 16,
    };
    DfaClass::new(target.dfa().alphabet().clone(), settings)
}

#[test]
fn every_target_is_learned() {
    let tomita = (1..=7).map(|number| format!("tomita:{number}"));
    for name in tomita.chain(["modulo:5".to_owned(), "robot".to_owned()]) {
        let target = Target::named(&name).unwrap();
        for (membership_cost, order) in [(1.0, Order::Ordered), (8.0, Order::Random)] {
            let config = Config {
                membership_cost,
                ..config(Strategy::Bayes, 1)
            };
            let mut learner = Learner::new(automata(&target), config, target.known().to_vec());
            let settings = TeacherSettings {
                order,
                counterexamples: Counterexamples::Random,
                error_rate: 0.0,
                seed: 1,
            };
            let mut teacher = ScriptedTeacher::new(&target, settings);
            let report = teach(&mut learner, &mut teacher, 150, process_cpu, |_| ())
                .expect("the setup is sound");
            let learned = report
                .learned
                .unwrap_or_else(|| panic!("{name}, {order:?}"));
            assert_eq!(learned, target.dfa().canonical(), "{name}");
            assert_eq!(report.dropped, 0, "the teacher does not err");
        }
    }
}

/// A target on which chains alone went on for ever among larger automata.
#[test]
fn chains_that_lose_their_way_are_led_back() {
    let rows = [
        [1, 2, 2, 3],
        [3, 0, 4, 0],
        [0, 1, 0, 2],
        [3, 4, 0, 1],
        [2, 4, 4, 4],
    ];
    let alphabet = Alphabet::new(["a", "b", "c", "d"]).unwrap();
    let accepting = vec![true, true, false, true, false];
    let dfa = Dfa::new(alphabet, 0, accepting, &rows.map(Vec::from)).unwrap();
    let target = Target::automaton("drawn", &dfa);
    let config = Config {
        membership_cost: 4.0,
        ..config(Strategy::Bayes, 0)
    };
    let mut learner = Learner::new(automata(&target), config, Vec::new());
    let settings = TeacherSettings {
        counterexamples: Counterexamples::Random,
        ..TeacherSettings::default()
    };
    let mut teacher = ScriptedTeacher::new(&target, settings);
    let report = teach(&mut learner, &mut teacher, 120, process_cpu, |_| ()).unwrap();
    assert_eq!(report.learned, Some(dfa.canonical()));
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 1000, ..ProptestConfig::default() })]

    /// Every question has at least two answers that some preorder and some set
    /// of atoms, consistent with all answers so far, would give.
    #[test]
    fn nothing_implied_is_asked(
        class in class(),
        order in any::<prop::sample::Index>(),
        target in any::<prop::sample::Index>(),
        seed in any::<u64>(),
        membership_cost in prop::sample::select(vec![1.0, 2.0, 8.0]),
    ) {
        let targets: Vec<FiniteConcept> = class.concepts().collect();
        let target = targets[target.index(targets.len())];
        let set = set_of(&class, target);
        let fitting: Vec<Relation> =
            PREORDERS.iter().copied().filter(|o| o.respects(set)).collect();
        let order = fitting[order.index(fitting.len())];
        let config = Config { membership_cost, ..config(Strategy::Bayes, seed) };
        let mut learner = Learner::new(class.clone(), config, Vec::new());
        let mut facts = Vec::new();
        let mut learned = None;
        for number in 0..100 {
            let (question, round) = match learner.next() {
                Step::Ask { question, round, .. } => (question, round),
                Step::Done { hypothesis } => {
                    learned = Some(hypothesis);
                    break;
                }
                Step::Conflict(conflict) => panic!("{conflict:?} of {facts:?}"),
            };
            if !matches!(question, Question::Equivalence { .. }) {
                let possible = outcomes(&question).into_iter().filter(|outcome| {
                    WORLDS.iter().any(|&world| {
                        facts.iter().chain([outcome]).all(|fact| holds(world, fact))
                    })
                });
                prop_assert!(possible.count() > 1, "{:?} is implied by {:?}", question, facts);
            }
            let reply = reply(&mut TableTeacher::new(&class, target, order), &question);
            learner.record(AnswerId(number), question, round, reply).expect("it fits");
            facts.extend(learner.entries().last().and_then(Entry::fact));
        }
        prop_assert_eq!(learned, Some(target), "{:?}", facts);
    }
}

/// What is asked after a retraction is what a learner asks that never heard the
/// answer.
#[test]
fn it_is_a_fold() {
    let target = Target::named("tomita:4").unwrap();
    let config = config(Strategy::Bayes, 3);
    let mut teacher = ScriptedTeacher::new(&target, TeacherSettings::default());
    let mut learner = Learner::new(automata(&target), config.clone(), target.known().to_vec());
    for number in 0..60 {
        let step = learner.next();
        let mut fresh = Learner::new(automata(&target), config.clone(), target.known().to_vec());
        for entry in learner.entries() {
            let (question, reply) = (entry.question.clone(), entry.reply.clone());
            fresh.record(entry.answer, question, None, reply).unwrap();
        }
        assert_eq!(fresh.next(), step, "question {number}");
        let Step::Ask { question, .. } = step else {
            return;
        };
        let reply = reply(&mut teacher, &question);
        learner
            .record(AnswerId(number), question, None, reply)
            .unwrap();
        if number % 6 == 5 {
            let place = learner.entries().len() - 2;
            let answer = learner.entries()[place].answer;
            assert!(learner.retract(answer));
        }
    }
    panic!("it does not end");
}
