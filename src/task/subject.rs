//! What a task is about, as it is read: words of symbols in a world, or another
//! class.

use std::sync::Arc;

use super::class::{self, ClassText};
use super::prior::{self, PriorText};
use super::reader::{Faults, Fields, Malformed};
use super::situation::{self, Files, WorldText};
use super::symbols::{self, SymbolText};
use super::universe::Universe;

/// What is about words, and nothing else. The bound on states and the name of the empty
/// word are too, but every log has them.
const OF_WORDS: [&str; 4] = ["symbols", "colours", "world", "prior"];

/// The parts of a task that say what it is about, and what is made of them.
pub(super) struct Subject {
    pub(super) symbols: Vec<SymbolText>,
    pub(super) class: Option<ClassText>,
    pub(super) world: Option<WorldText>,
    pub(super) prior: PriorText,
    pub(super) universe: Universe,
}

impl Subject {
    /// None, and at least one fault is kept, if nothing else can be read without it.
    pub(super) fn read(fields: &Fields<'_>, files: Files<'_>, faults: &mut Faults) -> Option<Self> {
        let Some(value) = fields.get("class") else {
            return Self::of_words(fields, files, faults);
        };
        for key in OF_WORDS.into_iter().filter(|key| fields.get(key).is_some()) {
            faults.0.push(Malformed::new(
                key,
                format!("`{key}` is about words, and a task with a `class` has none: leave one of the two out"),
            ));
        }
        let (class, universe) = class::read(value, files, faults)?;
        Some(Self {
            symbols: Vec::new(),
            class: Some(class),
            world: None,
            prior: PriorText::default(),
            universe,
        })
    }

    fn of_words(fields: &Fields<'_>, files: Files<'_>, faults: &mut Faults) -> Option<Self> {
        let (symbols, alphabet) = symbols::read(fields, faults)?;
        let told = fields.get("world");
        let world = told.and_then(|value| situation::read_world(value, files, faults));
        let prior = prior::read(fields, &alphabet, files, faults);
        let mut built = None;
        // Without its letters a map would be called wrong for no fault of its own.
        let lettered = !faults.0.iter().any(|fault| fault.path.ends_with(".letter"));
        if let Some((text, prior)) = &prior
            && lettered
            && world.is_some() == told.is_some()
            && (world.is_some() || !text.is_empty())
            // Its recordings come later.
            && !situation::comes_later(world.as_ref(), files)
        {
            let path = if text.is_empty() { "world" } else { "prior" };
            let world = situation::build_world(world.as_ref(), &symbols, &alphabet);
            let whole =
                world.and_then(|world| situation::build(Arc::new(world), prior.clone(), path));
            built = faults.keep(whole);
        }
        Some(Self {
            symbols,
            class: None,
            world,
            prior: prior.map(|(text, _)| text).unwrap_or_default(),
            universe: Universe::Words {
                alphabet,
                situation: built,
            },
        })
    }
}
