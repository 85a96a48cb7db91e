//! Labelled words in the text format of the Abbadingo competition.
//!
//! ```text
//! 3 2
//! 1 2 0 1
//! 0 0
//! -1 1 1
//! ```
//!
//! The first line holds the number of words and of symbols; every other line a
//! label (1 accepted, 0 rejected, -1 unknown), a length, and that many symbols
//! by number. The format has no names: symbols are read as `0`, `1`, …, and
//! written by their places in the alphabet. It has no preferences either.

use std::fmt::Write as _;

use super::{ReadError, WriteError};
use crate::sample::{Item, Sample};
use crate::{Alphabet, Symbol, Word};

/// Reads a sample over the symbols `0`, `1`, …, as many as the first line says.
///
/// Empty lines are passed over.
///
/// # Errors
///
/// With line and column, at the first number that is not as it should be.
pub fn read(text: &str) -> Result<Sample, ReadError> {
    let mut lines = text
        .lines()
        .enumerate()
        .map(|(index, line)| Line::new(index + 1, line))
        .filter(|line| line.peek().is_some());
    let Some(mut header) = lines.next() else {
        return Err(ReadError::at(
            1,
            1,
            "expected `WORDS SYMBOLS`, found nothing: the file is empty",
        ));
    };
    let words: usize = header.number("the number of words")?;
    let (_, column) = header.place();
    let symbols: usize = header.number("the number of symbols")?;
    header.end("the first line is `WORDS SYMBOLS`")?;
    if symbols == 0 || symbols > Alphabet::MAX_SYMBOLS {
        return Err(ReadError::at(
            header.number,
            column,
            format!(
                "expected 1 to {} symbols, found {symbols}",
                Alphabet::MAX_SYMBOLS
            ),
        ));
    }
    let alphabet = Alphabet::new((0..symbols).map(|name| name.to_string()))
        .map_err(|error| ReadError::at(header.number, column, error.to_string()))?;
    let mut sample = Sample::new(alphabet);
    for mut line in lines {
        if sample.items().len() == words {
            return Err(ReadError::at(
                line.number,
                1,
                format!(
                    "expected the end of the file, for line {} says {words} words: correct that number",
                    header.number
                ),
            ));
        }
        sample.push(item(&mut line, symbols)?);
    }
    if sample.items().len() < words {
        return Err(ReadError::at(
            text.lines().count() + 1,
            1,
            format!(
                "expected {words} words, found {}: the file is cut short, or the number in line {} is wrong",
                sample.items().len(),
                header.number
            ),
        ));
    }
    Ok(sample)
}

/// One line after the first.
fn item(line: &mut Line<'_>, symbols: usize) -> Result<Item, ReadError> {
    let place = line.place();
    let accepted = match line.token() {
        Some("1") => Some(true),
        Some("0") => Some(false),
        Some("-1") => None,
        other => {
            let found = other.unwrap_or("nothing");
            return Err(ReadError::at(
                place.0,
                place.1,
                format!("expected a label, 1, 0 or -1, found `{found}`"),
            ));
        }
    };
    let length: usize = line.number("the length of the word")?;
    let mut word = Word::empty();
    for done in 0..length {
        let (number, column) = line.place();
        if line.peek().is_none() {
            return Err(ReadError::at(
                number,
                column,
                format!("expected {length} symbols, found {done}: correct the length or the word"),
            ));
        }
        let symbol: usize = line.number("a symbol")?;
        if symbol >= symbols {
            return Err(ReadError::at(
                number,
                column,
                format!("expected a symbol below {symbols}, found {symbol}"),
            ));
        }
        word.push(Symbol::new(symbol));
    }
    line.end(&format!("the length before it is {length}"))?;
    Ok(match accepted {
        Some(accepted) => Item::Label { word, accepted },
        None => Item::Unknown { word },
    })
}

/// What is left of a line, and where that is.
struct Line<'a> {
    /// From 1.
    number: usize,
    text: &'a str,
    /// Characters before `text`.
    passed: usize,
}

impl<'a> Line<'a> {
    fn new(number: usize, text: &'a str) -> Self {
        let mut line = Self {
            number,
            text,
            passed: 0,
        };
        line.skip_blank();
        line
    }

    fn skip_blank(&mut self) {
        let rest = self.text.trim_start();
        let blank = &self.text[..self.text.len() - rest.len()];
        self.passed += blank.chars().count();
        self.text = rest;
    }

    /// The line and the column of what comes next.
    fn place(&self) -> (usize, usize) {
        (self.number, self.passed + 1)
    }

    fn peek(&self) -> Option<&'a str> {
        self.text.split_whitespace().next()
    }

    fn token(&mut self) -> Option<&'a str> {
        let token = self.peek()?;
        self.text = &self.text[token.len()..];
        self.passed += token.chars().count();
        self.skip_blank();
        Some(token)
    }

    /// The next token as a number.
    fn number(&mut self, what: &str) -> Result<usize, ReadError> {
        let (line, column) = self.place();
        let token = self.token();
        token.and_then(|t| t.parse().ok()).ok_or_else(|| {
            let found = token.map_or("nothing".to_owned(), |t| format!("`{t}`"));
            ReadError::at(line, column, format!("expected {what}, found {found}"))
        })
    }

    /// Refuses anything more.
    fn end(&self, why: &str) -> Result<(), ReadError> {
        match self.peek() {
            None => Ok(()),
            Some(token) => {
                let (line, column) = self.place();
                let message = format!("expected the end of the line, found `{token}`: {why}");
                Err(ReadError::at(line, column, message))
            }
        }
    }
}

/// Writes a sample; its symbols by their places in the alphabet.
///
/// # Errors
///
/// If an item is a preference.
pub fn write(sample: &Sample) -> Result<String, WriteError> {
    let mut text = format!("{} {}\n", sample.items().len(), sample.alphabet().len());
    for (place, item) in sample.items().iter().enumerate() {
        let (label, word) = match item {
            Item::Label { word, accepted } => (if *accepted { "1" } else { "0" }, word),
            Item::Unknown { word } => ("-1", word),
            Item::Below { .. } | Item::Equal { .. } => {
                return Err(WriteError::Preference { item: place + 1 });
            }
        };
        let _ = write!(text, "{label} {}", word.len());
        for symbol in word.iter() {
            let _ = write!(text, " {}", symbol.index());
        }
        text.push('\n');
    }
    Ok(text)
}
