//! One scripted person, who teaches one session after the other.

use std::sync::Arc;
use std::time::{Duration, Instant};

use automata::{Dfa, Word, format};
use hyper::Method;
use rand::{RngExt as _, SeedableRng as _};
use rand_chacha::ChaCha8Rng;
use serde_json::{Value, json};

use super::Habits;
use super::client::{Client, ClientError};
use super::crowd::Ledger;
use crate::evidence::Comparison;
use crate::oracle::{
    Counterexamples, Order, ScriptedTeacher, Target, Teacher as _, TeacherSettings,
};

/// How often somebody asks again who was told to wait.
const AGAIN: Duration = Duration::from_millis(200);

/// After so many answers somebody looks at the page.
const EVERY: u32 = 4;

/// How long somebody lets themselves be put off.
const LONGEST: Duration = Duration::from_secs(60);

/// How long somebody waits who was refused, at least.
const BREATH: Duration = Duration::from_millis(500);

/// Somebody with a connection of their own.
pub(super) struct Person {
    number: usize,
    client: Client,
    habits: Arc<Habits>,
    ledger: Arc<Ledger>,
    random: ChaCha8Rng,
    /// The place of what is taught next.
    next: usize,
}

/// A session that is being taught.
struct Lesson {
    path: String,
    teacher: ScriptedTeacher,
    target: Target,
}

impl Person {
    pub(super) fn new(
        number: usize,
        client: Client,
        habits: Arc<Habits>,
        ledger: Arc<Ledger>,
    ) -> Self {
        let mut random = ChaCha8Rng::seed_from_u64(habits.seed);
        random.set_stream(number as u64);
        Self {
            number,
            client,
            habits,
            ledger,
            random,
            next: number,
        }
    }

    /// Teaches until it is over.
    pub(super) async fn teach(mut self) {
        // Nobody comes at the same moment as somebody else.
        let late = self.random.random::<f64>();
        tokio::time::sleep(self.habits.think.mul_f64(late)).await;
        while !self.ledger.is_over() {
            if let Err(error) = self.lesson().await {
                self.ledger.failed(self.number, &error);
                tokio::time::sleep(BREATH.max(self.habits.think)).await;
            }
            self.ledger
                .reconnected(std::mem::take(&mut self.client.reconnects));
        }
    }

    /// One session from its beginning to its end.
    async fn lesson(&mut self) -> Result<(), ClientError> {
        let target = self.habits.targets[self.next % self.habits.targets.len()].clone();
        self.next += 1;
        let seed = self.random.random::<u32>();
        let begun = Instant::now();
        let path = begin(&mut self.client, target.name(), u64::from(seed)).await?;
        let settings = TeacherSettings {
            order: Order::Ordered,
            counterexamples: Counterexamples::Shortest,
            error_rate: 0.0,
            seed: u64::from(seed),
        };
        let mut lesson = Lesson {
            path,
            teacher: ScriptedTeacher::new(&target, settings),
            target,
        };
        let first = json!({"kind": "thinking"});
        let mut question = self.settled(&lesson.path, first).await?;
        self.ledger.began(begun.elapsed());
        let mut answers = 0;
        while let Some(answer) = lesson.answer(&question)? {
            self.think().await;
            if self.ledger.is_over() {
                return Ok(());
            }
            self.ledger.asks(self.number);
            let path = format!("{}/answers", lesson.path);
            let reply = self.patiently(Method::POST, &path, Some(&answer)).await?;
            question = self.settled(&lesson.path, reply).await?;
            self.ledger.waited(self.number);
            answers += 1;
            if answers % EVERY == 0 {
                self.look(&lesson.path).await?;
            }
        }
        self.ledger.ended();
        Ok(())
    }

    /// Looks at the session's page, whose question is there already.
    async fn look(&mut self, path: &str) -> Result<(), ClientError> {
        let page = path.strip_prefix("/api/v1").unwrap_or(path);
        let asked = Instant::now();
        loop {
            let (status, _) = self.client.send(Method::GET, page, None).await?;
            match status.as_u16() {
                200 => break,
                202 if asked.elapsed() < LONGEST => self.ledger.put_off(),
                202 => return Err(ClientError::PutOff),
                other => return Err(ClientError::Status(other)),
            }
            tokio::time::sleep(AGAIN).await;
        }
        self.ledger.looked(asked.elapsed());
        Ok(())
    }

    /// The question, once there is one.
    async fn settled(&mut self, path: &str, mut question: Value) -> Result<Value, ClientError> {
        let path = format!("{path}/question");
        let mut first = true;
        while question["kind"] == "thinking" {
            if !std::mem::take(&mut first) {
                tokio::time::sleep(AGAIN).await;
            }
            question = self.patiently(Method::GET, &path, None).await?;
        }
        Ok(question)
    }

    /// What comes back, in the end, where the server says that it is still thinking. The
    /// same answer sent again counts once.
    async fn patiently(
        &mut self,
        method: Method,
        path: &str,
        body: Option<&Value>,
    ) -> Result<Value, ClientError> {
        let since = Instant::now();
        loop {
            match self.client.json(method.clone(), path, body).await {
                Err(ClientError::PutOff) if since.elapsed() < LONGEST => {
                    self.ledger.put_off();
                    tokio::time::sleep(AGAIN).await;
                }
                other => return other,
            }
        }
    }

    /// Takes an exponentially distributed time, as far as that is human.
    async fn think(&mut self) {
        let drawn: f64 = 1.0 - self.random.random::<f64>();
        let long = (-drawn.ln()).min(6.0);
        tokio::time::sleep(self.habits.think.mul_f64(long)).await;
    }
}

/// Begins a session; its address.
pub(super) async fn begin(
    client: &mut Client,
    task: &str,
    seed: u64,
) -> Result<String, ClientError> {
    let wish = json!({"task": task, "seed": seed});
    let begun = client.json(Method::POST, "/api/v1/sessions", Some(&wish));
    let begun = begun.await?;
    let id = begun["id"]
        .as_str()
        .ok_or(ClientError::Nonsense("no session"))?;
    Ok(format!("/api/v1/sessions/{id}"))
}

impl Lesson {
    /// The true answer to a question; none at the end.
    fn answer(&mut self, question: &Value) -> Result<Option<Value>, ClientError> {
        let number = &question["number"];
        let said = match question["kind"].as_str() {
            Some("membership") => {
                let atom = self.word(&question["word"])?;
                let accepted = self.teacher.membership(&atom);
                json!({"question": number, "answer": if accepted { "accept" } else { "reject" }})
            }
            Some("comparison") => {
                let (first, second) = (
                    self.word(&question["first"])?,
                    self.word(&question["second"])?,
                );
                let better = match self.teacher.comparison(&first, &second) {
                    Comparison::First => "first",
                    Comparison::Second => "second",
                    Comparison::Equal => "equal",
                    Comparison::Incomparable => "incomparable",
                };
                json!({"question": number, "answer": better})
            }
            Some("equivalence") => {
                let rule = self.rule(&question["hypothesis"])?;
                match self.teacher.counterexample(&rule) {
                    None => json!({"question": number, "answer": "correct"}),
                    Some((atom, label)) => json!({
                        "question": number,
                        "answer": "counterexample",
                        "word": rule.alphabet().spell(&atom).collect::<Vec<_>>(),
                        "label": label,
                    }),
                }
            }
            Some("done") => return Ok(None),
            // True answers never contradict each other.
            Some("conflict") => {
                return Err(ClientError::Nonsense("a contradiction in true answers"));
            }
            _ => return Err(ClientError::Nonsense("a question of no known kind")),
        };
        Ok(Some(said))
    }

    fn word(&self, value: &Value) -> Result<Word, ClientError> {
        let nonsense = ClientError::Nonsense("no word over the task's symbols");
        let Some(names) = value.as_array() else {
            return Err(nonsense);
        };
        let names = names.iter().map(|name| name.as_str().unwrap_or_default());
        let word = self.target.dfa().alphabet().word(names);
        word.map_err(|_| nonsense)
    }

    fn rule(&self, value: &Value) -> Result<Dfa, ClientError> {
        let read = format::json::read(&value.to_string());
        let rule = read.map_err(|_| ClientError::Nonsense("no automaton"))?.dfa;
        if rule.alphabet() == self.target.dfa().alphabet() {
            Ok(rule)
        } else {
            Err(ClientError::Nonsense("an automaton over other symbols"))
        }
    }
}
