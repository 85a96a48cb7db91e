//! What every page has around its content, and pages that say what went wrong.

use askama::Template;
use axum::http::StatusCode;
use axum::response::{Html, IntoResponse, Response};

use super::assets;
use super::error::WebError;
use super::outlook::LeftView;
use crate::session::Session;
use crate::store::SessionId;

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
            stamp: assets::stamp(),
            session: None,
        }
    }

    /// Whether who looks has no business anywhere else.
    pub(crate) fn is_invited(&self) -> bool {
        self.session.as_ref().is_some_and(|bar| bar.invited)
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
    /// The address of its page, below which lie its others.
    pub(crate) home: String,
    /// Whether who looks is one of several people, and not the owner.
    pub(crate) invited: bool,
    pub(crate) title: String,
    pub(crate) answered: usize,
    /// The entries of its log: another page shows the same if they are as many.
    pub(crate) entries: u64,
    /// Paragraph by paragraph.
    pub(crate) guidelines: Vec<String>,
    /// Whether there is a question to practise with.
    pub(crate) practice: bool,
    /// What is left to be learned, while a question is open.
    pub(crate) left: Option<LeftView>,
    /// The last standing answer.
    pub(crate) undo: Option<u32>,
}

impl Bar {
    /// For the owner.
    pub(crate) fn of(id: SessionId, session: &Session) -> Self {
        let task = session.task();
        let counts = session.counts();
        Self {
            home: format!("/sessions/{id}"),
            invited: false,
            title: task.title.clone(),
            answered: (counts.membership + counts.comparison + counts.equivalence) as usize,
            entries: session.entries(),
            guidelines: paragraphs(&task.guidelines),
            practice: task.practice.is_some(),
            left: LeftView::of(session),
            undo: session.standing().last().map(|s| s.number),
        }
    }

    /// For one of several people, who sees what they said and nothing else.
    pub(crate) fn invited(home: String, session: &Session, person: u32) -> Self {
        let task = session.task();
        let answered = session.panel().answered_by(person);
        Self {
            home,
            invited: true,
            title: task.title.clone(),
            answered: answered.len(),
            entries: session.entries(),
            guidelines: paragraphs(&task.guidelines),
            practice: task.practice.is_some(),
            left: None,
            undo: answered.last().copied(),
        }
    }
}

/// Text in which an empty line ends a paragraph, and any other line goes on.
fn paragraphs(text: &str) -> Vec<String> {
    let mut paragraphs = vec![String::new()];
    for line in text.lines().map(str::trim) {
        let Some(last) = paragraphs.last_mut() else {
            continue;
        };
        match (line.is_empty(), last.is_empty()) {
            (true, true) => {}
            (true, false) => paragraphs.push(String::new()),
            (false, true) => last.push_str(line),
            (false, false) => {
                last.push(' ');
                last.push_str(line);
            }
        }
    }
    paragraphs.retain(|paragraph| !paragraph.is_empty());
    paragraphs
}

#[derive(Template)]
#[template(path = "error.html")]
struct ErrorPage {
    shell: Shell,
    heading: &'static str,
    message: String,
    /// The request's name, by which its line in the log is found.
    request: Option<String>,
    wait: bool,
}

/// A page that says what went wrong.
pub(crate) fn error_page(error: &WebError) -> Response {
    // A person who waits for the learner has met no error.
    let wait = matches!(error, WebError::Slow | WebError::Waiting);
    let status = if wait {
        StatusCode::ACCEPTED
    } else {
        error.status()
    };
    let heading = match status {
        StatusCode::NOT_FOUND => "Nothing here",
        StatusCode::ACCEPTED => "Still thinking",
        StatusCode::INTERNAL_SERVER_ERROR => "That went wrong",
        StatusCode::TOO_MANY_REQUESTS => "Too much at once",
        StatusCode::REQUEST_TIMEOUT => "That took too long",
        StatusCode::INSUFFICIENT_STORAGE => "The disk is full",
        StatusCode::SERVICE_UNAVAILABLE => "The database is away",
        _ => "That did not work",
    };
    let page = ErrorPage {
        shell: Shell::plain(heading),
        heading,
        message: match error {
            WebError::Slow => "Your answers are kept. Many rules fit what was said so far, and memrep compares them to find the question that tells most; this one takes longer than others. The page goes on by itself."
                .to_owned(),
            WebError::Waiting => "What was sent last waits for its turn: what came before is still being thought about, or the disk is slow. Stay on this page until it goes on by itself."
                .to_owned(),
            _ => error.message(),
        },
        request: error.told_by(),
        wait,
    };
    (status, render(&page)).into_response()
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
