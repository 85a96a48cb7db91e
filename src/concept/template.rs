//! Rules that tasks often have, by name: the words in which people know them
//! beforehand.

use automata::{Alphabet, Dfa, Symbol};

/// A rule by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Template {
    /// `avoid X`: `X` never happens.
    Avoid(Symbol),
    /// `reach Y`: `Y` happens at some time.
    Reach(Symbol),
    /// `X before Y`: no `Y` happens unless an `X` has happened. Neither has to.
    Before(Symbol, Symbol),
    /// `never X after Y`: once `Y` has happened, `X` does not.
    NeverAfter(Symbol, Symbol),
}

/// Why a text is no template.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum TemplateError {
    /// It has another form.
    #[error(
        "`{0}` is no rule that is known by name: write `avoid X`, `reach Y`, `X before Y` or `never X after Y`, or give an automaton file"
    )]
    Form(String),
    /// It names a symbol that the alphabet does not have.
    #[error("`{text}`: `{symbol}` is not a symbol of the alphabet {alphabet}")]
    Symbol {
        /// The text.
        text: String,
        /// What it names.
        symbol: String,
        /// The symbols, for people.
        alphabet: String,
    },
    /// It names one symbol twice.
    #[error("`{0}` is about one symbol: name two, or write `avoid X`")]
    Twice(String),
}

impl Template {
    /// Reads a rule.
    ///
    /// # Errors
    ///
    /// If it has no known form, or names no symbols of the alphabet.
    pub fn parse(text: &str, alphabet: &Alphabet) -> Result<Self, TemplateError> {
        let symbol = |name: &str| {
            alphabet.symbol(name).ok_or_else(|| TemplateError::Symbol {
                text: text.to_owned(),
                symbol: name.to_owned(),
                alphabet: alphabet.to_string(),
            })
        };
        let two = |first: &str, second: &str| {
            let (first, second) = (symbol(first)?, symbol(second)?);
            if first == second {
                return Err(TemplateError::Twice(text.to_owned()));
            }
            Ok((first, second))
        };
        let words: Vec<&str> = text.split_whitespace().collect();
        match words[..] {
            ["avoid", x] => Ok(Self::Avoid(symbol(x)?)),
            ["reach", y] => Ok(Self::Reach(symbol(y)?)),
            [x, "before", y] => two(x, y).map(|(x, y)| Self::Before(x, y)),
            ["never", x, "after", y] => two(x, y).map(|(x, y)| Self::NeverAfter(x, y)),
            _ => Err(TemplateError::Form(text.to_owned())),
        }
    }

    /// The words that keep the rule.
    ///
    /// # Panics
    ///
    /// If it names a symbol of a larger alphabet.
    pub fn dfa(self, alphabet: &Alphabet) -> Dfa {
        let (accepting, steps): (&[bool], &[(usize, Symbol, usize)]) = match self {
            Self::Avoid(x) => (&[true, false], &[(0, x, 1)]),
            Self::Reach(y) => (&[false, true], &[(0, y, 1)]),
            Self::Before(x, y) => (&[true, true, false], &[(0, x, 1), (0, y, 2)]),
            Self::NeverAfter(x, y) => (&[true, true, false], &[(0, y, 1), (1, x, 2)]),
        };
        let mut rows: Vec<Vec<usize>> = (0..accepting.len())
            .map(|state| vec![state; alphabet.len()])
            .collect();
        for &(from, symbol, to) in steps {
            rows[from][symbol.index()] = to;
        }
        Dfa::new(alphabet.clone(), 0, accepting.to_vec(), &rows)
            .expect("every state has a row, and every entry is a state")
    }
}
