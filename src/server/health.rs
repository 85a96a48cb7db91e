//! Whether the server is well, and its figures: for machines that watch it. Tells
//! nothing of sessions but how many there are.

use std::net::SocketAddr;
use std::sync::Arc;
use std::time::Duration;

use axum::Router;
use axum::extract::{ConnectInfo, Request, State};
use axum::http::StatusCode;
use axum::http::header::{CONTENT_TYPE, HOST};
use axum::response::{IntoResponse, Response};
use axum::routing::get;

use super::AppState;
use super::error::{PageError, WebError};
use super::guard;
use super::metrics::Standing;

/// Where they are.
pub(crate) const PATHS: [&str; 2] = ["/healthz", "/metrics"];

/// How long the store has to answer.
const DEADLINE: Duration = Duration::from_secs(2);

const FIGURES: &str = "application/openmetrics-text; version=1.0.0; charset=utf-8";

/// What proxies say of whom they ask for.
const FORWARDED: [&str; 4] = [
    "forwarded",
    "x-forwarded-for",
    "x-forwarded-host",
    "x-real-ip",
];

/// Both routes on the address that serves people. Whoever balances load names the
/// server by its number, and has no cookie: these are outside of what guards pages.
pub(crate) fn routes(state: AppState) -> Router {
    Router::new()
        .route("/healthz", get(health))
        .route("/metrics", get(near_figures))
        .with_state(state)
}

/// Both routes on an address of their own, which is whose they are to guard.
pub(crate) fn apart(state: AppState) -> Router {
    Router::new()
        .route("/healthz", get(health))
        .route("/metrics", get(figures))
        .with_state(state)
}

/// `GET /healthz`: `ok` if the store answers in time, 503 and why otherwise.
async fn health(State(app): State<AppState>) -> Response {
    match tokio::time::timeout(DEADLINE, ask_store(&app)).await {
        Ok(true) => "ok\n".into_response(),
        Ok(false) => unwell("the store fails: the log says why\n"),
        Err(_) => unwell("the store does not answer within 2 s\n"),
    }
}

fn unwell(why: &'static str) -> Response {
    (StatusCode::SERVICE_UNAVAILABLE, why).into_response()
}

/// Whether the store answers. Asked once at a time: a store that hangs is not to be
/// asked by one thread after the other.
async fn ask_store(app: &AppState) -> bool {
    let Ok(turn) = Arc::clone(&app.probes).acquire_owned().await else {
        return false;
    };
    let store = app.teaching.store();
    let asked = tokio::task::spawn_blocking(move || {
        let _turn = turn;
        store.probe()
    });
    match asked.await {
        Ok(Ok(())) => true,
        Ok(Err(cause)) => {
            tracing::error!(%cause, "the store fails");
            false
        }
        Err(cause) => {
            tracing::error!(%cause, "the store fails");
            false
        }
    }
}

/// `GET /metrics` for whoever sits at this machine. What a proxy passes on comes from
/// this machine too, so it is refused by the marks that proxies leave; the figures
/// have no names in them in any case.
async fn near_figures(State(app): State<AppState>, request: Request) -> Response {
    let peer = request.extensions().get::<ConnectInfo<SocketAddr>>();
    let headers = request.headers();
    let host = headers.get(HOST).and_then(|host| host.to_str().ok());
    let is_near = !app.figures_apart
        && peer.is_some_and(|ConnectInfo(peer)| peer.ip().is_loopback())
        && host.is_none_or(guard::is_own)
        && !FORWARDED.iter().any(|name| headers.contains_key(*name));
    if is_near {
        figures(State(app)).await
    } else {
        PageError(WebError::NoPage).into_response()
    }
}

/// `GET /metrics`.
async fn figures(State(app): State<AppState>) -> Response {
    let store = app.teaching.store();
    let counting = tokio::task::spawn_blocking(move || store.count());
    // Without an answer the last number stands.
    let counted = tokio::time::timeout(DEADLINE, counting).await;
    let standing = Standing {
        in_memory: app.teaching.in_memory(),
        stored: counted.ok().and_then(|done| done.ok()?.ok()),
        followers: app.teaching.live().followers(),
    };
    match app.metrics.text(&standing) {
        Ok(page) => ([(CONTENT_TYPE, FIGURES)], page).into_response(),
        Err(cause) => PageError(WebError::internal(cause)).into_response(),
    }
}
