//! People who answer while servers die, and what each of them knows of it.

use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::time::{Duration, Instant};

use serde_json::{Value, json};

use crate::server::{Reply, Server, answer, answers_in, ask};

/// After so many lives of the server a session is left for another.
const MOST_LIVES: usize = 10;

/// A number of the environment, or the usual one.
///
/// # Panics
///
/// If it is there and no number: a longer run that was meant is not to be a short one.
pub(crate) fn of_environment(name: &str, usual: u64) -> u64 {
    match std::env::var(name) {
        Ok(text) => text
            .parse()
            .unwrap_or_else(|e| panic!("{name}={text}: {e}")),
        Err(_) => usual,
    }
}

/// How far people who answer at the same time have come, and whether it is enough.
#[derive(Default)]
pub(crate) struct Pace {
    pub(crate) enough: AtomicBool,
    acknowledged: AtomicUsize,
    repeated: AtomicUsize,
}

impl Pace {
    /// Nobody answers anything new.
    pub(crate) fn over() -> Self {
        let pace = Self::default();
        pace.enough.store(true, Ordering::Relaxed);
        pace
    }

    /// Returns once so many answers were acknowledged, and so many sent again.
    pub(crate) fn wait_for(&self, acknowledged: usize, repeated: usize) {
        let begun = Instant::now();
        while self.acknowledged() < acknowledged || self.repeated.load(Ordering::Relaxed) < repeated
        {
            if begun.elapsed() > Duration::from_secs(60) {
                // Whoever answers is to end as well.
                self.enough.store(true, Ordering::Relaxed);
                let had = self.acknowledged();
                panic!("nothing happens: {had} answers acknowledged, {acknowledged} expected");
            }
            std::thread::sleep(Duration::from_millis(1));
        }
    }

    pub(crate) fn acknowledged(&self) -> usize {
        self.acknowledged.load(Ordering::Relaxed)
    }
}

/// What came back; none too where the server says that the database is away, for
/// then nobody knows whether what was sent was kept.
fn heard(address: &str, method: &str, path: &str, body: &Value) -> Option<Reply> {
    let reply = ask(address, method, path, body)?;
    let is_away = reply.status == 503 && reply.body.contains("store_unreachable");
    (!is_away).then_some(reply)
}

/// An answer that was sent, and what came back the first time that something did.
struct Sent {
    answer: Value,
    first: Option<Reply>,
}

/// A session, and all that its person knows of it.
#[derive(Default)]
pub(crate) struct Taught {
    id: String,
    sent: Vec<Sent>,
    /// How many lives of a server it has been through.
    lives: usize,
}

/// One person, over all lives of the server.
#[derive(Default)]
pub(crate) struct Person {
    sessions: Vec<Taught>,
    repeated: usize,
}

impl Person {
    /// Answers until the server is gone or it is enough.
    pub(crate) fn teach(&mut self, address: &str, task: &str, pace: &Pace) {
        // An answer that nothing came back for is sent again; one of which the reply
        // is known is too, once in a while, as by an impatient hand.
        if let Some(session) = self.sessions.last_mut()
            && let Some(last) = session.sent.last_mut()
        {
            let path = format!("/api/v1/sessions/{}/answers", session.id);
            let Some(reply) = heard(address, "POST", &path, &last.answer) else {
                return;
            };
            assert_eq!(reply.status, 200, "{reply:?}");
            if let Some(first) = &last.first {
                assert_eq!(*first, reply, "the reply to a repeated answer");
            } else {
                last.first = Some(reply);
                pace.acknowledged.fetch_add(1, Ordering::Relaxed);
            }
            self.repeated += 1;
            pace.repeated.fetch_add(1, Ordering::Relaxed);
        }
        if let Some(session) = self.sessions.last_mut() {
            session.lives += 1;
        }
        while !pace.enough.load(Ordering::Relaxed) {
            if self.step(address, task, pace).is_none() {
                return;
            }
        }
    }

    /// One question and its answer, or a new session; none once the server is gone.
    fn step(&mut self, address: &str, task: &str, pace: &Pace) -> Option<()> {
        let question = match self.sessions.last() {
            // A question that takes longer than the server lives is never put.
            Some(session) if session.lives <= MOST_LIVES => {
                let path = format!("/api/v1/sessions/{}/question", session.id);
                heard(address, "GET", &path, &Value::Null)?.json()
            }
            _ => json!({"kind": "done"}),
        };
        let Some(answer) = answer(&question) else {
            // Quick questions mostly, so that much happens between two kills; now and
            // then one that is thought about, and whose answers are tried beforehand.
            let strategies = [
                "thesis",
                "membership",
                "thesis",
                "thesis",
                "membership",
                "bayes",
            ];
            let strategy = strategies[self.sessions.len() % strategies.len()];
            let new = json!({"task": task, "strategy": strategy});
            let created = heard(address, "POST", "/api/v1/sessions", &new)?;
            assert_eq!(created.status, 201, "{created:?}");
            let id = created.json()["id"].as_str().unwrap().to_owned();
            self.sessions.push(Taught {
                id,
                ..Taught::default()
            });
            return Some(());
        };
        let session = self.sessions.last_mut()?;
        let path = format!("/api/v1/sessions/{}/answers", session.id);
        session.sent.push(Sent {
            answer: answer.clone(),
            first: None,
        });
        let reply = heard(address, "POST", &path, &answer)?;
        assert_eq!(reply.status, 200, "{reply:?}");
        session.sent.last_mut()?.first = Some(reply);
        pace.acknowledged.fetch_add(1, Ordering::Relaxed);
        Some(())
    }
}

/// What was found of one lane.
#[derive(Default)]
pub(crate) struct Found {
    pub(crate) acknowledged: usize,
    pub(crate) repeated: usize,
    pub(crate) sessions: usize,
}

/// Compares every log with what its person knows.
pub(crate) fn compare(server: &Server, people: &[Person]) -> Found {
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
