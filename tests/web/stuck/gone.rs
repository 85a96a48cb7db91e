//! Hard thoughts are nobody else's: they end with the connection of whoever they were
//! for, and no other session's answer waits for them.

use std::io::{Read, Write};
use std::net::{SocketAddr, TcpStream};
use std::sync::Arc;
use std::time::{Duration, Instant};

use memrep::server::{AppState, run};
use memrep::store::{Sqlite, Store};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use serde_json::{Value, json};
use tokio::net::TcpListener;

use crate::site::Site;

/// So long a session thinks on, in place of ten seconds.
const GRACE: Duration = Duration::from_millis(50);

/// A thousand labels at random, which no learner is done with soon.
fn hard() -> Value {
    let mut random = ChaCha8Rng::seed_from_u64(5);
    let symbols: Vec<String> = (0..26).map(|number| format!("s{number}")).collect();
    let mut examples = Vec::new();
    for number in 0..1000 {
        let length = random.random_range(20..60);
        // The first two symbols tell all words apart.
        let mut word = vec![&symbols[number % 26], &symbols[number / 26 % 26]];
        word.extend((0..length).map(|_| &symbols[random.random_range(0..26)]));
        examples.push(json!({"word": word, "label": random.random::<bool>()}));
    }
    json!({"symbols": symbols, "max_states": 100, "examples": examples})
}

/// Sends this, and is there to read what comes back.
fn ask(address: SocketAddr, head: &str, body: &str) -> TcpStream {
    let mut line = TcpStream::connect(address).unwrap();
    let length = body.len();
    let request = format!(
        "{head} HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\
         Content-Type: application/json\r\nContent-Length: {length}\r\n\r\n{body}"
    );
    line.write_all(request.as_bytes()).unwrap();
    line
}

fn get(address: SocketAddr, path: &str) -> String {
    let mut text = String::new();
    let mut line = ask(address, &format!("GET {path}"), "");
    line.read_to_string(&mut text).unwrap();
    text
}

/// How long it took until so many sessions think, as the server tells it.
fn until(address: SocketAddr, many: &str) -> Duration {
    let begun = Instant::now();
    loop {
        let figures = get(address, "/metrics");
        let thinking = figures
            .lines()
            .find_map(|line| line.strip_prefix("memrep_thinking "));
        if thinking.unwrap_or_else(|| panic!("{figures}")) == many {
            return begun.elapsed();
        }
        assert!(begun.elapsed() < Duration::from_secs(20), "never {many}");
        std::thread::sleep(Duration::from_millis(5));
    }
}

#[tokio::test(flavor = "multi_thread")]
async fn who_closes_the_connection_ends_the_work() {
    let store = Arc::new(Sqlite::in_memory().unwrap());
    let state = AppState::new(store.clone()).with_grace(GRACE);
    let listener = TcpListener::bind("127.0.0.1:0").await.unwrap();
    let address = listener.local_addr().unwrap();
    let server = tokio::spawn(run(listener, state, std::future::pending()));

    let body = json!({"task": hard()}).to_string();
    let waiting = ask(address, "POST /api/v1/sessions", &body);
    until(address, "1");
    drop(waiting);
    let took = until(address, "0");
    println!("the work ended {took:?} after the connection");

    // It did not end by itself: there is no question, only the session.
    let session = store.list(1).unwrap().remove(0).id;
    let events = store.read(&session).unwrap();
    assert_eq!(events.len(), 1, "a question was found");

    // Who comes back has it all done, and nothing is lost.
    let text = get(address, &format!("/api/v1/sessions/{session}/question"));
    assert!(text.contains("\"number\":1"), "{text}");
    server.abort();
}

#[tokio::test(flavor = "multi_thread")]
async fn an_answer_is_kept_while_others_think_on_all_cores() {
    let store = Arc::new(Sqlite::in_memory().unwrap());
    let before = Site::over_any(store.clone());
    let begun = before
        .post("/api/v1/sessions", json!({"task": "tomita:4"}))
        .await;
    let session = format!("/api/v1/sessions/{}", begun.json()["id"].as_str().unwrap());

    let state = AppState::new(store).with_grace(GRACE);
    let listener = TcpListener::bind("127.0.0.1:0").await.unwrap();
    let address = listener.local_addr().unwrap();
    let server = tokio::spawn(run(listener, state, std::future::pending()));
    let body = json!({"task": hard()}).to_string();
    // As many as have a turn at once.
    let turns = 2 * std::thread::available_parallelism().unwrap().get();
    let thinking: Vec<TcpStream> = (0..turns)
        .map(|_| ask(address, "POST /api/v1/sessions", &body))
        .collect();
    until(address, &turns.to_string());

    let answer = json!({"question": 1, "answer": "equal"}).to_string();
    let answering = ask(address, &format!("POST {session}/answers"), &answer);
    let begun = Instant::now();
    while !get(address, &format!("{session}/log")).contains("\"event\":\"answered\"") {
        assert!(begun.elapsed() < Duration::from_secs(20), "it is not kept");
        std::thread::sleep(Duration::from_millis(5));
    }
    println!("the answer was kept after {:?}", begun.elapsed());
    until(address, &turns.to_string());
    drop((thinking, answering));
    until(address, "0");
    server.abort();
}
