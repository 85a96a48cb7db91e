//! Tasks as large as they get: every page, every call and every file comes within two
//! seconds, with what was asked for or with a word on what the server is doing.

use std::fmt::Write as _;
use std::sync::Mutex;
use std::time::{Duration, Instant};

use automata::format::dot;
use axum::http::StatusCode;
use rand::seq::IndexedRandom;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use serde_json::{Value, json};

use crate::parts::{BOUNDARY, Parts};
use crate::site::{Reply, Site};

/// What nobody is to wait longer for.
const SOON: Duration = Duration::from_secs(2);

/// A site with a stopwatch.
struct Watched {
    site: Site,
    slowest: Mutex<(Duration, String)>,
}

impl Watched {
    fn new() -> Self {
        Self {
            site: Site::in_memory(),
            slowest: Mutex::default(),
        }
    }

    /// What came, which came soon.
    async fn time(&self, what: &str, reply: impl Future<Output = Reply>) -> Reply {
        let begun = Instant::now();
        let reply = reply.await;
        let took = begun.elapsed();
        assert!(took < SOON, "{what} took {took:?}");
        assert!(
            !reply.status.is_server_error() || reply.text.contains("still_thinking"),
            "{what}: {} {}",
            reply.status,
            reply.text
        );
        let mut slowest = self.slowest.lock().unwrap();
        if took > slowest.0 {
            *slowest = (took, what.to_owned());
        }
        reply
    }

    async fn get(&self, path: &str) -> Reply {
        self.time(path, self.site.get(path)).await
    }

    async fn form(&self, path: &str, fields: &[(&str, &str)]) -> Reply {
        self.time(path, self.site.form(path, fields)).await
    }

    async fn send(&self, path: &str, parts: Parts) -> Reply {
        let kind = format!("multipart/form-data; boundary={BOUNDARY}");
        let sent = self.site.post_text(path, &kind, parts.end());
        self.time(path, sent).await
    }

    /// A session of this task, begun through the API, which waits for its first
    /// question.
    async fn begin(&self, task: &Value) -> String {
        let sent = self.site.post("/api/v1/sessions", json!({"task": task}));
        let begun = sent.await;
        assert_eq!(begun.status, StatusCode::CREATED, "{}", begun.text);
        format!("/sessions/{}", begun.json()["id"].as_str().unwrap())
    }

    /// The session's page once it is more than a word on what it is doing.
    async fn patiently(&self, page: &str) -> Reply {
        for _ in 0..100 {
            let reply = self.get(page).await;
            if reply.status == StatusCode::OK {
                return reply;
            }
            assert_eq!(reply.status, StatusCode::ACCEPTED);
            assert!(reply.text.contains("Still thinking"), "{}", reply.text);
            tokio::time::sleep(Duration::from_millis(200)).await;
        }
        panic!("{page} still thinks");
    }

    /// Answers so many questions on the session's pages; whether it got as far as a
    /// rule to be looked at.
    async fn answer(&self, page: &str, most: usize, judge: impl Fn(&Value) -> bool) -> bool {
        for _ in 0..most {
            let number = self.patiently(page).await.main("data-question");
            let question = self.get(&format!("/api/v1{page}/question")).await.json();
            assert_eq!(question["number"].to_string(), number);
            let answer = match question["kind"].as_str().unwrap() {
                "comparison" => "equal",
                "membership" if judge(&question["word"]) => "accept",
                "membership" => "reject",
                _ => return true,
            };
            let fields = [("question", number.as_str()), ("answer", answer)];
            let sent = self.form(&format!("{page}/answers"), &fields).await;
            assert_eq!(sent.location(), page);
        }
        false
    }

    /// Looks at everything that there is of a session, which stands still.
    async fn look_around(&self, page: &str) {
        for path in ["", "/history", "/people"] {
            let reply = self.get(&format!("{page}{path}")).await;
            assert_eq!(reply.status, StatusCode::OK, "{path}");
        }
        // What these have depends on how far it is.
        for path in ["/why", "/practice", "/automaton.svg"] {
            self.get(&format!("{page}{path}")).await;
        }
        for path in ["", "/question", "/log", "/people"] {
            let reply = self.get(&format!("/api/v1{page}{path}")).await;
            assert_eq!(reply.status, StatusCode::OK, "{path}: {}", reply.text);
        }
        for path in ["/samples", "/concept", "/automaton"] {
            self.get(&format!("/api/v1{page}{path}")).await;
        }
        for format in ["json", "svg", "dot", "dot-people", "hoa"] {
            let path = format!("/api/v1{page}/automaton?format={format}");
            self.get(&path).await;
        }
        for path in ["/", "/api/v1/sessions"] {
            assert_eq!(self.get(path).await.status, StatusCode::OK);
        }
    }

    /// Agrees with the rule on show, and looks at what there is then.
    async fn agree(&self, page: &str) -> Reply {
        let number = self.patiently(page).await.main("data-question");
        let fields = [("question", number.as_str()), ("answer", "correct")];
        let sent = self.form(&format!("{page}/answers"), &fields).await;
        assert_eq!(sent.location(), page, "{}", sent.text);
        let done = self.patiently(page).await;
        assert!(done.text.contains("This is the rule you taught"));
        self.look_around(page).await;
        done
    }

    fn tell(&self, what: &str) {
        let slowest = self.slowest.lock().unwrap();
        println!(
            "{what}: nothing slower than {:?} ({})",
            slowest.0, slowest.1
        );
    }
}

/// A map of 50 × 50 cells, with so many of a hundred walls and coloured.
fn map(walls: u32, coloured: u32) -> String {
    let mut random = ChaCha8Rng::seed_from_u64(u64::from(walls));
    let mut map = String::new();
    for row in 0..50 {
        for column in 0..50 {
            map.push(match random.random_range(0..100) {
                _ if (row, column) == (0, 0) => 'S',
                draw if draw < walls => '#',
                draw if draw < walls + coloured => *b"mgcw".choose(&mut random).unwrap() as char,
                _ => '.',
            });
        }
        map.push('\n');
    }
    map
}

#[tokio::test(flavor = "multi_thread")]
async fn on_a_grid_of_50_by_50_drawn_in_the_studio() {
    for (walls, coloured, steps) in [(10, 20, "150"), (0, 90, "300"), (5, 2, "1000")] {
        let watched = Watched::new();
        let map = map(walls, coloured);
        let mut fields = vec![
            ("title", "Fifty by fifty"),
            ("world.kind", "grid"),
            ("world.map", map.as_str()),
            ("world.steps", steps),
            ("world.labelling", "entry"),
            ("symbols[0].name", "mud"),
            ("symbols[0].letter", "m"),
            ("symbols[1].name", "grass"),
            ("symbols[1].letter", "g"),
            ("symbols[2].name", "coal"),
            ("symbols[2].letter", "c"),
            ("symbols[3].name", "water"),
            ("symbols[3].letter", "w"),
        ];
        for verb in ["preview", "check", "save"] {
            fields.push(("do", verb));
            let reply = watched.form("/studio", &fields).await;
            assert_eq!(reply.status, StatusCode::OK, "{verb}: {}", reply.text);
            fields.pop();
        }
        fields.push(("do", "begin"));
        let page = watched.form("/studio", &fields).await.location();
        watched.patiently(&page).await;
        watched.look_around(&page).await;
        let reached = |word: &Value| word.as_array().unwrap().contains(&json!("water"));
        if watched.answer(&page, 12, reached).await {
            watched.agree(&page).await;
        }
        watched.look_around(&page).await;
        watched.tell(&format!("a grid with {walls} % walls, {steps} steps"));
    }
}

#[tokio::test(flavor = "multi_thread")]
async fn on_ten_thousand_recordings() {
    let mut random = ChaCha8Rng::seed_from_u64(1);
    let mut lines = String::new();
    for number in 0..10_000 {
        let length = random.random_range(1..30);
        let word: Vec<&str> = (0..length)
            .map(|_| *["a", "b", "c", "d"].choose(&mut random).unwrap())
            .collect();
        let line = json!({"id": format!("run {number}"), "word": word});
        writeln!(lines, "{line}").unwrap();
    }
    let task = "title = \"Ten thousand\"\nsymbols = [\"a\", \"b\", \"c\", \"d\"]\n\
                [world]\nkind = \"pool\"\nrecordings = \"runs.jsonl\"\n";
    let watched = Watched::new();
    let parts = Parts::default().text("file", task).recordings(&lines);
    let page = watched.send("/studio/recordings", parts).await.location();
    watched.patiently(&page).await;
    watched.look_around(&page).await;
    let ends = |word: &Value| word.as_array().unwrap().last() == Some(&json!("d"));
    if watched.answer(&page, 12, ends).await {
        watched.agree(&page).await;
    }
    watched.look_around(&page).await;
    watched.tell("10,000 recordings");
}

/// Only an automaton that counts to 59 agrees with these examples.
fn counting() -> Value {
    let example = |length: usize| json!({"word": vec!["a"; length], "label": length == 59});
    let examples: Vec<Value> = (0..60).map(example).collect();
    json!({"symbols": ["a"], "max_states": 60, "examples": examples})
}

#[tokio::test(flavor = "multi_thread")]
async fn on_a_rule_of_sixty_states_which_is_a_table_in_place_of_a_drawing() {
    let watched = Watched::new();
    let page = watched.begin(&counting()).await;
    watched.look_around(&page).await;
    let sixtieth = |word: &Value| word.as_array().unwrap().len() % 60 == 59;
    assert!(
        watched.answer(&page, 40, sixtieth).await,
        "no rule is shown"
    );
    let shown = watched.get(&page).await.text;
    assert!(shown.contains("Is this the rule you mean?"));
    assert!(shown.contains("too large to be drawn readably"));
    assert_eq!(shown.matches("<th scope=\"row\">").count(), 60, "{shown}");
    watched.look_around(&page).await;

    // Who asks for the drawing all the same is told where else to look.
    let format = |name: &str| format!("/api/v1{page}/automaton?format={name}");
    for path in [format("svg"), format!("{page}/automaton.svg")] {
        let refused = watched.get(&path).await;
        assert_eq!(refused.status, StatusCode::CONFLICT, "{path}");
        for said in ["60 states", "dot-people", "table"] {
            assert!(refused.text.contains(said), "{path}: {}", refused.text);
        }
    }
    let exported = dot::read(&watched.get(&format("dot")).await.text).unwrap();
    assert_eq!(exported.size(), 60);

    let done = watched.agree(&page).await.text;
    assert!(!done.contains("format=svg"), "a drawing is offered");
    assert!(done.contains("format=dot-people"));
    watched.tell("a rule of 60 states");
}

/// Labels without rhyme or reason, so that the smallest rule is beyond every budget.
fn noise() -> Value {
    let mut random = ChaCha8Rng::seed_from_u64(3);
    let symbols = ["a", "b", "c", "d"];
    let mut words: Vec<Vec<&str>> = (0..300)
        .map(|_| {
            let length = random.random_range(0..11);
            (0..length)
                .map(|_| *symbols.choose(&mut random).unwrap())
                .collect()
        })
        .collect();
    words.sort();
    words.dedup();
    let examples: Vec<Value> = (words.into_iter())
        .map(|word| json!({"word": word, "label": random.random::<bool>()}))
        .collect();
    json!({"symbols": symbols, "max_states": 60, "examples": examples})
}

#[tokio::test(flavor = "multi_thread")]
async fn on_answers_that_only_a_huge_rule_explains() {
    let watched = Watched::new();
    let page = watched.begin(&noise()).await;
    watched.answer(&page, 3, |_| true).await;
    // Whatever it is doing, everything else comes too.
    for path in ["", "/history", "/people", "/why"] {
        watched.get(&format!("{page}{path}")).await;
    }
    for path in ["/", "/studio", "/api/v1/sessions"] {
        assert_eq!(watched.get(path).await.status, StatusCode::OK);
    }
    let log = watched.get(&format!("/api/v1{page}/log")).await;
    assert_eq!(log.text.matches("\"event\":\"answered\"").count(), 3);
    watched.patiently(&page).await;
    watched.look_around(&page).await;
    watched.tell("300 labels at random");
}
