//! Which concepts are one, because nothing that can be shown and is open tells
//! them apart.

use std::collections::HashMap;

use automata::{Dfa, Word};

use super::catalogue::Catalogue;

/// As many concepts are remembered.
const REMEMBERED: usize = 200_000;

/// The classes met so far. They save work and change no answer: to be told apart
/// or not does not depend on who else was met.
#[derive(Default)]
pub(super) struct Classes {
    known: HashMap<Dfa, usize>,
    /// The concepts that the first words of the catalogue do not tell apart.
    groups: HashMap<Vec<u64>, Vec<Member>>,
    /// Other words that told some concepts apart: they are likely to do so again.
    telling: Vec<Word>,
    count: usize,
}

/// One concept of a class, with the number of the class.
struct Member {
    dfa: Dfa,
    class: usize,
}

impl Classes {
    /// The number of the concept's class. `separate` finds a word that tells two
    /// concepts apart, if there is one.
    pub(super) fn class_of(
        &mut self,
        dfa: &Dfa,
        catalogue: &Catalogue,
        separate: impl Fn(&Dfa, &Dfa) -> Option<Word>,
    ) -> usize {
        if let Some(&class) = self.known.get(dfa) {
            return class;
        }
        if self.known.len() >= REMEMBERED {
            self.known.clear();
            self.groups.clear();
            self.telling.clear();
        }
        let group = self.groups.entry(catalogue.signature(dfa)).or_default();
        let mut same = None;
        for member in &*group {
            let differs = |word: &Word| member.dfa.accepts(word) != dfa.accepts(word);
            if self.telling.iter().any(differs) {
                continue;
            }
            if let Some(word) = separate(&member.dfa, dfa) {
                self.telling.push(word);
            } else {
                same = Some(member.class);
                break;
            }
        }
        let class = same.unwrap_or_else(|| {
            self.count += 1;
            group.push(Member {
                dfa: dfa.clone(),
                class: self.count,
            });
            self.count
        });
        self.known.insert(dfa.clone(), class);
        class
    }
}
