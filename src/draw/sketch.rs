//! What of an automaton is drawn: its states in breadth-first order, one arrow
//! a pair of states, and the words on the arrows.

use std::collections::BTreeMap;

use automata::{Dfa, StateId, Symbol};

use super::marks::Mark;
use super::order::{is_left_out, numbered};
use super::phrase::phrases;
use super::text::Label;
use super::{Captions, MAX_ARROWS, MAX_STATES, Marks, TooLarge};

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
    /// The number of the state, as in [`numbered`].
    pub(super) number: usize,
    /// Whether it has a double ring.
    pub(super) accepting: bool,
    /// What leads from the state to itself.
    pub(super) looping: Option<Loop>,
    /// What stands below it: its phrase, and how it is marked.
    pub(super) below: Option<Label>,
    /// How it is marked.
    pub(super) marks: Vec<Mark>,
}

/// An arrow from a circle to itself.
pub(super) struct Loop {
    /// What stands on it.
    pub(super) label: Label,
    /// How any of it is marked.
    pub(super) marks: Vec<Mark>,
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
    /// How any of it is marked.
    pub(super) marks: Vec<Mark>,
}

impl Sketch {
    /// Chooses what is drawn of the reachable part of `dfa`.
    pub(super) fn of(dfa: &Dfa, captions: &Captions, marks: &Marks) -> Result<Self, TooLarge> {
        let order = numbered(dfa);
        let drawn = Drawn::of(dfa, &order, marks);
        let count: usize = drawn.exits.iter().map(BTreeMap::len).sum();
        if drawn.states.len() > MAX_STATES || count > MAX_ARROWS {
            return Err(TooLarge {
                states: drawn.states.len(),
                arrows: count,
            });
        }
        let phrases = captions.phrases.then(|| phrases(dfa, &captions.words));
        let phrases = phrases.unwrap_or_default();
        let mut states = Vec::with_capacity(drawn.states.len());
        let mut arrows = Vec::new();
        let mut sentences = Vec::new();
        for (from, (&state, exits)) in drawn.states.iter().zip(&drawn.exits).enumerate() {
            let rest = the_rest(dfa, exits, from);
            let mut looping = None;
            for (&to, symbols) in exits {
                let group = Group {
                    dfa,
                    captions,
                    marks,
                    state,
                    symbols,
                };
                sentences.push(group.sentence(from, to));
                let label = group.label(rest == Some(to));
                let marks = group.marks();
                if to == from {
                    looping = Some(Loop { label, marks });
                } else {
                    arrows.push(Arrow {
                        from,
                        to,
                        label,
                        marks,
                    });
                }
            }
            let phrase = phrases.get(from).map(String::as_str);
            let marks: Vec<Mark> = (Mark::ALL.into_iter())
                .filter(|&mark| marks.has_state(mark, state))
                .collect();
            states.push(State {
                number: from,
                accepting: dfa.is_accepting(state),
                looping,
                below: below(phrase, &marks),
                marks,
            });
        }
        if drawn.states.len() < order.len() || drawn.is_partial {
            sentences.push(super::write::NOTE.to_owned());
        }
        let title = captions
            .title
            .clone()
            .unwrap_or_else(|| match states.len() {
                1 => "An automaton with one state".to_owned(),
                n => format!("An automaton with {n} states"),
            });
        let told = named(&states, &phrases);
        let description = [rings(&states), told, sentences.join(" ")];
        let description: Vec<String> = (description.into_iter())
            .filter(|part| !part.is_empty())
            .collect();
        Ok(Self {
            states,
            arrows,
            hides_sink: drawn.states.len() < order.len() || drawn.is_partial,
            title,
            description: description.join(" "),
        })
    }
}

/// The drawn states and where they lead.
struct Drawn {
    /// In the order of their numbers.
    states: Vec<StateId>,
    /// The symbols that lead from each to others, by the other's number.
    exits: Vec<BTreeMap<usize, Vec<Symbol>>>,
    /// Whether some arrows to what would be left out are drawn, and not all.
    is_partial: bool,
}

impl Drawn {
    /// A state that would be left out is drawn after all where it is marked, or a
    /// marked arrow leads to it; then with the marked arrows alone.
    fn of(dfa: &Dfa, order: &[StateId], marks: &Marks) -> Self {
        let leads_there = |sink: StateId| {
            let mut marked = marks.arrows();
            marked.any(|(from, by)| !is_left_out(dfa, from) && dfa.next(from, by) == sink)
        };
        let states: Vec<StateId> = (order.iter().copied())
            .filter(|&state| {
                !is_left_out(dfa, state) || is_marked(marks, state) || leads_there(state)
            })
            .collect();
        let mut number = vec![None; dfa.size()];
        for (index, state) in states.iter().enumerate() {
            number[state.index()] = Some(index);
        }
        let mut is_partial = false;
        let mut exits = Vec::with_capacity(states.len());
        for &state in &states {
            let mut by_target: BTreeMap<usize, Vec<Symbol>> = BTreeMap::new();
            for symbol in dfa.alphabet().symbols() {
                let next = dfa.next(state, symbol);
                let Some(target) = number[next.index()] else {
                    continue;
                };
                let has = |&mark: &Mark| marks.has_arrow(mark, state, symbol);
                let is_shown = is_marked(marks, next) || Mark::ALL.iter().any(has);
                if is_left_out(dfa, next) && (next == state || !is_shown) {
                    is_partial |= next != state;
                    continue;
                }
                by_target.entry(target).or_default().push(symbol);
            }
            exits.push(by_target);
        }
        Self {
            states,
            exits,
            is_partial,
        }
    }
}

fn is_marked(marks: &Marks, state: StateId) -> bool {
    Mark::ALL.iter().any(|&mark| marks.has_state(mark, state))
}

/// The symbols of one arrow.
struct Group<'a> {
    dfa: &'a Dfa,
    captions: &'a Captions,
    marks: &'a Marks,
    state: StateId,
    symbols: &'a [Symbol],
}

impl Group<'_> {
    fn word(&self, symbol: Symbol) -> &str {
        let name = self.dfa.alphabet().name(symbol);
        self.captions.words.get(name).map_or(name, String::as_str)
    }

    fn words(&self, symbols: &[Symbol]) -> String {
        let words: Vec<&str> = symbols.iter().map(|&symbol| self.word(symbol)).collect();
        words.join(", ")
    }

    fn marked(&self, mark: Mark) -> Vec<Symbol> {
        let has = |&symbol: &Symbol| self.marks.has_arrow(mark, self.state, symbol);
        self.symbols.iter().copied().filter(has).collect()
    }

    fn marks(&self) -> Vec<Mark> {
        let any = |&mark: &Mark| !self.marked(mark).is_empty();
        Mark::ALL.into_iter().filter(any).collect()
    }

    /// The words of the symbols, and below them what is marked: all of it, or
    /// which.
    fn label(&self, is_rest: bool) -> Label {
        let marks = self.marks();
        let all = |&mark: &Mark| self.marked(mark).len() == self.symbols.len();
        let alike = marks.iter().all(all);
        let words: Vec<&str> = match self.symbols {
            symbols if is_rest && alike && symbols.len() == self.dfa.alphabet().len() => {
                vec!["anything"]
            }
            _ if is_rest && alike => vec!["otherwise"],
            symbols => symbols.iter().map(|&symbol| self.word(symbol)).collect(),
        };
        let told = marks.iter().map(|mark| {
            if all(mark) {
                format!("({})", mark.word())
            } else {
                format!("({}: {})", mark.word(), self.words(&self.marked(*mark)))
            }
        });
        told.fold(Label::list(&words), |label, line| label.with(&line))
    }

    fn sentence(&self, from: usize, to: usize) -> String {
        let words = self.words(self.symbols);
        let mut sentence = if to == from {
            format!("In state {from}, {words} stays there")
        } else {
            format!("In state {from}, {words} leads to {to}")
        };
        for mark in self.marks() {
            let marked = self.marked(mark);
            sentence.push_str(" (");
            sentence.push_str(mark.word());
            if marked.len() < self.symbols.len() {
                sentence.push_str(": ");
                sentence.push_str(&self.words(&marked));
            }
            sentence.push(')');
        }
        sentence.push('.');
        sentence
    }
}

/// What stands below a circle.
fn below(phrase: Option<&str>, marks: &[Mark]) -> Option<Label> {
    let told = marks.iter().map(|mark| format!("({})", mark.word()));
    // A phrase that is a number says nothing that the circle does not.
    let phrase = phrase.filter(|phrase| !phrase.starts_with("state "));
    let told: Vec<String> = told.collect();
    match (phrase, told.split_first()) {
        (None, None) => None,
        (Some(phrase), _) => Some(
            told.iter()
                .fold(Label::wrapped(phrase), |label, line| label.with(line)),
        ),
        (None, Some((first, rest))) => Some(
            rest.iter()
                .fold(Label::wrapped(first), |label, line| label.with(line)),
        ),
    }
}

/// The states by their phrases and marks, in sentences.
fn named(states: &[State], phrases: &[String]) -> String {
    let sentences: Vec<String> = (states.iter())
        .filter_map(|state| {
            let phrase = phrases.get(state.number);
            let phrase = phrase.filter(|phrase| !phrase.starts_with("state "));
            let marks: Vec<&str> = state.marks.iter().map(|mark| mark.word()).collect();
            let number = state.number;
            Some(match (phrase, marks.is_empty()) {
                (None, true) => return None,
                (Some(phrase), true) => format!("State {number}: {phrase}."),
                (Some(phrase), false) => {
                    format!("State {number} ({}): {phrase}.", marks.join(", "))
                }
                (None, false) => format!("State {number} is {}.", marks.join(" and ")),
            })
        })
        .collect();
    sentences.join(" ")
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
