//! The owner's page about the people who answer: whom to invite, what they are to
//! answer, how they do it and how far they agree.

use std::sync::{Arc, Mutex, PoisonError};

use askama::Template;
use axum::Router;
use axum::extract::{Path, State};
use axum::response::{IntoResponse, Redirect, Response};
use axum::routing::{get, post};

use super::AppState;
use super::api::session_id;
use super::behaviour::{BehaviourView, Content};
use super::error::{PageError, WebError};
use super::forms::Form;
use super::owner;
use super::pages::{Fields, read_form};
use super::past::{Choice, PastView, said};
use super::views::{Bar, Shell, render};
use crate::session::{
    Agreement, Concept, Decision, Event, MAX_ANSWERS, MAX_NAME, Malformed, Pooling, Position,
    Refusal, Session, Terms,
};
use crate::store::{InviteKey, SessionId};

/// All routes of the owner's page.
pub(crate) fn routes() -> Router<AppState> {
    Router::new()
        .route("/sessions/{id}/people", get(show).post(invite))
        .route("/sessions/{id}/people/terms", post(set_terms))
        .route("/sessions/{id}/people/{person}/link", post(new_link))
        .route("/sessions/{id}/people/{person}/dismissal", post(dismiss))
}

#[derive(Template)]
#[template(path = "people.html")]
struct PeoplePage {
    shell: Shell,
    bar: Bar,
    notice: Option<String>,
    terms: Terms,
    people: Vec<PersonView>,
    /// Those who teach alone.
    alone: Vec<AloneView>,
    /// A link that was just made: for whom, and its path. It is shown this once.
    link: Option<(String, String)>,
    agreement: AgreementView,
    disputes: Vec<Dispute>,
    /// The questions that are open.
    open: usize,
    most: u32,
    longest: usize,
}

struct PersonView {
    number: u32,
    name: String,
    left: bool,
    /// The question that they are at.
    at: Option<u32>,
    answers: usize,
    skipped: usize,
    time: String,
    repeated: String,
    reliability: String,
}

/// Numbers as they are read.
struct AgreementView {
    questions: usize,
    same: String,
    kappa: Option<String>,
    alpha: Option<String>,
}

/// A question on which people do not agree.
struct Dispute {
    number: u32,
    first: Option<BehaviourView>,
    second: Option<BehaviourView>,
    /// Who said what.
    said: Vec<(String, &'static str)>,
    choices: Vec<Choice>,
}

impl From<Agreement> for AgreementView {
    fn from(agreement: Agreement) -> Self {
        let two = |number: f64| format!("{number:.2}");
        Self {
            questions: agreement.questions,
            same: agreement
                .same
                .map_or_else(|| "–".to_owned(), |same| format!("{:.0} %", 100.0 * same)),
            kappa: agreement.kappa.map(two),
            alpha: agreement.alpha.map(two),
        }
    }
}

/// A time for people.
fn seconds(ms: Option<u64>) -> String {
    match ms {
        None => "–".to_owned(),
        Some(ms) => format!("{:.1} s", ms as f64 / 1000.0),
    }
}

impl PeoplePage {
    fn of(
        id: SessionId,
        session: &Session,
        at_work: &[(u32, u32)],
        alone: Vec<AloneView>,
        notice: Option<String>,
        link: Option<Link>,
    ) -> Self {
        let bar = Bar::of(id, session);
        let panel = session.panel();
        let shared = panel
            .people()
            .iter()
            .filter(|(_, person)| person.session.is_none());
        let people = shared.map(|(&number, person)| {
            let record = panel.record(number);
            let at = at_work.iter().find(|(who, _)| *who == number);
            PersonView {
                number,
                name: person.name.clone(),
                left: person.left,
                at: at.map(|(_, question)| *question),
                answers: record.answers,
                skipped: record.skipped,
                time: seconds(record.median_ms),
                repeated: match record.repeated {
                    0 => "–".to_owned(),
                    all => format!("{} of {all}", record.consistent),
                },
                reliability: format!("{:.2}", record.reliability),
            }
        });
        let link = link.and_then(|(person, path)| {
            let name = panel.people().get(&person)?.name.clone();
            Some((name, path))
        });
        let disputed = session.open().filter(|number| panel.disagrees(*number));
        Self {
            shell: Shell::of(bar.clone()),
            bar,
            notice,
            terms: panel.terms().clone(),
            people: people.collect(),
            alone,
            link,
            agreement: panel.agreement().into(),
            disputes: disputed
                .filter_map(|number| Dispute::of(number, session))
                .collect(),
            open: session.open().count(),
            most: MAX_ANSWERS,
            longest: MAX_NAME,
        }
    }
}

impl Dispute {
    fn of(number: u32, session: &Session) -> Option<Self> {
        let panel = session.panel();
        let opinions = panel.opinions(number);
        let past = PastView::said(number, &crate::learner::Reply::Skip, session)?;
        let name = |person: u32| {
            let known = panel.people().get(&person);
            known.map_or_else(|| person.to_string(), |person| person.name.clone())
        };
        Some(Self {
            number,
            first: past.first,
            second: past.second,
            said: (opinions.iter())
                .map(|one| (name(one.person), said(&one.reply)))
                .collect(),
            choices: past.others,
        })
    }
}

/// Somebody who teaches alone.
struct AloneView {
    name: String,
    home: String,
    answers: u32,
    state: &'static str,
    /// Which of the rules that people came to is theirs, from 1.
    rule: Option<usize>,
}

/// How far those are who teach alone, and whose rules are the same.
async fn alone(app: &AppState, id: SessionId) -> Result<Vec<AloneView>, WebError> {
    let own = |session: &Session| -> Vec<(String, String)> {
        let people = session.panel().people().values();
        people
            .filter_map(|person| Some((person.name.clone(), person.session.clone()?)))
            .collect()
    };
    let mut rules: Vec<Concept> = Vec::new();
    let mut views = Vec::new();
    for (name, session) in app.teaching.look(id, own).await? {
        let theirs: SessionId = session.parse().map_err(WebError::internal)?;
        let standing = |session: &Session| {
            let counts = session.counts();
            let answers = counts.membership + counts.comparison + counts.equivalence;
            let (state, rule) = match session.position() {
                Position::Done(rule) => ("done", Some(rule.clone())),
                Position::Conflict(_) => ("at answers that contradict each other", None),
                Position::Asking(_) | Position::Thinking => ("answering", None),
            };
            (answers, state, rule)
        };
        let (answers, state, rule) = app.teaching.look(theirs, standing).await?;
        let rule = rule.map(|rule| {
            let known = rules.iter().position(|known| *known == rule);
            known.unwrap_or_else(|| {
                rules.push(rule);
                rules.len() - 1
            })
        });
        views.push(AloneView {
            name,
            home: format!("/sessions/{theirs}"),
            answers,
            state,
            rule: rule.map(|place| place + 1),
        });
    }
    Ok(views)
}

/// The page as the session stands.
async fn page(
    app: &AppState,
    id: SessionId,
    notice: Option<String>,
    link: Option<Link>,
) -> Result<Response, WebError> {
    let at_work = app.teaching.leases().at_work(id);
    let alone = alone(app, id).await?;
    let link = link.map(|(person, path)| {
        let whole = app.door.whole(&path);
        (person, whole.unwrap_or(path))
    });
    let view = move |session: &Session| {
        render(&PeoplePage::of(id, session, &at_work, alone, notice, link))
    };
    app.teaching.look(id, view).await
}

async fn show(State(app): State<AppState>, Path(id): Path<String>) -> Result<Response, PageError> {
    Ok(page(&app, session_id(&id)?, None, None).await?)
}

/// Somebody's number, and the path at which they answer.
pub(crate) type Link = (u32, String);

fn path(key: &InviteKey) -> String {
    format!("/answer/{key}")
}

/// Invites somebody. Where everybody teaches alone, with a session of the same task
/// for them.
///
/// # Errors
///
/// If the session refuses.
pub(crate) async fn invited(app: &AppState, id: SessionId, name: String) -> Result<Link, WebError> {
    let asked = name.clone();
    let alone = move |session: &Session| -> Result<_, WebError> {
        session.invite(&asked, None)?;
        let alone = session.panel().terms().pooling == Pooling::Alone;
        Ok(alone.then(|| (session.task().clone(), session.setup().clone())))
    };
    let own = match app.teaching.look(id, alone).await?? {
        Some((task, setup)) => Some(app.teaching.create(task, setup).await?),
        None => None,
    };
    let chosen: Arc<Mutex<Option<u32>>> = Arc::default();
    let choice = Arc::clone(&chosen);
    let decide = move |session: &Session| {
        let own = own.map(|own| own.to_string());
        let decision = session.invite(&name, own)?;
        if let Decision::Append(Event::Invited { person, .. }) = &decision {
            *choice.lock().unwrap_or_else(PoisonError::into_inner) = Some(*person);
        }
        Ok(decision)
    };
    match app.teaching.act(id, decide, |_, _| ()).await {
        // They are invited, whatever else the session thinks about.
        Ok(()) | Err(WebError::Slow) => {}
        Err(error) => return Err(error),
    }
    let person = *chosen.lock().unwrap_or_else(PoisonError::into_inner);
    let person = person.ok_or_else(|| WebError::internal("nobody was invited"))?;
    Ok(match own {
        // Where everybody comes in, the session's own address is enough.
        Some(own) if !owner::is_locked(app).await? => (person, format!("/sessions/{own}")),
        _ => (person, path(&app.teaching.new_key(id, person).await?)),
    })
}

async fn invite(
    State(app): State<AppState>,
    Path(id): Path<String>,
    fields: Fields,
) -> Result<Response, PageError> {
    let id = session_id(&id)?;
    let form = read_form(fields)?;
    match invited(&app, id, form.text("name").to_owned()).await {
        Ok(link) => Ok(page(&app, id, None, Some(link)).await?),
        Err(error) => refused(&app, id, error).await,
    }
}

/// The page with what was wrong with a wish.
async fn refused(app: &AppState, id: SessionId, error: WebError) -> Result<Response, PageError> {
    if !error.is_refusal() {
        return Err(error.into());
    }
    let page = page(app, id, Some(error.message()), None).await?;
    Ok((error.status(), page).into_response())
}

fn person(text: &str) -> Result<u32, WebError> {
    text.parse().map_err(|_| WebError::NoPage)
}

async fn new_link(
    State(app): State<AppState>,
    Path((id, number)): Path<(String, String)>,
) -> Result<Response, PageError> {
    let (id, person) = (session_id(&id)?, person(&number)?);
    let view = move |session: &Session| {
        let known = session.panel().people().get(&person);
        let known = known.filter(|person| person.session.is_none());
        known.map(|person| person.left)
    };
    match app.teaching.look(id, view).await? {
        None => return Err(WebError::NoPage.into()),
        Some(true) => return Err(WebError::from(Refusal::Dismissed).into()),
        Some(false) => {}
    }
    let key = app.teaching.new_key(id, person).await?;
    Ok(page(&app, id, None, Some((person, path(&key)))).await?)
}

async fn dismiss(
    State(app): State<AppState>,
    Path((id, number)): Path<(String, String)>,
) -> Result<Response, PageError> {
    let (id, person) = (session_id(&id)?, person(&number)?);
    app.teaching.leases().release(id, person);
    let decide = move |session: &Session| Ok(session.dismiss(person)?);
    wish(&app, id, decide).await
}

fn read_terms(form: &Form) -> Result<Terms, Malformed> {
    Ok(Terms {
        answers: form.number("answers")?,
        pooling: match form.text("pooling") {
            "majority" => Pooling::Majority,
            "reliability" => Pooling::Reliability,
            "alone" => Pooling::Alone,
            _ => return Err(Malformed::new("pooling", "choose how answers become one")),
        },
        shows_rule: form.has("shows_rule"),
    })
}

async fn set_terms(
    State(app): State<AppState>,
    Path(id): Path<String>,
    fields: Fields,
) -> Result<Response, PageError> {
    let id = session_id(&id)?;
    let form = read_form(fields)?;
    let decide = move |session: &Session| Ok(session.set_terms(read_terms(&form)?)?);
    wish(&app, id, decide).await
}

async fn wish(
    app: &AppState,
    id: SessionId,
    decide: impl Fn(&Session) -> Result<Decision, WebError> + Send + 'static,
) -> Result<Response, PageError> {
    match app.teaching.act(id, decide, |_, _| ()).await {
        Ok(()) | Err(WebError::Slow | WebError::Waiting) => {
            Ok(Redirect::to(&format!("/sessions/{id}/people")).into_response())
        }
        Err(error) => refused(app, id, error).await,
    }
}
