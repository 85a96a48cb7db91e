//! Writes task files: TOML in the order of the template, which reads as the same task.

use std::fmt::Write as _;

use serde_json::{Map, Value};

use super::Task;

/// What stands before the tables, in this order.
const FIRST: [&str; 7] = [
    "name",
    "title",
    "empty",
    "guidelines",
    "target",
    "strategy",
    "max_states",
];
/// The tables, and arrays of tables, in this order, with their keys in theirs.
const TABLES: [(&str, &[&str]); 7] = [
    ("costs", &["membership", "comparison"]),
    (
        "class",
        &["kind", "ticks", "finest", "picture", "features", "table"],
    ),
    ("symbols", &["name", "word", "letter", "colour"]),
    ("world", &["kind", "steps", "longest", "labelling", "map"]),
    ("prior", &["holds", "suffices"]),
    ("examples", &["word", "point", "item", "label"]),
    (
        "practice",
        &["word", "point", "item", "first", "second", "answer", "why"],
    ),
];
/// What is written as tables of its own inside `class`.
const WITHIN_CLASS: [(&str, &[&str]); 2] = [
    ("axes", &["name", "unit", "best", "worst"]),
    ("behaviours", &["name", "features"]),
];

impl Task {
    /// The task as a file, TOML: [`Self::toml_content`] and [`Self::from_json`] make the
    /// same task of it.
    pub fn to_toml(&self) -> String {
        toml_text(&serde_json::to_value(self).unwrap_or_default())
    }
}

/// The content of a task file as TOML, whether it is a task or has faults. What is no
/// object has no content.
pub fn toml_text(content: &Value) -> String {
    let empty = Map::new();
    let content = content.as_object().unwrap_or(&empty);
    let mut text = String::new();
    let is_told = |key: &str| {
        let value = content.get(key);
        value.filter(|value| !value.is_null() && !is_bare_nothing(key, value))
    };
    let others = content.keys().map(String::as_str);
    let others = others.filter(|key| !FIRST.contains(key));
    for key in FIRST.into_iter().chain(others) {
        if let Some(value) = is_told(key)
            && !has_own_table(key, value)
        {
            entry(&mut text, key, value);
        }
    }
    for (key, order) in TABLES {
        match is_told(key).filter(|value| has_own_table(key, value)) {
            Some(Value::Object(map)) => table(&mut text, key, map, order),
            Some(Value::Array(list)) => tables(&mut text, key, list, order),
            _ => {}
        }
    }
    text
}

/// An empty list of examples says nothing.
fn is_bare_nothing(key: &str, value: &Value) -> bool {
    key == "examples" && value.as_array().is_some_and(Vec::is_empty)
}

/// Whether it is written under a heading.
fn has_own_table(key: &str, value: &Value) -> bool {
    let is_known = TABLES.iter().any(|(table, _)| *table == key);
    match value {
        Value::Object(_) => is_known && !["symbols", "examples"].contains(&key),
        Value::Array(list) => {
            ["symbols", "examples"].contains(&key) && is_tables(list) && !names_alone(key, list)
        }
        _ => false,
    }
}

fn is_tables(list: &[Value]) -> bool {
    !list.is_empty() && list.iter().all(Value::is_object)
}

/// Whether these symbols have names and nothing else: they are then written as such.
fn names_alone(key: &str, list: &[Value]) -> bool {
    let only = |symbol: &Value| {
        let map = symbol.as_object();
        map.is_some_and(|map| map.len() == 1 && map.get("name").is_some_and(Value::is_string))
    };
    key == "symbols" && list.iter().all(only)
}

fn table(text: &mut String, heading: &str, map: &Map<String, Value>, order: &[&str]) {
    let _ = write!(text, "\n[{heading}]\n");
    let nested = |key: &str, value: &Value| {
        let order = WITHIN_CLASS.iter().find(|(name, _)| *name == key);
        let order = order.filter(|_| heading == "class")?;
        let list = value.as_array().filter(|list| is_tables(list))?;
        Some((list.clone(), order.1))
    };
    for (key, value) in ordered(map, order) {
        if nested(key, value).is_none() {
            entry(text, key, value);
        }
    }
    for (key, value) in ordered(map, order) {
        if let Some((list, order)) = nested(key, value) {
            tables(text, &format!("{heading}.{key}"), &list, order);
        }
    }
}

fn tables(text: &mut String, heading: &str, list: &[Value], order: &[&str]) {
    for value in list {
        let _ = write!(text, "\n[[{heading}]]\n");
        for (key, value) in value
            .as_object()
            .into_iter()
            .flat_map(|map| ordered(map, order))
        {
            entry(text, key, value);
        }
    }
}

/// The entries, those of `order` first.
fn ordered<'a>(
    map: &'a Map<String, Value>,
    order: &'a [&str],
) -> impl Iterator<Item = (&'a str, &'a Value)> {
    let first = order.iter().filter_map(|key| map.get_key_value(*key));
    let rest = map.iter().filter(|(key, _)| !order.contains(&key.as_str()));
    let told = first.chain(rest).filter(|(_, value)| !value.is_null());
    told.map(|(key, value)| (key.as_str(), value))
}

/// A line `key = value`; several lines for texts that have several.
fn entry(text: &mut String, key: &str, value: &Value) {
    let rows = match value {
        Value::Array(rows) if key == "map" => rows.iter().map(Value::as_str).collect(),
        Value::Array(list) if names_alone(key, list) => {
            let names = list.iter().map(|symbol| symbol["name"].clone());
            return entry(text, key, &names.collect());
        }
        _ => None,
    };
    let rows: Option<Vec<&str>> = rows.filter(|rows: &Vec<&str>| {
        !rows.is_empty() && !rows.iter().any(|row| row.contains(['\n', '\r']))
    });
    let written = match (rows, value) {
        (Some(rows), _) => block(&format!("{}\n", rows.join("\n"))),
        // What people read is trimmed when it is read.
        (None, Value::String(long)) if long.contains('\n') && is_prose(key) => {
            block(&format!("{}\n", long.trim_end()))
        }
        (None, Value::String(long)) if long.contains('\n') => block(long),
        (None, value) => inline(value),
    };
    let _ = writeln!(text, "{} = {written}", bare(key));
}

fn is_prose(key: &str) -> bool {
    ["guidelines", "why"].contains(&key)
}

/// A key, in quotes where it has to be.
fn bare(key: &str) -> String {
    let is_plain = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '-';
    if !key.is_empty() && key.chars().all(is_plain) {
        key.to_owned()
    } else {
        quoted(key)
    }
}

/// A value within a line.
fn inline(value: &Value) -> String {
    match value {
        // Nothing in a task is null; there is no such thing in TOML.
        Value::Null => "\"\"".to_owned(),
        Value::Bool(value) => value.to_string(),
        Value::Number(number) => number.to_string(),
        Value::String(text) => quoted(text),
        Value::Array(list) => {
            let list: Vec<String> = list.iter().map(inline).collect();
            format!("[{}]", list.join(", "))
        }
        Value::Object(map) => {
            let told = map.iter().filter(|(_, value)| !value.is_null());
            let entries: Vec<String> = told
                .map(|(key, value)| format!("{} = {}", bare(key), inline(value)))
                .collect();
            format!("{{ {} }}", entries.join(", "))
        }
    }
}

fn quoted(text: &str) -> String {
    let mut written = String::from("\"");
    for c in text.chars() {
        match c {
            '"' => written.push_str("\\\""),
            '\n' => written.push_str("\\n"),
            c => escaped(&mut written, c),
        }
    }
    written.push('"');
    written
}

/// A text of several lines between three quotes, exactly as it is.
fn block(text: &str) -> String {
    let ends_it = text.contains("\"\"") || text.ends_with('"');
    let mut written = String::from("\"\"\"\n");
    for c in text.chars() {
        match c {
            '"' if ends_it => written.push_str("\\\""),
            '\n' => written.push('\n'),
            c => escaped(&mut written, c),
        }
    }
    written.push_str("\"\"\"");
    written
}

fn escaped(written: &mut String, c: char) {
    match c {
        '\\' => written.push_str("\\\\"),
        '\t' => written.push_str("\\t"),
        '\r' => written.push_str("\\r"),
        c if c.is_control() => {
            let _ = write!(written, "\\u{:04X}", u32::from(c));
        }
        c => written.push(c),
    }
}
