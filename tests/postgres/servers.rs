//! Several servers share one database: who is faster is decided by the log, pages
//! that are open elsewhere hear of it, and one that dies takes nothing along.

use std::io::{BufRead as _, BufReader, Write as _};
use std::net::TcpStream;
use std::sync::atomic::Ordering;
use std::time::{Duration, Instant};

use serde_json::{Value, json};

use crate::cluster::Cluster;
use crate::people::{Pace, Person, compare, of_environment};
use crate::server::{Reply, Server, answer, answers_in, ask};

fn begin(server: &Server, task: &str) -> String {
    let created = server.json("POST", "/api/v1/sessions", &json!({"task": task}));
    format!("/api/v1/sessions/{}", created["id"].as_str().unwrap())
}

/// Both servers answer every question at the same time, and otherwise: one wins, and
/// the other's person is told so with the question that is open now.
#[test]
fn of_two_servers_that_answer_at_once_one_wins_and_the_other_has_the_next_question() {
    let cluster = Cluster::start();
    let address = cluster.database("a");
    let servers = [Server::over(&address), Server::over(&address)];
    let session = begin(&servers[0], "tomita:4");
    let door = format!("{session}/answers");
    let mut question = servers[1].json("GET", &format!("{session}/question"), &Value::Null);
    let (mut wins, mut rules) = ([0, 0], 0);
    for _ in 0..25 {
        let Some(said) = answer(&question).filter(|said| said["answer"] != "correct") else {
            break;
        };
        if question["kind"] == "equivalence" {
            // A rule cannot be skipped: there are no two different answers to send.
            question = servers[0].json("POST", &door, &said);
            rules += 1;
            continue;
        }
        let skipped = json!({"question": question["number"], "answer": "skip"});
        let sent = [(&servers[0].address, said), (&servers[1].address, skipped)];
        let replies: Vec<Reply> = std::thread::scope(|scope| {
            let send =
                |(address, body): &(&String, Value)| ask(address, "POST", &door, body).unwrap();
            let both: Vec<_> = sent
                .iter()
                .map(|one| scope.spawn(move || send(one)))
                .collect();
            both.into_iter().map(|one| one.join().unwrap()).collect()
        });
        let winner = usize::from(replies[1].status == 200);
        let (won, lost) = (&replies[winner], &replies[1 - winner]);
        assert_eq!((won.status, lost.status), (200, 409), "{replies:?}");
        assert_eq!(lost.json()["error"]["code"], "question_closed");
        assert_eq!(
            lost.json()["question"],
            won.json(),
            "the loser has what is asked now"
        );
        // Sent again, to the other server, it is the same reply.
        let other = &servers[1 - winner];
        assert_eq!(other.ask("POST", &door, &sent[winner].1), *won);
        wins[winner] += 1;
        question = won.json();
    }
    let log = servers[0].ask("GET", &format!("{session}/log"), &Value::Null);
    assert_eq!(answers_in(&log.body).len(), wins[0] + wins[1] + rules);
    assert!(wins[0] + wins[1] > 4, "{wins:?}");
    println!("who won: {wins:?}");
    a_page_at_one_server_hears_what_happens_at_the_other(&servers);
}

fn a_page_at_one_server_hears_what_happens_at_the_other(servers: &[Server; 2]) {
    let session = begin(&servers[0], "tomita:1");
    let question = servers[0].json("GET", &format!("{session}/question"), &Value::Null);
    let address = &servers[1].address;
    let mut page = TcpStream::connect(address).unwrap();
    page.set_read_timeout(Some(Duration::from_secs(30)))
        .unwrap();
    write!(
        page,
        "GET {session}/live HTTP/1.1\r\nHost: {address}\r\n\r\n"
    )
    .unwrap();
    let mut lines = BufReader::new(page).lines();
    let mut next = || -> u64 {
        let data = lines.find_map(|line| Some(line.unwrap().strip_prefix("data: ")?.parse()));
        data.unwrap().unwrap()
    };
    let before = next();
    let begun = Instant::now();
    servers[0].json(
        "POST",
        &format!("{session}/answers"),
        &answer(&question).unwrap(),
    );
    let mut now = next();
    while now < before + 2 {
        now = next();
    }
    println!("news crossed in {:?}", begun.elapsed());
    assert!(
        begun.elapsed() < Duration::from_secs(5),
        "{:?}",
        begun.elapsed()
    );
}

/// Half of the people are at a server that is killed again and again, and go on at the
/// other. `MEMREP_KILLS=200` kills it more often than 12 times.
#[test]
fn sessions_of_a_server_that_is_killed_go_on_at_the_other() {
    let cluster = Cluster::start();
    let address = cluster.database("a");
    let steady = Server::over(&address);
    let mut people: Vec<Person> = (0..4).map(|_| Person::default()).collect();
    let kills = of_environment("MEMREP_KILLS", 12) as usize;
    let pace = Pace::default();
    for round in 0..kills {
        let mut doomed = Server::over(&address);
        pace.enough.store(false, Ordering::Relaxed);
        let places = [doomed.address.clone(), steady.address.clone()];
        std::thread::scope(|scope| {
            for (number, person) in people.iter_mut().enumerate() {
                let (places, pace) = (&places, &pace);
                scope.spawn(move || {
                    // Where the first is gone, the other has the session.
                    let first = (number + round) % 2;
                    person.teach(&places[first], "tomita:4", pace);
                    person.teach(&places[1], "tomita:1", pace);
                });
            }
            std::thread::sleep(Duration::from_millis(150 + 20 * (round % 12) as u64));
            pace.wait_for(4 * round + 2, round);
            doomed.kill();
            // The others go on.
            pace.wait_for(pace.acknowledged() + 2, 0);
            pace.enough.store(true, Ordering::Relaxed);
        });
    }
    let over = Pace::over();
    for person in &mut people {
        person.teach(&steady.address, "tomita:1", &over);
    }
    let found = compare(&steady, &people);
    println!(
        "{kills} kills: {} sessions, {} answers acknowledged, all kept once; {} sent again",
        found.sessions, found.acknowledged, found.repeated
    );
    assert!(
        found.acknowledged > 4 * (kills - 1),
        "too little happened to tell"
    );
    let gaps = "SELECT count(*) FROM (SELECT session FROM entries GROUP BY session
        HAVING max(seq) <> count(*) - 1) AS gaps";
    assert_eq!(cluster.ask("a", gaps), "0");
}

/// The database itself dies while people answer, with what it had not written yet; what
/// it had acknowledged is there when it is back. Its own setting would risk that.
#[test]
fn a_database_that_dies_amid_writing_has_every_acknowledged_answer_once() {
    let cluster = Cluster::start_synced();
    let address = cluster.database("a");
    cluster.ask("a", "ALTER DATABASE a SET synchronous_commit = off");
    let server = Server::over(&address);
    let mut people: Vec<Person> = (0..4).map(|_| Person::default()).collect();
    let pace = Pace::default();
    std::thread::scope(|scope| {
        for person in &mut people {
            let (place, pace) = (&server.address, &pace);
            scope.spawn(move || {
                while !pace.enough.load(Ordering::Relaxed) {
                    person.teach(place, "tomita:4", pace);
                    std::thread::sleep(Duration::from_millis(20));
                }
            });
        }
        pace.wait_for(20, 0);
        cluster.control(&["stop", "--mode=immediate"]);
        let before = pace.acknowledged();
        cluster.control(&["start"]);
        pace.wait_for(before + 20, 1);
        pace.enough.store(true, Ordering::Relaxed);
    });
    let over = Pace::over();
    for person in &mut people {
        person.teach(&server.address, "tomita:4", &over);
    }
    let found = compare(&server, &people);
    println!(
        "{} sessions, {} answers acknowledged, all kept once; {} sent again",
        found.sessions, found.acknowledged, found.repeated
    );
    assert!(found.acknowledged >= 40, "too little happened to tell");
}

/// While the database is away that is said; once it is back all goes on, news too.
#[test]
fn a_database_that_was_away_is_told_of_and_comes_back() {
    let cluster = Cluster::start();
    let address = cluster.database("a");
    let servers = [Server::over(&address), Server::over(&address)];
    let session = begin(&servers[0], "tomita:4");
    let door = format!("{session}/answers");
    let mut question = servers[0].json("GET", &format!("{session}/question"), &Value::Null);
    for way in ["fast", "immediate"] {
        // Restarted between two answers: nobody is to notice.
        cluster.control(&["restart", "--mode", way]);
        question = servers[0].json("POST", &door, &answer(&question).unwrap());
        // Away while somebody answers.
        cluster.control(&["stop", "--mode", way]);
        let said = answer(&question).unwrap();
        let away = servers[0].ask("POST", &door, &said);
        assert_eq!(away.status, 503, "{away:?}");
        assert_eq!(away.json()["error"]["code"], "store_unreachable");
        let health = servers[0].ask("GET", "/healthz", &Value::Null);
        assert_eq!(health.status, 503, "{health:?}");
        cluster.control(&["start"]);
        question = servers[0].json("POST", &door, &said);
        assert_eq!(servers[1].json("POST", &door, &said), question);
    }
    let log = servers[1].ask("GET", &format!("{session}/log"), &Value::Null);
    assert_eq!(answers_in(&log.body).len(), 4);
    // The listeners need a moment to come back.
    std::thread::sleep(Duration::from_secs(2));
    a_page_at_one_server_hears_what_happens_at_the_other(&servers);
}
