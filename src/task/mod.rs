//! What is taught: symbols as people see them, a world, and what is known before
//! the first question; read from task files and requests alike.
//!
//! A [`Task`] is what a session needs. A [`TaskFile`] has more: a target for
//! scripted teachers, and the names of other files. It must not know who answers,
//! or how questions are chosen beyond the strategy's name.

mod automaton;
mod class;
mod costs;
mod examples;
mod file;
mod places;
mod prior;
mod reader;
mod situation;
mod subject;
mod symbols;
mod target;
mod universe;
mod write;

use std::sync::Arc;

use automata::{Alphabet, Dfa, Symbol};
use serde::{Deserialize, Serialize};
use serde_json::Value;

pub use automaton::{Automaton, Unreadable};
pub use class::ClassText;
pub use costs::{Costs, read_cost, read_strategy};
pub use examples::{Example, Practice, Practised, read_word};
pub use file::{Fault, TaskFile, Unusable};
#[cfg(feature = "server")]
pub(crate) use places::Place;
pub use prior::{PriorText, Rule};
pub(crate) use reader::is_disruptive;
pub use reader::{Fields, Malformed};
pub(crate) use situation::{LONGEST, STEPS};
pub use situation::{Situation, Source, WorldText};
pub use symbols::{Colour, SymbolText};
pub(crate) use universe::Bare;
pub use universe::{
    Atom, AtomText, Axes, Axis, BehaviourText, Concept, ConceptText, OffGrid, Picture, Rewards,
    Saved, Universe,
};
pub use write::toml_text;

use self::reader::Faults;
use self::situation::Files;
use self::subject::Subject;
use crate::concept::Prior;
use crate::evidence::Fact;
use crate::learner::Strategy;
use crate::world::World;

/// The largest number of symbols a taught alphabet may have: more cannot be
/// offered as buttons.
pub const MAX_SYMBOLS: usize = 64;
/// The largest number of symbols in a word that a person or a script gives.
pub const MAX_WORD: usize = 1000;
/// The largest number of examples known at the start.
pub const MAX_EXAMPLES: usize = 2000;
/// The largest bound on states that can be asked for.
pub const MAX_STATES: usize = 100;
/// The bound on states where a task names none.
pub const DEFAULT_STATES: usize = 24;

/// A commented task file to begin with; it is valid.
pub const TEMPLATE: &str = include_str!("template.toml");

/// What a session teaches. Always valid: names are unique, examples use them and
/// can happen in the world, and there is something to learn.
///
/// It says nothing about the target: that is in the teacher's head.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Value")]
pub struct Task {
    /// The ready task's name, `own` for one that was written by hand.
    pub name: String,
    /// One line for people.
    pub title: String,
    /// The alphabet, in order; empty where the behaviours are no words.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub symbols: Vec<SymbolText>,
    /// What is learned in place of an automaton.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub class: Option<ClassText>,
    /// What is known at the start; no word stands twice.
    pub examples: Vec<Example>,
    /// The largest number of states considered, until it is raised.
    pub max_states: usize,
    /// What the teacher should keep in mind; may be empty.
    pub guidelines: String,
    /// What the empty word is called, without brackets.
    pub empty: String,
    /// Where behaviours come from; all words where there is none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub world: Option<WorldText>,
    /// What is known beforehand, and never asked.
    #[serde(skip_serializing_if = "PriorText::is_empty")]
    pub prior: PriorText,
    /// What questions cost, where the task tells.
    #[serde(skip_serializing_if = "Costs::are_untold")]
    pub costs: Costs,
    /// How questions are chosen, where the task tells.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub strategy: Option<Strategy>,
    /// A question to practise with.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub practice: Option<Practice>,
}

const KEYS: &[&str] = &[
    "name",
    "title",
    "class",
    "symbols",
    "colours",
    "world",
    "prior",
    "examples",
    "costs",
    "strategy",
    "guidelines",
    "empty",
    "max_states",
    "practice",
];

/// All that was read, with what is made of it.
struct Read {
    task: Task,
    /// The bound on states, where it is told.
    max_states: Option<usize>,
    universe: Universe,
    target: Option<Concept>,
}

impl Task {
    /// Reads a task file's content. It may name no files, and no target.
    ///
    /// # Errors
    ///
    /// Names the JSON path of the first thing that is wrong, and what to do.
    pub fn from_json(value: &Value) -> Result<Self, Malformed> {
        taken(read(value, Files::None))
    }

    /// The content of a task file, TOML, as [`Self::from_json`] reads it.
    ///
    /// # Errors
    ///
    /// Says where it ceases to be TOML.
    pub fn toml_content(text: &str) -> Result<Value, Fault> {
        file::content(text)
    }

    /// The alphabet of the symbols' names; none where the behaviours are no words.
    pub fn alphabet(&self) -> Option<Alphabet> {
        symbols::alphabet(&self.symbols).ok()
    }

    /// What is known at the start, as facts about the atoms of one class.
    ///
    /// Examples of another class, which only a task that was put together by hand
    /// has, are left out.
    pub fn known<A: TryFrom<Atom>>(&self, universe: &Universe) -> Vec<Fact<A>> {
        let facts = self.examples.iter().filter_map(|example| {
            let atom = universe.parse(&example.atom).ok()?;
            Some(Fact::Label {
                atom: A::try_from(atom).ok()?,
                accepted: example.label,
            })
        });
        facts.collect()
    }

    /// Its behaviours, and what can be learned of them.
    ///
    /// # Errors
    ///
    /// As for [`Task::situation`].
    pub fn universe(&self) -> Result<Universe, Malformed> {
        self.universe_in(None)
    }

    /// The same in this world, where the task's is an [upload](Self::upload).
    ///
    /// # Errors
    ///
    /// As for [`Task::situation_in`].
    pub fn universe_in(&self, world: Option<Arc<World>>) -> Result<Universe, Malformed> {
        if let Some(class) = &self.class {
            return class.universe();
        }
        Ok(Universe::Words {
            alphabet: symbols::alphabet(&self.symbols)?,
            situation: self.situation_in(world)?,
        })
    }

    /// Its world and what is known beforehand; none where all words are asked about
    /// and nothing is known.
    ///
    /// # Errors
    ///
    /// If the task was put together by hand, its recordings are not what they
    /// were when it was read, or they are an upload: [`Self::situation_in`].
    pub fn situation(&self) -> Result<Option<Situation>, Malformed> {
        self.situation_in(None)
    }

    /// The same with this world, in place of the one that the task tells.
    ///
    /// # Errors
    ///
    /// As [`Self::situation`], or if nothing is left to learn in the world.
    pub fn situation_in(&self, world: Option<Arc<World>>) -> Result<Option<Situation>, Malformed> {
        if world.is_none() && self.world.is_none() && self.prior.is_empty() {
            return Ok(None);
        }
        let alphabet = symbols::alphabet(&self.symbols)?;
        let world = match world {
            Some(world) => world,
            None => Arc::new(situation::build_world(
                self.world.as_ref(),
                &self.symbols,
                &alphabet,
            )?),
        };
        let rules = |rules: &[Rule]| -> Result<Vec<Dfa>, Malformed> {
            rules.iter().map(|rule| rule.dfa(&alphabet)).collect()
        };
        let (holds, suffices) = (rules(&self.prior.holds)?, rules(&self.prior.suffices)?);
        let prior = Prior::new(&alphabet, holds, suffices)
            .map_err(|error| Malformed::new("prior", error.to_string()))?;
        situation::build(world, prior, "prior").map(Some)
    }

    /// Checks what could not be when the task was read, because its world is an
    /// upload: that its examples and its practice question are recorded, and that
    /// what is known beforehand leaves something to learn.
    ///
    /// # Errors
    ///
    /// Names the first that is not.
    pub fn check_in(&self, world: Arc<World>) -> Result<(), Malformed> {
        let universe = self.universe_in(Some(world))?;
        examples::check_all(&self.examples, self.practice.as_ref(), &universe)
    }

    /// The name of the upload that the task's world is, if it is one.
    pub fn upload(&self) -> Option<&str> {
        match &self.world {
            Some(WorldText::Pool {
                source: Source::Upload(upload),
            }) => Some(upload),
            _ => None,
        }
    }

    /// What stands for each symbol in the map of a grid.
    pub fn marks(&self) -> impl Iterator<Item = (char, Symbol)> {
        symbols::marks(&self.symbols)
    }

    /// What people read for a symbol.
    pub fn text(&self, symbol: Symbol) -> &str {
        self.symbols[symbol.index()].text()
    }
}

impl TryFrom<Value> for Task {
    type Error = Malformed;

    fn try_from(value: Value) -> Result<Self, Malformed> {
        taken(read(&value, Files::Logged))
    }
}

/// The task, or the first fault.
fn taken(read: Result<Read, Vec<Malformed>>) -> Result<Task, Malformed> {
    match read {
        Ok(read) => Ok(read.task),
        Err(faults) => Err(faults.into_iter().next().unwrap_or_else(|| {
            Malformed::new("", "this is no task, look at `memrep task new` for one")
        })),
    }
}

/// Reads a task file's content.
///
/// # Errors
///
/// All faults that are worth telling at once.
fn read(value: &Value, files: Files<'_>) -> Result<Read, Vec<Malformed>> {
    let fields = Fields::of(value, "").map_err(|fault| vec![fault])?;
    let mut faults = Faults::default();
    let is_file = !matches!(files, Files::None | Files::Logged);
    if fields.get("target").is_some() && !is_file {
        faults.0.push(Malformed::new(
            "target",
            "a session is taught by whoever answers it: leave `target` out, and keep it for `memrep learn`",
        ));
    }
    let unknown = fields.unknown(KEYS);
    faults
        .0
        .extend(unknown.filter(|fault| fault.path != "target"));
    let name = faults.keep(fields.text("name", 60)).flatten();
    let title = faults.keep(fields.text("title", 120)).flatten();
    let guidelines = faults.keep(fields.long_text("guidelines", 4000)).flatten();
    let empty = faults.keep(fields.text("empty", 60)).flatten();
    let max_states = faults
        .keep(fields.whole("max_states", 1, MAX_STATES))
        .flatten();
    let costs = faults.keep(Costs::read(&fields));
    let strategy = faults.keep(read_strategy(&fields)).flatten();
    // Without its symbols or its class nothing else of a task can be read.
    let Some(subject) = Subject::read(&fields, files, &mut faults) else {
        return Err(faults.0);
    };
    let universe = &subject.universe;
    let examples = examples::read(&fields, universe, &mut faults);
    let practice = faults.keep(examples::read_practice(&fields, universe));
    let target =
        match fields.get("target") {
            Some(value) if is_file => {
                let target = target::read(value, universe, files);
                faults.keep(target.and_then(|target| {
                    target::suits(&target, &examples, universe).map(|()| target)
                }))
            }
            _ => None,
        };
    if let (Some(Some(practice)), false) = (&practice, matches!(files, Files::Logged)) {
        let target = target.as_ref();
        faults.keep(examples::check_answer(
            practice, &examples, target, universe,
        ));
    }
    if !faults.0.is_empty() {
        return Err(faults.0);
    }
    let task = Task {
        name: name.unwrap_or_else(|| "own".to_owned()),
        title: title.unwrap_or_else(|| "My own rule".to_owned()),
        symbols: subject.symbols,
        class: subject.class,
        examples,
        max_states: max_states.unwrap_or(DEFAULT_STATES),
        guidelines: guidelines.unwrap_or_default(),
        empty: empty.unwrap_or_else(|| "nothing happens".to_owned()),
        world: subject.world,
        prior: subject.prior,
        costs: costs.unwrap_or_default(),
        strategy,
        practice: practice.flatten(),
    };
    Ok(Read {
        task,
        max_states,
        universe: subject.universe,
        target,
    })
}

#[cfg(test)]
mod tests;
