//! Reads JSONL samples line by line.

use std::collections::HashMap;

use super::{Label, Line};
use crate::format::ReadError;
use crate::format::json::{alphabet_error, expect_object};
use crate::sample::{Item, Sample};
use crate::{Alphabet, Symbol, Word};

/// What to do about a line that is JSON but no item.
const HINT: &str = r#"; a line is {"word":["a"],"label":true}, {"worse":["a"],"better":["b"]} or {"equal":[["a"],["b"]]}"#;

/// Reads a sample. Its alphabet is the one that the first line names, or else
/// has the symbols of all words in the order of their first appearance.
///
/// Empty lines are passed over.
///
/// # Errors
///
/// With line and column, and with the path of the field where a value makes no
/// item; or if there is no symbol at all.
pub fn read(text: &str) -> Result<Sample, ReadError> {
    read_file(text, File::alphabet).map_err(|error| placed(error, text))
}

/// Reads a sample over a known alphabet.
///
/// # Errors
///
/// As [`read`], or if a word has another symbol, or the first line names
/// another alphabet.
pub fn read_over(text: &str, alphabet: &Alphabet) -> Result<Sample, ReadError> {
    let over = |file: &File| match &file.declared {
        Some((number, declared)) if declared != alphabet => {
            let message = format!("expected the alphabet {alphabet}, found {declared}");
            Err(ReadError::field("alphabet", message).on_line(*number))
        }
        _ => Ok(alphabet.clone()),
    };
    read_file(text, over).map_err(|error| placed(error, text))
}

fn read_file(
    text: &str,
    alphabet_of: impl FnOnce(&File) -> Result<Alphabet, ReadError>,
) -> Result<Sample, ReadError> {
    let file = File::parse(text)?;
    let alphabet = alphabet_of(&file)?;
    file.sample(alphabet)
}

/// The error with the place of its field in its line.
fn placed(error: ReadError, text: &str) -> ReadError {
    let line = error.line().and_then(|number| text.lines().nth(number - 1));
    error.placed_in(line.unwrap_or_default())
}

/// What a line says.
enum Content {
    Alphabet(Vec<String>),
    Item(Named<Vec<String>>),
}

/// An item whose symbols are still names, or the numbers of names.
enum Named<W> {
    Label(W, Label),
    Below(W, W),
    Equal(W, W),
}

impl Content {
    /// The form that a line has.
    fn of(line: Line) -> Result<Self, ReadError> {
        let preference = (line.worse, line.better, line.equal);
        Ok(match (line.alphabet, line.word, line.label, preference) {
            (Some(names), None, None, (None, None, None)) => Self::Alphabet(names),
            (None, Some(word), Some(label), (None, None, None)) => {
                Self::Item(Named::Label(word, label))
            }
            (None, None, None, (Some(worse), Some(better), None)) => {
                Self::Item(Named::Below(worse, better))
            }
            (None, None, None, (None, None, Some(words))) => {
                let [first, second] = <[_; 2]>::try_from(words).map_err(|words| {
                    let message = format!("expected two words, found {}", words.len());
                    ReadError::field("equal", message)
                })?;
                Self::Item(Named::Equal(first, second))
            }
            _ => {
                let message = format!("these keys do not go together{HINT}");
                return Err(ReadError::at(1, 1, message));
            }
        })
    }
}

impl<W> Named<W> {
    /// The words with their places in the line.
    fn words(&self) -> Vec<(&'static str, &W)> {
        match self {
            Self::Label(word, _) => vec![("word", word)],
            Self::Below(worse, better) => vec![("worse", worse), ("better", better)],
            Self::Equal(first, second) => vec![("equal[0]", first), ("equal[1]", second)],
        }
    }
}

impl Named<Vec<String>> {
    fn numbered(self, names: &mut Names) -> Named<Box<[u32]>> {
        let mut number = |word: Vec<String>| names.numbers(word);
        match self {
            Self::Label(word, label) => Named::Label(number(word), label),
            Self::Below(worse, better) => Named::Below(number(worse), number(better)),
            Self::Equal(first, second) => Named::Equal(number(first), number(second)),
        }
    }
}

impl Named<Box<[u32]>> {
    /// The item, by the symbols of all names.
    fn item(&self, symbols: &[Result<Symbol, String>]) -> Result<Item, ReadError> {
        let read = |field, names| word(symbols, field, names);
        Ok(match self {
            Self::Label(names, Label(Some(accepted))) => Item::Label {
                word: read("word", names)?,
                accepted: *accepted,
            },
            Self::Label(names, Label(None)) => Item::Unknown {
                word: read("word", names)?,
            },
            Self::Below(worse, better) => Item::Below {
                worse: read("worse", worse)?,
                better: read("better", better)?,
            },
            Self::Equal(first, second) => Item::Equal {
                first: read("equal[0]", first)?,
                second: read("equal[1]", second)?,
            },
        })
    }
}

/// The word of these names; the error has the place of the first that is no
/// symbol.
fn word(symbols: &[Result<Symbol, String>], field: &str, names: &[u32]) -> Result<Word, ReadError> {
    let symbols = names.iter().enumerate().map(|(place, name)| {
        let symbol = symbols[*name as usize].clone();
        symbol.map_err(|message| ReadError::field(format!("{field}[{place}]"), message))
    });
    symbols.collect()
}

/// The names of symbols, each kept once however often it stands in the file.
#[derive(Default)]
struct Names {
    numbers: HashMap<String, u32>,
    /// In the order in which they appear.
    all: Vec<String>,
}

impl Names {
    fn numbers(&mut self, word: Vec<String>) -> Box<[u32]> {
        let number = |name: String| {
            if let Some(number) = self.numbers.get(&name) {
                return *number;
            }
            let number = self.all.len() as u32;
            self.all.push(name.clone());
            self.numbers.insert(name, number);
            number
        };
        word.into_iter().map(number).collect()
    }
}

/// A file before its alphabet is known.
struct File {
    /// The alphabet that the first line names, and that line's number.
    declared: Option<(usize, Alphabet)>,
    /// The items, each with the number of its line.
    items: Vec<(usize, Named<Box<[u32]>>)>,
    names: Names,
}

impl File {
    fn parse(text: &str) -> Result<Self, ReadError> {
        let mut file = Self {
            declared: None,
            items: Vec::new(),
            names: Names::default(),
        };
        for (index, line) in text.lines().enumerate() {
            let number = index + 1;
            if !line.trim().is_empty() {
                file.line(number, line)
                    .map_err(|error| error.on_line(number))?;
            }
        }
        Ok(file)
    }

    fn line(&mut self, number: usize, text: &str) -> Result<(), ReadError> {
        let json = |error| ReadError::json(&error, HINT);
        expect_object(text, HINT)?;
        match Content::of(serde_json::from_str(text).map_err(json)?)? {
            Content::Item(item) => {
                let item = item.numbered(&mut self.names);
                self.items.push((number, item));
            }
            Content::Alphabet(names) => {
                if self.declared.is_some() || !self.items.is_empty() {
                    let message = "the alphabet can only be named once, before all words: move it to the first line";
                    return Err(ReadError::field("alphabet", message));
                }
                let alphabet = Alphabet::new(names).map_err(|e| alphabet_error(&e))?;
                self.declared = Some((number, alphabet));
            }
        }
        Ok(())
    }

    /// The one that the first line names, or else the one that is shown.
    fn alphabet(&self) -> Result<Alphabet, ReadError> {
        match &self.declared {
            Some((_, alphabet)) => Ok(alphabet.clone()),
            None => self.shown_alphabet(),
        }
    }

    /// The symbols in the order in which they appear.
    fn shown_alphabet(&self) -> Result<Alphabet, ReadError> {
        let names = &self.names.all;
        // One by one, so that the error has the place of the bad one.
        let bad = names.iter().position(|name| Alphabet::new([name]).is_err());
        if let Some(bad) = bad {
            let message = format!(
                "expected a symbol, found \"{}\": use letters, digits and `_` only",
                names[bad]
            );
            return Err(self.first(bad as u32, message));
        }
        if names.is_empty() {
            let message = r#"there is no symbol in this file, so its alphabet is not known: name it in the first line, {"alphabet":["a","b"]}"#;
            return Err(ReadError::at(1, 1, message));
        }
        Alphabet::new(names).map_err(|error| ReadError::at(1, 1, error.to_string()))
    }

    /// The error where this name stands first.
    fn first(&self, name: u32, message: String) -> ReadError {
        for (number, item) in &self.items {
            for (field, word) in item.words() {
                if let Some(place) = word.iter().position(|known| *known == name) {
                    let error = ReadError::field(format!("{field}[{place}]"), message);
                    return error.on_line(*number);
                }
            }
        }
        ReadError::at(1, 1, message)
    }

    /// The items over their alphabet.
    fn sample(&self, alphabet: Alphabet) -> Result<Sample, ReadError> {
        let symbol = |name: &String| {
            alphabet.symbol(name).ok_or_else(|| {
                format!("expected a symbol of the alphabet {alphabet}, found \"{name}\"")
            })
        };
        let symbols: Vec<Result<Symbol, String>> = self.names.all.iter().map(symbol).collect();
        let mut sample = Sample::new(alphabet);
        for (number, item) in &self.items {
            let item = item.item(&symbols);
            sample.push(item.map_err(|error| error.on_line(*number))?);
        }
        Ok(sample)
    }
}
