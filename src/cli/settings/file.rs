//! Reads the settings in a TOML file, with the line and column of each.

use std::path::Path;

use anyhow::bail;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::{Kind, Source, nearest};
use crate::task::Place;

/// What a file says of one setting.
pub(super) struct Given {
    pub(super) key: String,
    pub(super) texts: Vec<String>,
    pub(super) source: Source,
}

/// What a file says, given the settings that there are: the name of each, what its
/// values are, and whether it may have several.
pub(super) fn read(
    path: &Path,
    text: &str,
    known: &[(String, Kind, bool)],
) -> anyhow::Result<Vec<Given>> {
    let at = |byte| {
        let place = Place::of(text, byte);
        Source::File(path.to_owned(), place.line, place.column)
    };
    let table = match DeTable::parse(text) {
        Ok(table) => table,
        Err(error) => {
            let message = error.message().trim().replace('\n', ", ");
            let start = error.span().map_or(0, |span| span.start);
            bail!("{}: this is not TOML: {message}", at(start));
        }
    };
    let mut all = Vec::new();
    for (key, value) in table.get_ref() {
        let name = key.get_ref();
        let Some((_, kind, is_list)) = known.iter().find(|(known, ..)| known == name) else {
            let names: Vec<String> = known.iter().map(|(key, ..)| key.clone()).collect();
            let remedy = match nearest(name, &names) {
                Some(near) => format!("did you mean `{near}`?"),
                None => format!("the settings are {}", names.join(", ")),
            };
            bail!("{}: `{name}` is no setting: {remedy}", at(key.span().start));
        };
        let Some(texts) = texts(value, *kind, *is_list) else {
            let wanted = match kind {
                Kind::Text => "a string in quotes",
                Kind::Whole => "a whole number",
                Kind::Switch => "true or false",
            };
            let or_more = if *is_list {
                ", or an array of them"
            } else {
                ""
            };
            bail!(
                "{}: `{name}` is {wanted}{or_more}, not {}",
                at(value.span().start),
                described(odd(value, *kind, *is_list))
            );
        };
        all.push(Given {
            key: name.to_string(),
            texts,
            source: at(value.span().start),
        });
    }
    Ok(all)
}

fn texts(value: &Spanned<DeValue<'_>>, kind: Kind, is_list: bool) -> Option<Vec<String>> {
    match value.get_ref() {
        DeValue::Array(values) if is_list => {
            let each = values.iter().map(|value| text(value.get_ref(), kind));
            each.collect()
        }
        value => Some(vec![text(value, kind)?]),
    }
}

/// What is wrong about a value: one of several, or all of it.
fn odd<'a, 'i>(value: &'a Spanned<DeValue<'i>>, kind: Kind, is_list: bool) -> &'a DeValue<'i> {
    match value.get_ref() {
        DeValue::Array(values) if is_list => {
            let values = values.iter().map(Spanned::get_ref);
            let mut odd = values.filter(|value| text(value, kind).is_none());
            odd.next().unwrap_or(value.get_ref())
        }
        value => value,
    }
}

fn text(value: &DeValue<'_>, kind: Kind) -> Option<String> {
    match (kind, value) {
        (Kind::Text, DeValue::String(text)) => Some(text.to_string()),
        (Kind::Switch, DeValue::Boolean(on)) => Some(on.to_string()),
        (Kind::Whole, DeValue::Integer(number)) => {
            // One that is too large is the option's to refuse, as any out of its range.
            let value = i128::from_str_radix(number.as_str(), number.radix());
            Some(value.map_or_else(|_| number.to_string(), |value| value.to_string()))
        }
        _ => None,
    }
}

fn described(value: &DeValue<'_>) -> &'static str {
    match value {
        DeValue::String(_) => "a string",
        DeValue::Integer(_) => "a number",
        DeValue::Float(_) => "a number with a point",
        DeValue::Boolean(_) => "true or false",
        DeValue::Datetime(_) => "a date",
        DeValue::Array(_) => "an array",
        DeValue::Table(_) => "a table",
    }
}
