//! Why standing answers cannot all be true, in words for people.

use super::{Conflict, ConflictCause, Session};
use crate::learner::Question;
use crate::task::Universe;

impl Session {
    /// One or two sentences about the answers of a conflict of this session,
    /// which are "they", or "it" where there is one.
    pub fn explain(&self, conflict: &Conflict) -> String {
        let single = conflict.answers.len() == 1;
        let with_known = "Together with what was known at the start,";
        let bound = conflict.bound.unwrap_or(self.task().max_states);
        match conflict.cause {
            ConflictCause::States if !matches!(self.universe(), Universe::Words { .. }) => {
                format!("No rule of the kind that this task learns fits {}.", if single { "it" } else { "them" })
            }
            ConflictCause::States => {
                let them = match conflict.answers.len() {
                    0 => "what was known at the start",
                    1 => "it together with what was known at the start",
                    _ => "them",
                };
                format!("No rule with at most {bound} states fits {them}. A larger rule would.")
            }
            ConflictCause::Order if single => {
                format!("{with_known} it says that something is better than itself.")
            }
            ConflictCause::Order => {
                "Followed round, they say that something is better than itself.".to_owned()
            }
            ConflictCause::Equality if single => {
                format!("{with_known} it says of two that are equally good that one is better.")
            }
            ConflictCause::Equality => {
                "Taken together, they say of the same two that they are equally good, and that one is better."
                    .to_owned()
            }
            ConflictCause::Membership if !self.compares(conflict) => if single {
                "What was known at the start says the opposite."
            } else {
                "They call the same thing acceptable and not acceptable."
            }
            .to_owned(),
            ConflictCause::Membership if single => format!(
                "{with_known} it makes something acceptable no better than something that is not."
            ),
            ConflictCause::Membership => {
                "They make something acceptable no better than something that is not.".to_owned()
            }
        }
    }

    /// Whether a comparison is among the answers of the conflict.
    fn compares(&self, conflict: &Conflict) -> bool {
        let asked = conflict.answers.iter().filter_map(|&n| self.asked(n));
        asked
            .map(|asked| &asked.question)
            .any(|question| matches!(question, Question::Comparison { .. }))
    }
}
