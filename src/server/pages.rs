//! The pages of a session: everything a person does, as plain forms.

use askama::Template;
use axum::Router;
use axum::extract::rejection::FormRejection;
use axum::extract::{Form as FormBody, Path, Query, State};
use axum::http::StatusCode;
use axum::response::{IntoResponse, Redirect, Response};
use axum::routing::{get, post};

use super::AppState;
use super::api::session_id;
use super::behaviour::{BehaviourView, Content};
use super::error::{PageError, WebError};
use super::follow::Follow;
use super::forms::{Faults, Form};
use super::past::PastView;
use super::spent::Spent;
use super::standing::{Typed, View, page};
use super::views::{Bar, Shell, render};
use super::{again, export, live, media, outlook, practice, start};
use crate::learner::Reply;
use crate::session::{Concept, Decision, Position, Session};
use crate::store::SessionId;

/// Where a counterexample is typed, the behaviour first.
const ATOM_FIELDS: [&str; 4] = ["word", "point", "item", "label"];

/// A form's body, or why it is none.
pub(crate) type Fields = Result<FormBody<Vec<(String, String)>>, FormRejection>;

/// All routes of the pages but that of uploads.
pub(crate) fn routes() -> Router<AppState> {
    Router::new()
        .route("/", get(start::show))
        .route("/sessions/{id}", get(show))
        .route("/sessions/{id}/answers", post(answer))
        .route("/sessions/{id}/retractions", post(retract))
        .route("/sessions/{id}/changes", post(change))
        .route("/sessions/{id}/bound", post(enlarge))
        .route("/sessions/{id}/again", post(again::begin))
        .route("/sessions/{id}/history", get(history))
        .route("/sessions/{id}/why", get(outlook::why))
        .route("/sessions/{id}/live", get(live::live))
        .route(
            "/sessions/{id}/practice",
            get(practice::show).post(practice::answer),
        )
        .route("/sessions/{id}/automaton.svg", get(drawing))
        .route("/sessions/{id}/media/{*path}", get(media::show))
}

pub(crate) fn read_form(fields: Fields) -> Result<Form, WebError> {
    match fields {
        Ok(FormBody(fields)) => Ok(Form::new(fields)),
        Err(rejection) if rejection.status() == StatusCode::PAYLOAD_TOO_LARGE => {
            Err(WebError::TooLarge)
        }
        Err(rejection) => Err(WebError::unread(
            &rejection,
            "the form could not be read: go back and send it again",
        )),
    }
}

async fn show(
    State(app): State<AppState>,
    Path(id): Path<String>,
    Query(query): Query<Vec<(String, String)>>,
) -> Result<Response, PageError> {
    let id = session_id(&id)?;
    let mut query = query.into_iter();
    let trace = query.find_map(|(key, value)| (key == "trace").then_some(value));
    // First what may have to be waited for, and then what is there.
    let spent = spent(&app, id).await?;
    let typed = Typed {
        follows: Follow::all(&app.teaching, id).await,
        ..Typed::default()
    };
    let view = View {
        typed,
        trace,
        spent,
        ..View::default()
    };
    let view = move |session: &Session| page(id, session, view);
    Ok(app.teaching.look(id, view).await?)
}

/// The time that a session took, once it is done.
pub(crate) async fn spent(app: &AppState, id: SessionId) -> Result<Option<Spent>, WebError> {
    let is_done = |session: &Session| matches!(session.position(), Position::Done(_));
    if !app.teaching.look(id, is_done).await? {
        return Ok(None);
    }
    Ok(Spent::of(&app.teaching.log(id).await?))
}

/// Does what a form asks and goes back to the session; where that is refused,
/// shows the session as it stands, with the reason.
async fn act(
    app: &AppState,
    id: SessionId,
    typed: Typed,
    decide: impl Fn(&Session) -> Result<Decision, WebError> + Send + 'static,
) -> Result<Response, PageError> {
    match app.teaching.act(id, decide, |_, _| ()).await {
        // Where the learner takes long, the session's own page does the waiting.
        Ok(()) | Err(WebError::Slow | WebError::Waiting) => {
            Ok(Redirect::to(&format!("/sessions/{id}")).into_response())
        }
        Err(error) if error.is_refusal() => {
            let typed = match error.field() {
                Some(field) if ATOM_FIELDS.iter().any(|named| field.starts_with(named)) => Typed {
                    faults: Faults::of(&error, &ATOM_FIELDS),
                    ..typed
                },
                _ => Typed {
                    notice: Some(error.message()),
                    ..typed
                },
            };
            let view = View {
                typed,
                spent: spent(app, id).await?,
                ..View::default()
            };
            let view = move |session: &Session| page(id, session, view);
            let page = app.teaching.look(id, view).await?;
            Ok((error.status(), page).into_response())
        }
        Err(error) => Err(error.into()),
    }
}

async fn answer(
    State(app): State<AppState>,
    Path(id): Path<String>,
    fields: Fields,
) -> Result<Response, PageError> {
    let id = session_id(&id)?;
    let form = read_form(fields)?;
    let typed = Typed {
        atom: [form.text("word"), form.text("item")].concat(),
        values: form.texts("point").map(str::to_owned).collect(),
        label: form.text("label").to_owned(),
        ..Typed::default()
    };
    let decide = move |session: &Session| {
        let reply = form.reply(session.universe())?;
        let number = form.number("question")?;
        if reply == Reply::Correct && form.has("looked") {
            return Ok(session.agree(number, Some(form.number("looked")?))?);
        }
        Ok(session.answer(number, &reply)?)
    };
    act(&app, id, typed, decide).await
}

async fn retract(
    State(app): State<AppState>,
    Path(id): Path<String>,
    fields: Fields,
) -> Result<Response, PageError> {
    let id = session_id(&id)?;
    let form = read_form(fields)?;
    let decide = move |session: &Session| Ok(session.retract(form.number("question")?)?);
    act(&app, id, Typed::default(), decide).await
}

async fn change(
    State(app): State<AppState>,
    Path(id): Path<String>,
    fields: Fields,
) -> Result<Response, PageError> {
    let id = session_id(&id)?;
    let form = read_form(fields)?;
    let decide = move |session: &Session| {
        let reply = form.reply(session.universe())?;
        Ok(session.change(form.number("question")?, &reply)?)
    };
    act(&app, id, Typed::default(), decide).await
}

async fn enlarge(
    State(app): State<AppState>,
    Path(id): Path<String>,
    fields: Fields,
) -> Result<Response, PageError> {
    let id = session_id(&id)?;
    let form = read_form(fields)?;
    let decide = move |session: &Session| Ok(session.enlarge(form.number("max_states")? as usize)?);
    act(&app, id, Typed::default(), decide).await
}

/// What is known from the start.
pub(crate) struct ExampleView {
    pub(crate) behaviour: BehaviourView,
    pub(crate) label: bool,
}

#[derive(Template)]
#[template(path = "history.html")]
pub(crate) struct HistoryPage {
    pub(crate) shell: Shell,
    pub(crate) bar: Bar,
    pub(crate) notice: Option<String>,
    pub(crate) items: Vec<PastView>,
    pub(crate) examples: Vec<ExampleView>,
}

async fn history(
    State(app): State<AppState>,
    Path(id): Path<String>,
) -> Result<Response, PageError> {
    let id = session_id(&id)?;
    let view = move |session: &Session| {
        let bar = Bar::of(id, session);
        let task = session.task();
        let known = task.examples.iter().filter_map(|example| {
            let atom = session.universe().parse(&example.atom).ok()?;
            Some(ExampleView {
                behaviour: BehaviourView::of(&atom, session),
                label: example.label,
            })
        });
        render(&HistoryPage {
            shell: Shell::of(bar.clone()),
            bar,
            notice: None,
            items: session
                .standing()
                .iter()
                .rev()
                .filter_map(|s| PastView::of(s.number, session))
                .collect(),
            examples: known.collect(),
        })
    };
    Ok(app.teaching.look(id, view).await?)
}

async fn drawing(
    State(app): State<AppState>,
    Path(id): Path<String>,
) -> Result<Response, PageError> {
    let id = session_id(&id)?;
    let view = |session: &Session| match session.hypothesis().ok_or(WebError::NoAutomaton)? {
        Concept::Automaton(dfa) => export::write(&dfa, session.task(), export::Format::Svg),
        Concept::Parameter(_) | Concept::Named(_) => Err(WebError::NotAnAutomaton),
    };
    let svg = app.teaching.look(id, view).await??;
    Ok(super::typed("image/svg+xml", svg))
}
