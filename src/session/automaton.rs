//! Automata inside a log, in the form of the automaton file.

use automata::format::json;
use automata::{Alphabet, Dfa};
use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::event::Unreadable;

/// The automaton file's content: `{"format":"memrep-dfa","version":1,…}`.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Automaton(Value);

impl Automaton {
    /// The file's content for this automaton.
    #[expect(
        clippy::missing_panics_doc,
        reason = "what the writer of the format writes is JSON"
    )]
    pub fn of(dfa: &Dfa) -> Self {
        let text = json::write(&json::Document::from(dfa.clone()));
        Self(serde_json::from_str(&text).expect("an automaton file is JSON"))
    }

    /// The automaton, which must be over `alphabet`.
    ///
    /// # Errors
    ///
    /// If it is over another one, or no automaton.
    pub fn read(&self, alphabet: &Alphabet) -> Result<Dfa, Unreadable> {
        let dfa = json::read(&self.0.to_string())
            .map_err(|error| Unreadable(format!("hypothesis: {error}")))?
            .dfa;
        if dfa.alphabet() == alphabet {
            Ok(dfa)
        } else {
            Err(Unreadable(format!(
                "the hypothesis is over {}, not over {alphabet}",
                dfa.alphabet()
            )))
        }
    }
}
