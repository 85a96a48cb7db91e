//! States in words: a short phrase for each, which no other state has.
//!
//! A state is told by what it waits for: the symbols that lead one step nearer
//! to acceptance, or, where it accepts, those that lead out of acceptance. Where
//! two states would share a phrase, how one comes to them is tried, then both
//! together; what is still shared gives way to the state's number.

use std::collections::{BTreeMap, VecDeque};

use automata::{Dfa, StateId, Symbol};

use super::order::{is_never_left, numbered};

/// The most symbols that a phrase names.
const NAMED: usize = 2;

/// What a word begins with that needs no article before it.
const DETERMINED: [&str; 10] = [
    "a", "an", "the", "any", "no", "some", "another", "one", "my", "your",
];

/// A phrase for every reachable state, in the order of [`numbered`]: short,
/// different from all others, `state 3` where nothing better tells it apart.
/// `words` has people's word for a symbol by its name.
pub fn phrases(dfa: &Dfa, words: &BTreeMap<String, String>) -> Vec<String> {
    let order = numbered(dfa);
    let states = States::of(dfa, words);
    let offers: Vec<Vec<String>> = order.iter().map(|&state| states.offers(state)).collect();
    let mut wanted: BTreeMap<&str, usize> = BTreeMap::new();
    for offer in offers.iter().flatten() {
        *wanted.entry(offer).or_default() += 1;
    }
    (offers.iter().enumerate())
        .map(|(number, offers)| {
            let alone = offers.iter().find(|offer| wanted[offer.as_str()] == 1);
            alone.cloned().unwrap_or_else(|| format!("state {number}"))
        })
        .collect()
}

/// What is known of the states of an automaton.
struct States<'a> {
    dfa: &'a Dfa,
    words: &'a BTreeMap<String, String>,
    /// The symbols to acceptance; none from where there is no way.
    distance: Vec<Option<usize>>,
    /// The symbols that lead to a state from others.
    entries: Vec<Vec<Symbol>>,
}

impl<'a> States<'a> {
    fn of(dfa: &'a Dfa, words: &'a BTreeMap<String, String>) -> Self {
        let mut sources: Vec<Vec<StateId>> = vec![Vec::new(); dfa.size()];
        let mut entries: Vec<Vec<Symbol>> = vec![Vec::new(); dfa.size()];
        for state in numbered(dfa) {
            for symbol in dfa.alphabet().symbols() {
                let next = dfa.next(state, symbol).index();
                sources[next].push(state);
                if next != state.index() && !entries[next].contains(&symbol) {
                    entries[next].push(symbol);
                }
            }
        }
        let mut distance = vec![None; dfa.size()];
        let mut open: VecDeque<StateId> = dfa.states().filter(|&q| dfa.is_accepting(q)).collect();
        for state in &open {
            distance[state.index()] = Some(0);
        }
        while let Some(state) = open.pop_front() {
            let farther = distance[state.index()].map(|near: usize| near + 1);
            for source in &sources[state.index()] {
                if distance[source.index()].is_none() {
                    distance[source.index()] = farther;
                    open.push_back(*source);
                }
            }
        }
        Self {
            dfa,
            words,
            distance,
            entries,
        }
    }

    /// Phrases that are true of the state, best first.
    fn offers(&self, state: StateId) -> Vec<String> {
        let end = match (self.dfa.is_accepting(state), is_never_left(self.dfa, state)) {
            (true, true) => Some("done"),
            (false, true) => Some("failed for good"),
            _ => None,
        };
        if let Some(end) = end {
            return vec![end.to_owned()];
        }
        if state == self.dfa.start() {
            return vec!["at the start".to_owned()];
        }
        let ahead = self.ahead(state);
        let behind = self.spell(&self.entries[state.index()]);
        let behind = behind.map(|came| format!("after {came}"));
        let mut offers = Vec::new();
        if self.dfa.is_accepting(state) {
            // Where one state alone accepts and can be left, that says it.
            offers.push("fine so far".to_owned());
        }
        offers.extend(ahead.iter().chain(&behind).cloned());
        if let (Some(ahead), Some(behind)) = (&ahead, &behind) {
            offers.push(format!("{behind}, {ahead}"));
        }
        offers
    }

    /// What a state waits for, or what ends that it is fine; none where that is
    /// too much to tell.
    fn ahead(&self, state: StateId) -> Option<String> {
        let is_accepting = self.dfa.is_accepting(state);
        let here = self.distance[state.index()]?;
        let leads = |symbol: &Symbol| {
            let next = self.distance[self.dfa.next(state, *symbol).index()];
            if is_accepting {
                next != Some(0)
            } else {
                next.is_some_and(|next| next < here)
            }
        };
        let symbols: Vec<Symbol> = self.dfa.alphabet().symbols().filter(leads).collect();
        if is_accepting && symbols.is_empty() {
            return Some("fine, whatever comes next".to_owned());
        }
        let symbols = self.spell(&symbols)?;
        Some(if is_accepting {
            format!("fine until {symbols}")
        } else {
            format!("waiting for {symbols}")
        })
    }

    /// A few symbols in words; none where they are too many, or none at all.
    fn spell(&self, symbols: &[Symbol]) -> Option<String> {
        let words: Vec<String> = symbols.iter().map(|&symbol| self.word(symbol)).collect();
        (!words.is_empty() && words.len() <= NAMED).then(|| words.join(" or "))
    }

    /// People's word with an article where it is a noun without one, as words of
    /// small letters are; a symbol without a word by its name.
    fn word(&self, symbol: Symbol) -> String {
        let name = self.dfa.alphabet().name(symbol);
        let Some(word) = self.words.get(name) else {
            return name.to_owned();
        };
        let first = word.split_whitespace().next().unwrap_or_default();
        let is_noun = first.chars().count() > 1
            && first.starts_with(|c: char| c.is_lowercase())
            && !DETERMINED.contains(&first);
        if is_noun {
            format!("the {word}")
        } else {
            word.clone()
        }
    }
}
