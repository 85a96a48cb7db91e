//! The start page: ready tasks, one's own, and sessions to go on with.

use askama::Template;
use axum::extract::State;
use axum::response::{IntoResponse, Redirect, Response};

use super::AppState;
use super::behaviour::{Chip, chips};
use super::error::{PageError, WebError};
use super::forms::Faults;
use super::pages::{Fields, read_form};
use super::views::{Shell, render};
use crate::session::{Setup, Task, offered, ready};
use crate::store::Listed;

struct TaskCard {
    name: String,
    title: String,
    about: String,
    chips: Vec<Chip>,
}

struct SessionCard {
    id: String,
    title: String,
    state: &'static str,
    at: String,
    when: String,
}

#[derive(Default)]
struct OwnForm {
    title: String,
    symbols: String,
    examples: String,
}

#[derive(Template)]
#[template(path = "start.html")]
struct StartPage {
    shell: Shell,
    notice: Option<String>,
    tasks: Vec<TaskCard>,
    sessions: Vec<SessionCard>,
    own: OwnForm,
    faults: Faults,
}

async fn start_page(app: &AppState, own: OwnForm, faults: Faults) -> Result<Response, WebError> {
    let sessions = app.teaching.list(20).await?;
    Ok(render(&StartPage {
        shell: Shell::plain("Teach a rule"),
        notice: None,
        tasks: offered().map(task_card).collect(),
        sessions: sessions.iter().filter_map(session_card).collect(),
        own,
        faults,
    }))
}

fn task_card(task: Task) -> TaskCard {
    let about = task.guidelines.split(". ").next().unwrap_or_default();
    TaskCard {
        about: format!("{}.", about.trim_end_matches('.')),
        chips: chips(&task),
        name: task.name,
        title: task.title,
    }
}

/// `None` for a log of another version, which cannot be shown but does not
/// hide the others either.
fn session_card(listed: &Listed) -> Option<SessionCard> {
    let first: serde_json::Value = serde_json::from_str(&listed.first.body).ok()?;
    let last: serde_json::Value = serde_json::from_str(&listed.last.body).ok()?;
    Some(SessionCard {
        id: listed.id.to_string(),
        title: first["task"]["title"].as_str()?.to_owned(),
        state: match last["event"].as_str()? {
            "done" => "rule learned",
            "conflict" => "answers disagree",
            "asked" if last["kind"] == "equivalence" => "a rule to look at",
            _ => "a question waits",
        },
        when: format!(
            "{} {} UTC",
            listed.last.at.get(..10)?,
            listed.last.at.get(11..16)?
        ),
        at: listed.last.at.clone(),
    })
}

pub(crate) async fn show(State(app): State<AppState>) -> Result<Response, PageError> {
    Ok(start_page(&app, OwnForm::default(), Faults::default()).await?)
}

pub(crate) async fn begin(
    State(app): State<AppState>,
    fields: Fields,
) -> Result<Response, PageError> {
    let form = read_form(fields)?;
    let task = if form.has("task") {
        ready(form.text("task")).map_err(WebError::from)?
    } else {
        match form.own_task() {
            Ok(task) => task,
            Err(fault) => {
                let own = OwnForm {
                    title: form.text("title").to_owned(),
                    symbols: form.text("symbols").to_owned(),
                    examples: form.text("examples").to_owned(),
                };
                let error = WebError::from(fault);
                let faults = Faults::of(&error, &["title", "symbols", "examples"]);
                let page = start_page(&app, own, faults).await?;
                return Ok((error.status(), page).into_response());
            }
        }
    };
    let setup = Setup::of(&task);
    let id = app.teaching.create(task, setup).await?;
    Ok(Redirect::to(&format!("/sessions/{id}")).into_response())
}
