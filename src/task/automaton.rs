//! Automata inside logs and task files, in the form of the automaton file.

use automata::format::json;
use automata::{Alphabet, Dfa};
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value, json};

/// The automaton file's content: `{"format":"memrep-dfa","version":1,…}`.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Automaton(Value);

/// A name in a log that its alphabet does not have, or a table that is no
/// automaton over it.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct Unreadable(pub String);

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

    /// The automaton of a table in a task, in which the keys that the task itself
    /// tells may be left out: `format`, `version`, `alphabet` and `states`.
    ///
    /// # Errors
    ///
    /// If it is no automaton over `alphabet`.
    pub(super) fn inline(
        table: &Map<String, Value>,
        alphabet: &Alphabet,
    ) -> Result<Dfa, Unreadable> {
        let states = table.get("delta").and_then(Value::as_array).map(Vec::len);
        let names: Vec<&str> = alphabet.names().collect();
        let mut whole = json!({
            "format": "memrep-dfa", "version": 1, "alphabet": names, "states": states,
        });
        for (key, value) in table {
            whole[key] = value.clone();
        }
        Self(whole).read(alphabet)
    }

    /// The automaton, which must be over `alphabet`.
    ///
    /// # Errors
    ///
    /// If it is over another one, or no automaton.
    pub fn read(&self, alphabet: &Alphabet) -> Result<Dfa, Unreadable> {
        let dfa = json::read(&self.0.to_string())
            .map_err(|error| Unreadable(format!("this is no automaton: {error}")))?
            .dfa;
        over(dfa, alphabet)
    }
}

/// The automaton, if it is over `alphabet`.
pub(super) fn over(dfa: Dfa, alphabet: &Alphabet) -> Result<Dfa, Unreadable> {
    if dfa.alphabet() == alphabet {
        Ok(dfa)
    } else {
        Err(Unreadable(format!(
            "the automaton is over {}, not over {alphabet}: give it the symbols of the task in the same order",
            dfa.alphabet()
        )))
    }
}
