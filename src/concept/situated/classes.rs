//! Which concepts are one, because nothing that can be shown and is open tells
//! them apart.

use std::collections::HashMap;

use automata::{Dfa, Word};

use super::catalogue::Catalogue;

/// As many concepts are remembered.
const REMEMBERED: usize = 200_000;
/// So many words of the catalogue tell most concepts apart.
const SIGNED: usize = 192;

/// The classes met so far. They save work and change no answer: to be told apart
/// or not does not depend on who else was met.
#[derive(Clone, Default)]
pub(super) struct Classes {
    known: HashMap<Dfa, usize>,
    /// By the labels of the first words of the catalogue.
    groups: HashMap<Vec<u64>, Group>,
    /// Words outside the catalogue that told some concepts apart: they are likely to do so again.
    telling: Vec<Word>,
    count: usize,
}

/// The concepts that the first words of the catalogue do not tell apart.
#[derive(Clone, Default)]
struct Group {
    /// The first, while it is the only one: there is no need to look further.
    lone: Option<Member>,
    /// By the labels of all words of the catalogue.
    parts: HashMap<Vec<u64>, Vec<Member>>,
}

/// One concept of a class, with the number of the class.
#[derive(Clone)]
struct Member {
    dfa: Dfa,
    class: usize,
    told: Told,
}

/// What a concept says of the first of the telling words.
#[derive(Clone, Default)]
struct Told(Vec<bool>);

impl Told {
    /// What it says of all of them.
    fn all(&mut self, dfa: &Dfa, telling: &[Word]) -> &[bool] {
        let new = telling[self.0.len()..].iter();
        self.0.extend(new.map(|word| dfa.accepts(word)));
        &self.0
    }
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
        let class = self.place(dfa, catalogue, separate);
        self.known.insert(dfa.clone(), class);
        class
    }

    /// The class of a concept that was not met before.
    fn place(
        &mut self,
        dfa: &Dfa,
        catalogue: &Catalogue,
        separate: impl Fn(&Dfa, &Dfa) -> Option<Word>,
    ) -> usize {
        let group = (self.groups.entry(catalogue.signature(dfa, SIGNED))).or_default();
        let mut own = || {
            self.count += 1;
            Member {
                dfa: dfa.clone(),
                class: self.count,
                told: Told::default(),
            }
        };
        if group.lone.is_none() && group.parts.is_empty() {
            return group.lone.insert(own()).class;
        }
        if let Some(lone) = group.lone.take() {
            let labels = catalogue.signature(&lone.dfa, usize::MAX);
            group.parts.entry(labels).or_default().push(lone);
        }
        let labels = catalogue.signature(dfa, usize::MAX);
        let alike = group.parts.entry(labels).or_default();
        let mut told = Told::default();
        for member in &mut *alike {
            let says = told.all(dfa, &self.telling);
            if member.told.all(&member.dfa, &self.telling) != says {
                continue;
            }
            match separate(&member.dfa, dfa) {
                Some(word) => self.telling.push(word),
                None => return member.class,
            }
        }
        alike.push(own());
        self.count
    }
}
