//! Recordings that come with a session: taught by what they show, served as they
//! came.

use std::path::Path;
use std::sync::Arc;

use axum::body::Body;
use axum::http::{Request, StatusCode};
use memrep::concept::Prior;
use memrep::oracle::{SituatedTeacher, Target, TeacherSettings};
use memrep::world::World;
use memrep::world::pool::PoolReader;
use serde_json::{Value, json};

use crate::api::{answer, create, dfa};
use crate::parts::{GIF, PNG, Parts, SESSIONS, all_words, binary, film, line};
use crate::site::Site;

/// Answers all questions; what the last reply was.
async fn teach(site: &mut Site, path: &Path, session: &str, target: &str, lines: &str) -> Value {
    let target = Target::named(target).unwrap();
    let alphabet = target.dfa().alphabet().clone();
    let pool = PoolReader::read(alphabet.clone(), lines.as_bytes()).unwrap();
    let recorded: Vec<Vec<String>> = (pool.recordings().iter())
        .map(|recording| alphabet.spell(&recording.word).map(str::to_owned).collect())
        .collect();
    let open = Prior::none(&alphabet).open().clone();
    let world = Arc::new(World::Pool(pool));
    let mut teacher = SituatedTeacher::new(world, open, &target, TeacherSettings::default());
    let mut question = site.get(&format!("{session}/question")).await.json();
    for asked in 0..200 {
        if question["kind"] == "done" {
            return question;
        }
        if question["kind"] != "equivalence" {
            let words = ["word", "first", "second"].map(|key| question.get(key).cloned());
            let words: Vec<Value> = words.into_iter().flatten().collect();
            let shown = question["shown"].as_array().unwrap();
            assert_eq!(shown.len(), words.len());
            for (word, shown) in words.iter().zip(shown) {
                let number: usize = shown["recording"].as_str().unwrap()[4..].parse().unwrap();
                assert_eq!(json!(recorded[number]), *word);
            }
        }
        let said = answer(&mut teacher, &alphabet, &question);
        let reply = site.post(&format!("{session}/answers"), said).await;
        assert_eq!(reply.status, StatusCode::OK, "{}", reply.text);
        question = reply.json();
        if asked % 6 == 5 {
            *site = Site::at(path);
            let again = site.get(&format!("{session}/question")).await.json();
            assert_eq!(again, question, "another question after a restart");
        }
    }
    panic!("it does not end");
}

/// Only what was recorded is asked, also after restarts; an upload serves a second
/// session with other settings.
#[tokio::test]
async fn a_rule_is_taught_by_recordings_across_restarts() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.db");
    let mut site = Site::at(&path);
    let lines = all_words();
    let mut body = binary();
    body["seed"] = json!(3);
    let reply = Parts::default()
        .task(&body)
        .recordings(&lines)
        .send(&site, SESSIONS)
        .await;
    assert_eq!(reply.status, StatusCode::CREATED, "{}", reply.text);
    let (id, upload) = (reply.json()["id"].clone(), reply.json()["upload"].clone());
    let session = format!("{SESSIONS}/{}", id.as_str().unwrap());
    let state = site.get(&session).await.json();
    assert_eq!(
        state["task"]["world"],
        json!({"kind": "pool", "upload": upload})
    );
    assert_eq!(state["setup"]["seed"], 3);
    let log = site.get(&format!("{session}/log")).await.text;
    let first: Value = serde_json::from_str(log.lines().next().unwrap()).unwrap();
    assert_eq!(first["task"]["world"]["upload"], upload);
    let done = teach(&mut site, &path, &session, "tomita:5", &lines).await;
    let target = Target::named("tomita:5").unwrap();
    assert_eq!(
        dfa(&done["hypothesis"]).is_equivalent(target.dfa()),
        Ok(true)
    );
    // All is recorded that is needed to tell rules of this size apart.
    assert_eq!(done.get("beyond"), None, "{done}");

    let again = |symbols: [&str; 2]| {
        json!({
            "task": {"symbols": symbols, "world": {"kind": "pool", "upload": upload}},
            "strategy": "membership",
        })
    };
    // Other symbols, or in another order, are another alphabet.
    for symbols in [["1", "0"], ["0", "1"]] {
        let session = create(&site, again(symbols)).await;
        let question = site.get(&format!("{session}/question")).await.json();
        assert_eq!(question["kind"], "membership");
    }
    let session = create(&site, again(["0", "1"])).await;
    teach(&mut site, &path, &session, "tomita:6", &lines).await;
}

/// Where recordings leave something open, the end says what would decide it.
#[tokio::test]
async fn the_end_says_what_the_recordings_do_not_tell() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.db");
    let mut site = Site::at(&path);
    let zeros = |n: usize| line(&format!("run-{n}"), &vec!["0"; n]);
    let lines: String = (0..6).map(zeros).collect();
    let reply = Parts::default()
        .task(&binary())
        .recordings(&lines)
        .send(&site, SESSIONS)
        .await;
    let session = format!("{SESSIONS}/{}", reply.json()["id"].as_str().unwrap());
    let done = teach(&mut site, &path, &session, "tomita:5", &lines).await;
    let beyond = done["beyond"].as_array().unwrap();
    assert_eq!(beyond, &[json!("1")], "{done}");
    let page = site.get(&session.replace("/api/v1", "")).await;
    assert!(
        page.text.contains("No recording decides whether"),
        "{}",
        page.text
    );
    assert!(page.words().contains(&"1".to_owned()));
}

fn pictures() -> String {
    [
        json!({"id": "run-0", "word": ["a"], "media": {"kind": "frames", "paths": ["f/0.png", "f/1 & 2.png"]}}),
        json!({"id": "run-1", "word": ["b"], "complete": false, "media": {"kind": "animation", "path": "b.gif"}}),
        json!({"id": "run-2", "word": ["a", "b"], "media": {"kind": "cells", "cells": [[3, 4], [3, 5], [4, 5], [4, 5], [7, 1]]}}),
        json!({"id": "run-3", "word": ["b", "a"], "media": {"kind": "video", "path": "c.mp4"}}),
    ]
    .map(|line| line.to_string() + "\n")
    .concat()
}

fn letters() -> Value {
    // As examples they are all on one page.
    let example = |word: &str| {
        let names: Vec<String> = word.chars().map(String::from).collect();
        json!({"word": names, "label": word == "a"})
    };
    let examples = ["a", "b", "ab", "ba"].map(example);
    let world = json!({"kind": "pool"});
    json!({"task": {"symbols": ["a", "b"], "world": world, "examples": examples}})
}

fn with_media(lines: &str) -> Parts {
    Parts::default()
        .task(&letters())
        .recordings(lines)
        .media("f/0.png", PNG)
        .media("f/1 & 2.png", PNG)
        .media("b.gif", GIF)
        .media("c.mp4", &film())
}

/// Every kind of media is on the page, and comes as it was sent, whole or in part,
/// to its own session alone.
#[tokio::test]
async fn media_are_shown_and_served() {
    let site = Site::in_memory();
    let reply = with_media(&pictures()).send(&site, SESSIONS).await;
    assert_eq!(reply.status, StatusCode::CREATED, "{}", reply.text);
    let session = format!("/sessions/{}", reply.json()["id"].as_str().unwrap());
    let history = site.get(&format!("{session}/history")).await.text;
    for part in [
        format!("src=\"{session}/media/f/0.png\""),
        format!("src=\"{session}/media/f/1%20%26%202.png\""),
        "alt=\"Picture 2 of 2 of the recording run-0\"".to_owned(),
        format!("<img src=\"{session}/media/b.gif\" alt=\"The recording run-1"),
        format!("preload=\"metadata\" src=\"{session}/media/c.mp4\""),
        // Cells from row 3 and column 1 on.
        "viewBox=\"-1 -1 162 162\"".to_owned(),
        "d=\"M112 16 L144 16 L144 48 L150 54 L16 144\"".to_owned(),
        "The recording is cut off here".to_owned(),
    ] {
        assert!(history.contains(&part), "{part}: {history}");
    }
    assert_eq!(history.matches("cut off here").count(), 1);

    let film = film();
    for (path, kind, bytes) in [
        ("f/0.png", "image/png", PNG),
        ("f/1%20%26%202.png", "image/png", PNG),
        ("b.gif", "image/gif", GIF),
        ("c.mp4", "video/mp4", &film[..]),
    ] {
        let reply = site.get(&format!("{session}/media/{path}")).await;
        assert_eq!(reply.status, StatusCode::OK, "{path}");
        assert_eq!(reply.header("content-type"), kind);
        assert_eq!(reply.header("x-content-type-options"), "nosniff");
        assert_eq!(
            reply.header("cache-control"),
            "private, max-age=31536000, immutable"
        );
        assert_eq!(reply.header("accept-ranges"), "bytes");
        assert_eq!(reply.header("content-length"), bytes.len().to_string());
        assert!(reply.bytes == bytes, "{path}");
    }
    let policy = site.get(&session).await;
    assert!(
        policy
            .header("content-security-policy")
            .contains("media-src 'self'")
    );

    let size = film.len();
    for (range, status, expected) in [
        ("bytes=0-9", StatusCode::PARTIAL_CONTENT, 0..10),
        (
            "bytes=262140-262150",
            StatusCode::PARTIAL_CONTENT,
            262_140..262_151,
        ),
        ("bytes=524288-", StatusCode::PARTIAL_CONTENT, 524_288..size),
        ("bytes=-5", StatusCode::PARTIAL_CONTENT, size - 5..size),
        ("bytes=0-1,4-5", StatusCode::OK, 0..size),
        ("bytes=9999999-", StatusCode::RANGE_NOT_SATISFIABLE, 0..0),
    ] {
        let request = Request::get(format!("{session}/media/c.mp4")).header("range", range);
        let reply = site.send(request.body(Body::empty()).unwrap()).await;
        assert_eq!(reply.status, status, "{range}");
        assert!(reply.bytes == film[expected.clone()], "{range}");
        let told = match status {
            StatusCode::PARTIAL_CONTENT => {
                format!("bytes {}-{}/{size}", expected.start, expected.end - 1)
            }
            StatusCode::RANGE_NOT_SATISFIABLE => format!("bytes */{size}"),
            _ => String::new(),
        };
        assert_eq!(reply.header("content-range"), told);
    }

    let other = Parts::default().task(&binary()).recordings(&all_words());
    let other = other.send(&site, SESSIONS).await.json();
    let plain = create(&site, json!({"task": "tomita:1"})).await;
    for (session, path) in [
        (
            format!("/sessions/{}", other["id"].as_str().unwrap()),
            "f/0.png",
        ),
        (plain.replace("/api/v1", ""), "f/0.png"),
        (session.clone(), "recordings"),
        (session.clone(), "f/../f/0.png"),
        (session.clone(), "nothing.png"),
        (
            "/sessions/0123456789abcdef0123456789abcdef".to_owned(),
            "f/0.png",
        ),
    ] {
        let reply = site.get(&format!("{session}/media/{path}")).await;
        assert_eq!(reply.status, StatusCode::NOT_FOUND, "{session} {path}");
    }
}

/// A task file as it stands on the command line, its world and all.
#[tokio::test]
async fn a_task_file_is_taken_too() {
    let site = Site::in_memory();
    let task = "name = \"runs\"\nsymbols = [\"0\", \"1\"]\n[world]\nkind = \"pool\"\nrecordings = \"runs.jsonl\"\n";
    let parts = Parts::default().part("task", Some("task.toml"), task.as_bytes());
    let reply = parts.recordings(&all_words()).send(&site, SESSIONS).await;
    assert_eq!(reply.status, StatusCode::CREATED, "{}", reply.text);
    let session = format!("{SESSIONS}/{}", reply.json()["id"].as_str().unwrap());
    assert_eq!(site.get(&session).await.json()["task"]["name"], "runs");
}

/// The start page's form, as browsers send it.
#[tokio::test]
async fn the_page_takes_recordings_and_tells_faults_at_their_fields() {
    let site = Site::in_memory();
    let typed = || {
        Parts::default()
            .text("title", "My runs")
            .text("symbols", "a b")
            .text("examples", "+ a\r\n- b a")
    };
    // What is sent where no file was chosen.
    let empty = |parts: Parts, name: &str| parts.part(name, Some(""), b"");
    let with_files = |lines: &str| {
        let parts = typed().recordings(lines);
        let parts = parts.media("f/0.png", PNG).media("f/1 & 2.png", PNG);
        parts.media("b.gif", GIF).media("c.mp4", &film())
    };
    let location = with_files(&pictures())
        .send(&site, "/sessions")
        .await
        .location();
    let page = site.get(&location).await;
    assert!(page.text.contains("My runs"), "{}", page.text);

    let none = empty(empty(empty(typed(), "recordings"), "media"), "media");
    let location = none.send(&site, "/sessions").await.location();
    let state = site.get(&format!("/api/v1{location}")).await.json();
    assert_eq!(state["task"].get("world"), None, "{state}");

    let before = site.get(SESSIONS).await.json();
    for (parts, status, field, part) in [
        (
            with_files("broken\n"),
            422,
            "recordings",
            "Line 1, column 1: expected an object",
        ),
        (
            with_files(&pictures()).media("more.png", PNG),
            422,
            "media",
            "`more.png` is named by no recording",
        ),
        (
            typed().recordings(&line("x", &["a"])),
            422,
            "examples",
            "Example 2: no recording shows this",
        ),
        (
            Parts::default()
                .text("title", "My runs")
                .text("symbols", "a a")
                .recordings("x"),
            422,
            "symbols",
            "twice",
        ),
    ] {
        let reply = parts.send(&site, "/sessions").await;
        assert_eq!(reply.status.as_u16(), status, "{}", reply.text);
        let fault = format!("id=\"{field}-fault\"");
        let at = reply
            .text
            .split(&fault)
            .nth(1)
            .unwrap_or_else(|| panic!("{field}: {}", reply.text));
        let said = at.split("</span>").next().unwrap();
        assert!(said.contains(part), "{said}");
        assert!(reply.text.contains("value=\"My runs\""));
        assert!(reply.text.contains("Choose the files again"));
    }
    assert_eq!(site.get(SESSIONS).await.json(), before);
}

/// The start page takes a task file as it lies in a folder, target and all, in place of
/// its other fields; what is wrong with it is told at its field.
#[tokio::test]
async fn a_task_file_begins_a_session_from_the_start_page() {
    let site = Site::in_memory();
    let send = async |file: &str| {
        let parts = Parts::default().text("title", "").text("symbols", "");
        let parts = parts.part("file", Some("task.toml"), file.as_bytes());
        parts.send(&site, "/sessions").await
    };
    for (file, kind, title) in [
        (
            include_str!("../../examples/tasks/robot-recharge.toml"),
            "grid",
            "robot-recharge",
        ),
        (include_str!("../../examples/tasks/car.toml"), "", "car"),
        (r#"{"name": "mine", "symbols": ["a", "b"]}"#, "", "mine"),
    ] {
        let session = format!("/api/v1{}", send(file).await.location());
        let state = site.get(&session).await.json();
        assert_eq!(state["task"]["name"], title);
        assert_eq!(state["task"]["world"]["kind"].as_str().unwrap_or(""), kind);
        assert_eq!(state["task"].get("target"), None);
    }
    let begun = site.get("/api/v1/sessions").await.json()["sessions"].clone();
    for (file, part) in [
        ("symbols = [", "line 1, column 12: this is not TOML"),
        ("{\"symbols\": ", "this is not JSON"),
        ("symbols = [\"a\", \"a\"]", "`symbols[1]`"),
        (
            "symbols = [\"a\"]\nworld = {kind = \"grid\", map = [\"..\"]}",
            "`world.map`",
        ),
        (
            "class = {kind = \"finite\", table = \"here.csv\"}",
            "this file is not here",
        ),
    ] {
        let reply = send(file).await;
        assert_eq!(reply.status, StatusCode::UNPROCESSABLE_ENTITY);
        let told = reply.text.split("id=\"file-fault\"").nth(1).unwrap();
        let told = told.split("</span>").next().unwrap().replace("&#34;", "\"");
        assert!(told.to_lowercase().contains(&part.to_lowercase()), "{told}");
        assert!(reply.text.contains("Choose the files again"));
    }
    assert_eq!(site.get("/api/v1/sessions").await.json()["sessions"], begun);
}
