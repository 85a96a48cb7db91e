//! What somebody with good intentions sends.

use axum::http::{Method, StatusCode};
use rand::RngExt;
use rand::seq::IndexedRandom;
use serde_json::{Value, json};

use super::{ANSWERS, Caller, WORDS};

/// The same answer as a page sends it.
pub(super) fn fields_of(reply: &Value) -> Vec<(&'static str, String)> {
    let text = |value: &Value| match value {
        Value::String(text) => text.clone(),
        Value::Null => String::new(),
        Value::Array(items) => {
            let items: Vec<&str> = items.iter().filter_map(Value::as_str).collect();
            items.join(" ")
        }
        other => other.to_string(),
    };
    let mut fields = vec![
        ("question", text(&reply["question"])),
        ("answer", text(&reply["answer"])),
    ];
    for key in ["word", "item", "point", "label"] {
        if !reply[key].is_null() {
            fields.push((key, text(&reply[key])));
        }
    }
    fields
}

impl Caller {
    async fn question(&mut self) -> Value {
        self.get(format!("/api/v1/sessions/{}/question", self.id))
            .await
            .json()
    }

    /// An answer that fits a question, mostly.
    pub(super) fn reply_to(&mut self, question: &Value) -> Value {
        let answer = match question["kind"].as_str().unwrap_or_default() {
            "membership" => self.some(&["accept", "reject", "reject", "skip"]),
            "comparison" => self.some(&["first", "second", "equal", "incomparable", "skip"]),
            "equivalence" => self.some(&["counterexample", "counterexample", "correct"]),
            _ => self.some(&ANSWERS),
        };
        let answer = if self.one_in(12) {
            self.some(&ANSWERS)
        } else {
            answer
        };
        let mut reply = json!({"question": question["number"], "answer": answer});
        if answer == "counterexample" {
            let (key, atom) = self.atom(question);
            reply[key] = atom;
            reply["label"] = self.random.random::<bool>().into();
        }
        reply
    }

    fn atom(&mut self, question: &Value) -> (&'static str, Value) {
        let rule = &question["hypothesis"];
        if rule["limits"].is_array() {
            return ("point", json!([self.random.random_range(0..12)]));
        }
        if rule["concept"].is_string() {
            return ("item", self.some(&WORDS).into());
        }
        let symbols: Vec<Value> = rule["alphabet"].as_array().cloned().unwrap_or_default();
        let length = self.random.random_range(0..5);
        let word: Vec<Value> = (0..length)
            .filter_map(|_| symbols.choose(&mut self.random).cloned())
            .collect();
        ("word", word.into())
    }

    /// A number that may be a question's.
    pub(super) fn number(&mut self) -> Value {
        let near = json!(self.random.random_range(0..15));
        let far = [
            json!(-1),
            json!(u64::MAX),
            json!(1.5),
            json!("1"),
            json!(null),
            json!([]),
        ];
        if self.one_in(6) {
            self.some(&far)
        } else {
            near
        }
    }

    /// Something that somebody with good intentions sends.
    pub(super) async fn sensible(&mut self) {
        let path = format!("/api/v1/sessions/{}", self.id);
        match self.random.random_range(0..20) {
            0..6 => {
                let question = self.question().await;
                let reply = self.reply_to(&question);
                let first = self
                    .json(Method::POST, format!("{path}/answers"), reply.clone())
                    .await;
                if first.status == StatusCode::OK && self.one_in(3) {
                    let twice = self
                        .json(Method::POST, format!("{path}/answers"), reply)
                        .await;
                    assert_eq!(first.text, twice.text, "a repeated answer counts twice");
                }
            }
            6 => {
                let body = json!({"question": self.number()});
                self.json(Method::POST, format!("{path}/retractions"), body)
                    .await;
            }
            7 => {
                let mut body = self.reply_to(&json!({"kind": "membership"}));
                body["question"] = self.number();
                if self.one_in(2) {
                    body["answer"] = self.some(&ANSWERS).into();
                }
                self.json(Method::POST, format!("{path}/changes"), body)
                    .await;
            }
            8 => drop(
                self.json(Method::POST, format!("{path}/undo"), json!({}))
                    .await,
            ),
            9 => {
                let body = json!({"max_states": self.random.random_range(1..5)});
                self.json(Method::POST, format!("{path}/bound"), body).await;
            }
            10 => self.conflict().await,
            11 => self.both_at_once().await,
            12..15 => self.people().await,
            15 => self.page_form().await,
            16 if self.one_in(4) => self.live().await,
            _ => self.look_around().await,
        }
    }

    /// Where answers contradict each other, one of them is withdrawn.
    async fn conflict(&mut self) {
        let question = self.question().await;
        if let Some(answers) = question["answers"]
            .as_array()
            .filter(|list| !list.is_empty())
        {
            let body = json!({"question": self.some(answers)});
            let path = format!("/api/v1/sessions/{}/retractions", self.id);
            let reply = self.json(Method::POST, path, body).await;
            assert_eq!(reply.status, StatusCode::OK, "{}", reply.text);
        }
    }

    /// Two people press a button at the same time: one is heard, the other is told, or
    /// both said the same.
    async fn both_at_once(&mut self) {
        let question = self.question().await;
        let (one, other) = (self.reply_to(&question), self.reply_to(&question));
        let path = format!("/api/v1/sessions/{}/answers", self.id);
        self.trail
            .push(format!("POST {path} {one} and {other} at once"));
        let (first, second) = tokio::join!(
            self.site.post(&path, one.clone()),
            self.site.post(&path, other.clone())
        );
        self.look_at(&first);
        self.look_at(&second);
        if one != other {
            let both = first.status == StatusCode::OK && second.status == StatusCode::OK;
            assert!(!both, "both {one} and {other} were taken");
        }
    }

    /// A page's form, without script.
    async fn page_form(&mut self) {
        let question = self.question().await;
        let reply = self.reply_to(&question);
        let mut fields = fields_of(&reply);
        let door = self.some(&[
            "practice",
            "people",
            "people/terms",
            "answers",
            "answers",
            "answers",
            "retractions",
            "changes",
            "bound",
            "again",
        ]);
        if door == "bound" {
            fields = vec![("max_states", self.random.random_range(0..6).to_string())];
        }
        let path = format!("/sessions/{}/{door}", self.id);
        self.form(path, &fields).await;
    }

    /// The news of the session as it stands, of which the rest is not waited for.
    async fn live(&mut self) {
        let api = self.some(&["", "/api/v1"]);
        let path = format!("{api}/sessions/{}/live", self.id);
        self.follow(path).await;
    }

    /// Pages and files.
    async fn look_around(&mut self) {
        let id = self.id.clone();
        let doors = [
            format!("/sessions/{id}"),
            format!("/sessions/{id}/history"),
            format!("/sessions/{id}/why"),
            format!("/sessions/{id}/practice"),
            format!("/sessions/{id}/people"),
            format!("/sessions/{id}/automaton.svg"),
            format!("/sessions/{id}/media/a.png"),
            format!("/api/v1/sessions/{id}"),
            format!("/api/v1/sessions/{id}/log"),
            format!("/api/v1/sessions/{id}/samples"),
            format!("/api/v1/sessions/{id}/concept"),
            format!("/api/v1/sessions/{id}/people"),
            "/api/v1/sessions".to_owned(),
            "/api/v1/openapi.json".to_owned(),
            "/studio".to_owned(),
            "/".to_owned(),
            "/healthz".to_owned(),
        ];
        if self.one_in(4) {
            let format = self.some(&["json", "dot", "dot-people", "hoa", "svg", "exe"]);
            let part = self.some(&["whole", "learned", "half"]);
            let path = format!("/api/v1/sessions/{id}/automaton?format={format}&part={part}");
            self.get(path).await;
        } else {
            let path = self.some(&doors);
            self.get(path).await;
        }
    }
}
