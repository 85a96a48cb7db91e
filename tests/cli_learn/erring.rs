//! `memrep learn` where answers are wrong or contradict each other.

use serde_json::Value;

use super::{folder, memrep, summary};

/// Wrong answers are dropped and the target learned all the same.
#[test]
fn an_erring_teacher() {
    let folder = folder();
    let mut dropped = 0;
    for seed in 0..5 {
        let arguments = format!(
            "learn --target tomita:6 --error-rate 0.1 --max-states 6 --seed {seed} --format json"
        );
        let outcome = memrep(&folder, &arguments);
        assert_eq!(outcome.status, Some(0), "{}", outcome.stdout);
        dropped += summary(&outcome)["dropped"].as_u64().unwrap();
    }
    assert!(dropped > 0);
}

/// What contradicts is named with its numbers and its cause as soon as it does.
#[test]
fn a_contradiction_is_traced() {
    let folder = folder();
    // Not every teacher who may err does.
    let (arguments, outcome) = (0..10)
        .map(|seed| {
            let arguments = format!(
                "learn --target tomita:6 --error-rate 0.15 --max-states 4 --seed {seed} --trace"
            );
            let outcome = memrep(&folder, &format!("{arguments} --format json"));
            (arguments, outcome)
        })
        .find(|(_, outcome)| outcome.stdout.contains("\"conflict\""))
        .expect("one of ten teachers contradicts what was said before");
    let lines: Vec<Value> = (outcome.stdout.lines())
        .map(|line| serde_json::from_str(line).unwrap())
        .collect();
    let (summary, lines) = lines.split_last().unwrap();
    let mut asked = 0;
    let mut dropped = 0;
    for line in lines {
        if line["question"].is_u64() {
            asked += 1;
            assert_eq!(line["question"], asked);
            continue;
        }
        let numbers = |key: &str| -> Vec<u64> {
            let numbers = line[key].as_array().unwrap();
            numbers.iter().map(|n| n.as_u64().unwrap()).collect()
        };
        let (conflict, gone) = (numbers("conflict"), numbers("dropped"));
        assert!(gone.iter().all(|answer| conflict.contains(answer)));
        let cause = line["cause"].as_str().unwrap();
        assert!(["order", "equality", "membership", "states"].contains(&cause));
        dropped += gone.len();
    }
    assert!(dropped > 0, "nobody erred");
    assert_eq!(summary["dropped"], dropped);
    let people = memrep(&folder, &arguments).stdout;
    assert!(people.contains(" cannot all be true. "), "{people}");
}

/// Where answers may be wrong, it tells how many are and which.
#[test]
fn wrong_answers_are_named() {
    let folder = folder();
    // Not every teacher who may err does.
    let (learn, outcome) = (0..10)
        .map(|seed| {
            let learn = format!(
                "learn --target tomita:6 --strategy bayes --robust --error-rate 0.2 --seed {seed}"
            );
            let outcome = memrep(&folder, &format!("{learn} --trace --format json"));
            (learn, outcome)
        })
        .find(|(_, outcome)| !outcome.stdout.contains("\"doubted\":[]"))
        .expect("one of ten teachers errs");
    assert_eq!(outcome.status, Some(0));
    let summary = summary(&outcome);
    assert_eq!(summary["equivalent"], true);
    assert_eq!(summary["dropped"], 0);
    let doubted = summary["doubted"].as_array().unwrap();
    let answers = summary["membership"].as_f64().unwrap() + summary["comparison"].as_f64().unwrap();
    let share = doubted.len() as f64 / answers;
    assert!(
        (summary["wrong"].as_f64().unwrap() - share).abs() < 1e-3,
        "{summary}"
    );
    assert!(!doubted.is_empty(), "a fifth of the answers are wrong");
    let people = memrep(&folder, &learn);
    let percent = (share * 100.0).round();
    let sentence = format!("(about {percent} % of all are expected to be wrong)");
    assert!(people.stdout.contains(&sentence), "{}", people.stdout);
}
