//! The Hanoi omega-automata format, version 1: for Spot, Owl and other tools of
//! ω-automata. Written only.
//!
//! The format has no acceptance of finite words. As Spot does for LTL over
//! finite words, the accepting states get the mark of a Büchi condition, and the
//! automaton's name says that it is to be read with finite semantics: a word is
//! accepted if its run *ends* in a marked state.
//!
//! A letter is a valuation of propositions there. Every symbol becomes one
//! proposition, and reading it means that this one holds and the others do not
//! (one-hot); there are no edges for other valuations.

use std::fmt::Write as _;

use super::WriteError;
use crate::Dfa;

/// The largest alphabet that is written. Every edge names every proposition, so
/// a state of `n` symbols takes `n²` literals: here 16,384.
const MAX_SYMBOLS: usize = 128;

/// Writes an automaton.
///
/// # Errors
///
/// If the alphabet has more than 128 symbols.
pub fn write(dfa: &Dfa) -> Result<String, WriteError> {
    let symbols = dfa.alphabet().len();
    if symbols > MAX_SYMBOLS {
        return Err(WriteError::TooManySymbols {
            symbols,
            max: MAX_SYMBOLS,
        });
    }
    let mut text = String::from(
        "HOA: v1\nname: \"finite semantics: a word is accepted if its run ends in a state marked 0\"\n",
    );
    let _ = writeln!(text, "States: {}", dfa.size());
    let _ = writeln!(text, "Start: {}", dfa.start().index());
    let _ = write!(text, "AP: {symbols}");
    for name in dfa.alphabet().names() {
        let _ = write!(text, " \"{name}\"");
    }
    text.push_str("\nacc-name: Buchi\nAcceptance: 1 Inf(0)\n");
    text.push_str("properties: trans-labels explicit-labels state-acc deterministic\n");
    // Aliases would say this once, but not every reader knows them on edges.
    let labels: Vec<String> = (0..symbols).map(|place| one_hot(place, symbols)).collect();
    text.push_str("--BODY--\n");
    for state in dfa.states() {
        let mark = if dfa.is_accepting(state) { " {0}" } else { "" };
        let _ = writeln!(text, "State: {}{mark}", state.index());
        for symbol in dfa.alphabet().symbols() {
            let next = dfa.next(state, symbol).index();
            let _ = writeln!(text, "[{}] {next}", labels[symbol.index()]);
        }
    }
    text.push_str("--END--\n");
    Ok(text)
}

/// Proposition `place` holds and no other of `symbols`.
fn one_hot(place: usize, symbols: usize) -> String {
    let literals: Vec<String> = (0..symbols)
        .map(|other| {
            let not = if other == place { "" } else { "!" };
            format!("{not}{other}")
        })
        .collect();
    literals.join("&")
}
