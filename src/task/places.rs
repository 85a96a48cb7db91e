//! Where in a TOML text its values stand: the value as JSON, and a tree of places.

use std::collections::BTreeMap;
use std::ops::Range;

use serde_json::{Map, Value, json};
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// Where the values of a text stand.
#[derive(Debug, Default)]
pub(super) struct Places {
    span: Range<usize>,
    within: Within,
}

#[derive(Debug, Default)]
enum Within {
    #[default]
    Nothing,
    Text,
    Array(Vec<Places>),
    Table(BTreeMap<String, Places>),
}

/// The line and the column, both from 1, columns in characters.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Place {
    pub(crate) line: usize,
    pub(crate) column: usize,
}

impl Place {
    /// Of a byte of the text.
    pub(crate) fn of(text: &str, byte: usize) -> Self {
        let before = text.get(..byte).unwrap_or(text);
        let line_start = before.rfind('\n').map_or(0, |at| at + 1);
        Self {
            line: before.matches('\n').count() + 1,
            column: before[line_start..].chars().count() + 1,
        }
    }
}

/// Reads a TOML text.
///
/// # Errors
///
/// Says where it ceases to be TOML.
pub(super) fn read(text: &str) -> Result<(Value, Places), (Option<Place>, String)> {
    let table = DeTable::parse(text).map_err(|error| {
        let at = error.span().map(|span| Place::of(text, span.start));
        // The parser's message may have several lines.
        let message = error.message().trim().replace('\n', ", ");
        (at, format!("this is not TOML: {message}"))
    })?;
    let span = table.span();
    let (value, within) = read_table(table.get_ref());
    Ok((value, Places { span, within }))
}

fn read_table(table: &DeTable<'_>) -> (Value, Within) {
    let (mut map, mut places) = (Map::new(), BTreeMap::new());
    for (key, value) in table {
        let key = key.get_ref().to_string();
        let (value, place) = read_value(value);
        map.insert(key.clone(), value);
        places.insert(key, place);
    }
    (Value::Object(map), Within::Table(places))
}

fn read_value(value: &Spanned<DeValue<'_>>) -> (Value, Places) {
    let (read, within) = match value.get_ref() {
        DeValue::String(text) => (Value::from(text.as_ref()), Within::Text),
        DeValue::Integer(number) => {
            let digits = number.as_str();
            let signed = i64::from_str_radix(digits, number.radix()).map(Value::from);
            let number =
                signed.or_else(|_| u64::from_str_radix(digits, number.radix()).map(Value::from));
            // A number that does not fit into anything is no number that is meant.
            (
                number.unwrap_or_else(|_| json!({ "number": digits })),
                Within::Nothing,
            )
        }
        DeValue::Float(number) => {
            let parsed = number.as_str().parse::<f64>().ok();
            let finite = parsed
                .and_then(serde_json::Number::from_f64)
                .map(Value::Number);
            // JSON knows no infinite numbers; where one is meant it is said so.
            let infinite = || Value::from(number.as_str().trim_start_matches('+'));
            (finite.unwrap_or_else(infinite), Within::Nothing)
        }
        DeValue::Boolean(value) => (Value::from(*value), Within::Nothing),
        // Nothing in a task is a date: as an object it is refused wherever it is.
        DeValue::Datetime(date) => (json!({ "date": date.to_string() }), Within::Nothing),
        DeValue::Array(array) => {
            let (values, places) = array.iter().map(read_value).unzip();
            (Value::Array(values), Within::Array(places))
        }
        DeValue::Table(table) => read_table(table),
    };
    let span = value.span();
    (read, Places { span, within })
}

/// A step of a path.
enum Step<'a> {
    Key(&'a str),
    Index(usize),
}

impl Places {
    /// Where that stands which has this path, or else the innermost value around
    /// it. In a text of several lines the first index is a line and the second a
    /// character.
    pub(super) fn find(&self, path: &str, text: &str) -> Place {
        let mut place = self;
        let mut steps = steps(path).into_iter();
        while let Some(step) = steps.next() {
            let next = match (&place.within, &step) {
                (Within::Table(table), Step::Key(key)) => table.get(*key),
                (Within::Array(array), Step::Index(index)) => array.get(*index),
                (Within::Text, Step::Index(index)) => {
                    return place.inside(*index, steps.next(), text);
                }
                _ => None,
            };
            match next {
                Some(next) => place = next,
                None => break,
            }
        }
        Place::of(text, place.span.start)
    }

    /// A character of a text, or of one of its lines; where the text begins, if there
    /// is no such character.
    fn inside(&self, index: usize, then: Option<Step<'_>>, text: &str) -> Place {
        let start = Place::of(text, self.span.start);
        let found = self.counted(start, index, then, text);
        let line = text.lines().nth(found.line.saturating_sub(1));
        let is_there = line.is_some_and(|line| found.column <= line.chars().count());
        if is_there { found } else { start }
    }

    fn counted(&self, start: Place, index: usize, then: Option<Step<'_>>, text: &str) -> Place {
        let source = text.get(self.span.clone()).unwrap_or_default();
        let is_long = source.starts_with("\"\"\"") || source.starts_with("'''");
        match then {
            // One line of an array of lines; the quote comes first.
            None if !is_long => Place {
                column: (start.column + 1).saturating_add(index),
                ..start
            },
            // Several lines written in one: there is no better place.
            Some(_) if !is_long => start,
            then => {
                let column = match then {
                    Some(Step::Index(column)) => column,
                    _ => 0,
                };
                let rest = &source[3..];
                // A line break right after the quotes is not part of the text.
                let begins_below = rest.starts_with('\n') || rest.starts_with("\r\n");
                let (line, before) = match (index, begins_below) {
                    (0, false) => (start.line, start.column + 3),
                    (_, false) => (start.line.saturating_add(index), 1),
                    (_, true) => ((start.line + 1).saturating_add(index), 1),
                };
                Place {
                    line,
                    column: column.saturating_add(before),
                }
            }
        }
    }
}

/// The steps of a path such as `symbols[2].name`.
fn steps(path: &str) -> Vec<Step<'_>> {
    let parts = path.split(['.', '[']).filter(|part| !part.is_empty());
    let step = |part: &'_ str| match part.strip_suffix(']') {
        Some(index) => index.parse().ok().map(Step::Index),
        None => None,
    };
    parts
        .map(|part| step(part).unwrap_or(Step::Key(part)))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_path_leads_to_its_value() {
        let text = "a = 1\n[b]\nc = [ \"x\", { d = true } ]\nmap = \"\"\"\n..S\n.Q.\n\"\"\"\nrows = [\n  \"..S\",\n  '.ü.',\n]\n[[e]]\nf = inf\n[[e]]\nf = 0x10\n";
        let (value, places) = read(text).unwrap();
        assert_eq!(value["e"], json!([{"f": "inf"}, {"f": 16}]));
        assert_eq!(value["b"]["map"], "..S\n.Q.\n");
        for (path, line, column) in [
            ("a", 1, 5),
            ("b.c[0]", 3, 7),
            ("b.c[1].d", 3, 18),
            ("b.c[1].unknown", 3, 12),
            ("b.map", 4, 7),
            ("b.map[1][1]", 6, 2),
            ("b.rows[1][1]", 10, 5),
            ("e[0].f", 13, 5),
            ("e[1].f", 15, 5),
            ("nowhere", 1, 1),
        ] {
            assert_eq!(places.find(path, text), Place { line, column }, "{path}");
        }
    }

    /// A key may look like a path of a text that is not so long.
    #[test]
    fn indices_beyond_a_text_lead_to_its_beginning() {
        let text = "a = \"x\"\nmap = \"\"\"\n..\n\"\"\"\n";
        let (_, places) = read(text).unwrap();
        let beyond = usize::MAX;
        for (path, line, column) in [
            (format!("a[{beyond}]"), 1, 5),
            (format!("map[{beyond}]"), 2, 7),
            (format!("map[0][{beyond}]"), 2, 7),
            (format!("map[{beyond}][{beyond}]"), 2, 7),
        ] {
            assert_eq!(places.find(&path, text), Place { line, column }, "{path}");
        }
    }

    #[test]
    fn faults_of_syntax_have_a_place() {
        for (text, line, column) in [("a = \n", 1, 5), ("a = 1\na = 2\n", 2, 1), ("x\n", 1, 2)] {
            let (place, message) = read(text).unwrap_err();
            assert!(message.starts_with("this is not TOML: "), "{message}");
            assert_eq!(place, Some(Place { line, column }), "{text}: {message}");
        }
    }
}
