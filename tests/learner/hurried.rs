//! Over budget, a good-enough question still comes.

use std::collections::BTreeSet;

use memrep::bench::{process_cpu, teach};
use memrep::concept::{DfaClass, FiniteClass};
use memrep::evidence::{AnswerId, Comparison, Fact};
use memrep::identify::{EngineChoice, Settings};
use memrep::learner::{Config, Learner, Question, Reply, Step, Strategy};
use memrep::oracle::{ScriptedTeacher, Target, Teacher, TeacherSettings};

use crate::finite::config;
use crate::teacher::{TableTeacher, reply};

fn automata(target: &Target) -> DfaClass {
    let settings = Settings {
        engine: EngineChoice::Auto,
        max_states: 16,
    };
    DfaClass::new(target.dfa().alphabet().clone(), settings)
}

/// Without any budget, the questions are membership queries on new words, none
/// of which is known.
#[test]
fn without_budget_new_words_are_judged() {
    let target = Target::named("tomita:4").unwrap();
    let config = Config {
        budget: 0,
        ..config(Strategy::Thesis, 0)
    };
    let mut learner = Learner::new(automata(&target), config, target.known().to_vec());
    let mut teacher = ScriptedTeacher::new(&target, TeacherSettings::default());
    let mut seen = BTreeSet::new();
    for number in 0..40 {
        let Step::Ask {
            question,
            round,
            hurried,
        } = learner.next()
        else {
            panic!("nothing was agreed on");
        };
        let reply = reply(&mut teacher, &question);
        match (&question, &reply) {
            (Question::Membership { atom }, _) => {
                assert!(hurried && seen.insert(atom.clone()), "{atom:?}");
                assert!(!atom.is_empty(), "the empty word is known");
            }
            // The one automaton that needs no search.
            (Question::Equivalence { hypothesis }, Reply::Counterexample { atom, .. }) => {
                assert_eq!(hypothesis.size(), 1, "{hypothesis:?}");
                seen.insert(atom.clone());
            }
            _ => panic!("{question:?} without candidates"),
        }
        learner
            .record(AnswerId(number), question, round, reply)
            .unwrap();
    }
    assert!(seen.len() >= 39);
}

/// With enough budget for some questions only, runs end all the same, and no
/// question comes twice.
#[test]
fn little_budget_still_learns() {
    let mut hurried = 0;
    for name in ["tomita:1", "tomita:5", "tomita:4", "tomita:7"] {
        for budget in [5, 20, 100, 500, 5000] {
            let target = Target::named(name).unwrap();
            let config = Config {
                budget,
                ..config(Strategy::Thesis, 1)
            };
            let known = target.known().to_vec();
            let mut learner = Learner::new(automata(&target), config, known);
            let mut teacher = ScriptedTeacher::new(&target, TeacherSettings::default());
            let mut asked = Vec::new();
            let report = teach(&mut learner, &mut teacher, 100, process_cpu, |question| {
                assert!(!asked.contains(question.question), "{question:?} again");
                asked.push(question.question.clone());
            })
            .unwrap();
            hurried += report.hurried;
            assert!(report.learned.is_some() || budget < 5000, "{name}");
            if let Some(learned) = report.learned {
                assert!(learned.is_equivalent(target.dfa()).unwrap());
            }
        }
    }
    assert!(hurried > 0, "no budget ever ended");
}

/// A finite universe of which everything is known needs no budget.
#[test]
fn a_finite_universe_ends_without_budget() {
    let columns = [(1, vec![true, false]), (1, vec![false, true])];
    let class = FiniteClass::new(2, columns).unwrap();
    let target = class.concepts().nth(1).unwrap();
    let config = Config {
        budget: 0,
        ..config(Strategy::Thesis, 0)
    };
    let mut learner = Learner::new(class.clone(), config, Vec::new());
    let order = |_, _| Comparison::Incomparable;
    let mut teacher = TableTeacher {
        class: &class,
        target,
        order,
    };
    for number in 0..4 {
        let (question, round) = match learner.next() {
            Step::Ask {
                question, round, ..
            } => (question, round),
            Step::Done { hypothesis } => {
                assert_eq!(hypothesis, target);
                return;
            }
            Step::Conflict(conflict) => panic!("{conflict:?}"),
        };
        let reply = reply(&mut teacher, &question);
        learner
            .record(AnswerId(number), question, round, reply)
            .unwrap();
    }
    panic!("two membership queries and an equivalence query are enough");
}

/// Facts that no one may take back are told as a conflict without answers.
#[test]
fn contradictory_knowledge_is_told() {
    let target = Target::named("tomita:1").unwrap();
    let word = target.dfa().accepted_words().next().unwrap();
    let label = |accepted| Fact::Label {
        atom: word.clone(),
        accepted,
    };
    let known = vec![label(true), label(false)];
    let mut learner = Learner::new(automata(&target), config(Strategy::Thesis, 0), known);
    let Step::Conflict(conflict) = learner.next() else {
        panic!("a word with two labels");
    };
    assert!(conflict.answers.is_empty());
    let mut teacher = ScriptedTeacher::new(&target, TeacherSettings::default());
    assert!(teacher.membership(&word));
    teach(&mut learner, &mut teacher, 10, process_cpu, |_| ()).unwrap_err();
}
