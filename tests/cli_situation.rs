//! `memrep learn` beside what is known beforehand, and on a grid, as a shell sees it.

use std::process::{Command, Output};

use automata::format::json;
use memrep::oracle::Target;
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
        let line: serde_json::Value = serde_json::from_str(line).unwrap();
        for key in ["word", "first", "second"] {
            if let Some(word) = line[key].as_array() {
                assert!(!word.contains(&"R".into()), "{line}");
                assert!(word.contains(&"Y".into()), "{line}");
            }
        }
    }
    let read = |name: &str| {
        let text = std::fs::read_to_string(folder.path().join(name)).unwrap();
        json::read(&text).unwrap().dfa
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
    let text = error(&learn(&folder, &["--grid", "bad.txt"]));
    assert!(
        text.contains("`--grid bad.txt`") && text.contains('x'),
        "{text}"
    );
}
