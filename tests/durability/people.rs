//! People who answer while servers die, and what each of them knows of it.

use std::sync::atomic::{AtomicBool, Ordering};

use serde_json::{Value, json};

use crate::server::{Reply, Server, answer, answers_in, ask};

/// After so many lives of the server a session is left for another.
const MOST_LIVES: usize = 10;

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
    /// Answers until the server is gone or `enough`.
    pub(crate) fn teach(&mut self, address: &str, task: &str, enough: &AtomicBool) {
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
        if let Some(session) = self.sessions.last_mut() {
            session.lives += 1;
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
            // A question that takes longer than the server lives is never put.
            Some(session) if session.lives <= MOST_LIVES => {
                let path = format!("/api/v1/sessions/{}/question", session.id);
                ask(address, "GET", &path, &Value::Null)?.json()
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
            let created = ask(address, "POST", "/api/v1/sessions", &new)?;
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
        let reply = ask(address, "POST", &path, &answer)?;
        assert_eq!(reply.status, 200, "{reply:?}");
        session.sent.last_mut()?.first = Some(reply);
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
