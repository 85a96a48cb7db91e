//! Behaviours in tasks and requests: examples known at the start, and the practice
//! question.

use std::collections::BTreeMap;

use automata::{Alphabet, Word};
use serde::Serialize;
use serde_json::Value;

use super::reader::{Faults, Fields, Malformed};
use super::universe::{Atom, AtomText, Bare, Concept, Universe};
use super::{MAX_EXAMPLES, MAX_WORD};

/// A behaviour whose label is known before the first question.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Example {
    /// The behaviour.
    #[serde(flatten)]
    pub atom: AtomText,
    /// Whether it is acceptable.
    pub label: bool,
}

/// A question with its answer, by which a person learns what is meant.
#[derive(Clone, Debug, PartialEq, Serialize)]
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
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Practised {
    /// Is this acceptable?
    Judgement(AtomText),
    /// Which is better?
    Comparison {
        /// One behaviour.
        #[serde(with = "Bare")]
        first: AtomText,
        /// The other.
        #[serde(with = "Bare")]
        second: AtomText,
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
/// world of the task, and all together for its class.
pub(super) fn read(fields: &Fields<'_>, universe: &Universe, faults: &mut Faults) -> Vec<Example> {
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
    let mut seen: BTreeMap<Atom, (usize, bool)> = BTreeMap::new();
    let mut kept = Vec::with_capacity(list.len());
    for (place, value) in list.iter().enumerate() {
        let path = format!("examples[{place}]");
        let Some((atom, label)) = faults.keep(read_example(value, &path, universe)) else {
            continue;
        };
        match seen.get(&atom) {
            Some((_, known)) if *known == label => continue,
            Some((first, _)) => {
                faults.0.push(Malformed::new(
                    path,
                    format!(
                        "this {} has the other label at examples[{first}]: keep one of the two",
                        universe.key()
                    ),
                ));
                continue;
            }
            None => {}
        }
        faults.keep(check(universe, &atom, Some(label), &path));
        kept.push(Example {
            atom: universe.text(&atom),
            label,
        });
        seen.insert(atom, (place, label));
    }
    let labels = seen.into_iter().map(|(atom, (_, label))| (atom, label));
    if !universe.has_rule(labels.collect()) {
        faults.0.push(Malformed::new(
            "examples",
            "no rule of the task's `class` fits all of these: correct one of them, or widen the class",
        ));
    }
    kept
}

/// Checks again that the examples and the practice question can happen, once their
/// world is there.
///
/// # Errors
///
/// Names the first that cannot.
pub(super) fn check_all(
    examples: &[Example],
    practice: Option<&Practice>,
    universe: &Universe,
) -> Result<(), Malformed> {
    let one = |atom: &AtomText, label, path: &str| {
        let atom = universe.parse(atom);
        let atom = atom.map_err(|error| Malformed::new(path, error.to_string()))?;
        check(universe, &atom, label, path)
    };
    for (place, example) in examples.iter().enumerate() {
        let path = format!("examples[{place}]");
        one(&example.atom, Some(example.label), &path)?;
    }
    match practice.map(|practice| &practice.asks) {
        None => Ok(()),
        Some(Practised::Judgement(atom)) => one(atom, None, "practice.word"),
        Some(Practised::Comparison { first, second }) => {
            one(first, None, "practice.first")?;
            one(second, None, "practice.second")
        }
    }
}

/// Checks that a behaviour can happen, and that its label is not known otherwise.
fn check(
    universe: &Universe,
    atom: &Atom,
    label: Option<bool>,
    path: &str,
) -> Result<(), Malformed> {
    match (universe.situation(), atom) {
        (Some(situation), Atom::Word(word)) => situation.check(word, label, path),
        _ => Ok(()),
    }
}

fn read_example(value: &Value, path: &str, universe: &Universe) -> Result<(Atom, bool), Malformed> {
    let key = universe.key();
    let fields = Fields::of(value, path).map_err(|_| {
        let one = match universe {
            Universe::Words { .. } => "[\"a\"]",
            Universe::Monotone(_) => "[1.5, 20]",
            Universe::Finite(_) | Universe::Linear(_) => "\"a\"",
        };
        Malformed::new(
            path,
            format!("give an example as `{{\"{key}\": {one}, \"label\": true}}`"),
        )
    })?;
    fields.only(&[key, "label"])?;
    let Some(atom) = fields.get(key) else {
        return Err(Malformed::new(
            path,
            format!("this example has no `{key}`: give one"),
        ));
    };
    let atom = universe.read(atom, &format!("{path}.{key}"))?;
    let Some(label) = value.get("label").and_then(Value::as_bool) else {
        return Err(Malformed::new(
            format!("{path}.label"),
            format!("say `true` if the {key} is acceptable, `false` if it is not"),
        ));
    };
    Ok((atom, label))
}

/// The question under `practice`, if there is one.
pub(super) fn read_practice(
    fields: &Fields<'_>,
    universe: &Universe,
) -> Result<Option<Practice>, Malformed> {
    let Some(value) = fields.get("practice") else {
        return Ok(None);
    };
    let key = universe.key();
    let fields = Fields::of(value, "practice")?;
    fields.only(&[key, "first", "second", "answer", "why"])?;
    let read = |key: &str| -> Result<Option<AtomText>, Malformed> {
        let Some(value) = fields.get(key) else {
            return Ok(None);
        };
        let path = fields.path_of(key);
        let atom = universe.read(value, &path)?;
        check(universe, &atom, None, &path)?;
        Ok(Some(universe.text(&atom)))
    };
    let (asks, answers) = match (read(key)?, read("first")?, read("second")?) {
        (Some(atom), None, None) => (Practised::Judgement(atom), &JUDGEMENTS[..]),
        (None, Some(first), Some(second)) => {
            (Practised::Comparison { first, second }, &COMPARISONS[..])
        }
        _ => {
            return Err(Malformed::new(
                "practice",
                format!("give either one `{key}`, or `first` and `second` to be compared"),
            ));
        }
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

/// Checks that the expected answer contradicts nothing that is known: no example, not
/// what is known beforehand, and not the target.
pub(super) fn check_answer(
    practice: &Practice,
    examples: &[Example],
    target: Option<&Concept>,
    universe: &Universe,
) -> Result<(), Malformed> {
    let known = |text: &AtomText| -> Option<(bool, String)> {
        if let Some(place) = examples.iter().position(|example| example.atom == *text) {
            return Some((examples[place].label, format!("examples[{place}]")));
        }
        let atom = universe.parse(text).ok()?;
        let settled = match (universe.situation(), &atom) {
            (Some(situation), Atom::Word(word)) => situation.prior.settled(word),
            _ => None,
        };
        if let Some(label) = settled {
            return Some((label, "`prior`".to_owned()));
        }
        target.map(|target| (universe.accepts(target, &atom), "`target`".to_owned()))
    };
    let verdict = |label: bool| {
        if label {
            "acceptable"
        } else {
            "not acceptable"
        }
    };
    let answer = practice.answer;
    let said = match &practice.asks {
        Practised::Judgement(atom) => match known(atom) {
            Some((label, by)) if label != (answer == "accept") => {
                format!("{by} says that this is {}", verdict(label))
            }
            _ => return Ok(()),
        },
        Practised::Comparison { first, second } => match (known(first), known(second)) {
            (Some((one, by)), Some((other, also)))
                if one != other
                    && answer != "incomparable"
                    && answer != if one { "first" } else { "second" } =>
            {
                format!(
                    "{by} says that the first is {}, and {also} that the second is {}",
                    verdict(one),
                    verdict(other)
                )
            }
            _ => return Ok(()),
        },
    };
    Err(Malformed::new(
        "practice.answer",
        format!("the expected answer is `{answer}`, but {said}: correct one of them"),
    ))
}
