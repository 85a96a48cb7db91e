//! What a task looks like to whoever will answer its questions, as far as it is told.

use serde_json::{Value, json};

use crate::server::behaviour::{Chip, chips};
use crate::server::scene::Scene;
use crate::session::{Task, Universe};
use crate::task::{Malformed, TaskFile};
use crate::world::World;

/// So many of the behaviours that can be asked about are counted, and so many shown.
const COUNTED: usize = 200;
const SHOWN: usize = 4;

/// What there is to see.
#[derive(Default)]
pub(super) struct Preview {
    pub(super) title: String,
    pub(super) chips: Vec<Chip>,
    pub(super) scene: Option<Scene>,
    /// What can be asked about, in a sentence.
    pub(super) about: String,
    /// The simplest behaviours that can be.
    pub(super) simplest: Vec<String>,
    /// What is still wrong: none if it can be taught.
    pub(super) faults: usize,
}

/// A task read as far as it goes, and what is wrong with it.
pub(super) fn look(content: &Value) -> (Preview, Result<TaskFile, Vec<Malformed>>) {
    let read = TaskFile::of_content(content);
    let mut preview = match &read {
        Ok(file) => of(&file.task, &file.universe, true),
        Err(_) => partly(content),
    };
    preview.faults = read.as_ref().err().map_or(0, Vec::len);
    (preview, read)
}

/// What can be shown of a task with faults: its symbols, and its world if that is
/// right.
fn partly(content: &Value) -> Preview {
    let title = content["title"].as_str().unwrap_or_default().to_owned();
    let symbols = json!({"symbols": content["symbols"]});
    let mut with_world = symbols.clone();
    with_world["world"] = content["world"].clone();
    for part in [with_world, symbols] {
        if let Ok(file) = TaskFile::of_content(&part) {
            return Preview {
                title,
                ..of(&file.task, &file.universe, false)
            };
        }
    }
    Preview {
        title,
        ..Preview::default()
    }
}

fn of(task: &Task, universe: &Universe, whole: bool) -> Preview {
    let symbols = chips(task);
    let mut preview = Preview {
        title: task.title.clone(),
        ..Preview::default()
    };
    let counted = |number: usize, what: &str| {
        let plural = if number == 1 { "" } else { "s" };
        format!("{number} {what}{plural}")
    };
    match universe {
        Universe::Words { situation, .. } => {
            let world = situation.as_ref().map(|situation| &*situation.world);
            if let Some(World::Grid(grid)) = world
                && let Some(from) = grid.starts().next()
            {
                let looks: Vec<_> = symbols.iter().map(Chip::look).collect();
                preview.scene = Some(Scene::of(grid, from, &[], &looks));
            }
            preview.about = match situation {
                Some(situation) if whole => {
                    let listing = situation.world.list(situation.prior.open(), COUNTED);
                    preview.simplest = (listing.words.iter().take(SHOWN))
                        .map(|word| {
                            let texts: Vec<&str> = word.iter().map(|s| task.text(s)).collect();
                            if texts.is_empty() {
                                format!("({})", task.empty)
                            } else {
                                texts.join(" · ")
                            }
                        })
                        .collect();
                    let number = counted(listing.words.len(), "behaviour");
                    if listing.complete {
                        format!("{number} can be asked about. The simplest:")
                    } else {
                        format!("More than {number} can be asked about. The simplest:")
                    }
                }
                None if whole && task.world.is_some() => {
                    "What was recorded can be asked about.".to_owned()
                }
                None if whole => "Everything that can happen can be asked about.".to_owned(),
                _ => String::new(),
            };
        }
        Universe::Monotone(axes) => {
            preview.about = String::from("Limits are learned on what is measured.");
            preview.simplest = (axes.axes().iter())
                .map(|axis| {
                    let (best, worst) = (axis.spell(axis.best), axis.spell(axis.worst));
                    format!("{}: {best} is best, {worst} worst", axis.name)
                })
                .collect();
        }
        Universe::Finite(_) | Universe::Linear(_) => {
            let items = universe.items();
            preview.about = format!(
                "{} can be asked about, such as:",
                counted(items.len(), "behaviour")
            );
            preview.simplest = (items.iter().take(SHOWN))
                .map(|item| (*item).to_owned())
                .collect();
        }
    }
    preview.chips = symbols;
    preview
}
