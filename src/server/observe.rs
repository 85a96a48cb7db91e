//! Every request has a name, a line in the log, and a place in the figures. None of
//! them tells whose session it was.

use std::time::Instant;

use axum::extract::{MatchedPath, Request, State};
use axum::http::{HeaderMap, HeaderName, HeaderValue, Method};
use axum::middleware::Next;
use axum::response::Response;
use tracing::Instrument as _;

use super::AppState;
use super::health;
use super::metrics::Asked;

const REQUEST_ID: HeaderName = HeaderName::from_static("x-request-id");
/// A name from outside has so many characters at most.
const LONGEST: usize = 64;

tokio::task_local! {
    static CURRENT: String;
}

/// The name of the request that is being answered; none outside of one.
pub(crate) fn request_id() -> Option<String> {
    CURRENT.try_with(String::clone).ok()
}

/// Names the request, answers it, and tells the log and the figures.
pub(crate) async fn observe(State(app): State<AppState>, request: Request, next: Next) -> Response {
    let id = given_id(request.headers()).unwrap_or_else(new_id);
    let method = method_name(request.method());
    let route = request.extensions().get::<MatchedPath>();
    let route = route.map_or("none", MatchedPath::as_str).to_owned();
    // Of the highest level: whatever is told at all tells for which request.
    let span = tracing::error_span!("request", request = id, method, route);
    let begun = Instant::now();
    let waiting = app.metrics.arrived();
    let answered = CURRENT.scope(id.clone(), next.run(request));
    let mut response = answered.instrument(span.clone()).await;
    drop(waiting);
    let (took, status) = (begun.elapsed(), response.status().as_u16());
    span.in_scope(|| {
        let ms = (took.as_secs_f64() * 1e5).round() / 100.0;
        // Machines ask for these all day, and browsers for what belongs to a page.
        let is_told = !health::PATHS.contains(&route.as_str()) && !route.starts_with("/static/");
        if is_told {
            tracing::info!(status, ms, "answered");
        } else {
            tracing::debug!(status, ms, "answered");
        }
    });
    app.metrics.answered(&Asked { method, route }, status, took);
    if let Ok(id) = HeaderValue::from_str(&id) {
        response.headers_mut().insert(REQUEST_ID, id);
    }
    response
}

/// The name that a proxy before us gave, if it is short and plain.
fn given_id(headers: &HeaderMap) -> Option<String> {
    let id = headers.get(REQUEST_ID)?.to_str().ok()?;
    let plain = |c: char| c.is_ascii_alphanumeric() || matches!(c, '-' | '_' | '.');
    let fits = !id.is_empty() && id.len() <= LONGEST && id.chars().all(plain);
    fits.then(|| id.to_owned())
}

fn new_id() -> String {
    // Without randomness from the system names may repeat; they are no secrets.
    let number = getrandom::u64().unwrap_or_default();
    format!("{number:016x}")
}

/// A method by its name, those that nobody uses together.
fn method_name(method: &Method) -> &'static str {
    match *method {
        Method::GET => "GET",
        Method::POST => "POST",
        Method::HEAD => "HEAD",
        Method::PUT => "PUT",
        Method::DELETE => "DELETE",
        Method::OPTIONS => "OPTIONS",
        Method::PATCH => "PATCH",
        _ => "other",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_from_outside_is_kept_only_if_it_is_short_and_plain() {
        let given = |id: &str| {
            let mut headers = HeaderMap::new();
            headers.insert(REQUEST_ID, HeaderValue::from_str(id).unwrap());
            given_id(&headers)
        };
        for id in ["7", "01J-abc_DEF.9", &"x".repeat(64)] {
            assert_eq!(given(id).as_deref(), Some(id));
        }
        for id in ["", "a b", "a=b", "a\"b", "ä", &"x".repeat(65)] {
            assert_eq!(given(id), None, "{id}");
        }
        assert_ne!(new_id(), new_id());
    }
}
