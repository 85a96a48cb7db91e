//! The page of a rule that was agreed on: the rule, what it took, files to take
//! away, and what to do next.

use askama::Template;
use axum::response::Response;

use super::behaviour::{BehaviourView, Content};
use super::export;
use super::forms::Faults;
use super::rule::RuleView;
use super::spent::{Effort, Spent};
use super::standing::View;
use super::trace::TraceView;
use super::views::{Bar, Shell, render};
use crate::draw::Marks;
use crate::learner::{Reply, Strategy};
use crate::session::{Claim, Concept, MAX_STATES, Session, Universe};
use crate::store::SessionId;
use crate::world::World;

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
    trace: Option<TraceView>,
    claim: Option<ClaimView>,
    effort: Effort,
    spent: Option<Spent>,
    files: Vec<Download>,
    agreed: Option<u32>,
    /// What nothing that can be shown decides; and whether that is recordings.
    beyond: Option<BehaviourView>,
    recorded: bool,
    again: AgainView,
    faults: Faults,
}

/// What may be claimed, in numbers.
struct ClaimView {
    looked: u32,
    percent: u32,
    drawn_from: String,
}

impl ClaimView {
    fn of(claim: Claim) -> Self {
        Self {
            looked: claim.looked,
            percent: claim.percent(),
            drawn_from: claim.drawn_from,
        }
    }
}

/// The form that begins the same task with other settings.
#[derive(Clone)]
struct AgainView {
    strategy: String,
    membership_cost: String,
    comparison_cost: String,
    seed: String,
    /// None where nothing learned has states.
    max_states: Option<String>,
    most: usize,
}

/// A strategy, with what people are told of it.
const STRATEGIES: [(&str, Strategy, &str); 4] = [
    (
        "bayes",
        Strategy::Bayes,
        "the question worth most for its cost",
    ),
    (
        "exp4+",
        Strategy::Exp4Plus,
        "a bandit with the same guesses",
    ),
    ("thesis", Strategy::Thesis, "the bandit as first published"),
    (
        "membership",
        Strategy::Membership,
        "the bandit without comparisons",
    ),
];

impl AgainView {
    fn of(session: &Session, view: &View) -> Self {
        let setup = session.setup();
        let name = STRATEGIES.iter().find(|(_, s, _)| *s == setup.strategy);
        let has_states = matches!(session.universe(), Universe::Words { .. });
        let typed = |name: &str, usual: String| {
            let fields = view.again.iter();
            let mut named = fields.filter(|(key, _)| key == name);
            named.next().map_or(usual, |(_, value)| value.clone())
        };
        Self {
            strategy: typed(
                "strategy",
                name.map_or("bayes", |(name, ..)| *name).to_owned(),
            ),
            membership_cost: typed("membership_cost", setup.membership_cost.to_string()),
            comparison_cost: typed("comparison_cost", setup.comparison_cost.to_string()),
            seed: typed("seed", setup.seed.to_string()),
            max_states: has_states
                .then(|| typed("max_states", session.task().max_states.to_string())),
            most: MAX_STATES,
        }
    }

    /// The strategies by name, with a sentence each, and whether it is chosen.
    fn strategies(&self) -> impl Iterator<Item = (&'static str, &'static str, bool)> {
        let told = |(name, _, about): &(&'static str, Strategy, &'static str)| {
            (*name, *about, *name == self.strategy)
        };
        STRATEGIES.iter().map(told).collect::<Vec<_>>().into_iter()
    }
}

/// The page of a session that is done.
pub(crate) fn page(
    id: SessionId,
    (shell, bar, notice): (Shell, Bar, Option<String>),
    learned: &Concept,
    session: &Session,
    view: View,
) -> Response {
    let whole = session.whole(learned);
    let again = AgainView::of(session, &view);
    let rule = RuleView::of(&whole, session, &Marks::default());
    render(&DonePage {
        shell,
        bar,
        notice,
        trace: TraceView::of(&whole, session, view.trace.as_deref()),
        claim: session.claim().map(ClaimView::of),
        effort: Effort::of(session),
        spent: view.spent,
        files: downloads(id, session, rule.is_drawn()),
        rule,
        beyond: (session.beyond()).map(|atom| BehaviourView::of(&atom, session)),
        recorded: matches!(session.world(), Some(World::Pool(_))),
        agreed: session
            .standing()
            .iter()
            .rev()
            .find(|s| s.reply == Reply::Correct)
            .map(|s| s.number),
        again,
        faults: view.typed.faults,
    })
}

fn downloads(id: SessionId, session: &Session, is_drawn: bool) -> Vec<Download> {
    let automaton = |&(format, title, about): &(export::Format, _, _)| Download {
        format: format.name(),
        title,
        about,
        href: format!("/api/v1/sessions/{id}/automaton?format={}", format.name()),
    };
    let rules: Vec<Download> = match session.universe() {
        Universe::Words { .. } => export::OFFERED
            .iter()
            .filter(|(format, ..)| is_drawn || *format != export::Format::Svg)
            .map(automaton)
            .collect(),
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
