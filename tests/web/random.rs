//! Whatever is sent in whatever order: no call is answered by a 5xx, and after each
//! what must always hold of the session still does.
//!
//! `MEMREP_CALLS=10000` sends so many; `MEMREP_CALLS_SEED=7` sends what another run
//! sent, which printed that number.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use axum::body::Body;
use axum::http::{Method, Request, StatusCode};
use rand::seq::IndexedRandom;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use serde_json::{Value, json};

use crate::invariants::check;
use crate::site::{Reply, Site};

/// How many are sent where nothing else is said.
const CALLS: usize = 1500;
/// The calls of one session, before another is begun.
const LENGTH: usize = 50;

const ANSWERS: [&str; 10] = [
    "accept",
    "reject",
    "first",
    "second",
    "equal",
    "incomparable",
    "correct",
    "skip",
    "counterexample",
    "perhaps",
];
const WORDS: [&str; 5] = ["a", "b", "0", "1", "R"];

/// A site, a session on it, and whoever calls.
struct Caller {
    site: Site,
    random: ChaCha8Rng,
    id: String,
    /// The keys of those who were invited.
    keys: Vec<String>,
    /// What was sent to this session, to be told where something breaks.
    trail: Vec<String>,
    seed: u64,
    /// How often each status came.
    statuses: BTreeMap<u16, usize>,
}

impl Drop for Caller {
    fn drop(&mut self) {
        if std::thread::panicking() {
            eprintln!("sent with MEMREP_CALLS_SEED={}:", self.seed);
            for call in &self.trail {
                eprintln!("  {}", call.chars().take(300).collect::<String>());
            }
        }
    }
}

fn tasks() -> [Value; 8] {
    [
        json!({"task": "tomita:1"}),
        json!({"task": {"symbols": ["a"], "max_states": 2}}),
        json!({"task": {"symbols": ["a", "b"], "max_states": 2}, "strategy": "thesis", "seed": 5}),
        json!({"task": {"symbols": ["a", "b"], "max_states": 3, "prior": {"holds": ["avoid b"]}}}),
        json!({"task": {"symbols": ["a", "b"], "max_states": 3,
            "world": {"kind": "grid", "map": "S.a\n#b.", "steps": 6}}, "comparison_cost": "inf"}),
        json!({"task": {"class": {"kind": "finite", "table": "is,x,y,z\na,1,0,1\nb,0,1,1\n"}}}),
        json!({"task": {"class": {"kind": "monotone", "ticks": 5, "axes": [
            {"name": "wait", "unit": "s", "best": 0, "worst": 10}]}}}),
        json!({"task": "robot", "strategy": "exp4+", "membership_cost": 1}),
    ]
}

impl Caller {
    async fn begin(seed: u64) -> Self {
        let mut caller = Self {
            site: Site::in_memory(),
            random: ChaCha8Rng::seed_from_u64(seed),
            id: String::new(),
            keys: Vec::new(),
            trail: Vec::new(),
            seed,
            statuses: BTreeMap::new(),
        };
        let task = tasks().choose(&mut caller.random).unwrap().clone();
        let made = caller
            .json(Method::POST, "/api/v1/sessions".to_owned(), task)
            .await;
        caller.id = made.json()["id"].as_str().unwrap().to_owned();
        caller
    }

    fn one_in(&mut self, times: u32) -> bool {
        self.random.random_range(0..times) == 0
    }

    fn some<T: Clone>(&mut self, of: &[T]) -> T {
        of.choose(&mut self.random).unwrap().clone()
    }

    async fn send(&mut self, method: Method, path: String, kind: &str, body: String) -> Reply {
        self.trail.push(format!("{method} {path} ({kind}) {body}"));
        let request = Request::builder()
            .method(method)
            .uri(&path)
            .header("content-type", kind)
            .body(Body::from(body));
        // Some paths are none.
        let Ok(request) = request else {
            return self.site.get("/").await;
        };
        let reply = self.site.send(request).await;
        self.look_at(&reply);
        reply
    }

    async fn json(&mut self, method: Method, path: String, body: Value) -> Reply {
        self.send(method, path, "application/json", body.to_string())
            .await
    }

    async fn form(&mut self, path: String, fields: &[(&str, String)]) -> Reply {
        let mut body = String::new();
        for (key, value) in fields {
            let _ = write!(body, "{key}=");
            for byte in value.bytes() {
                let _ = write!(body, "%{byte:02X}");
            }
            body.push('&');
        }
        self.send(
            Method::POST,
            path,
            "application/x-www-form-urlencoded",
            body,
        )
        .await
    }

    async fn get(&mut self, path: String) -> Reply {
        self.send(Method::GET, path, "text/plain", String::new())
            .await
    }

    /// No call is answered by a 5xx; 503 says that the learner takes long.
    fn look_at(&mut self, reply: &Reply) {
        *self.statuses.entry(reply.status.as_u16()).or_default() += 1;
        assert!(
            !reply.status.is_server_error() || reply.status == StatusCode::SERVICE_UNAVAILABLE,
            "{}: {}",
            reply.status,
            reply.text
        );
    }

    async fn question(&mut self) -> Value {
        self.get(format!("/api/v1/sessions/{}/question", self.id))
            .await
            .json()
    }

    /// An answer that fits a question, mostly.
    fn reply_to(&mut self, question: &Value) -> Value {
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
    fn number(&mut self) -> Value {
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
    async fn sensible(&mut self) {
        let path = format!("/api/v1/sessions/{}", self.id);
        match self.random.random_range(0..16) {
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
            12 => self.people().await,
            13 => self.page_form().await,
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

    async fn people(&mut self) {
        let path = format!("/api/v1/sessions/{}/people", self.id);
        match self.random.random_range(0..6) {
            0 => {
                let name = self.some(&[
                    "Ada",
                    "",
                    "<b>",
                    "\u{202e}x",
                    "a name that is much too long, for nobody is called so, not even on paper",
                ]);
                let made = self.json(Method::POST, path, json!({"name": name})).await;
                if made.status == StatusCode::CREATED {
                    let link = made.json()["link"].as_str().unwrap().to_owned();
                    self.keys.push(link.rsplit('/').next().unwrap().to_owned());
                }
            }
            1 => {
                let pooling = self.some(&["majority", "reliability", "none"]);
                let body = json!({"answers": self.number(), "pooling": pooling});
                self.json(Method::POST, format!("{path}/terms"), body).await;
            }
            2 => {
                let person = self.random.random_range(0..4);
                let what = self.some(&["link", "dismissal"]);
                self.form(format!("/sessions/{}/people/{person}/{what}", self.id), &[])
                    .await;
            }
            _ => {
                let Some(key) = self.keys.choose(&mut self.random).cloned() else {
                    return drop(self.get(path).await);
                };
                let door = format!("/api/v1/answer/{key}");
                let question = self.get(door.clone()).await;
                let question = serde_json::from_str(&question.text).unwrap_or_default();
                if self.one_in(5) {
                    let body = json!({"question": self.number()});
                    self.json(Method::POST, format!("{door}/retractions"), body)
                        .await;
                } else {
                    let reply = self.reply_to(&question);
                    self.json(Method::POST, door, reply).await;
                }
                let pages = ["", "/history", "/practice"];
                let page = self.some(&pages);
                self.get(format!("/answer/{key}{page}")).await;
            }
        }
    }

    /// A page's form, without script.
    async fn page_form(&mut self) {
        let question = self.question().await;
        let reply = self.reply_to(&question);
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
        let door = self.some(&[
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
            format!("/api/v1/sessions/{id}/samples"),
            format!("/api/v1/sessions/{id}/concept"),
            format!("/api/v1/sessions/{id}/people"),
            "/studio".to_owned(),
            "/".to_owned(),
        ];
        if self.one_in(2) {
            let format = self.some(&["json", "dot", "dot-people", "hoa", "svg", "exe"]);
            let part = self.some(&["whole", "learned", "half"]);
            let path = format!("/api/v1/sessions/{id}/automaton?format={format}&part={part}");
            self.get(path).await;
        } else {
            let path = self.some(&doors);
            self.get(path).await;
        }
    }

    /// What makes no sense.
    async fn nonsense(&mut self) {
        let ids = [
            self.id.clone(),
            self.id.to_uppercase(),
            "0".repeat(32),
            "%00".to_owned(),
            "..%2f..".to_owned(),
            "\u{202e}"
                .escape_unicode()
                .to_string()
                .replace(['\\', '{', '}'], ""),
            "x".repeat(3000),
        ];
        let doors = [
            "",
            "/question",
            "/answers",
            "/retractions",
            "/changes",
            "/undo",
            "/bound",
            "/automaton",
            "/concept",
            "/log",
            "/people",
            "/people/terms",
            "/samples",
            "/nothing",
            "/again",
            "/history",
            "/why",
            "/practice",
            "/media/x",
            "/people/9999999999/link",
        ];
        let bodies = [
            String::new(),
            "{".to_owned(),
            "[]".to_owned(),
            "null".to_owned(),
            "{\"question\":1e400,\"answer\":\"accept\"}".to_owned(),
            "{\"question\":18446744073709551616,\"answer\":\"accept\"}".to_owned(),
            "{\"question\":1,\"question\":2,\"answer\":{\"a\":[]}}".to_owned(),
            "{\"max_states\":4000000000}".to_owned(),
            "{\"task\":{\"symbols\":[\"a\"],\"max_states\":0}}".to_owned(),
            "{\"task\":\"modulo:51\",\"seed\":-1}".to_owned(),
            "{\"task\":{\"symbols\":[\"a\",\"a\"],\"world\":{\"kind\":\"pool\",\"upload\":\"x\"}}}"
                .to_owned(),
            "question=1&answer=accept&question=2".to_owned(),
            "question=%FF%00&answer=%u0000&act=remove+symbols%5B99999999999999999999%5D".to_owned(),
            "\u{0}\u{feff}<script>".to_owned(),
            "[".repeat(5000),
            "a".repeat(70_000),
            "--x\r\nContent-Disposition: form-data; name=\"task\"\r\n\r\n{}\r\n--x--".to_owned(),
        ];
        let kinds = [
            "application/json",
            "application/json",
            "application/x-www-form-urlencoded",
            "text/plain",
            "multipart/form-data; boundary=x",
            "multipart/form-data",
            "\u{7f}x/",
        ];
        let methods = [
            Method::GET,
            Method::POST,
            Method::POST,
            Method::POST,
            Method::PUT,
            Method::DELETE,
            Method::PATCH,
            Method::HEAD,
            Method::OPTIONS,
        ];
        let (id, door) = (self.some(&ids), self.some(&doors));
        let path = match self.random.random_range(0..8) {
            0..4 => format!("/api/v1/sessions/{id}{door}"),
            4 | 5 => format!("/sessions/{id}{door}"),
            6 => format!("/api/v1/answer/{id}"),
            _ => self
                .some(&[
                    "/sessions",
                    "/api/v1/sessions",
                    "/studio",
                    "/studio/recordings",
                    "/api/v2",
                    "/answer/x/answers",
                ])
                .to_owned(),
        };
        let (method, kind, body) = (self.some(&methods), self.some(&kinds), self.some(&bodies));
        self.send(method, path, kind, body).await;
    }
}

fn told(variable: &str) -> Option<u64> {
    let told = std::env::var(variable).ok()?;
    Some(
        told.parse()
            .unwrap_or_else(|_| panic!("{variable} is a number")),
    )
}

#[tokio::test(flavor = "multi_thread", worker_threads = 2)]
async fn no_sequence_of_calls_breaks_what_must_hold() {
    let calls = told("MEMREP_CALLS").map_or(CALLS, |calls| calls as usize);
    let only = told("MEMREP_CALLS_SEED");
    let (mut sent, mut seed, mut entries, mut conflicts) = (0, only.unwrap_or(0), 0, 0);
    let mut statuses: BTreeMap<u16, usize> = BTreeMap::new();
    while sent < calls {
        let mut caller = Caller::begin(seed).await;
        for _ in 0..LENGTH {
            if caller.one_in(3) {
                caller.nonsense().await;
            } else {
                caller.sensible().await;
            }
            let checked = check(&caller.site, &caller.id).await;
            entries = checked.entries.max(entries);
            conflicts += usize::from(checked.is_conflict);
        }
        sent += caller.trail.len();
        for (status, times) in &caller.statuses {
            *statuses.entry(*status).or_default() += times;
        }
        seed += 1;
        if only.is_some() {
            break;
        }
    }
    eprintln!("{sent} calls to {seed} sessions, of at most {entries} entries: {statuses:?}");
    eprintln!("after {conflicts} of them answers contradicted each other");
    // 503 would say that the learner takes long, and no task here is hard.
    assert!(statuses.keys().all(|status| *status < 500), "{statuses:?}");
    if only.is_none() {
        for status in [200, 303, 400, 404, 405, 409, 422] {
            assert!(statuses.contains_key(&status), "no {status}: {statuses:?}");
        }
        assert!(
            entries > 20 && conflicts > 20,
            "they get somewhere: {entries} {conflicts}"
        );
    }
}
