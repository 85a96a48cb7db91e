//! What is known of a language: labelled words and preferences.

use crate::{Alphabet, Dfa, Word};

/// One thing that is known, or to be found out, of a language.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum Item {
    /// The word is in the language, or is not.
    Label {
        /// The word.
        word: Word,
        /// Whether it is in the language.
        accepted: bool,
    },
    /// Nobody said whether the word is in the language.
    Unknown {
        /// The word.
        word: Word,
    },
    /// If `worse` is in the language, so is `better`.
    Below {
        /// The word that is worse.
        worse: Word,
        /// The word that is better.
        better: Word,
    },
    /// Both words are in the language, or neither is.
    Equal {
        /// One word.
        first: Word,
        /// The other.
        second: Word,
    },
}

impl Item {
    /// The words, in the order in which the item names them.
    pub fn words(&self) -> impl Iterator<Item = &Word> {
        let (first, second) = match self {
            Self::Label { word, .. } | Self::Unknown { word } => (word, None),
            Self::Below { worse, better } => (worse, Some(better)),
            Self::Equal { first, second } => (first, Some(second)),
        };
        std::iter::once(first).chain(second)
    }

    /// Whether a language agrees, of which `contains` says what is in it.
    pub fn holds(&self, contains: impl Fn(&Word) -> bool) -> bool {
        match self {
            Self::Label { word, accepted } => contains(word) == *accepted,
            Self::Unknown { .. } => true,
            Self::Below { worse, better } => !contains(worse) || contains(better),
            Self::Equal { first, second } => contains(first) == contains(second),
        }
    }
}

/// An ordered list of items over one alphabet, as sample files keep it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Sample {
    alphabet: Alphabet,
    items: Vec<Item>,
}

impl Sample {
    /// A sample without items.
    pub fn new(alphabet: Alphabet) -> Self {
        Self {
            alphabet,
            items: Vec::new(),
        }
    }

    /// Appends an item.
    ///
    /// # Panics
    ///
    /// If a word has a symbol that is not of this alphabet.
    pub fn push(&mut self, item: Item) {
        let symbols = self.alphabet.len();
        for symbol in item.words().flat_map(Word::iter) {
            assert!(
                symbol.index() < symbols,
                "symbol {} is not of the alphabet {}",
                symbol.index(),
                self.alphabet
            );
        }
        self.items.push(item);
    }

    /// The alphabet of all words.
    pub fn alphabet(&self) -> &Alphabet {
        &self.alphabet
    }

    /// The items in order.
    pub fn items(&self) -> &[Item] {
        &self.items
    }

    /// The first item that an automaton contradicts: its place, from 0.
    pub fn first_violated(&self, dfa: &Dfa) -> Option<usize> {
        self.items
            .iter()
            .position(|item| !item.holds(|word| dfa.accepts(word)))
    }
}

impl Extend<Item> for Sample {
    /// Appends items one by one; see [`Sample::push`].
    fn extend<I: IntoIterator<Item = Item>>(&mut self, items: I) {
        for item in items {
            self.push(item);
        }
    }
}
