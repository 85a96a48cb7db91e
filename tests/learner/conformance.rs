//! The check after the last agreement: what is drawn, what is asked of it, and
//! that it is a fold like the rest.

use std::collections::BTreeSet;

use automata::{Dfa, Word};
use memrep::bench::{process_cpu, teach};
use memrep::concept::{ConceptClass, DfaClass};
use memrep::evidence::AnswerId;
use memrep::identify::{EngineChoice, Settings};
use memrep::learner::{Config, Learner, Progress, Question, Reply, Step, Strategy};
use memrep::oracle::{ScriptedTeacher, Target, TeacherSettings};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

use crate::claims::{checked, twenty};
use crate::finite::config;
use crate::teacher::reply;

fn automata(target: &Target) -> DfaClass {
    let settings = Settings {
        engine: EngineChoice::Auto,
        max_states: 8,
    };
    DfaClass::new(target.dfa().alphabet().clone(), settings)
}

/// Half of the words are accepted by the hypothesis, and every length of a side
/// is as likely as another.
#[test]
fn words_are_drawn_as_it_is_said() {
    for name in ["tomita:4", "robot", "modulo:9"] {
        let target = Target::named(name).unwrap();
        let class = automata(&target);
        let dfa = target.dfa();
        let longest = 10.max(2 * dfa.size());
        assert!(class.drawn_from(dfa).contains(&format!("up to {longest} ")));
        let mut random = ChaCha8Rng::seed_from_u64(5);
        let words = class.draw(dfa, 4000, &mut random);
        assert_eq!(words.len(), 4000);
        for side in [true, false] {
            let drawn: Vec<&Word> = words.iter().filter(|w| dfa.accepts(w) == side).collect();
            assert!(drawn.len().abs_diff(2000) < 130, "{name}: {}", drawn.len());
            let all = if side { dfa.clone() } else { dfa.complement() };
            let lengths: Vec<usize> = (0..=longest)
                .filter(|&length| all.count_of_length(length).bits() > 0)
                .collect();
            let each = drawn.len() as f64 / lengths.len() as f64;
            for length in lengths {
                let count = drawn.iter().filter(|word| word.len() == length).count();
                assert!(
                    (count as f64 - each).abs() < 5.0 * each.sqrt(),
                    "{name}: {length}"
                );
            }
            assert!(drawn.iter().all(|word| word.len() <= longest));
        }
    }
    // Where one side is empty, all come from the other.
    let target = Target::named("tomita:1").unwrap();
    let all = Dfa::new(
        target.dfa().alphabet().clone(),
        0,
        vec![true],
        &[vec![0, 0]],
    )
    .unwrap();
    let words = automata(&target).draw(&all, 50, &mut ChaCha8Rng::seed_from_u64(0));
    assert_eq!(words.len(), 50);
}

/// A learner that is in the check of Tomita 5, and the next number.
fn in_check(target: &Target, config: &Config, judged: u32) -> (Learner<DfaClass>, u32) {
    let mut teacher = ScriptedTeacher::new(target, TeacherSettings::default());
    let mut learner = Learner::new(automata(target), config.clone(), target.known().to_vec());
    let mut number = 0;
    loop {
        let Step::Ask {
            question, round, ..
        } = learner.next()
        else {
            panic!("there is something to be judged");
        };
        if learner
            .conformance()
            .is_some_and(|check| check.judged >= judged)
        {
            return (learner, number);
        }
        let reply = reply(&mut teacher, &question);
        learner
            .record(AnswerId(number), question, round, reply)
            .unwrap();
        number += 1;
    }
}

/// The next move of a learner that hears the standing answers anew.
fn replayed(learner: &Learner<DfaClass>, target: &Target) -> (Step<Word, Dfa>, Option<Progress>) {
    let config = learner.config().clone();
    let mut fresh = Learner::new(automata(target), config, target.known().to_vec());
    for entry in learner.entries() {
        let (question, reply) = (entry.question.clone(), entry.reply.clone());
        fresh
            .record(entry.answer, question, entry.round.clone(), reply)
            .unwrap();
    }
    let step = fresh.next();
    assert_eq!(fresh.counts(), learner.counts());
    (step, fresh.conformance().cloned())
}

/// What is asked follows from the answers that stand, nothing known is asked,
/// and every answer moves the check on; also where answers are taken back in the
/// middle of it.
#[test]
fn a_check_is_a_fold() {
    let target = Target::named("tomita:5").unwrap();
    let mut teacher = ScriptedTeacher::new(&target, TeacherSettings::default());
    let config = checked(0.05, 0.1, 2);
    let (mut learner, mut number) = in_check(&target, &config, 0);
    let learned = learner.counts();
    let mut retracted = 0;
    loop {
        let step = learner.next();
        let progress = learner.conformance().cloned();
        assert_eq!(
            (step.clone(), progress.clone()),
            replayed(&learner, &target)
        );
        let progress = progress.expect("it is in the check");
        let Step::Ask { question, .. } = step else {
            break;
        };
        let Question::Membership { atom } = &question else {
            panic!("{question:?} is no part of a check");
        };
        let asked = |entry: &memrep::learner::Entry<Word, Dfa>| entry.question == question;
        assert!(!learner.entries().iter().any(asked), "{atom:?} again");
        let reply = reply(&mut teacher, &question);
        learner
            .record(AnswerId(number), question, None, reply)
            .unwrap();
        number += 1;
        learner.next();
        let further = learner.conformance().expect("it agrees");
        assert!(further.judged > progress.judged);
        if number % 5 == 0 && retracted < 6 {
            // Once of the check, once of what was answered before.
            let entries = learner.entries();
            let place = if retracted % 2 == 0 {
                entries.len() - 3
            } else {
                1
            };
            let answer = entries[place].answer;
            assert!(learner.retract(answer));
            retracted += 1;
        }
    }
    assert_eq!(retracted, 6);
    let progress = learner.conformance().expect("it was checked");
    assert!(progress.is_complete());
    let counts = learner.counts();
    assert!(
        counts.conformance > 20 && counts.conformance <= progress.needed,
        "{counts:?}"
    );
    assert!(counts.membership <= learned.membership);
    assert_eq!(counts.equivalence, learned.equivalence);
}

/// Taking the agreement back ends the check; agreeing once more opens another
/// with words of its own, so that none is judged before it is drawn.
#[test]
fn another_agreement_draws_other_words() {
    let target = Target::named("tomita:5").unwrap();
    let (mut learner, number) = in_check(&target, &checked(0.05, 0.1, 2), 40);
    let judged: BTreeSet<Word> = learner.entries().iter().filter_map(judged_atom).collect();
    let agreement = learner.entries().iter().find(|e| e.reply == Reply::Correct);
    let agreement = agreement.expect("it was agreed on").answer;
    assert!(learner.retract(agreement));
    let Step::Ask { question, .. } = learner.next() else {
        panic!("agreement is asked for");
    };
    assert!(learner.conformance().is_none());
    assert!(matches!(question, Question::Equivalence { .. }));
    learner
        .record(AnswerId(number), question, None, Reply::Correct)
        .unwrap();
    let Step::Ask {
        question: Question::Membership { atom },
        ..
    } = learner.next()
    else {
        panic!("the check is opened");
    };
    assert!(!judged.contains(&atom));
    let progress = learner.conformance().unwrap();
    assert!(progress.judged < 20, "most words are new: {progress:?}");
}

fn judged_atom(entry: &memrep::learner::Entry<Word, Dfa>) -> Option<Word> {
    match &entry.question {
        Question::Membership { atom } => Some(atom.clone()),
        _ => None,
    }
}

/// A wrong judgement in the check refutes what was right; once it is taken back
/// the check goes on where it was.
#[test]
fn a_slip_is_mended() {
    let target = Target::named("tomita:5").unwrap();
    let mut teacher = ScriptedTeacher::new(&target, TeacherSettings::default());
    let (mut learner, number) = in_check(&target, &checked(0.05, 0.1, 2), 12);
    let before = (learner.next(), learner.conformance().cloned());
    let Step::Ask { question, .. } = before.0.clone() else {
        panic!("there is something to be judged");
    };
    let wrong = match reply(&mut teacher, &question) {
        Reply::Accept => Reply::Reject,
        _ => Reply::Accept,
    };
    learner
        .record(AnswerId(number), question, None, wrong)
        .unwrap();
    assert!(!matches!(learner.next(), Step::Done { .. }));
    assert!(learner.conformance().is_none());
    assert!(learner.retract(AnswerId(number)));
    assert_eq!((learner.next(), learner.conformance().cloned()), before);
}

/// Whoever skips is told what the claim is about; whoever skips everything is
/// let go without one.
#[test]
fn skipped_words_are_passed_over() {
    let (class, target) = twenty();
    for every in [3, 1] {
        let mut learner = Learner::new(class.clone(), checked(0.2, 0.2, 1), Vec::new());
        let mut skipped = BTreeSet::new();
        for number in 0..60 {
            let (question, reply) = match learner.next() {
                Step::Done { .. } => break,
                Step::Conflict(conflict) => panic!("{conflict:?}"),
                Step::Ask { question, .. } => {
                    let reply = match &question {
                        Question::Membership { atom } if atom.0 % every == 0 => {
                            assert!(skipped.insert(*atom), "skipped once is enough");
                            Reply::Skip
                        }
                        Question::Membership { atom } if class.contains(&target, atom) => {
                            Reply::Accept
                        }
                        Question::Membership { .. } => Reply::Reject,
                        _ => Reply::Correct,
                    };
                    (question, reply)
                }
            };
            learner
                .record(AnswerId(number), question, None, reply)
                .unwrap();
        }
        assert!(matches!(learner.next(), Step::Done { .. }));
        let progress = learner.conformance().expect("it was checked");
        assert!(progress.skipped > 0);
        assert_eq!(progress.is_complete(), every == 3);
        match progress.claim() {
            Some(claim) => {
                let text = claim.to_string();
                let skips = format!("{} were skipped", progress.skipped);
                assert!(text.contains(&skips), "{text}");
            }
            None => assert_eq!((every, progress.judged), (1, 0)),
        }
    }
}

/// Also a teacher who errs ends with the target and its claim, and one slip in
/// the check alone overturns nothing.
#[test]
fn a_teacher_who_errs_passes_too() {
    for name in ["tomita:1", "tomita:6"] {
        let target = Target::named(name).unwrap();
        for seed in 0..3 {
            let settings = TeacherSettings {
                error_rate: 0.05,
                seed,
                ..TeacherSettings::default()
            };
            let config = checked(0.1, 0.1, seed);
            let mut learner = Learner::new(automata(&target), config, target.known().to_vec());
            let mut teacher = ScriptedTeacher::new(&target, settings);
            let mut asked = 0;
            let report = teach(&mut learner, &mut teacher, 2000, process_cpu, |question| {
                asked += u32::from(question.check.is_some());
            })
            .unwrap();
            let learned = report.learned.expect("the questions are ample");
            assert!(learned.is_equivalent(target.dfa()).unwrap());
            let check = report.check.expect("it was checked");
            assert!(check.is_complete());
            assert_eq!(report.counts.conformance, asked);
        }
    }
}

/// Without one asked for there is none, as it always was.
#[test]
fn no_claim_no_check() {
    let target = Target::named("tomita:1").unwrap();
    let mut text = serde_json::to_value(config(Strategy::Thesis, 0)).unwrap();
    text.as_object_mut().unwrap().remove("conformance");
    let config: Config = serde_json::from_value(text).unwrap();
    let mut learner = Learner::new(automata(&target), config, target.known().to_vec());
    let mut teacher = ScriptedTeacher::new(&target, TeacherSettings::default());
    let report = teach(&mut learner, &mut teacher, 100, process_cpu, |_| ()).unwrap();
    assert!(report.learned.is_some());
    assert_eq!((report.check, report.counts.conformance), (None, 0));
}
