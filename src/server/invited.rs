//! The pages of an invited person: a question at a time, what they said, and nothing
//! of what others say.

use std::fmt;
use std::sync::Arc;

use askama::Template;
use axum::Router;
use axum::extract::{Path, State};
use axum::http::HeaderMap;
use axum::response::{IntoResponse, Redirect, Response};
use axum::routing::{get, post};

use super::AppState;
use super::behaviour::{BehaviourView, Brief};
use super::error::{PageError, WebError};
use super::leases::{Leases, Turn};
use super::owner::{self, Seat};
use super::pages::{Fields, HistoryPage, read_form};
use super::past::{PastView, RecentView};
use super::rule::RuleView;
use super::standing::{Put, QuestionPage};
use super::views::{Bar, Shell, render};
use super::{live, media, practice};
use crate::draw::Marks;
use crate::learner::{Question, Reply};
use crate::session::{Atom, Decision, Position, Session};
use crate::store::{InviteKey, SessionId};

/// All routes of invited people.
pub(crate) fn routes() -> Router<AppState> {
    Router::new()
        .route("/answer/{key}", get(door).post(enter))
        .route("/answer/s/{place}", get(show))
        .route("/answer/s/{place}/answers", post(answer))
        .route("/answer/s/{place}/retractions", post(retract))
        .route("/answer/s/{place}/history", get(history))
        .route("/answer/s/{place}/practice", get(practise).post(practised))
        .route("/answer/s/{place}/live", get(follow))
        .route("/answer/s/{place}/media/{*path}", get(file))
}

/// Who answers.
#[derive(Clone, Copy)]
pub(crate) struct Guest {
    /// Where their pages are: no secret, since whoever has no visit sees nothing there.
    place: Place,
    pub(crate) session: SessionId,
    pub(crate) person: u32,
}

/// Where an invited person's pages are, one place for each invitation: so that somebody
/// may have several in one browser. It is the beginning of what the store has of the
/// key, which tells nothing of the key.
#[derive(Clone, Copy)]
struct Place([u8; Place::DIGITS]);

impl Place {
    const DIGITS: usize = 16;

    fn of(digest: &str) -> Option<Self> {
        let is_digit = |b: &u8| matches!(b, b'0'..=b'9' | b'a'..=b'f');
        let digits: [u8; Self::DIGITS] = digest.as_bytes().get(..Self::DIGITS)?.try_into().ok()?;
        digits.iter().all(is_digit).then_some(Self(digits))
    }
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0
            .iter()
            .try_for_each(|digit| write!(f, "{}", char::from(*digit)))
    }
}

impl Guest {
    /// Who has this key; the session [has yet to admit](Self::admit) them.
    ///
    /// # Errors
    ///
    /// If nobody has it.
    pub(crate) async fn of(app: &AppState, key: &str) -> Result<Self, WebError> {
        let key = self::key(key)?;
        let (session, person) = app.teaching.invited(key).await?;
        let place = Place::of(&key.digest()).ok_or(WebError::NotInvited)?;
        Ok(Self {
            place,
            session,
            person,
        })
    }

    /// Who visits at this place; the session [has yet to admit](Self::admit) them.
    ///
    /// # Errors
    ///
    /// If that is nobody.
    async fn at(app: &AppState, place: &str, headers: &HeaderMap) -> Result<Self, WebError> {
        let known = Place::of(place).filter(|_| place.len() == Place::DIGITS);
        let known = known.ok_or(WebError::NotInvited)?;
        let (session, person) = owner::invited(app, headers, place).await?;
        Ok(Self {
            place: known,
            session,
            person,
        })
    }

    /// Lets them in if they still answer for the session itself. Whoever acts is
    /// admitted in the same turn in which that is decided on: one of its own would be
    /// waited for, and what was sent could get lost meanwhile.
    ///
    /// # Errors
    ///
    /// If they left, or teach alone in a session of their own.
    pub(crate) fn admit(&self, session: &Session) -> Result<(), WebError> {
        match self.known(session)? {
            None => Ok(()),
            Some(_) => Err(WebError::NotInvited),
        }
    }

    /// The session that they have to themselves, if they have one.
    fn known(&self, session: &Session) -> Result<Option<String>, WebError> {
        let known = session.panel().people().get(&self.person);
        let known = known.filter(|person| !person.left);
        let known = known.map(|person| person.session.clone());
        known.ok_or(WebError::NotInvited)
    }

    /// Whether there is something new for this person to do, were it put.
    pub(crate) fn wants(&self, session: &Session, leases: &Leases) -> bool {
        // Each of them may have one at hand, and as many may wait for others.
        let most = 2 * session.panel().people().len();
        leases.turn(self.session, session, self.person).is_none() && session.open().count() < most
    }

    fn home(&self) -> String {
        format!("/answer/s/{}", self.place)
    }

    fn bar(&self, session: &Session) -> Bar {
        Bar::invited(self.home(), session, self.person)
    }
}

#[derive(Template)]
#[template(path = "waiting.html")]
struct WaitingPage {
    shell: Shell,
    bar: Bar,
    notice: Option<String>,
    done: bool,
    recent: Vec<RecentView>,
}

/// The question that is this person's now.
fn page(guest: Guest, session: &Session, leases: &Leases, notice: Option<String>) -> Response {
    let bar = guest.bar(session);
    let shell = Shell::of(bar.clone());
    let turn = leases.turn(guest.session, session, guest.person);
    let recent = RecentView::said_by(guest.person, session);
    let (number, mirrored) = match turn {
        Some(Turn::Answer(number)) => (number, false),
        // With the sides changed, so that the place is not what is remembered.
        Some(Turn::Repeat(number)) => (number, true),
        None => {
            return render(&WaitingPage {
                shell,
                bar,
                notice,
                done: matches!(session.position(), Position::Done(_)),
                recent,
            });
        }
    };
    let Some(asked) = session.asked(number) else {
        return PageError(WebError::Slow).into_response();
    };
    let (first, second, mirrored) = match &asked.question {
        Question::Membership { atom } => (BehaviourView::of(atom, session), None, false),
        Question::Comparison { first, second } => {
            let (first, second) = BehaviourView::pair(first, second, session);
            if mirrored {
                (second, Some(first), true)
            } else {
                (first, Some(second), false)
            }
        }
        // Never an open question of theirs.
        Question::Equivalence { .. } => return PageError(WebError::NoPage).into_response(),
    };
    let shows_rule = session.panel().terms().shows_rule;
    let rule = session.last_shown().filter(|_| shows_rule);
    let put = Put {
        number,
        first,
        second,
        mirrored,
        hurried: false,
        rule: rule.map(|rule| RuleView::of(&rule, session, &Marks::default())),
        recent,
    };
    render(&QuestionPage::of(shell, bar, notice, put, session))
}

#[derive(Template)]
#[template(path = "door.html")]
struct DoorPage {
    shell: Shell,
    key: InviteKey,
}

fn key(text: &str) -> Result<InviteKey, WebError> {
    text.parse().map_err(|_| WebError::NotInvited)
}

/// `GET /answer/{key}`: a button to begin with. A look at the link changes nothing, as
/// programs take that show where a link leads before anybody follows it.
async fn door(
    State(app): State<AppState>,
    Path(text): Path<String>,
) -> Result<Response, PageError> {
    let guest = Guest::of(&app, &text).await?;
    let view = move |session: &Session| guest.known(session);
    app.teaching.look(guest.session, view).await??;
    let key = key(&text)?;
    Ok(render(&DoorPage {
        shell: Shell::plain("You are invited"),
        key,
    }))
}

/// `POST /answer/{key}`: a cookie for the key, which is in no address from then on.
async fn enter(
    State(app): State<AppState>,
    Path(text): Path<String>,
    headers: HeaderMap,
) -> Result<Response, PageError> {
    let key = key(&text)?;
    let guest = Guest::of(&app, &text).await?;
    let view = move |session: &Session| guest.known(session);
    let own = app.teaching.look(guest.session, view).await??;
    let home = own.map_or_else(|| guest.home(), |own| format!("/sessions/{own}"));
    let answer = Redirect::to(&home).into_response();
    let place = guest.place.to_string();
    Ok(owner::let_in(&app, &headers, &place, key.digest(), answer).await?)
}

async fn show(
    State(app): State<AppState>,
    Path(place): Path<String>,
    headers: HeaderMap,
) -> Result<Response, PageError> {
    let guest = Guest::at(&app, &place, &headers).await?;
    Ok(put(&app, guest, None).await?)
}

/// The page with the question that comes next for this person.
async fn put(app: &AppState, guest: Guest, notice: Option<String>) -> Result<Response, WebError> {
    let leases = app.teaching.leases();
    let (deciding, viewing) = (Arc::clone(leases), Arc::clone(leases));
    let admit = move |session: &Session| guest.admit(session);
    let wants = move |session: &Session| guest.wants(session, &deciding);
    let view = move |session: &Session, _: &Position| page(guest, session, &viewing, notice);
    (app.teaching)
        .put_another(guest.session, admit, wants, view)
        .await
}

/// What a person says: the entry to append.
///
/// # Errors
///
/// If the question is not theirs to answer.
pub(crate) fn say(
    session: &Session,
    person: u32,
    number: u32,
    reply: &Reply<Atom>,
    took: Option<u64>,
) -> Result<Decision, WebError> {
    Ok(match session.panel().due(person) {
        Some(due) if due == number => session.repeat(person, number, reply)?,
        _ => session.say(person, number, reply, took)?,
    })
}

async fn answer(
    State(app): State<AppState>,
    Path(place): Path<String>,
    headers: HeaderMap,
    fields: Fields,
) -> Result<Response, PageError> {
    let guest = Guest::at(&app, &place, &headers).await?;
    let form = read_form(fields)?;
    let decide = move |session: &Session| {
        let reply = form.reply(session.universe())?;
        let reply = match reply {
            Reply::Compared(comparison) if form.has("mirrored") => {
                Reply::Compared(comparison.mirrored())
            }
            reply => reply,
        };
        // What a browser says of time is believed if it is some.
        let took = form
            .text("took")
            .parse()
            .ok()
            .filter(|took| *took < 86_400_000);
        say(
            session,
            guest.person,
            form.number("question")?,
            &reply,
            took,
        )
    };
    done(&app, guest, decide).await
}

async fn retract(
    State(app): State<AppState>,
    Path(place): Path<String>,
    headers: HeaderMap,
    fields: Fields,
) -> Result<Response, PageError> {
    let guest = Guest::at(&app, &place, &headers).await?;
    let form = read_form(fields)?;
    let decide =
        move |session: &Session| Ok(session.unsay(guest.person, form.number("question")?)?);
    done(&app, guest, decide).await
}

/// Does what a form asks, and shows what is next.
async fn done(
    app: &AppState,
    guest: Guest,
    decide: impl Fn(&Session) -> Result<Decision, WebError> + Send + 'static,
) -> Result<Response, PageError> {
    let decide = move |session: &Session| {
        guest.admit(session)?;
        decide(session)
    };
    match app.teaching.act(guest.session, decide, |_, _| ()).await {
        Ok(()) | Err(WebError::Slow | WebError::Waiting) => {
            app.teaching.leases().release(guest.session, guest.person);
            Ok(Redirect::to(&guest.home()).into_response())
        }
        Err(error) if error.is_refusal() => {
            app.teaching.leases().release(guest.session, guest.person);
            let page = put(app, guest, Some(error.message())).await?;
            Ok((error.status(), page).into_response())
        }
        Err(error) => Err(error.into()),
    }
}

async fn history(
    State(app): State<AppState>,
    Path(place): Path<String>,
    headers: HeaderMap,
) -> Result<Response, PageError> {
    let guest = Guest::at(&app, &place, &headers).await?;
    let view = move |session: &Session| {
        guest.admit(session)?;
        let bar = guest.bar(session);
        let answered = session.panel().answered_by(guest.person).iter().rev();
        let items = answered.filter_map(|&number| {
            let said = session.panel().said(guest.person, number)?;
            let mut past = PastView::said(number, &said.reply, session)?;
            // Once it is withdrawn, the question comes again.
            past.others.clear();
            Some(past)
        });
        Ok::<_, WebError>(render(&HistoryPage {
            shell: Shell::of(bar.clone()),
            bar,
            notice: None,
            items: items.collect(),
            examples: Vec::new(),
        }))
    };
    Ok(app.teaching.look(guest.session, view).await??)
}

async fn practise(
    State(app): State<AppState>,
    Path(place): Path<String>,
    headers: HeaderMap,
) -> Result<Response, PageError> {
    let guest = Guest::at(&app, &place, &headers).await?;
    let view = move |session: &Session| {
        guest.admit(session)?;
        practice::page(guest.bar(session), session, None)
    };
    Ok(app.teaching.look(guest.session, view).await??)
}

async fn practised(
    State(app): State<AppState>,
    Path(place): Path<String>,
    headers: HeaderMap,
    fields: Fields,
) -> Result<Response, PageError> {
    let guest = Guest::at(&app, &place, &headers).await?;
    let form = read_form(fields)?;
    let view = move |session: &Session| {
        guest.admit(session)?;
        practice::page(guest.bar(session), session, Some(form.text("answer")))
    };
    Ok(app.teaching.look(guest.session, view).await??)
}

async fn follow(
    State(app): State<AppState>,
    Path(place): Path<String>,
    headers: HeaderMap,
) -> Result<Response, PageError> {
    let guest = Guest::at(&app, &place, &headers).await?;
    let view = move |session: &Session| guest.admit(session);
    app.teaching.look(guest.session, view).await??;
    let seat = Seat::Invited { place };
    let news = live::news(&app, guest.session, headers, seat, Some(guest)).await?;
    Ok(news.into_response())
}

async fn file(
    State(app): State<AppState>,
    Path((place, path)): Path<(String, String)>,
    headers: HeaderMap,
) -> Result<Response, PageError> {
    let guest = Guest::at(&app, &place, &headers).await?;
    let view = move |session: &Session| guest.admit(session);
    app.teaching.look(guest.session, view).await??;
    Ok(media::serve(&app, guest.session, path, &headers).await?)
}
