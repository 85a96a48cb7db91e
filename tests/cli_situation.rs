//! `memrep learn` beside what is known beforehand, and on a grid, as a shell sees it.

use std::fmt::Write as _;
use std::process::{Command, Output};

use automata::format::json as automaton;
use memrep::oracle::Target;
use serde_json::{Value, json};
use tempfile::TempDir;

/// A room with lava, recharge, water and dryer tiles.
const ROOM: &str = "....B...\n.RR...Y.\n....S...\n.OO.B.R.\nY.......\n";

fn learn(folder: &TempDir, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_memrep"))
        .args(["learn", "--target", "robot", "--teacher", "random"])
        .args(arguments)
        .current_dir(folder.path())
        .output()
        .unwrap()
}

fn folder() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("room.txt"), ROOM).unwrap();
    folder
}

fn error(output: &Output) -> String {
    assert_eq!(output.status.code(), Some(2));
    String::from_utf8(output.stderr.clone()).unwrap()
}

/// The whole that is saved is the target; the part is not, and with the rules it is.
#[test]
fn what_is_known_is_not_asked() {
    let folder = folder();
    let rules = ["--prior", "avoid R", "--prior", "reach Y"];
    let saved = ["--save", "whole.json", "--save-part", "part.json"];
    let output = learn(
        &folder,
        &[&rules[..], &saved, &["--trace", "--format", "json"]].concat(),
    );
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    let trace = String::from_utf8(output.stdout).unwrap();
    for line in trace.lines() {
        let line: Value = serde_json::from_str(line).unwrap();
        for key in ["word", "first", "second"] {
            if let Some(word) = line[key].as_array() {
                assert!(!word.contains(&"R".into()), "{line}");
                assert!(word.contains(&"Y".into()), "{line}");
            }
        }
    }
    let read = |name: &str| {
        let text = std::fs::read_to_string(folder.path().join(name)).unwrap();
        automaton::read(&text).unwrap().dfa
    };
    let target = Target::named("robot").unwrap();
    assert_eq!(read("whole.json").is_equivalent(target.dfa()), Ok(true));
    assert_eq!(read("part.json").is_equivalent(target.dfa()), Ok(false));

    // A file does for a rule.
    let again = learn(
        &folder,
        &["--prior", "part.json", "--suffices", "whole.json"],
    );
    assert_eq!(again.status.code(), Some(0), "{again:?}");
}

#[test]
fn only_walks_are_asked_about() {
    let folder = folder();
    let output = learn(
        &folder,
        &[
            "--prior",
            "avoid R",
            "--grid",
            "room.txt",
            "--steps",
            "20",
            "--no-empty-word",
        ],
    );
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    let text = String::from_utf8(output.stdout).unwrap();
    assert!(text.starts_with("learned: robot with "), "{text}");
}

/// Every walk that is told goes from cell to neighbouring cell, and gives the word
/// of its question.
#[test]
fn walks_are_told() {
    let folder = folder();
    let grid = ["--grid", "room.txt", "--labelling", "every-step"];
    let rest = ["--no-empty-word", "--trace", "--format", "json"];
    let output = learn(&folder, &[&grid[..], &rest].concat());
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    let room: Vec<Vec<char>> = ROOM.lines().map(|line| line.chars().collect()).collect();
    let mut walks = 0;
    for line in String::from_utf8(output.stdout).unwrap().lines() {
        let line: Value = serde_json::from_str(line).unwrap();
        let words = ["first", "second", "word"].map(|key| line[key].clone());
        let words = words.iter().filter_map(Value::as_array);
        let shown = line["shown"].as_array().cloned().unwrap_or_default();
        for (shown, word) in shown.iter().zip(words) {
            let cells: Vec<[usize; 2]> = serde_json::from_value(shown["walk"].clone()).unwrap();
            assert_eq!(cells[0], [2, 4], "the start");
            for step in cells.windows(2) {
                let far = step[0][0].abs_diff(step[1][0]) + step[0][1].abs_diff(step[1][1]);
                assert!(far <= 1, "{line}");
            }
            let given: Vec<String> = (cells[1..].iter())
                .map(|at| room[at[0]][at[1]])
                .filter(|mark| "RYBO".contains(*mark))
                .map(String::from)
                .collect();
            assert_eq!(
                &given,
                &serde_json::from_value::<Vec<String>>(word.clone().into()).unwrap()
            );
            walks += 1;
        }
    }
    assert!(walks > 10, "{walks}");
}

/// Only recordings are asked about, and what they leave undecided is told.
#[test]
fn only_recordings_are_asked_about() {
    let folder = folder();
    let words = ["", "Y", "B", "BY", "BOY", "YBOY", "R", "RY", "O", "OY"];
    let mut file = String::new();
    for (number, word) in words.iter().enumerate() {
        let word: Vec<String> = word.chars().map(String::from).collect();
        let id = format!("run-{number}");
        writeln!(file, "{}", json!({"id": id, "word": word})).unwrap();
    }
    std::fs::write(folder.path().join("pool.jsonl"), file).unwrap();
    let pool = [
        "--pool",
        "pool.jsonl",
        "--no-empty-word",
        "--trace",
        "--format",
        "json",
    ];
    let output = learn(&folder, &pool);
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    let trace = String::from_utf8(output.stdout).unwrap();
    let lines: Vec<Value> = trace
        .lines()
        .map(|l| serde_json::from_str(l).unwrap())
        .collect();
    let (summary, lines) = lines.split_last().unwrap();
    for line in lines {
        for shown in line["shown"].as_array().into_iter().flatten() {
            let id = shown["recording"].as_str().unwrap();
            assert!(id.starts_with("run-"), "{line}");
        }
    }
    assert_eq!(summary["equivalent"], true);
    let beyond = summary["beyond"]
        .as_array()
        .expect("ten words decide little");
    let beyond: String = beyond
        .iter()
        .map(|symbol| symbol.as_str().unwrap())
        .collect();
    assert!(!words.contains(&beyond.as_str()), "{beyond}");
    let people = learn(&folder, &pool[..3]);
    let people = String::from_utf8(people.stdout).unwrap();
    assert!(
        people.contains("undecided: nothing that can be shown is like"),
        "{people}"
    );
}

#[test]
fn faults_name_their_place() {
    let folder = folder();
    let cases: [(&[&str], &str); 6] = [
        (&["--prior", "shun R"], "is no rule that is known by name"),
        (&["--prior", "avoid Q"], "`Q` is not a symbol"),
        (&["--prior", "none.json"], "none.json"),
        (&["--prior", "avoid Y"], "example 1"),
        (
            &["--grid", "nowhere.txt"],
            "`--grid nowhere.txt` cannot be read",
        ),
        (&["--save-part", "x.json"], "use `--save`"),
    ];
    for (arguments, expected) in cases {
        let text = error(&learn(&folder, arguments));
        assert!(text.contains(expected), "{arguments:?}: {text}");
    }
    std::fs::write(folder.path().join("bad.txt"), "..B\n.x.\nS..\n").unwrap();
    std::fs::write(
        folder.path().join("bad.jsonl"),
        "{\"id\":\"a\",\"word\":[\"Q\"]}\n",
    )
    .unwrap();
    let text = error(&learn(&folder, &["--pool", "bad.jsonl"]));
    assert!(
        text.contains("line 1") && text.contains("word[0]"),
        "{text}"
    );
    let text = error(&learn(&folder, &["--grid", "bad.txt"]));
    assert!(
        text.contains("`--grid bad.txt`") && text.contains('x'),
        "{text}"
    );
}
