//! Sessions in a world and beside what is known beforehand, over the API.

use automata::Word;
use axum::http::StatusCode;
use memrep::oracle::{
    Counterexamples, Order, ScriptedTeacher, SituatedTeacher, Target, TeacherSettings,
};
use memrep::task::Task;
use serde_json::{Value, json};

use crate::api::{answer, create, dfa, word};
use crate::site::Site;

const ROOM: [&str; 6] = [
    "....B...", //
    ".RR...Y.", "....S...", ".OO.B.R.", "....B..Y", "Y.......",
];

/// The robot's task in a room.
fn robot() -> Value {
    json!({
        "name": "robot-room",
        "symbols": [
            {"name": "R", "word": "lava", "colour": "#d55e00", "letter": "R"},
            {"name": "Y", "word": "recharge", "colour": "gold"},
            {"name": "B", "word": "water"},
            {"name": "O", "word": "dryer"},
        ],
        "world": {"kind": "grid", "map": ROOM, "steps": 30},
        "prior": {"holds": ["avoid R", "reach Y"]},
        "examples": [{"word": ["Y"], "label": true}],
        "costs": {"membership": 2},
    })
}

/// A walk goes from cell to neighbouring cell, and gives the word.
fn check_walk(shown: &Value, word: &Value) {
    let at = |value: &Value| usize::try_from(value.as_u64().unwrap()).unwrap();
    let cells: Vec<(usize, usize)> = (shown["walk"].as_array().unwrap().iter())
        .map(|cell| (at(&cell[0]), at(&cell[1])))
        .collect();
    let tile = |(row, column): (usize, usize)| char::from(ROOM[row].as_bytes()[column]);
    assert_eq!(tile(cells[0]), 'S');
    for pair in cells.windows(2) {
        let ((a, b), (c, d)) = (pair[0], pair[1]);
        assert_eq!(a.abs_diff(c) + b.abs_diff(d), 1, "{shown}");
    }
    let given = cells[1..].iter().map(|&cell| tile(cell));
    let given: Vec<String> = given
        .filter(|tile| !".S".contains(*tile))
        .map(String::from)
        .collect();
    assert_eq!(json!(given), *word, "{shown}");
}

/// Nothing is asked that is known or cannot be; a restart changes nothing; the export
/// is the target, and its part is what was learned.
#[tokio::test]
async fn a_task_is_taught_in_its_world_across_restarts() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.db");
    let mut site = Site::at(&path);
    let session = create(&site, json!({"task": robot()})).await;
    let state = site.get(&session).await.json();
    assert_eq!(state["setup"]["membership_cost"], 2.0);
    assert_eq!(state["task"]["symbols"][1]["colour"], "#ffd700");

    let task = Task::from_json(&robot()).unwrap();
    let situation = task.situation().unwrap().unwrap();
    let (world, prior) = (situation.world, situation.prior);
    let target = Target::named("robot").unwrap();
    let alphabet = task.alphabet().unwrap();
    let settings = TeacherSettings {
        order: Order::Random,
        counterexamples: Counterexamples::Shortest,
        error_rate: 0.0,
        seed: 5,
    };
    let open = prior.open().clone();
    let mut teacher = SituatedTeacher::new(world.clone(), open, &target, settings);
    let mut asked = 0;
    loop {
        let question = site.get(&format!("{session}/question")).await.json();
        if question["kind"] == "done" {
            break;
        }
        let words: Vec<&Value> = ["word", "first", "second"]
            .iter()
            .filter_map(|key| question.get(key))
            .collect();
        let shown = question["shown"].as_array().map_or(0, Vec::len);
        assert_eq!(shown, words.len(), "{question}");
        for (place, names) in words.iter().enumerate() {
            check_walk(&question["shown"][place], names);
            let word = word(&alphabet, names);
            assert_eq!(prior.settled(&word), None, "{question}");
        }
        if question["kind"] == "equivalence" {
            // What is shown is the whole.
            let (whole, learned) = (dfa(&question["hypothesis"]), dfa(&question["learned"]));
            let same = prior.whole(&learned).is_equivalent(&whole);
            assert_eq!(same, Ok(true));
        }
        let reply = answer(&mut teacher, &alphabet, &question);
        let reply = site.post(&format!("{session}/answers"), reply).await;
        assert_eq!(reply.status, StatusCode::OK, "{}", reply.text);
        asked += 1;
        assert!(asked < 300, "it does not end");
        if asked % 10 == 0 {
            site = Site::at(&path);
            let again = site.get(&format!("{session}/question")).await;
            assert_eq!(again.json(), reply.json());
        }
    }
    let export = async |query: &str| site.get(&format!("{session}/automaton{query}")).await;
    let whole = dfa(&export("").await.json());
    let wrong = whole.xor(target.dfa()).unwrap();
    assert_eq!(world.simplest(&wrong, 1), Vec::<Word>::new());
    let learned = dfa(&export("?part=learned").await.json());
    assert_eq!(learned.is_equivalent(&whole), Ok(false));
    assert_eq!(prior.whole(&learned).is_equivalent(&whole), Ok(true));
    let explicit = dfa(&export("?part=whole&format=json").await.json());
    assert_eq!(explicit.is_equivalent(&whole), Ok(true));
    let page = site.get(&session.replace("/api/v1", "")).await.text;
    assert!(page.contains("id=\"download-part\"") && page.contains("?part=learned"));
    let bad = export("?part=half").await;
    assert_eq!(bad.status, StatusCode::UNPROCESSABLE_ENTITY);
    assert_eq!(bad.json()["error"]["field"], "part");
}

/// A counterexample that cannot be, or that is settled, is refused and changes nothing.
#[tokio::test]
async fn impossible_counterexamples_are_refused() {
    let site = Site::in_memory();
    let session = create(&site, json!({"task": robot()})).await;
    let target = Target::named("robot").unwrap();
    let mut teacher = ScriptedTeacher::new(&target, TeacherSettings::default());
    let alphabet = target.dfa().alphabet().clone();
    let question = loop {
        let question = site.get(&format!("{session}/question")).await.json();
        if question["kind"] == "equivalence" {
            break question;
        }
        let reply = answer(&mut teacher, &alphabet, &question);
        site.post(&format!("{session}/answers"), reply).await;
    };
    let many = ["Y"; 40];
    for (word, label, code, field) in [
        (json!(many.as_slice()), false, "infeasible", "word"),
        (json!(["R", "Y"]), true, "settled_beforehand", "word"),
        (json!(["B"]), true, "settled_beforehand", "word"),
        (json!(["R", "Y"]), false, "no_counterexample", "label"),
    ] {
        let body = json!({
            "question": question["number"], "answer": "counterexample", "word": word, "label": label,
        });
        let reply = site.post(&format!("{session}/answers"), body).await;
        assert_eq!(reply.status, StatusCode::UNPROCESSABLE_ENTITY);
        let error = &reply.json()["error"];
        assert_eq!(
            (&error["code"], &error["field"]),
            (&json!(code), &json!(field))
        );
        assert!(error["message"].as_str().unwrap().len() > 40, "{error}");
    }
    let still = site.get(&format!("{session}/question")).await.json();
    assert_eq!(still, question);
}

/// The ready tasks with files are taught by name, in their worlds.
#[tokio::test]
async fn ready_tasks_have_their_worlds() {
    let site = Site::in_memory();
    for (name, kind) in [("robot-recharge", "grid"), ("deliver", "grid")] {
        let session = create(&site, json!({"task": name})).await;
        let state = site.get(&session).await.json();
        assert_eq!(state["task"]["world"]["kind"], kind);
        assert_eq!(state["task"].get("target"), None);
        let question = site.get(&format!("{session}/question")).await.json();
        assert_eq!(
            question.get("shown").is_some(),
            kind == "grid",
            "{question}"
        );
        let page = site.get(&session.replace("/api/v1", "")).await;
        assert_eq!(page.status, StatusCode::OK);
    }
}

/// A task that is at fault makes no session, and its place is named.
#[tokio::test]
async fn faulty_worlds_make_no_session() {
    let site = Site::in_memory();
    for (key, value, field) in [
        (
            "world",
            json!({"kind": "grid", "map": ["Y.."]}),
            "task.world.map",
        ),
        (
            "world",
            json!({"kind": "grid", "map": ["SY#B"]}),
            "task.world.map[0][3]",
        ),
        (
            "world",
            json!({"kind": "pool", "recordings": "a.jsonl"}),
            "task.world.recordings",
        ),
        ("colours", json!({"G": "green"}), "task.colours.G"),
        ("prior", json!({"holds": ["avoid Y"]}), "task.examples[0]"),
        (
            "prior",
            json!({"holds": ["avoid Y", "reach Y"]}),
            "task.prior",
        ),
        (
            "prior",
            json!({"holds": ["ry.json"]}),
            "task.prior.holds[0]",
        ),
        ("target", json!("robot"), "task.target"),
    ] {
        let mut task = robot();
        task[key] = value;
        let reply = site.post("/api/v1/sessions", json!({"task": task})).await;
        assert_eq!(reply.status, StatusCode::UNPROCESSABLE_ENTITY, "{field}");
        assert_eq!(reply.json()["error"]["field"], field, "{}", reply.text);
    }
    let listed = site.get("/api/v1/sessions").await.json();
    assert_eq!(listed["sessions"], json!([]));
}
