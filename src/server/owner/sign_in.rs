//! Signing in and out, by page and by script.

use askama::Template;
use axum::body::Bytes;
use axum::extract::{Form as FormBody, FromRequest, Query, Request, State};
use axum::http::header::SET_COOKIE;
use axum::http::{HeaderMap, HeaderValue, StatusCode};
use axum::response::{IntoResponse, Redirect, Response};
use axum::routing::{get, post};
use axum::{Json, Router};
use percent_encoding::{AsciiSet, NON_ALPHANUMERIC, utf8_percent_encode};
use serde_json::{Value, json};

use super::budgets::Whence;
use super::cookie::Cookie;
use super::{Look, OWNERS, Stands, begin, password};
use crate::server::AppState;
use crate::server::api::{Body, read_body};
use crate::server::error::{ApiError, PageError, WebError};
use crate::server::pages::read_form;
use crate::server::views::{Shell, render};
use crate::session::{Fields, Malformed};
use crate::store::VisitKey;

/// The pages.
pub(crate) fn routes() -> Router<AppState> {
    Router::new()
        .route("/sign-in", get(show).post(sign_in))
        .route("/sign-out", post(sign_out))
}

/// The same for scripts, relative to `/api/v1`.
pub(crate) fn api_routes() -> Router<AppState> {
    Router::new()
        .route("/sign-in", post(give_key))
        .route("/sign-out", post(end_key))
}

#[derive(Template)]
#[template(path = "sign_in.html")]
struct SignInPage {
    shell: Shell,
    /// Where to go on.
    to: String,
    fault: Option<String>,
}

fn page(to: String, fault: Option<String>) -> Response {
    render(&SignInPage {
        shell: Shell::plain("Sign in"),
        to,
        fault,
    })
}

/// The address of the page that leads on to `back`.
pub(super) fn address(back: &str) -> String {
    format!("/sign-in?to={}", utf8_percent_encode(back, PLAIN_PATH))
}

/// What stands for something else in an address: all but what paths are made of.
const PLAIN_PATH: &AsciiSet = &NON_ALPHANUMERIC
    .remove(b'/')
    .remove(b'-')
    .remove(b'.')
    .remove(b'_');

/// The path to go on to, if it is one of this site's pages: never another site's, which
/// browsers also see in `//host` and `/\host`.
fn local(to: &str) -> &str {
    let plain = |c: char| c.is_ascii_graphic() && c != '\\';
    let is_local = to.starts_with('/')
        && !to.starts_with("//")
        && to.chars().all(plain)
        && !to.starts_with("/sign-");
    if is_local { to } else { "/" }
}

fn named(pairs: &[(String, String)], name: &str) -> String {
    let found = pairs.iter().find(|(key, _)| key == name);
    found.map_or(String::new(), |(_, value)| value.clone())
}

async fn show(
    State(app): State<AppState>,
    Query(query): Query<Vec<(String, String)>>,
    headers: HeaderMap,
) -> Result<Response, PageError> {
    let to = named(&query, "to");
    let to = local(&to);
    match super::stands(&app, &headers, Look::Asked).await? {
        Stands::In => Ok(Redirect::to(to).into_response()),
        Stands::Out => Ok(page(to.to_owned(), None)),
        Stands::Unlocked => Err(WebError::NoPassword.into()),
    }
}

/// Begins a visit if the password is right.
async fn enter(
    app: &AppState,
    headers: &HeaderMap,
    from: Whence,
    given: String,
) -> Result<(VisitKey, Option<HeaderValue>), WebError> {
    app.door.budgets.spend_try(from)?;
    let kept = super::ask(app, |store| store.visits().password()).await?;
    let kept = kept.ok_or(WebError::NoPassword)?;
    let hash = kept.clone();
    let turn = app
        .door
        .checks
        .acquire()
        .await
        .map_err(WebError::internal)?;
    let right = tokio::task::spawn_blocking(move || password::is_right(&given, &kept));
    let right = right.await.map_err(WebError::internal)?;
    drop(turn);
    if !right {
        tracing::warn!(from = %from.address, "a sign-in failed");
        return Err(WebError::WrongPassword);
    }
    tracing::info!(from = %from.address, "the owner signed in");
    app.door.budgets.welcome(from);
    let begun = begin(app, headers, None, None).await?;
    // Another password ends all visits, also one that began while it was set.
    let digest = begun.0.digest();
    let ended = super::ask(app, move |store| {
        let visits = store.visits();
        let is_old = visits.password()?.as_ref() != Some(&hash);
        if is_old {
            visits.end_visit(&digest)?;
        }
        Ok(is_old)
    });
    if ended.await? {
        return Err(WebError::WrongPassword);
    }
    Ok(begun)
}

async fn sign_in(State(app): State<AppState>, request: Request) -> Result<Response, PageError> {
    let from = app.door.budgets.whence(&request);
    let headers = request.headers().clone();
    let fields = FormBody::<Vec<(String, String)>>::from_request(request, &()).await;
    let form = read_form(fields)?;
    let to = local(form.text("to")).to_owned();
    match enter(&app, &headers, from, form.text("password").to_owned()).await {
        Ok((_, kept)) => {
            let kept = kept.ok_or_else(|| WebError::internal("the cookie cannot be written"))?;
            let mut answer = Redirect::to(&to).into_response();
            answer.headers_mut().insert(SET_COOKIE, kept);
            Ok(answer)
        }
        Err(error @ WebError::WrongPassword) => {
            Ok((error.status(), page(to, Some(error.message()))).into_response())
        }
        Err(error) => Err(error.into()),
    }
}

/// Ends the visit of whoever asks.
async fn leave(app: &AppState, headers: &HeaderMap) -> Result<(), WebError> {
    if let Some(key) = super::owners_key(app, headers) {
        super::ask(app, move |store| store.visits().end_visit(&key.digest())).await?;
        tracing::info!("a visit was ended");
    }
    Ok(())
}

async fn sign_out(State(app): State<AppState>, headers: HeaderMap) -> Result<Response, PageError> {
    leave(&app, &headers).await?;
    let is_secure = app.door.is_secure(&headers);
    let mut answer = Redirect::to("/sign-in").into_response();
    if let Some(forgotten) = (Cookie {
        place: None,
        is_secure,
    })
    .forget()
    {
        answer.headers_mut().insert(SET_COOKIE, forgotten);
    }
    // Pictures and films were to be kept by the browser.
    let cache = HeaderValue::from_static("\"cache\"");
    answer.headers_mut().insert("clear-site-data", cache);
    Ok(answer)
}

async fn give_key(State(app): State<AppState>, request: Request) -> Result<Response, ApiError> {
    let from = app.door.budgets.whence(&request);
    let headers = request.headers().clone();
    let body: Body = Bytes::from_request(request, &()).await;
    let body = read_body(body)?;
    let fields = Fields::of(&body, "")?;
    fields.only(&["password"])?;
    let given = fields.get("password").and_then(Value::as_str);
    let given = given.ok_or_else(|| Malformed::new("password", "give the owner's password"))?;
    let (key, _) = enter(&app, &headers, from, given.to_owned()).await?;
    let expires = super::now() + OWNERS.whole;
    let given = json!({"token": key.to_string(), "expires": expires, "idle": OWNERS.idle});
    Ok((StatusCode::CREATED, Json(given)).into_response())
}

async fn end_key(State(app): State<AppState>, headers: HeaderMap) -> Result<Response, ApiError> {
    leave(&app, &headers).await?;
    Ok(Json(json!({})).into_response())
}

#[cfg(test)]
mod tests {
    use super::{address, local};

    #[test]
    fn nobody_is_sent_to_another_site() {
        for own in ["/", "/sessions/ab?trace=0,1", "/studio"] {
            assert_eq!(local(own), own);
        }
        for other in [
            "",
            "//evil.example",
            "/\\evil.example",
            "https://evil.example",
            "javascript:alert(1)",
            "evil",
            "/a\nb",
            "/\t/evil.example",
            "/sign-in",
            "/\u{202e}",
        ] {
            assert_eq!(local(other), "/", "{other:?}");
        }
        assert_eq!(address("/a?b=c&d"), "/sign-in?to=/a%3Fb%3Dc%26d");
    }
}
