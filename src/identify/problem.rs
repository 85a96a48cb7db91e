//! What an engine is asked about: words in a prefix tree and the facts on them.

use automata::{Alphabet, Word};

use super::tree::{NodeId, PrefixTree};
use crate::evidence::{AnswerId, Fact};

/// A fact's place in its [`Problem`], dense from 0 and never used twice.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) struct FactId(pub(crate) u32);

impl FactId {
    /// The place in [`Problem::facts`].
    pub(crate) fn index(self) -> usize {
        self.0 as usize
    }
}

/// What a fact demands of a language, on nodes of the prefix tree.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Constraint {
    /// The node's word is accepted, or not.
    Label(NodeId, bool),
    /// If the first is accepted, so is the second (Eq. 5.4).
    AtMost(NodeId, NodeId),
    /// Both are accepted, or neither.
    Same(NodeId, NodeId),
}

/// A fact with the answer it came from; none if it was known from the start.
#[derive(Clone, Copy, Debug)]
pub(crate) struct StoredFact {
    pub(crate) answer: Option<AnswerId>,
    pub(crate) constraint: Constraint,
}

/// All facts ever given and the words they speak of. It only grows: retracted
/// facts stay, and engines are told which facts stand.
#[derive(Clone, Debug)]
pub(crate) struct Problem {
    alphabet: Alphabet,
    tree: PrefixTree,
    facts: Vec<StoredFact>,
}

impl Problem {
    /// No facts over this alphabet.
    pub(crate) fn new(alphabet: Alphabet) -> Self {
        let tree = PrefixTree::new(alphabet.len());
        Self {
            alphabet,
            tree,
            facts: Vec::new(),
        }
    }

    /// Adds a fact; none if it says nothing about the language.
    ///
    /// # Panics
    ///
    /// If a word has a symbol that the alphabet does not have.
    pub(crate) fn add(&mut self, answer: Option<AnswerId>, fact: &Fact<Word>) -> Option<FactId> {
        let (one, other) = match fact {
            Fact::Label { atom, .. } => (atom, atom),
            Fact::Below { worse, better } => (worse, better),
            Fact::Equal { first, second } | Fact::Incomparable { first, second } => (first, second),
        };
        for symbol in one.iter().chain(other.iter()) {
            assert!(
                symbol.index() < self.alphabet.len(),
                "a word has symbol number {}, which the alphabet {} does not have",
                symbol.index(),
                self.alphabet,
            );
        }
        let constraint = match fact {
            Fact::Label { atom, accepted } => Constraint::Label(self.tree.insert(atom), *accepted),
            Fact::Below { worse, better } => {
                Constraint::AtMost(self.tree.insert(worse), self.tree.insert(better))
            }
            Fact::Equal { first, second } => {
                Constraint::Same(self.tree.insert(first), self.tree.insert(second))
            }
            Fact::Incomparable { .. } => return None,
        };
        let id = FactId(u32::try_from(self.facts.len()).expect("fewer than 2^32 facts"));
        self.facts.push(StoredFact { answer, constraint });
        Some(id)
    }

    /// The alphabet of the words.
    pub(crate) fn alphabet(&self) -> &Alphabet {
        &self.alphabet
    }

    /// All prefixes of all words.
    pub(crate) fn tree(&self) -> &PrefixTree {
        &self.tree
    }

    /// All facts ever added, by [`FactId`].
    pub(crate) fn facts(&self) -> &[StoredFact] {
        &self.facts
    }
}
