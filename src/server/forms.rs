//! Reads what people and scripts send: JSON bodies and forms.

use automata::{Alphabet, Word};
use serde_json::{Value, json};

use super::error::WebError;
use super::upload;
use crate::evidence::Comparison;
use crate::learner::Reply;
use crate::session::{Atom, Fields, MAX_WORD, Malformed, Task, Universe};
use crate::store::UploadId;

/// The answers that the API knows, for people.
const ANSWERS: &str = "`accept`, `reject`, `first`, `second`, `equal`, `incomparable`, `correct`, `counterexample` or `skip`";

/// A JSON body.
///
/// # Errors
///
/// Says at which line and column it ceases to be JSON.
pub(crate) fn json_body(body: &[u8]) -> Result<Value, WebError> {
    if body.is_empty() {
        return Err(WebError::Unreadable(
            "the body is empty: send a JSON object".to_owned(),
        ));
    }
    serde_json::from_slice(body)
        .map_err(|error| WebError::Unreadable(format!("the body is not JSON: {error}")))
}

/// The question's number in a JSON body.
pub(crate) fn question_number(fields: &Fields<'_>) -> Result<u32, Malformed> {
    fields
        .whole("question", 1, u32::MAX as usize)?
        .map(|n| n as u32)
        .ok_or_else(|| Malformed::new("question", "give the number of the question"))
}

/// The answer in a JSON body: the keys `answer`, `label`, and the one under which the
/// universe tells behaviours.
pub(crate) fn json_reply(
    fields: &Fields<'_>,
    universe: &Universe,
) -> Result<Reply<Atom>, Malformed> {
    let Some(answer) = fields.get("answer").and_then(Value::as_str) else {
        return Err(Malformed::new("answer", format!("give one of {ANSWERS}")));
    };
    let key = universe.key();
    if answer != "counterexample" {
        for key in [key, "label"] {
            if fields.get(key).is_some() {
                return Err(Malformed::new(
                    key,
                    format!("`{key}` belongs to the answer `counterexample` alone: leave it out"),
                ));
            }
        }
        return plain_reply(answer);
    }
    let Some(atom) = fields.get(key) else {
        let how = match universe {
            Universe::Words { .. } => ", as an array of symbol names".to_owned(),
            Universe::Monotone(axes) => format!(": {}", axes.expected()),
            Universe::Finite(_) | Universe::Linear(_) => " by its name".to_owned(),
        };
        return Err(Malformed::new(
            key,
            format!("give the {key} that the rule treats wrongly{how}"),
        ));
    };
    let atom = universe.read(atom, key)?;
    let Some(label) = fields.get("label").and_then(Value::as_bool) else {
        return Err(Malformed::new(
            "label",
            format!("say `true` if the {key} is acceptable, `false` if it is not"),
        ));
    };
    Ok(Reply::Counterexample { atom, label })
}

/// The answers that need no word.
pub(crate) fn plain_reply(answer: &str) -> Result<Reply<Atom>, Malformed> {
    Ok(match answer {
        "accept" => Reply::Accept,
        "reject" => Reply::Reject,
        "first" => Reply::Compared(Comparison::First),
        "second" => Reply::Compared(Comparison::Second),
        "equal" => Reply::Compared(Comparison::Equal),
        "incomparable" => Reply::Compared(Comparison::Incomparable),
        "correct" => Reply::Correct,
        "skip" => Reply::Skip,
        _ => {
            return Err(Malformed::new(
                "answer",
                format!("`{answer}` is no answer: give one of {ANSWERS}"),
            ));
        }
    })
}

/// The field of the start page's form in which a task file comes.
pub(crate) const FILE: &str = "file";

/// The content of a task file, JSON or TOML. A target is left out: it is for scripted
/// teachers, and people are never shown it.
///
/// # Errors
///
/// Says where it ceases to be one of the two.
pub(crate) fn task_content(text: &str) -> Result<Value, String> {
    let mut content = if text.trim_start().starts_with('{') {
        serde_json::from_str(text).map_err(|error| format!("this is not JSON: {error}"))?
    } else {
        Task::toml_content(text).map_err(|fault| {
            let line = fault.line.unwrap_or(1);
            format!("line {line}: {}", fault.message)
        })?
    };
    if let Value::Object(task) = &mut content {
        task.remove("target");
    }
    Ok(content)
}

/// A form's fields, in the order sent.
pub(crate) struct Form(Vec<(String, String)>);

impl Form {
    /// The fields of a form body. Of control characters only those stay that people
    /// type: the others cannot stand in the page that shows a fault.
    pub(crate) fn new(mut fields: Vec<(String, String)>) -> Self {
        let unshown = |c: char| c.is_control() && !matches!(c, '\n' | '\r' | '\t');
        for (_, value) in &mut fields {
            if value.contains(unshown) {
                *value = value.replace(unshown, "\u{fffd}");
            }
        }
        Self(fields)
    }

    /// The first value of a field, empty where there is none.
    pub(crate) fn text(&self, name: &str) -> &str {
        self.0
            .iter()
            .find(|(key, _)| key == name)
            .map_or("", |(_, value)| value.as_str())
    }

    /// Whether the form has the field at all.
    pub(crate) fn has(&self, name: &str) -> bool {
        self.0.iter().any(|(key, _)| key == name)
    }

    /// Whether it has a task file.
    pub(crate) fn has_file(&self) -> bool {
        !self.text(FILE).trim().is_empty()
    }

    /// The task of a task file.
    fn file_task(&self, upload: Option<UploadId>) -> Result<Task, Malformed> {
        let fault = |message: String| Malformed::new(FILE, message);
        let mut task = task_content(self.text(FILE)).map_err(fault)?;
        let named = |error: Malformed| {
            let path = error.path.strip_prefix("task.").unwrap_or(&error.path);
            fault(format!("`{path}`: {}", error.message))
        };
        if let Some(upload) = upload {
            upload::use_upload(&mut task, upload).map_err(named)?;
        }
        Task::from_json(&task).map_err(named)
    }

    /// The number of the question that is meant.
    pub(crate) fn number(&self, name: &'static str) -> Result<u32, Malformed> {
        self.text(name)
            .trim()
            .parse()
            .map_err(|_| Malformed::new(name, format!("give a whole number as `{name}`")))
    }

    /// All values of a field, in the order sent.
    pub(crate) fn texts<'a>(&'a self, name: &'a str) -> impl Iterator<Item = &'a str> {
        let named = self.0.iter().filter(move |(key, _)| key == name);
        named.map(|(_, value)| value.as_str())
    }

    /// The answer: a plain one, or a counterexample where the form has none.
    pub(crate) fn reply(&self, universe: &Universe) -> Result<Reply<Atom>, Malformed> {
        if self.has("answer") {
            return plain_reply(self.text("answer"));
        }
        if !self.has(universe.key()) && !self.has("label") {
            return Err(Malformed::new("answer", "choose an answer"));
        }
        let atom = match universe {
            Universe::Words { alphabet, .. } => {
                Atom::Word(typed_word(self.text("word"), "word", alphabet)?)
            }
            Universe::Monotone(axes) => {
                let values = self.texts("point").map(typed_number);
                let values: Vec<f64> = values.collect::<Result<_, _>>()?;
                let point = axes.nearest(&values);
                let point = point.map_err(|error| Malformed::new("point", error.to_string()))?;
                Atom::Point(point)
            }
            Universe::Finite(_) | Universe::Linear(_) => {
                universe.read(&self.text("item").into(), "item")?
            }
        };
        let label = match self.text("label") {
            "true" => true,
            "false" => false,
            _ => {
                return Err(Malformed::new(
                    "label",
                    "choose whether this should be accepted or not",
                ));
            }
        };
        Ok(Reply::Counterexample { atom, label })
    }

    /// The task of the "my own" form; its world is the upload, if there is one.
    pub(crate) fn own_task_in(&self, upload: Option<UploadId>) -> Result<Task, Malformed> {
        if self.has_file() {
            return self.file_task(upload);
        }
        let names: Vec<&str> = self
            .text("symbols")
            .split(|c: char| c.is_whitespace() || c == ',' || c == ';')
            .filter(|name| !name.is_empty())
            .collect();
        if names.is_empty() {
            return Err(Malformed::new(
                "symbols",
                "name the things that can happen, with spaces between, as in `water dryer recharge`",
            ));
        }
        let mut task = json!({ "symbols": names });
        if !self.text("title").trim().is_empty() {
            task["title"] = self.text("title").into();
        }
        // The alphabet is checked first, so that its faults are named before
        // those of the examples.
        Task::from_json(&task)?;
        let alphabet =
            Alphabet::new(names).map_err(|error| Malformed::new("symbols", error.to_string()))?;
        let mut examples = Vec::new();
        for (i, line) in self.text("examples").lines().enumerate() {
            let line = line.trim();
            if line.is_empty() {
                continue;
            }
            let (label, rest) = example_label(line).ok_or_else(|| {
                Malformed::new(
                    "examples",
                    format!(
                        "line {}: begin with `+` for acceptable or `-` for not acceptable, as in `+ water dryer`",
                        i + 1
                    ),
                )
            })?;
            let word = typed_word(rest, "examples", &alphabet).map_err(|e| {
                Malformed::new("examples", format!("line {}: {}", i + 1, e.message))
            })?;
            let names: Vec<&str> = alphabet.spell(&word).collect();
            examples.push(json!({"word": names, "label": label}));
        }
        task["examples"] = Value::Array(examples);
        if let Some(upload) = upload {
            task["world"] = json!({"kind": "pool", "upload": upload.to_string()});
        }
        Task::from_json(&task)
    }
}

/// A number as people type it, with a point or a comma.
fn typed_number(text: &str) -> Result<f64, Malformed> {
    let number = text.trim().replace(',', ".").parse().ok();
    number
        .filter(|number: &f64| number.is_finite())
        .ok_or_else(|| {
            Malformed::new(
                "point",
                format!(
                    "`{}` is no number: write digits, as in `12` or `1.5`",
                    text.trim()
                ),
            )
        })
}

fn example_label(line: &str) -> Option<(bool, &str)> {
    if let Some(rest) = line.strip_prefix('+') {
        return Some((true, rest));
    }
    // Hyphen, minus sign, en dash: what keyboards and documents make of it.
    line.strip_prefix(['-', '\u{2212}', '\u{2013}'])
        .map(|rest| (false, rest))
}

/// A word as people type it: names with spaces or commas between; where all
/// names are single characters the spaces may be left out.
pub(crate) fn typed_word(text: &str, field: &str, alphabet: &Alphabet) -> Result<Word, Malformed> {
    let single = alphabet.names().all(|name| name.chars().count() == 1);
    let mut symbols = Vec::new();
    for token in text
        .split(|c: char| c.is_whitespace() || c == ',' || c == '·')
        .filter(|token| !token.is_empty())
    {
        if let Some(symbol) = alphabet.symbol(token) {
            symbols.push(symbol);
        } else if single
            && let Some(several) = token
                .chars()
                .map(|c| alphabet.symbol(c.encode_utf8(&mut [0; 4])))
                .collect::<Option<Vec<_>>>()
        {
            symbols.extend(several);
        } else {
            let names: Vec<&str> = alphabet.names().collect();
            return Err(Malformed::new(
                field,
                format!("`{token}` is not a symbol: use {}", names.join(", ")),
            ));
        }
    }
    if symbols.len() > MAX_WORD {
        return Err(Malformed::new(
            field,
            format!(
                "this has {} symbols: at most {MAX_WORD} are possible",
                symbols.len()
            ),
        ));
    }
    Ok(symbols.into())
}

/// What is wrong with a form, and at which of its fields that is to be said.
#[derive(Clone, Default)]
pub(crate) struct Faults(Option<(&'static str, String)>);

impl Faults {
    /// The error at the field that it speaks of, or else at the first.
    pub(crate) fn of(error: &WebError, fields: &[&'static str]) -> Self {
        let path = error.field().unwrap_or_default();
        let named = path.split(['[', '.']).next().unwrap_or_default();
        let field = fields.iter().find(|field| **field == named);
        let field = field.or(fields.first()).copied().unwrap_or_default();
        Self(Some((field, error.message())))
    }

    /// What is to be said, wherever.
    pub(crate) fn message(&self) -> Option<String> {
        self.0.as_ref().map(|(_, message)| message.clone())
    }

    /// What is to be said at this field.
    pub(crate) fn at(&self, field: &str) -> Option<&str> {
        let (faulty, message) = self.0.as_ref()?;
        (*faulty == field).then_some(message)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn form(fields: &[(&str, &str)]) -> Form {
        Form::new(
            fields
                .iter()
                .map(|(k, v)| ((*k).to_owned(), (*v).to_owned()))
                .collect(),
        )
    }

    #[test]
    fn words_are_read_as_people_type_them() {
        let short = Alphabet::new(["R", "Y", "B"]).unwrap();
        let expected = short.word(["R", "Y", "B"]).unwrap();
        for text in ["R Y B", " RYB ", "R,Y,B", "RY B", "R · Y · B"] {
            assert_eq!(
                typed_word(text, "word", &short),
                Ok(expected.clone()),
                "{text}"
            );
        }
        assert_eq!(typed_word("  ", "word", &short), Ok(Word::empty()));
        let long = Alphabet::new(["a", "bc"]).unwrap();
        let error = typed_word("abc", "word", &long).unwrap_err();
        assert_eq!(error.message, "`abc` is not a symbol: use a, bc");
    }

    #[test]
    fn the_own_form_becomes_a_task() {
        let task = form(&[
            ("symbols", "water, dryer recharge"),
            ("examples", "+ water dryer\r\n\r\n- water\n+\n"),
            ("title", " Tea "),
        ])
        .own_task_in(None)
        .unwrap();
        assert_eq!(task.title, "Tea");
        assert_eq!(task.symbols.len(), 3);
        let labels: Vec<bool> = task.examples.iter().map(|e| e.label).collect();
        assert_eq!(labels, [true, false, true]);
        for (fields, path, part) in [
            (form(&[]), "symbols", "name the things"),
            (form(&[("symbols", "a a")]), "symbols[1]", "twice"),
            (
                form(&[("symbols", "a"), ("examples", "+ a\nb")]),
                "examples",
                "line 2: begin",
            ),
            (
                form(&[("symbols", "a"), ("examples", "+ b")]),
                "examples",
                "line 1: `b`",
            ),
            (
                form(&[("symbols", "a"), ("examples", "+ a\n- a")]),
                "examples[1]",
                "other label",
            ),
        ] {
            let error = fields.own_task_in(None).unwrap_err();
            assert_eq!(error.path, path);
            assert!(error.message.contains(part), "{error}");
        }
    }
}
