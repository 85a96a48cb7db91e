//! The JSON API under `/api/v1`.

use std::fmt::Write as _;

use axum::body::Bytes;
use axum::extract::rejection::BytesRejection;
use axum::extract::{Path, Query, State};
use axum::http::header::{CONTENT_DISPOSITION, CONTENT_TYPE};
use axum::http::{HeaderValue, StatusCode};
use axum::response::{IntoResponse, Response};
use axum::routing::{get, post};
use axum::{Json, Router};
use serde_json::{Value, json};

use super::AppState;
use super::error::{ApiError, WebError};
use super::export::{self, Format};
use super::forms;
use super::upload::under_task;
use crate::learner::Reply;
use crate::session::{
    Concept, Fields, MAX_STATES, Malformed, Position, RISK, Refusal, SETUP_KEYS, Session, Setup,
    Task, ready,
};
use crate::store::SessionId;

/// What a handler answers.
pub(crate) type Answer = Result<Json<Value>, ApiError>;
/// What a request brings.
pub(crate) type Body = Result<Bytes, BytesRejection>;

/// All routes but that of uploads, relative to `/api/v1`.
pub(crate) fn routes() -> Router<AppState> {
    Router::new()
        .route("/openapi.json", get(description))
        .route("/sessions", get(list))
        .route("/sessions/{id}", get(state))
        .route("/sessions/{id}/question", get(question))
        .route("/sessions/{id}/samples", get(samples))
        .route("/sessions/{id}/answers", post(answer))
        .route("/sessions/{id}/retractions", post(retract))
        .route("/sessions/{id}/changes", post(change))
        .route("/sessions/{id}/undo", post(undo))
        .route("/sessions/{id}/bound", post(enlarge))
        .route("/sessions/{id}/automaton", get(automaton))
        .route("/sessions/{id}/concept", get(concept))
        .route("/sessions/{id}/log", get(log))
        .route("/sessions/{id}/live", get(super::live::live))
}

/// What the routes are, for programs that write clients.
async fn description() -> Response {
    super::typed("application/json", include_str!("openapi.json").to_owned())
}

/// The JSON of a request.
pub(crate) fn read_body(body: Body) -> Result<Value, WebError> {
    let bytes = body.map_err(|rejection| match rejection.status() {
        StatusCode::PAYLOAD_TOO_LARGE => WebError::TooLarge,
        _ => WebError::unread(&rejection, rejection.body_text()),
    })?;
    forms::json_body(&bytes)
}

pub(crate) fn session_id(text: &str) -> Result<SessionId, WebError> {
    text.parse().map_err(|_| WebError::NoSession)
}

pub(crate) async fn create(State(app): State<AppState>, body: Body) -> Result<Response, ApiError> {
    let body = read_body(body)?;
    let fields = Fields::of(&body, "")?;
    let mut known = vec!["task"];
    known.extend(SETUP_KEYS);
    fields.only(&known)?;
    let task = match fields.get("task") {
        Some(Value::String(name)) => ready(name).map_err(|error| error.under("task"))?,
        Some(task) => {
            // A world is searched for the examples: not on the threads that listen.
            let task = task.clone();
            let read = tokio::task::spawn_blocking(move || Task::from_json(&task));
            let read = read.await.map_err(WebError::internal)?;
            read.map_err(|error| error.under("task"))?
        }
        None => {
            return Err(Malformed::new(
                "task",
                "name a ready task, as in `\"tomita:5\"`, or give a task file's content",
            )
            .into());
        }
    };
    let setup = Setup::of(&task).with(&fields)?;
    let id = app.teaching.create(task, setup).await;
    let id = id.map_err(under_task)?;
    Ok((StatusCode::CREATED, Json(json!({"id": id.to_string()}))).into_response())
}

async fn list(State(app): State<AppState>) -> Answer {
    let sessions: Vec<Value> = app
        .teaching
        .list(1000)
        .await?
        .into_iter()
        .map(|listed| json!({"id": listed.id.to_string(), "created": listed.first.at, "changed": listed.last.at}))
        .collect();
    Ok(Json(json!({ "sessions": sessions })))
}

async fn state(State(app): State<AppState>, Path(id): Path<String>) -> Answer {
    let id = session_id(&id)?;
    let view = move |session: &Session| {
        let (state, open) = match session.position() {
            Position::Thinking => ("thinking", None),
            Position::Asking(number) => ("asking", Some(*number)),
            Position::Conflict(_) => ("conflict", None),
            Position::Done(_) => ("done", None),
        };
        let setup = serde_json::to_value(session.setup()).unwrap_or_default();
        json!({
            "id": id.to_string(),
            "task": session.task(),
            "setup": setup,
            "state": state,
            "question": open,
            "counts": session.counts(),
            "answers": session.standing().iter().map(|s| s.number).collect::<Vec<_>>(),
            "hypothesis": session.hypothesis().map(|rule| session.universe().rule(&rule)),
        })
    };
    Ok(Json(app.teaching.look(id, view).await?))
}

async fn question(State(app): State<AppState>, Path(id): Path<String>) -> Answer {
    let id = session_id(&id)?;
    let view = |session: &Session| session.describe(session.position());
    Ok(Json(app.teaching.look(id, view).await?))
}

/// The behaviours beside the rule on show, and what may be claimed once all of them
/// were looked at.
async fn samples(State(app): State<AppState>, Path(id): Path<String>) -> Answer {
    let id = session_id(&id)?;
    let view = |session: &Session| {
        let Position::Asking(number) = *session.position() else {
            return Err(WebError::NoAutomaton);
        };
        let sheet = session.samples(number).ok_or(WebError::NoAutomaton)?;
        let bare = |atom| session.universe().text(atom).bare();
        let samples: Vec<Value> = sheet.atoms.iter().map(bare).collect();
        Ok(json!({
            "question": number,
            "samples": samples,
            "drawn_from": sheet.drawn_from,
            "share": sheet.claim().map(|claim| claim.share),
            "confidence": 1.0 - RISK,
        }))
    };
    Ok(Json(app.teaching.look(id, view).await??))
}

async fn answer(
    State(app): State<AppState>,
    Path(id): Path<String>,
    body: Body,
) -> Result<Response, ApiError> {
    let id = session_id(&id)?;
    let body = read_body(body)?;
    let decide = move |session: &Session| {
        let fields = Fields::of(&body, "")?;
        let key = session.universe().key();
        fields.only(&["question", "answer", key, "label", "looked"])?;
        let number = forms::question_number(&fields)?;
        let reply = forms::json_reply(&fields, session.universe())?;
        let Some(looked) = fields.whole("looked", 0, u32::MAX as usize)? else {
            return Ok(session.answer(number, &reply)?);
        };
        if reply != Reply::Correct {
            let message = "`looked` belongs to the answer `correct` alone: leave it out";
            return Err(Malformed::new("looked", message).into());
        }
        Ok(session.agree(number, Some(looked as u32))?)
    };
    match app.teaching.act(id, decide, Session::describe).await {
        Ok(question) => Ok(Json(question).into_response()),
        // Somebody else was faster: what is asked now comes along.
        Err(error @ WebError::Refused(Refusal::Closed { .. })) => {
            let view = |session: &Session| session.describe(session.position());
            // If that takes long, it can be asked for.
            match app.teaching.look(id, view).await {
                Ok(question) => Ok(ApiError(error).beside("question", &question)),
                Err(_) => Err(error.into()),
            }
        }
        Err(error) => Err(error.into()),
    }
}

async fn change(State(app): State<AppState>, Path(id): Path<String>, body: Body) -> Answer {
    let id = session_id(&id)?;
    let body = read_body(body)?;
    let decide = move |session: &Session| {
        let fields = Fields::of(&body, "")?;
        fields.only(&["question", "answer", session.universe().key(), "label"])?;
        let number = forms::question_number(&fields)?;
        let reply = forms::json_reply(&fields, session.universe())?;
        Ok(session.change(number, &reply)?)
    };
    Ok(Json(app.teaching.act(id, decide, Session::describe).await?))
}

async fn retract(State(app): State<AppState>, Path(id): Path<String>, body: Body) -> Answer {
    let id = session_id(&id)?;
    let body = read_body(body)?;
    let decide = move |session: &Session| {
        let fields = Fields::of(&body, "")?;
        fields.only(&["question"])?;
        Ok(session.retract(forms::question_number(&fields)?)?)
    };
    Ok(Json(app.teaching.act(id, decide, Session::describe).await?))
}

async fn undo(State(app): State<AppState>, Path(id): Path<String>, bytes: Bytes) -> Answer {
    let id = session_id(&id)?;
    // It takes nothing: neither a body nor a key in it.
    let body: Value = match &bytes[..] {
        [] => json!({}),
        bytes => serde_json::from_slice(bytes)
            .map_err(|_| WebError::Unreadable("leave the body out, or send `{}`".to_owned()))?,
    };
    let decide = move |session: &Session| {
        Fields::of(&body, "")?.only(&[])?;
        Ok(session.undo()?)
    };
    Ok(Json(app.teaching.act(id, decide, Session::describe).await?))
}

async fn enlarge(State(app): State<AppState>, Path(id): Path<String>, body: Body) -> Answer {
    let id = session_id(&id)?;
    let body = read_body(body)?;
    let decide = move |session: &Session| {
        let fields = Fields::of(&body, "")?;
        fields.only(&["max_states"])?;
        let bound = fields
            .whole("max_states", 1, MAX_STATES)?
            .ok_or_else(|| Malformed::new("max_states", "give the new bound on states"))?;
        Ok(session.enlarge(bound)?)
    };
    Ok(Json(app.teaching.act(id, decide, Session::describe).await?))
}

async fn automaton(
    State(app): State<AppState>,
    Path(id): Path<String>,
    Query(query): Query<Vec<(String, String)>>,
) -> Result<Response, ApiError> {
    let id = session_id(&id)?;
    let named = query
        .iter()
        .find(|(key, _)| key == "format")
        .map_or("json", |(_, value)| value.as_str());
    let format = Format::named(named)?;
    let part = query.iter().find(|(key, _)| key == "part");
    let is_whole = match part.map_or("whole", |(_, value)| value.as_str()) {
        "whole" => true,
        "learned" => false,
        other => {
            return Err(Malformed::new(
                "part",
                format!("there is no part `{other}`: give whole or learned"),
            )
            .into());
        }
    };
    let shown = app
        .teaching
        .look(id, move |session| {
            let rule = if is_whole {
                session.hypothesis()
            } else {
                session.learned().cloned()
            };
            match rule.ok_or(WebError::NoAutomaton)? {
                Concept::Automaton(dfa) => Ok((dfa, session.task().clone())),
                Concept::Parameter(_) | Concept::Named(_) => Err(WebError::NotAnAutomaton),
            }
        })
        .await?;
    let (hypothesis, task) = shown?;
    let name = match (is_whole, format.extension()) {
        (true, extension) => export::file_name(&task, extension),
        (false, extension) => export::file_name(&task, &format!("learned.{extension}")),
    };
    let body = tokio::task::spawn_blocking(move || export::write(&hypothesis, &task, format))
        .await
        .map_err(WebError::internal)??;
    Ok((
        [
            (CONTENT_TYPE, format.media_type().to_owned()),
            (
                CONTENT_DISPOSITION,
                format!("attachment; filename=\"{name}\""),
            ),
        ],
        body,
    )
        .into_response())
}

/// The rule in the form of its class.
async fn concept(
    State(app): State<AppState>,
    Path(id): Path<String>,
) -> Result<Response, ApiError> {
    let id = session_id(&id)?;
    let view = |session: &Session| {
        let rule = session.hypothesis().ok_or(WebError::NoAutomaton)?;
        let body = export::concept(&rule, session.universe(), session.task())?;
        Ok::<_, WebError>((body, export::file_name(session.task(), "json")))
    };
    let (body, name) = app.teaching.look(id, view).await??;
    let disposition = format!("attachment; filename=\"{name}\"");
    let headers = [
        (CONTENT_TYPE, "application/json".to_owned()),
        (CONTENT_DISPOSITION, disposition),
    ];
    Ok((headers, body).into_response())
}

async fn log(State(app): State<AppState>, Path(id): Path<String>) -> Result<Response, ApiError> {
    let id = session_id(&id)?;
    let entries = app.teaching.log(id).await?;
    let mut lines = String::new();
    for entry in entries {
        // The body is an object: its fields follow the store's own.
        let rest = entry.body.strip_prefix('{').unwrap_or(&entry.body);
        let _ = writeln!(
            lines,
            "{{\"seq\":{},\"at\":\"{}\",{rest}",
            entry.seq, entry.at
        );
    }
    let mut file = super::typed("application/jsonl; charset=utf-8", lines);
    // Not by the task's name: a log that cannot be read is to be had too.
    let name = format!("attachment; filename=\"memrep-{id}.jsonl\"");
    let name = HeaderValue::from_str(&name).map_err(WebError::internal)?;
    file.headers_mut().insert(CONTENT_DISPOSITION, name);
    Ok(file)
}
