//! The studio's page: the form with what was typed, its faults, and the preview.

use std::fmt::Display;

use askama::Template;

use super::faults::SheetFaults;
use super::preview::Preview;
use super::sheet::Sheet;
use crate::server::forms::Faults;
use crate::server::views::Shell;

/// What a field looks like.
enum Kind {
    Line,
    /// A number, or what may stand in its place.
    Number,
    /// So many lines.
    Area(usize),
    /// One of these: what is sent, and what people read.
    Choice(Vec<(String, String)>),
}

/// A field with its label, its hint and its fault.
#[derive(Template)]
#[template(path = "studio_field.html")]
struct FieldView<'a> {
    id: String,
    name: &'a str,
    label: &'a str,
    hint: &'a str,
    value: &'a str,
    fault: Option<&'a str>,
    described: String,
    kind: Kind,
}

impl FieldView<'_> {
    fn is_chosen(&self, sent: &str) -> bool {
        self.value == sent
    }
}

/// What was made of the request, at the top of the page.
pub(super) enum Said {
    Nothing,
    /// The task can be taught.
    Fine,
    /// It was opened from a file.
    Opened(String),
    /// It has faults, and could be saved in spite of them.
    Unsaved,
    /// It has faults.
    Faulty,
}

/// The page.
#[derive(Template)]
#[template(path = "studio.html")]
pub(super) struct StudioPage {
    pub(super) shell: Shell,
    pub(super) sheet: Sheet,
    pub(super) faults: SheetFaults,
    pub(super) preview: Preview,
    pub(super) said: Said,
    /// Ready tasks, by name and title.
    pub(super) ready: Vec<(String, String)>,
}

/// The preview alone, for the page's script.
#[derive(Template)]
#[template(path = "studio_preview.html")]
pub(super) struct PreviewPart {
    pub(super) preview: Preview,
}

/// The last step of a task of recordings: the files.
#[derive(Template)]
#[template(path = "studio_recordings.html")]
pub(super) struct RecordingsPage {
    pub(super) shell: Shell,
    pub(super) faults: Faults,
    /// The task file's text.
    pub(super) text: String,
    /// Whether files came, which a page cannot keep.
    pub(super) sent: bool,
}

impl StudioPage {
    fn field(&self, name: &str, label: &str, hint: &str, kind: Kind) -> String {
        let id = self.id(name);
        let fault = self.faults.at(name);
        let mut described = Vec::new();
        if !hint.is_empty() {
            described.push(format!("{id}-hint"));
        }
        if fault.is_some() {
            described.push(format!("{id}-fault"));
        }
        let view = FieldView {
            name,
            label,
            hint,
            value: self.sheet.at(name),
            fault,
            described: described.join(" "),
            kind,
            id,
        };
        view.render().unwrap_or_default()
    }

    /// The identifier of a field on the page.
    #[expect(clippy::unused_self, reason = "templates call methods of their page")]
    fn id(&self, name: &str) -> String {
        if name.is_empty() {
            return "open-file".to_owned();
        }
        let id = name.replace(['.', '['], "-");
        id.replace(']', "")
    }

    fn line(&self, name: &str, label: &str, hint: &str) -> String {
        self.field(name, label, hint, Kind::Line)
    }

    fn number(&self, name: &str, label: &str, hint: &str) -> String {
        self.field(name, label, hint, Kind::Number)
    }

    fn area(&self, name: &str, label: &str, hint: &str, lines: usize) -> String {
        self.field(name, label, hint, Kind::Area(lines))
    }

    /// `options` are `sent=read` with bars between; what stands in the field is one
    /// of them in any case.
    fn choice(&self, name: &str, label: &str, hint: &str, options: &str) -> String {
        let pair = |option: &str| {
            let (sent, read) = option.split_once('=').unwrap_or((option, option));
            (sent.to_owned(), read.to_owned())
        };
        let mut options: Vec<(String, String)> = options.split('|').map(pair).collect();
        let value = self.sheet.at(name);
        if !options.iter().any(|(sent, _)| sent == value) {
            options.push((value.to_owned(), value.to_owned()));
        }
        self.field(name, label, hint, Kind::Choice(options))
    }

    /// The numbers of a list's rows.
    fn rows(&self, list: &str) -> Vec<String> {
        (0..self.sheet.rows(list).len())
            .map(|place| place.to_string())
            .collect()
    }

    fn cell(&self, list: &str, row: impl Display, key: &str, label: &str, hint: &str) -> String {
        self.line(&format!("{list}[{row}].{key}"), label, hint)
    }

    fn cell_choice(
        &self,
        list: &str,
        row: impl Display,
        key: &str,
        label: &str,
        options: &str,
    ) -> String {
        self.choice(&format!("{list}[{row}].{key}"), label, "", options)
    }

    /// A row's number for people; the page's script puts it where it adds a row.
    #[expect(clippy::unused_self, reason = "templates call methods of their page")]
    fn counted(&self, row: &str) -> String {
        match row.parse::<usize>() {
            Ok(row) => (row + 1).to_string(),
            Err(_) => row.to_owned(),
        }
    }

    /// Whether a part of the form belongs to what stands in a field: one of `values`,
    /// `none` for nothing.
    fn shows(&self, field: &str, values: &str) -> bool {
        let value = match self.sheet.at(field) {
            "" => "none",
            value => value,
        };
        values.split(' ').any(|known| known == value)
    }

    /// The size of the map, rows first.
    fn size(&self) -> (usize, usize) {
        let map = self.sheet.at("world.map");
        let columns = map.lines().map(|line| line.chars().count()).max();
        match (map.lines().count(), columns) {
            (rows @ 1.., Some(columns @ 1..)) => (rows, columns),
            _ => (6, 8),
        }
    }

    /// The names of the symbols so far.
    fn names(&self) -> Vec<&str> {
        let rows = self.sheet.rows("symbols").iter();
        let names = rows.filter_map(|row| row.get("name"));
        names
            .map(|name| name.trim())
            .filter(|n| !n.is_empty())
            .collect()
    }
}
