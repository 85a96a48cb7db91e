//! Who may come in: the owner by a password, invited people by their links, everybody
//! else not at all. Must not know what the pages show.

mod budgets;
mod cookie;
mod origin;
mod password;
mod sign_in;

use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant, SystemTime};

use axum::extract::{MatchedPath, Request, State};
use axum::http::header::{AUTHORIZATION, HOST, SET_COOKIE};
use axum::http::{HeaderMap, HeaderValue, Method};
use axum::middleware::Next;
use axum::response::{IntoResponse, Redirect, Response};
use tokio::sync::Semaphore;

use super::AppState;
use super::error::WebError;
use super::guard;
use super::routes::{self, May};
use crate::session::Session;
use crate::store::{SessionId, Store, StoreError, VisitKey, Visitor};
use budgets::Budgets;
use cookie::Cookie;

pub use origin::{NoOrigin, Origin};
pub use password::{BadPassword, hash as hash_password};
pub(crate) use sign_in::{api_routes, routes};

/// How long a visit may last, in seconds.
#[derive(Clone, Copy)]
struct Length {
    idle: u64,
    whole: u64,
}

const OWNERS: Length = Length {
    idle: 3600,
    whole: 24 * 3600,
};
const INVITED: Length = Length {
    idle: 12 * 3600,
    whole: 30 * 24 * 3600,
};

/// A visit that goes on is written down so often at most, in seconds.
const SEEN_EVERY: u64 = 60;
/// How long it may take until a password that another process set is heeded.
const RECALL: Duration = Duration::from_secs(1);
/// So many sign-ins are checked at the same time: each takes 19 MiB.
const CHECKS: usize = 2;

/// How the server is reached, and by whom.
#[derive(Clone, Debug, Default)]
pub struct Reached {
    /// The addresses under which people know it, besides those of this machine.
    pub origins: Vec<Origin>,
    /// Whether a proxy says for whom it asks, in `X-Forwarded-For`.
    pub behind_proxy: bool,
    /// Whether other machines can reach it: then nobody comes in without a password.
    pub is_public: bool,
}

/// The door of a site.
pub(crate) struct Door {
    reached: Reached,
    /// Whether there is a password, and when that was looked up.
    locked: Mutex<Option<(Instant, bool)>>,
    checks: Semaphore,
    budgets: Budgets,
}

impl Door {
    pub(crate) fn new(reached: Reached) -> Self {
        Self {
            budgets: Budgets::new(reached.behind_proxy),
            reached,
            locked: Mutex::new(None),
            checks: Semaphore::new(CHECKS),
        }
    }

    /// Whether a `Host` header means this server by one of its addresses.
    pub(crate) fn answers_to(&self, host: &str) -> bool {
        guard::is_own(host) || self.reached.origins.iter().any(|one| one.is_meant_by(host))
    }

    /// The whole address of a path, as people reach it, if that was said: the first of
    /// several counts.
    pub(crate) fn whole(&self, path: &str) -> Option<String> {
        let origin = self.reached.origins.first()?;
        Some(format!("{origin}{path}"))
    }

    /// Whether any of its addresses is one with TLS.
    pub(crate) fn has_tls(&self) -> bool {
        self.reached.origins.iter().any(Origin::is_secure)
    }

    /// Whether the request came to an address with TLS.
    fn is_secure(&self, headers: &HeaderMap) -> bool {
        let host = headers.get(HOST).and_then(|host| host.to_str().ok());
        let mut origins = self.reached.origins.iter();
        origins.any(|one| one.is_secure() && host.is_some_and(|host| one.is_meant_by(host)))
    }

    /// Whether there is a password, as of a moment ago.
    async fn is_locked(&self, app: &AppState) -> Result<bool, WebError> {
        let known = *self.locked.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((at, locked)) = known
            && at.elapsed() < RECALL
        {
            return Ok(locked);
        }
        let locked = ask(app, |store| store.visits().password()).await?.is_some();
        let mut known = self.locked.lock().unwrap_or_else(PoisonError::into_inner);
        *known = Some((Instant::now(), locked));
        Ok(locked)
    }
}

/// What the store says.
async fn ask<T: Send + 'static>(
    app: &AppState,
    question: impl FnOnce(&dyn Store) -> Result<T, StoreError> + Send + 'static,
) -> Result<T, WebError> {
    let store = app.teaching.store();
    let asked = tokio::task::spawn_blocking(move || question(&*store));
    let answer = asked.await.map_err(WebError::internal)?;
    answer.map_err(WebError::internal)
}

/// Seconds since 1970.
fn now() -> u64 {
    let since = SystemTime::now().duration_since(SystemTime::UNIX_EPOCH);
    since.map_or(0, |since| since.as_secs())
}

/// Why somebody is looked at.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Look {
    /// They ask for something, which is a sign of life.
    Asked,
    /// To see whether they may stay.
    Glance,
}

/// Whose visit has this key, if it goes on; that somebody asked is written down.
async fn visitor(app: &AppState, key: VisitKey, look: Look) -> Result<Option<Visitor>, WebError> {
    ask(app, move |store| {
        let (visits, digest, now) = (store.visits(), key.digest(), now());
        let Some(visit) = visits.visit(&digest)? else {
            return Ok(None);
        };
        let length = match visit.visitor {
            Visitor::Owner => OWNERS,
            Visitor::Invited { .. } => INVITED,
        };
        let idle = now.saturating_sub(visit.seen);
        if idle >= length.idle || now.saturating_sub(visit.begun) >= length.whole {
            // What cannot be noted on a full disk is not to keep anybody from looking.
            noted(visits.end_visit(&digest));
            return Ok(None);
        }
        if look == Look::Asked && idle >= SEEN_EVERY {
            noted(visits.see_visit(&digest, now));
        }
        Ok(Some(visit.visitor))
    })
    .await
}

/// Tells the log if something about a visit could not be noted.
fn noted(result: Result<(), StoreError>) {
    if let Err(cause) = result {
        tracing::warn!(%cause, "a visit could not be noted");
    }
}

/// The key that a request shows as the owner's: a browser's cookie, or a script's
/// `Authorization: Bearer`.
fn owners_key(app: &AppState, headers: &HeaderMap) -> Option<VisitKey> {
    let bearer = headers
        .get(AUTHORIZATION)
        .and_then(|value| value.to_str().ok());
    if let Some(bearer) = bearer {
        let (scheme, key) = bearer.split_once(' ')?;
        return scheme
            .eq_ignore_ascii_case("bearer")
            .then(|| key.trim().parse().ok())?;
    }
    let is_secure = app.door.is_secure(headers);
    Cookie {
        place: None,
        is_secure,
    }
    .read(headers)
}

/// How somebody stands to the owner's pages.
enum Stands {
    In,
    Out,
    /// Nobody can be in: there is no password, and other machines reach the server.
    Unlocked,
}

async fn stands(app: &AppState, headers: &HeaderMap, look: Look) -> Result<Stands, WebError> {
    if !app.door.is_locked(app).await? {
        return Ok(if app.door.reached.is_public {
            Stands::Unlocked
        } else {
            Stands::In
        });
    }
    let owner = match owners_key(app, headers) {
        Some(key) => visitor(app, key, look).await? == Some(Visitor::Owner),
        None => false,
    };
    Ok(if owner { Stands::In } else { Stands::Out })
}

/// Whether one of the browser's invitations gives this session to its person alone.
async fn teaches_alone(
    app: &AppState,
    headers: &HeaderMap,
    path: &str,
    look: Look,
) -> Result<bool, WebError> {
    let mut parts = path.split('/').skip_while(|part| *part != "sessions");
    let id: Option<SessionId> = parts.nth(1).and_then(|id| id.parse().ok());
    let Some(id) = id.map(|id| id.to_string()) else {
        return Ok(false);
    };
    for key in cookie::invited(headers, app.door.is_secure(headers)) {
        let Some(Visitor::Invited {
            session, person, ..
        }) = visitor(app, key, look).await?
        else {
            continue;
        };
        let id = id.clone();
        let view = move |session: &Session| {
            let known = session.panel().people().get(&person);
            known.is_some_and(|known| !known.left && known.session == Some(id))
        };
        if app.teaching.look(session, view).await? {
            return Ok(true);
        }
    }
    Ok(false)
}

/// Lets through whom the [table of routes](routes) lets. What is not in the table is
/// for nobody.
pub(crate) async fn admit(State(app): State<AppState>, request: Request, next: Next) -> Response {
    let path = request.uri().path().to_owned();
    let Some(route) = request.extensions().get::<MatchedPath>() else {
        // Nothing is there: the handler for that says so.
        return next.run(request).await;
    };
    let route = match routes::find(request.method(), route.as_str()) {
        Ok(route) => route,
        Err(error) => return guard::refuse(&path, error),
    };
    let headers = request.headers();
    let admitted = match route.may {
        // The handler looks at what they hold.
        May::Anyone | May::Key | May::Invited => Ok(()),
        may => comes_in(&app, headers, &path, may, Look::Asked).await,
    };
    let admitted = admitted.map_err(|error| match error {
        // Nothing of what came was looked at.
        WebError::Slow | WebError::Waiting if request.method() != Method::GET => WebError::Unheard,
        error => error,
    });
    let budgets = &app.door.budgets;
    match admitted.and_then(|()| budgets.spend(budgets.whence(&request), route.cost)) {
        Ok(()) => next.run(request).await,
        Err(WebError::SignIn) if !guard::is_api(&path) => to_sign_in(request.method(), &request),
        Err(error) => guard::refuse(&path, error),
    }
}

/// Whether whoever asks is the owner, or has the session of this path to themselves
/// where that is enough.
async fn comes_in(
    app: &AppState,
    headers: &HeaderMap,
    path: &str,
    may: May,
    look: Look,
) -> Result<(), WebError> {
    match stands(app, headers, look).await? {
        Stands::In => Ok(()),
        Stands::Unlocked => Err(WebError::NoPassword),
        Stands::Out if may == May::Teacher && teaches_alone(app, headers, path, look).await? => {
            Ok(())
        }
        Stands::Out => Err(WebError::SignIn),
    }
}

/// Whether somebody who follows this session by their visit as its teacher, or at this
/// place as one who is invited, may go on: their visit may have ended meanwhile.
pub(crate) async fn stays(app: &AppState, headers: &HeaderMap, at: &Seat) -> bool {
    let stays = match at {
        Seat::Teacher { session } => {
            let path = format!("/sessions/{session}");
            comes_in(app, headers, &path, May::Teacher, Look::Glance).await
        }
        Seat::Invited { place } => guest(app, headers, place, Look::Glance).await.map(|_| ()),
    };
    stays.is_ok()
}

/// From where somebody follows a session.
pub(crate) enum Seat {
    /// Its own pages.
    Teacher {
        /// Which session.
        session: SessionId,
    },
    /// An invited person's pages.
    Invited {
        /// Where these are.
        place: String,
    },
}

/// Leads to the page for signing in, and back to where a form was rather than to where
/// it was sent.
fn to_sign_in(method: &Method, request: &Request) -> Response {
    let path = request.uri().path();
    let back = if *method == Method::GET {
        request
            .uri()
            .path_and_query()
            .map_or(path, |whole| whole.as_str())
    } else {
        match path.match_indices('/').nth(2) {
            Some((end, _)) => &path[..end],
            None => "/",
        }
    };
    Redirect::to(&sign_in::address(back)).into_response()
}

/// A visit that begins: its key, and the header that has the browser keep it.
async fn begin(
    app: &AppState,
    headers: &HeaderMap,
    place: Option<&str>,
    invite: Option<String>,
) -> Result<(VisitKey, Option<HeaderValue>), WebError> {
    let cookie = Cookie {
        place,
        is_secure: app.door.is_secure(headers),
    };
    let length = if invite.is_some() { INVITED } else { OWNERS };
    let key = VisitKey::random().map_err(WebError::internal)?;
    let before = cookie.read(headers);
    ask(app, move |store| {
        let (visits, now) = (store.visits(), now());
        if let Some(before) = before {
            visits.end_visit(&before.digest())?;
        }
        visits.forget_visits(now.saturating_sub(INVITED.whole))?;
        visits.begin_visit(&key.digest(), invite.as_deref(), now)
    })
    .await?;
    Ok((key, cookie.keep(&key, length.whole)))
}

/// Lets whoever has the invitation of this digest in at this place: the answer, with
/// the cookie by which they go on.
///
/// # Errors
///
/// If the store fails.
pub(crate) async fn let_in(
    app: &AppState,
    headers: &HeaderMap,
    place: &str,
    invite: String,
    mut answer: Response,
) -> Result<Response, WebError> {
    let (_, kept) = begin(app, headers, Some(place), Some(invite)).await?;
    let kept = kept.ok_or_else(|| WebError::internal("the cookie cannot be written"))?;
    answer.headers_mut().insert(SET_COOKIE, kept);
    Ok(answer)
}

/// To which session, and as whom, this browser is invited at this place.
///
/// # Errors
///
/// If it is not, or not any more.
pub(crate) async fn invited(
    app: &AppState,
    headers: &HeaderMap,
    place: &str,
) -> Result<(SessionId, u32), WebError> {
    guest(app, headers, place, Look::Asked).await
}

async fn guest(
    app: &AppState,
    headers: &HeaderMap,
    place: &str,
    look: Look,
) -> Result<(SessionId, u32), WebError> {
    let cookie = Cookie {
        place: Some(place),
        is_secure: app.door.is_secure(headers),
    };
    let key = cookie.read(headers).ok_or(WebError::NotInvited)?;
    match visitor(app, key, look).await? {
        // A key is for the place for which it was given.
        Some(Visitor::Invited {
            invite,
            session,
            person,
        }) if invite.starts_with(place) => Ok((session, person)),
        _ => Err(WebError::NotInvited),
    }
}

/// Whether links are to lead through the door: whoever teaches alone needs a
/// capability for that only where there is a lock.
///
/// # Errors
///
/// If the store fails.
pub(crate) async fn is_locked(app: &AppState) -> Result<bool, WebError> {
    Ok(app.door.reached.is_public || app.door.is_locked(app).await?)
}

/// Shared by all requests.
pub(crate) type SharedDoor = Arc<Door>;
