//! The page on which a rule is checked: what changed in it, behaviours to look at,
//! and a way to say what it treats wrongly.

use askama::Template;
use axum::response::Response;

use super::behaviour::{BehaviourView, Chip, Content, chips};
use super::forms::Faults;
use super::rule::RuleView;
use super::standing::View;
use super::trace::TraceView;
use super::views::{Bar, Shell, render};
use super::walk::WalkView;
use crate::draw::Marks;
use crate::session::{Atom, Concept, Session, Universe};
use crate::task::Axis;

#[derive(Template)]
#[template(path = "equivalence.html")]
struct CheckPage {
    shell: Shell,
    bar: Bar,
    notice: Option<String>,
    number: u32,
    rule: RuleView,
    trace: Option<TraceView>,
    sheet: Option<SheetView>,
    walk: Option<WalkView>,
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
    fn of(session: &Session, view: &View) -> Self {
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
                    typed: view.typed.values.get(place).cloned().unwrap_or_default(),
                };
                Self::Values(axes.axes().iter().enumerate().map(input).collect())
            }
            universe @ (Universe::Finite(_) | Universe::Linear(_)) => {
                Self::Items(universe.items().into_iter().map(str::to_owned).collect())
            }
        }
    }
}

/// Behaviours to look at.
struct SheetView {
    samples: Vec<SampleView>,
    /// How many were drawn; some may be the same.
    drawn: u32,
    drawn_from: String,
    /// The share that may be claimed, in percent.
    percent: u32,
}

/// A behaviour of the sheet.
struct SampleView {
    behaviour: BehaviourView,
    accepted: bool,
    /// How often it was drawn.
    times: usize,
    /// What a form says of it to call it treated wrongly.
    fields: Vec<(&'static str, String)>,
}

impl SheetView {
    fn of(number: u32, whole: &Concept, session: &Session) -> Option<Self> {
        let sheet = session.samples(number)?;
        let claim = sheet.claim()?;
        let mut atoms: Vec<(&Atom, usize)> = Vec::new();
        for atom in &sheet.atoms {
            match atoms.iter_mut().find(|(known, _)| *known == atom) {
                Some((_, times)) => *times += 1,
                None => atoms.push((atom, 1)),
            }
        }
        let samples = atoms.into_iter().map(|(atom, times)| {
            let accepted = session.universe().accepts(whole, atom);
            SampleView {
                behaviour: BehaviourView::of(atom, session),
                accepted,
                times,
                fields: fields(atom, session.universe()),
            }
        });
        Some(Self {
            samples: samples.collect(),
            drawn: claim.looked,
            percent: claim.percent(),
            drawn_from: sheet.drawn_from,
        })
    }
}

/// The fields of a form in which a behaviour is told, as the form below has them.
fn fields(atom: &Atom, universe: &Universe) -> Vec<(&'static str, String)> {
    match (atom, universe) {
        (Atom::Word(word), Universe::Words { alphabet, .. }) => {
            let names: Vec<&str> = alphabet.spell(word).collect();
            vec![("word", names.join(" "))]
        }
        (Atom::Point(point), Universe::Monotone(axes)) => {
            let values = axes.values(point).into_iter();
            values.map(|value| ("point", value.to_string())).collect()
        }
        _ => vec![("item", universe.spell(atom))],
    }
}

/// The page of a rule that is to be checked.
pub(crate) fn page(
    (shell, bar, notice): (Shell, Bar, Option<String>),
    (number, learned): (u32, &Concept),
    session: &Session,
    view: View,
) -> Response {
    let whole = session.whole(learned);
    let before = session.shown_before(number).map(|rule| session.whole(rule));
    let marks = match (&whole, before) {
        (Concept::Automaton(shown), Some(Concept::Automaton(before))) => {
            Marks::new_since(shown, &before.minimise())
        }
        _ => Marks::default(),
    };
    let trace = TraceView::of(&whole, session, view.trace.as_deref());
    let ask = Ask::of(session, &view);
    let traced = view.trace.unwrap_or_default();
    render(&CheckPage {
        shell,
        bar,
        notice,
        number,
        rule: RuleView::of(&whole, session, &marks),
        trace,
        sheet: SheetView::of(number, &whole, session),
        walk: WalkView::of(session),
        ask,
        typed: match view.typed.atom {
            typed if typed.is_empty() => traced,
            typed => typed,
        },
        label: view.typed.label,
        faults: view.typed.faults,
    })
}
