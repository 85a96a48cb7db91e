//! Whole runs on the targets of chapter 5.

use memrep::bench::{process_cpu, teach};
use memrep::concept::DfaClass;
use memrep::identify::{EngineChoice, Settings};
use memrep::learner::{Config, Learner, Strategy};
use memrep::oracle::{Counterexamples, Order, ScriptedTeacher, Target, TeacherSettings};

use crate::finite::config;

fn run(
    target: &Target,
    config: Config,
    settings: TeacherSettings,
) -> memrep::bench::Report<automata::Dfa> {
    let bound = Settings {
        engine: EngineChoice::Auto,
        // Where the teacher errs, wrong answers look like further states.
        max_states: if settings.error_rate > 0.0 { 6 } else { 24 },
    };
    let class = DfaClass::new(target.dfa().alphabet().clone(), bound);
    let mut learner = Learner::new(class, config, target.known().to_vec());
    let mut teacher = ScriptedTeacher::new(target, settings);
    teach(&mut learner, &mut teacher, 1000, process_cpu, |_| ()).expect("the setup is sound")
}

#[test]
fn every_target_is_learned() {
    let names = [
        "tomita:1",
        "tomita:2",
        "tomita:3",
        "tomita:3t",
        "tomita:4",
        "tomita:5",
        "tomita:6",
        "tomita:7",
        "modulo:5",
        "modulo:10",
        "zeros:1",
        "zeros:3",
        "robot",
    ];
    for name in names {
        let target = Target::named(name).unwrap();
        for seed in 0..3 {
            for (order, counterexamples) in [
                (Order::Ordered, Counterexamples::Shortest),
                (Order::Random, Counterexamples::Random),
            ] {
                for strategy in [Strategy::Thesis, Strategy::Membership] {
                    let settings = TeacherSettings {
                        order,
                        counterexamples,
                        error_rate: 0.0,
                        seed,
                    };
                    let report = run(&target, config(strategy, seed), settings);
                    let learned = report
                        .learned
                        .unwrap_or_else(|| panic!("{name}, {settings:?}, {strategy:?}"));
                    assert_eq!(learned, target.dfa().canonical(), "{name}");
                    assert_eq!(report.dropped, 0, "the teacher does not err");
                    let counts = report.counts;
                    let cost = f64::from(4 * counts.membership + counts.comparison);
                    assert!((report.cost - cost).abs() < 1e-9);
                    if strategy == Strategy::Membership {
                        assert_eq!(counts.comparison, 0);
                    }
                }
            }
        }
    }
}

/// With an infinite cost, the thesis' strategy asks no comparison either, and
/// that costs nothing.
#[test]
fn an_infinite_cost_means_never() {
    let target = Target::named("tomita:6").unwrap();
    let config = Config {
        comparison_cost: f64::INFINITY,
        ..config(Strategy::Thesis, 0)
    };
    let report = run(&target, config, TeacherSettings::default());
    assert_eq!(report.counts.comparison, 0);
    assert!(report.cost.is_finite());
}

/// Fig. 5.5: wrong answers are found out and dropped, and the target is learned.
#[test]
fn a_teacher_who_errs_is_survived() {
    let target = Target::named("tomita:6").unwrap();
    let mut dropped = 0;
    for seed in 0..5 {
        for error_rate in [0.05, 0.2] {
            let settings = TeacherSettings {
                error_rate,
                seed,
                ..TeacherSettings::default()
            };
            let report = run(&target, config(Strategy::Thesis, seed), settings);
            let learned = report
                .learned
                .unwrap_or_else(|| panic!("seed {seed}, error rate {error_rate}"));
            assert!(learned.is_equivalent(target.dfa()).unwrap());
            dropped += report.dropped;
        }
    }
    assert!(dropped > 0, "nobody noticed an error");
}
