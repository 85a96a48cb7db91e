//! Where the behaviours of a task come from: read, and put together with what is known
//! beforehand.

use std::fs::File;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use automata::{Alphabet, Word};
use serde::Serialize;
use serde_json::Value;

use super::reader::{Faults, Fields, Malformed};
use super::symbols::{SymbolText, marks};
use crate::concept::{Prior, PriorError, Situated};
use crate::identify::Settings;
use crate::world::grid::{Grid, GridError, GridMap, Labelling, MOST_STEPS};
use crate::world::pool::PoolReader;
use crate::world::{Words, World};

/// Where no world is named, all words up to this length can be shown.
pub(crate) const LONGEST: usize = 1000;
/// The steps of a walk through a grid where a task does not tell.
pub(crate) const STEPS: usize = 40;

/// The world of a task, as it is written.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
#[serde(tag = "kind", rename_all = "lowercase")]
pub enum WorldText {
    /// All words up to a length.
    Words {
        /// The most symbols.
        longest: usize,
    },
    /// A grid.
    Grid {
        /// Its rows.
        map: Vec<String>,
        /// The most steps of a walk.
        steps: usize,
        /// When a tile gives its symbol.
        labelling: Labelling,
    },
    /// Recordings, as JSON lines.
    Pool {
        /// Where they are.
        #[serde(flatten)]
        source: Source,
    },
}

/// Where recordings are.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Source {
    /// In this file.
    #[serde(rename = "recordings")]
    File(PathBuf),
    /// In an upload of this name, which whoever keeps uploads hands in.
    Upload(String),
}

/// Where behaviours come from, and what is known beforehand.
#[derive(Clone, Debug)]
pub struct Situation {
    /// What can be shown.
    pub world: Arc<World>,
    /// What is never asked.
    pub prior: Prior,
}

impl Situation {
    /// The class of what can be learned in it.
    ///
    /// # Errors
    ///
    /// As [`Situated::new`].
    pub fn class(&self, settings: Settings) -> Result<Situated, PriorError> {
        Situated::new(Arc::clone(&self.world), self.prior.clone(), settings)
    }

    /// Checks that the word can be shown, and that a label does not contradict what
    /// is known beforehand.
    pub(super) fn check(
        &self,
        word: &Word,
        label: Option<bool>,
        path: &str,
    ) -> Result<(), Malformed> {
        if !self.world.is_feasible(word) {
            let message = if matches!(*self.world, World::Pool(_)) {
                "no recording shows this: leave it out, or add a recording of it"
            } else {
                "this cannot happen in the world of the task: leave it out, or change the world"
            };
            return Err(Malformed::new(path, message));
        }
        match (self.prior.settled(word), label) {
            (Some(settled), Some(label)) if settled != label => Err(Malformed::new(
                path,
                format!(
                    "this is {} and what is known beforehand (`prior`) says the opposite: correct one of them",
                    if label {
                        "acceptable"
                    } else {
                        "not acceptable"
                    }
                ),
            )),
            _ => Ok(()),
        }
    }
}

/// Which files a task may name.
#[derive(Clone, Copy, Debug)]
pub(super) enum Files<'a> {
    /// None: the task came over the network.
    None,
    /// None: the task was read before, and this is from a log. What is refused today
    /// may have been taken then.
    Logged,
    /// Those by a path that is relative to this folder.
    In(&'a Path),
    /// Any, but none is here to be looked at.
    Elsewhere,
}

impl Files<'_> {
    /// The path of a file that is named at `path` in the task.
    pub(super) fn find(self, named: &str, path: &str) -> Result<PathBuf, Malformed> {
        match self {
            Files::In(folder) => Ok(folder.join(named)),
            Files::None | Files::Logged => Err(Malformed::new(
                path,
                format!("`{named}`: a session reads no files, give the content itself"),
            )),
            Files::Elsewhere => Err(Malformed::new(
                path,
                format!("`{named}`: this file is not here, give its content itself"),
            )),
        }
    }
}

/// What stands under `world`; none, and a fault is kept, if it is no world.
pub(super) fn read_world(
    value: &Value,
    files: Files<'_>,
    faults: &mut Faults,
) -> Option<WorldText> {
    let fields = faults.keep(Fields::of(value, "world"))?;
    let kind = faults.keep(fields.text("kind", 60))?.unwrap_or_default();
    let world = match kind.as_str() {
        "words" => {
            faults.0.extend(fields.unknown(&["kind", "longest"]));
            let longest = faults.keep(fields.whole("longest", 1, LONGEST))?;
            WorldText::Words {
                longest: longest.unwrap_or(LONGEST),
            }
        }
        "grid" => {
            let keys = ["kind", "map", "steps", "labelling"];
            faults.0.extend(fields.unknown(&keys));
            let steps = faults.keep(fields.whole("steps", 1, MOST_STEPS));
            let labelling = faults.keep(read_labelling(&fields));
            WorldText::Grid {
                map: faults.keep(read_map(&fields))?,
                steps: steps?.unwrap_or(STEPS),
                labelling: labelling?,
            }
        }
        "pool" => {
            let keys = ["kind", "recordings", "upload"];
            faults.0.extend(fields.unknown(&keys));
            WorldText::Pool {
                source: faults.keep(read_source(&fields, files))?,
            }
        }
        _ => {
            faults.0.push(Malformed::new(
                fields.path_of("kind"),
                format!("`{kind}` is no kind of world: give `words`, `grid` or `pool`"),
            ));
            return None;
        }
    };
    Some(world)
}

fn read_map(fields: &Fields<'_>) -> Result<Vec<String>, Malformed> {
    let fault = |path| {
        Malformed::new(
            path,
            "draw the grid as text, one line a row: `S` a start, `#` a wall, `.` an empty cell, and the letters of symbols",
        )
    };
    let path = fields.path_of("map");
    match fields.get("map") {
        Some(Value::String(text)) => Ok(text.lines().map(str::to_owned).collect()),
        Some(Value::Array(rows)) => {
            let row = |(i, row): (usize, &Value)| match row.as_str() {
                Some(row) => Ok(row.to_owned()),
                None => Err(fault(format!("{path}[{i}]"))),
            };
            rows.iter().enumerate().map(row).collect()
        }
        _ => Err(fault(path)),
    }
}

fn read_labelling(fields: &Fields<'_>) -> Result<Labelling, Malformed> {
    match fields.text("labelling", 60)?.as_deref() {
        None | Some("entry") => Ok(Labelling::Entry),
        Some("every-step") => Ok(Labelling::EveryStep),
        Some(other) => Err(Malformed::new(
            fields.path_of("labelling"),
            format!("`{other}` is no labelling: give `entry` or `every-step`"),
        )),
    }
}

fn read_source(fields: &Fields<'_>, files: Files<'_>) -> Result<Source, Malformed> {
    let path = fields.path_of("recordings");
    let named = fields.text("recordings", 4000)?;
    let upload = fields.text("upload", 60)?;
    match (files, named, upload) {
        (Files::In(_), Some(named), None) => files.find(&named, &path).map(Source::File),
        (Files::Elsewhere, Some(named), None) => Ok(Source::File(named.into())),
        (Files::In(_) | Files::Elsewhere, _, Some(_)) => Err(Malformed::new(
            fields.path_of("upload"),
            "an upload is known to its server alone: name a file of recordings as `recordings`",
        )),
        (Files::In(_) | Files::Elsewhere, None, None) => Err(Malformed::new(
            path,
            "name the file of the recordings, one JSON object a line",
        )),
        (Files::None | Files::Logged, None, Some(upload)) => Ok(Source::Upload(upload)),
        (Files::None | Files::Logged, named, _) => {
            let file = named.map_or_else(String::new, |file| format!("`{file}`: "));
            Err(Malformed::new(
                path,
                format!(
                    "{file}a session reads no files: send the recordings with the task as `multipart/form-data`, or name what was sent before as `upload`"
                ),
            ))
        }
    }
}

/// Whether the world is built later, of recordings that are not here yet.
pub(super) fn comes_later(text: Option<&WorldText>, files: Files<'_>) -> bool {
    match text {
        Some(WorldText::Pool { source }) => {
            matches!(source, Source::Upload(_)) || matches!(files, Files::Elsewhere)
        }
        _ => false,
    }
}

/// The world that is written; without one, all words.
pub(super) fn build_world(
    text: Option<&WorldText>,
    symbols: &[SymbolText],
    alphabet: &Alphabet,
) -> Result<World, Malformed> {
    let alphabet = alphabet.clone();
    Ok(match text {
        None => World::Words(Words::new(alphabet, LONGEST)),
        Some(WorldText::Words { longest }) => World::Words(Words::new(alphabet, *longest)),
        Some(WorldText::Grid {
            map,
            steps,
            labelling,
        }) => World::Grid(build_grid(map, symbols, alphabet, *labelling, *steps)?),
        Some(WorldText::Pool {
            source: Source::Upload(upload),
        }) => {
            return Err(Malformed::new(
                "world.upload",
                format!(
                    "the recordings of the upload `{upload}` are not here: ask the server that has them"
                ),
            ));
        }
        Some(WorldText::Pool {
            source: Source::File(recordings),
        }) => {
            let fault = |error: &dyn std::fmt::Display| {
                let message = format!("{}: {error}", recordings.display());
                Malformed::new("world.recordings", message)
            };
            let file = File::open(recordings).map_err(|error| fault(&error))?;
            let pool = PoolReader::read(alphabet, file).map_err(|error| fault(&error))?;
            World::Pool(pool)
        }
    })
}

fn build_grid(
    map: &[String],
    symbols: &[SymbolText],
    alphabet: Alphabet,
    labelling: Labelling,
    steps: usize,
) -> Result<Grid, Malformed> {
    let map = GridMap {
        rows: map.iter().map(String::as_str).collect(),
        marks: marks(symbols).collect(),
    };
    map.grid(alphabet, labelling, steps).map_err(|error| {
        let path = match &error {
            GridError::NoSymbol { at, .. }
            | GridError::Unreachable { at, .. }
            | GridError::Foreign { at, .. }
            | GridError::BadStart(at) => format!("world.map[{}][{}]", at.row, at.column),
            GridError::Ragged { row, .. } => format!("world.map[{}]", row - 1),
            GridError::Steps(_) => "world.steps".to_owned(),
            GridError::Mark(mark) => {
                let bearer = symbols.iter().rposition(|s| s.mark() == Some(*mark));
                bearer.map_or_else(|| "symbols".to_owned(), |i| format!("symbols[{i}]"))
            }
            GridError::Empty | GridError::TooLarge { .. } | GridError::NoStart => {
                "world.map".to_owned()
            }
        };
        let hint = match &error {
            GridError::NoStart => " with `S`",
            GridError::Mark(_) => " by `letter`; `#`, `.` and `S` are taken",
            _ => "",
        };
        Malformed::new(path, format!("{error}{hint}"))
    })
}

/// Both together.
pub(super) fn build(world: Arc<World>, prior: Prior, path: &str) -> Result<Situation, Malformed> {
    if !world.has_word(prior.open()) {
        return Err(Malformed::new(
            path,
            PriorError::NothingOpenHere.to_string(),
        ));
    }
    Ok(Situation { world, prior })
}
