//! The server is killed at random moments while several people answer: nothing that
//! was acknowledged is lost, nothing counts twice.
//!
//! 200 kills; `MEMREP_KILLS=2000` makes more, `MEMREP_SEED=7` repeats a run's moments.

use std::path::Path;
use std::sync::atomic::Ordering;
use std::time::Duration;

use rand::{RngExt as _, SeedableRng as _};
use rand_chacha::ChaCha8Rng;
use serde_json::{Value, json};

use crate::people::{Found, Pace, Person, compare, of_environment};
use crate::server::{Reply, Server, answer, answers_in, ask, assert_sound};

/// People who answer at the same time, each in a session of their own.
const PEOPLE: usize = 4;
/// Servers over databases of their own that are killed at the same time.
const LANES: u64 = 2;

/// One server over one database, killed so many times.
fn lane(database: &Path, kills: u64, seed: u64) -> Found {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let mut people: Vec<Person> = (0..PEOPLE).map(|_| Person::default()).collect();
    let tasks = ["tomita:4", "tomita:4"];
    let pace = Pace::default();
    for life in 0..kills as usize {
        let mut server = Server::at(database);
        let moment = Duration::from_millis(rng.random_range(20..250));
        pace.enough.store(false, Ordering::Relaxed);
        let address = server.address.clone();
        std::thread::scope(|scope| {
            for (number, person) in people.iter_mut().enumerate() {
                let (address, pace) = (&address, &pace);
                scope.spawn(move || person.teach(address, tasks[number % 2], pace));
            }
            std::thread::sleep(moment);
            // A slow machine takes longer, and tells as much.
            pace.wait_for(life + 2, life / 2);
            server.kill();
            pace.enough.store(true, Ordering::Relaxed);
        });
        if life % 20 == 0 {
            assert_sound(database);
        }
    }
    assert_sound(database);
    let server = Server::at(database);
    let over = Pace::over();
    for person in &mut people {
        person.teach(&server.address, "tomita:1", &over);
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
