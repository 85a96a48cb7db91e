//! Recordings that come with a new session: all of it is there afterwards, or
//! nothing.
//!
//! A form comes part by part and is never in memory as a whole: `parts` takes it
//! from the network, `spool` reads the recordings as they come and writes the rest
//! to a file without a name, `check` sees whether all fits together. Then the store
//! keeps the files and the session in one step; `pools` reads them back.

mod check;
mod parts;
mod pools;
mod spool;

use axum::Json;
use axum::body::Bytes;
use axum::extract::{FromRequest, Request, State};
use axum::http::StatusCode;
use axum::http::header::CONTENT_TYPE;
use axum::response::{IntoResponse, Response};
use serde_json::{Map, Value, json};

use self::parts::{Texts, take};
pub(crate) use self::pools::Pools;
pub(crate) use self::spool::Files;
use super::error::{ApiError, WebError};
use super::forms::{self, Form};
use super::{API_LIMIT, AppState, api};
use crate::session::{Fields, Malformed, SETUP_KEYS, Setup, Task};
use crate::store::{SessionId, UploadId};
use crate::world::World;

/// The name of the part with the recordings, and of their file in the store: no
/// picture or film can be called so.
pub(crate) const RECORDINGS: &str = "recordings";
/// The name of the parts with pictures and films.
pub(crate) const MEDIA: &str = "media";
/// The most bytes of an upload's files in all: 64 MiB.
pub(crate) const UPLOAD_LIMIT: u64 = 64 << 20;
/// The most bytes of what is around the files.
const FRAME_LIMIT: u64 = 8 << 20;

/// What comes to the API beside files.
const TASK: Texts = Texts {
    names: &["task"],
    most: API_LIMIT,
};

/// What the start page sends beside files; a task file is as long as a task may be.
const FORM: Texts = Texts {
    names: &["title", "symbols", "examples", forms::FILE],
    most: API_LIMIT,
};

/// A new upload with the task that it was sent for.
pub(crate) struct Upload {
    pub(crate) id: UploadId,
    pub(crate) world: World,
    pub(crate) files: Files,
}

/// Whether the request has a form with files.
pub(crate) fn is_multipart(request: &Request) -> bool {
    let kind = request.headers().get(CONTENT_TYPE);
    let kind = kind.and_then(|kind| kind.to_str().ok()).unwrap_or_default();
    let kind = kind.split(';').next().unwrap_or_default().trim();
    kind.eq_ignore_ascii_case("multipart/form-data")
}

/// `POST /api/v1/sessions`: JSON, or a form with recordings.
pub(crate) async fn create(
    State(app): State<AppState>,
    request: Request,
) -> Result<Response, ApiError> {
    if !is_multipart(&request) {
        let body = Bytes::from_request(request, &()).await;
        return api::create(State(app), body).await;
    }
    let id = UploadId::random().map_err(WebError::internal)?;
    let mut read: Option<(Task, Setup)> = None;
    let (_, spool) = take(request, &TASK, |form| {
        let (task, setup) = read_task(form, id)?;
        let alphabet = task.alphabet().ok_or_else(no_words)?;
        read = Some((task, setup));
        Ok(alphabet)
    })
    .await;
    let spool = spool?;
    let (Some(spool), Some((task, setup))) = (spool, read) else {
        let message = "there are no recordings: send them as a part of this name after `task`, or send the task alone as JSON";
        return Err(Malformed::new(RECORDINGS, message).into());
    };
    let (pool, files) = spool.split();
    let upload = Upload {
        id,
        world: World::Pool(pool),
        files,
    };
    let session = app.teaching.create_with(task, setup, upload).await;
    let session = session.map_err(under_task)?;
    Ok((StatusCode::CREATED, Json(created(session, id))).into_response())
}

fn created(session: SessionId, upload: UploadId) -> Value {
    json!({"id": session.to_string(), "upload": upload.to_string()})
}

fn no_words() -> Malformed {
    let message = "recordings are of words: give `symbols`, or leave the recordings out";
    Malformed::new("task.symbols", message)
}

/// What is wrong with the task stands under its key.
pub(crate) fn under_task(error: WebError) -> WebError {
    match error {
        WebError::Malformed(fault) if fault.path != RECORDINGS && fault.path != MEDIA => {
            fault.under("task").into()
        }
        other => other,
    }
}

/// The part `task`: the JSON body of a new session, or a task file.
fn read_task(form: &Form, upload: UploadId) -> Result<(Task, Setup), WebError> {
    if !form.has("task") {
        let message = "send the task first, so that the recordings can be read over its symbols";
        return Err(Malformed::new("task", message).into());
    }
    let body = forms::task_content(form.text("task"));
    let body = body.map_err(|message| Malformed::new("task", message))?;
    // A task file has no key of this name.
    let mut body = match body.get("task") {
        Some(_) => body,
        None => json!({ "task": body }),
    };
    use_upload(&mut body["task"], upload)?;
    let fields = Fields::of(&body, "")?;
    let mut known = vec!["task"];
    known.extend(SETUP_KEYS);
    fields.only(&known)?;
    let task = Task::from_json(&body["task"]).map_err(|error| error.under("task"))?;
    let setup = Setup::of(&task).with(&fields)?;
    Ok((task, setup))
}

/// Makes the upload the world of the task.
pub(crate) fn use_upload(task: &mut Value, upload: UploadId) -> Result<(), Malformed> {
    let Some(task) = task.as_object_mut() else {
        let message = "give a task file's content: a ready task has a world of its own";
        return Err(Malformed::new("task", message));
    };
    let world = task.entry("world").or_insert(Value::Null);
    if world.is_null() {
        *world = json!({"kind": "pool"});
    }
    let fault = |key: &str, message: &str| Malformed::new(format!("task.world{key}"), message);
    let world: &mut Map<String, Value> = world
        .as_object_mut()
        .ok_or_else(|| fault("", "give an object (in TOML a table)"))?;
    if world.get("kind").is_some_and(|kind| kind != "pool") {
        let message = "recordings came with the task: give `pool`, or leave the recordings out";
        return Err(fault(".kind", message));
    }
    if world.contains_key("upload") {
        let message = "recordings came with the task: leave this out, or leave the recordings out";
        return Err(fault(".upload", message));
    }
    // The file that a task file names is the one that was sent.
    world.remove("recordings");
    world.insert("upload".to_owned(), upload.to_string().into());
    Ok(())
}

/// What the start page's form holds, with the upload if there was one.
pub(crate) struct OwnRule {
    pub(crate) form: Form,
    /// Whether there were files.
    pub(crate) sent: bool,
    pub(crate) read: Result<(Task, Option<Upload>), WebError>,
}

/// Reads the start page's form, with recordings or without; none if it is none of
/// that kind, and the request comes back.
pub(crate) async fn own_rule(request: Request) -> Result<OwnRule, Request> {
    if !is_multipart(&request) {
        return Err(request);
    }
    let id = UploadId::random().map_err(WebError::internal);
    let mut read = None;
    let (form, spool) = take(request, &FORM, |form| {
        let id = id
            .as_ref()
            .map_err(|_| WebError::internal("no randomness"))?;
        let task = form.own_task_in(Some(*id))?;
        let alphabet = task.alphabet().ok_or_else(no_words)?;
        read = Some((task, *id));
        Ok(alphabet)
    })
    .await;
    let sent = read.is_some() || form.has_file() || !matches!(spool, Ok(None));
    let read = match (spool, read) {
        (Err(error), _) => Err(error),
        (Ok(Some(spool)), Some((task, id))) => {
            let (pool, files) = spool.split();
            let world = World::Pool(pool);
            Ok((task, Some(Upload { id, world, files })))
        }
        (Ok(_), _) => form
            .own_task_in(None)
            .map(|task| (task, None))
            .map_err(Into::into),
    };
    Ok(OwnRule { form, sent, read })
}
