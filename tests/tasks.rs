//! Task files, as a shell sees them: the ready ones are taught to the end, and what is
//! wrong with others is told by line and column.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use automata::format::json as automaton;
use memrep::task::{Concept, TaskFile};
use serde_json::Value;

fn memrep(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_memrep"))
        .args(arguments)
        .current_dir(folder)
        .output()
        .unwrap()
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).unwrap()
}

fn ready() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/tasks");
    let files = std::fs::read_dir(folder).unwrap();
    let mut files: Vec<PathBuf> = files.map(|file| file.unwrap().path()).collect();
    files.sort();
    files
}

/// Each is checked, and taught by a scripted teacher; what is learned agrees with the
/// target on all that can happen.
#[test]
fn the_ready_tasks_are_learned() {
    let names: Vec<String> = (ready().iter())
        .map(|path| path.file_stem().unwrap().to_str().unwrap().to_owned())
        .collect();
    assert_eq!(
        names,
        [
            "car",
            "deliver",
            "four-buttons",
            "patrol",
            "repairs",
            "robot-recharge"
        ]
    );
    for path in ready() {
        let name = path.to_str().unwrap();
        let folder = tempfile::tempdir().unwrap();
        let checked = memrep(folder.path(), &["task", "check", name, "--format", "json"]);
        assert_eq!(checked.status.code(), Some(0), "{checked:?}");
        let summary: Value = serde_json::from_slice(&checked.stdout).unwrap();

        let save = ["--seed", "3", "--save", "learned.json"];
        let arguments = [&["learn", "--target", name], &save[..]].concat();
        let learned = memrep(folder.path(), &arguments);
        assert_eq!(learned.status.code(), Some(0), "{name}: {learned:?}");
        let saved = std::fs::read_to_string(folder.path().join("learned.json")).unwrap();
        let file = TaskFile::open(&path).unwrap();
        let (task, target) = (&file.task, file.target.unwrap());
        assert!(
            !task.guidelines.is_empty() && task.practice.is_some(),
            "{name}"
        );
        let Concept::Automaton(target) = target else {
            let saved: Value = serde_json::from_str(&saved).unwrap();
            assert_eq!(saved["concept"]["limits"], serde_json::json!([40.0, 1.0]));
            assert_eq!(summary["class"], "monotone");
            continue;
        };
        assert_eq!(summary["never_shown"], serde_json::json!([]), "{summary}");
        assert_ne!(summary["simplest"], serde_json::json!([]), "{summary}");
        let learned = automaton::read(&saved).unwrap().dfa;
        let differ = learned.xor(&target).unwrap();
        let situation = file.universe.situation().unwrap();
        assert_eq!(situation.world.simplest(&differ, 1), [], "{name}");
        assert!(
            task.symbols
                .iter()
                .all(|s| s.colour.is_some() && s.letter.is_some())
        );
    }
}

/// The practice question of each is answered as its target does.
#[test]
fn practice_tells_the_truth() {
    for path in ready() {
        let file = TaskFile::open(&path).unwrap();
        let (target, practice) = (file.target.unwrap(), file.task.practice.clone().unwrap());
        let question = serde_json::to_value(&practice).unwrap();
        let accepts = |key: &str| {
            let atom = file.universe.read(&question[key], key).unwrap();
            file.universe.accepts(&target, &atom)
        };
        let expected = if question.get("word").is_some() {
            if accepts("word") { "accept" } else { "reject" }
        } else {
            match (accepts("first"), accepts("second")) {
                (true, false) => "first",
                (false, true) => "second",
                _ => panic!("{}: the practice question does not differ", path.display()),
            }
        };
        assert_eq!(practice.answer, expected, "{}", path.display());
    }
}

#[test]
fn a_new_task_passes_its_check_and_nothing_is_overwritten() {
    let folder = tempfile::tempdir().unwrap();
    let new = memrep(folder.path(), &["task", "new", "tea.toml"]);
    assert_eq!(new.status.code(), Some(0), "{new:?}");
    let checked = memrep(folder.path(), &["task", "check", "tea.toml"]);
    assert_eq!(checked.status.code(), Some(0), "{checked:?}");
    assert!(text(&checked.stdout).contains("a grid of 3 × 6 cells"));
    let learned = memrep(folder.path(), &["learn", "--target", "tea.toml"]);
    assert_eq!(learned.status.code(), Some(0), "{learned:?}");

    std::fs::write(folder.path().join("tea.toml"), "mine").unwrap();
    let again = memrep(folder.path(), &["task", "new", "tea.toml"]);
    assert_eq!(again.status.code(), Some(2));
    assert!(text(&again.stderr).contains("there already"), "{again:?}");
    let kept = std::fs::read_to_string(folder.path().join("tea.toml")).unwrap();
    assert_eq!(kept, "mine");
    let printed = memrep(folder.path(), &["task", "new"]);
    assert!(text(&printed.stdout).starts_with("# A task"));
}

const ROOM: &str = r#"symbols = ["a", "b"]
target = "reach b"
examples = [
  { word = ["b"], label = true },
]
[world]
kind = "grid"
steps = 9
map = """
S.a
#.b
"""
[prior]
holds = ["b.json"]
"#;

/// Each line of a report begins with the file, the line and the column.
#[test]
fn faults_are_told_by_line_and_column() {
    let folder = tempfile::tempdir().unwrap();
    let rule = r#"{"format":"memrep-dfa","version":1,"alphabet":["a","b"],"states":2,"start":0,"accepting":[1],"delta":[[0,1],[1,1]]}"#;
    std::fs::write(folder.path().join("b.json"), rule).unwrap();
    let check = |content: &str| {
        std::fs::write(folder.path().join("room.toml"), content).unwrap();
        memrep(folder.path(), &["task", "check", "room.toml"])
    };
    // Rules in files are found beside the task.
    let good = check(
        &ROOM
            .replace("\"reach b\"", "[\"a before b\", \"reach b\"]")
            .replace("[\"b\"]", "[\"a\", \"b\"]"),
    );
    assert_eq!(good.status.code(), Some(0), "{good:?}");

    for (from, to, expected) in [
        (
            "S.a",
            "..a",
            "room.toml:9:7: world.map: the grid has no start",
        ),
        (
            "#.b",
            "#.q",
            "room.toml:11:3: world.map[1][2]: the tile `q`",
        ),
        (
            "S.a",
            "S#a",
            "room.toml:10:3: world.map[0][2]: the tile `a` at row 1, column 3 cannot be reached",
        ),
        (
            "word = [\"b\"]",
            "word = [\"a\"]",
            "room.toml:4:3: examples[0]: this is acceptable and what is known",
        ),
        (
            "word = [\"b\"]",
            "word = [\"b\", \"c\"]",
            "room.toml:4:18: examples[0].word[1]: `c` is not a symbol",
        ),
        (
            "[world]",
            "colours = { c = \"red\" }\n[world]",
            "room.toml:6:17: colours.c: this colour has no symbol",
        ),
        (
            "[\"b.json\"]",
            "[\"b.json\", \"avoid b\"]",
            "room.toml:13:1: prior: the automata that hold exclude",
        ),
        (
            "b.json",
            "c.json",
            "room.toml:14:10: prior.holds[0]: c.json: cannot read it",
        ),
        (
            "steps = 9",
            "steps = 9\nstep = 1",
            "room.toml:9:8: world.step: `step` is an unknown key",
        ),
        ("kind = ", "kind ", "room.toml:7:6: this is not TOML"),
    ] {
        let bad = check(&ROOM.replacen(from, to, 1));
        assert_eq!(bad.status.code(), Some(2), "{to}: {bad:?}");
        let told = text(&bad.stderr);
        assert!(
            told.lines().any(|line| line.starts_with(expected)),
            "{to}: {told}"
        );
    }

    // For programs, and from `learn`.
    std::fs::write(folder.path().join("room.toml"), ROOM.replace("#.b", "#.q")).unwrap();
    let told = memrep(
        folder.path(),
        &["task", "check", "room.toml", "--format", "json"],
    );
    assert_eq!(told.status.code(), Some(2));
    let fault: Value = serde_json::from_str(text(&told.stdout).lines().next().unwrap()).unwrap();
    assert_eq!((&fault["line"], &fault["column"]), (&11.into(), &3.into()));
    let learn = memrep(folder.path(), &["learn", "--target", "room.toml"]);
    assert_eq!(learn.status.code(), Some(2));
    assert!(text(&learn.stderr).contains("room.toml:11:3:"), "{learn:?}");
    let missing = memrep(folder.path(), &["task", "check", "nowhere.toml"]);
    assert_eq!(missing.status.code(), Some(2));
    assert!(text(&missing.stderr).starts_with("nowhere.toml: cannot read it"));
}

/// Options on the command line override what the file tells.
#[test]
fn options_override_the_file() {
    let folder = tempfile::tempdir().unwrap();
    let content = ROOM
        .replace(
            "[prior]\nholds = [\"b.json\"]\n",
            "[costs]\nmembership = 2\ncomparison = inf\n",
        )
        .replace("symbols", "strategy = \"thesis\"\nsymbols");
    std::fs::write(folder.path().join("room.toml"), content).unwrap();
    let learn = |more: &[&str]| {
        let usual = ["learn", "--target", "room.toml", "--format", "json"];
        let output = memrep(folder.path(), &[&usual[..], more].concat());
        assert_eq!(output.status.code(), Some(0), "{output:?}");
        let last = text(&output.stdout).lines().last().unwrap().to_owned();
        serde_json::from_str::<Value>(&last).unwrap()
    };
    let told = learn(&[]);
    assert_eq!(told["strategy"], "thesis");
    assert_eq!(told["comparison"], 0);
    let asked = told["membership"].as_f64().unwrap();
    assert!(asked > 0.0);
    assert_eq!(told["cost"].as_f64(), Some(2.0 * asked));
    let other = learn(&[
        "--strategy",
        "bayes",
        "--comparison-cost",
        "1",
        "--membership-cost",
        "9",
    ]);
    assert_eq!(other["strategy"], "bayes");
    assert_eq!(other["membership"], 0);
    assert!(other["comparison"].as_f64().unwrap() > 0.0);
    // With two steps `b` is out of reach.
    let short = ["learn", "--target", "room.toml", "--steps", "1"];
    let short = memrep(folder.path(), &short);
    assert_eq!(short.status.code(), Some(2));
    assert!(
        text(&short.stderr).contains("cannot be reached"),
        "{short:?}"
    );
}
