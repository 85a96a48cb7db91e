//! What is left to be learned, and why the open question is asked, for people.

use askama::Template;
use axum::extract::{Path, State};
use axum::response::Response;

use super::AppState;
use super::api::session_id;
use super::behaviour::{BehaviourView, Content};
use super::error::{PageError, WebError};
use super::export;
use super::past::said;
use super::rule::RuleView;
use super::views::{Bar, Shell, render};
use crate::draw::Marks;
use crate::learner::{Counts, Left, Question, Removed};
use crate::session::{Atom, Concept, Position, Session};
use crate::store::SessionId;

/// How much is left, in numbers that can be read at a glance.
#[derive(Clone)]
pub(crate) struct LeftView {
    /// The rules that fit: "12", or "more than 340".
    pub(crate) rules: String,
    /// Whether that is one.
    pub(crate) only: bool,
    /// Bits to a tenth, with "at least" where it is more.
    pub(crate) bits: String,
    /// The questions to be expected, and from how many to how many.
    pub(crate) questions: Option<QuestionsView>,
}

/// Whole numbers of questions.
#[derive(Clone)]
pub(crate) struct QuestionsView {
    pub(crate) about: u32,
    pub(crate) low: u32,
    pub(crate) high: u32,
}

impl LeftView {
    /// What was left when the open question was put; none where none is open, or
    /// nothing is known about it.
    pub(crate) fn of(session: &Session) -> Option<Self> {
        match session.position() {
            Position::Asking(number) => session.asked(*number)?.left.map(Self::from),
            _ => None,
        }
    }
}

impl From<Left> for LeftView {
    fn from(left: Left) -> Self {
        let (many, at_least) = if left.exact {
            ("", "")
        } else {
            ("more than ", "at least ")
        };
        #[expect(clippy::cast_sign_loss, reason = "it is at least one")]
        let whole = |number: f64| number.round().max(1.0) as u32;
        Self {
            rules: format!("{many}{}", left.concepts),
            only: left.exact && left.concepts == 1,
            bits: format!("{at_least}{:.1}", left.bits.abs()),
            questions: left.questions.map(|expected| QuestionsView {
                about: whole(expected.mean),
                low: whole(expected.low.floor()),
                high: whole(expected.high.ceil()),
            }),
        }
    }
}

/// What an answer would rule out.
struct EffectView {
    answer: &'static str,
    removed: usize,
    /// Of a hundred, to draw a bar.
    share: usize,
}

#[derive(Template)]
#[template(path = "why.html")]
struct WhyPage {
    shell: Shell,
    bar: Bar,
    first: Option<BehaviourView>,
    second: Option<BehaviourView>,
    left: Option<LeftView>,
    effects: Vec<EffectView>,
    /// Two rules that the question tells apart, with what each says.
    rivals: Vec<RivalView>,
    counts: Counts,
    costs: Costs,
}

/// What was spent on answers, by the costs that were told.
struct Costs {
    comparisons: String,
    judgements: String,
    all: String,
}

struct RivalView {
    rule: RuleView,
    says: String,
}

impl Costs {
    fn of(session: &Session) -> Self {
        let (counts, setup) = (session.counts(), session.setup());
        let spent = |count: u32, cost: f64| match count {
            0 => 0.0,
            _ => f64::from(count) * cost,
        };
        let comparisons = spent(counts.comparison, setup.comparison_cost);
        let judgements = spent(
            counts.membership + counts.conformance,
            setup.membership_cost,
        );
        let text = |cost: f64| format!("{}", (cost * 100.0).round() / 100.0);
        Self {
            comparisons: text(comparisons),
            judgements: text(judgements),
            all: text(comparisons + judgements),
        }
    }
}

/// What a rule says of a question.
fn says(question: &Question<Atom, Concept>, rule: &Concept, session: &Session) -> String {
    let label = |atom: &Atom| {
        if session.universe().accepts(rule, atom) {
            "acceptable"
        } else {
            "not acceptable"
        }
    };
    match question {
        Question::Membership { atom } => format!("By this rule it is {}.", label(atom)),
        Question::Comparison { first, second } => {
            let (first, second) = (label(first), label(second));
            if first == second {
                format!("By this rule both are {first}.")
            } else {
                format!("By this rule A is {first} and B is {second}.")
            }
        }
        Question::Equivalence { .. } => String::new(),
    }
}

impl RivalView {
    /// Both, with where they differ marked on the drawings.
    fn pair(
        rivals: &[Concept; 2],
        question: &Question<Atom, Concept>,
        session: &Session,
    ) -> Vec<Self> {
        let whole = rivals.each_ref().map(|rival| session.whole(rival));
        let other = |place: usize| &whole[1 - place];
        let view = |(place, rule): (usize, &Concept)| {
            let mut view = RuleView::of(rule, session, &Marks::default());
            if let (RuleView::Automaton(view), Concept::Automaton(one), Concept::Automaton(other)) =
                (&mut view, rule, other(place))
            {
                let marks = Marks::in_dispute(one, other);
                view.svg = export::drawing(one, session.task(), &marks);
            }
            Self {
                rule: view,
                says: says(question, rule, session),
            }
        };
        whole.iter().enumerate().map(view).collect()
    }
}

/// The page; none where no question is open.
fn page(id: SessionId, session: &Session) -> Result<Response, WebError> {
    let Position::Asking(number) = session.position() else {
        return Err(WebError::NoPage);
    };
    let asked = session.asked(*number).ok_or(WebError::NoPage)?;
    let (first, second) = match &asked.question {
        Question::Membership { atom } => (Some(BehaviourView::of(atom, session)), None),
        Question::Comparison { first, second } => {
            let (first, second) = BehaviourView::pair(first, second, session);
            (Some(first), Some(second))
        }
        Question::Equivalence { .. } => (None, None),
    };
    let all = asked.left.map_or(0, |left| left.concepts);
    let effect = |removed: &Removed| EffectView {
        answer: said(&removed.answer.reply()),
        removed: removed.concepts,
        share: 100 * removed.concepts / all.max(1),
    };
    let rivals = session.fork().rivals();
    let bar = Bar::of(id, session);
    Ok(render(&WhyPage {
        shell: Shell::of(bar.clone()),
        bar,
        first,
        second,
        left: asked.left.map(LeftView::from),
        effects: asked.removed.iter().map(effect).collect(),
        rivals: rivals.map_or_else(Vec::new, |rivals| {
            RivalView::pair(&rivals, &asked.question, session)
        }),
        counts: session.counts(),
        costs: Costs::of(session),
    }))
}

/// `GET /sessions/{id}/why`.
pub(crate) async fn why(
    State(app): State<AppState>,
    Path(id): Path<String>,
) -> Result<Response, PageError> {
    let id = session_id(&id)?;
    let view = move |session: &Session| page(id, session);
    Ok(app.teaching.look(id, view).await??)
}
