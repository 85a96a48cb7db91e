//! Automata inside a log, in the form of the automaton file.

use automata::{Alphabet, Dfa};
use serde::{Deserialize, Serialize};

use super::event::Unreadable;

/// The automaton file's content: `{"format":"memrep-dfa","version":1,…}`.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Automaton {
    format: String,
    version: u32,
    alphabet: Vec<String>,
    states: usize,
    start: usize,
    accepting: Vec<usize>,
    delta: Vec<Vec<usize>>,
}

const FORMAT: &str = "memrep-dfa";
const VERSION: u32 = 1;

impl Automaton {
    /// The file's content for this automaton.
    pub fn of(dfa: &Dfa) -> Self {
        let row = |state| {
            let next = |symbol| dfa.next(state, symbol).index();
            dfa.alphabet().symbols().map(next).collect()
        };
        Self {
            format: FORMAT.to_owned(),
            version: VERSION,
            alphabet: dfa.alphabet().names().map(str::to_owned).collect(),
            states: dfa.size(),
            start: dfa.start().index(),
            accepting: dfa
                .states()
                .filter(|&state| dfa.is_accepting(state))
                .map(automata::StateId::index)
                .collect(),
            delta: dfa.states().map(row).collect(),
        }
    }

    /// The automaton, which must be over `alphabet`.
    ///
    /// # Errors
    ///
    /// If it is over another one, or no automaton.
    pub fn read(&self, alphabet: &Alphabet) -> Result<Dfa, Unreadable> {
        let unreadable = |message: String| Unreadable(format!("hypothesis: {message}"));
        if self.format != FORMAT || self.version != VERSION {
            return Err(unreadable(format!(
                "`{}` version {} is not `{FORMAT}` version {VERSION}",
                self.format, self.version
            )));
        }
        if !alphabet
            .names()
            .eq(self.alphabet.iter().map(String::as_str))
        {
            return Err(unreadable(format!("it is not over {alphabet}")));
        }
        let mut accepting = vec![false; self.states];
        for &state in &self.accepting {
            match accepting.get_mut(state) {
                Some(entry) => *entry = true,
                None => return Err(unreadable(format!("state {state} does not exist"))),
            }
        }
        Dfa::new(alphabet.clone(), self.start, accepting, &self.delta)
            .map_err(|error| unreadable(error.to_string()))
    }
}
