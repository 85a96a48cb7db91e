//! What the templates show, and how it is made from a session.

use askama::Template;
use automata::{Dfa, Word};
use axum::http::StatusCode;
use axum::http::header::{HeaderValue, RETRY_AFTER};
use axum::response::{Html, IntoResponse, Response};
use serde_json::json;

use super::assets;
use super::error::WebError;
use super::recording::RecordingView;
use super::scene::{Look, Scene};
use crate::evidence::Comparison;
use crate::learner::{Question, Reply};
use crate::session::{Session, Task};
use crate::world::{Trajectory, World};

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
    /// What its tile shows.
    pub(crate) letter: String,
    pub(crate) tone: usize,
    /// A colour of the task's own, in place of the tone.
    pub(crate) colour: Option<String>,
    /// Part of the beginning that both words share.
    pub(crate) shared: bool,
    /// Where the two words part.
    pub(crate) parts: bool,
}

impl Chip {
    /// Whether its tile says all.
    pub(crate) fn is_bare(&self) -> bool {
        self.text == self.letter
    }

    fn look(&self) -> Look {
        Look {
            letter: self.letter.clone(),
            tone: self.tone,
            colour: self.colour.clone(),
        }
    }
}

/// A word as a row of chips, and the walk that shows it where there is a grid.
pub(crate) struct WordView {
    pub(crate) scene: Option<Scene>,
    pub(crate) recording: Option<RecordingView>,
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
            letter: match (symbol.letter, &symbol.colour) {
                (Some(letter), _) => letter.to_string(),
                // A tile of a colour of its own is as wide as one letter.
                (None, Some(_)) => symbol.name.chars().take(1).collect(),
                (None, None) => symbol.name.clone(),
            },
            colour: symbol.colour.as_ref().map(|colour| colour.hex().to_owned()),
            // The tones begin with the ones for danger and reward; bare letters
            // begin further on, so that they do not look like either.
            tone: (if worded { i } else { i + 2 }) % TONES,
            shared: false,
            parts: false,
        })
        .collect()
}

impl WordView {
    pub(crate) fn of(word: &Word, session: &Session) -> Self {
        Self::beside(word, None, session)
    }

    /// The word with what it shares with `other` marked.
    pub(crate) fn beside(word: &Word, other: Option<&Word>, session: &Session) -> Self {
        let common = other.map_or(0, |other| {
            word.iter()
                .zip(other.iter())
                .take_while(|(a, b)| a == b)
                .count()
        });
        let symbols = chips(session.task());
        let scene = match session.world().map(|world| (world, world.trajectory(word))) {
            Some((World::Grid(grid), Some(Trajectory::Walk { from, steps }))) => {
                let looks: Vec<Look> = symbols.iter().map(Chip::look).collect();
                Some(Scene::of(grid, from, &steps, &looks))
            }
            _ => None,
        };
        let chips: Vec<Chip> = word
            .iter()
            .enumerate()
            .map(|(i, symbol)| {
                let chip = &symbols[symbol.index()];
                Chip {
                    name: chip.name.clone(),
                    text: chip.text.clone(),
                    letter: chip.letter.clone(),
                    tone: chip.tone,
                    colour: chip.colour.clone(),
                    shared: i < common,
                    parts: common > 0 && i == common,
                }
            })
            .collect();
        let names: Vec<&str> = chips.iter().map(|chip| chip.name.as_str()).collect();
        Self {
            data: names.join(" "),
            scene,
            recording: RecordingView::shown(word, session),
            chips,
            empty: session.task().empty.clone(),
        }
    }

    pub(crate) fn pair(first: &Word, second: &Word, session: &Session) -> (Self, Self) {
        (
            Self::beside(first, Some(second), session),
            Self::beside(second, Some(first), session),
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
        let standing = session.answer_to(number)?;
        let reply = &standing.reply;
        let (asked, first, second, choices): (_, _, _, &[_]) =
            match &session.asked(number)?.question {
                Question::Membership { atom } => (
                    "Is this acceptable?",
                    Some(WordView::of(atom, session)),
                    None,
                    &JUDGEMENTS,
                ),
                Question::Comparison { first, second } => {
                    let (first, second) = WordView::pair(first, second, session);
                    ("Which is closer?", Some(first), Some(second), &COMPARISONS)
                }
                Question::Equivalence { .. } => {
                    let word = match reply {
                        Reply::Counterexample { atom, .. } => Some(WordView::of(atom, session)),
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
            first: first.unwrap_or_else(|| WordView::of(&Word::empty(), session)),
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
