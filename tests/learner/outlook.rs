//! What a learner says is left: counts against a twin that goes through all
//! concepts, and the expected questions against those that were put in the end.

use memrep::bench::{process_cpu, teach};
use memrep::concept::{ConceptClass, DfaClass, FiniteConcept};
use memrep::evidence::{AnswerId, Fact};
use memrep::identify::{EngineChoice, Settings};
use memrep::learner::{Answer, Config, Entry, Learner, Question, Step, Strategy};
use memrep::oracle::{Order, ScriptedTeacher, Target, TeacherSettings};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use crate::finite::config;
use crate::implied::{some_class, some_order};
use crate::teacher::{TableTeacher, reply};

/// What this answer says; none where it is agreement.
fn fact<A: Clone, C: Clone>(question: &Question<A, C>, answer: Answer) -> Option<Fact<A>> {
    let entry = Entry {
        answer: AnswerId(0),
        question: question.clone(),
        round: None,
        reply: answer.reply(),
    };
    entry.fact()
}

#[test]
fn what_is_left_and_removed_is_counted() {
    let (mut counted, mut told_apart) = (0, 0);
    for seed in 0..300 {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let class = some_class(&mut random);
        let concepts: Vec<FiniteConcept> = class.concepts().collect();
        let target = concepts[random.random_range(0..concepts.len())];
        let mut teacher = TableTeacher {
            class: &class,
            target,
            order: some_order(&class, target, &mut random),
        };
        let mut learner = Learner::new(class.clone(), config(Strategy::Bayes, seed), Vec::new());
        let mut facts: Vec<Fact<_>> = Vec::new();
        for number in 0.. {
            let Step::Ask {
                question, round, ..
            } = learner.next()
            else {
                assert!(learner.outlook().is_none(), "there is nothing to ask");
                break;
            };
            let outlook = learner.outlook().expect("it was weighed");
            let fits = |concept: &FiniteConcept, fact: &Fact<_>| {
                fact.holds(|atom| class.contains(concept, atom))
            };
            let left: Vec<FiniteConcept> = concepts
                .iter()
                .copied()
                .filter(|concept| facts.iter().all(|fact| fits(concept, fact)))
                .collect();
            assert!(outlook.left.concepts <= left.len());
            if outlook.left.exact {
                assert_eq!(outlook.left.concepts, left.len());
                for removed in &outlook.removed {
                    let stays = |concept: &&FiniteConcept| match fact(&question, removed.answer) {
                        Some(fact) => fits(concept, &fact),
                        None => {
                            matches!(question, Question::Equivalence { hypothesis } if hypothesis == **concept)
                        }
                    };
                    let stay = left.iter().filter(stays).count();
                    assert_eq!(removed.concepts, left.len() - stay, "{removed:?}");
                    counted += 1;
                }
            }
            if let Some([one, other]) = &outlook.rivals {
                assert!(left.contains(one) && left.contains(other));
                let apart = outlook.removed.iter().any(|removed| {
                    fact(&question, removed.answer)
                        .is_none_or(|fact| fits(one, &fact) != fits(other, &fact))
                });
                assert!(
                    apart && one != other,
                    "{question:?} is about something else"
                );
                told_apart += 1;
            } else if let Question::Equivalence { .. } = question {
                assert_eq!(outlook.left.concepts, 1);
            }
            let reply = reply(&mut teacher, &question);
            let entry = Entry {
                answer: AnswerId(number),
                question: question.clone(),
                round: round.clone(),
                reply: reply.clone(),
            };
            facts.extend(entry.fact());
            learner
                .record(AnswerId(number), question, round, reply)
                .unwrap();
        }
    }
    assert!(
        counted > 1000 && told_apart > 500,
        "{counted}, {told_apart}"
    );
}

/// On seeds and costs that the lines were not drawn through.
#[test]
fn most_sessions_end_when_they_are_expected_to() {
    let (mut within, mut all, mut surplus) = (0, 0, 0.0);
    for (number, name) in [
        "tomita:3", "tomita:4", "tomita:5", "tomita:7", "robot", "modulo:6",
    ]
    .into_iter()
    .cycle()
    .take(24)
    .enumerate()
    {
        let target = Target::named(name).unwrap();
        let class = DfaClass::new(
            target.dfa().alphabet().clone(),
            Settings {
                engine: EngineChoice::Auto,
                max_states: 16,
            },
        );
        let seed = 1000 + number as u64;
        let config = Config {
            membership_cost: 2.0,
            ..config(Strategy::Bayes, seed)
        };
        let mut learner = Learner::new(class, config, target.known().to_vec());
        let settings = TeacherSettings {
            order: Order::Ordered,
            seed,
            ..TeacherSettings::default()
        };
        let mut teacher = ScriptedTeacher::new(&target, settings);
        let mut said = Vec::new();
        let observe = |asked: &memrep::bench::Asked<'_, _, _>| said.push(asked.left);
        teach(&mut learner, &mut teacher, 200, process_cpu, observe).unwrap();
        for (place, left) in said.iter().enumerate() {
            let Some(expected) = left.and_then(|left| left.questions) else {
                continue;
            };
            let needed = (said.len() - place) as f64;
            assert!(expected.low <= expected.mean && expected.mean <= expected.high);
            within += usize::from((expected.low..=expected.high).contains(&needed));
            surplus += expected.mean - needed;
            all += 1;
        }
    }
    println!(
        "{within} of {all} within, {:.1} too many on average",
        surplus / all as f64
    );
    assert!(all > 300);
    assert!(within * 10 >= all * 7, "{within} of {all}");
    assert!((surplus / all as f64).abs() < 2.5, "{surplus} of {all}");
}
