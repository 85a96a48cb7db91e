//! The learner is a fold: what it asks follows from its configuration and the
//! answers that stand, and from nothing else.

use memrep::concept::{ConceptClass, DfaClass, FiniteClass, FiniteConcept};
use memrep::evidence::{AnswerId, Comparison};
use memrep::identify::{EngineChoice, Settings};
use memrep::learner::{Config, Entry, Learner, Question, Reply, Round, Step, Strategy};
use memrep::oracle::{Order, ScriptedTeacher, Target, TeacherSettings};
use proptest::prelude::*;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use crate::brute::class;
use crate::finite::config;
use crate::teacher::reply;

/// Any reply that fits the question, true or not.
fn any_reply(
    class: &FiniteClass,
    question: &Question<memrep::concept::FiniteAtom, FiniteConcept>,
    random: &mut ChaCha8Rng,
) -> Option<Reply<memrep::concept::FiniteAtom>> {
    Some(match question {
        Question::Membership { .. } => match random.random_range(0..5) {
            0 => Reply::Skip,
            1 | 2 => Reply::Accept,
            _ => Reply::Reject,
        },
        Question::Comparison { .. } => match random.random_range(0..5) {
            0 => Reply::Skip,
            1 => Reply::Compared(Comparison::First),
            2 => Reply::Compared(Comparison::Second),
            3 => Reply::Compared(Comparison::Equal),
            _ => Reply::Compared(Comparison::Incomparable),
        },
        Question::Equivalence { hypothesis } => {
            let atom = class.atoms().nth(random.random_range(0..4))?;
            let label = !class.contains(hypothesis, &atom);
            Reply::Counterexample { atom, label }
        }
    })
}

fn replay<C: ConceptClass>(
    class: C,
    config: &Config,
    entries: &[Entry<C::Atom, C::Concept>],
) -> Learner<C> {
    let mut learner = Learner::new(class, config.clone(), Vec::new());
    for entry in entries {
        // As a log does it: the round goes through text.
        let text = serde_json::to_string(&entry.round).unwrap();
        let round: Option<Round> = serde_json::from_str(&text).unwrap();
        assert_eq!(round, entry.round);
        learner
            .record(
                entry.answer,
                entry.question.clone(),
                round,
                entry.reply.clone(),
            )
            .expect("it was recorded before");
    }
    learner
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, ..ProptestConfig::default() })]

    /// After any answers and retractions, the next move is that of a learner
    /// which heard only what stands.
    #[test]
    fn retracted_is_as_if_never_asked(class in class(), seed in any::<u64>()) {
        let config = config(Strategy::Thesis, seed);
        let mut random = ChaCha8Rng::seed_from_u64(seed ^ 1);
        let mut learner = Learner::new(class.clone(), config.clone(), Vec::new());
        for number in 0..20 {
            let step = learner.next();
            prop_assert_eq!(&learner.next(), &step, "asking twice changes nothing");
            let fresh = replay(class.clone(), &config, learner.entries()).next();
            prop_assert_eq!(&fresh, &step, "after {:?}", learner.entries());
            match step {
                Step::Ask { question, round, .. } => {
                    let Some(reply) = any_reply(&class, &question, &mut random) else { break };
                    learner.record(AnswerId(number), question, round, reply).expect("it fits");
                }
                Step::Conflict(conflict) => {
                    prop_assert!(!conflict.answers.is_empty());
                    let place = random.random_range(0..conflict.answers.len());
                    prop_assert!(learner.retract(conflict.answers[place]));
                    prop_assert!(!learner.retract(conflict.answers[place]));
                }
                Step::Done { .. } => break,
            }
            if random.random_ratio(1, 4) && !learner.entries().is_empty() {
                let place = random.random_range(0..learner.entries().len());
                let answer = learner.entries()[place].answer;
                prop_assert!(learner.retract(answer));
            }
        }
    }
}

/// The same for automata, whose class keeps what it learned from other facts.
#[test]
fn automata_are_a_fold_too() {
    let target = Target::named("tomita:5").unwrap();
    let class = || {
        let settings = Settings {
            engine: EngineChoice::Auto,
            max_states: 16,
        };
        DfaClass::new(target.dfa().alphabet().clone(), settings)
    };
    let settings = TeacherSettings {
        order: Order::Random,
        ..TeacherSettings::default()
    };
    let mut teacher = ScriptedTeacher::new(&target, settings);
    let config = config(Strategy::Thesis, 3);
    let mut learner = Learner::new(class(), config.clone(), Vec::new());
    let mut number = 0;
    loop {
        let step = learner.next();
        let fresh = replay(class(), &config, learner.entries()).next();
        assert_eq!(fresh, step, "question {number}");
        let Step::Ask {
            question, round, ..
        } = step
        else {
            break;
        };
        let reply = reply(&mut teacher, &question);
        learner
            .record(AnswerId(number), question, round, reply)
            .unwrap();
        number += 1;
        // Now and then the last answer but one is taken back.
        if number % 5 == 0 {
            let place = learner.entries().len() - 2;
            assert!(learner.retract(learner.entries()[place].answer));
        }
        assert!(number < 200, "it does not end");
    }
    let counts = learner.counts();
    assert_eq!(
        (counts.membership + counts.comparison + counts.equivalence) as usize,
        learner.entries().len()
    );
}
