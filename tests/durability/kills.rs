//! The server is killed at random moments while several people answer: nothing that
//! was acknowledged is lost, nothing counts twice.
//!
//! 200 kills; `MEMREP_KILLS=2000` makes more, `MEMREP_SEED=7` repeats a run's moments.

use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use rand::{RngExt as _, SeedableRng as _};
use rand_chacha::ChaCha8Rng;
use serde_json::{Value, json};

use crate::server::{Reply, Server, answer, answers_in, ask, assert_sound};

/// People who answer at the same time, each in a session of their own.
const PEOPLE: usize = 4;
/// Servers over databases of their own that are killed at the same time.
const LANES: u64 = 2;

fn of_environment(name: &str, usual: u64) -> u64 {
    let text = std::env::var(name).unwrap_or_default();
    text.parse().unwrap_or(usual)
}

/// An answer that was sent, and what came back the first time that something did.
struct Sent {
    answer: Value,
    first: Option<Reply>,
}

/// A session, and all that its person knows of it.
#[derive(Default)]
struct Taught {
    id: String,
    sent: Vec<Sent>,
}

/// One person, over all lives of the server.
#[derive(Default)]
struct Person {
    sessions: Vec<Taught>,
    repeated: usize,
}

impl Person {
    /// Answers until the server is gone or `enough`.
    fn teach(&mut self, address: &str, task: &str, enough: &AtomicBool) {
        // An answer that nothing came back for is sent again; one of which the reply
        // is known is too, once in a while, as by an impatient hand.
        if let Some(session) = self.sessions.last_mut()
            && let Some(last) = session.sent.last_mut()
        {
            let path = format!("/api/v1/sessions/{}/answers", session.id);
            let Some(reply) = ask(address, "POST", &path, &last.answer) else {
                return;
            };
            assert_eq!(reply.status, 200, "{reply:?}");
            match &last.first {
                Some(first) => assert_eq!(*first, reply, "the reply to a repeated answer"),
                None => last.first = Some(reply),
            }
            self.repeated += 1;
        }
        while !enough.load(Ordering::Relaxed) {
            if self.step(address, task).is_none() {
                return;
            }
        }
    }

    /// One question and its answer, or a new session; none once the server is gone.
    fn step(&mut self, address: &str, task: &str) -> Option<()> {
        let question = match self.sessions.last() {
            Some(session) => {
                let path = format!("/api/v1/sessions/{}/question", session.id);
                ask(address, "GET", &path, &Value::Null)?.json()
            }
            None => json!({"kind": "done"}),
        };
        let Some(answer) = answer(&question) else {
            let created = ask(address, "POST", "/api/v1/sessions", &json!({"task": task}))?;
            assert_eq!(created.status, 201, "{created:?}");
            let id = created.json()["id"].as_str().unwrap().to_owned();
            self.sessions.push(Taught {
                id,
                sent: Vec::new(),
            });
            return Some(());
        };
        let session = self.sessions.last_mut()?;
        let path = format!("/api/v1/sessions/{}/answers", session.id);
        session.sent.push(Sent {
            answer: answer.clone(),
            first: None,
        });
        let reply = ask(address, "POST", &path, &answer)?;
        assert_eq!(reply.status, 200, "{reply:?}");
        session.sent.last_mut()?.first = Some(reply);
        Some(())
    }
}

/// What was found of one lane.
#[derive(Default)]
struct Found {
    acknowledged: usize,
    repeated: usize,
    sessions: usize,
}

/// Compares every log with what its person knows.
fn compare(server: &Server, people: &[Person]) -> Found {
    let mut found = Found::default();
    for person in people {
        found.repeated += person.repeated;
        for session in &person.sessions {
            found.sessions += 1;
            let path = format!("/api/v1/sessions/{}/log", session.id);
            let log = server.ask("GET", &path, &Value::Null);
            assert_eq!(log.status, 200, "{log:?}");
            let kept = answers_in(&log.body);
            let mut kept = kept.iter();
            for sent in &session.sent {
                let Some(entry) = kept.as_slice().first() else {
                    assert!(sent.first.is_none(), "lost: {}\n{}", sent.answer, log.body);
                    continue;
                };
                let is_it = entry["number"] == sent.answer["question"]
                    && entry["answer"] == sent.answer["answer"];
                assert!(
                    is_it || sent.first.is_none(),
                    "lost or changed: {}\n{}",
                    sent.answer,
                    log.body
                );
                if is_it {
                    kept.next();
                    found.acknowledged += usize::from(sent.first.is_some());
                }
            }
            assert_eq!(kept.count(), 0, "doubled, or never sent:\n{}", log.body);
        }
    }
    found
}

/// One server over one database, killed so many times.
fn lane(database: &Path, kills: u64, seed: u64) -> Found {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let mut people: Vec<Person> = (0..PEOPLE).map(|_| Person::default()).collect();
    let tasks = ["tomita:1", "tomita:4"];
    for life in 0..kills {
        let mut server = Server::at(database);
        let moment = Duration::from_millis(rng.random_range(20..150));
        let enough = AtomicBool::new(false);
        let address = server.address.clone();
        std::thread::scope(|scope| {
            for (number, person) in people.iter_mut().enumerate() {
                let (address, enough) = (&address, &enough);
                scope.spawn(move || person.teach(address, tasks[number % 2], enough));
            }
            std::thread::sleep(moment);
            server.kill();
            enough.store(true, Ordering::Relaxed);
        });
        if life % 20 == 0 {
            assert_sound(database);
        }
    }
    assert_sound(database);
    let server = Server::at(database);
    let never = AtomicBool::new(true);
    for person in &mut people {
        person.teach(&server.address, "tomita:1", &never);
    }
    compare(&server, &people)
}

#[test]
fn killed_at_any_moment_it_loses_nothing_and_counts_nothing_twice() {
    let kills = of_environment("MEMREP_KILLS", 200);
    let seed = of_environment("MEMREP_SEED", u64::from(std::process::id()));
    println!("MEMREP_SEED={seed} repeats this run's moments");
    let folder = tempfile::tempdir().unwrap();
    let begun = std::time::Instant::now();
    let lanes: Vec<Found> = std::thread::scope(|scope| {
        let lanes: Vec<_> = (0..LANES)
            .map(|lane_number| {
                let database = folder.path().join(format!("{lane_number}.db"));
                scope.spawn(move || lane(&database, kills / LANES, seed + lane_number))
            })
            .collect();
        lanes.into_iter().map(|lane| lane.join().unwrap()).collect()
    });
    let sum = |figure: fn(&Found) -> usize| lanes.iter().map(figure).sum::<usize>();
    let (acknowledged, repeated) = (sum(|f| f.acknowledged), sum(|f| f.repeated));
    println!(
        "{kills} kills in {:.1} s: {} sessions, {acknowledged} answers acknowledged, all kept once; {repeated} sent again",
        begun.elapsed().as_secs_f64(),
        sum(|f| f.sessions),
    );
    assert!(
        acknowledged as u64 > kills && repeated as u64 > kills / 2,
        "too little happened to tell"
    );
}

/// A double click: the same answer twice at once is one entry, and both get the same
/// reply; and so does whoever sends it again after a restart, much later.
#[test]
fn the_reply_to_a_repeated_answer_is_the_first_reply() {
    let folder = tempfile::tempdir().unwrap();
    let database = folder.path().join("a.db");
    let mut server = Server::at(&database);
    let created = server.json("POST", "/api/v1/sessions", &json!({"task": "tomita:4"}));
    let session = format!("/api/v1/sessions/{}", created["id"].as_str().unwrap());
    let path = format!("{session}/answers");
    let mut question = server.json("GET", &format!("{session}/question"), &Value::Null);
    let mut replies = Vec::new();
    while let Some(answer) = answer(&question).filter(|_| replies.len() < 6) {
        let address = &server.address;
        let twice: Vec<Reply> = std::thread::scope(|scope| {
            let send = || ask(address, "POST", &path, &answer).unwrap();
            let both = [scope.spawn(send), scope.spawn(send)];
            both.into_iter().map(|one| one.join().unwrap()).collect()
        });
        assert_eq!(twice[0].status, 200, "{:?}", twice[0]);
        assert_eq!(twice[0], twice[1]);
        question = twice[0].json();
        replies.push((answer, twice[0].clone()));
    }
    assert!(replies.len() > 3, "{question}");
    server.kill();
    let server = Server::at(&database);
    for (answer, first) in &replies {
        assert_eq!(server.ask("POST", &path, answer), *first, "{answer}");
    }
    let log = server
        .ask("GET", &format!("{session}/log"), &Value::Null)
        .body;
    assert_eq!(answers_in(&log).len(), replies.len());
}

/// Who answers what was answered otherwise meanwhile is told so, with what is asked
/// now.
#[test]
fn who_is_late_gets_the_question_that_is_open_now() {
    let folder = tempfile::tempdir().unwrap();
    let server = Server::at(&folder.path().join("a.db"));
    let created = server.json("POST", "/api/v1/sessions", &json!({"task": "tomita:1"}));
    let session = format!("/api/v1/sessions/{}", created["id"].as_str().unwrap());
    let first = server.json("GET", &format!("{session}/question"), &Value::Null);
    let path = format!("{session}/answers");
    let next = server.json("POST", &path, &answer(&first).unwrap());
    let late = json!({"question": first["number"], "answer": "skip"});
    let reply = server.ask("POST", &path, &late);
    assert_eq!(reply.status, 409);
    assert_eq!(reply.json()["error"]["code"], "question_closed");
    assert_eq!(reply.json()["question"], next);
}
