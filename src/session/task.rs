//! What a session teaches: symbols with their human words, and what is known
//! before the first question.

use std::collections::BTreeMap;

use automata::{Alphabet, AlphabetError, Symbol, Word};
use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::reader::{Fields, Malformed};
use crate::evidence::Fact;

/// The largest number of symbols a taught alphabet may have: more cannot be
/// offered as buttons.
pub const MAX_SYMBOLS: usize = 64;
/// The largest number of symbols in a word that a person or a script gives.
pub const MAX_WORD: usize = 1000;
/// The largest number of examples known at the start.
pub const MAX_EXAMPLES: usize = 2000;
/// The largest bound on states that can be asked for.
pub const MAX_STATES: usize = 100;
/// The bound on states where a task names none.
pub const DEFAULT_STATES: usize = 24;

/// A symbol as people see it.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct SymbolText {
    /// The name in words, automata and the API: `[A-Za-z_0-9]+`.
    pub name: String,
    /// The human word for it; the name where there is none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub word: Option<String>,
}

impl SymbolText {
    /// What people read.
    pub fn text(&self) -> &str {
        self.word.as_deref().unwrap_or(&self.name)
    }
}

/// A word whose label is known before the first question.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Example {
    /// Symbol names, in order.
    pub word: Vec<String>,
    /// Whether it is acceptable.
    pub label: bool,
}

/// What a session teaches. Always valid: names are unique, examples use them.
///
/// It says nothing about the target: that is in the teacher's head.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(try_from = "Value")]
pub struct Task {
    /// The ready task's name, `own` for one that was written by hand.
    pub name: String,
    /// One line for people.
    pub title: String,
    /// The alphabet, in order.
    pub symbols: Vec<SymbolText>,
    /// What is known at the start; no word stands twice.
    pub examples: Vec<Example>,
    /// The largest number of states considered, until it is raised.
    pub max_states: usize,
    /// What the teacher should keep in mind; may be empty.
    pub guidelines: String,
    /// What the empty word is called, without brackets.
    pub empty: String,
}

const KEYS: &[&str] = &[
    "name",
    "title",
    "symbols",
    "examples",
    "max_states",
    "guidelines",
    "empty",
];

impl Task {
    /// Reads a task file's content.
    ///
    /// # Errors
    ///
    /// Names the JSON path of the first thing that is wrong, and what to do.
    pub fn from_json(value: &Value) -> Result<Self, Malformed> {
        let fields = Fields::of(value, "")?;
        if value.get("target").is_some() {
            return Err(Malformed::new(
                "target",
                "a session is taught by whoever answers it: leave `target` out, and keep it for `memrep learn`",
            ));
        }
        fields.only(KEYS)?;
        let symbols = fields.required_list(
            "symbols",
            "give the names of the symbols, as in `[\"a\", \"b\"]`",
        )?;
        let symbols = symbols
            .iter()
            .enumerate()
            .map(|(i, symbol)| read_symbol(symbol, &format!("symbols[{i}]")))
            .collect::<Result<Vec<_>, _>>()?;
        let alphabet = check_alphabet(&symbols)?;
        let examples = fields
            .list("examples")?
            .iter()
            .enumerate()
            .map(|(i, example)| read_example(example, &format!("examples[{i}]"), &alphabet))
            .collect::<Result<Vec<_>, _>>()?;
        let examples = merge_examples(examples)?;
        Ok(Self {
            name: fields.text("name", 60)?.unwrap_or_else(|| "own".to_owned()),
            title: fields
                .text("title", 120)?
                .unwrap_or_else(|| "My own rule".to_owned()),
            symbols,
            examples,
            max_states: fields
                .whole("max_states", 1, MAX_STATES)?
                .unwrap_or(DEFAULT_STATES),
            guidelines: fields.long_text("guidelines", 4000)?.unwrap_or_default(),
            empty: fields
                .text("empty", 60)?
                .unwrap_or_else(|| "nothing happens".to_owned()),
        })
    }

    /// The alphabet of the symbols' names.
    ///
    /// # Panics
    ///
    /// If the task was put together by hand, and its names make no alphabet.
    pub fn alphabet(&self) -> Alphabet {
        Alphabet::new(self.symbols.iter().map(|symbol| symbol.name.as_str()))
            .expect("a task's symbols were checked when it was read")
    }

    /// What is known at the start, as facts over [`Task::alphabet`].
    ///
    /// # Panics
    ///
    /// If the task was put together by hand, and an example uses other names.
    pub fn known(&self, alphabet: &Alphabet) -> Vec<Fact<Word>> {
        self.examples
            .iter()
            .map(|example| Fact::Label {
                atom: alphabet
                    .word(&example.word)
                    .expect("a task's examples were checked when it was read"),
                accepted: example.label,
            })
            .collect()
    }

    /// What people read for a symbol of [`Task::alphabet`].
    pub fn text(&self, symbol: Symbol) -> &str {
        self.symbols[symbol.index()].text()
    }
}

impl TryFrom<Value> for Task {
    type Error = Malformed;

    fn try_from(value: Value) -> Result<Self, Malformed> {
        Self::from_json(&value)
    }
}

/// Reads an array of symbol names as a word of `alphabet`.
///
/// # Errors
///
/// Names the path of the first entry that is no symbol.
pub fn read_word(value: &Value, path: &str, alphabet: &Alphabet) -> Result<Word, Malformed> {
    let Some(names) = value.as_array() else {
        return Err(Malformed::new(
            path,
            "give a word as an array of symbol names, `[]` for the empty word",
        ));
    };
    if names.len() > MAX_WORD {
        return Err(Malformed::new(
            path,
            format!(
                "the word has {} symbols: at most {MAX_WORD} are possible",
                names.len()
            ),
        ));
    }
    names
        .iter()
        .enumerate()
        .map(|(i, name)| {
            let at = format!("{path}[{i}]");
            let Some(name) = name.as_str() else {
                return Err(Malformed::new(at, "give a symbol's name as a string"));
            };
            alphabet.symbol(name).ok_or_else(|| {
                Malformed::new(
                    at,
                    format!("`{name}` is not a symbol: the symbols are {alphabet}"),
                )
            })
        })
        .collect()
}

fn read_symbol(value: &Value, path: &str) -> Result<SymbolText, Malformed> {
    if let Some(name) = value.as_str() {
        return Ok(SymbolText {
            name: name.to_owned(),
            word: None,
        });
    }
    let fields = Fields::of(value, path).map_err(|_| {
        Malformed::new(
            path,
            "give a symbol as its name, or as `{\"name\": \"b\", \"word\": \"water\"}`",
        )
    })?;
    fields.only(&["name", "word"])?;
    let Some(name) = fields.text("name", 60)? else {
        return Err(Malformed::new(
            path,
            "this symbol has no `name`: give it one",
        ));
    };
    Ok(SymbolText {
        name,
        word: fields.text("word", 60)?,
    })
}

fn check_alphabet(symbols: &[SymbolText]) -> Result<Alphabet, Malformed> {
    if symbols.len() > MAX_SYMBOLS {
        return Err(Malformed::new(
            "symbols",
            format!(
                "there are {} symbols: at most {MAX_SYMBOLS} can be taught",
                symbols.len()
            ),
        ));
    }
    Alphabet::new(symbols.iter().map(|symbol| symbol.name.as_str())).map_err(|error| {
        let path = match &error {
            AlphabetError::BadName { position, .. } => format!("symbols[{position}]"),
            AlphabetError::Duplicate { second, .. } => format!("symbols[{second}]"),
            AlphabetError::Empty | AlphabetError::TooLarge(_) => "symbols".to_owned(),
        };
        Malformed::new(path, error.to_string())
    })
}

fn read_example(value: &Value, path: &str, alphabet: &Alphabet) -> Result<Example, Malformed> {
    let fields = Fields::of(value, path).map_err(|_| {
        Malformed::new(
            path,
            "give an example as `{\"word\": [\"a\"], \"label\": true}`",
        )
    })?;
    fields.only(&["word", "label"])?;
    let Some(word) = value.get("word") else {
        return Err(Malformed::new(path, "this example has no `word`: give one"));
    };
    let word = read_word(word, &format!("{path}.word"), alphabet)?;
    let Some(label) = value.get("label").and_then(Value::as_bool) else {
        return Err(Malformed::new(
            format!("{path}.label"),
            "say `true` if the word is acceptable, `false` if it is not",
        ));
    };
    Ok(Example {
        word: alphabet.spell(&word).map(str::to_owned).collect(),
        label,
    })
}

/// Drops repetitions and refuses a word with two labels.
fn merge_examples(examples: Vec<Example>) -> Result<Vec<Example>, Malformed> {
    if examples.len() > MAX_EXAMPLES {
        return Err(Malformed::new(
            "examples",
            format!(
                "there are {} examples: at most {MAX_EXAMPLES} are possible",
                examples.len()
            ),
        ));
    }
    let mut seen: BTreeMap<Vec<String>, (usize, bool)> = BTreeMap::new();
    let mut kept = Vec::with_capacity(examples.len());
    for (position, example) in examples.into_iter().enumerate() {
        match seen.get(&example.word) {
            None => {
                seen.insert(example.word.clone(), (position, example.label));
                kept.push(example);
            }
            Some((_, label)) if *label == example.label => {}
            Some((first, _)) => {
                return Err(Malformed::new(
                    format!("examples[{position}]"),
                    format!(
                        "this word has the other label at examples[{first}]: keep one of the two"
                    ),
                ));
            }
        }
    }
    Ok(kept)
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    #[test]
    fn a_task_survives_its_log() {
        let task = Task::from_json(&json!({
            "title": "Tea",
            "symbols": ["a", {"name": "b", "word": "water"}],
            "examples": [{"word": [], "label": false}, {"word": ["b", "a"], "label": true}],
            "max_states": 7,
            "guidelines": "first water,\nthen tea",
        }))
        .unwrap();
        let again: Task = serde_json::from_value(serde_json::to_value(&task).unwrap()).unwrap();
        assert_eq!(task, again);
        assert_eq!(task.text(Symbol::new(1)), "water");
        assert_eq!(task.known(&task.alphabet()).len(), 2);
    }

    #[test]
    fn every_fault_is_named_with_its_path() {
        let cases = [
            (json!([]), "", "object"),
            (json!({}), "symbols", "give the names"),
            (json!({"symbols": []}), "symbols", "empty"),
            (json!({"symbols": "ab"}), "symbols", "array"),
            (json!({"symbols": ["a", "a"]}), "symbols[1]", "twice"),
            (json!({"symbols": ["a", "b c"]}), "symbols[1]", "`b c`"),
            (json!({"symbols": ["a", 3]}), "symbols[1]", "as its name"),
            (
                json!({"symbols": [{"name": "a", "colour": 1}]}),
                "symbols[0].colour",
                "unknown",
            ),
            (
                json!({"symbols": [{"word": "a"}]}),
                "symbols[0]",
                "no `name`",
            ),
            (
                json!({"symbols": ["a"], "sybmols": 1}),
                "sybmols",
                "unknown",
            ),
            (
                json!({"symbols": ["a"], "target": "tomita:1"}),
                "target",
                "leave `target` out",
            ),
            (
                json!({"symbols": ["a"], "max_states": 0}),
                "max_states",
                "between 1 and 100",
            ),
            (
                json!({"symbols": ["a"], "max_states": 2.5}),
                "max_states",
                "whole number",
            ),
            (
                json!({"symbols": ["a"], "title": "x\u{202e}y"}),
                "title",
                "control",
            ),
            (
                json!({"symbols": ["a"], "examples": [{"word": ["b"], "label": true}]}),
                "examples[0].word[0]",
                "`b` is not a symbol",
            ),
            (
                json!({"symbols": ["a"], "examples": [{"word": ["a"]}]}),
                "examples[0].label",
                "true",
            ),
            (
                json!({"symbols": ["a"], "examples": [{"label": true}]}),
                "examples[0]",
                "no `word`",
            ),
            (
                json!({"symbols": ["a"], "examples": [{"word": ["a"], "label": true}, {"word": ["a"], "label": false}]}),
                "examples[1]",
                "examples[0]",
            ),
        ];
        for (input, path, part) in cases {
            let error = Task::from_json(&input).unwrap_err();
            assert_eq!(error.path, path, "{input}: {error}");
            assert!(error.message.contains(part), "{input}: {error}");
        }
    }
}
