//! A rule for people: an automaton drawn, limits with what was said about them, or
//! what is acceptable by name.

use automata::{Dfa, StateId};
use serde_json::json;

use super::chart::Chart;
use crate::draw::{self, Marks};
use crate::session::{Atom, Concept, Session, Task, Universe};

/// A rule for people.
pub(crate) enum RuleView {
    /// An automaton.
    Automaton(AutomatonView),
    /// Limits on what is measured.
    Limits(LimitsView),
    /// Behaviours by name.
    Items(ItemsView),
}

/// Limits on what is measured.
pub(crate) struct LimitsView {
    /// A phrase an axis.
    pub(crate) limits: Vec<String>,
    /// What is accepted as an area, where there are two axes.
    pub(crate) chart: Option<Chart>,
}

/// What a rule says of every behaviour.
pub(crate) struct ItemsView {
    /// What the rule is called.
    pub(crate) name: String,
    pub(crate) accepted: Vec<String>,
    pub(crate) rejected: Vec<String>,
}

impl RuleView {
    /// The rule of a session, with these marks on its drawing.
    pub(crate) fn of(concept: &Concept, session: &Session, marks: &Marks) -> Self {
        let universe = session.universe();
        match (universe, concept) {
            (_, Concept::Automaton(dfa)) => {
                Self::Automaton(AutomatonView::of(dfa, session.task(), marks))
            }
            (Universe::Monotone(axes), Concept::Parameter(most)) => Self::Limits(LimitsView {
                limits: axes.described(most),
                chart: Chart::of(axes, most, session),
            }),
            (Universe::Finite(table), Concept::Named(named)) => {
                let name = format!("This rule is called “{}”.", table.concept(*named));
                Self::items(name, concept, universe)
            }
            (Universe::Linear(rewards), Concept::Parameter(parameter)) => {
                let reward = rewards.reward(parameter);
                let weights: Vec<String> = (rewards.features().iter().zip(&reward.weights))
                    .map(|(name, weight)| format!("{name} {weight:+.2}"))
                    .collect();
                let name = format!(
                    "Acceptable is what adds up to more than {:.2}, each step counting {}.",
                    reward.threshold,
                    weights.join(", ")
                );
                Self::items(name, concept, universe)
            }
            (_, Concept::Parameter(_) | Concept::Named(_)) => {
                Self::items(String::new(), concept, universe)
            }
        }
    }

    fn items(name: String, concept: &Concept, universe: &Universe) -> Self {
        let (mut accepted, mut rejected) = (Vec::new(), Vec::new());
        for (place, item) in universe.items().into_iter().enumerate() {
            let atom = Atom::Item(place as u32);
            let side = if universe.accepts(concept, &atom) {
                &mut accepted
            } else {
                &mut rejected
            };
            side.push(item.to_owned());
        }
        Self::Items(ItemsView {
            name,
            accepted,
            rejected,
        })
    }

    /// Whether there is a drawing of an automaton.
    pub(crate) fn is_drawn(&self) -> bool {
        matches!(self, Self::Automaton(view) if view.svg.is_some())
    }

    /// The automaton's table as JSON, for the script that tries words.
    pub(crate) fn machine(&self) -> Option<&str> {
        match self {
            Self::Automaton(view) => Some(&view.machine),
            Self::Limits(_) | Self::Items(_) => None,
        }
    }
}

/// An automaton for people.
pub(crate) struct AutomatonView {
    /// The drawing, where it is not too large.
    pub(crate) svg: Option<String>,
    pub(crate) symbols: Vec<String>,
    /// The states in the order of their numbers in the drawing.
    pub(crate) rows: Vec<RowView>,
    /// Whether anything is marked as new.
    pub(crate) has_new: bool,
    /// The table as JSON, for the script that tries words.
    pub(crate) machine: String,
}

/// A state's line in the table.
pub(crate) struct RowView {
    pub(crate) state: usize,
    /// The state in words; none where those are its number.
    pub(crate) phrase: Option<String>,
    pub(crate) accepting: bool,
    pub(crate) is_new: bool,
    pub(crate) next: Vec<NextView>,
}

/// Where a symbol leads.
pub(crate) struct NextView {
    pub(crate) state: usize,
    pub(crate) is_new: bool,
}

impl AutomatonView {
    fn of(dfa: &Dfa, task: &Task, marks: &Marks) -> Self {
        let order = draw::numbered(dfa);
        let mut number = vec![0; dfa.size()];
        for (place, state) in order.iter().enumerate() {
            number[state.index()] = place;
        }
        let symbols = || dfa.alphabet().symbols();
        let phrases = draw::phrases(dfa, &super::export::captions(task).words);
        let row = |(place, (&state, phrase)): (usize, (&StateId, &String))| RowView {
            state: place,
            phrase: (!phrase.starts_with("state ")).then(|| phrase.clone()),
            accepting: dfa.is_accepting(state),
            is_new: marks.states().any(|marked| marked == state),
            next: symbols()
                .map(|symbol| NextView {
                    state: number[dfa.next(state, symbol).index()],
                    is_new: marks.arrows().any(|marked| marked == (state, symbol)),
                })
                .collect(),
        };
        let rows: Vec<RowView> = order.iter().zip(&phrases).enumerate().map(row).collect();
        let delta = |row: &RowView| -> Vec<usize> { row.next.iter().map(|n| n.state).collect() };
        let texts: Vec<&str> = symbols().map(|symbol| task.text(symbol)).collect();
        let machine = json!({
            "symbols": dfa.alphabet().names().collect::<Vec<_>>(),
            "texts": texts,
            "start": number[dfa.start().index()],
            "accepting": rows.iter().map(|row| row.accepting).collect::<Vec<_>>(),
            "delta": rows.iter().map(delta).collect::<Vec<_>>(),
            "phrases": phrases,
        });
        Self {
            svg: super::export::drawing(dfa, task, marks),
            symbols: texts.into_iter().map(str::to_owned).collect(),
            rows,
            has_new: !marks.is_empty(),
            machine: machine.to_string(),
        }
    }
}
