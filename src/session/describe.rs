//! What is next in a session, as the API and `memrep replay` show it.

use serde_json::{Value, json};

use super::{Position, QuestionText, Session};
use crate::learner::Question;
use crate::task::{Atom, Concept};
use crate::world::Shown;

impl Session {
    /// What is next where the session stands so, as `GET /sessions/{id}/question`
    /// shows it.
    pub fn describe(&self, position: &Position) -> Value {
        match position {
            Position::Thinking => json!({"kind": "thinking"}),
            Position::Asking(number) => self.describe_question(*number),
            Position::Conflict(conflict) => {
                let mut value = serde_json::to_value(conflict).unwrap_or_default();
                value["kind"] = "conflict".into();
                value["message"] = self.explain(conflict).into();
                value
            }
            Position::Done(hypothesis) => {
                let mut value = json!({"kind": "done"});
                self.show_rule(&mut value, hypothesis);
                if let Some(atom) = self.beyond() {
                    value["beyond"] = self.universe().text(&atom).bare();
                }
                value
            }
        }
    }

    /// A question that was put, the same way.
    pub fn describe_question(&self, number: u32) -> Value {
        let Some(asked) = self.asked(number) else {
            return json!({"kind": "thinking"});
        };
        let question = QuestionText::of(&asked.question, self.universe());
        let mut value = serde_json::to_value(question).unwrap_or_default();
        value["number"] = (number).into();
        let atoms: &[&Atom] = match &asked.question {
            Question::Membership { atom } => &[atom],
            Question::Comparison { first, second } => &[first, second],
            Question::Equivalence { hypothesis } => {
                self.show_rule(&mut value, hypothesis);
                &[]
            }
        };
        let shown = atoms.iter().filter_map(|atom| match atom {
            Atom::Word(word) => self.world()?.shown(word),
            Atom::Point(_) | Atom::Item(_) => None,
        });
        let shown: Vec<Shown<'_>> = shown.collect();
        if !shown.is_empty() {
            value["shown"] = json!(shown);
        }
        if asked.hurried {
            value["hurried"] = true.into();
        }
        if let Some(left) = &asked.left {
            value["left"] = json!(left);
            value["removed"] = json!(asked.removed);
        }
        value
    }

    /// The whole rule; and the learned part, where that is not all of it.
    fn show_rule(&self, value: &mut Value, learned: &Concept) {
        let universe = self.universe();
        value["hypothesis"] = json!(universe.rule(&self.whole(learned)));
        if self.has_prior() {
            value["learned"] = json!(universe.rule(learned));
        }
    }
}
