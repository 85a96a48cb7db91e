//! What is wrong with a task, at the fields of the form where it can be mended.

use std::collections::BTreeMap;

use super::sheet::{Sheet, first_key, is_list, row_named};
use crate::server::error::sentence;
use crate::session::Malformed;

/// A fault with the field at which it stands.
pub(super) struct Placed {
    /// The field, or the list, or nothing if it is about the whole.
    pub(super) field: String,
    /// Where it is, for people.
    pub(super) label: String,
    pub(super) message: String,
}

/// All faults of a form.
#[derive(Default)]
pub(super) struct SheetFaults {
    pub(super) all: Vec<Placed>,
    by_field: BTreeMap<String, String>,
}

impl SheetFaults {
    /// The faults of the task that this form says.
    pub(super) fn of(faults: Vec<Malformed>, sheet: &Sheet) -> Self {
        let mut found = Self::default();
        for fault in faults {
            let field = field_of(&fault.path, sheet).unwrap_or_default();
            found.add(field, &fault.message);
        }
        found
    }

    /// One more.
    pub(super) fn add(&mut self, field: String, message: &str) {
        let message = sentence(message);
        let told = self.by_field.entry(field.clone()).or_default();
        if !told.is_empty() {
            told.push(' ');
        }
        told.push_str(&message);
        self.all.push(Placed {
            label: label(&field),
            field,
            message,
        });
    }

    /// What is to be said at this field.
    pub(super) fn at(&self, field: &str) -> Option<&str> {
        self.by_field.get(field).map(String::as_str)
    }
}

/// The field that holds what has this path.
fn field_of(path: &str, sheet: &Sheet) -> Option<String> {
    let mut path = path.to_owned();
    // Behaviours are told under three keys, and typed into one field.
    for key in ["word", "point", "item"] {
        path = path.replace(&format!(".{key}"), ".atom");
    }
    loop {
        if sheet.has(&path) || is_list(&path) {
            return Some(path);
        }
        if let Some((list, _)) = row_named(&path) {
            return Some(format!("{path}.{}", first_key(list)));
        }
        let known = match path.as_str() {
            "world.upload" => Some("world.recordings"),
            "prior" => Some("prior.holds"),
            "class" => Some("class.kind"),
            "world" => Some("world.kind"),
            "practice" => Some("practice.kind"),
            "costs" => Some("costs.membership"),
            "colours" => Some("symbols"),
            _ => None,
        };
        if let Some(known) = known {
            return Some(known.to_owned());
        }
        let end = path.rfind(['.', '['])?;
        path.truncate(end);
    }
}

/// A field's name for people: `Symbols, 2: name`.
fn label(field: &str) -> String {
    let spaced = |text: &str| {
        let text = text.replace(['.', '_'], " ");
        let mut chars = text.chars();
        let first = chars.next().map(|c| c.to_uppercase().to_string());
        first.unwrap_or_default() + chars.as_str()
    };
    let row = field.rsplit_once('.').and_then(|(row, key)| {
        let (list, place) = row_named(row)?;
        Some((list, place, key))
    });
    match row {
        Some((list, place, "atom" | "rule")) => format!("{}, {}", spaced(list), place + 1),
        Some((list, place, key)) => format!("{}, {}: {key}", spaced(list), place + 1),
        None if field.is_empty() => "The whole".to_owned(),
        None => spaced(field.strip_suffix(".kind").unwrap_or(field)),
    }
}
