//! The studio: builds a task by forms, says what is wrong with it, saves it as a task
//! file and begins to teach it.
//!
//! A [`Sheet`] is the form as it was filled in; `content` makes a task file's content
//! of it, and `opened` a form of such a content, so that nothing can be said here that a file cannot
//! say. The reader of task files says what is wrong; `faults` finds the field.

mod content;
mod faults;
mod opened;
mod page;
mod preview;
mod sheet;

use std::error::Error;

use axum::Router;
use axum::extract::{DefaultBodyLimit, Form as FormBody, FromRequest, Multipart, Query};
use axum::extract::{Request, State};
use axum::http::StatusCode;
use axum::http::header::{CONTENT_DISPOSITION, CONTENT_TYPE};
use axum::response::{IntoResponse, Redirect, Response};
use axum::routing::get;
use serde_json::Value;

use self::content::content;
use self::faults::SheetFaults;
use self::opened::sheet;
use self::page::{PreviewPart, RecordingsPage, Said, StudioPage};
use self::sheet::{Row, Sheet, resized};
use super::AppState;
use super::error::{PageError, WebError};
use super::forms::{self, FILE, Faults};
use super::upload::{self, OwnRule};
use super::views::{Shell, render};
use crate::session::{Malformed, Setup, Task, offered, ready};
use crate::task::{Fault, TaskFile, WorldText, toml_text};
use crate::world::grid::LONGEST_SIDE;

/// The largest form: the largest table of a task, as a browser may write it.
const STUDIO_LIMIT: usize = 4 * 1024 * 1024;

/// The routes of the studio but that of recordings.
pub(crate) fn routes() -> Router<AppState> {
    Router::new()
        .route("/studio", get(show).post(act))
        .layer(DefaultBodyLimit::max(STUDIO_LIMIT))
}

/// `GET /studio`: an empty form, or `?task=` one that is ready.
async fn show(Query(query): Query<Vec<(String, String)>>) -> Result<Response, PageError> {
    let named = query.iter().find(|(key, _)| key == "task");
    match named {
        None => answer(Sheet::blank(), None, Said::Nothing).await,
        Some((_, name)) => open_ready(name).await,
    }
}

/// The fields of a request, files among them as texts.
async fn fields(request: Request) -> Result<Vec<(String, String)>, WebError> {
    let kind = request.headers().get(CONTENT_TYPE);
    let kind = kind.and_then(|kind| kind.to_str().ok()).unwrap_or_default();
    let unreadable = |status: StatusCode, cause: &(dyn Error + 'static)| match status {
        StatusCode::PAYLOAD_TOO_LARGE => WebError::TooLarge,
        _ => WebError::unread(
            cause,
            "the form could not be read: go back and send it again",
        ),
    };
    if !kind.starts_with("multipart/form-data") {
        let form = FormBody::<Vec<(String, String)>>::from_request(request, &()).await;
        return form
            .map(|form| form.0)
            .map_err(|e| unreadable(e.status(), &e));
    }
    let parts = Multipart::from_request(request, &()).await;
    let mut parts = parts.map_err(|e| unreadable(e.status(), &e))?;
    let mut fields = Vec::new();
    while let Some(part) = parts
        .next_field()
        .await
        .map_err(|e| unreadable(e.status(), &e))?
    {
        let name = part.name().unwrap_or_default().to_owned();
        let bytes = part.bytes().await.map_err(|e| unreadable(e.status(), &e))?;
        // What is no text is told to be no task file.
        fields.push((name, String::from_utf8_lossy(&bytes).into_owned()));
    }
    Ok(fields)
}

/// `POST /studio`: what the pressed button says.
async fn act(State(app): State<AppState>, request: Request) -> Result<Response, PageError> {
    let fields = fields(request).await?;
    let of = |name: &str| {
        let field = fields.iter().rev().find(|(key, _)| key == name);
        field.map_or("", |(_, value)| value.as_str())
    };
    let mut typed = Sheet::sent(&fields);
    let (verb, object) = of("do").split_once(' ').unwrap_or((of("do"), ""));
    match verb {
        "open" => {
            let text = [of(FILE), of("text")].concat();
            return open(typed, &text).await;
        }
        "open-ready" => return open_ready(of("ready")).await,
        "add" => {
            typed.add(object);
        }
        "remove" => typed.remove(object),
        "rule" => {
            if let Some(list) = ["prior.holds", "prior.suffices"]
                .into_iter()
                .find(|l| *l == object)
            {
                let [form, x, y] =
                    ["form", "x", "y"].map(|key| of(&format!("{list}.{key}")).trim());
                typed.push(list, Row::from([("rule", rule(form, x, y))]));
            }
        }
        "resize" => {
            let side = |name: &str| of(name).trim().parse::<usize>().unwrap_or(1);
            let [rows, columns] =
                ["map-rows", "map-columns"].map(|name| side(name).clamp(1, LONGEST_SIDE));
            let map = resized(typed.at("world.map").trim_matches('\n'), rows, columns);
            typed.set("world.map", map);
        }
        "preview" => {
            let (preview, _) = looked(content(&typed)).await?;
            return Ok(render(&PreviewPart { preview }));
        }
        "save-draft" => return Ok(file(&content(&typed))),
        "save" | "begin" | "check" => return finish(&app, typed, verb).await,
        _ => {}
    }
    answer(typed, None, Said::Nothing).await
}

/// A rule of this form about these symbols.
fn rule(form: &str, x: &str, y: &str) -> String {
    match form {
        "before" => format!("{x} before {y}"),
        "never" => format!("never {x} after {y}"),
        form => format!("{form} {x}"),
    }
}

/// Checks the task; then saves it or begins to teach it, if that is wanted.
async fn finish(app: &AppState, typed: Sheet, verb: &str) -> Result<Response, PageError> {
    let content = content(&typed);
    let (_, read) = looked(content.clone()).await?;
    let task = match read {
        Ok(file) => file.task,
        Err(faults) => {
            let said = if verb == "save" {
                Said::Unsaved
            } else {
                Said::Faulty
            };
            let faults = SheetFaults::of(faults, &typed);
            return answer(typed, Some(faults), said).await;
        }
    };
    match verb {
        "save" => Ok(file(&content)),
        "begin" if matches!(task.world, Some(WorldText::Pool { .. })) => {
            Ok(render(&RecordingsPage {
                shell: Shell::plain("Recordings"),
                faults: Faults::default(),
                text: toml_text(&content),
                sent: false,
            }))
        }
        "begin" => {
            let setup = Setup::of(&task);
            let id = app.teaching.create(task, setup).await?;
            Ok(Redirect::to(&format!("/sessions/{id}")).into_response())
        }
        _ => answer(typed, None, Said::Fine).await,
    }
}

/// Opens a task file, whatever is wrong with it; what is no task file at all changes
/// nothing.
async fn open(typed: Sheet, text: &str) -> Result<Response, PageError> {
    let at = |fault: &Fault| match (fault.line, fault.column) {
        (Some(line), Some(column)) => format!("line {line}, column {column}: {}", fault.message),
        _ => fault.message.clone(),
    };
    let value = if text.trim().is_empty() {
        Err("choose a task file first".to_owned())
    } else if text.trim_start().starts_with('{') {
        serde_json::from_str(text).map_err(|error| format!("this is not JSON: {error}"))
    } else {
        Task::toml_content(text).map_err(|fault| at(&fault))
    };
    let value: Value = match value {
        Ok(value) => value,
        Err(message) => {
            let mut faults = SheetFaults::default();
            faults.add(String::new(), &message);
            let typed = if typed.rows("symbols").is_empty() && typed.at("class.kind").is_empty() {
                Sheet::blank()
            } else {
                typed
            };
            return answer(typed, Some(faults), Said::Faulty).await;
        }
    };
    let opened = sheet(&value);
    let owned = text.to_owned();
    let read = tokio::task::spawn_blocking(move || TaskFile::sent(&owned));
    match read.await.map_err(WebError::internal)? {
        Ok(file) => answer(opened, None, Said::Opened(file.task.title)).await,
        Err(faults) => {
            let told = faults
                .iter()
                .map(|fault| Malformed::new(&*fault.path, at(fault)));
            let faults = SheetFaults::of(told.collect(), &opened);
            answer(opened, Some(faults), Said::Faulty).await
        }
    }
}

async fn open_ready(name: &str) -> Result<Response, PageError> {
    let task = ready(name).map_err(WebError::from)?;
    let value = serde_json::to_value(&task).map_err(WebError::internal)?;
    answer(sheet(&value), None, Said::Opened(task.title)).await
}

type Looked = (preview::Preview, Result<TaskFile, Vec<Malformed>>);

/// The preview of a task, and the task: large grids take a while.
async fn looked(content: Value) -> Result<Looked, WebError> {
    let looked = tokio::task::spawn_blocking(move || preview::look(&content));
    looked.await.map_err(WebError::internal)
}

async fn answer(
    sheet: Sheet,
    faults: Option<SheetFaults>,
    said: Said,
) -> Result<Response, PageError> {
    let (preview, _) = looked(content(&sheet)).await?;
    let status = match faults {
        Some(_) => StatusCode::UNPROCESSABLE_ENTITY,
        None => StatusCode::OK,
    };
    let page = StudioPage {
        shell: Shell::plain("Build a task"),
        sheet,
        faults: faults.unwrap_or_default(),
        preview,
        said,
        ready: offered().map(|task| (task.name, task.title)).collect(),
    };
    Ok((status, render(&page)).into_response())
}

/// The task file, to be saved.
fn file(content: &Value) -> Response {
    let name: String = (content["name"].as_str().unwrap_or_default().chars())
        .map(|c| if c.is_ascii_alphanumeric() { c } else { '-' })
        .collect();
    let name = match name.trim_matches('-') {
        "" => "task",
        name => name,
    };
    let named = format!("attachment; filename=\"{name}.toml\"");
    let headers = [
        (CONTENT_TYPE, "application/toml; charset=utf-8".to_owned()),
        (CONTENT_DISPOSITION, named),
    ];
    (headers, toml_text(content)).into_response()
}

/// `POST /studio/recordings`: begins a task with its recordings.
pub(crate) async fn record(
    State(app): State<AppState>,
    request: Request,
) -> Result<Response, PageError> {
    let Ok(OwnRule { form, sent, read }) = upload::own_rule(request).await else {
        let message = "send the recordings as `multipart/form-data`".to_owned();
        return Err(WebError::Unreadable(message).into());
    };
    let begun = match read {
        Ok((task, Some(upload))) => {
            let setup = Setup::of(&task);
            app.teaching.create_with(task, setup, upload).await
        }
        Ok((task, None)) => {
            let setup = Setup::of(&task);
            app.teaching.create(task, setup).await
        }
        Err(error) => Err(error),
    };
    let error = match begun {
        Ok(id) => return Ok(Redirect::to(&format!("/sessions/{id}")).into_response()),
        Err(WebError::Malformed(fault)) if fault.message.starts_with("`world.recordings`") => {
            Malformed::new(upload::RECORDINGS, "choose the file of the recordings").into()
        }
        Err(
            error @ (WebError::Malformed(_) | WebError::UploadTooLarge | WebError::Unreadable(_)),
        ) => error,
        Err(error) => return Err(error.into()),
    };
    let page = RecordingsPage {
        shell: Shell::plain("Recordings"),
        faults: Faults::of(&error, &[upload::RECORDINGS, upload::MEDIA]),
        text: form.text(forms::FILE).to_owned(),
        sent,
    };
    Ok((error.status(), render(&page)).into_response())
}
