//! The studio's form as it was filled in: plain fields, and rows of fields. Fields
//! are called by the path of what they hold in a task file.

use std::collections::BTreeMap;

/// Fields of which there is one.
const FIELDS: [&str; 27] = [
    "name",
    "title",
    "empty",
    "guidelines",
    "target",
    "strategy",
    "max_states",
    "costs.membership",
    "costs.comparison",
    "class.kind",
    "class.ticks",
    "class.picture",
    "class.table",
    "class.features",
    "class.finest",
    "world.kind",
    "world.longest",
    "world.map",
    "world.steps",
    "world.labelling",
    "world.recordings",
    "practice.kind",
    "practice.atom",
    "practice.first",
    "practice.second",
    "practice.answer",
    "practice.why",
];

/// Rows of fields, with the fields that each row has, the first one first.
const LISTS: [(&str, &[&str]); 6] = [
    ("symbols", &["name", "word", "letter", "colour"]),
    ("prior.holds", &["rule"]),
    ("prior.suffices", &["rule"]),
    ("class.axes", &["name", "unit", "best", "worst"]),
    ("class.behaviours", &["name", "features"]),
    ("examples", &["atom", "label"]),
];

/// The most rows that are shown: more than a task may have of anything.
const MOST_ROWS: usize = 2100;

/// The fields of a row.
pub(super) type Row = BTreeMap<&'static str, String>;

/// What stands in the form.
#[derive(Clone, Debug, Default)]
pub(super) struct Sheet {
    fields: BTreeMap<&'static str, String>,
    rows: BTreeMap<&'static str, Vec<Row>>,
}

impl Sheet {
    /// A task that nothing is said of yet.
    pub(super) fn blank() -> Self {
        let mut sheet = Self::default();
        sheet.set("world.kind", "words");
        sheet.set("world.recordings", "recordings.jsonl");
        for _ in 0..2 {
            sheet.add("symbols");
        }
        sheet
    }

    /// What was sent; the rows of a list are numbered anew.
    pub(super) fn sent(sent: &[(String, String)]) -> Self {
        let mut sheet = Self::default();
        let mut rows: BTreeMap<(&'static str, usize), Row> = BTreeMap::new();
        for (name, value) in sent {
            // Browsers send the ends of lines as Windows writes them.
            let value = value.replace("\r\n", "\n");
            if let Some(field) = FIELDS.iter().find(|field| *field == name) {
                sheet.fields.entry(field).or_insert(value);
            } else if let Some((list, place, key)) = placed(name) {
                rows.entry((list, place)).or_default().insert(key, value);
            }
        }
        for ((list, _), row) in rows {
            sheet.push(list, row);
        }
        sheet
    }

    /// What a field holds; nothing if it is not there.
    pub(super) fn at(&self, name: &str) -> &str {
        let value = match placed(name) {
            Some((list, place, key)) => (self.rows(list).get(place)).and_then(|row| row.get(key)),
            None => self.fields.get(name),
        };
        value.map_or("", String::as_str)
    }

    /// Whether there is such a field.
    pub(super) fn has(&self, name: &str) -> bool {
        match placed(name) {
            Some((list, place, _)) => place < self.rows(list).len(),
            None => FIELDS.contains(&name),
        }
    }

    /// Fills a plain field.
    pub(super) fn set(&mut self, name: &'static str, value: impl Into<String>) {
        self.fields.insert(name, value.into());
    }

    /// The rows of a list.
    pub(super) fn rows(&self, list: &str) -> &[Row] {
        self.rows.get(list).map_or(&[], Vec::as_slice)
    }

    /// One more row, as it is.
    pub(super) fn push(&mut self, list: &'static str, row: Row) {
        let rows = self.rows.entry(list).or_default();
        if rows.len() < MOST_ROWS {
            rows.push(row);
        }
    }

    /// One more row in which nothing stands; whether there is such a list.
    pub(super) fn add(&mut self, list: &str) -> bool {
        let known = LISTS.iter().find(|(name, _)| *name == list);
        if let Some((list, _)) = known {
            self.push(list, Row::new());
        }
        known.is_some()
    }

    /// One row less: `symbols[2]`.
    pub(super) fn remove(&mut self, named: &str) {
        let Some((list, place)) = row_named(named) else {
            return;
        };
        if let Some(rows) = self.rows.get_mut(list)
            && place < rows.len()
        {
            rows.remove(place);
        }
    }
}

/// The list and the place in `symbols[2]`.
pub(super) fn row_named(name: &str) -> Option<(&'static str, usize)> {
    let (list, place) = name.strip_suffix(']')?.rsplit_once('[')?;
    let (list, _) = LISTS.iter().find(|(known, _)| *known == list)?;
    Some((list, place.parse().ok()?))
}

/// The first field of each row of a list.
pub(super) fn first_key(list: &str) -> &'static str {
    let known = LISTS.iter().find(|(known, _)| *known == list);
    known
        .and_then(|(_, keys)| keys.first())
        .copied()
        .unwrap_or_default()
}

/// Whether there is a list of this name.
pub(super) fn is_list(name: &str) -> bool {
    LISTS.iter().any(|(known, _)| *known == name)
}

/// The list, the place and the key in `symbols[2].name`.
fn placed(name: &str) -> Option<(&'static str, usize, &'static str)> {
    let (row, key) = name.rsplit_once('.')?;
    let (list, place) = row_named(row)?;
    let (_, keys) = LISTS.iter().find(|(known, _)| *known == list)?;
    let key = keys.iter().find(|known| **known == key)?;
    Some((list, place, key))
}

/// A map of so many rows and columns, with what there is in its upper left corner.
pub(super) fn resized(map: &str, rows: usize, columns: usize) -> String {
    let old: Vec<Vec<char>> = map.lines().map(|line| line.chars().collect()).collect();
    let row = |place: usize| -> String {
        let old = old.get(place).map_or(&[][..], Vec::as_slice);
        let cell = |column: usize| old.get(column).copied().unwrap_or('.');
        (0..columns).map(cell).collect()
    };
    let rows: Vec<String> = (0..rows).map(row).collect();
    rows.join("\n")
}
