//! The page of a session as it stands: a question, a rule to look at, answers that
//! contradict each other, or the result.

use askama::Template;
use axum::response::{IntoResponse, Response};

use super::behaviour::{BehaviourView, Brief, Chip, Content, chips, legend};
use super::error::{PageError, WebError};
use super::export;
use super::follow::Follow;
use super::forms::Faults;
use super::past::{PastView, RecentView};
use super::rule::RuleView;
use super::views::{Bar, Shell, render};
use crate::learner::{Counts, Question, Reply};
use crate::session::{MAX_STATES, Position, Session, Universe};
use crate::store::SessionId;
use crate::task::Axis;
use crate::world::World;

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
    /// What the colours of the world mean.
    legend: Vec<Chip>,
    /// The last answers.
    recent: Vec<RecentView>,
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

/// The page of a session as it stands.
pub(crate) fn page(id: SessionId, session: &Session, typed: Typed) -> Response {
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
                legend: legend(session),
                recent: RecentView::last(session),
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
        Position::Done(hypothesis) => render(&DonePage {
            shell,
            bar,
            notice,
            rule: RuleView::of(&session.whole(hypothesis), session),
            counts: session.counts(),
            files: downloads(id, session),
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

fn downloads(id: SessionId, session: &Session) -> Vec<Download> {
    let automaton = |&(format, title, about): &(export::Format, _, _)| Download {
        format: format.name(),
        title,
        about,
        href: format!("/api/v1/sessions/{id}/automaton?format={}", format.name()),
    };
    let rules: Vec<Download> = match session.universe() {
        Universe::Words { .. } => export::OFFERED.iter().map(automaton).collect(),
        Universe::Monotone(_) | Universe::Finite(_) | Universe::Linear(_) => vec![Download {
            format: "json",
            title: "JSON",
            about: "the rule, for programs",
            href: format!("/api/v1/sessions/{id}/concept"),
        }],
    };
    let part = session.has_prior().then(|| Download {
        format: "part",
        title: "Learned part",
        about: "as JSON, without what was known beforehand",
        href: format!("/api/v1/sessions/{id}/automaton?part=learned"),
    });
    let log = Download {
        format: "log",
        title: "Log",
        about: "every question and answer, one a line",
        href: format!("/api/v1/sessions/{id}/log"),
    };
    rules.into_iter().chain(part).chain([log]).collect()
}
