//! The JSON API about the people who answer, and for them.

use std::sync::Arc;

use axum::extract::{DefaultBodyLimit, Path, State};
use axum::http::StatusCode;
use axum::response::{IntoResponse, Response};
use axum::routing::{get, post};
use axum::{Json, Router};
use serde_json::{Value, json};

use super::api::{Answer, Body, read_body, session_id};
use super::error::{ApiError, WebError};
use super::forms;
use super::invited::{Guest, say};
use super::leases::Turn;
use super::people::invited;
use super::{AppState, FORM_LIMIT};
use crate::session::{Decision, Fields, MAX_ANSWERS, Malformed, Pooling, Position, Session, Terms};

/// All routes, relative to `/api/v1`.
pub(crate) fn routes() -> Router<AppState> {
    // Whoever has no key is not to send much before that is seen.
    let for_them = Router::new()
        .route("/answer/{key}", get(question).post(answer))
        .route("/answer/{key}/retractions", post(retract))
        .layer(DefaultBodyLimit::max(FORM_LIMIT));
    Router::new()
        .route("/sessions/{id}/people", get(people).post(invite))
        .route("/sessions/{id}/people/terms", post(set_terms))
        .merge(for_them)
}

/// The people of a session, as its owner sees them.
fn described(session: &Session) -> Value {
    let panel = session.panel();
    let people: Vec<Value> = (panel.people().iter())
        .map(|(number, person)| {
            let mut value = json!(panel.record(*number));
            value["person"] = (*number).into();
            value["name"] = person.name.as_str().into();
            value["left"] = person.left.into();
            if let Some(own) = &person.session {
                value["session"] = own.as_str().into();
            }
            value
        })
        .collect();
    let disputes: Vec<u32> = session
        .open()
        .filter(|number| panel.disagrees(*number))
        .collect();
    json!({
        "terms": panel.terms(),
        "people": people,
        "agreement": panel.agreement(),
        "open": session.open().collect::<Vec<u32>>(),
        "disputes": disputes,
    })
}

async fn people(State(app): State<AppState>, Path(id): Path<String>) -> Answer {
    Ok(Json(app.teaching.look(session_id(&id)?, described).await?))
}

async fn invite(
    State(app): State<AppState>,
    Path(id): Path<String>,
    body: Body,
) -> Result<Response, ApiError> {
    let id = session_id(&id)?;
    let body = read_body(body)?;
    let fields = Fields::of(&body, "")?;
    fields.only(&["name"])?;
    let name = fields.get("name").and_then(Value::as_str);
    let name = name.ok_or_else(|| Malformed::new("name", "give the person's name"))?;
    let (person, link) = invited(&app, id, name.to_owned()).await?;
    let mut made = json!({"person": person, "link": link});
    if let Some(whole) = app.door.whole(&link) {
        made["url"] = whole.into();
    }
    Ok((StatusCode::CREATED, Json(made)).into_response())
}

async fn set_terms(State(app): State<AppState>, Path(id): Path<String>, body: Body) -> Answer {
    let id = session_id(&id)?;
    let body = read_body(body)?;
    let decide = move |session: &Session| {
        let fields = Fields::of(&body, "")?;
        fields.only(&["answers", "pooling", "shows_rule"])?;
        let now = session.panel().terms();
        let answers = fields.whole("answers", 1, MAX_ANSWERS as usize)?;
        let pooling = match fields.get("pooling").map(Value::as_str) {
            None => now.pooling,
            Some(Some("majority")) => Pooling::Majority,
            Some(Some("reliability")) => Pooling::Reliability,
            Some(Some("alone")) => Pooling::Alone,
            Some(_) => {
                return Err(
                    Malformed::new("pooling", "give `majority`, `reliability` or `alone`").into(),
                );
            }
        };
        let shows_rule = match fields.get("shows_rule") {
            None => now.shows_rule,
            Some(value) => value
                .as_bool()
                .ok_or_else(|| Malformed::new("shows_rule", "say `true` or `false`"))?,
        };
        Ok(session.set_terms(Terms {
            answers: answers.map_or(now.answers, |answers| answers as u32),
            pooling,
            shows_rule,
        })?)
    };
    let view = |session: &Session, _: &Position| described(session);
    Ok(Json(app.teaching.act(id, decide, view).await?))
}

/// The question that is this person's now.
async fn turn(app: &AppState, guest: Guest) -> Answer {
    let leases = app.teaching.leases();
    let (deciding, viewing) = (Arc::clone(leases), Arc::clone(leases));
    let admit = move |session: &Session| guest.admit(session);
    let wants = move |session: &Session| guest.wants(session, &deciding);
    let view = move |session: &Session, position: &Position| {
        let turn = viewing.turn(guest.session, session, guest.person);
        match turn {
            Some(Turn::Answer(number)) => session.describe_question(number),
            Some(Turn::Repeat(number)) => {
                let mut value = session.describe_question(number);
                value["repeated"] = true.into();
                value
            }
            None if matches!(position, Position::Done(_)) => json!({"kind": "done"}),
            None => json!({"kind": "waiting"}),
        }
    };
    let put = (app.teaching).put_another(guest.session, admit, wants, view);
    let mut value = put.await?;
    // What is left, and what answers would rule out, is the owner's to know.
    if let Value::Object(question) = &mut value {
        for key in ["left", "removed", "hurried"] {
            question.remove(key);
        }
    }
    Ok(Json(value))
}

async fn question(State(app): State<AppState>, Path(key): Path<String>) -> Answer {
    let guest = Guest::of(&app, &key).await?;
    turn(&app, guest).await
}

async fn answer(State(app): State<AppState>, Path(key): Path<String>, body: Body) -> Answer {
    let guest = Guest::of(&app, &key).await?;
    let body = read_body(body)?;
    let decide = move |session: &Session| {
        let fields = Fields::of(&body, "")?;
        fields.only(&[
            "question",
            "answer",
            "took",
            session.universe().key(),
            "label",
        ])?;
        let number = forms::question_number(&fields)?;
        let took = fields.whole("took", 0, 86_400_000)?.map(|took| took as u64);
        let reply = forms::json_reply(&fields, session.universe())?;
        say(session, guest.person, number, &reply, took)
    };
    said(&app, guest, decide).await
}

async fn retract(State(app): State<AppState>, Path(key): Path<String>, body: Body) -> Answer {
    let guest = Guest::of(&app, &key).await?;
    let body = read_body(body)?;
    let decide = move |session: &Session| {
        let fields = Fields::of(&body, "")?;
        fields.only(&["question"])?;
        Ok(session.unsay(guest.person, forms::question_number(&fields)?)?)
    };
    said(&app, guest, decide).await
}

async fn said(
    app: &AppState,
    guest: Guest,
    decide: impl Fn(&Session) -> Result<Decision, WebError> + Send + 'static,
) -> Answer {
    let decide = move |session: &Session| {
        guest.admit(session)?;
        decide(session)
    };
    app.teaching.act(guest.session, decide, |_, _| ()).await?;
    app.teaching.leases().release(guest.session, guest.person);
    turn(app, guest).await
}
