//! How words end in automata: where, and how well they did on the way.

use std::collections::HashMap;

use automata::{Dfa, StateId, Symbol, Word};

use super::particles::Pace;
use crate::belief::{End, Place};

/// How a word over its alphabet ends in an automaton.
pub fn end(dfa: &Dfa, word: &Word) -> End {
    let reader = Reader::new(dfa);
    reader.end(reader.read(reader.start(), word.symbols()))
}

/// How each of some words ends in each of some automata, by word and then by
/// automaton. Takes a step for every word where words come after their beginnings; long
/// words without these are read each from the start.
pub fn ends(automata: &[&Dfa], words: &[Word]) -> Vec<Vec<End>> {
    let routes = routes(words);
    let mut ends: Vec<Vec<End>> = (words.iter())
        .map(|_| Vec::with_capacity(automata.len()))
        .collect();
    let mut reached: Vec<Reached> = Vec::with_capacity(words.len());
    for dfa in automata {
        let reader = Reader::new(dfa);
        reached.clear();
        for (&(from, rest), ends) in routes.iter().zip(&mut ends) {
            let from = from.map_or_else(|| reader.start(), |word| reached[word]);
            let at = reader.read(from, rest);
            reached.push(at);
            ends.push(reader.end(at));
        }
    }
    ends
}

/// For every word the place of the same but for its last symbol, if that came before,
/// and what is left to read.
fn routes(words: &[Word]) -> Vec<(Option<usize>, &[Symbol])> {
    let mut known: HashMap<&[Symbol], usize> = HashMap::with_capacity(words.len());
    let mut routes = Vec::with_capacity(words.len());
    for (number, word) in words.iter().enumerate() {
        let symbols = word.symbols();
        let (before, last) = symbols.split_at(symbols.len().saturating_sub(1));
        routes.push(match known.get(before) {
            Some(&before) => (Some(before), last),
            None => (None, symbols),
        });
        known.insert(symbols, number);
    }
    routes
}

/// Where a word has come to.
#[derive(Clone, Copy, Debug)]
struct Reached {
    state: StateId,
    depth: u32,
    /// As [`Pace::progress`] tells it.
    progress: u32,
}

/// Reads words in an automaton.
struct Reader<'a> {
    dfa: &'a Dfa,
    /// By state.
    paces: Vec<Pace>,
    /// By state, what ends of words there have in common: in acceptance, how many words
    /// of two symbols lead on to it (section 5.3, "Tomita languages").
    places: Vec<Place>,
}

impl<'a> Reader<'a> {
    fn new(dfa: &'a Dfa) -> Self {
        let next = |state| dfa.alphabet().symbols().map(move |a| dfa.next(state, a));
        let pace = |state: StateId| {
            let accepting = dfa.is_accepting(state);
            Pace::new(accepting, !accepting && next(state).all(|to| to == state))
        };
        let room = |state| {
            let ends = next(state).flat_map(next);
            ends.filter(|&end| dfa.is_accepting(end)).count() as u32
        };
        let place = |state: StateId| {
            let number = state.index() as u32;
            if dfa.is_accepting(state) {
                Place::inside(number, room(state))
            } else {
                Place::outside(number)
            }
        };
        Self {
            dfa,
            paces: dfa.states().map(pace).collect(),
            places: dfa.states().map(place).collect(),
        }
    }

    fn start(&self) -> Reached {
        let state = self.dfa.start();
        Reached {
            state,
            depth: 0,
            progress: self.paces[state.index()].start(),
        }
    }

    fn read(&self, mut at: Reached, symbols: &[Symbol]) -> Reached {
        for &symbol in symbols {
            at.state = self.dfa.next(at.state, symbol);
            at.depth += 1;
            at.progress = self.paces[at.state.index()].progress(at.depth, at.progress);
        }
        at
    }

    fn end(&self, at: Reached) -> End {
        self.places[at.state.index()].end(at.progress)
    }
}

#[cfg(test)]
mod tests {
    use automata::Alphabet;

    use super::*;
    use crate::identify::completion::automaton;

    /// Words in any order, with and without their beginnings among them.
    #[test]
    fn many_words_end_as_each_does_alone() {
        let alphabet = Alphabet::new(["a", "b"]).expect("two symbols");
        // The last one has a rejecting sink.
        let tables: [(&[u32], &[bool]); 3] = [
            (&[0, 0], &[true]),
            (&[1, 0, 2, 1, 0, 2], &[true, false, true]),
            (&[0, 1, 2, 1, 2, 2], &[false, true, false]),
        ];
        let read = |(delta, output): (&[u32], &[bool])| {
            automaton(&alphabet, (delta.into(), output.into()))
        };
        let drawn = tables.map(read);
        let automata: Vec<&Dfa> = drawn.iter().collect();
        let shortest: Vec<Word> = alphabet.words().take(200).collect();
        let descending: Vec<Word> = shortest.iter().rev().cloned().collect();
        let every_third: Vec<Word> = shortest.iter().step_by(3).cloned().collect();
        for words in [shortest, descending, every_third] {
            let alone = |word| automata.iter().map(|dfa| end(dfa, word)).collect();
            let expected: Vec<Vec<End>> = words.iter().map(alone).collect();
            assert_eq!(ends(&automata, &words), expected);
        }
    }
}
