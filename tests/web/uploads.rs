//! Recordings that come with a session: taught by what they show, served as they
//! came, and refused as a whole where anything is wrong.

use std::io::{Read, Write};
use std::net::TcpStream;
use std::path::Path;
use std::sync::Arc;
use std::time::Duration;

use automata::Alphabet;
use axum::body::Body;
use axum::http::{Request, StatusCode};
use memrep::concept::Prior;
use memrep::oracle::{SituatedTeacher, Target, TeacherSettings};
use memrep::server::{AppState, run};
use memrep::store::Sqlite;
use memrep::world::World;
use memrep::world::pool::PoolReader;
use serde_json::{Value, json};
use tokio::net::TcpListener;

use crate::api::{answer, create, dfa};
use crate::site::{Reply, Site};

const BOUNDARY: &str = "----a-boundary-that-nobody-writes";
const PNG: &[u8] = b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR and more of it";
const GIF: &[u8] = b"GIF89a and more of it";

/// A form with files.
#[derive(Clone, Default)]
pub(crate) struct Parts(Vec<u8>);

impl Parts {
    fn part(mut self, name: &str, file: Option<&str>, content: &[u8]) -> Self {
        let file = file.map_or(String::new(), |file| format!("; filename=\"{file}\""));
        let head = format!(
            "--{BOUNDARY}\r\nContent-Disposition: form-data; name=\"{name}\"{file}\r\n\r\n"
        );
        self.0.extend_from_slice(head.as_bytes());
        self.0.extend_from_slice(content);
        self.0.extend_from_slice(b"\r\n");
        self
    }

    fn text(self, name: &str, text: &str) -> Self {
        self.part(name, None, text.as_bytes())
    }

    fn task(self, task: &Value) -> Self {
        self.text("task", &task.to_string())
    }

    fn recordings(self, lines: &str) -> Self {
        self.part("recordings", Some("runs.jsonl"), lines.as_bytes())
    }

    fn media(self, path: &str, content: &[u8]) -> Self {
        self.part("media", Some(path), content)
    }

    fn end(mut self) -> Vec<u8> {
        self.0
            .extend_from_slice(format!("--{BOUNDARY}--\r\n").as_bytes());
        self.0
    }

    async fn send(self, site: &Site, path: &str) -> Reply {
        post(site, path, self.end()).await
    }
}

async fn post(site: &Site, path: &str, body: Vec<u8>) -> Reply {
    let kind = format!("multipart/form-data; boundary={BOUNDARY}");
    site.post_text(path, &kind, body).await
}

const SESSIONS: &str = "/api/v1/sessions";

fn line(id: &str, word: &[&str]) -> String {
    json!({"id": id, "word": word}).to_string() + "\n"
}

fn binary() -> Value {
    json!({"task": {"symbols": ["0", "1"], "world": {"kind": "pool"}}})
}

/// All words of up to five symbols.
fn all_words() -> String {
    let words = (0..6).flat_map(|length| (0..1_usize << length).map(move |bits| (length, bits)));
    let spell = |(length, bits): (usize, usize)| -> Vec<&str> {
        let bit = |place| if bits >> place & 1 == 1 { "1" } else { "0" };
        (0..length).map(bit).collect()
    };
    let lines = words.map(spell).enumerate();
    lines
        .map(|(number, word)| line(&format!("run-{number}"), &word))
        .collect()
}

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

fn film() -> Vec<u8> {
    let mut film = b"\0\0\0\x20ftypisom\0\0\x02\0isomiso2avc1mp41".to_vec();
    film.extend((0..600_000_u32).map(|i| (i % 253) as u8));
    film
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

/// The number of rows in all tables.
fn rows(path: &Path) -> i64 {
    let connection = rusqlite::Connection::open(path).unwrap();
    let count = |table: &str| -> i64 {
        let sql = format!("SELECT count(*) FROM {table}");
        connection.query_row(&sql, [], |row| row.get(0)).unwrap()
    };
    ["sessions", "entries", "uploads", "files", "chunks"]
        .map(count)
        .iter()
        .sum()
}

/// Each fault is told with its place, and leaves nothing.
#[tokio::test]
async fn what_is_wrong_is_named_and_leaves_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.db");
    let site = Site::at(&path);
    let two = line("x", &["0"]) + &line("y", &["1"]);
    let with = |key: &str, value: Value| {
        let mut body = binary();
        body["task"][key] = value;
        Parts::default().task(&body)
    };
    let plain = || Parts::default().task(&binary());
    let frames = |second: &str| {
        json!({"id": "z", "word": [], "media": {"kind": "frames", "paths": ["a.png", second]}})
            .to_string()
    };
    for (parts, field, part) in [
        (
            plain().recordings(&(two.clone() + "\n{\"id\":")),
            "recordings",
            "line 4, column",
        ),
        (
            plain().recordings(&(two.clone() + &line("x", &[]))),
            "recordings",
            "line 3, `id`: `x` is the name of line 1",
        ),
        (
            plain().recordings(&line("x", &["0", "1", "0", "2"])),
            "recordings",
            "line 1, `word[3]`: expected a symbol",
        ),
        (
            plain().recordings("\n"),
            "recordings",
            "there is no recording",
        ),
        (
            plain().recordings(&frames("b.bmp")),
            "recordings",
            "line 1, `media.paths[1]`: `b.bmp` is no picture",
        ),
        (
            plain().recordings(&frames("../b.png")),
            "recordings",
            "no path within the upload",
        ),
        (
            plain()
                .recordings(&(two.clone() + &frames("b.png")))
                .media("a.png", PNG)
                .media("deep/b.png", PNG),
            "recordings",
            "line 3, `media.paths[1]`: `b.png` was not sent, and `deep/b.png` was",
        ),
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
            plain().media("a.png", b"<script>").recordings(&two),
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
        (
            plain().media("a.png", PNG),
            "recordings",
            "without recordings",
        ),
        (
            plain().recordings(&two).recordings(&two),
            "recordings",
            "two files of recordings",
        ),
        (plain(), "recordings", "there are no recordings"),
        (
            Parts::default().recordings(&two).task(&binary()),
            "task",
            "send the task first",
        ),
        (
            Parts::default().text("task", "{\"task\":").recordings(&two),
            "task",
            "not JSON",
        ),
        (
            Parts::default()
                .text("task", "symbols = [\"0\"\n")
                .recordings(&two),
            "task",
            "line 2: this is not TOML",
        ),
        (
            Parts::default()
                .task(&json!({"task": "tomita:1"}))
                .recordings(&two),
            "task",
            "a ready task",
        ),
        (
            with("symbols", json!(["0", "0"])).recordings(&two),
            "task.symbols[1]",
            "twice",
        ),
        (
            with("world", json!({"kind": "words"})).recordings(&two),
            "task.world.kind",
            "give `pool`",
        ),
        (
            with("world", json!({"kind": "pool", "upload": "a"})).recordings(&two),
            "task.world.upload",
            "leave this out",
        ),
        (
            with(
                "examples",
                json!([{"word": ["0"], "label": true}, {"word": ["0", "0"], "label": true}]),
            )
            .recordings(&two),
            "task.examples[1]",
            "no recording shows this",
        ),
        (
            with(
                "practice",
                json!({"word": ["0", "0"], "answer": "accept", "why": "because"}),
            )
            .recordings(&two),
            "task.practice.word",
            "no recording shows this",
        ),
        (
            with(
                "prior",
                json!({"suffices": ["reach 0"], "holds": ["reach 0"]}),
            )
            .recordings(&two),
            "task.prior",
            "leaves nothing",
        ),
        (
            with(
                "prior",
                json!({"holds": ["avoid 0"], "suffices": ["reach 1"]}),
            )
            .recordings(&two),
            "task.prior",
            "leaves nothing",
        ),
        (plain().text("colour", "red"), "colour", "no part `colour`"),
    ] {
        let reply = parts.send(&site, SESSIONS).await;
        assert_eq!(
            reply.status,
            StatusCode::UNPROCESSABLE_ENTITY,
            "{part}: {}",
            reply.text
        );
        let error = &reply.json()["error"];
        assert_eq!(error["field"], field, "{part}: {error}");
        assert!(
            error["message"].as_str().unwrap().contains(part),
            "{part}: {error}"
        );
        assert_eq!(rows(&path), 0, "{part}");
    }
    // Without its end.
    let mut body = plain().recordings(&two).end();
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

    // An upload that is there, with a task that does not fit it.
    let reply = plain().recordings(&two).send(&site, SESSIONS).await.json();
    let before = rows(&path);
    let world = json!({"kind": "pool", "upload": reply["upload"]});
    for (task, field, part) in [
        (
            json!({"symbols": ["0"], "world": world}),
            "task.world.upload",
            "line 2, `word[0]`",
        ),
        (
            json!({"symbols": ["0", "1"], "world": world, "examples": [{"word": [], "label": true}]}),
            "task.examples[0]",
            "no recording shows this",
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

/// Ten thousand recordings, one of which is broken, are told by its line.
#[tokio::test]
async fn a_broken_line_among_many_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.db");
    let site = Site::at(&path);
    let many = |broken: usize| -> String {
        let one = |number: usize| {
            let bit = |place: usize| {
                if number >> (place % 14) & 1 == 1 {
                    "1"
                } else {
                    "0"
                }
            };
            let mut word: Vec<&str> = (0..50).map(bit).collect();
            if number == broken {
                word[3] = "x";
            }
            line(&format!("run-{number}"), &word)
        };
        (1..=10_000).map(one).collect()
    };
    let reply = Parts::default()
        .task(&binary())
        .recordings(&many(7312))
        .send(&site, SESSIONS)
        .await;
    assert_eq!(reply.status, StatusCode::UNPROCESSABLE_ENTITY);
    let message = reply.json()["error"]["message"]
        .as_str()
        .unwrap()
        .to_owned();
    assert!(message.starts_with("Line 7312, `word[3]`: "), "{message}");
    assert_eq!(rows(&path), 0);
    let reply = Parts::default()
        .task(&binary())
        .recordings(&many(0))
        .send(&site, SESSIONS)
        .await;
    assert_eq!(reply.status, StatusCode::CREATED, "{}", reply.text);
}

/// 64 MiB are taken and a byte more is not, and nothing of it stays.
#[tokio::test]
async fn the_limit_is_64_mib() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.db");
    let site = Site::at(&path);
    let lines =
        json!({"id": "a", "word": ["0"], "media": {"kind": "frames", "paths": ["a.png", "b.png"]}})
            .to_string();
    let part = 32 << 20;
    let mut large = PNG.to_vec();
    large.resize(part, 0);
    let mut rest = PNG.to_vec();
    rest.resize(part - lines.len() + 1, 0);
    let parts = Parts::default()
        .task(&binary())
        .recordings(&lines)
        .media("a.png", &large);
    let reply = parts
        .clone()
        .media("b.png", &rest)
        .send(&site, SESSIONS)
        .await;
    assert_eq!(reply.status, StatusCode::PAYLOAD_TOO_LARGE);
    let error = &reply.json()["error"];
    assert_eq!(error["code"], "body_too_large");
    assert!(
        error["message"].as_str().unwrap().contains("64 MiB"),
        "{error}"
    );
    assert_eq!(rows(&path), 0);
    rest.pop();
    let reply = parts.media("b.png", &rest).send(&site, SESSIONS).await;
    assert_eq!(reply.status, StatusCode::CREATED, "{}", reply.text);
    // JSON and plain forms keep their own limits.
    let long = "a".repeat(3 << 20);
    let reply = site.post(SESSIONS, json!({"task": long})).await;
    assert_eq!(reply.status, StatusCode::PAYLOAD_TOO_LARGE);
    let reply = site.form("/sessions", &[("symbols", &long)]).await;
    assert_eq!(reply.status, StatusCode::PAYLOAD_TOO_LARGE);
}

/// A connection that ends in the middle leaves nothing; and one that is refused in
/// the middle hears why.
#[tokio::test(flavor = "multi_thread", worker_threads = 2)]
async fn a_broken_connection_leaves_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.db");
    let state = AppState::new(Arc::new(Sqlite::open(&path).unwrap()));
    let listener = TcpListener::bind("127.0.0.1:0").await.unwrap();
    let address = listener.local_addr().unwrap();
    let (stop, stopped) = tokio::sync::oneshot::channel::<()>();
    let server = tokio::spawn(run(listener, state, async {
        let _ = stopped.await;
    }));
    let head = |length: usize| {
        format!(
            "POST {SESSIONS} HTTP/1.1\r\nHost: {address}\r\nConnection: close\r\nContent-Type: multipart/form-data; boundary={BOUNDARY}\r\nContent-Length: {length}\r\n\r\n"
        )
    };
    let whole = Parts::default()
        .task(&binary())
        .recordings(&all_words())
        .end();
    for cut in [10, 200, whole.len() / 2, whole.len() - 4] {
        let mut stream = TcpStream::connect(address).unwrap();
        stream.write_all(head(whole.len()).as_bytes()).unwrap();
        stream.write_all(&whole[..cut]).unwrap();
        stream.flush().unwrap();
        std::thread::sleep(Duration::from_millis(50));
        drop(stream);
    }
    std::thread::sleep(Duration::from_millis(200));
    assert_eq!(rows(&path), 0);

    // Refused at its first line, and still heard after 20 MiB more.
    let mut film = film();
    film.resize(20 << 20, 0);
    let parts = Parts::default()
        .task(&binary())
        .recordings("nothing\n")
        .media("a.mp4", &film)
        .end();
    let mut stream = TcpStream::connect(address).unwrap();
    stream.write_all(head(parts.len()).as_bytes()).unwrap();
    stream.write_all(&parts).unwrap();
    let mut heard = String::new();
    stream.read_to_string(&mut heard).unwrap();
    assert!(heard.starts_with("HTTP/1.1 422"), "{heard}");
    assert!(heard.contains("Line 1: expected an object"), "{heard}");
    assert_eq!(rows(&path), 0);
    stop.send(()).unwrap();
    server.await.unwrap().unwrap();
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
            "Line 1: expected an object",
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

/// An alphabet is what recordings are read over, whatever its order.
#[test]
fn the_fixture_has_all_words() {
    let alphabet = Alphabet::new(["0", "1"]).unwrap();
    let pool = PoolReader::read(alphabet, all_words().as_bytes()).unwrap();
    assert_eq!((pool.recordings().len(), pool.different()), (63, 63));
}
