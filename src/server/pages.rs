//! The pages of a session: everything a person does, as plain forms.

use askama::Template;
use axum::Router;
use axum::extract::rejection::FormRejection;
use axum::extract::{Form as FormBody, Path, State};
use axum::http::StatusCode;
use axum::response::{IntoResponse, Redirect, Response};
use axum::routing::{get, post};

use super::AppState;
use super::api::session_id;
use super::behaviour::{BehaviourView, Chip, Content, chips};
use super::error::{PageError, WebError};
use super::forms::{Faults, Form};
use super::past::PastView;
use super::rule::RuleView;
use super::views::{Bar, Shell, render};
use super::{export, media, practice, start};
use crate::learner::{Counts, Question, Reply};
use crate::session::{Concept, Decision, MAX_STATES, Position, Session, Universe};
use crate::store::SessionId;
use crate::task::Axis;
use crate::world::World;

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
        .route("/sessions/{id}/history", get(history))
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
        Err(_) => Err(WebError::Unreadable(
            "the form could not be read: go back and send it again".to_owned(),
        )),
    }
}

#[derive(Template)]
#[template(path = "question.html")]
struct QuestionPage {
    shell: Shell,
    bar: Bar,
    notice: Option<String>,
    number: u32,
    first: BehaviourView,
    second: Option<BehaviourView>,
    hurried: bool,
}

#[derive(Template)]
#[template(path = "equivalence.html")]
struct EquivalencePage {
    shell: Shell,
    bar: Bar,
    notice: Option<String>,
    number: u32,
    rule: RuleView,
    ask: Ask,
    typed: String,
    label: String,
    faults: Faults,
}

/// How a person says what the rule treats wrongly.
enum Ask {
    /// By symbols.
    Word {
        chips: Vec<Chip>,
        names: String,
        empty: String,
    },
    /// By a number an axis.
    Values(Vec<InputView>),
    /// By its name.
    Items(Vec<String>),
}

/// Where a number on an axis is typed.
struct InputView {
    name: String,
    least: String,
    most: String,
    step: String,
    typed: String,
}

impl Ask {
    fn of(session: &Session, typed: &Typed) -> Self {
        match session.universe() {
            Universe::Words { alphabet, .. } => {
                let names: Vec<&str> = alphabet.names().collect();
                Self::Word {
                    chips: chips(session.task()),
                    names: names.join(", "),
                    empty: session.task().empty.clone(),
                }
            }
            Universe::Monotone(axes) => {
                let input = |(place, axis): (usize, &Axis)| InputView {
                    name: axis.name.clone(),
                    least: axis.spell(axis.best.min(axis.worst)),
                    most: axis.spell(axis.best.max(axis.worst)),
                    step: axis.spell(axes.step(axis)),
                    typed: typed.values.get(place).cloned().unwrap_or_default(),
                };
                Self::Values(axes.axes().iter().enumerate().map(input).collect())
            }
            universe @ (Universe::Finite(_) | Universe::Linear(_)) => {
                Self::Items(universe.items().into_iter().map(str::to_owned).collect())
            }
        }
    }
}

#[derive(Template)]
#[template(path = "conflict.html")]
struct ConflictPage {
    shell: Shell,
    bar: Bar,
    notice: Option<String>,
    items: Vec<PastView>,
    /// Why the answers cannot all be true.
    message: String,
    minimal: bool,
    bound: Option<usize>,
    larger: Option<usize>,
    /// Whether something was known at the start, which may have a part in it.
    known: bool,
}

struct Download {
    format: &'static str,
    title: &'static str,
    about: &'static str,
    href: String,
}

#[derive(Template)]
#[template(path = "done.html")]
struct DonePage {
    shell: Shell,
    bar: Bar,
    notice: Option<String>,
    rule: RuleView,
    counts: Counts,
    files: Vec<Download>,
    agreed: Option<u32>,
    /// What nothing that can be shown decides; and whether that is recordings.
    beyond: Option<BehaviourView>,
    recorded: bool,
}

/// What a person had typed when something was wrong with it.
#[derive(Clone, Default)]
struct Typed {
    notice: Option<String>,
    faults: Faults,
    /// A word, or the name of a behaviour.
    atom: String,
    values: Vec<String>,
    label: String,
}

/// The page of a session as it stands.
fn page(id: SessionId, session: &Session, typed: Typed) -> Response {
    let task = session.task();
    let bar = Bar::of(id.to_string(), session);
    let shell = Shell::of(bar.clone());
    let showing = match session.position() {
        Position::Asking(number) => session.asked(*number).map(|asked| &asked.question),
        _ => None,
    };
    // Only the page of an equivalence query has the fields to say it at.
    let notice = match showing {
        Some(Question::Equivalence { .. }) => typed.notice.clone(),
        _ => typed.notice.clone().or_else(|| typed.faults.message()),
    };
    match session.position() {
        Position::Thinking => PageError(WebError::Slow).into_response(),
        Position::Asking(number) => {
            let Some(asked) = session.asked(*number) else {
                return PageError(WebError::Slow).into_response();
            };
            let (first, second) = match &asked.question {
                Question::Membership { atom } => (BehaviourView::of(atom, session), None),
                Question::Comparison { first, second } => {
                    let (first, second) = BehaviourView::pair(first, second, session);
                    (first, Some(second))
                }
                Question::Equivalence { hypothesis } => {
                    return render(&EquivalencePage {
                        shell,
                        bar,
                        notice,
                        number: *number,
                        rule: RuleView::of(&session.whole(hypothesis), session),
                        ask: Ask::of(session, &typed),
                        typed: typed.atom,
                        label: typed.label,
                        faults: typed.faults,
                    });
                }
            };
            render(&QuestionPage {
                shell,
                bar,
                notice,
                number: *number,
                first,
                second,
                hurried: asked.hurried,
            })
        }
        Position::Conflict(conflict) => render(&ConflictPage {
            shell,
            bar,
            notice,
            items: conflict
                .answers
                .iter()
                .filter_map(|&number| PastView::of(number, session))
                .collect(),
            message: session.explain(conflict),
            minimal: conflict.minimal,
            bound: conflict.bound,
            larger: conflict
                .bound
                .map(|bound| (bound * 2).min(MAX_STATES))
                .filter(|larger| *larger > task.max_states),
            known: !task.examples.is_empty(),
        }),
        Position::Done(hypothesis) => render(&DonePage {
            shell,
            bar,
            notice,
            rule: RuleView::of(&session.whole(hypothesis), session),
            counts: session.counts(),
            files: downloads(id, session.universe()),
            beyond: (session.beyond()).map(|atom| BehaviourView::of(&atom, session)),
            recorded: matches!(session.world(), Some(World::Pool(_))),
            agreed: session
                .standing()
                .iter()
                .rev()
                .find(|s| s.reply == Reply::Correct)
                .map(|s| s.number),
        }),
    }
}

fn downloads(id: SessionId, universe: &Universe) -> Vec<Download> {
    let automaton = |&(format, title, about): &(export::Format, _, _)| Download {
        format: format.name(),
        title,
        about,
        href: format!("/api/v1/sessions/{id}/automaton?format={}", format.name()),
    };
    let rules: Vec<Download> = match universe {
        Universe::Words { .. } => export::OFFERED.iter().map(automaton).collect(),
        Universe::Monotone(_) | Universe::Finite(_) | Universe::Linear(_) => vec![Download {
            format: "json",
            title: "JSON",
            about: "the rule, for programs",
            href: format!("/api/v1/sessions/{id}/concept"),
        }],
    };
    let log = Download {
        format: "log",
        title: "Log",
        about: "every question and answer, one a line",
        href: format!("/api/v1/sessions/{id}/log"),
    };
    rules.into_iter().chain([log]).collect()
}

async fn show(State(app): State<AppState>, Path(id): Path<String>) -> Result<Response, PageError> {
    let id = session_id(&id)?;
    let view = move |session: &Session| page(id, session, Typed::default());
    Ok(app.teaching.look(id, view).await?)
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
        Ok(()) | Err(WebError::Slow) => {
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
            let view = move |session: &Session| page(id, session, typed);
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
        Ok(session.answer(form.number("question")?, &reply)?)
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

struct ExampleView {
    behaviour: BehaviourView,
    label: bool,
}

#[derive(Template)]
#[template(path = "history.html")]
struct HistoryPage {
    shell: Shell,
    bar: Bar,
    notice: Option<String>,
    items: Vec<PastView>,
    examples: Vec<ExampleView>,
}

async fn history(
    State(app): State<AppState>,
    Path(id): Path<String>,
) -> Result<Response, PageError> {
    let id = session_id(&id)?;
    let view = move |session: &Session| {
        let bar = Bar::of(id.to_string(), session);
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
