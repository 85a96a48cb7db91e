//! Uploads that are refused: the fault is told with its place, and nothing of them
//! stays.

use axum::http::StatusCode;
use serde_json::{Value, json};

use crate::parts::{BOUNDARY, GIF, PNG, Parts, SESSIONS, binary, line, post, rows};
use crate::site::Site;

/// Two recordings.
fn two() -> String {
    line("x", &["0"]) + &line("y", &["1"])
}

fn plain() -> Parts {
    Parts::default().task(&binary())
}

/// The task with something else in it.
fn with(key: &str, value: Value) -> Parts {
    let mut body = binary();
    body["task"][key] = value;
    Parts::default().task(&body)
}

/// A recording of `a.png` and another picture.
fn frames(second: &str) -> String {
    let media = json!({"kind": "frames", "paths": ["a.png", second]});
    json!({"id": "z", "word": [], "media": media}).to_string()
}

/// Each is refused at a field for a reason, and nothing stays.
async fn refuse(cases: Vec<(Parts, &str, &str)>) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.db");
    let site = Site::at(&path);
    for (parts, field, part) in cases {
        let reply = parts.send(&site, SESSIONS).await;
        let status = reply.status;
        assert_eq!(status, StatusCode::UNPROCESSABLE_ENTITY, "{}", reply.text);
        let error = &reply.json()["error"];
        assert_eq!(error["field"], field, "{part}: {error}");
        let message = error["message"].as_str().unwrap().to_lowercase();
        assert!(message.contains(&part.to_lowercase()), "{part}: {error}");
        assert_eq!(rows(&path), 0, "{part}");
    }
}

/// The line and the field, or what is missing.
#[tokio::test]
async fn faulty_recordings_are_named() {
    refuse(vec![
        (
            plain().recordings(&(two() + "\n{\"id\":")),
            "recordings",
            "line 4, column",
        ),
        (
            plain().recordings(&(two() + &line("x", &[]))),
            "recordings",
            "line 3, column 7, `id`: `x` is the name of line 1",
        ),
        (
            plain().recordings(&line("x", &["0", "1", "0", "2"])),
            "recordings",
            ", `word[3]`: expected a symbol",
        ),
        (
            plain().recordings("\n"),
            "recordings",
            "there is no recording",
        ),
        (
            plain().recordings(&frames("b.bmp")),
            "recordings",
            ", `media.paths[1]`: `b.bmp` is no picture",
        ),
        (
            plain().recordings(&frames("../b.png")),
            "recordings",
            "no path within the upload",
        ),
        (
            plain()
                .recordings(&(two() + &frames("b.png")))
                .media("a.png", PNG)
                .media("deep/b.png", PNG),
            "recordings",
            "line 3, `media.paths[1]`: `b.png` was not sent, and `deep/b.png` was",
        ),
        (
            plain().media("a.png", PNG),
            "recordings",
            "without recordings",
        ),
        (
            plain().recordings(&two()).recordings(&two()),
            "recordings",
            "two files of recordings",
        ),
        (plain(), "recordings", "there are no recordings"),
    ])
    .await;
}

/// The file, and what is wrong with it.
#[tokio::test]
async fn faulty_media_are_named() {
    refuse(vec![
        (
            plain()
                .recordings(&frames("b.png"))
                .media("a.png", PNG)
                .media("b.png", PNG)
                .media("c.png", PNG),
            "media",
            "`c.png` is named by no recording",
        ),
        (
            plain()
                .recordings(&frames("b.png"))
                .media("a.png", PNG)
                .media("b.png", GIF),
            "media",
            "`b.png` is called .png and its content is `image/gif`",
        ),
        (
            plain().media("a.png", b"not at all").recordings(&two()),
            "media",
            "its content is something else",
        ),
        (
            plain().media("a.svg", b"<svg>"),
            "media",
            "no picture or film",
        ),
        (
            plain().media("a.png", PNG).media("a.png", PNG),
            "media",
            "`a.png` came twice",
        ),
        (plain().part("media", None, PNG), "media", "without a name"),
    ])
    .await;
}

/// The path in the task, also where only the recordings show the fault.
#[tokio::test]
async fn faulty_tasks_are_named() {
    refuse(vec![
        (
            Parts::default().recordings(&two()).task(&binary()),
            "task",
            "send the task first",
        ),
        (
            Parts::default()
                .text("task", "{\"task\":")
                .recordings(&two()),
            "task",
            "not JSON",
        ),
        (
            Parts::default()
                .text("task", "symbols = [\"0\"]\nname = \n")
                .recordings(&two()),
            "task",
            "line 2: this is not TOML",
        ),
        (
            Parts::default()
                .task(&json!({"task": "tomita:1"}))
                .recordings(&two()),
            "task",
            "a ready task",
        ),
        (
            with("symbols", json!(["0", "0"])).recordings(&two()),
            "task.symbols[1]",
            "twice",
        ),
        (
            with("world", json!({"kind": "words"})).recordings(&two()),
            "task.world.kind",
            "give `pool`",
        ),
        (
            with("world", json!({"kind": "pool", "upload": "a"})).recordings(&two()),
            "task.world.upload",
            "leave this out",
        ),
        (
            with(
                "examples",
                json!([{"word": ["0"], "label": true}, {"word": ["0", "0"], "label": true}]),
            )
            .recordings(&two()),
            "task.examples[1]",
            "no recording shows this",
        ),
        (
            with(
                "practice",
                json!({"word": ["0", "0"], "answer": "accept", "why": "because"}),
            )
            .recordings(&two()),
            "task.practice.word",
            "no recording shows this",
        ),
        (
            with(
                "prior",
                json!({"suffices": ["reach 0"], "holds": ["reach 0"]}),
            )
            .recordings(&two()),
            "task.prior",
            "nothing to learn",
        ),
        (
            with(
                "prior",
                json!({"holds": ["avoid 0"], "suffices": ["reach 1"]}),
            )
            .recordings(&two()),
            "task.prior",
            "nothing to learn",
        ),
        (plain().text("colour", "red"), "colour", "no part `colour`"),
        (plain().text("task", "{}"), "task", "several parts `task`"),
    ])
    .await;
}

/// What is no whole form, and worlds that nobody sent.
#[tokio::test]
async fn broken_forms_and_unknown_uploads_leave_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.db");
    let site = Site::at(&path);
    // Without its end.
    let mut body = plain().recordings(&two()).end();
    body.truncate(body.len() - BOUNDARY.len() - 20);
    let reply = post(&site, SESSIONS, body).await;
    assert_eq!(reply.status, StatusCode::BAD_REQUEST, "{}", reply.text);
    let reply = site
        .post_text(SESSIONS, "multipart/form-data", "nothing")
        .await;
    assert_eq!(reply.status, StatusCode::BAD_REQUEST, "{}", reply.text);
    for (world, field) in [
        (json!({"kind": "pool"}), "task.world.recordings"),
        (
            json!({"kind": "pool", "upload": "0123456789abcdef0123456789abcdef"}),
            "task.world.upload",
        ),
        (
            json!({"kind": "pool", "upload": "nobody's"}),
            "task.world.upload",
        ),
    ] {
        let task = json!({"symbols": ["0", "1"], "world": world});
        let reply = site.post(SESSIONS, json!({"task": task})).await;
        assert_eq!(
            reply.status,
            StatusCode::UNPROCESSABLE_ENTITY,
            "{}",
            reply.text
        );
        assert_eq!(reply.json()["error"]["field"], field, "{}", reply.text);
    }
    assert_eq!(rows(&path), 0);
}

/// An upload that is there, with a task that does not fit it.
#[tokio::test]
async fn a_task_that_does_not_fit_an_upload_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.db");
    let site = Site::at(&path);
    let reply = plain()
        .recordings(&two())
        .send(&site, SESSIONS)
        .await
        .json();
    let before = rows(&path);
    let world = json!({"kind": "pool", "upload": reply["upload"]});
    for (task, field, part) in [
        (
            json!({"symbols": ["0"], "world": world}),
            "task.world.upload",
            ", `word[0]`",
        ),
        (
            json!({"symbols": ["0", "1"], "world": world, "examples": [{"word": [], "label": true}]}),
            "task.examples[0]",
            "No recording shows this",
        ),
    ] {
        let reply = site.post(SESSIONS, json!({"task": task})).await;
        assert_eq!(
            reply.status,
            StatusCode::UNPROCESSABLE_ENTITY,
            "{}",
            reply.text
        );
        let error = &reply.json()["error"];
        assert_eq!(error["field"], field, "{error}");
        assert!(error["message"].as_str().unwrap().contains(part), "{error}");
    }
    assert_eq!(rows(&path), before);
}
