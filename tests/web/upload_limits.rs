//! Uploads that are large, too large, or broken off.

use std::io::{Read, Write};
use std::net::TcpStream;
use std::sync::Arc;
use std::time::Duration;

use axum::http::StatusCode;
use memrep::server::{AppState, run};
use memrep::store::Sqlite;
use serde_json::json;
use tokio::net::TcpListener;

use crate::parts::{BOUNDARY, PNG, Parts, SESSIONS, all_words, binary, film, line, rows};
use crate::site::Site;

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
    assert!(
        message.starts_with("Line 7312, column 38, `word[3]`: "),
        "{message}"
    );
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
    assert!(
        heard.contains("Line 1, column 1: expected an object"),
        "{heard}"
    );
    assert_eq!(rows(&path), 0);
    stop.send(()).unwrap();
    server.await.unwrap();
}
