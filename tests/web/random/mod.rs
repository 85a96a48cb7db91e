//! Whatever is sent in whatever order: no call is answered by a 5xx, and after each
//! what must always hold of the session still does.
//!
//! `MEMREP_CALLS=10000` sends so many; `MEMREP_CALLS_SEED=7` sends what another run
//! sent, which printed that number.

mod guests;
mod nonsense;
mod sensible;

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;

use axum::body::Body;
use axum::http::{Method, Request, StatusCode};
use memrep::server::routes::{ROUTES, Route};
use rand::seq::IndexedRandom;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use serde_json::{Value, json};

use crate::invariants::check;
use crate::site::{Reply, Site};

/// How many are sent where nothing else is said.
const CALLS: usize = 2000;
/// The calls of one session, before another is begun.
const LENGTH: usize = 50;

/// Routes that do nothing with a session.
const ELSEWHERE: [&str; 6] = [
    "/static/{stamp}/{name}",
    "/metrics",
    "/sign-in",
    "/sign-out",
    "/api/v1/sign-in",
    "/api/v1/sign-out",
];

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
    /// Where their pages are, of those who came.
    homes: Vec<(String, String)>,
    /// The routes that were tried.
    tried: BTreeSet<&'static str>,
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
            homes: Vec::new(),
            tried: BTreeSet::new(),
            trail: Vec::new(),
            seed,
            statuses: BTreeMap::new(),
        };
        let task = tasks().choose(&mut caller.random).unwrap().clone();
        let made = caller
            .json(Method::POST, "/api/v1/sessions".to_owned(), task)
            .await;
        let made = made.json();
        made["id"].as_str().unwrap().clone_into(&mut caller.id);
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
        self.tried.extend(route_of(&method, &path));
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

    /// The first news of a stream, whose end would not come.
    async fn follow(&mut self, path: String) {
        self.trail.push(format!("GET {path}"));
        self.tried.extend(route_of(&Method::GET, &path));
        let answer = (self.site).with_cookies(Request::get(&path).body(Body::empty()).unwrap());
        let answer = self.site.open(answer).await;
        assert_eq!(answer.status(), StatusCode::OK, "{path}");
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
}

/// The route that this path is of, among all that there are.
fn route_of(method: &Method, path: &str) -> Option<&'static str> {
    let path = path.split('?').next().unwrap();
    let fits = |route: &&Route| {
        let is_rest = |part: &str| part.starts_with("{*");
        let (mut parts, mut pattern) = (path.split('/'), route.path.split('/'));
        route.methods.contains(&method.as_str())
            && loop {
                match (parts.next(), pattern.next()) {
                    (Some(_), Some(rest)) if is_rest(rest) => break true,
                    (Some(part), Some(name)) if name.starts_with('{') || part == name => {}
                    (None, None) => break true,
                    _ => break false,
                }
            }
    };
    // Names come before what may have any name.
    let known = ROUTES.iter().filter(fits);
    let route = known.min_by_key(|route| route.path.matches('{').count());
    route.map(|route| route.path)
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
    let mut tried = BTreeSet::new();
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
        tried.append(&mut caller.tried);
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
        let all = ROUTES.iter().map(|route| route.path);
        let left: Vec<&str> = all
            .filter(|path| !tried.contains(path) && !ELSEWHERE.contains(path))
            .collect();
        assert!(left.is_empty(), "never called: {left:?}");
        assert!(
            entries > 20 && conflicts > 20,
            "they get somewhere: {entries} {conflicts}"
        );
    }
}
