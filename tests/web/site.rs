//! A site over a store, asked without a network.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::{Arc, Mutex};
use std::time::Duration;

use axum::Router;
use axum::body::{Body, to_bytes};
use axum::http::{HeaderMap, Method, Request, Response, StatusCode};
use memrep::server::{AppState, app};
use memrep::store::{Sqlite, Store};
use serde_json::Value;
use tower::ServiceExt;

/// The whole site, as one browser sees it, which keeps cookies.
pub(crate) struct Site {
    router: Router,
    cookies: Mutex<BTreeMap<String, String>>,
}

/// What came back.
pub(crate) struct Reply {
    pub(crate) status: StatusCode,
    pub(crate) headers: HeaderMap,
    pub(crate) text: String,
    /// The same where it is no text.
    pub(crate) bytes: Vec<u8>,
}

impl Reply {
    pub(crate) fn json(&self) -> Value {
        serde_json::from_str(&self.text).unwrap_or_else(|e| panic!("{e}: {}", self.text))
    }

    pub(crate) fn header(&self, name: &str) -> &str {
        self.headers.get(name).map_or("", |v| v.to_str().unwrap())
    }

    /// Where a redirect leads.
    pub(crate) fn location(&self) -> String {
        assert_eq!(self.status, StatusCode::SEE_OTHER, "{}", self.text);
        self.header("location").to_owned()
    }

    /// The value of an attribute on the page's `<main>`.
    pub(crate) fn main(&self, attribute: &str) -> String {
        let main = self
            .text
            .split("<main")
            .nth(1)
            .expect("a page has a main element");
        attribute_of(main, attribute)
    }

    /// The words on the page, in order.
    pub(crate) fn words(&self) -> Vec<String> {
        self.text
            .split("<ol class=\"word")
            .skip(1)
            .map(|part| attribute_of(part, "data-word"))
            .collect()
    }
}

fn attribute_of(text: &str, attribute: &str) -> String {
    let tag = text.split('>').next().unwrap();
    tag.split_once(&format!("{attribute}=\""))
        .map_or(String::new(), |(_, rest)| {
            rest.split('"').next().unwrap().to_owned()
        })
}

impl Site {
    pub(crate) fn in_memory() -> Self {
        Self::over(Sqlite::in_memory().unwrap())
    }

    pub(crate) fn at(path: &Path) -> Self {
        Self::over(Sqlite::open(path).unwrap())
    }

    /// One where each of several people has a question for so long.
    pub(crate) fn with_lease(lease: Duration) -> Self {
        let store = Arc::new(Sqlite::in_memory().unwrap());
        Self::of(AppState::with_lease(store, lease))
    }

    fn over(store: Sqlite) -> Self {
        Self::over_any(Arc::new(store))
    }

    /// One over a store of the test's own.
    pub(crate) fn over_any(store: Arc<dyn Store>) -> Self {
        Self::of(AppState::new(store))
    }

    /// One of the test's own.
    pub(crate) fn of(state: AppState) -> Self {
        Self {
            router: app(state),
            cookies: Mutex::default(),
        }
    }

    /// The same site in another browser, which has no cookies yet.
    pub(crate) fn elsewhere(&self) -> Self {
        Self {
            router: self.router.clone(),
            cookies: Mutex::default(),
        }
    }

    /// The cookies that this browser has.
    pub(crate) fn cookies(&self) -> BTreeMap<String, String> {
        self.cookies.lock().unwrap().clone()
    }

    /// Has this browser have these cookies and no others.
    pub(crate) fn set_cookies(&self, cookies: BTreeMap<String, String>) {
        *self.cookies.lock().unwrap() = cookies;
    }

    /// Opens an invitation and presses its button: where the person's pages are.
    pub(crate) async fn enter(&self, link: &str) -> String {
        let page = self.get(link).await;
        assert_eq!(page.status, StatusCode::OK, "{}", page.text);
        self.form(link, &[]).await.location()
    }

    /// What comes back, before its body has.
    pub(crate) async fn open(&self, request: Request<Body>) -> Response<Body> {
        self.router.clone().oneshot(request).await.unwrap()
    }

    /// The request as this browser sends it, with its cookies.
    pub(crate) fn with_cookies(&self, mut request: Request<Body>) -> Request<Body> {
        let cookies: Vec<String> = (self.cookies().iter())
            .map(|(name, value)| format!("{name}={value}"))
            .collect();
        if !cookies.is_empty() {
            let cookies = cookies.join("; ").parse().unwrap();
            request.headers_mut().insert("cookie", cookies);
        }
        request
    }

    pub(crate) async fn send(&self, request: Request<Body>) -> Reply {
        let request = self.with_cookies(request);
        let response = self.router.clone().oneshot(request).await.unwrap();
        for kept in response.headers().get_all("set-cookie") {
            let (cookie, terms) = kept.to_str().unwrap().split_once("; ").unwrap();
            let (name, value) = cookie.split_once('=').unwrap();
            let mut cookies = self.cookies.lock().unwrap();
            if terms.contains("Max-Age=0;") {
                cookies.remove(name);
            } else {
                cookies.insert(name.to_owned(), value.to_owned());
            }
        }
        let (parts, body) = response.into_parts();
        let bytes = to_bytes(body, 16 << 20).await.unwrap();
        Reply {
            status: parts.status,
            headers: parts.headers,
            text: String::from_utf8_lossy(&bytes).into_owned(),
            bytes: bytes.into(),
        }
    }

    pub(crate) async fn get(&self, path: &str) -> Reply {
        self.send(Request::get(path).body(Body::empty()).unwrap())
            .await
    }

    pub(crate) async fn post(&self, path: &str, body: Value) -> Reply {
        self.post_text(path, "application/json", body.to_string())
            .await
    }

    /// A form, as a browser without script sends it.
    pub(crate) async fn form(&self, path: &str, fields: &[(&str, &str)]) -> Reply {
        let encode = |text: &str| -> String {
            text.bytes()
                .map(|b| match b {
                    b'a'..=b'z' | b'A'..=b'Z' | b'0'..=b'9' => char::from(b).to_string(),
                    _ => format!("%{b:02X}"),
                })
                .collect()
        };
        let body: Vec<String> = fields
            .iter()
            .map(|(key, value)| format!("{}={}", encode(key), encode(value)))
            .collect();
        self.post_text(path, "application/x-www-form-urlencoded", body.join("&"))
            .await
    }

    pub(crate) async fn post_text(&self, path: &str, kind: &str, body: impl Into<Body>) -> Reply {
        let request = Request::builder()
            .method(Method::POST)
            .uri(path)
            .header("content-type", kind)
            .body(body.into())
            .unwrap();
        self.send(request).await
    }
}
