//! How much a person has to press: the robot's task as its guidelines put it, from the
//! start page to the file with the automaton, by one who looks at the samples of a rule.

use std::path::Path;
use std::sync::Arc;

use automata::{Dfa, Word};
use memrep::oracle::{SituatedTeacher, Target, Teacher, TeacherSettings};
use memrep::task::TaskFile;
use serde_json::{Value, json};

use crate::api::{create, dfa, word};
use crate::site::Site;

/// What is pressed from the start page to the file at most.
const MOST: usize = 30;

/// What the task's guidelines say: of two walks an acceptable one is better than one
/// that is not, and others are equally good or bad.
fn opinion(target: &Dfa, question: &Value) -> &'static str {
    let accepts = |key: &str| target.accepts(&word(target.alphabet(), &question[key]));
    match question["kind"].as_str().unwrap() {
        "membership" if accepts("word") => "accept",
        "membership" => "reject",
        "comparison" => match (accepts("first"), accepts("second")) {
            (true, false) => "first",
            (false, true) => "second",
            _ => "equal",
        },
        other => panic!("{other} is answered otherwise"),
    }
}

/// Teaches the task with this seed; what was pressed on the way.
async fn clicks(site: &Site, teacher: &mut SituatedTeacher, target: &Dfa, seed: u64) -> usize {
    let task =
        json!({"task": "robot-recharge", "strategy": "bayes", "membership_cost": 4, "seed": seed});
    let session = create(site, task).await;
    // The task is begun, and in the end its automaton is downloaded.
    let mut clicks = 2;
    loop {
        let question = site.get(&format!("{session}/question")).await.json();
        let number = &question["number"];
        let said = match question["kind"].as_str().unwrap() {
            "done" => break,
            "equivalence" => {
                let rule = dfa(&question["hypothesis"]);
                let differs = |word: &Word| rule.accepts(word) != target.accepts(word);
                let sheet = site.get(&format!("{session}/samples")).await.json();
                let samples = sheet["samples"].as_array().unwrap().iter();
                let mut samples = samples.map(|sample| word(target.alphabet(), sample));
                let objection = if let Some(wrong) = samples.find(differs) {
                    // It has a button.
                    Some((target.accepts(&wrong), wrong))
                } else {
                    let missed = teacher.counterexample(&rule);
                    // A box to tick with the agreement; or else a button for each thing
                    // that happens, by which the label is chosen too.
                    clicks += missed.as_ref().map_or(1, |(word, _)| word.len());
                    missed.map(|(word, label)| (label, word))
                };
                match objection {
                    None => json!({"question": number, "answer": "correct"}),
                    Some((label, word)) => {
                        let names: Vec<&str> = target.alphabet().spell(&word).collect();
                        json!({"question": number, "answer": "counterexample", "word": names, "label": label})
                    }
                }
            }
            _ => json!({"question": number, "answer": opinion(target, &question)}),
        };
        clicks += 1;
        site.post(&format!("{session}/answers"), said).await;
    }
    let file = site.get(&format!("{session}/automaton")).await;
    let learned = automata::format::json::read(&file.text).unwrap().dfa;
    assert!(learned.is_equivalent(target).unwrap(), "seed {seed}");
    clicks
}

#[tokio::test]
async fn the_robot_is_taught_with_at_most_thirty_clicks() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/tasks/robot-recharge.toml");
    let file = TaskFile::open(&file).unwrap();
    let situation = file.universe.situation().unwrap();
    let target = Target::named("robot").unwrap();
    let site = Site::in_memory();
    let mut all = Vec::new();
    for seed in 0..10 {
        let (world, open) = (Arc::clone(&situation.world), situation.prior.open().clone());
        let mut teacher = SituatedTeacher::new(world, open, &target, TeacherSettings::default());
        all.push(clicks(&site, &mut teacher, target.dfa(), seed).await);
    }
    println!("Clicks by seed: {all:?}");
    assert!(all.iter().all(|&clicks| clicks <= MOST), "{all:?}");
}
