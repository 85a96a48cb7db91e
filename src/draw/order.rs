//! The numbers of states: breadth-first from the start, without gaps, and what
//! is left out of a drawing last.

use std::collections::VecDeque;

use automata::{Dfa, StateId};

/// The reachable states in the order of their numbers, from 0: as a
/// breadth-first walk first meets them, symbols taken in the alphabet's order,
/// and rejecting states that are never left after all others, since pictures
/// leave them out.
pub fn numbered(dfa: &Dfa) -> Vec<StateId> {
    let (shown, hidden): (Vec<_>, Vec<_>) = (breadth_first(dfa).into_iter())
        .map(|visit| visit.state)
        .partition(|&state| !is_left_out(dfa, state));
    shown.into_iter().chain(hidden).collect()
}

/// Whether a picture leaves the state out: nothing is ever accepted from it.
/// The start is drawn in any case.
pub(super) fn is_left_out(dfa: &Dfa, state: StateId) -> bool {
    state != dfa.start() && !dfa.is_accepting(state) && is_never_left(dfa, state)
}

/// Whether every symbol leads from the state to itself.
pub(super) fn is_never_left(dfa: &Dfa, state: StateId) -> bool {
    (dfa.alphabet().symbols()).all(|symbol| dfa.next(state, symbol) == state)
}

/// A state as a breadth-first walk first meets it.
pub(super) struct Visit {
    /// The state.
    pub(super) state: StateId,
    /// The state that was left for it, and by what; none for the start.
    pub(super) by: Option<(StateId, automata::Symbol)>,
}

/// The reachable states in breadth-first order.
pub(super) fn breadth_first(dfa: &Dfa) -> Vec<Visit> {
    let mut met = vec![false; dfa.size()];
    let start = dfa.start();
    let mut order = vec![Visit {
        state: start,
        by: None,
    }];
    let mut open = VecDeque::from([start]);
    met[start.index()] = true;
    while let Some(state) = open.pop_front() {
        for symbol in dfa.alphabet().symbols() {
            let next = dfa.next(state, symbol);
            if !std::mem::replace(&mut met[next.index()], true) {
                order.push(Visit {
                    state: next,
                    by: Some((state, symbol)),
                });
                open.push_back(next);
            }
        }
    }
    order
}
