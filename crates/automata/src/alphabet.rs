//! A finite alphabet of named symbols.

use std::fmt;
use std::sync::Arc;

use serde::{Deserialize, Serialize};

use crate::Word;

/// A symbol's position in its [`Alphabet`], from 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Symbol(u16);

impl Symbol {
    /// The symbol at position `index` of an alphabet.
    ///
    /// # Panics
    ///
    /// If `index` is beyond [`Alphabet::MAX_SYMBOLS`].
    pub fn new(index: usize) -> Self {
        assert!(
            index < Alphabet::MAX_SYMBOLS,
            "symbol {index} is beyond any alphabet"
        );
        Self(index as u16)
    }

    /// The position in the alphabet, from 0.
    pub fn index(self) -> usize {
        usize::from(self.0)
    }
}

/// An ordered, non-empty set of named symbols. Cloning is cheap.
///
/// Two alphabets are equal when they have the same names in the same order.
#[derive(Clone, PartialEq, Eq, Hash)]
pub struct Alphabet {
    names: Arc<[String]>,
}

/// Why a list of names is no alphabet.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum AlphabetError {
    /// There is no symbol at all.
    #[error("the alphabet is empty: give at least one symbol")]
    Empty,
    /// A name is not of the form `[A-Za-z_0-9]+`.
    #[error(
        "symbol {position} is named `{}`: use letters, digits and `_` only, at least one of them",
        name.escape_debug()
    )]
    BadName {
        /// The place in the list, from 0.
        position: usize,
        /// The name as given.
        name: String,
    },
    /// A name stands twice.
    #[error(
        "symbol `{name}` is named twice, as number {} and {}: give every symbol its own name", first + 1, second + 1
    )]
    Duplicate {
        /// The name that is repeated.
        name: String,
        /// Where it stands first, from 0.
        first: usize,
        /// Where it stands again, from 0.
        second: usize,
    },
    /// There are more names than [`Alphabet::MAX_SYMBOLS`].
    #[error("the alphabet has {0} symbols: at most {max} are possible", max = Alphabet::MAX_SYMBOLS)]
    TooLarge(usize),
}

/// A name that an alphabet does not have.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("`{}` is not a symbol of the alphabet {alphabet}", name.escape_debug())]
pub struct UnknownSymbol {
    /// The name as given.
    pub name: String,
    /// The alphabet's names, for people: `{a, b}`.
    pub alphabet: String,
}

impl Alphabet {
    /// The largest number of symbols an alphabet may have.
    pub const MAX_SYMBOLS: usize = 4096;

    /// An alphabet of these names, in this order.
    ///
    /// # Errors
    ///
    /// If there is no name, or one is empty, has a character outside
    /// `[A-Za-z_0-9]`, or stands twice.
    pub fn new<I, S>(names: I) -> Result<Self, AlphabetError>
    where
        I: IntoIterator<Item = S>,
        S: Into<String>,
    {
        let names: Vec<String> = names.into_iter().map(Into::into).collect();
        if names.is_empty() {
            return Err(AlphabetError::Empty);
        }
        if names.len() > Self::MAX_SYMBOLS {
            return Err(AlphabetError::TooLarge(names.len()));
        }
        let mut seen = std::collections::HashMap::new();
        for (position, name) in names.iter().enumerate() {
            let plain = |c: char| c.is_ascii_alphanumeric() || c == '_';
            if name.is_empty() || !name.chars().all(plain) {
                return Err(AlphabetError::BadName {
                    position,
                    name: name.clone(),
                });
            }
            if let Some(first) = seen.insert(name.as_str(), position) {
                return Err(AlphabetError::Duplicate {
                    name: name.clone(),
                    first,
                    second: position,
                });
            }
        }
        Ok(Self {
            names: names.into(),
        })
    }

    /// The number of symbols, at least 1.
    #[expect(clippy::len_without_is_empty, reason = "an alphabet is never empty")]
    pub fn len(&self) -> usize {
        self.names.len()
    }

    /// All symbols in order.
    pub fn symbols(&self) -> impl DoubleEndedIterator<Item = Symbol> + ExactSizeIterator + use<> {
        (0..self.len()).map(Symbol::new)
    }

    /// The names in order.
    pub fn names(&self) -> impl ExactSizeIterator<Item = &str> {
        self.names.iter().map(String::as_str)
    }

    /// The name of a symbol of this alphabet.
    ///
    /// # Panics
    ///
    /// If `symbol` belongs to a larger alphabet.
    pub fn name(&self, symbol: Symbol) -> &str {
        &self.names[symbol.index()]
    }

    /// The symbol of this name.
    pub fn symbol(&self, name: &str) -> Option<Symbol> {
        self.names.iter().position(|n| n == name).map(Symbol::new)
    }

    /// The word of these symbol names.
    ///
    /// # Errors
    ///
    /// Names the first one that this alphabet does not have.
    pub fn word<I, S>(&self, names: I) -> Result<Word, UnknownSymbol>
    where
        I: IntoIterator<Item = S>,
        S: AsRef<str>,
    {
        names
            .into_iter()
            .map(|name| {
                let name = name.as_ref();
                self.symbol(name).ok_or_else(|| UnknownSymbol {
                    name: name.to_owned(),
                    alphabet: self.to_string(),
                })
            })
            .collect()
    }

    /// The names of a word's symbols, in order.
    ///
    /// # Panics
    ///
    /// If the word has a symbol that is not of this alphabet.
    pub fn spell<'a>(&'a self, word: &'a Word) -> impl Iterator<Item = &'a str> {
        word.iter().map(|symbol| self.name(symbol))
    }
}

impl fmt::Display for Alphabet {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{{{}}}", self.names.join(", "))
    }
}

impl fmt::Debug for Alphabet {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}
