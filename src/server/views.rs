//! What the templates show, and how it is made from a session.

use askama::Template;
use automata::{Dfa, Word};
use axum::http::StatusCode;
use axum::http::header::{HeaderValue, RETRY_AFTER};
use axum::response::{Html, IntoResponse, Response};
use serde_json::json;

use super::assets;
use super::error::WebError;
use crate::evidence::Comparison;
use crate::learner::{Question, Reply};
use crate::session::{Session, Task};

/// What every page has around its content.
pub(crate) struct Shell {
    pub(crate) title: String,
    pub(crate) stamp: String,
    pub(crate) session: Option<Bar>,
}

impl Shell {
    /// A page that belongs to no session.
    pub(crate) fn plain(title: &str) -> Self {
        Self {
            title: title.to_owned(),
            stamp: format!("{:08x}", assets::STAMP),
            session: None,
        }
    }

    /// A page of a session.
    pub(crate) fn of(bar: Bar) -> Self {
        Self {
            title: bar.title.clone(),
            session: Some(bar),
            ..Self::plain("")
        }
    }
}

/// A session's line at the top.
#[derive(Clone)]
pub(crate) struct Bar {
    pub(crate) id: String,
    pub(crate) title: String,
    pub(crate) answered: usize,
    pub(crate) guidelines: String,
    /// The last standing answer.
    pub(crate) undo: Option<u32>,
}

impl Bar {
    pub(crate) fn of(id: String, session: &Session) -> Self {
        let task = session.task();
        let counts = session.counts();
        Self {
            id,
            title: task.title.clone(),
            answered: (counts.membership + counts.comparison + counts.equivalence) as usize,
            guidelines: task.guidelines.clone(),
            undo: session.standing().last().map(|s| s.number),
        }
    }
}

/// A symbol as a chip.
pub(crate) struct Chip {
    pub(crate) name: String,
    pub(crate) text: String,
    pub(crate) tone: usize,
    /// Part of the beginning that both words share.
    pub(crate) shared: bool,
    /// Where the two words part.
    pub(crate) parts: bool,
}

/// A word as a row of chips.
pub(crate) struct WordView {
    pub(crate) data: String,
    pub(crate) chips: Vec<Chip>,
    pub(crate) empty: String,
}

/// The number of tones that the style sheet has.
const TONES: usize = 8;

/// The task's symbols as chips.
pub(crate) fn chips(task: &Task) -> Vec<Chip> {
    let worded = task.symbols.iter().any(|symbol| symbol.word.is_some());
    task.symbols
        .iter()
        .enumerate()
        .map(|(i, symbol)| Chip {
            name: symbol.name.clone(),
            text: symbol.text().to_owned(),
            // The tones begin with the ones for danger and reward; bare letters
            // begin further on, so that they do not look like either.
            tone: (if worded { i } else { i + 2 }) % TONES,
            shared: false,
            parts: false,
        })
        .collect()
}

impl WordView {
    pub(crate) fn of(word: &Word, task: &Task) -> Self {
        Self::beside(word, None, task)
    }

    /// The word with what it shares with `other` marked.
    pub(crate) fn beside(word: &Word, other: Option<&Word>, task: &Task) -> Self {
        let common = other.map_or(0, |other| {
            word.iter()
                .zip(other.iter())
                .take_while(|(a, b)| a == b)
                .count()
        });
        let symbols = chips(task);
        let chips: Vec<Chip> = word
            .iter()
            .enumerate()
            .map(|(i, symbol)| {
                let chip = &symbols[symbol.index()];
                Chip {
                    name: chip.name.clone(),
                    text: chip.text.clone(),
                    tone: chip.tone,
                    shared: i < common,
                    parts: common > 0 && i == common,
                }
            })
            .collect();
        let names: Vec<&str> = chips.iter().map(|chip| chip.name.as_str()).collect();
        Self {
            data: names.join(" "),
            chips,
            empty: task.empty.clone(),
        }
    }

    pub(crate) fn pair(first: &Word, second: &Word, task: &Task) -> (Self, Self) {
        (
            Self::beside(first, Some(second), task),
            Self::beside(second, Some(first), task),
        )
    }
}

/// An automaton for people.
pub(crate) struct RuleView {
    /// The drawing, where it is not too large.
    pub(crate) svg: Option<String>,
    pub(crate) symbols: Vec<String>,
    pub(crate) rows: Vec<RowView>,
    /// The table as JSON, for the script that tries words.
    pub(crate) machine: String,
}

/// A state's line in the table.
pub(crate) struct RowView {
    pub(crate) state: usize,
    pub(crate) start: bool,
    pub(crate) accepting: bool,
    pub(crate) next: Vec<usize>,
}

impl RuleView {
    pub(crate) fn of(dfa: &Dfa, task: &Task) -> Self {
        let symbols = || dfa.alphabet().symbols();
        let rows: Vec<RowView> = dfa
            .states()
            .map(|state| RowView {
                state: state.index(),
                start: state == dfa.start(),
                accepting: dfa.is_accepting(state),
                next: symbols()
                    .map(|symbol| dfa.next(state, symbol).index())
                    .collect(),
            })
            .collect();
        let machine = json!({
            "symbols": dfa.alphabet().names().collect::<Vec<_>>(),
            "start": dfa.start().index(),
            "accepting": rows.iter().map(|row| row.accepting).collect::<Vec<_>>(),
            "delta": rows.iter().map(|row| &row.next).collect::<Vec<_>>(),
        });
        Self {
            svg: super::export::drawing(dfa, task),
            symbols: symbols()
                .map(|symbol| task.text(symbol).to_owned())
                .collect(),
            rows,
            machine: machine.to_string(),
        }
    }
}

/// A standing answer, and how it could be mended.
pub(crate) struct PastView {
    pub(crate) number: u32,
    pub(crate) asked: &'static str,
    pub(crate) shows_word: bool,
    pub(crate) first: WordView,
    pub(crate) second: Option<WordView>,
    pub(crate) said: String,
    pub(crate) others: Vec<Choice>,
}

/// An answer that could be given instead.
pub(crate) struct Choice {
    pub(crate) value: &'static str,
    pub(crate) text: &'static str,
}

const JUDGEMENTS: [(&str, &str, Reply<Word>); 2] = [
    ("accept", "acceptable", Reply::Accept),
    ("reject", "not acceptable", Reply::Reject),
];
const COMPARISONS: [(&str, &str, Reply<Word>); 4] = [
    ("first", "A is better", Reply::Compared(Comparison::First)),
    ("second", "B is better", Reply::Compared(Comparison::Second)),
    (
        "equal",
        "equally good or bad",
        Reply::Compared(Comparison::Equal),
    ),
    (
        "incomparable",
        "I can’t compare these",
        Reply::Compared(Comparison::Incomparable),
    ),
];

impl PastView {
    /// The standing answer of this number.
    pub(crate) fn of(number: u32, session: &Session) -> Option<Self> {
        let task = session.task();
        let standing = session.answer_to(number)?;
        let reply = &standing.reply;
        let (asked, first, second, choices): (_, _, _, &[_]) =
            match &session.asked(number)?.question {
                Question::Membership { atom } => (
                    "Is this acceptable?",
                    Some(WordView::of(atom, task)),
                    None,
                    &JUDGEMENTS,
                ),
                Question::Comparison { first, second } => {
                    let (first, second) = WordView::pair(first, second, task);
                    ("Which is closer?", Some(first), Some(second), &COMPARISONS)
                }
                Question::Equivalence { .. } => {
                    let word = match reply {
                        Reply::Counterexample { atom, .. } => Some(WordView::of(atom, task)),
                        _ => None,
                    };
                    ("Is this the rule?", word, None, &[])
                }
            };
        let said = match reply {
            Reply::Skip => "nothing, you skipped it",
            Reply::Correct => "this is right",
            Reply::Counterexample { label: true, .. } => "no, this should be accepted",
            Reply::Counterexample { label: false, .. } => "no, this should not be accepted",
            _ => choices
                .iter()
                .find(|(_, _, r)| r == reply)
                .map_or("", |(_, text, _)| text),
        };
        Some(Self {
            number,
            asked,
            shows_word: first.is_some(),
            first: first.unwrap_or_else(|| WordView::of(&Word::empty(), task)),
            second,
            said: said.to_owned(),
            others: choices
                .iter()
                .filter(|(_, _, r)| r != reply)
                .map(|&(value, text, _)| Choice { value, text })
                .collect(),
        })
    }
}

#[derive(Template)]
#[template(path = "error.html")]
struct ErrorPage {
    shell: Shell,
    heading: &'static str,
    message: String,
    wait: bool,
}

/// A page that says what went wrong.
pub(crate) fn error_page(error: &WebError) -> Response {
    let status = error.status();
    let wait = status == StatusCode::SERVICE_UNAVAILABLE;
    let heading = match status {
        StatusCode::NOT_FOUND => "Nothing here",
        StatusCode::SERVICE_UNAVAILABLE => "Still thinking",
        StatusCode::INTERNAL_SERVER_ERROR => "That went wrong",
        _ => "That did not work",
    };
    let page = ErrorPage {
        shell: Shell::plain(heading),
        heading,
        message: error.message(),
        wait,
    };
    let mut response = (status, render(&page)).into_response();
    if wait {
        response
            .headers_mut()
            .insert(RETRY_AFTER, HeaderValue::from_static("3"));
    }
    response
}

/// A template as a response.
pub(crate) fn render(page: &impl Template) -> Response {
    match page.render() {
        Ok(html) => Html(html).into_response(),
        Err(cause) => {
            tracing::error!(%cause, "a template failed");
            StatusCode::INTERNAL_SERVER_ERROR.into_response()
        }
    }
}
