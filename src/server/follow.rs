//! What would follow each way to mend a contradiction, for people.

use std::time::Duration;

use super::ahead::Trial;
use super::outlook::LeftView;
use super::past::{PastView, value};
use super::teaching::Teaching;
use crate::session::{Event, Position};
use crate::store::SessionId;

/// How long a page waits for consequences that are still being worked out.
const PATIENCE: Duration = Duration::from_millis(700);

/// What would follow if an answer was withdrawn or changed.
#[derive(Clone)]
pub(crate) struct Follow {
    number: u32,
    /// The new answer; none where it is withdrawn.
    value: Option<&'static str>,
    text: String,
}

impl Follow {
    /// What came of a trial, if it mends an answer.
    fn of(trial: &Trial) -> Option<Self> {
        let (number, value) = match &trial.cause {
            Event::Retracted { number } => (*number, None),
            Event::Changed { number, reply } => (*number, Some(value(reply)?)),
            _ => return None,
        };
        let text = match trial.session.position() {
            Position::Thinking => return None,
            Position::Conflict(conflict) => {
                let numbers: Vec<String> = conflict.answers.iter().map(u32::to_string).collect();
                match numbers.as_slice() {
                    [] => "what was known at the start still can’t be true".to_owned(),
                    [only] => format!("answer {only} still can’t be true"),
                    [before @ .., last] => format!(
                        "answers {} and {last} still can’t all be true",
                        before.join(", ")
                    ),
                }
            }
            Position::Asking(_) => match LeftView::of(&trial.session) {
                Some(left) if left.only => "your answers agree, and one rule fits them".to_owned(),
                Some(left) => format!("your answers agree, and {} rules fit them", left.rules),
                None => "your answers agree".to_owned(),
            },
            Position::Done(_) => {
                "your answers agree with the rule that you said is right".to_owned()
            }
        };
        Some(Self {
            number,
            value,
            text,
        })
    }

    /// What follows every way to mend the contradiction that the session met, as
    /// far as that is known soon; nothing where there is none.
    pub(crate) async fn all(teaching: &Teaching, id: SessionId) -> Vec<Self> {
        let entries = teaching.look(id, |session| {
            matches!(session.position(), Position::Conflict(_)).then(|| session.entries())
        });
        // Whatever is wrong with the session, its page will say.
        let Ok(Some(entries)) = entries.await else {
            return Vec::new();
        };
        let follows = teaching.survey(id, entries, PATIENCE, Self::of).await;
        follows.into_iter().flatten().collect()
    }

    /// Adds to an answer what would follow if it was mended.
    pub(crate) fn add_to(follows: &[Self], past: &mut PastView) {
        let find = |value| {
            let mut follows = follows.iter();
            let found = follows.find(|one| one.number == past.number && one.value == value);
            found.map(|follow| follow.text.clone())
        };
        past.withdrawn = find(None);
        let found: Vec<Option<String>> = (past.others.iter())
            .map(|choice| find(Some(choice.value)))
            .collect();
        for (choice, follows) in past.others.iter_mut().zip(found) {
            choice.follows = follows;
        }
    }
}
