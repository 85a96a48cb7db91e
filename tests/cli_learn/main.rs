//! `memrep learn` as a shell sees it, and what all commands refuse.

mod erring;

use std::process::Command;

use serde_json::Value;
use tempfile::TempDir;

/// What a run of the command left behind.
struct Outcome {
    status: Option<i32>,
    stdout: String,
    stderr: String,
}

fn memrep(folder: &TempDir, arguments: &str) -> Outcome {
    let output = Command::new(env!("CARGO_BIN_EXE_memrep"))
        .args(arguments.split_whitespace())
        .current_dir(folder.path())
        .output()
        .unwrap();
    Outcome {
        status: output.status.code(),
        stdout: String::from_utf8(output.stdout).unwrap(),
        stderr: String::from_utf8(output.stderr).unwrap(),
    }
}

fn folder() -> TempDir {
    tempfile::tempdir().unwrap()
}

/// The last line as JSON.
fn summary(outcome: &Outcome) -> Value {
    assert_eq!(outcome.stderr, "");
    serde_json::from_str(outcome.stdout.lines().last().unwrap()).unwrap()
}

#[test]
fn learns_and_tells() {
    let folder = folder();
    let outcome = memrep(&folder, "learn --target tomita:4 --seed 7 --format json");
    assert_eq!(outcome.status, Some(0));
    let summary = summary(&outcome);
    assert_eq!(outcome.stdout.lines().count(), 1);
    assert_eq!(summary["target"], "tomita:4");
    assert_eq!(summary["strategy"], "bayes");
    assert_eq!(summary["seed"], 7);
    assert_eq!(summary["equivalent"], true);
    assert_eq!(summary["states"], 4);
    assert_eq!(summary["dropped"], 0);
    let number = |key: &str| summary[key].as_f64().unwrap();
    let cost = 4.0 * number("membership") + number("comparison");
    assert!((number("cost") - cost).abs() < 1e-9, "{summary}");
    assert!(number("equivalence") >= 1.0);
    assert!(summary["question_ms"]["p95"].as_f64() >= summary["question_ms"]["p50"].as_f64());

    let people = memrep(&folder, "learn --target tomita:4 --seed 7");
    assert_eq!(people.status, Some(0));
    assert!(
        people
            .stdout
            .starts_with("learned: tomita:4 with 4 states\n"),
        "{}",
        people.stdout
    );

    // One of something is one, and none are many.
    let few = memrep(&folder, "learn --target tomita:6 --comparison-cost inf");
    let asked = few.stdout.lines().nth(1).unwrap();
    assert!(
        asked.contains(", 0 comparisons, 1 equivalence query"),
        "{asked}"
    );
    let plus = memrep(
        &folder,
        "learn --target tomita:6 --strategy exp4+ --format json",
    );
    assert_eq!(plus.status, Some(0));
    assert_eq!(self::summary(&plus)["strategy"], "exp4+");
}

/// Every question is traced in the form that scripts rely on, and a seed gives
/// the same trace.
#[test]
fn traces_every_question() {
    let folder = folder();
    let arguments =
        "learn --target tomita:6 --teacher random --counterexample random --trace --format json";
    let outcome = memrep(&folder, arguments);
    let lines: Vec<Value> = outcome
        .stdout
        .lines()
        .map(|line| serde_json::from_str(line).unwrap())
        .collect();
    let (summary, questions) = lines.split_last().unwrap();
    let mut counts = std::collections::BTreeMap::new();
    for (index, question) in questions.iter().enumerate() {
        assert_eq!(question["question"], index + 1);
        let kind = question["kind"].as_str().unwrap();
        *counts.entry(kind).or_insert(0) += 1;
        let answer = question["answer"].as_str().unwrap();
        match kind {
            "membership" => {
                assert!(question["word"].is_array());
                assert!(["accept", "reject"].contains(&answer));
            }
            "comparison" => {
                assert!(question["first"].is_array() && question["second"].is_array());
                assert!(["first", "second", "equal", "incomparable"].contains(&answer));
            }
            "equivalence" => {
                assert_eq!(question["hypothesis"]["format"], "memrep-dfa");
                assert_eq!(question["word"].is_array(), answer == "counterexample");
                assert_eq!(question["label"].is_boolean(), answer == "counterexample");
            }
            other => panic!("{other}"),
        }
    }
    assert_eq!(questions.last().unwrap()["answer"], "correct");
    for (kind, count) in counts {
        assert_eq!(summary[kind], count, "{kind}");
    }
    let again = memrep(&folder, arguments);
    let traced = |outcome: &Outcome| {
        outcome
            .stdout
            .rsplit_once("{\"target\"")
            .unwrap()
            .0
            .to_owned()
    };
    assert_eq!(traced(&again), traced(&outcome));
    let people = memrep(&folder, "learn --target tomita:6 --trace");
    assert!(people.stdout.starts_with("1. "), "{}", people.stdout);
}

#[test]
fn membership_only_in_two_ways() {
    let folder = folder();
    for arguments in [
        "learn --target tomita:5 --strategy membership --format json",
        "learn --target tomita:5 --comparison-cost inf --format json",
    ] {
        let summary = summary(&memrep(&folder, arguments));
        assert_eq!(summary["comparison"], 0);
        assert_eq!(
            summary["cost"],
            4.0 * summary["membership"].as_f64().unwrap()
        );
    }
}

/// What is saved is read back as the target, and a saved file is a target.
#[test]
fn saves_what_was_learned() {
    let folder = folder();
    let outcome = memrep(
        &folder,
        "learn --target robot --teacher random --save learned.json",
    );
    assert_eq!((outcome.status, outcome.stderr.as_str()), (Some(0), ""));
    let outcome = memrep(
        &folder,
        "learn --target learned.json --save again.dot --format json",
    );
    assert_eq!(summary(&outcome)["target"], "learned.json");
    assert_eq!(summary(&outcome)["states"], 4);
    let outcome = memrep(&folder, "equivalent learned.json again.dot");
    assert_eq!(outcome.status, Some(0), "{}", outcome.stderr);
}

#[test]
fn too_few_questions_are_a_no() {
    let folder = folder();
    let outcome = memrep(
        &folder,
        "learn --target tomita:7 --max-questions 3 --format json --save x.json",
    );
    assert_eq!(outcome.status, Some(1));
    let summary = summary(&outcome);
    assert_eq!(summary["equivalent"], false);
    assert_eq!(summary["states"], Value::Null);
    assert!(!folder.path().join("x.json").exists());
    let people = memrep(&folder, "learn --target tomita:7 --max-questions 3");
    assert!(
        people.stdout.contains("`--max-questions`"),
        "{}",
        people.stdout
    );
}

#[test]
fn nothing_known_at_the_start() {
    let folder = folder();
    let traced = |arguments| memrep(&folder, arguments).stdout;
    let knowing = traced("learn --target tomita:1 --trace");
    let ignorant = traced("learn --target tomita:1 --trace --no-empty-word");
    assert_ne!(knowing, ignorant);
    assert!(
        !knowing.contains("is the empty word acceptable?"),
        "{knowing}"
    );
}

/// Too small a bound makes true answers contradict each other: they are not dropped,
/// and asked for again, until the questions run out.
#[test]
fn a_bound_below_the_target_is_told() {
    for strategy in ["bayes", "exp4+", "thesis"] {
        let arguments = format!("learn --target modulo:5 --max-states 3 --strategy {strategy}");
        let outcome = memrep(&folder(), &arguments);
        assert_eq!(outcome.status, Some(2), "{}", outcome.stdout);
        let told = outcome
            .stderr
            .contains("`--max-states` is too small: answers ")
            && outcome
                .stderr
                .contains(" are true, and nothing of size 3 or less fits");
        assert!(told, "{}", outcome.stderr);
    }
}

/// What README shows is what happens, but for the times.
#[test]
fn the_example_of_the_readme_is_true() {
    let readme = include_str!("../../README.md");
    let command = "learn --target tomita:5 --membership-cost 4 --seed 7";
    assert!(readme.contains(&format!("$ memrep {command}\n")));
    let outcome = memrep(&folder(), command);
    for line in outcome.stdout.lines().take(3) {
        assert!(readme.contains(&format!("\n{line}\n")), "{line}");
    }
}

/// The check is asked for, told to people and to programs, and counted apart.
#[test]
fn a_claim_is_checked() {
    let folder = folder();
    let arguments = "learn --target tomita:4 --conformance 0.1,0.05 --trace";
    let outcome = memrep(&folder, &format!("{arguments} --format json"));
    assert_eq!(outcome.status, Some(0), "{}", outcome.stderr);
    let summary = summary(&outcome);
    let check = &summary["conformance"];
    assert_eq!(
        (&check["needed"], &check["judged"]),
        (&36.into(), &36.into())
    );
    assert_eq!(check["complete"], true);
    assert!(check["share"].as_f64() <= Some(0.1));
    let lines: Vec<Value> = (outcome.stdout.lines())
        .map(|line| serde_json::from_str(line).unwrap())
        .collect();
    let checks = lines.iter().filter(|line| line["check"] == 1);
    assert_eq!(check["asked"], checks.clone().count());
    assert!(checks.clone().all(|line| line["kind"] == "membership"));
    let plain = memrep(&folder, "learn --target tomita:4 --format json");
    let plain: Value = serde_json::from_str(&plain.stdout).unwrap();
    assert_eq!(plain.get("conformance"), None);
    for key in ["membership", "comparison", "equivalence", "cost"] {
        assert_eq!(plain[key], summary[key], "{key}");
    }
    let people = memrep(&folder, arguments);
    let claim = check["claim"].as_str().unwrap();
    assert!(
        people.stdout.contains(&format!("checked: {claim}")),
        "{}",
        people.stdout
    );
    assert!(
        people
            .stdout
            .contains(" of 36 random words judged: wrong about at most ")
    );

    let cut = memrep(
        &folder,
        "learn --target tomita:4 --conformance 0.1,0.05 --max-questions 40",
    );
    assert_eq!(cut.status, Some(1), "{}", cut.stdout);
    assert!(
        cut.stdout.contains("allow more by `--max-questions`"),
        "{}",
        cut.stdout
    );
}

#[test]
fn bad_input_is_told() {
    let folder = folder();
    std::fs::write(folder.path().join("cut.json"), "{\"format\":").unwrap();
    std::fs::write(
        folder.path().join("labels.jsonl"),
        "{\"word\":[\"a\"],\"label\":true}\n",
    )
    .unwrap();
    let cases = [
        ("learn", "--target"),
        (
            "learn --target tomita:9",
            "give a number from 1 to 7, or 3t",
        ),
        ("learn --target tomita:", "give a number from 1 to 7, or 3t"),
        ("learn --target nothing", "there is no target `nothing`"),
        (
            "learn --target missing.toml",
            "missing.toml: cannot read it",
        ),
        ("learn --target cut.json", "cut.json: line 1"),
        ("learn --target labels.jsonl", "expected an automaton"),
        (
            "learn --target robot --membership-cost 0",
            "give a positive number",
        ),
        (
            "learn --target robot --membership-cost inf",
            "give a positive number",
        ),
        (
            "learn --target robot --comparison-cost -1",
            "--comparison-cost",
        ),
        (
            "learn --target robot --comparison-cost nan",
            "give a positive number, or `inf`",
        ),
        (
            "learn --target robot --error-rate 2",
            "give a number from 0 to 1",
        ),
        (
            "learn --target robot --conformance 0.05",
            "give two numbers between 0 and 1",
        ),
        (
            "learn --target robot --conformance 5,0.05",
            "the share of errors must be between 0 and 1",
        ),
        (
            "learn --target robot --conformance 0.05,-1",
            "the risk must be between 0 and 1",
        ),
        (
            "learn --target robot --conformance 1e-9,0.05",
            "allow a larger share of errors",
        ),
        ("learn --target robot --max-states 0", "--max-states"),
        (
            "learn --target robot --strategy thesis --robust",
            "add `--strategy bayes`",
        ),
        (
            "learn --target robot --promise shortest --counterexample random",
            "add `--counterexample shortest`",
        ),
        (
            "learn --target robot --equivalence-cost -1",
            "give a number, 0 or more",
        ),
        (
            "learn --target robot --strategy best",
            "possible values: bayes, exp4+, thesis",
        ),
        (
            "learn --target robot --save no/such/folder.json",
            "there is no folder no/such: make it first",
        ),
        (
            "learn --target robot --save learned.png",
            "the extension does not tell the format",
        ),
        (
            "learn --target robot --robust --conformance 0.1,0.1",
            "`--robust` takes none so: give one of the two",
        ),
        ("bench nothing", "unrecognized subcommand"),
    ];
    for (arguments, message) in cases {
        let outcome = memrep(&folder, arguments);
        assert_eq!(outcome.status, Some(2), "{arguments}: {}", outcome.stdout);
        assert!(
            outcome.stderr.contains(message),
            "{arguments}: {}",
            outcome.stderr
        );
    }
}
