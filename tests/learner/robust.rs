//! Answers that may be wrong: the learner ends with the target all the same,
//! says which answers were wrong, and never takes one for a fact.

use std::collections::BTreeSet;

use automata::{Dfa, Word};
use memrep::bench::{process_cpu, teach};
use memrep::concept::{ConceptClass, DfaClass, FiniteAtom, FiniteClass, FiniteConcept};
use memrep::evidence::{AnswerId, Comparison, Fact};
use memrep::identify::{EngineChoice, Settings};
use memrep::learner::{Config, Learner, Question, Reply, Step, Strategy};
use memrep::oracle::{Counterexamples, Order, ScriptedTeacher, Target, TeacherSettings};
use proptest::prelude::*;

use crate::brute::class;
use crate::finite::{config, set_of};
use crate::teacher::reply;

fn robust(seed: u64) -> Config {
    Config {
        robust: true,
        ..config(Strategy::Bayes, seed)
    }
}

fn learner(target: &Target, config: Config) -> Learner<DfaClass> {
    let settings = Settings {
        engine: EngineChoice::Auto,
        max_states: 16,
    };
    let class = DfaClass::new(target.dfa().alphabet().clone(), settings);
    Learner::new(class, config, target.known().to_vec())
}

fn teacher(target: &Target, error_rate: f64, seed: u64) -> ScriptedTeacher {
    let settings = TeacherSettings {
        order: Order::Ordered,
        counterexamples: Counterexamples::Shortest,
        error_rate,
        seed,
    };
    ScriptedTeacher::new(target, settings)
}

/// Whether no one who respects membership in `target` gives this reply.
fn is_wrong(target: &Dfa, question: &Question<Word, Dfa>, reply: &Reply<Word>) -> bool {
    match (question, reply) {
        (Question::Membership { atom }, Reply::Accept) => !target.accepts(atom),
        (Question::Membership { atom }, Reply::Reject) => target.accepts(atom),
        (Question::Comparison { first, second }, Reply::Compared(answer)) => {
            let worse = match answer {
                Comparison::First => (second, first),
                Comparison::Second => (first, second),
                _ => return false,
            };
            target.accepts(worse.0) && !target.accepts(worse.1)
        }
        _ => false,
    }
}

#[test]
fn targets_are_learned_from_wrong_answers() {
    for (number, error_rate, cost) in [
        (1, 0.2, 4.0),
        (2, 0.05, 1.0),
        (4, 0.1, 4.0),
        (5, 0.02, 8.0),
        (6, 0.1, 1.0),
        (7, 0.2, 4.0),
    ] {
        let target = Target::named(&format!("tomita:{number}")).expect("there are seven");
        let config = Config {
            membership_cost: cost,
            ..robust(number)
        };
        let mut learner = learner(&target, config);
        let mut teacher = teacher(&target, error_rate, number);
        let report = teach(&mut learner, &mut teacher, 150, process_cpu, |_| ())
            .expect("what is certain never contradicts");
        assert_eq!(report.dropped, 0, "nothing is dropped");
        assert_eq!(report.learned.as_ref(), Some(&target.dfa().canonical()));
        // The target is known now, and so is which answers were wrong.
        let wrong: BTreeSet<AnswerId> = (learner.entries().iter())
            .filter(|entry| is_wrong(target.dfa(), &entry.question, &entry.reply))
            .map(|entry| entry.answer)
            .collect();
        let doubts = learner.doubts().expect("answers are doubted");
        let doubted: BTreeSet<AnswerId> = doubts.answers.iter().map(|d| d.answer).collect();
        assert_eq!(doubted, wrong, "tomita:{number}");
        let answers = learner.counts().membership + learner.counts().comparison;
        let share = wrong.len() as f64 / f64::from(answers.max(1));
        assert!((doubts.error_rate - share).abs() < 1e-9);
    }
}

/// While it learns, it comes to expect the errors that there are, and most of the
/// answers it doubts most are wrong.
#[test]
fn the_error_rate_is_learned() {
    let target = Target::named("tomita:6").expect("it is one of seven");
    let mut sums = [0.0; 2];
    for (sum, error_rate) in sums.iter_mut().zip([0.0, 0.2]) {
        for seed in 0..4 {
            // Nobody asks whether it is right.
            let mut learner = learner(&target, robust(seed));
            let mut teacher = teacher(&target, error_rate, seed);
            let words = target.dfa().alphabet().words().take(60);
            for (number, atom) in words.enumerate() {
                let question = Question::Membership { atom };
                let reply = reply(&mut teacher, &question);
                learner
                    .record(AnswerId(number as u32), question, None, reply)
                    .expect("it fits");
            }
            assert!(matches!(learner.next(), Step::Ask { .. }));
            let doubts = learner.doubts().expect("answers are doubted");
            *sum += doubts.error_rate / 4.0;
            for doubt in doubts.answers.iter().filter(|doubt| doubt.chance > 0.9) {
                let entry = &learner.entries()[doubt.answer.0 as usize];
                assert!(is_wrong(target.dfa(), &entry.question, &entry.reply));
            }
            if error_rate > 0.0 {
                assert!(!doubts.answers.is_empty());
            }
        }
    }
    assert!(sums[0] < 0.04, "{sums:?}");
    assert!((0.1..0.3).contains(&sums[1]), "{sums:?}");
}

/// What it asks is a function of the answers that stand, also after one was
/// taken back.
#[test]
fn it_is_a_fold() {
    let target = Target::named("tomita:4").expect("it is one of seven");
    let mut teacher = teacher(&target, 0.1, 1);
    let mut subject = learner(&target, robust(3));
    for number in 0..14 {
        let step = subject.next();
        let mut fresh = learner(&target, robust(3));
        for entry in subject.entries() {
            let (question, reply) = (entry.question.clone(), entry.reply.clone());
            fresh
                .record(entry.answer, question, None, reply)
                .expect("it fitted");
        }
        assert_eq!(fresh.next(), step, "question {number}");
        assert_eq!(fresh.doubts(), subject.doubts());
        let Step::Ask { question, .. } = step else {
            return;
        };
        let reply = reply(&mut teacher, &question);
        subject
            .record(AnswerId(number), question, None, reply)
            .expect("it fits");
        if number % 5 == 4 {
            let place = subject.entries().len() - 2;
            let answer = subject.entries()[place].answer;
            assert!(subject.retract(answer));
        }
    }
}

/// What is known from the start is certain, and can contradict itself.
#[test]
fn certain_facts_contradict() {
    let class = FiniteClass::new(2, [(1, vec![true, false]), (1, vec![false, true])])
        .expect("it is a table");
    let label = |atom| Fact::Label {
        atom: FiniteAtom(atom),
        accepted: true,
    };
    let mut learner = Learner::new(class, robust(0), vec![label(0), label(1)]);
    assert!(matches!(learner.next(), Step::Conflict(_)));
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, ..ProptestConfig::default() })]

    /// Whatever is answered wrongly, the learner ends with the target, finds no
    /// contradiction and compares no two atoms twice.
    #[test]
    fn any_errors_are_survived(
        class in class(),
        target in any::<prop::sample::Index>(),
        errors in prop::collection::vec(prop::bool::weighted(0.2), 200),
        seed in any::<u64>(),
        membership_cost in prop::sample::select(vec![1.0, 2.0, 8.0]),
    ) {
        let targets: Vec<FiniteConcept> = class.concepts().collect();
        let target = targets[target.index(targets.len())];
        let config = Config { membership_cost, ..robust(seed) };
        let mut learner = Learner::new(class.clone(), config, Vec::new());
        let mut compared = BTreeSet::new();
        let mut learned = None;
        for (number, wrong) in errors.iter().enumerate() {
            let (question, round) = match learner.next() {
                Step::Ask { question, round, .. } => (question, round),
                Step::Done { hypothesis } => {
                    learned = Some(hypothesis);
                    break;
                }
                Step::Conflict(conflict) => panic!("{conflict:?}"),
            };
            let label = |atom: &FiniteAtom| class.contains(&target, atom);
            let reply = match &question {
                Question::Membership { atom } if label(atom) != *wrong => Reply::Accept,
                Question::Membership { .. } => Reply::Reject,
                Question::Comparison { first, second } => {
                    let pair = (*first.min(second), *first.max(second));
                    prop_assert!(compared.insert(pair), "{:?} once more", pair);
                    let answer = match (label(first), label(second)) {
                        (true, false) => Comparison::First,
                        (false, true) => Comparison::Second,
                        _ if *wrong => Comparison::First,
                        _ => Comparison::Equal,
                    };
                    Reply::Compared(if *wrong { answer.mirrored() } else { answer })
                }
                Question::Equivalence { hypothesis } => {
                    let differs = set_of(&class, *hypothesis) ^ set_of(&class, target);
                    if differs == 0 {
                        Reply::Correct
                    } else {
                        let atom = FiniteAtom(differs.trailing_zeros());
                        Reply::Counterexample { atom, label: label(&atom) }
                    }
                }
            };
            learner.record(AnswerId(number as u32), question, round, reply).expect("it fits");
        }
        prop_assert_eq!(learned, Some(target), "after {} questions", errors.len());
    }
}
