//! Tasks are read as they are written, and every fault is named.

use serde_json::json;

use automata::Word;

use super::*;

#[test]
fn a_task_survives_its_log() {
    let task = Task::from_json(&json!({
        "title": "Tea",
        "symbols": ["a", {"name": "b", "word": "water"}],
        "examples": [{"word": [], "label": false}, {"word": ["b", "a"], "label": true}],
        "max_states": 7,
        "guidelines": "first water,\nthen tea",
    }))
    .unwrap();
    let again: Task = serde_json::from_value(serde_json::to_value(&task).unwrap()).unwrap();
    assert_eq!(task, again);
    assert_eq!(task.text(Symbol::new(1)), "water");
    assert_eq!(task.known::<Word>(&task.universe().unwrap()).len(), 2);
}

#[test]
fn every_fault_is_named_with_its_path() {
    let cases = [
        (json!([]), "", "object"),
        (json!({}), "symbols", "give the names"),
        (json!({"symbols": []}), "symbols", "empty"),
        (json!({"symbols": "ab"}), "symbols", "array"),
        (json!({"symbols": ["a", "a"]}), "symbols[1]", "twice"),
        (json!({"symbols": ["a", "b c"]}), "symbols[1]", "`b c`"),
        (json!({"symbols": ["a", 3]}), "symbols[1]", "as its name"),
        (
            json!({"symbols": [{"name": "a", "color": 1}]}),
            "symbols[0].color",
            "unknown",
        ),
        (
            json!({"symbols": [{"word": "a"}]}),
            "symbols[0]",
            "no `name`",
        ),
        (
            json!({"symbols": ["a"], "sybmols": 1}),
            "sybmols",
            "unknown",
        ),
        (
            json!({"symbols": ["a"], "target": "tomita:1"}),
            "target",
            "leave `target` out",
        ),
        (
            json!({"symbols": ["a"], "max_states": 0}),
            "max_states",
            "between 1 and 100",
        ),
        (
            json!({"symbols": ["a"], "max_states": 2.5}),
            "max_states",
            "whole number",
        ),
        (
            json!({"symbols": ["a"], "title": "x\u{202e}y"}),
            "title",
            "control",
        ),
        (
            json!({"symbols": ["a"], "examples": [{"word": ["b"], "label": true}]}),
            "examples[0].word[0]",
            "`b` is not a symbol",
        ),
        (
            json!({"symbols": ["a"], "examples": [{"word": ["a"]}]}),
            "examples[0].label",
            "true",
        ),
        (
            json!({"symbols": ["a"], "examples": [{"label": true}]}),
            "examples[0]",
            "no `word`",
        ),
        (
            json!({"symbols": ["a"], "examples": [{"word": ["a"], "label": true}, {"word": ["a"], "label": false}]}),
            "examples[1]",
            "examples[0]",
        ),
    ];
    for (input, path, part) in cases {
        let error = Task::from_json(&input).unwrap_err();
        assert_eq!(error.path, path, "{input}: {error}");
        assert!(error.message.contains(part), "{input}: {error}");
    }
}

/// A request's task in a room with a tile each of `a` and `b`.
fn room(more: &Value) -> Value {
    let mut task = json!({
        "symbols": [{"name": "apple", "letter": "a"}, "b"],
        "world": {"kind": "grid", "map": "S.a\n..b", "steps": 5},
    });
    for (key, value) in more.as_object().unwrap() {
        task[key] = value.clone();
    }
    task
}

#[test]
fn a_world_and_a_prior_survive_the_log() {
    let task = Task::from_json(&room(&json!({
        "colours": {"apple": "Red", "b": "#00FF00"},
        "prior": {"holds": ["avoid b", {"start": 0, "accepting": [0, 1], "delta": [[1, 0], [1, 1]]}]},
        "examples": [{"word": ["apple"], "label": true}],
        "costs": {"comparison": "inf"},
        "strategy": "thesis",
        "practice": {"word": ["apple"], "answer": "accept", "why": "It is red."},
    })))
    .unwrap();
    let text = serde_json::to_string(&task).unwrap();
    let again: Task = serde_json::from_str(&text).unwrap();
    assert_eq!(task, again);
    assert_eq!(task.symbols[0].colour.as_ref().unwrap().hex(), "#ff0000");
    assert_eq!(task.costs.comparison, Some(f64::INFINITY));
    let situation = task.situation().unwrap().unwrap();
    let alphabet = task.alphabet().unwrap();
    assert!(
        situation
            .world
            .is_feasible(&alphabet.word(["apple", "b"]).unwrap())
    );
    assert!(
        !situation
            .world
            .is_feasible(&alphabet.word(["b"; 7]).unwrap())
    );
    let settled = situation.prior.settled(&alphabet.word(["b"]).unwrap());
    assert_eq!(settled, Some(false));
}

#[test]
fn a_task_without_a_world_is_written_as_before() {
    let task = Task::from_json(&json!({"symbols": ["a"]})).unwrap();
    assert_eq!(
        serde_json::to_value(&task).unwrap(),
        json!({
            "name": "own", "title": "My own rule", "symbols": [{"name": "a"}],
            "examples": [], "max_states": 24, "guidelines": "", "empty": "nothing happens",
        })
    );
    assert!(task.situation().unwrap().is_none());
}

/// Every case is what a task has more, the path of its fault, and a part of what is
/// said.
fn check_faults(cases: &[(Value, &str, &str)]) {
    for (more, path, part) in cases {
        let error = Task::from_json(&room(more)).unwrap_err();
        assert_eq!(error.path, *path, "{more}: {error}");
        assert!(error.message.contains(part), "{more}: {error}");
    }
}

#[test]
fn faults_of_worlds_are_named() {
    let grid = |map: &str| json!({"world": {"kind": "grid", "map": map, "steps": 5}});
    check_faults(&[
        (grid("..a\n..b"), "world.map", "no start"),
        (grid("S.a\n.qb"), "world.map[1][1]", "`q`"),
        (
            grid("S.a\n#.#\n.#b"),
            "world.map[2][2]",
            "cannot be reached",
        ),
        (grid("S.a\n..bb"), "world.map[1]", "4 cells"),
        (
            json!({"world": {"kind": "grid"}}),
            "world.map",
            "draw the grid",
        ),
        (
            json!({"world": {"kind": "grid", "map": "Sab", "steps": 0}}),
            "world.steps",
            "between",
        ),
        (json!({"world": {"kind": "torus"}}), "world.kind", "`torus`"),
        (
            json!({"world": {"kind": "pool", "recordings": "/etc/passwd"}}),
            "world.recordings",
            "reads no files",
        ),
        (
            json!({"colours": {"c": "red"}}),
            "colours.c",
            "has no symbol",
        ),
        (
            json!({"colours": {"b": "reddish"}}),
            "colours.b",
            "no colour",
        ),
        (
            json!({"symbols": [{"name": "apple", "letter": "b"}, {"name": "b"}]}),
            "symbols[1]",
            "stands for two things",
        ),
        (
            json!({"symbols": [{"name": "apple", "letter": "ab"}, "b"]}),
            "symbols[0].letter",
            "one character",
        ),
    ]);
}

#[test]
fn faults_of_priors_and_examples_are_named() {
    let example = |word: &[&str], label: bool| json!({"word": word, "label": label});
    check_faults(&[
        (
            json!({"prior": {"holds": ["avoid c"]}}),
            "prior.holds[0]",
            "`c` is not a symbol",
        ),
        (
            json!({"prior": {"holds": ["b.json"]}}),
            "prior.holds[0]",
            "`avoid X`",
        ),
        (
            json!({"prior": {"holds": ["avoid b", "reach b"]}}),
            "prior",
            "exclude each other",
        ),
        (
            json!({"prior": {"holds": ["avoid b", "avoid apple"]}, "examples": [example(&["b"], true)]}),
            "examples[0]",
            "says the opposite",
        ),
        (
            json!({"world": {"kind": "grid", "map": "Sa.", "steps": 5}, "prior": {"holds": ["reach b"]}}),
            "prior",
            "nothing to learn",
        ),
        (
            json!({"examples": [example(&["b"; 9], false)]}),
            "examples[0]",
            "cannot happen",
        ),
        (
            json!({"practice": {"word": ["b"], "answer": "first", "why": "so"}}),
            "practice.answer",
            "accept, reject",
        ),
        (
            json!({"practice": {"word": ["b"], "answer": "accept"}}),
            "practice.why",
            "why",
        ),
        (
            json!({"practice": {"first": ["b"], "answer": "first"}}),
            "practice",
            "either",
        ),
        (
            json!({"costs": {"membership": 0}}),
            "costs.membership",
            "greater than 0",
        ),
        (json!({"strategy": "psychic"}), "strategy", "unknown"),
    ]);
}

#[test]
fn the_template_is_a_task() {
    let file = TaskFile::from_toml(TEMPLATE, std::path::Path::new("")).unwrap();
    assert!(file.target.is_some());
    assert!(file.task.practice.is_some());
    assert!(file.universe.situation().is_some());
}

/// All faults are told, in their order in the file.
#[test]
fn a_file_is_told_all_its_faults() {
    let text = TEMPLATE
        .replace("\"#d55e00\"", "\"#d55e0\"")
        .replace("..P..C", "..P.?C")
        .replace("membership = 4 ", "membership = -4")
        .replace("label = false", "label = 0");
    let faults = TaskFile::from_toml(&text, std::path::Path::new("")).unwrap_err();
    let places: Vec<(&str, usize, usize)> = (faults.iter())
        .map(|fault| {
            (
                fault.path.as_str(),
                fault.line.unwrap(),
                fault.column.unwrap(),
            )
        })
        .collect();
    let line = |part: &str| text.lines().position(|line| line.contains(part)).unwrap() + 1;
    assert_eq!(
        places,
        [
            ("costs.membership", line("membership = -4"), 14),
            ("symbols[0].colour", line("\"#d55e0\""), 10),
            ("world.map[1][4]", line("..P.?C"), 5),
            ("examples[1].label", line("label = 0"), 9),
        ]
    );
    // A letter that is none is one fault, and not another one in the map.
    let text = TEMPLATE.replace("letter = \"K\"", "letter = \"Kettle\"");
    let faults = TaskFile::from_toml(&text, std::path::Path::new("")).unwrap_err();
    assert_eq!(faults.len(), 1, "{faults:?}");
}

#[test]
fn a_target_says_what_examples_and_prior_say() {
    for (instead, part) in [
        ("[\"kettle before cup\"]", "says the opposite"),
        ("\"avoid kettle\"", "rejects the example [kettle, cup]"),
        ("\"tomita:4\"", "the automaton is over"),
        ("\"nonsense\"", "`avoid X`"),
        ("\"nonsense.json\"", "cannot read it"),
        ("[]", "empty"),
        (
            "{ start = 0, accepting = [0], delta = [[0, 0]] }",
            "no automaton",
        ),
    ] {
        let target =
            "target = [\"kettle before cup\", \"never puddle after kettle\", \"reach cup\"]";
        assert!(TEMPLATE.contains(target));
        let text = TEMPLATE.replace(target, &format!("target = {instead}"));
        let faults = TaskFile::from_toml(&text, std::path::Path::new("")).unwrap_err();
        assert_eq!(faults.len(), 1, "{faults:?}");
        assert!(faults[0].path.starts_with("target"), "{faults:?}");
        assert!(faults[0].message.contains(part), "{faults:?}");
    }
}

/// A log keeps its task, whatever is refused since.
#[test]
fn what_was_taken_once_is_read_from_its_log() {
    let content = json!({
        "symbols": ["a"],
        "examples": [{"word": ["a"], "label": true}],
        "practice": {"word": ["a"], "answer": "reject", "why": "So it was."},
    });
    let refused = Task::from_json(&content).unwrap_err();
    assert_eq!(refused.path, "practice.answer");
    let task: Task = serde_json::from_value(content).unwrap();
    let kept = serde_json::to_value(&task).unwrap();
    assert_eq!(serde_json::from_value::<Task>(kept).unwrap(), task);
}
