//! What can go wrong with a request: one type, shown as JSON by the API and as
//! a page by the pages.

use std::error::Error;
use std::io;
use std::time::Duration;

use axum::Json;
use axum::http::header::{RETRY_AFTER, WWW_AUTHENTICATE};
use axum::http::{HeaderValue, StatusCode};
use axum::response::{IntoResponse, Response};
use serde_json::{Value, json};
use tower_http::timeout::TimeoutError;

use super::observe;
use super::upload::{RECORDINGS, UPLOAD_LIMIT};
use super::views;
use crate::session::{Corrupt, Malformed, Refusal};
use crate::store::StoreError;

/// Why a request was not granted. The cause of an internal error is logged and
/// not sent.
#[derive(Debug)]
pub(crate) enum WebError {
    /// No such page.
    NoPage,
    /// The page exists, but not for this method.
    NoMethod,
    /// No session of this name.
    NoSession,
    /// Nobody answers with this key.
    NotInvited,
    /// The session does not grant it now.
    Refused(Refusal),
    /// The request's content is wrong.
    Malformed(Malformed),
    /// The request's body is no JSON, or no form.
    Unreadable(String),
    /// The request's body is too large.
    TooLarge,
    /// The files that came are too large.
    UploadTooLarge,
    /// The request's body came too slowly.
    Late,
    /// The request came from another site.
    Foreign,
    /// Only the owner may have this.
    SignIn,
    /// It is not the owner's password.
    WrongPassword,
    /// Nobody can sign in, and others can reach the server.
    NoPassword,
    /// Too much was asked; in so long there may be more.
    TooMany(Duration),
    /// Many addresses try to sign in; in so long another may.
    Besieged(Duration),
    /// No automaton is on show at the moment.
    NoAutomaton,
    /// The session learns no automaton.
    NotAnAutomaton,
    /// The automaton is too large for this form.
    TooLargeToShow(String),
    /// The learner is still at work.
    Slow,
    /// What was sent waits for its turn: it is not kept yet.
    Waiting,
    /// What was sent was not looked at, because who sent it could not be told soon
    /// enough.
    Unheard,
    /// There is no room for what was to be kept.
    Full(String),
    /// The store is elsewhere, and does not answer.
    Away(String),
    /// The session's log cannot be read.
    Corrupt(Corrupt),
    /// Something that should not happen.
    Internal(Box<dyn Error + Send + Sync>),
}

impl WebError {
    /// Something that should not happen; but what the store and the disk say of
    /// themselves is told for what it is.
    pub(crate) fn internal(error: impl Into<Box<dyn Error + Send + Sync>>) -> Self {
        let error = error.into();
        match error.downcast_ref::<StoreError>() {
            Some(StoreError::Full { message }) => return Self::Full(message.clone()),
            Some(StoreError::Away { message }) => return Self::Away(message.clone()),
            Some(StoreError::Unread { error, .. }) if has_no_room(error) => {
                return Self::Full(error.to_string());
            }
            _ => {}
        }
        match error.downcast_ref::<io::Error>() {
            Some(met) if has_no_room(met) => Self::Full(met.to_string()),
            _ => Self::Internal(error),
        }
    }

    /// Why a body could not be read, of which all else has this message.
    pub(crate) fn unread(cause: &(dyn Error + 'static), message: impl Into<String>) -> Self {
        let mut next = Some(cause);
        while let Some(cause) = next {
            if cause.is::<TimeoutError>() {
                return Self::Late;
            }
            next = cause.source();
        }
        Self::Unreadable(message.into())
    }

    /// Whether the session is as it was.
    pub(crate) fn is_refusal(&self) -> bool {
        matches!(self, Self::Refused(_) | Self::Malformed(_))
    }

    pub(crate) fn status(&self) -> StatusCode {
        match self {
            Self::NoPage
            | Self::NoSession
            | Self::NotInvited
            | Self::Refused(Refusal::Unknown { .. }) => StatusCode::NOT_FOUND,
            Self::NoMethod => StatusCode::METHOD_NOT_ALLOWED,
            Self::Refused(
                Refusal::Unfit { .. }
                | Refusal::NoCounterexample { .. }
                | Refusal::Infeasible { .. }
                | Refusal::Looked { .. }
                | Refusal::Settled { .. }
                | Refusal::NoBound
                | Refusal::BadAnswers
                | Refusal::BadName
                | Refusal::UnshownName
                | Refusal::OwnersAnswer
                | Refusal::BadBound { .. },
            )
            | Self::Malformed(_) => StatusCode::UNPROCESSABLE_ENTITY,
            Self::Refused(_)
            | Self::NoAutomaton
            | Self::NotAnAutomaton
            | Self::TooLargeToShow(_) => StatusCode::CONFLICT,
            Self::Unreadable(_) => StatusCode::BAD_REQUEST,
            Self::TooLarge | Self::UploadTooLarge => StatusCode::PAYLOAD_TOO_LARGE,
            Self::Late => StatusCode::REQUEST_TIMEOUT,
            Self::Foreign | Self::NoPassword => StatusCode::FORBIDDEN,
            Self::SignIn | Self::WrongPassword => StatusCode::UNAUTHORIZED,
            Self::TooMany(_) | Self::Besieged(_) => StatusCode::TOO_MANY_REQUESTS,
            Self::Slow | Self::Waiting | Self::Unheard | Self::Away(_) => {
                StatusCode::SERVICE_UNAVAILABLE
            }
            Self::Full(_) => StatusCode::INSUFFICIENT_STORAGE,
            Self::Corrupt(_) | Self::Internal(_) => StatusCode::INTERNAL_SERVER_ERROR,
        }
    }

    /// A stable name for programs.
    fn code(&self) -> &'static str {
        match self {
            Self::NoPage => "not_found",
            Self::NoMethod => "method_not_allowed",
            Self::NoSession => "no_such_session",
            Self::NotInvited => "not_invited",
            Self::Refused(refusal) => match refusal {
                Refusal::Closed { .. } => "question_closed",
                Refusal::Unknown { .. } => "no_such_question",
                Refusal::NotStanding { .. } => "no_standing_answer",
                Refusal::Unfit { .. } => "answer_does_not_fit",
                Refusal::NoCounterexample { .. } => "no_counterexample",
                Refusal::Infeasible { .. } => "infeasible",
                Refusal::Looked { .. } => "looked_at_others",
                Refusal::Settled { .. } => "settled_beforehand",
                Refusal::Outdated { .. } => "hypothesis_outdated",
                Refusal::NothingToUndo => "nothing_to_undo",
                Refusal::NoBound => "no_bound",
                Refusal::BadBound { .. } => "bad_bound",
                Refusal::BadAnswers => "bad_answers",
                Refusal::BadName | Refusal::UnshownName => "bad_name",
                Refusal::TooManyPeople => "too_many_people",
                Refusal::NoPerson => "not_invited",
                Refusal::Dismissed => "dismissed",
                Refusal::Said { .. } => "already_answered",
                Refusal::OwnersAnswer => "owners_answer",
            },
            Self::Malformed(_) => "malformed",
            Self::Unreadable(_) => "unreadable_body",
            Self::TooLarge | Self::UploadTooLarge => "body_too_large",
            Self::Late => "body_too_slow",
            Self::Foreign => "cross_site",
            Self::SignIn => "sign_in",
            Self::WrongPassword => "wrong_password",
            Self::NoPassword => "no_password",
            Self::TooMany(_) | Self::Besieged(_) => "too_many_requests",
            Self::NoAutomaton => "no_automaton",
            Self::NotAnAutomaton => "not_an_automaton",
            Self::TooLargeToShow(_) => "automaton_too_large",
            Self::Slow => "still_thinking",
            Self::Waiting => "not_taken_yet",
            Self::Unheard => "not_taken",
            Self::Full(_) => "disk_full",
            Self::Away(_) => "store_unreachable",
            Self::Corrupt(_) => "log_unreadable",
            Self::Internal(_) => "internal",
        }
    }

    /// The part of the request that is meant.
    pub(crate) fn field(&self) -> Option<&str> {
        match self {
            Self::Malformed(malformed) if !malformed.path.is_empty() => Some(&malformed.path),
            Self::Refused(refusal) => match refusal {
                Refusal::Closed { .. }
                | Refusal::Unknown { .. }
                | Refusal::NotStanding { .. }
                | Refusal::Said { .. } => Some("question"),
                Refusal::Unfit { .. } | Refusal::Outdated { .. } => Some("answer"),
                Refusal::NoCounterexample { .. } => Some("label"),
                Refusal::Infeasible { .. } | Refusal::Settled { .. } => Some("word"),
                Refusal::Looked { .. } => Some("looked"),
                Refusal::BadBound { .. } => Some("max_states"),
                Refusal::BadAnswers => Some("answers"),
                Refusal::BadName | Refusal::UnshownName | Refusal::TooManyPeople => Some("name"),
                Refusal::NothingToUndo
                | Refusal::NoBound
                | Refusal::NoPerson
                | Refusal::Dismissed
                | Refusal::OwnersAnswer => None,
            },
            Self::UploadTooLarge => Some(RECORDINGS),
            _ => None,
        }
    }

    /// What happened and what to do, for people.
    pub(crate) fn message(&self) -> String {
        match self {
            Self::NoPage => "There is nothing at this address: begin at the start page.".to_owned(),
            Self::NoMethod => "This address does not take such a request.".to_owned(),
            Self::NoSession => {
                "There is no such session here: check the address, or begin a new one.".to_owned()
            }
            Self::NotInvited => {
                "This link does not answer here, or not any more: ask whoever sent it for a new one."
                    .to_owned()
            }
            Self::Refused(refusal) => sentence(&refusal.to_string()),
            Self::Malformed(malformed) => sentence(&malformed.message),
            Self::Unreadable(message) | Self::TooLargeToShow(message) => sentence(message),
            Self::TooLarge => "The request is too large: send less at once.".to_owned(),
            Self::UploadTooLarge => format!(
                "The files have more than {} MiB in all: leave recordings out, or make their pictures and films smaller.",
                UPLOAD_LIMIT >> 20
            ),
            Self::Late => "The request took too long to arrive, and nothing of it was kept: send it again, or less at once.".to_owned(),
            Self::Foreign => {
                "The request came from another site, so nothing was done: use this site's own pages."
                    .to_owned()
            }
            Self::SignIn => "Only the owner of this server may have this: sign in, by `POST /api/v1/sign-in` with the password, and send the token as `Authorization: Bearer`.".to_owned(),
            Self::WrongPassword => "That is not the password: try again.".to_owned(),
            Self::NoPassword => "Other machines can reach this server, and it has no owner's password yet: set one with `memrep password`.".to_owned(),
            Self::TooMany(wait) => format!("That was too much in a short time, so it was not done: try again in {} seconds.", whole_seconds(*wait)),
            Self::Besieged(wait) => format!("Too many addresses try to sign in at the moment: try again in {} seconds, from where you signed in before, or at the machine itself (ssh -L 8080:127.0.0.1:8080 HOST).", whole_seconds(*wait)),
            Self::NoAutomaton => {
                "No rule is on show at the moment: go on answering, or mend the answers that contradict each other, until one is.".to_owned()
            }
            Self::NotAnAutomaton => {
                "This session learns no automaton: take its rule from `/concept`.".to_owned()
            }
            Self::Slow => {
                "The next question is still being worked out: many rules fit what was said, and they are compared. Your answers are kept: ask again in a moment."
                    .to_owned()
            }
            Self::Waiting => {
                "What you sent waits for its turn: what was sent to this session before is still being thought about, or the disk is slow. Send it again in a moment: it will count once."
                    .to_owned()
            }
            Self::Unheard => {
                "What you just sent was not taken: the session by which you were invited is busy. Send it again in a moment."
                    .to_owned()
            }
            Self::Full(_) => {
                "The disk on which the answers are kept is full, so that what you just sent was not kept. Free space on it, then send it again: it will count once. What was kept before is safe."
                    .to_owned()
            }
            Self::Away(_) => {
                "The database in which the answers are kept cannot be reached, so that what you just sent may not have been kept. Send it again in a moment: it will count once. What was kept before is safe."
                    .to_owned()
            }
            Self::Corrupt(corrupt) => sentence(&format!(
                "{corrupt}; nothing was changed, use the memrep that wrote this session"
            )),
            Self::Internal(_) => {
                "Something went wrong in memrep, not with your request. Answers that were accepted are kept: try again, and if it stays, look at the server's output."
                    .to_owned()
            }
        }
    }

    /// The name under which the log has the cause; none where the message says all.
    pub(crate) fn told_by(&self) -> Option<String> {
        let is_ours = self.status() == StatusCode::INTERNAL_SERVER_ERROR;
        is_ours.then(observe::request_id).flatten()
    }

    pub(crate) fn log(&self) {
        match self {
            Self::Internal(cause) => tracing::error!(%cause, "request failed"),
            Self::Full(cause) => tracing::error!(%cause, "no room to keep what was sent"),
            Self::Away(cause) => tracing::error!(%cause, "the store cannot be reached"),
            Self::Corrupt(cause) => tracing::error!(%cause, "log unreadable"),
            Self::Slow => tracing::warn!("a question takes long"),
            Self::Waiting => tracing::warn!("what was sent waits for its turn"),
            _ => {}
        }
    }
}

/// The seconds to wait, as a header has them.
fn whole_seconds(wait: Duration) -> u64 {
    wait.as_secs() + u64::from(wait.subsec_nanos() > 0)
}

/// Whether a file could not grow.
fn has_no_room(error: &io::Error) -> bool {
    use io::ErrorKind::{FileTooLarge, QuotaExceeded, StorageFull};
    matches!(error.kind(), StorageFull | QuotaExceeded | FileTooLarge)
}

/// The same with a capital letter and a full stop.
pub(crate) fn sentence(text: &str) -> String {
    let mut chars = text.chars();
    let Some(first) = chars.next() else {
        return String::new();
    };
    let mut sentence: String = first.to_uppercase().chain(chars).collect();
    if !sentence.ends_with(['.', '?', '!']) {
        sentence.push('.');
    }
    sentence
}

/// An error as the API shows it.
pub(crate) struct ApiError(pub(crate) WebError);

/// An error as the pages show it.
pub(crate) struct PageError(pub(crate) WebError);

impl<E: Into<WebError>> From<E> for ApiError {
    fn from(error: E) -> Self {
        Self(error.into())
    }
}

impl<E: Into<WebError>> From<E> for PageError {
    fn from(error: E) -> Self {
        Self(error.into())
    }
}

impl From<Refusal> for WebError {
    fn from(refusal: Refusal) -> Self {
        Self::Refused(refusal)
    }
}

impl From<Malformed> for WebError {
    fn from(malformed: Malformed) -> Self {
        Self::Malformed(malformed)
    }
}

impl ApiError {
    /// The error with what was learned beside it, under this key.
    pub(crate) fn beside(self, key: &str, value: &Value) -> Response {
        self.respond(json!({ key: value }))
    }

    fn respond(self, mut body: Value) -> Response {
        self.0.log();
        let mut error = json!({"code": self.0.code(), "message": self.0.message()});
        if let Some(field) = self.0.field() {
            error["field"] = field.into();
        }
        if let Some(id) = self.0.told_by() {
            error["request"] = id.into();
        }
        body["error"] = error;
        let mut response = (self.0.status(), Json(body)).into_response();
        let headers = response.headers_mut();
        match self.0 {
            WebError::Slow | WebError::Waiting | WebError::Unheard => {
                headers.insert(RETRY_AFTER, HeaderValue::from_static("1"));
            }
            WebError::Away(_) => {
                headers.insert(RETRY_AFTER, HeaderValue::from_static("2"));
            }
            WebError::TooMany(wait) | WebError::Besieged(wait) => {
                headers.insert(RETRY_AFTER, whole_seconds(wait).into());
            }
            WebError::SignIn => {
                headers.insert(WWW_AUTHENTICATE, HeaderValue::from_static("Bearer"));
            }
            _ => {}
        }
        response
    }
}

impl IntoResponse for ApiError {
    fn into_response(self) -> Response {
        self.respond(json!({}))
    }
}

impl IntoResponse for PageError {
    fn into_response(self) -> Response {
        self.0.log();
        let mut response = views::error_page(&self.0);
        if let WebError::TooMany(wait) | WebError::Besieged(wait) = self.0 {
            let wait = whole_seconds(wait).into();
            response.headers_mut().insert(RETRY_AFTER, wait);
        }
        response
    }
}
