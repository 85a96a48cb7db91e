//! The learned part, over the symbols that matter: one that stands in nothing that
//! can be asked would only multiply the concepts.

use std::collections::BTreeSet;

use automata::{Alphabet, Dfa, Symbol, Word};

use super::words_of;
use crate::concept::{ConceptClass, DfaClass, Failure, Heard, Sample, Spread, Weighted, Wish};
use crate::evidence::{AnswerId, Budget, Fact};
use crate::identify::Settings;

/// Automata that do not move on symbols that do not matter.
#[derive(Clone)]
pub(super) struct Reduced {
    alphabet: Alphabet,
    settings: Settings,
    /// The symbols of words that can be asked about.
    asked: BTreeSet<Symbol>,
    facts: Vec<(Option<AnswerId>, Fact<Word>)>,
    /// The symbols that matter: those, and those of the facts.
    columns: Vec<Symbol>,
    class: DfaClass,
}

impl Reduced {
    /// What can be asked about is in this language.
    pub(super) fn new(frame: &Dfa, settings: Settings) -> Self {
        let alphabet = frame.alphabet().clone();
        let live = frame.live();
        let mut asked = BTreeSet::new();
        for state in frame.reachable() {
            let mut symbols = alphabet.symbols();
            asked.extend(
                symbols
                    .by_ref()
                    .filter(|&symbol| live[frame.next(state, symbol).index()]),
            );
        }
        let columns = columns(&alphabet, &asked);
        Self {
            class: DfaClass::new(part(&alphabet, &columns), settings.clone()),
            columns,
            facts: Vec::new(),
            asked,
            settings,
            alphabet,
        }
    }

    pub(super) fn add(&mut self, answer: Option<AnswerId>, fact: Fact<Word>) {
        self.facts.push((answer, fact));
        if !self.rebuild()
            && let Some((answer, fact)) = self.facts.last()
        {
            self.class.add(*answer, reduce(fact, &self.columns));
        }
    }

    pub(super) fn forget(&mut self) {
        self.class.forget();
    }

    pub(super) fn retract(&mut self, answer: AnswerId) {
        self.facts.retain(|(standing, _)| *standing != Some(answer));
        if !self.rebuild() {
            self.class.retract(answer);
        }
    }

    /// Begins anew if other symbols matter than before: it depends on the facts
    /// that stand alone.
    fn rebuild(&mut self) -> bool {
        let facts = self.facts.iter().flat_map(|(_, fact)| words_of(fact));
        let mut matter = self.asked.clone();
        matter.extend(facts.flat_map(Word::iter));
        let columns = columns(&self.alphabet, &matter);
        if columns == self.columns {
            return false;
        }
        self.class = DfaClass::new(part(&self.alphabet, &columns), self.settings.clone());
        for (answer, fact) in &self.facts {
            self.class.add(*answer, reduce(fact, &columns));
        }
        self.columns = columns;
        true
    }

    pub(super) fn sample(
        &mut self,
        count: usize,
        seed: u64,
        budget: &mut Budget,
    ) -> Result<Sample<Dfa>, Failure> {
        let sample = self.class.sample(count, seed, budget)?;
        Ok(Sample {
            concepts: sample.concepts.iter().map(|dfa| self.lift(dfa)).collect(),
            complete: sample.complete,
        })
    }

    /// As the wish has it, but for what was heard.
    pub(super) fn spread(
        &mut self,
        wish: &Wish<'_, Word>,
        heard: &[Vec<Heard<Word>>],
        budget: &mut Budget,
    ) -> Result<Spread<Dfa>, Failure> {
        let heard: Vec<Vec<Heard<Word>>> = heard
            .iter()
            .map(|answer| {
                let reduced = |said: &Heard<Word>| Heard {
                    fact: reduce(&said.fact, &self.columns),
                    sure: said.sure,
                };
                answer.iter().map(reduced).collect()
            })
            .collect();
        let wish = Wish {
            heard: &heard,
            ..wish.clone()
        };
        let spread = self.class.spread(&wish, budget)?;
        let lifted = |weighted: &Weighted<Dfa>| Weighted {
            concept: self.lift(&weighted.concept),
            log_weight: weighted.log_weight,
        };
        Ok(Spread {
            concepts: spread.concepts.iter().map(lifted).collect(),
            ..spread
        })
    }

    /// The words with some symbol that does not matter.
    pub(super) fn ignored(&self) -> Dfa {
        let symbols = self.alphabet.symbols();
        let row = symbols.map(|symbol| usize::from(!self.columns.contains(&symbol)));
        let rows = [row.collect(), vec![1; self.alphabet.len()]];
        Dfa::new(self.alphabet.clone(), 0, vec![false, true], &rows)
            .expect("every state has a row, and every entry is a state")
    }

    /// The automaton over all symbols, which does not move on those that do not
    /// matter.
    fn lift(&self, dfa: &Dfa) -> Dfa {
        if self.columns.len() == self.alphabet.len() {
            return dfa.clone();
        }
        let rows: Vec<Vec<usize>> = dfa
            .states()
            .map(|state| {
                let mut row = vec![state.index(); self.alphabet.len()];
                for (column, symbol) in self.columns.iter().enumerate() {
                    row[symbol.index()] = dfa.next(state, Symbol::new(column)).index();
                }
                row
            })
            .collect();
        let accepting = dfa.states().map(|state| dfa.is_accepting(state)).collect();
        Dfa::new(self.alphabet.clone(), dfa.start().index(), accepting, &rows)
            .expect("every state has a row, and every entry is a state")
    }
}

/// The symbols that matter, in order; an alphabet has at least one.
fn columns(alphabet: &Alphabet, matter: &BTreeSet<Symbol>) -> Vec<Symbol> {
    if matter.is_empty() {
        alphabet.symbols().take(1).collect()
    } else {
        matter.iter().copied().collect()
    }
}

fn part(alphabet: &Alphabet, columns: &[Symbol]) -> Alphabet {
    Alphabet::new(columns.iter().map(|&symbol| alphabet.name(symbol)))
        .expect("some symbols of an alphabet are an alphabet")
}

/// The same fact with its symbols numbered by their columns.
fn reduce(fact: &Fact<Word>, columns: &[Symbol]) -> Fact<Word> {
    let word = |word: &Word| -> Word {
        let column = |symbol| columns.partition_point(|&before| before < symbol);
        word.iter().map(column).map(Symbol::new).collect()
    };
    match fact {
        Fact::Label { atom, accepted } => Fact::Label {
            atom: word(atom),
            accepted: *accepted,
        },
        Fact::Below { worse, better } => Fact::Below {
            worse: word(worse),
            better: word(better),
        },
        Fact::Equal { first, second } => Fact::Equal {
            first: word(first),
            second: word(second),
        },
        Fact::Incomparable { first, second } => Fact::Incomparable {
            first: word(first),
            second: word(second),
        },
    }
}
