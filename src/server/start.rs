//! The start page: ready tasks, one's own, and sessions to go on with.

use askama::Template;
use axum::extract::{Form as FormBody, FromRequest, Request, State};
use axum::response::{IntoResponse, Redirect, Response};

use super::AppState;
use super::behaviour::{Chip, chips};
use super::error::{PageError, WebError, sentence};
use super::forms::{FILE, Faults};
use super::owner;
use super::pages::read_form;
use super::upload::{self, OwnRule};
use super::views::{Shell, render};
use crate::session::{Malformed, Setup, Task, offered, ready};
use crate::store::{Listed, SessionId};
use crate::task::{Fault, TaskFile};

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
    /// Whether files came, which a page cannot keep.
    sent: bool,
}

#[derive(Template)]
#[template(path = "start.html")]
struct StartPage {
    shell: Shell,
    notice: Option<String>,
    tasks: Vec<TaskCard>,
    classics: Vec<TaskCard>,
    sessions: Vec<SessionCard>,
    /// Whether there is somebody to sign out.
    locked: bool,
    own: OwnForm,
    faults: Faults,
    file: SentFile,
}

/// A task file that came, where something is wrong with it.
#[derive(Default)]
struct SentFile {
    text: String,
    faults: Vec<String>,
}

impl SentFile {
    /// All that is wrong with it, by line and column.
    fn of(text: &str) -> Self {
        let told = |fault: &Fault| {
            let place = match (fault.line, fault.column) {
                (Some(line), Some(column)) => format!("line {line}, column {column}: "),
                _ => String::new(),
            };
            let path = match fault.path.as_str() {
                "" => String::new(),
                path => format!("`{path}`: "),
            };
            sentence(&format!("{place}{path}{}", fault.message))
        };
        let faults = TaskFile::sent(text).err().unwrap_or_default();
        Self {
            text: text.to_owned(),
            faults: faults.iter().map(told).collect(),
        }
    }
}

async fn start_page(
    app: &AppState,
    own: OwnForm,
    faults: Faults,
    file: SentFile,
) -> Result<Response, WebError> {
    let sessions = app.teaching.list(20).await?;
    // Rules over symbols that stand for nothing come last.
    let worded = |task: &Task| task.symbols.iter().any(|symbol| symbol.word.is_some());
    let bare = |task: &Task| task.class.is_none() && !worded(task);
    let (classics, tasks): (Vec<Task>, Vec<Task>) = offered().partition(bare);
    let cards = |tasks: Vec<Task>| tasks.into_iter().map(task_card).collect();
    let (tasks, classics) = (cards(tasks), cards(classics));
    Ok(render(&StartPage {
        shell: Shell::plain("Teach a rule"),
        notice: None,
        tasks,
        classics,
        sessions: sessions.iter().filter_map(session_card).collect(),
        locked: owner::is_locked(app).await?,
        own,
        faults,
        file,
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
    let file = SentFile::default();
    Ok(start_page(&app, OwnForm::default(), Faults::default(), file).await?)
}

/// `POST /sessions`: a ready task, or one's own with recordings or without.
pub(crate) async fn begin(
    State(app): State<AppState>,
    request: Request,
) -> Result<Response, PageError> {
    let own = match upload::own_rule(request).await {
        Ok(own) => own,
        Err(request) => {
            let form = read_form(FormBody::from_request(request, &()).await)?;
            if form.has("task") {
                let task = ready(form.text("task")).map_err(WebError::from)?;
                let setup = Setup::of(&task);
                let id = app.teaching.create(task, setup).await?;
                return Ok(to_session(id));
            }
            let read = form.own_task_in(None).map(|task| (task, None));
            OwnRule {
                sent: false,
                read: read.map_err(WebError::from),
                form,
            }
        }
    };
    let begun = match own.read {
        Ok((task, upload)) => {
            let setup = Setup::of(&task);
            match upload {
                Some(upload) => app.teaching.create_with(task, setup, upload).await,
                None => app.teaching.create(task, setup).await,
            }
        }
        Err(error) => Err(error),
    };
    match begun {
        Ok(id) => Ok(to_session(id)),
        Err(
            error @ (WebError::Malformed(_) | WebError::UploadTooLarge | WebError::Unreadable(_)),
        ) => {
            let error = numbered(error);
            let typed = OwnForm {
                title: own.form.text("title").to_owned(),
                symbols: own.form.text("symbols").to_owned(),
                examples: own.form.text("examples").to_owned(),
                sent: own.sent,
            };
            let faults = Faults::of(&error, &FIELDS);
            let file = if own.form.has_file() {
                let text = own.form.text(FILE).to_owned();
                let read = tokio::task::spawn_blocking(move || SentFile::of(&text)).await;
                read.map_err(WebError::internal)?
            } else {
                SentFile::default()
            };
            let page = start_page(&app, typed, faults, file).await?;
            Ok((error.status(), page).into_response())
        }
        Err(error) => Err(error.into()),
    }
}

/// The fields of one's own rule; what is about no field is said at the first.
const FIELDS: [&str; 6] = ["recordings", "title", "symbols", "examples", "media", FILE];

/// The same, saying which example is meant.
fn numbered(error: WebError) -> WebError {
    let place = |path: &str| -> Option<usize> {
        let place = path.strip_prefix("examples[")?.strip_suffix(']')?;
        place.parse().ok()
    };
    match error {
        WebError::Malformed(fault) => match place(&fault.path) {
            Some(at) => {
                let message = format!("example {}: {}", at + 1, fault.message);
                Malformed::new(fault.path, message).into()
            }
            None => fault.into(),
        },
        other => other,
    }
}

fn to_session(id: SessionId) -> Response {
    Redirect::to(&format!("/sessions/{id}")).into_response()
}
