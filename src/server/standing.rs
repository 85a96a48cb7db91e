//! The page of a session as it stands: a question, a rule to look at, answers that
//! contradict each other, or the result.

use askama::Template;
use axum::response::{IntoResponse, Response};

use super::behaviour::{BehaviourView, Brief, Content, Legend};
use super::error::{PageError, WebError};
use super::follow::Follow;
use super::forms::Faults;
use super::past::{PastView, RecentView};
use super::rule::RuleView;
use super::spent::Spent;
use super::views::{Bar, Shell, render};
use super::{check, done};
use crate::learner::Question;
use crate::session::{MAX_STATES, Position, Session};
use crate::store::SessionId;

#[derive(Template)]
#[template(path = "question.html")]
pub(crate) struct QuestionPage {
    shell: Shell,
    bar: Bar,
    notice: Option<String>,
    number: u32,
    first: BehaviourView,
    second: Option<BehaviourView>,
    hurried: bool,
    /// Whether the sides are not those of the log.
    mirrored: bool,
    /// What the colours of the world mean.
    legend: Legend,
    /// The last answers.
    recent: Vec<RecentView>,
    /// The rule that was shown last, where people may see it.
    rule: Option<RuleView>,
}

/// A question as it is put to somebody.
pub(crate) struct Put {
    pub(crate) number: u32,
    pub(crate) first: BehaviourView,
    pub(crate) second: Option<BehaviourView>,
    pub(crate) mirrored: bool,
    pub(crate) hurried: bool,
    pub(crate) rule: Option<RuleView>,
    pub(crate) recent: Vec<RecentView>,
}

impl QuestionPage {
    pub(crate) fn of(
        shell: Shell,
        bar: Bar,
        notice: Option<String>,
        put: Put,
        session: &Session,
    ) -> Self {
        Self {
            shell,
            bar,
            notice,
            number: put.number,
            first: put.first,
            second: put.second,
            hurried: put.hurried,
            mirrored: put.mirrored,
            legend: Legend::of(session),
            recent: put.recent,
            rule: put.rule,
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

/// What a person had typed when something was wrong with it.
#[derive(Clone, Default)]
pub(crate) struct Typed {
    pub(crate) notice: Option<String>,
    pub(crate) faults: Faults,
    /// A word, or the name of a behaviour.
    pub(crate) atom: String,
    pub(crate) values: Vec<String>,
    pub(crate) label: String,
    /// What would follow each way to mend a contradiction.
    pub(crate) follows: Vec<Follow>,
}

/// What of a session's page is not in the session.
#[derive(Clone, Default)]
pub(crate) struct View {
    pub(crate) typed: Typed,
    /// The behaviour that is run through a rule on show.
    pub(crate) trace: Option<String>,
    /// The time that a session took which is done.
    pub(crate) spent: Option<Spent>,
    /// What was typed to begin the task once more.
    pub(crate) again: Vec<(String, String)>,
}

/// The page of a session as it stands.
pub(crate) fn page(id: SessionId, session: &Session, view: View) -> Response {
    let typed = view.typed.clone();
    let task = session.task();
    let bar = Bar::of(id, session);
    let shell = Shell::of(bar.clone());
    let showing = match session.position() {
        Position::Asking(number) => session.asked(*number).map(|asked| &asked.question),
        _ => None,
    };
    // Only the page of an equivalence query has the fields to say it at.
    let notice = match showing {
        Some(Question::Equivalence { .. }) => typed.notice.clone(),
        None if matches!(session.position(), Position::Done(_)) => typed.notice.clone(),
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
                    let frame = (shell, bar, notice);
                    return check::page(frame, (*number, hypothesis), session, view);
                }
            };
            let put = Put {
                number: *number,
                first,
                second,
                mirrored: false,
                hurried: asked.hurried,
                rule: None,
                recent: RecentView::last(session),
            };
            render(&QuestionPage::of(shell, bar, notice, put, session))
        }
        Position::Conflict(conflict) => render(&ConflictPage {
            shell,
            bar,
            notice,
            items: conflict
                .answers
                .iter()
                .filter_map(|&number| PastView::of(number, session))
                .map(|mut past| {
                    Follow::add_to(&typed.follows, &mut past);
                    past
                })
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
        Position::Done(hypothesis) => {
            done::page(id, (shell, bar, notice), hypothesis, session, view)
        }
    }
}
