//! DOT for programs: the dialect of the Automata Wiki that `AALpy` and
//! `AutomataLib` read.
//!
//! ```dot
//! digraph automaton {
//!   __start0 [label="" shape="none"];
//!
//!   s0 [label="s0" shape="circle"];
//!   s1 [label="s1" shape="doublecircle"];
//!
//!   s0 -> s1 [label="a"];
//!   s0 -> s0 [label="b"];
//!   s1 -> s1 [label="a"];
//!   s1 -> s1 [label="b"];
//!
//!   __start0 -> s0;
//! }
//! ```
//!
//! These programs read line by line with patterns, so what is written here is
//! narrower than DOT: bare names of states, one edge a line and a letter, and
//! every edge, the sink's too. A reader takes a letter of digits for a number:
//! `01` and `1` would be one. What is read here is wider: any layout and
//! comments, quoted names, attributes of drawings.
//!
//! DOT lists no alphabet: a reader gets the letters in the order in which edges
//! name them, which in a written file is the declared one. For a picture see
//! [`dot_people`](super::dot_people).

mod lexer;
mod parser;

use std::collections::BTreeMap;
use std::fmt::Write as _;

use super::WriteError;
use crate::{Alphabet, Dfa};

pub use parser::read;

/// Writes an automaton, its states named `s0`, `s1`, … in the table's order.
///
/// # Errors
///
/// If two symbols are names of the same number.
pub fn write(dfa: &Dfa) -> Result<String, WriteError> {
    refuse_same_numbers(dfa.alphabet())?;
    let mut text = String::from("digraph automaton {\n  __start0 [label=\"\" shape=\"none\"];\n\n");
    for state in dfa.states() {
        let name = state.index();
        let shape = if dfa.is_accepting(state) {
            "doublecircle"
        } else {
            "circle"
        };
        let _ = writeln!(text, "  s{name} [label=\"s{name}\" shape=\"{shape}\"];");
    }
    text.push('\n');
    for state in dfa.states() {
        for symbol in dfa.alphabet().symbols() {
            let (from, to) = (state.index(), dfa.next(state, symbol).index());
            let letter = dfa.alphabet().name(symbol);
            let _ = writeln!(text, "  s{from} -> s{to} [label=\"{letter}\"];");
        }
    }
    let _ = writeln!(text, "\n  __start0 -> s{};\n}}", dfa.start().index());
    Ok(text)
}

/// Refuses `1` beside `01`.
fn refuse_same_numbers(alphabet: &Alphabet) -> Result<(), WriteError> {
    let mut seen = BTreeMap::new();
    for name in alphabet.names() {
        if !name.bytes().all(|byte| byte.is_ascii_digit()) {
            continue;
        }
        if let Some(first) = seen.insert(name.trim_start_matches('0'), name) {
            return Err(WriteError::SameNumber {
                first: first.to_owned(),
                second: name.to_owned(),
            });
        }
    }
    Ok(())
}
