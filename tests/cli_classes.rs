//! `memrep learn` on targets that are no automata, as a shell sees it.

use std::process::Command;

use serde_json::Value;
use tempfile::TempDir;

const TABLE: &str = "behaviour,always,polite,quiet\nsize,1,2,2\n\"greets, warmly\",1,1,0\nwaits,1,1,1\ninterrupts,1,0,0\n";
const REWARDS: &str = r#"{"weights": [0.5, -1.0], "threshold": 0.2, "behaviours": [
  {"name": "parks", "features": [[0.0, 0.0]]},
  {"name": "drives", "features": [[0.6, 0.1], [0.6, 0.1]]},
  {"name": "races", "features": [[1.0, 0.4], [1.0, 0.5]]}
]}"#;

/// Runs the command in a folder with both files: its status, output and errors.
fn memrep(arguments: &str) -> (Option<i32>, String, String, TempDir) {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("table.csv"), TABLE).unwrap();
    std::fs::write(folder.path().join("rewards.json"), REWARDS).unwrap();
    let output = Command::new(env!("CARGO_BIN_EXE_memrep"))
        .args(arguments.split_whitespace())
        .current_dir(folder.path())
        .output()
        .unwrap();
    let text = |bytes| String::from_utf8(bytes).unwrap();
    let (stdout, stderr) = (text(output.stdout), text(output.stderr));
    (output.status.code(), stdout, stderr, folder)
}

fn lines(stdout: &str) -> Vec<Value> {
    let lines = stdout.lines();
    lines
        .map(|line| serde_json::from_str(line).unwrap())
        .collect()
}

#[test]
fn every_class_is_learned_by_every_strategy() {
    for target in [
        "monotone:1:20",
        "monotone:2:8",
        "monotone:4:3:7",
        "finite:table.csv",
        "finite:table.csv#quiet",
        "linear:rewards.json",
    ] {
        for strategy in ["bayes", "exp4+", "thesis", "membership"] {
            for teacher in ["ordered", "random"] {
                let (status, stdout, stderr, _folder) = memrep(&format!(
                    "learn --target {target} --strategy {strategy} --teacher {teacher} --seed 5 --format json"
                ));
                assert_eq!(
                    (status, stderr.as_str()),
                    (Some(0), ""),
                    "{target} {strategy}"
                );
                let summary = &lines(&stdout)[0];
                assert_eq!(summary["target"], target);
                assert_eq!(summary["equivalent"], true);
                assert!(summary["size"].as_u64().unwrap() >= 1);
                assert_eq!(summary.get("states"), None);
                let number = |key: &str| summary[key].as_f64().unwrap();
                let cost = 4.0 * number("membership") + number("comparison");
                assert!((number("cost") - cost).abs() < 1e-9, "{summary}");
            }
        }
    }
}

/// Every line of the trace tells its atoms as the class has them, and what was
/// saved is what was shown last.
#[test]
fn questions_are_traced_and_the_concept_is_saved() {
    let (status, stdout, _, folder) = memrep(
        "learn --target monotone:2:7:4 --strategy thesis --trace --format json --save out.json",
    );
    assert_eq!(status, Some(0));
    let lines = lines(&stdout);
    let (summary, questions) = lines.split_last().unwrap();
    let point = |value: &Value| {
        let point: Vec<f64> = value
            .as_array()
            .unwrap()
            .iter()
            .map(|at| at.as_f64().unwrap())
            .collect();
        assert_eq!(point.len(), 2);
        assert!(point.iter().all(|at| (0.0..=1.0).contains(at)));
        point
    };
    let last = questions.last().unwrap();
    let target = point(&last["hypothesis"]["parameter"]);
    let contains = |atom: &Value| {
        point(atom)
            .iter()
            .zip(&target)
            .all(|(low, high)| low <= high)
    };
    let mut kinds = [0; 3];
    for line in questions {
        match line["kind"].as_str().unwrap() {
            "membership" => {
                kinds[0] += 1;
                assert_eq!(
                    line["answer"] == "accept",
                    contains(&line["atom"]),
                    "{line}"
                );
            }
            "comparison" => {
                kinds[1] += 1;
                let (first, second) = (contains(&line["first"]), contains(&line["second"]));
                match line["answer"].as_str().unwrap() {
                    "first" => assert!(first >= second),
                    "second" => assert!(first <= second),
                    "equal" => assert_eq!(first, second),
                    other => assert_eq!(other, "incomparable"),
                }
            }
            _ => {
                kinds[2] += 1;
                if line["answer"] == "counterexample" {
                    assert_eq!(line["label"].as_bool(), Some(contains(&line["atom"])));
                }
            }
        }
    }
    assert_eq!(summary["membership"], kinds[0]);
    assert_eq!(summary["comparison"], kinds[1]);
    assert_eq!(summary["equivalence"], kinds[2]);
    let saved = std::fs::read_to_string(folder.path().join("out.json")).unwrap();
    let saved: Value = serde_json::from_str(&saved).unwrap();
    assert_eq!(saved["format"], "memrep-monotone");
    assert_eq!(saved["version"], 1);
    assert_eq!(saved["concept"], last["hypothesis"]);

    let (_, stdout, _, folder) =
        memrep("learn --target finite:table.csv#polite --trace --format json --save out.json");
    let named = self::lines(&stdout);
    assert!(
        named.iter().any(|line| line["hypothesis"] == "polite"),
        "{stdout}"
    );
    let saved = std::fs::read_to_string(folder.path().join("out.json")).unwrap();
    assert!(saved.contains("\"memrep-finite\"") && saved.contains("\"concept\":\"polite\""));

    let (_, stdout, _, _folder) = memrep("learn --target finite:table.csv#polite --trace");
    assert!(
        stdout.contains("is it `polite`? correct\nlearned: "),
        "{stdout}"
    );
    let (_, stdout, _, _folder) = memrep("learn --target monotone:2:5:3 --trace --strategy thesis");
    assert!(stdout.contains("in every dimension? correct"), "{stdout}");
    let (_, stdout, _, folder) =
        memrep("learn --target linear:rewards.json --trace --save out.json");
    assert!(
        stdout.contains("? correct\nlearned: linear:rewards.json as a reward above"),
        "{stdout}"
    );
    let saved = std::fs::read_to_string(folder.path().join("out.json")).unwrap();
    let saved: Value = serde_json::from_str(&saved).unwrap();
    assert_eq!(saved["concept"]["weights"].as_array().unwrap().len(), 2);
}

#[test]
fn a_check_and_wrong_answers_work_as_for_automata() {
    let (status, stdout, _, _folder) =
        memrep("learn --target monotone:2:6 --conformance 0.2,0.2 --seed 2");
    assert_eq!(status, Some(0));
    assert!(stdout.contains("\nchecked: "), "{stdout}");
    let (status, stdout, _, _folder) =
        memrep("learn --target monotone:2:6 --error-rate 0.1 --robust --seed 2 --format json");
    assert_eq!(status, Some(0), "{stdout}");
    assert_eq!(lines(&stdout)[0]["equivalent"], true);
    // One person's promise: nothing simpler refutes.
    let (status, ..) = memrep("learn --target monotone:3:6 --promise shortest --seed 1");
    assert_eq!(status, Some(0));
}

fn refused(arguments: &str, reason: &str) {
    let (status, stdout, stderr, _folder) = memrep(&format!("learn --target {arguments}"));
    assert_eq!((status, stdout.as_str()), (Some(2), ""), "{arguments}");
    assert!(stderr.contains(reason), "{arguments}: {stderr}");
}

#[test]
fn bad_targets_are_refused() {
    for name in [
        "monotone:0:5",
        "monotone:5:5",
        "monotone:2",
        "monotone:2:1",
        "monotone:4:17",
        "monotone:2:5:1:1",
        "monotone:a:b",
    ] {
        refused(name, "give monotone:D:TICKS");
    }
    refused("monotone:2:5 --prior x", "`--prior` is about words");
    refused("monotone:2:5 --suffices x", "`--suffices` is about words");
    refused("monotone:2:5 --grid room.txt", "`--grid` is about words");
    refused("finite:table.csv --pool x", "`--pool` is about words");
    refused(
        "finite:table.csv --max-states 4",
        "`--max-states` is about words",
    );
    refused(
        "finite:table.csv#rude",
        "has no concept `rude`: give one of always, polite, quiet",
    );
    refused("finite:missing.csv", "missing.csv: cannot read it");
    refused("linear:missing.json", "missing.json: cannot read it");
    refused("linear:table.csv", "line 1 column 1");
}

#[test]
fn bad_files_are_refused_with_their_place() {
    let folder = tempfile::tempdir().unwrap();
    let refuse = |kind: &str, text: &str, reason: &str| {
        std::fs::write(folder.path().join("file"), text).unwrap();
        let output = Command::new(env!("CARGO_BIN_EXE_memrep"))
            .args(["learn", "--target", &format!("{kind}:file")])
            .current_dir(folder.path())
            .output()
            .unwrap();
        let stderr = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{text}");
        assert!(stderr.contains(reason), "{text:?}: {stderr}");
    };
    let table = |text, reason| refuse("finite", text, reason);
    table("", "line 1, column 1: the table is empty");
    table("# none\n\n", "the table is empty");
    table("x\n", "line 1, column 1: there is no concept");
    table(
        "x,a,a\nb,1,0\n",
        "line 1, column 5: `a` is the name of another concept",
    );
    table(
        "x,a,\nb,1,0\n",
        "line 1, column 5: this concept has no name",
    );
    table(
        "x,a,c\nb,1\n",
        "line 2, column 3: this line has 2 fields and the first has 3",
    );
    table(
        "x,a,c\nb,1,0,1\n",
        "line 2, column 7: this line has 4 fields",
    );
    table("x,a,c\nb,1,yes\n", "line 2, column 5: `yes` is no entry");
    table(
        "x,a,c\nsize,1,0\nb,1,0\n",
        "line 2, column 8: `0` is no size",
    );
    table(
        "x,a,c\nb,1,0\nb,0,1\n",
        "line 3, column 1: `b` is the name of another behaviour too, in line 2",
    );
    table(
        "x,a,c\nb,1,1\n",
        "line 1, column 5: `a` and `c` contain the same",
    );
    table(
        "x,a,c\n\"b,1,0\n",
        "line 2, column 1: this quote is never closed",
    );
    table(
        "x,a,c\n\"b\" c,1,0\n",
        "line 2, column 5: after a quoted field comes a comma",
    );
    let rewards = |text, reason| refuse("linear", text, reason);
    rewards(
        "{\"weights\":[1]}",
        "missing field `threshold` at line 1 column 15",
    );
    rewards(
        "{\"weights\":[1],\"threshold\":0,\"behaviours\":[]}",
        "there is no behaviour",
    );
    rewards(
        "{\"weights\":[1],\"threshold\":0,\"behaviours\":[{\"name\":\"a\",\"features\":[[2]]}]}",
        "behaviour 1, step 1, feature 1 is 2",
    );
    rewards(
        "{\"weights\":[1,1],\"threshold\":0,\"behaviours\":[{\"name\":\"a\",\"features\":[[1]]}]}",
        "2 weights for 1 features",
    );
    rewards(
        "{\"weights\":[1],\"threshold\":0,\"finest\":1,\"behaviours\":[{\"name\":\"a\",\"features\":[[1]]}]}",
        "`finest` is 1",
    );
    rewards(
        "{\"weights\":[0,0,0,0],\"threshold\":0,\"behaviours\":[{\"name\":\"a\",\"features\":[[1,1,1,1]]}]}",
        "there are 4 features",
    );
    rewards(
        "{\"weights\":[0.5],\"threshold\":0.26,\"finest\":2,\"behaviours\":[{\"name\":\"a\",\"features\":[[0.5]]},{\"name\":\"b\",\"features\":[[0.6]]}]}",
        "raise `finest`",
    );
}
