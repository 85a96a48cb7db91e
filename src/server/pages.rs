//! The pages: everything a person does, as plain forms.

use askama::Template;
use axum::Router;
use axum::extract::rejection::FormRejection;
use axum::extract::{Form as FormBody, Path, State};
use axum::http::StatusCode;
use axum::response::{IntoResponse, Redirect, Response};
use axum::routing::{get, post};

use super::AppState;
use super::api::session_id;
use super::error::{PageError, WebError};
use super::export;
use super::forms::Form;
use super::views::{Bar, Chip, PastView, RuleView, Shell, WordView, chips, render};
use crate::learner::{Counts, Question, Reply};
use crate::session::{
    ConflictCause, Decision, MAX_STATES, Position, Session, Setup, Task, offered, ready,
};
use crate::store::{Listed, SessionId};

type Fields = Result<FormBody<Vec<(String, String)>>, FormRejection>;

/// All routes of the pages.
pub(crate) fn routes() -> Router<AppState> {
    Router::new()
        .route("/", get(start))
        .route("/sessions", post(begin))
        .route("/sessions/{id}", get(show))
        .route("/sessions/{id}/answers", post(answer))
        .route("/sessions/{id}/retractions", post(retract))
        .route("/sessions/{id}/changes", post(change))
        .route("/sessions/{id}/bound", post(enlarge))
        .route("/sessions/{id}/history", get(history))
        .route("/sessions/{id}/automaton.svg", get(drawing))
}

fn read_form(fields: Fields) -> Result<Form, WebError> {
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

// ---- the start page --------------------------------------------------------

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

/// What is wrong with a form, and at which of its fields that is to be said.
#[derive(Clone, Default)]
struct Faults(Option<(&'static str, String)>);

impl Faults {
    /// The error at the field that it speaks of, or else at the first.
    fn of(error: &WebError, fields: &[&'static str]) -> Self {
        let path = error.field().unwrap_or_default();
        let named = path.split(['[', '.']).next().unwrap_or_default();
        let field = fields.iter().find(|field| **field == named);
        let field = field.or(fields.first()).copied().unwrap_or_default();
        Self(Some((field, error.message())))
    }

    /// What is to be said at this field.
    fn at(&self, field: &str) -> Option<&str> {
        let (faulty, message) = self.0.as_ref()?;
        (*faulty == field).then_some(message)
    }
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

async fn start(State(app): State<AppState>) -> Result<Response, PageError> {
    Ok(start_page(&app, OwnForm::default(), Faults::default()).await?)
}

async fn begin(State(app): State<AppState>, fields: Fields) -> Result<Response, PageError> {
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
    let id = app.teaching.create(task, Setup::default()).await?;
    Ok(Redirect::to(&format!("/sessions/{id}")).into_response())
}

// ---- a session -------------------------------------------------------------

#[derive(Template)]
#[template(path = "question.html")]
struct QuestionPage {
    shell: Shell,
    bar: Bar,
    notice: Option<String>,
    number: u32,
    first: WordView,
    second: Option<WordView>,
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
    chips: Vec<Chip>,
    names: String,
    empty: String,
    typed: String,
    label: String,
    faults: Faults,
}

#[derive(Template)]
#[template(path = "conflict.html")]
struct ConflictPage {
    shell: Shell,
    bar: Bar,
    notice: Option<String>,
    items: Vec<PastView>,
    cause: ConflictCause,
    minimal: bool,
    bound: Option<usize>,
    larger: Option<usize>,
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
}

/// What a person had typed when something was wrong with it.
#[derive(Clone, Default)]
struct Typed {
    notice: Option<String>,
    faults: Faults,
    word: String,
    label: String,
}

/// The page of a session as it stands.
fn page(id: SessionId, session: &Session, typed: Typed) -> Response {
    let task = session.task();
    let bar = Bar::of(id.to_string(), session);
    let shell = Shell::of(bar.clone());
    let notice = typed.notice;
    match session.position() {
        Position::Thinking => PageError(WebError::Slow).into_response(),
        Position::Asking(number) => {
            let Some(asked) = session.asked(*number) else {
                return PageError(WebError::Slow).into_response();
            };
            let (first, second) = match &asked.question {
                Question::Membership { atom } => (WordView::of(atom, task), None),
                Question::Comparison { first, second } => {
                    let (first, second) = WordView::pair(first, second, task);
                    (first, Some(second))
                }
                Question::Equivalence { hypothesis } => {
                    let names: Vec<&str> = session.alphabet().names().collect();
                    return render(&EquivalencePage {
                        shell,
                        bar,
                        notice,
                        number: *number,
                        rule: RuleView::of(hypothesis, task),
                        chips: chips(task),
                        names: names.join(", "),
                        empty: task.empty.clone(),
                        typed: typed.word,
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
            cause: conflict.cause,
            minimal: conflict.minimal,
            bound: conflict.bound,
            larger: conflict
                .bound
                .map(|bound| (bound * 2).min(MAX_STATES))
                .filter(|larger| *larger > task.max_states),
        }),
        Position::Done(hypothesis) => render(&DonePage {
            shell,
            bar,
            notice,
            rule: RuleView::of(hypothesis, task),
            counts: session.counts(),
            files: downloads(id),
            agreed: session
                .standing()
                .iter()
                .rev()
                .find(|s| s.reply == Reply::Correct)
                .map(|s| s.number),
        }),
    }
}

fn downloads(id: SessionId) -> Vec<Download> {
    let automata = export::OFFERED
        .iter()
        .map(|&(format, title, about)| Download {
            format: format.name(),
            title,
            about,
            href: format!("/api/v1/sessions/{id}/automaton?format={}", format.name()),
        });
    let log = Download {
        format: "log",
        title: "Log",
        about: "every question and answer, one a line",
        href: format!("/api/v1/sessions/{id}/log"),
    };
    automata.chain([log]).collect()
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
        Ok(()) => Ok(Redirect::to(&format!("/sessions/{id}")).into_response()),
        Err(error) if error.is_refusal() => {
            let typed = match error.field() {
                Some("word" | "label") => Typed {
                    faults: Faults::of(&error, &["word", "label"]),
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
        word: form.text("word").to_owned(),
        label: form.text("label").to_owned(),
        ..Typed::default()
    };
    let decide = move |session: &Session| {
        let reply = form.reply(session.alphabet())?;
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
        let reply = form.reply(session.alphabet())?;
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
    word: WordView,
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
            let word = session.alphabet().word(&example.word).ok()?;
            Some(ExampleView {
                word: WordView::of(&word, task),
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
    let view = |session: &Session| {
        let hypothesis = session.hypothesis().ok_or(WebError::NoAutomaton)?;
        export::write(hypothesis, session.task(), export::Format::Svg)
    };
    let svg = app.teaching.look(id, view).await??;
    Ok(super::typed("image/svg+xml", svg))
}
