//! The studio as a browser without script uses it: fields are typed, buttons pressed.

use axum::http::StatusCode;
use memrep::task::{Task, TaskFile};
use serde_json::json;

use crate::desk::{Desk, unescaped};
use crate::parts::{Parts, line};
use crate::site::Site;

const ROBOT: &str = include_str!("../../examples/tasks/robot-recharge.toml");

fn task(text: &str) -> Task {
    let mut content = Task::toml_content(text).unwrap_or_else(|e| panic!("{e:?}: {text}"));
    content.as_object_mut().unwrap().remove("target");
    Task::from_json(&content).unwrap_or_else(|e| panic!("{e}: {text}"))
}

#[tokio::test]
async fn the_robot_task_is_built_from_nothing() {
    let site = Site::in_memory();
    let start = site.get("/").await;
    assert!(
        start.text.contains("href=\"/studio\""),
        "the start page leads there"
    );
    let robot = TaskFile::sent(ROBOT).unwrap().task;
    let mut desk = Desk::open(&site, "/studio").await;
    desk.fill("title", &robot.title);
    desk.fill("name", &robot.name);
    desk.fill("empty", &robot.empty);
    desk.fill("guidelines", &robot.guidelines);
    for _ in 0..3 {
        desk.then(&site, "add symbols").await;
    }
    // One too many, and not the last.
    desk.fill("symbols[2].word", "a mistake");
    for (i, symbol) in robot.symbols.iter().enumerate() {
        let place = if i < 2 { i } else { i + 1 };
        desk.fill(&format!("symbols[{place}].name"), &symbol.name);
        desk.fill(
            &format!("symbols[{place}].word"),
            symbol.word.as_ref().unwrap(),
        );
        desk.fill(
            &format!("symbols[{place}].letter"),
            &symbol.letter.unwrap().to_string(),
        );
        desk.fill(
            &format!("symbols[{place}].colour"),
            symbol.colour.as_ref().unwrap().hex(),
        );
    }
    desk.then(&site, "remove symbols[2]").await;
    assert_eq!(desk.at("symbols[2].word"), "water");
    assert_eq!(desk.at("title"), robot.title, "nothing typed is lost");

    desk.fill("world.kind", "grid");
    desk.then(&site, "show").await;
    desk.fill(
        "world.map",
        "....B...\n.R..BB..\n.RR...Y.\n....S...\n.O....R.\n.OO.B.R.",
    );
    desk.fill("map-rows", "8");
    desk.then(&site, "resize").await;
    let map = desk.at("world.map").to_owned();
    assert!(
        map.starts_with("....B...\n") && map.ends_with(".OO.B.R.\n........\n........"),
        "{map}"
    );
    desk.fill(
        "world.map",
        &map.replace("\n........\n........", "\n....B..Y\nY......."),
    );
    desk.fill("world.steps", "40");
    for (form, x) in [("avoid", "R"), ("reach", "Y")] {
        desk.fill("prior.holds.form", form);
        desk.fill("prior.holds.x", x);
        desk.then(&site, "rule prior.holds").await;
    }
    for (place, word) in ["Y", "YY", "O, Y"].into_iter().enumerate() {
        desk.then(&site, "add examples").await;
        desk.fill(&format!("examples[{place}].atom"), word);
        desk.fill(&format!("examples[{place}].label"), "true");
    }
    desk.fill("costs.membership", "4");
    desk.fill("costs.comparison", "1");
    desk.fill("practice.kind", "comparison");
    desk.fill("practice.first", "Y");
    desk.fill("practice.second", "B Y");
    desk.fill("practice.answer", "first");
    desk.fill("practice.why", &robot.practice.as_ref().unwrap().why);

    desk.then(&site, "check").await;
    assert_eq!(desk.page.status, StatusCode::OK, "{}", desk.page.text);
    assert!(desk.page.text.contains("This task can be taught"));
    assert!(
        desk.page.text.contains("<svg class=\"scene\""),
        "the preview shows the grid"
    );
    let saved = desk.press(&site, "save").await;
    assert_eq!(
        saved.header("content-disposition"),
        "attachment; filename=\"robot-recharge.toml\""
    );
    assert_eq!(task(&saved.text), robot);

    let session = desk.press(&site, "begin").await.location();
    let page = site.get(&session).await;
    assert!(["comparison", "membership"].contains(&page.main("data-kind").as_str()));
    let state = site.get(&format!("/api/v1{session}")).await.json();
    assert_eq!(state["task"]["world"]["map"].as_array().unwrap().len(), 8);
}

#[tokio::test]
async fn every_task_file_is_opened_and_saved_as_the_same_task() {
    let site = Site::in_memory();
    let finite = "[class]\nkind = \"finite\"\ntable = \"\"\"\nbehaviour,polite,loud\n\"waits, then \"\"nods\"\"\",1,0\nhonks,0,1\n\"\"\"\n[[examples]]\nitem = \"honks\"\nlabel = false\n";
    let linear = "[class]\nkind = \"linear\"\nfeatures = [\"speed\", \"near, or far\"]\nbehaviours = [{ name = \"creeps\", features = [[0.25, 0.0], [0.2, 0.1]] }, { name = \"rushes\", features = [[0.9, 0.7]] }]\n";
    let rules = "symbols = [\"a\", \"bc\"]\ntarget = [\"reach a\"]\nmax_states = 7\nstrategy = \"exp4+\"\n[costs]\ncomparison = inf\n[world]\nkind = \"words\"\nlongest = 9\n[prior]\nsuffices = [{ start = 0, accepting = [1], delta = [[1, 0], [1, 1]] }]\n[colours]\nbc = \"gold\"\n[practice]\nword = []\nanswer = \"reject\"\nwhy = \"one\\n\\ntwo\"\n";
    let mut texts = vec![finite.to_owned(), linear.to_owned(), rules.to_owned()];
    for file in std::fs::read_dir("examples/tasks").unwrap() {
        texts.push(std::fs::read_to_string(file.unwrap().path()).unwrap());
    }
    for text in &texts {
        // One that names other files can be saved only where they are.
        if TaskFile::sent(text).is_err() {
            continue;
        }
        let parts = Parts::default().part("file", Some("t.toml"), text.as_bytes());
        let desk = Desk::of(parts.text("do", "open").send(&site, "/studio").await);
        assert_eq!(desk.page.status, StatusCode::OK, "{}", desk.page.text);
        let saved = desk.press(&site, "save").await;
        assert_eq!(task(&saved.text), task(text), "{}", saved.text);
        // Its target too.
        let (was, is) = (
            TaskFile::sent(text).unwrap(),
            TaskFile::sent(&saved.text).unwrap(),
        );
        assert_eq!(was.target, is.target);
        assert_eq!(was.max_states, is.max_states);
    }
    // A ready task is opened by its name.
    let desk = Desk::open(&site, "/studio?task=robot-recharge").await;
    assert_eq!(task(&desk.press(&site, "save").await.text), task(ROBOT));
}

/// More than a title may have: 160 characters.
const LONG: &str = "one and another and one more, and so on and so on and on and on, and one and another and one more, and so on and so on and on and on, and still no end in sight.";

/// What is typed into which field of the robot's task, at which field that is told, and
/// how.
const FAULTS: &[(&str, &str, &str, &str)] = &[
    ("title", LONG, "title", "at most 120"),
    (
        "symbols[1].colour",
        "mud",
        "symbols-1-colour",
        "`mud` is no colour",
    ),
    (
        "symbols[1].letter",
        "Yes",
        "symbols-1-letter",
        "more than a letter",
    ),
    ("symbols[3].name", "R", "symbols-3-name", "twice"),
    (
        "symbols[3].name",
        "a b",
        "symbols-3-name",
        "letters, digits",
    ),
    ("world.map", "..\n..", "world-map", "no start"),
    ("world.map", "SYRBO\nY..?.", "world-map", "`?`"),
    (
        "world.steps",
        "many",
        "world-steps",
        "a whole number between 1 and 1000",
    ),
    (
        "prior.holds[1].rule",
        "reach Q",
        "prior-holds-1-rule",
        "`Q` is not a symbol",
    ),
    (
        "examples[1].atom",
        "Y Q",
        "examples-1-atom",
        "`Q` is not a symbol",
    ),
    ("examples[2].label", "", "examples-2-label", "acceptable"),
    (
        "costs.membership",
        "-1",
        "costs-membership",
        "greater than 0",
    ),
    ("max_states", "0", "max_states", "between 1 and 100"),
    (
        "practice.answer",
        "second",
        "practice-answer",
        "examples[0] says",
    ),
    ("practice.why", "", "practice-why", "say in a sentence"),
    ("target", "reach Q", "target", "`Q` is not a symbol"),
];

#[tokio::test]
async fn all_faults_are_told_at_their_fields_and_nothing_is_lost() {
    let site = Site::in_memory();
    let base = || async {
        let desk = Desk::of(
            Parts::default()
                .text("text", ROBOT)
                .text("do", "open")
                .send(&site, "/studio")
                .await,
        );
        assert_eq!(desk.page.status, StatusCode::OK);
        desk
    };
    for (field, typed, at, part) in FAULTS.iter().copied() {
        let mut desk = base().await;
        desk.fill(field, typed);
        desk.then(&site, "check").await;
        assert_eq!(
            desk.page.status,
            StatusCode::UNPROCESSABLE_ENTITY,
            "{field}"
        );
        let told = desk
            .fault(at)
            .unwrap_or_else(|| panic!("{at}: {}", desk.page.text));
        assert!(
            told.to_lowercase().contains(&part.to_lowercase()),
            "{field}: {told}"
        );
        assert!(
            desk.page.text.contains(&format!("href=\"#{at}\"")),
            "the summary leads to {at}"
        );
        assert_eq!(desk.at(field), typed);
        assert_eq!(desk.at("practice.second"), "B Y");
        // It is not begun, and not saved but on demand.
        assert_eq!(
            desk.press(&site, "begin").await.status,
            StatusCode::UNPROCESSABLE_ENTITY
        );
        let refused = desk.press(&site, "save").await;
        assert!(refused.text.contains("Save it as it is"));
        assert!(
            desk.press(&site, "save-draft")
                .await
                .header("content-disposition")
                .contains("attachment")
        );
    }
    // Several at once.
    let mut desk = base().await;
    desk.fill("title", LONG);
    desk.fill("max_states", "0");
    desk.fill("prior.holds[0].rule", "shun R");
    desk.then(&site, "check").await;
    for at in ["title", "max_states", "prior-holds-0-rule"] {
        assert!(desk.fault(at).is_some(), "{at}");
    }
    assert_eq!(
        site.get("/api/v1/sessions").await.json()["sessions"],
        json!([])
    );
}

#[tokio::test]
async fn hostile_names_stay_text() {
    let site = Site::in_memory();
    let evil = "\"><script>alert(1)</script></textarea><b x='";
    let mut desk = Desk::open(&site, "/studio").await;
    for field in [
        "title",
        "guidelines",
        "symbols[0].name",
        "symbols[0].word",
        "symbols[1].colour",
        "world.map",
        "target",
        "class.table",
    ] {
        desk.fill(field, evil);
    }
    desk.fill("symbols[1].name", "b");
    desk.fill("world.kind", evil);
    for button in ["check", "add symbols"] {
        let again = Desk::of(desk.press(&site, button).await);
        assert!(
            !again.page.text.contains("<script>alert"),
            "{}",
            again.page.text
        );
        assert_eq!(again.at("symbols[0].word"), evil);
        assert_eq!(again.at("world.kind"), evil);
        assert_eq!(again.at("world.map"), evil);
    }
    desk.fill("symbols[0].name", "a");
    desk.fill("symbols[1].colour", "");
    desk.fill("world.kind", "words");
    desk.fill("target", "");
    desk.fill("title", evil);
    let saved = desk.press(&site, "save").await;
    assert_eq!(task(&saved.text).title, evil);
    let page = site.get(&desk.press(&site, "begin").await.location()).await;
    assert!(!page.text.contains("<script>alert"));
    // Rows that are far away, and fields that nobody knows, do no harm.
    let far = Parts::default()
        .text("symbols[18446744073709551615].name", "a")
        .text("symbols[x].name", "b");
    let far = far
        .text("do", "remove symbols[99]")
        .text("unknown[0].x", "c");
    let desk = Desk::of(far.send(&site, "/studio").await);
    assert_eq!(desk.at("symbols[0].name"), "a");
}

#[tokio::test]
async fn recordings_come_in_the_last_step() {
    let site = Site::in_memory();
    let mut desk = Desk::open(&site, "/studio").await;
    desk.fill("symbols[0].name", "a");
    desk.fill("symbols[1].name", "b");
    desk.fill("title", "My runs");
    desk.fill("world.kind", "pool");
    let saved = desk.press(&site, "save").await;
    assert!(
        saved.text.contains("recordings = \"recordings.jsonl\""),
        "{}",
        saved.text
    );
    let page = desk.press(&site, "begin").await;
    assert_eq!(page.main("data-kind"), "recordings");
    let text = page.text.split("name=\"file\" hidden>\n").nth(1).unwrap();
    let text = unescaped(text.split("</textarea>").next().unwrap());
    let send = async |lines: &str| {
        let parts = Parts::default().text("file", &text);
        let parts = match lines {
            "" => parts.part("recordings", Some(""), b""),
            lines => parts.recordings(lines),
        };
        parts.send(&site, "/studio/recordings").await
    };
    for (lines, told) in [
        ("", "Choose the file of the recordings"),
        ("broken\n", "Line 1, column 1: expected an object"),
    ] {
        let reply = send(lines).await;
        assert_eq!(reply.status, StatusCode::UNPROCESSABLE_ENTITY);
        assert_eq!(reply.main("data-kind"), "recordings");
        let fault = reply.text.split("id=\"recordings-fault\"").nth(1).unwrap();
        assert!(fault.contains(told), "{fault}");
        assert!(reply.text.contains("My runs"), "the task is still there");
    }
    let runs = [line("x", &["a"]), line("y", &["b"]), line("z", &["a", "b"])].concat();
    let session = send(&runs).await.location();
    let state = site.get(&format!("/api/v1{session}")).await.json();
    assert_eq!(state["task"]["title"], "My runs");
    assert_eq!(state["task"]["world"]["kind"], "pool");
}

#[tokio::test]
async fn a_faulty_file_is_told_all_its_faults_and_mended_in_the_studio() {
    let site = Site::in_memory();
    let text = "title = \"Tea\"\nmax_states = 0\nsymbols = [\"a\", \"b\"]\n[prior]\nholds = [\"avoid c\"]\n";
    let parts = Parts::default().part("file", Some("t.toml"), text.as_bytes());
    let reply = parts.send(&site, "/sessions").await;
    assert_eq!(reply.status, StatusCode::UNPROCESSABLE_ENTITY);
    for told in ["Line 2, column 14", "Line 5, column 10"] {
        assert!(reply.text.contains(told), "{told}: {}", reply.text);
    }
    assert!(reply.text.contains("Open it in the studio"));
    let mut desk = Desk::of(
        Parts::default()
            .text("text", text)
            .text("do", "open")
            .send(&site, "/studio")
            .await,
    );
    assert!(
        desk.fault("max_states")
            .unwrap()
            .starts_with("Line 2, column 14")
    );
    assert!(desk.fault("prior-holds-0-rule").is_some());
    desk.fill("max_states", "5");
    desk.fill("prior.holds[0].rule", "avoid b");
    let state = desk.press(&site, "begin").await.location();
    assert!(state.starts_with("/sessions/"));
    // What is no task file at all leaves the form as it is.
    let mut desk = Desk::open(&site, "/studio?task=car").await;
    desk.fields
        .push(("text".to_owned(), "symbols = [".to_owned()));
    desk.then(&site, "open").await;
    assert_eq!(desk.page.status, StatusCode::UNPROCESSABLE_ENTITY);
    assert!(desk.fault("file").unwrap().contains("Line 1, column"));
    assert_eq!(desk.at("class.axes[1].name"), "distance");
}
