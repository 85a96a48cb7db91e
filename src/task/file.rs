//! Task files: TOML, or the same in JSON; every fault with its line and column.

use std::fmt;
use std::path::{Path, PathBuf};

use automata::format::locate;

use super::places::{self, Place, Places};
use super::situation::Files;
use super::universe::{Concept, Universe};
use super::{Malformed, Task};

/// The largest task file, in bytes: as much as the studio takes. What is parsed takes
/// many times the memory of its text.
const LARGEST: usize = 4 << 20;

/// A task with what only a file has.
#[derive(Clone, Debug)]
pub struct TaskFile {
    /// The task.
    pub task: Task,
    /// The bound on states, where the file tells.
    pub max_states: Option<usize>,
    /// Its behaviours, and what can be learned of them.
    pub universe: Universe,
    /// What a scripted teacher has in mind: of automata the whole language, not the
    /// part that is learned.
    pub target: Option<Concept>,
}

/// One thing that is wrong with a task file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fault {
    /// The line, from 1, where it is known.
    pub line: Option<usize>,
    /// The column, in characters from 1.
    pub column: Option<usize>,
    /// A path such as `symbols[2].name`; empty for the whole.
    pub path: String,
    /// What is wrong, and what to do.
    pub message: String,
}

/// Why a file is no task: at least one fault, in their order in the file.
///
/// As text, a line a fault: `FILE:LINE:COLUMN: path: what is wrong: what to do`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Unusable {
    /// The file.
    pub file: PathBuf,
    /// What is wrong with it.
    pub faults: Vec<Fault>,
}

impl fmt::Display for Unusable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (place, fault) in self.faults.iter().enumerate() {
            if place > 0 {
                f.write_str("\n")?;
            }
            write!(f, "{}:", self.file.display())?;
            if let (Some(line), Some(column)) = (fault.line, fault.column) {
                write!(f, "{line}:{column}:")?;
            }
            if !fault.path.is_empty() {
                write!(f, " {}:", fault.path)?;
            }
            write!(f, " {}", fault.message)?;
        }
        Ok(())
    }
}

impl std::error::Error for Unusable {}

impl TaskFile {
    /// Reads a task file, JSON if it is called so and TOML otherwise. Files that it
    /// names lie relative to it.
    ///
    /// # Errors
    ///
    /// Names all that is wrong with it.
    pub fn open(path: &Path) -> Result<Self, Unusable> {
        let unusable = |faults| Unusable {
            file: path.to_owned(),
            faults,
        };
        let text = std::fs::read_to_string(path).map_err(|error| {
            unusable(vec![Fault {
                line: None,
                column: None,
                path: String::new(),
                message: format!("cannot read it as text: {error}"),
            }])
        })?;
        let folder = path.parent().unwrap_or(Path::new(""));
        let is_json = path
            .extension()
            .is_some_and(|extension| extension == "json");
        let read = if is_json { from_json } else { read_toml };
        read(&text, Files::In(folder)).map_err(unusable)
    }

    /// Reads a task as TOML; files that it names lie in this folder.
    ///
    /// # Errors
    ///
    /// Names all that is wrong with it.
    pub fn from_toml(text: &str, folder: &Path) -> Result<Self, Vec<Fault>> {
        from_toml(text, folder)
    }

    /// Reads the text of a task file that was sent, TOML or JSON. The files that it
    /// names are elsewhere: recordings may be, and are not looked at.
    ///
    /// # Errors
    ///
    /// Names all that is wrong with it.
    pub fn sent(text: &str) -> Result<Self, Vec<Fault>> {
        if text.trim_start().starts_with('{') {
            from_json(text, Files::Elsewhere)
        } else {
            read_toml(text, Files::Elsewhere)
        }
    }

    /// Reads the content of a task file, as [`Self::sent`] does.
    ///
    /// # Errors
    ///
    /// Names all that is wrong with it.
    pub fn of_content(content: &serde_json::Value) -> Result<Self, Vec<Malformed>> {
        read(content, Files::Elsewhere)
    }
}

/// What a TOML text says, as JSON.
pub(super) fn content(text: &str) -> Result<serde_json::Value, Fault> {
    parsed(text).map(|(value, _)| value)
}

/// Refuses a text that is too large to be read.
fn expect_small(text: &str) -> Result<(), Fault> {
    if text.len() <= LARGEST {
        return Ok(());
    }
    let message = format!(
        "this has {} bytes, and a task file at most {LARGEST}: keep recordings, tables and automata in files of their own",
        text.len()
    );
    Err(placed(
        Place { line: 1, column: 1 },
        Malformed::new("", message),
    ))
}

fn parsed(text: &str) -> Result<(serde_json::Value, Places), Fault> {
    expect_small(text)?;
    places::read(text).map_err(|(place, message)| {
        let place = place.unwrap_or(Place { line: 1, column: 1 });
        placed(place, Malformed::new("", message))
    })
}

fn from_toml(text: &str, folder: &Path) -> Result<TaskFile, Vec<Fault>> {
    read_toml(text, Files::In(folder))
}

fn read_toml(text: &str, files: Files<'_>) -> Result<TaskFile, Vec<Fault>> {
    let (value, places) = parsed(text).map_err(|fault| vec![fault])?;
    read(&value, files).map_err(|faults| in_order(faults, |path| places.find(path, text)))
}

fn from_json(text: &str, files: Files<'_>) -> Result<TaskFile, Vec<Fault>> {
    expect_small(text).map_err(|fault| vec![fault])?;
    let value = serde_json::from_str(text).map_err(|error| {
        // An empty text has neither.
        let place = Place {
            line: error.line().max(1),
            column: error.column().max(1),
        };
        let message = format!("this is not JSON: {error}");
        vec![placed(place, Malformed::new("", message))]
    })?;
    read(&value, files).map_err(|faults| {
        let place = |path: &str| Place::of(text, locate(text, path));
        in_order(faults, place)
    })
}

fn read(value: &serde_json::Value, files: Files<'_>) -> Result<TaskFile, Vec<Malformed>> {
    let read = super::read(value, files)?;
    Ok(TaskFile {
        task: read.task,
        max_states: read.max_states,
        universe: read.universe,
        target: read.target,
    })
}

fn placed(place: Place, Malformed { path, message }: Malformed) -> Fault {
    Fault {
        line: Some(place.line),
        column: Some(place.column),
        path,
        message,
    }
}

fn in_order(faults: Vec<Malformed>, place_of: impl Fn(&str) -> Place) -> Vec<Fault> {
    let place = |fault: Malformed| (place_of(&fault.path), fault);
    let mut faults: Vec<_> = faults.into_iter().map(place).collect();
    faults.sort_by_key(|(place, _)| *place);
    let placed = faults
        .into_iter()
        .map(|(place, fault)| placed(place, fault));
    placed.collect()
}
