//! A behaviour run through a rule that is an automaton, step by step.

use super::behaviour::{Chip, chips};
use super::export;
use super::forms;
use crate::draw;
use crate::session::{Concept, Session};

/// A form that runs behaviours through a rule, and what came of the last.
pub(crate) struct TraceView {
    pub(crate) chips: Vec<Chip>,
    pub(crate) typed: String,
    /// Why what was typed is no behaviour.
    pub(crate) fault: Option<String>,
    /// The states that it goes through, the start first; empty before one is typed.
    pub(crate) steps: Vec<StepView>,
    /// Whether the rule accepts it.
    pub(crate) accepted: bool,
}

/// Where a step leads.
pub(crate) struct StepView {
    /// What happens; nothing before the first step.
    pub(crate) by: Option<String>,
    pub(crate) state: usize,
    pub(crate) phrase: String,
}

impl TraceView {
    /// Of a rule, with what was typed; none where the rule is no automaton.
    pub(crate) fn of(rule: &Concept, session: &Session, typed: Option<&str>) -> Option<Self> {
        let Concept::Automaton(dfa) = rule else {
            return None;
        };
        let task = session.task();
        let mut view = Self {
            chips: chips(task),
            typed: typed.unwrap_or_default().to_owned(),
            fault: None,
            steps: Vec::new(),
            accepted: false,
        };
        let Some(typed) = typed else {
            return Some(view);
        };
        let word = match forms::typed_word(typed, "trace", dfa.alphabet()) {
            Ok(word) => word,
            Err(error) => {
                view.fault = Some(error.message);
                return Some(view);
            }
        };
        let order = draw::numbered(dfa);
        let phrases = draw::phrases(dfa, &export::captions(task).words);
        let mut state = dfa.start();
        let mut step = |by: Option<String>, state| {
            let number = order.iter().position(|known| *known == state);
            let number = number.unwrap_or_default();
            view.steps.push(StepView {
                by,
                state: number,
                phrase: phrases[number].clone(),
            });
        };
        step(None, state);
        for symbol in word.iter() {
            state = dfa.next(state, symbol);
            step(Some(task.text(symbol).to_owned()), state);
        }
        view.accepted = dfa.is_accepting(state);
        Some(view)
    }
}
