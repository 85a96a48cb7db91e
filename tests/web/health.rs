//! What machines ask a server: whether it is well, and its figures.

use std::net::SocketAddr;
use std::sync::Arc;
use std::time::{Duration, Instant};

use axum::Router;
use axum::body::{Body, to_bytes};
use axum::extract::ConnectInfo;
use axum::http::{Request, Response, StatusCode};
use memrep::server::{AppState, app};
use memrep::store::{
    Entry, InviteKey, Listed, NewFile, SessionId, Sqlite, Store, StoreError, StoredFile, UploadId,
    Visit, Visits,
};
use serde_json::json;
use tower::ServiceExt;

use crate::site::Site;

/// A request from this address.
fn from(peer: &str, request: axum::http::request::Builder) -> Request<Body> {
    let mut request = request.body(Body::empty()).unwrap();
    let peer: SocketAddr = peer.parse().unwrap();
    request.extensions_mut().insert(ConnectInfo(peer));
    request
}

async fn text(response: Response<Body>) -> String {
    let bytes = to_bytes(response.into_body(), 1 << 20).await.unwrap();
    String::from_utf8(bytes.into()).unwrap()
}

async fn figures(site: &Site) -> String {
    let response = site
        .open(from("127.0.0.1:9", Request::get("/metrics")))
        .await;
    assert_eq!(response.status(), StatusCode::OK);
    text(response).await
}

/// The value on the line that begins so.
fn value(figures: &str, name: &str) -> f64 {
    let mut lines = figures.lines();
    let found = lines.find_map(|line| line.strip_prefix(name)?.strip_prefix(' '));
    let found = found.unwrap_or_else(|| panic!("no {name} in\n{figures}"));
    found.parse().unwrap()
}

/// The same of what is counted.
fn whole(figures: &str, name: &str) -> u64 {
    let value = value(figures, name).to_string();
    value.parse().unwrap_or_else(|_| panic!("{name}: {value}"))
}

#[tokio::test]
async fn whoever_balances_load_is_told_that_all_is_well() {
    let site = Site::in_memory();
    // By whatever name or number the server is called.
    for host in ["10.1.2.3:8080", "memrep.internal"] {
        let request = Request::get("/healthz").header("host", host);
        let reply = site.send(from("10.9.9.9:1", request)).await;
        assert_eq!(
            (reply.status, reply.text.as_str()),
            (StatusCode::OK, "ok\n")
        );
        assert_eq!(reply.header("x-content-type-options"), "nosniff");
    }
    assert_eq!(
        site.post("/healthz", json!({})).await.status,
        StatusCode::METHOD_NOT_ALLOWED
    );
}

#[tokio::test]
async fn figures_count_what_happened_and_name_nobody() {
    let site = Site::in_memory();
    let created = site
        .post("/api/v1/sessions", json!({"task": "tomita:4"}))
        .await;
    let id = created.json()["id"].as_str().unwrap().to_owned();
    let api = format!("/api/v1/sessions/{id}");
    let mut question = site.get(&format!("{api}/question")).await.json();
    for _ in 0..3 {
        let said = if question["kind"] == "membership" {
            "accept"
        } else {
            "equal"
        };
        let answer = json!({"question": question["number"], "answer": said});
        question = site.post(&format!("{api}/answers"), answer).await.json();
    }
    site.get("/sessions/00000000000000000000000000000000").await;
    let page = figures(&site).await;
    assert_eq!(whole(&page, "memrep_answers_accepted_total"), 3);
    // The first question, and one after each answer.
    assert_eq!(whole(&page, "memrep_questions_asked_total"), 4);
    assert_eq!(whole(&page, "memrep_question_seconds_count"), 4);
    // Those, the answers, and the session's beginning, which is not a question's.
    assert_eq!(whole(&page, "memrep_store_append_seconds_count"), 7);
    assert_eq!(whole(&page, "memrep_sessions_stored"), 1);
    assert_eq!(whole(&page, "memrep_sessions_in_memory"), 2);
    assert_eq!(whole(&page, "memrep_queue_length"), 0);
    assert!(value(&page, "memrep_solver_cpu_seconds_total") > 0.0);
    let answers = "memrep_http_requests_total{method=\"POST\",route=\"/api/v1/sessions/{id}/answers\",status=\"2xx\"}";
    assert_eq!(whole(&page, answers), 3);
    let missing =
        "memrep_http_requests_total{method=\"GET\",route=\"/sessions/{id}\",status=\"4xx\"}";
    assert_eq!(whole(&page, missing), 1);
    assert!(page.ends_with("# EOF\n"));
    assert!(!page.contains(&id), "{page}");
    assert!(value(&page, "process_cpu_seconds_total") > 0.0);
    if cfg!(target_os = "linux") {
        assert!(value(&page, "process_resident_memory_bytes") > 1e6);
    }
}

#[tokio::test]
async fn open_streams_are_counted_while_they_are_open() {
    let site = Site::in_memory();
    let created = site
        .post("/api/v1/sessions", json!({"task": "tomita:1"}))
        .await;
    let id = created.json()["id"].as_str().unwrap().to_owned();
    let live = format!("/api/v1/sessions/{id}/live");
    let stream = site
        .open(Request::get(&live).body(Body::empty()).unwrap())
        .await;
    assert_eq!(whole(&figures(&site).await, "memrep_live_followers"), 1);
    drop(stream);
    // Whoever follows is let go by a task of its own.
    for _ in 0..200 {
        if whole(&figures(&site).await, "memrep_live_followers") == 0 {
            return;
        }
        tokio::time::sleep(Duration::from_millis(10)).await;
    }
    panic!("a stream that is closed is counted still");
}

#[tokio::test]
async fn figures_are_for_this_machine_alone() {
    let site = Site::in_memory();
    let near = |request| site.send(from("127.0.0.1:9", request));
    for request in [
        Request::get("/metrics"),
        Request::get("/metrics").header("host", "localhost:8080"),
    ] {
        assert_eq!(near(request).await.status, StatusCode::OK);
    }
    for request in [
        Request::get("/metrics").header("x-forwarded-for", "192.0.2.7"),
        Request::get("/metrics").header("forwarded", "for=192.0.2.7"),
        Request::get("/metrics").header("host", "memrep.example.org"),
    ] {
        let reply = near(request).await;
        assert_eq!(reply.status, StatusCode::NOT_FOUND);
        assert!(!reply.text.contains("memrep_build"));
    }
    let far = site
        .send(from("192.0.2.7:9", Request::get("/metrics")))
        .await;
    assert_eq!(far.status, StatusCode::NOT_FOUND);
    let store = Arc::new(Sqlite::in_memory().unwrap());
    let apart = app(AppState::new(store).with_figures_apart());
    let request = from("127.0.0.1:9", Request::get("/metrics"));
    assert_eq!(
        apart.oneshot(request).await.unwrap().status(),
        StatusCode::NOT_FOUND
    );
}

/// A store that does not answer, or fails.
struct Ill {
    hangs: Duration,
}

impl Ill {
    fn fails<T>(&self) -> Result<T, StoreError> {
        std::thread::sleep(self.hangs);
        Err(StoreError::Unusable {
            path: "/secret/place".to_owned(),
            message: "the disk is full".to_owned(),
        })
    }
}

impl Visits for Ill {
    fn password(&self) -> Result<Option<String>, StoreError> {
        self.fails()
    }
    fn set_password(&self, _: Option<&str>) -> Result<(), StoreError> {
        self.fails()
    }
    fn begin_visit(&self, _: &str, _: Option<&str>, _: u64) -> Result<(), StoreError> {
        self.fails()
    }
    fn visit(&self, _: &str) -> Result<Option<Visit>, StoreError> {
        self.fails()
    }
    fn see_visit(&self, _: &str, _: u64) -> Result<(), StoreError> {
        self.fails()
    }
    fn end_visit(&self, _: &str) -> Result<(), StoreError> {
        self.fails()
    }
    fn forget_visits(&self, _: u64) -> Result<(), StoreError> {
        self.fails()
    }
}

impl Store for Ill {
    fn append_all(&self, _: &SessionId, _: u64, _: &[&str]) -> Result<(), StoreError> {
        self.fails()
    }
    fn read(&self, _: &SessionId) -> Result<Vec<Entry>, StoreError> {
        self.fails()
    }
    fn list(&self, _: usize) -> Result<Vec<Listed>, StoreError> {
        self.fails()
    }
    fn begin(
        &self,
        _: &SessionId,
        _: &str,
        _: &UploadId,
        _: Option<&mut dyn Iterator<Item = NewFile<'_>>>,
    ) -> Result<(), StoreError> {
        self.fails()
    }
    fn invite(&self, _: &InviteKey, _: &SessionId, _: u32) -> Result<(), StoreError> {
        self.fails()
    }
    fn invited(&self, _: &InviteKey) -> Result<Option<(SessionId, u32)>, StoreError> {
        self.fails()
    }
    fn visits(&self) -> &dyn Visits {
        self
    }

    fn upload_of(&self, _: &SessionId) -> Result<Option<UploadId>, StoreError> {
        self.fails()
    }
    fn file(&self, _: &UploadId, _: &str) -> Result<Option<StoredFile>, StoreError> {
        self.fails()
    }
    fn chunk(&self, _: &StoredFile, _: u64) -> Result<Vec<u8>, StoreError> {
        self.fails()
    }
}

fn over(hangs: Duration) -> Router {
    app(AppState::new(Arc::new(Ill { hangs })))
}

#[tokio::test]
async fn a_store_that_fails_or_hangs_makes_the_server_unwell() {
    let ask = |router: &Router| {
        let request = Request::get("/healthz").body(Body::empty()).unwrap();
        router.clone().oneshot(request)
    };
    let failing = ask(&over(Duration::ZERO)).await.unwrap();
    assert_eq!(failing.status(), StatusCode::SERVICE_UNAVAILABLE);
    let said = text(failing).await;
    assert!(
        said.contains("the store fails") && !said.contains("secret"),
        "{said}"
    );
    let hanging = over(Duration::from_secs(4));
    let begun = Instant::now();
    let both = tokio::join!(ask(&hanging), ask(&hanging));
    for reply in [both.0.unwrap(), both.1.unwrap()] {
        assert_eq!(reply.status(), StatusCode::SERVICE_UNAVAILABLE);
        let said = text(reply).await;
        assert!(said.contains("does not answer within 2 s"), "{said}");
    }
    assert!(
        begun.elapsed() < Duration::from_millis(3500),
        "{:?}",
        begun.elapsed()
    );
}

#[tokio::test]
async fn an_error_of_ours_names_the_request_under_which_the_log_has_its_cause() {
    let router = over(Duration::ZERO);
    let session = "/sessions/00000000000000000000000000000000";
    for path in [session.to_owned(), format!("/api/v1{session}")] {
        let request = Request::get(path).header("x-request-id", "proxy-17");
        let reply = router.clone().oneshot(request.body(Body::empty()).unwrap());
        let reply = reply.await.unwrap();
        assert_eq!(reply.status(), StatusCode::INTERNAL_SERVER_ERROR);
        assert_eq!(reply.headers()["x-request-id"], "proxy-17");
        let said = text(reply).await;
        assert!(
            said.contains("proxy-17") && !said.contains("disk is full"),
            "{said}"
        );
    }
    // Nothing of ours went wrong, and nothing is to be looked up.
    let reply = Site::in_memory().get(&format!("/api/v1{session}")).await;
    assert_eq!(reply.status, StatusCode::NOT_FOUND);
    assert_eq!(reply.json()["error"]["request"], json!(null));
}
