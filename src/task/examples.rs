//! Words in tasks and requests: examples known at the start, and the practice
//! question.

use std::collections::BTreeMap;

use automata::{Alphabet, Word};
use serde::Serialize;
use serde_json::Value;

use super::reader::{Faults, Fields, Malformed};
use super::situation::Situation;
use super::{MAX_EXAMPLES, MAX_WORD};

/// A word whose label is known before the first question.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Example {
    /// Symbol names, in order.
    pub word: Vec<String>,
    /// Whether it is acceptable.
    pub label: bool,
}

/// A question with its answer, by which a person learns what is meant.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Practice {
    /// What is asked.
    #[serde(flatten)]
    pub asks: Practised,
    /// The expected answer, by its name in the API.
    pub answer: &'static str,
    /// Why that is the answer, for the person.
    pub why: String,
}

/// What a practice question asks.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
#[serde(untagged)]
pub enum Practised {
    /// Is this acceptable?
    Judgement {
        /// Symbol names, in order.
        word: Vec<String>,
    },
    /// Which is better?
    Comparison {
        /// One word.
        first: Vec<String>,
        /// The other.
        second: Vec<String>,
    },
}

const JUDGEMENTS: [&str; 2] = ["accept", "reject"];
const COMPARISONS: [&str; 4] = ["first", "second", "equal", "incomparable"];

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

/// The examples under `examples`, without repetitions. Each must be possible in the
/// situation.
pub(super) fn read(
    fields: &Fields<'_>,
    alphabet: &Alphabet,
    situation: Option<&Situation>,
    faults: &mut Faults,
) -> Vec<Example> {
    let list = faults.keep(fields.list("examples")).unwrap_or_default();
    if list.len() > MAX_EXAMPLES {
        faults.0.push(Malformed::new(
            "examples",
            format!(
                "there are {} examples: at most {MAX_EXAMPLES} are possible",
                list.len()
            ),
        ));
        return Vec::new();
    }
    let mut seen: BTreeMap<Word, (usize, bool)> = BTreeMap::new();
    let mut kept = Vec::with_capacity(list.len());
    for (place, value) in list.iter().enumerate() {
        let path = format!("examples[{place}]");
        let Some((word, label)) = faults.keep(read_example(value, &path, alphabet)) else {
            continue;
        };
        match seen.get(&word) {
            Some((_, known)) if *known == label => continue,
            Some((first, _)) => {
                faults.0.push(Malformed::new(
                    path,
                    format!(
                        "this word has the other label at examples[{first}]: keep one of the two"
                    ),
                ));
                continue;
            }
            None => {}
        }
        if let Some(situation) = situation {
            faults.keep(situation.check(&word, Some(label), &path));
        }
        kept.push(Example {
            word: names(&word, alphabet),
            label,
        });
        seen.insert(word, (place, label));
    }
    kept
}

/// Checks that the examples and the practice question are possible in the situation.
///
/// # Errors
///
/// Names the first that is not.
pub(super) fn check(
    examples: &[Example],
    practice: Option<&Practice>,
    alphabet: &Alphabet,
    situation: &Situation,
) -> Result<(), Malformed> {
    let one = |names: &[String], label, path: &str| {
        let word = alphabet
            .word(names)
            .map_err(|error| Malformed::new(path, error.to_string()))?;
        situation.check(&word, label, path)
    };
    for (place, example) in examples.iter().enumerate() {
        one(
            &example.word,
            Some(example.label),
            &format!("examples[{place}]"),
        )?;
    }
    match practice.map(|practice| &practice.asks) {
        None => Ok(()),
        Some(Practised::Judgement { word }) => one(word, None, "practice.word"),
        Some(Practised::Comparison { first, second }) => {
            one(first, None, "practice.first")?;
            one(second, None, "practice.second")
        }
    }
}

fn names(word: &Word, alphabet: &Alphabet) -> Vec<String> {
    alphabet.spell(word).map(str::to_owned).collect()
}

fn read_example(value: &Value, path: &str, alphabet: &Alphabet) -> Result<(Word, bool), Malformed> {
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
    Ok((word, label))
}

/// The question under `practice`, if there is one.
pub(super) fn read_practice(
    fields: &Fields<'_>,
    alphabet: &Alphabet,
    situation: Option<&Situation>,
) -> Result<Option<Practice>, Malformed> {
    const FORM: &str = "give either one `word`, or `first` and `second` to be compared";
    let Some(value) = fields.get("practice") else {
        return Ok(None);
    };
    let fields = Fields::of(value, "practice")?;
    fields.only(&["word", "first", "second", "answer", "why"])?;
    let read = |key: &str| -> Result<Option<Word>, Malformed> {
        let Some(value) = fields.get(key) else {
            return Ok(None);
        };
        let path = fields.path_of(key);
        let word = read_word(value, &path, alphabet)?;
        if let Some(situation) = situation {
            situation.check(&word, None, &path)?;
        }
        Ok(Some(word))
    };
    let (asks, answers) = match (read("word")?, read("first")?, read("second")?) {
        (Some(word), None, None) => {
            let word = names(&word, alphabet);
            (Practised::Judgement { word }, &JUDGEMENTS[..])
        }
        (None, Some(first), Some(second)) => {
            let [first, second] = [first, second].map(|word| names(&word, alphabet));
            (Practised::Comparison { first, second }, &COMPARISONS[..])
        }
        _ => return Err(Malformed::new("practice", FORM)),
    };
    let given = fields.text("answer", 60)?.unwrap_or_default();
    let Some(&answer) = answers.iter().find(|answer| **answer == given) else {
        return Err(Malformed::new(
            fields.path_of("answer"),
            format!(
                "`{given}` does not answer this: expect one of {}",
                answers.join(", ")
            ),
        ));
    };
    let why = fields.long_text("why", 1000)?.ok_or_else(|| {
        Malformed::new(
            fields.path_of("why"),
            "say in a sentence why that is the answer: it is what the person practises for",
        )
    })?;
    Ok(Some(Practice { asks, answer, why }))
}
