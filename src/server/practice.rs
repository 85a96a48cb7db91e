//! The practice question of a task: answered, explained, and not kept.

use askama::Template;
use axum::extract::{Path, State};
use axum::response::Response;

use super::AppState;
use super::api::session_id;
use super::behaviour::{BehaviourView, Content, Legend};
use super::error::{PageError, WebError};
use super::forms::plain_reply;
use super::pages::{Fields, read_form};
use super::past::said;
use super::views::{Bar, Shell, render};
use crate::session::Session;
use crate::task::{Practice, Practised};

#[derive(Template)]
#[template(path = "practice.html")]
struct PracticePage {
    shell: Shell,
    bar: Bar,
    first: BehaviourView,
    second: Option<BehaviourView>,
    verdict: Option<Verdict>,
    /// What the colours of the world mean.
    legend: Legend,
}

/// What becomes of an answer.
struct Verdict {
    right: bool,
    /// The expected answer, for people.
    meant: &'static str,
    why: String,
}

/// The page, with the answer that was given.
pub(crate) fn page(
    bar: Bar,
    session: &Session,
    answer: Option<&str>,
) -> Result<Response, WebError> {
    let practice = session.task().practice.as_ref();
    let Practice {
        asks,
        answer: expected,
        why,
    } = practice.ok_or(WebError::NoPage)?;
    let universe = session.universe();
    let parse = |text| universe.parse(text).map_err(WebError::internal);
    let (first, second) = match asks {
        Practised::Judgement(atom) => (BehaviourView::of(&parse(atom)?, session), None),
        Practised::Comparison { first, second } => {
            let (first, second) = BehaviourView::pair(&parse(first)?, &parse(second)?, session);
            (first, Some(second))
        }
    };
    let verdict = match answer {
        None => None,
        Some(answer) => {
            plain_reply(answer)?;
            Some(Verdict {
                right: answer == *expected,
                meant: said(&plain_reply(expected)?),
                why: why.clone(),
            })
        }
    };
    Ok(render(&PracticePage {
        shell: Shell::of(bar.clone()),
        bar,
        first,
        second,
        verdict,
        legend: Legend::of(session),
    }))
}

/// Asks it.
pub(crate) async fn show(
    State(app): State<AppState>,
    Path(id): Path<String>,
) -> Result<Response, PageError> {
    let id = session_id(&id)?;
    let view = move |session: &Session| page(Bar::of(id, session), session, None);
    Ok(app.teaching.look(id, view).await??)
}

/// Says what is meant.
pub(crate) async fn answer(
    State(app): State<AppState>,
    Path(id): Path<String>,
    fields: Fields,
) -> Result<Response, PageError> {
    let id = session_id(&id)?;
    let form = read_form(fields)?;
    let view =
        move |session: &Session| page(Bar::of(id, session), session, Some(form.text("answer")));
    Ok(app.teaching.look(id, view).await??)
}
