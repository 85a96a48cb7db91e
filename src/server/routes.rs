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
    /// What a request costs of its address's budget for costly work. What is bounded in
    /// another way costs nothing: answers, of which each question takes one.
    pub cost: u32,
}

/// What solves, or draws, or reads a whole log.
const SOME: u32 = 1;
/// What begins a session, takes files, or tries a task out.
const MUCH: u32 = 10;

const READ: &[&str] = &["GET"];
const WRITE: &[&str] = &["POST"];
const BOTH: &[&str] = &["GET", "POST"];

const fn route(methods: &'static [&'static str], path: &'static str, may: May) -> Route {
    Route {
        methods,
        path,
        may,
        cost: 0,
    }
}

impl Route {
    const fn costs(self, cost: u32) -> Self {
        Self { cost, ..self }
    }
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
    route(WRITE, "/answer/s/{place}/retractions", May::Invited).costs(SOME),
    route(READ, "/answer/s/{place}/history", May::Invited),
    route(BOTH, "/answer/s/{place}/practice", May::Invited),
    route(READ, "/answer/s/{place}/live", May::Invited),
    route(READ, "/answer/s/{place}/media/{*path}", May::Invited),
    // Their API.
    route(BOTH, "/api/v1/answer/{key}", May::Key),
    route(WRITE, "/api/v1/answer/{key}/retractions", May::Key).costs(SOME),
    // Pages.
    route(READ, "/", May::Owner),
    route(WRITE, "/sessions", May::Owner).costs(MUCH),
    route(READ, "/studio", May::Owner),
    route(WRITE, "/studio", May::Owner).costs(MUCH),
    route(WRITE, "/studio/recordings", May::Owner).costs(MUCH),
    route(READ, "/sessions/{id}", May::Teacher),
    route(WRITE, "/sessions/{id}/answers", May::Teacher),
    route(WRITE, "/sessions/{id}/retractions", May::Teacher).costs(SOME),
    route(WRITE, "/sessions/{id}/changes", May::Teacher).costs(SOME),
    route(WRITE, "/sessions/{id}/bound", May::Teacher).costs(SOME),
    route(WRITE, "/sessions/{id}/again", May::Owner).costs(MUCH),
    route(READ, "/sessions/{id}/history", May::Teacher).costs(SOME),
    route(READ, "/sessions/{id}/why", May::Teacher).costs(SOME),
    route(READ, "/sessions/{id}/live", May::Teacher),
    route(BOTH, "/sessions/{id}/practice", May::Teacher),
    route(READ, "/sessions/{id}/automaton.svg", May::Teacher).costs(SOME),
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
    route(READ, "/api/v1/sessions", May::Owner),
    route(WRITE, "/api/v1/sessions", May::Owner).costs(MUCH),
    route(READ, "/api/v1/sessions/{id}", May::Teacher),
    route(READ, "/api/v1/sessions/{id}/question", May::Teacher),
    route(READ, "/api/v1/sessions/{id}/samples", May::Teacher).costs(SOME),
    route(WRITE, "/api/v1/sessions/{id}/answers", May::Teacher),
    route(WRITE, "/api/v1/sessions/{id}/retractions", May::Teacher).costs(SOME),
    route(WRITE, "/api/v1/sessions/{id}/changes", May::Teacher).costs(SOME),
    route(WRITE, "/api/v1/sessions/{id}/undo", May::Teacher).costs(SOME),
    route(WRITE, "/api/v1/sessions/{id}/bound", May::Teacher).costs(SOME),
    route(READ, "/api/v1/sessions/{id}/automaton", May::Teacher).costs(SOME),
    route(READ, "/api/v1/sessions/{id}/concept", May::Teacher).costs(SOME),
    route(READ, "/api/v1/sessions/{id}/log", May::Teacher).costs(SOME),
    route(READ, "/api/v1/sessions/{id}/live", May::Teacher),
    route(BOTH, "/api/v1/sessions/{id}/people", May::Owner),
    route(WRITE, "/api/v1/sessions/{id}/people/terms", May::Owner),
];

/// The route of this path, as the router writes it, for this method.
///
/// # Errors
///
/// If the table does not have it.
pub(crate) fn find(method: &Method, path: &str) -> Result<&'static Route, WebError> {
    let method = match method.as_str() {
        "HEAD" => "GET",
        other => other,
    };
    let mut known = WebError::NoPage;
    for route in ROUTES.iter().filter(|route| route.path == path) {
        if route.methods.contains(&method) {
            return Ok(route);
        }
        known = WebError::NoMethod;
    }
    Err(known)
}
