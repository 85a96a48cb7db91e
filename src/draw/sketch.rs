//! What of an automaton is drawn: its states in breadth-first order, one arrow
//! a pair of states, and the words on the arrows.

use std::collections::{BTreeMap, VecDeque};

use automata::{Dfa, StateId, Symbol};

use super::text::Label;
use super::{Captions, MAX_ARROWS, MAX_STATES, TooLarge};

/// What a picture shows, before anything has a place. The start is the first
/// of the states.
pub(super) struct Sketch {
    /// The drawn states in breadth-first order.
    pub(super) states: Vec<State>,
    /// The arrows between different states, by their ends.
    pub(super) arrows: Vec<Arrow>,
    /// Whether a rejecting sink is left out.
    pub(super) hides_sink: bool,
    /// What the picture shows.
    pub(super) title: String,
    /// The whole automaton in sentences.
    pub(super) description: String,
}

/// A circle.
pub(super) struct State {
    /// The number of the state in breadth-first order, the sink included.
    pub(super) number: usize,
    /// Whether it has a double ring.
    pub(super) accepting: bool,
    /// What leads from the state to itself.
    pub(super) looping: Option<Label>,
}

/// An arrow between two different circles, given by their places in
/// [`Sketch::states`].
pub(super) struct Arrow {
    /// Where it starts.
    pub(super) from: usize,
    /// Where it ends.
    pub(super) to: usize,
    /// What stands on it.
    pub(super) label: Label,
}

impl Sketch {
    /// Chooses what is drawn of the reachable part of `dfa`.
    pub(super) fn of(dfa: &Dfa, captions: &Captions) -> Result<Self, TooLarge> {
        let order = breadth_first(dfa);
        // The start is drawn even if nothing can ever be accepted from it.
        let hidden = |state: StateId| state != dfa.start() && is_rejecting_sink(dfa, state);
        let drawn: Vec<(usize, StateId)> = (order.iter().copied().enumerate())
            .filter(|&(_, state)| !hidden(state))
            .collect();
        let hides_sink = drawn.len() < order.len();
        let mut place = vec![None; dfa.size()];
        for (index, &(_, state)) in drawn.iter().enumerate() {
            place[state.index()] = Some(index);
        }

        let mut exits = Vec::with_capacity(drawn.len());
        for &(_, state) in &drawn {
            let mut by_target: BTreeMap<usize, Vec<Symbol>> = BTreeMap::new();
            for symbol in dfa.alphabet().symbols() {
                if let Some(target) = place[dfa.next(state, symbol).index()] {
                    by_target.entry(target).or_default().push(symbol);
                }
            }
            exits.push(by_target);
        }
        let count: usize = exits.iter().map(BTreeMap::len).sum();
        if drawn.len() > MAX_STATES || count > MAX_ARROWS {
            return Err(TooLarge {
                states: drawn.len(),
                arrows: count,
            });
        }

        let word = |symbol: &Symbol| -> &str {
            let name = dfa.alphabet().name(*symbol);
            captions.words.get(name).map_or(name, String::as_str)
        };
        let mut states = Vec::with_capacity(drawn.len());
        let mut arrows = Vec::new();
        let mut sentences = Vec::new();
        for (from, (&(number, state), by_target)) in drawn.iter().zip(&exits).enumerate() {
            let rest = the_rest(dfa, by_target, from);
            let mut looping = None;
            for (&to, symbols) in by_target {
                let words: Vec<&str> = symbols.iter().map(word).collect();
                let all = symbols.len() == dfa.alphabet().len();
                let label = match rest {
                    Some(target) if target == to && all => Label::list(&["anything"]),
                    Some(target) if target == to => Label::list(&["otherwise"]),
                    _ => Label::list(&words),
                };
                let goal = drawn[to].0;
                sentences.push(if to == from {
                    format!("In state {number}, {} stays there.", words.join(", "))
                } else {
                    format!("In state {number}, {} leads to {goal}.", words.join(", "))
                });
                if to == from {
                    looping = Some(label);
                } else {
                    arrows.push(Arrow { from, to, label });
                }
            }
            states.push(State {
                number,
                accepting: dfa.is_accepting(state),
                looping,
            });
        }
        if hides_sink {
            sentences.push(super::write::NOTE.to_owned());
        }
        let title = captions
            .title
            .clone()
            .unwrap_or_else(|| match states.len() {
                1 => "An automaton with one state".to_owned(),
                n => format!("An automaton with {n} states"),
            });
        let description = format!("{} {}", rings(&states), sentences.join(" "));
        Ok(Self {
            states,
            arrows,
            hides_sink,
            title,
            description,
        })
    }
}

/// The sentence about the start and the double rings.
fn rings(states: &[State]) -> String {
    let accepting: Vec<String> = (states.iter())
        .filter(|state| state.accepting)
        .map(|state| state.number.to_string())
        .collect();
    match accepting.as_slice() {
        [] => "It starts in state 0. No state is accepting.".to_owned(),
        [one] => format!("It starts in state 0. State {one} is accepting."),
        several => format!(
            "It starts in state 0. States {} are accepting.",
            several.join(", ")
        ),
    }
}

/// The states in the order in which a breadth-first walk first meets them,
/// symbols taken in the alphabet's order.
fn breadth_first(dfa: &Dfa) -> Vec<StateId> {
    let mut met = vec![false; dfa.size()];
    let mut order = vec![dfa.start()];
    let mut open = VecDeque::from([dfa.start()]);
    met[dfa.start().index()] = true;
    while let Some(state) = open.pop_front() {
        for symbol in dfa.alphabet().symbols() {
            let next = dfa.next(state, symbol);
            if !std::mem::replace(&mut met[next.index()], true) {
                order.push(next);
                open.push_back(next);
            }
        }
    }
    order
}

/// Whether `state` rejects and is never left.
fn is_rejecting_sink(dfa: &Dfa, state: StateId) -> bool {
    !dfa.is_accepting(state)
        && (dfa.alphabet().symbols()).all(|symbol| dfa.next(state, symbol) == state)
}

/// The target whose symbols are written as "otherwise": the largest group of
/// at least three, a loop before an arrow. There is none where a symbol leads
/// into the hidden sink, since "otherwise" would then speak of that one too.
fn the_rest(dfa: &Dfa, exits: &BTreeMap<usize, Vec<Symbol>>, from: usize) -> Option<usize> {
    let shown: usize = exits.values().map(Vec::len).sum();
    if shown < dfa.alphabet().len() {
        return None;
    }
    exits
        .iter()
        .filter(|(_, symbols)| symbols.len() >= 3)
        .max_by_key(|&(&to, symbols)| (symbols.len(), to == from, std::cmp::Reverse(to)))
        .map(|(&to, _)| to)
}
