//! All routes, and who may use each. What is not in this table is for nobody: a
//! route that is added without a line here answers nothing but 404.

use axum::http::Method;

use super::error::WebError;

/// Who may use a route.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum May {
    /// Everybody: it tells nothing of anybody's.
    Anyone,
    /// Whoever has the key of an invitation, which is in the address.
    Key,
    /// An invited person, by their visit, and at their own place only.
    Invited,
    /// The owner, and whoever has the session to themselves.
    Teacher,
    /// The owner.
    Owner,
}

/// A route.
#[derive(Clone, Copy, Debug)]
pub struct Route {
    /// Its methods: `GET` (with which goes `HEAD`) or `POST`.
    pub methods: &'static [&'static str],
    /// Its path, as the router writes it.
    pub path: &'static str,
    /// Who may use it.
    pub may: May,
}

const READ: &[&str] = &["GET"];
const WRITE: &[&str] = &["POST"];
const BOTH: &[&str] = &["GET", "POST"];

const fn route(methods: &'static [&'static str], path: &'static str, may: May) -> Route {
    Route { methods, path, may }
}

/// All of them.
pub const ROUTES: &[Route] = &[
    route(READ, "/static/{stamp}/{name}", May::Anyone),
    route(READ, "/healthz", May::Anyone),
    // Tells only whoever sits at this machine.
    route(READ, "/metrics", May::Anyone),
    route(READ, "/api/v1/openapi.json", May::Anyone),
    route(BOTH, "/sign-in", May::Anyone),
    route(WRITE, "/sign-out", May::Anyone),
    route(WRITE, "/api/v1/sign-in", May::Anyone),
    route(WRITE, "/api/v1/sign-out", May::Anyone),
    // Pages of invited people.
    route(BOTH, "/answer/{key}", May::Key),
    route(READ, "/answer/s/{place}", May::Invited),
    route(WRITE, "/answer/s/{place}/answers", May::Invited),
    route(WRITE, "/answer/s/{place}/retractions", May::Invited),
    route(READ, "/answer/s/{place}/history", May::Invited),
    route(BOTH, "/answer/s/{place}/practice", May::Invited),
    route(READ, "/answer/s/{place}/live", May::Invited),
    route(READ, "/answer/s/{place}/media/{*path}", May::Invited),
    // Their API.
    route(BOTH, "/api/v1/answer/{key}", May::Key),
    route(WRITE, "/api/v1/answer/{key}/retractions", May::Key),
    // Pages.
    route(READ, "/", May::Owner),
    route(WRITE, "/sessions", May::Owner),
    route(BOTH, "/studio", May::Owner),
    route(WRITE, "/studio/recordings", May::Owner),
    route(READ, "/sessions/{id}", May::Teacher),
    route(WRITE, "/sessions/{id}/answers", May::Teacher),
    route(WRITE, "/sessions/{id}/retractions", May::Teacher),
    route(WRITE, "/sessions/{id}/changes", May::Teacher),
    route(WRITE, "/sessions/{id}/bound", May::Teacher),
    route(WRITE, "/sessions/{id}/again", May::Owner),
    route(READ, "/sessions/{id}/history", May::Teacher),
    route(READ, "/sessions/{id}/why", May::Teacher),
    route(READ, "/sessions/{id}/live", May::Teacher),
    route(BOTH, "/sessions/{id}/practice", May::Teacher),
    route(READ, "/sessions/{id}/automaton.svg", May::Teacher),
    route(READ, "/sessions/{id}/media/{*path}", May::Teacher),
    route(BOTH, "/sessions/{id}/people", May::Owner),
    route(WRITE, "/sessions/{id}/people/terms", May::Owner),
    route(WRITE, "/sessions/{id}/people/{person}/link", May::Owner),
    route(
        WRITE,
        "/sessions/{id}/people/{person}/dismissal",
        May::Owner,
    ),
    // The API.
    route(BOTH, "/api/v1/sessions", May::Owner),
    route(READ, "/api/v1/sessions/{id}", May::Teacher),
    route(READ, "/api/v1/sessions/{id}/question", May::Teacher),
    route(READ, "/api/v1/sessions/{id}/samples", May::Teacher),
    route(WRITE, "/api/v1/sessions/{id}/answers", May::Teacher),
    route(WRITE, "/api/v1/sessions/{id}/retractions", May::Teacher),
    route(WRITE, "/api/v1/sessions/{id}/changes", May::Teacher),
    route(WRITE, "/api/v1/sessions/{id}/undo", May::Teacher),
    route(WRITE, "/api/v1/sessions/{id}/bound", May::Teacher),
    route(READ, "/api/v1/sessions/{id}/automaton", May::Teacher),
    route(READ, "/api/v1/sessions/{id}/concept", May::Teacher),
    route(READ, "/api/v1/sessions/{id}/log", May::Teacher),
    route(READ, "/api/v1/sessions/{id}/live", May::Teacher),
    route(BOTH, "/api/v1/sessions/{id}/people", May::Owner),
    route(WRITE, "/api/v1/sessions/{id}/people/terms", May::Owner),
];

/// Who may use this route with this method.
///
/// # Errors
///
/// If the table does not have them.
pub(crate) fn may(method: &Method, path: &str) -> Result<May, WebError> {
    let route = ROUTES.iter().find(|route| route.path == path);
    let route = route.ok_or(WebError::NoPage)?;
    let method = match method.as_str() {
        "HEAD" => "GET",
        other => other,
    };
    if route.methods.contains(&method) {
        Ok(route.may)
    } else {
        Err(WebError::NoMethod)
    }
}
