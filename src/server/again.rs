//! The same task once more, with other settings.

use axum::extract::{Path, State};
use axum::response::{IntoResponse, Redirect, Response};
use serde_json::{Map, Value};

use super::AppState;
use super::api::session_id;
use super::error::{PageError, WebError};
use super::forms::{Faults, Form};
use super::pages::{Fields as Body, read_form, spent};
use super::standing::{Typed, View, page};
use crate::session::{Fields, MAX_STATES, Malformed, Session, Setup, Task};

/// The fields of the form.
const FIELDS: [&str; 5] = [
    "strategy",
    "membership_cost",
    "comparison_cost",
    "seed",
    "max_states",
];

/// `POST /sessions/{id}/again`: a new session of the task, as it is told; its
/// uploads are shared.
pub(crate) async fn begin(
    State(app): State<AppState>,
    Path(id): Path<String>,
    fields: Body,
) -> Result<Response, PageError> {
    let id = session_id(&id)?;
    let form = read_form(fields)?;
    let known = |session: &Session| (session.task().clone(), session.setup().clone());
    let (task, setup) = app.teaching.look(id, known).await?;
    let begun = match settings(&form, task, &setup) {
        Ok((task, setup)) => app.teaching.create(task, setup).await,
        Err(error) => Err(error.into()),
    };
    match begun {
        Ok(new) => Ok(Redirect::to(&format!("/sessions/{new}")).into_response()),
        Err(error @ WebError::Malformed(_)) => {
            let typed = Typed {
                faults: Faults::of(&error, &FIELDS),
                ..Typed::default()
            };
            let again = FIELDS.map(|name| (name.to_owned(), form.text(name).to_owned()));
            let view = View {
                typed,
                again: again.to_vec(),
                spent: spent(&app, id).await?,
                ..View::default()
            };
            let view = move |session: &Session| page(id, session, view);
            let page = app.teaching.look(id, view).await?;
            Ok((error.status(), page).into_response())
        }
        Err(error) => Err(error.into()),
    }
}

/// The task and the setup with what the form tells; fields that are left out or
/// empty change nothing.
fn settings(form: &Form, mut task: Task, setup: &Setup) -> Result<(Task, Setup), Malformed> {
    let mut told = Map::new();
    let given = |name: &str| Some(form.text(name).trim().to_owned()).filter(|t| !t.is_empty());
    if let Some(strategy) = given("strategy") {
        told.insert("strategy".to_owned(), strategy.into());
    }
    for name in ["membership_cost", "comparison_cost"] {
        if let Some(text) = given(name) {
            let number = text.replace(',', ".").parse::<f64>().ok();
            let number = number.filter(|number| number.is_finite());
            told.insert(
                name.to_owned(),
                number.map_or(Value::from(text), Value::from),
            );
        }
    }
    if let Some(text) = given("seed") {
        let seed = text.parse::<u64>().map_or(Value::from(text), Value::from);
        told.insert("seed".to_owned(), seed);
    }
    if let Some(text) = given("max_states") {
        let bound = text.parse().ok();
        let bound = bound.filter(|bound| (1..=MAX_STATES).contains(bound));
        task.max_states = bound.ok_or_else(|| {
            Malformed::new(
                "max_states",
                format!("give a whole number from 1 to {MAX_STATES}"),
            )
        })?;
    }
    let told = Value::Object(told);
    let setup = setup.with(&Fields::of(&told, "")?)?;
    Ok((task, setup))
}
