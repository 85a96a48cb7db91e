//! A server that is told to stop does so soon, whatever it is doing, and leaves
//! nothing half: every answer that somebody saw accepted is there afterwards.

use std::collections::BTreeMap;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::path::Path;
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

use memrep::store::{Sqlite, Store};
use serde_json::{Value, json};

/// A server as a child process, and where it is.
pub(crate) struct Server {
    child: Child,
    pub(crate) address: String,
}

impl Server {
    pub(crate) fn start(folder: &Path, log: &str) -> Self {
        let lines = std::fs::File::create(folder.join("log")).unwrap();
        let mut child = Command::new(env!("CARGO_BIN_EXE_memrep"))
            .args(["serve", "--addr", "127.0.0.1:0", "--database", "a.db"])
            .args(["--log", log, "--log-format", "json"])
            .current_dir(folder)
            .stdout(Stdio::piped())
            .stderr(lines)
            .spawn()
            .unwrap();
        let mut line = String::new();
        let out = child.stdout.as_mut().unwrap();
        BufReader::new(out).read_line(&mut line).unwrap();
        let address = line.trim().strip_prefix("memrep is at http://").unwrap();
        let address = address.trim_end_matches('/').to_owned();
        Self { child, address }
    }

    /// Tells it to stop; how it ended, and after how long.
    pub(crate) fn stop(mut self) -> (ExitStatus, Duration) {
        let begun = Instant::now();
        let id = self.child.id().to_string();
        let told = Command::new("kill").args(["-TERM", &id]).status().unwrap();
        assert!(told.success());
        while begun.elapsed() < Duration::from_secs(20) {
            if let Some(status) = self.child.try_wait().unwrap() {
                return (status, begun.elapsed());
            }
            std::thread::sleep(Duration::from_millis(5));
        }
        panic!("still there after 20 s");
    }
}

impl Drop for Server {
    fn drop(&mut self) {
        // Already gone where a test has waited for it.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// A connection that stays open.
pub(crate) struct Line {
    stream: BufReader<TcpStream>,
}

impl Line {
    pub(crate) fn to(address: &str) -> std::io::Result<Self> {
        let stream = TcpStream::connect(address)?;
        stream.set_read_timeout(Some(Duration::from_secs(30)))?;
        Ok(Self {
            stream: BufReader::new(stream),
        })
    }

    pub(crate) fn send(&mut self, method: &str, path: &str, body: &Value) -> std::io::Result<()> {
        let body = if body.is_null() {
            String::new()
        } else {
            body.to_string()
        };
        let head = format!(
            "{method} {path} HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\nContent-Length: {}\r\n\r\n",
            body.len()
        );
        self.stream.get_mut().write_all((head + &body).as_bytes())
    }

    /// The status and the body; none if the connection ended before the answer began,
    /// an error if it ended within.
    pub(crate) fn receive(&mut self) -> std::io::Result<Option<(u16, String)>> {
        let mut first = String::new();
        match self.stream.read_line(&mut first) {
            Ok(0) => return Ok(None),
            Err(error) if error.kind() == std::io::ErrorKind::ConnectionReset => return Ok(None),
            other => other?,
        };
        let status = first.split(' ').nth(1).unwrap().parse().unwrap();
        let mut length = 0;
        loop {
            let mut line = String::new();
            assert!(
                self.stream.read_line(&mut line)? > 0,
                "half a head: {first}"
            );
            if line == "\r\n" {
                break;
            }
            if let Some(value) = line.to_ascii_lowercase().strip_prefix("content-length:") {
                length = value.trim().parse().unwrap();
            }
        }
        let mut body = vec![0; length];
        self.stream.read_exact(&mut body)?;
        Ok(Some((status, String::from_utf8(body).unwrap())))
    }

    pub(crate) fn ask(&mut self, method: &str, path: &str, body: &Value) -> Option<(u16, Value)> {
        // A connection that is closed meanwhile shows when it is read.
        let _ = self.send(method, path, body);
        let (status, text) = self.receive().expect("an answer that began is whole")?;
        Some((status, serde_json::from_str(&text).unwrap()))
    }
}

/// What was seen accepted: how many answers of which session.
type Accepted = Arc<Mutex<BTreeMap<String, usize>>>;

/// Answers without pause until the server is gone; nothing true, nothing refused.
fn answer_on(address: &str, task: &str, accepted: &Accepted, busy: &AtomicUsize) {
    let Ok(mut line) = Line::to(address) else {
        return;
    };
    busy.fetch_add(1, Ordering::Relaxed);
    while let Some((201, begun)) = line.ask("POST", "/api/v1/sessions", &json!({"task": task})) {
        let id = begun["id"].as_str().unwrap().to_owned();
        let path = format!("/api/v1/sessions/{id}");
        let mut question = line.ask("GET", &format!("{path}/question"), &Value::Null);
        // A few to a session, so that no learner has much to think about.
        for _ in 0..6 {
            let Some((200, asked)) = &question else {
                return;
            };
            let said = match asked["kind"].as_str().unwrap() {
                "membership" => "accept",
                "comparison" => "equal",
                _ => break,
            };
            let answer = json!({"question": asked["number"], "answer": said});
            question = line.ask("POST", &format!("{path}/answers"), &answer);
            match &question {
                Some((200, _)) => *accepted.lock().unwrap().entry(id.clone()).or_default() += 1,
                // The answer is kept, or is to be sent again: who is told so cannot know.
                Some((503, _)) | None => return,
                Some((status, said)) => panic!("{status}: {said}"),
            }
        }
    }
}

/// All that was seen accepted is in the log, and at most one more a session: the one
/// whose answer did not arrive.
fn assert_kept(database: &Path, accepted: &Accepted) {
    let store = Sqlite::open(database).unwrap();
    for (id, count) in accepted.lock().unwrap().iter() {
        let log = store.read(&id.parse().unwrap()).unwrap();
        let answered = log
            .iter()
            .filter(|entry| entry.body.contains("\"answered\""));
        let kept = answered.count();
        assert!(
            kept == *count || kept == count + 1,
            "{id}: {kept} of {count}"
        );
    }
}

#[test]
fn under_load_it_stops_within_five_seconds_and_answers_what_it_began() {
    let folder = tempfile::tempdir().unwrap();
    let server = Server::start(folder.path(), "info");
    let (accepted, busy) = (Accepted::default(), Arc::new(AtomicUsize::new(0)));
    let people: Vec<_> = (0..16)
        .map(|number| {
            let (address, accepted) = (server.address.clone(), Arc::clone(&accepted));
            let busy = Arc::clone(&busy);
            let task = format!("tomita:{}", number % 7 + 1);
            std::thread::spawn(move || answer_on(&address, &task, &accepted, &busy))
        })
        .collect();
    let begun = Instant::now();
    let count = || accepted.lock().unwrap().values().sum::<usize>();
    while (count() < 60 || busy.load(Ordering::Relaxed) < 16) && begun.elapsed().as_secs() < 60 {
        std::thread::sleep(Duration::from_millis(10));
    }
    let (status, took) = server.stop();
    for person in people {
        person.join().unwrap();
    }
    assert!(status.success(), "{status}");
    assert!(took < Duration::from_secs(5), "{took:?}");
    let kept = count();
    assert!(kept >= 60, "only {kept} answers");
    // Nothing is left for the next start.
    assert!(!folder.path().join("a.db-wal").exists());
    assert_kept(&folder.path().join("a.db"), &accepted);
    let log = std::fs::read_to_string(folder.path().join("log")).unwrap();
    let lines: Vec<Value> = (log.lines())
        .map(|line| serde_json::from_str(line).unwrap_or_else(|e| panic!("{e}: {line}")))
        .collect();
    let told = |message: &str| {
        lines
            .iter()
            .filter(|line| line["message"] == message)
            .count()
    };
    assert_eq!((told("started"), told("stopped")), (1, 1));
    assert!(told("answered") > kept, "one line a request");
    for id in accepted.lock().unwrap().keys() {
        assert!(!log.contains(id), "the log names no session");
    }
    println!("stopped after {took:?} with {kept} answers kept");
}

/// Six letters, and labels that no small rule explains.
fn hard_task() -> Value {
    let letters = ["a", "b", "c", "d", "e", "f"];
    let mut state: u64 = 7;
    let mut draw = |most: u64| {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) % most
    };
    let mut words = BTreeMap::new();
    for _ in 0..150 {
        let length = 6 + draw(7);
        let word: Vec<&str> = (0..length).map(|_| letters[draw(6) as usize]).collect();
        words.insert(word, draw(2) == 0);
    }
    let examples: Vec<Value> = words
        .into_iter()
        .map(|(word, label)| json!({"word": word, "label": label}))
        .collect();
    json!({
        "title": "Hard",
        "max_states": 40,
        "symbols": letters.map(|name| json!({"name": name})),
        "examples": examples,
    })
}

/// Whether a session is being thought about, as the server tells it.
fn thinks(address: &str) -> bool {
    let mut line = Line::to(address).unwrap();
    line.send("GET", "/metrics", &Value::Null).unwrap();
    let (status, figures) = line.receive().unwrap().unwrap();
    assert_eq!(status, 200, "{figures}");
    figures.lines().any(|line| line == "memrep_thinking 1")
}

#[test]
fn in_a_long_thought_and_with_readers_waiting_it_stops_within_five_seconds() {
    let folder = tempfile::tempdir().unwrap();
    let server = Server::start(folder.path(), "warn");
    let mut line = Line::to(&server.address).unwrap();
    let (status, begun) = line
        .ask("POST", "/api/v1/sessions", &json!({"task": "tomita:1"}))
        .unwrap();
    assert_eq!(status, 201);
    let path = format!("/api/v1/sessions/{}", begun["id"].as_str().unwrap());
    let readers: Vec<Line> = (0..8)
        .map(|_| {
            let mut reader = Line::to(&server.address).unwrap();
            reader
                .send("GET", &format!("{path}/live"), &Value::Null)
                .unwrap();
            let mut first = String::new();
            reader.stream.read_line(&mut first).unwrap();
            assert!(first.contains("200"), "{first}");
            reader
        })
        .collect();
    let answered = Arc::new(AtomicBool::new(false));
    let (address, done) = (server.address.clone(), Arc::clone(&answered));
    let thinker = std::thread::spawn(move || {
        let mut line = Line::to(&address).unwrap();
        let _ = line.ask("POST", "/api/v1/sessions", &json!({"task": hard_task()}));
        done.store(true, Ordering::Relaxed);
    });
    let asked = Instant::now();
    while !thinks(&server.address) {
        assert!(asked.elapsed() < Duration::from_secs(20), "it never thinks");
        std::thread::sleep(Duration::from_millis(5));
    }
    // Into the middle of it.
    std::thread::sleep(Duration::from_millis(300));
    let is_thinking = thinks(&server.address) && !answered.load(Ordering::Relaxed);
    let (status, took) = server.stop();
    thinker.join().unwrap();
    assert!(status.success(), "{status}");
    assert!(took < Duration::from_secs(5), "{took:?}");
    assert!(!folder.path().join("a.db-wal").exists());
    drop(readers);
    println!("stopped after {took:?}; it was thinking: {is_thinking}");
    assert!(is_thinking, "the task is hard enough to be thought about");
}
