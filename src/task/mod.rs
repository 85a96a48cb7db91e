//! What is taught: symbols as people see them, a world, and what is known before
//! the first question; read from task files and requests alike.
//!
//! A [`Task`] is what a session needs. A [`TaskFile`] has more: a target for
//! scripted teachers, and the names of other files. It must not know who answers,
//! or how questions are chosen beyond the strategy's name.

mod automaton;
mod costs;
mod examples;
mod file;
mod places;
mod reader;
mod situation;
mod symbols;

use std::sync::Arc;

use automata::{Alphabet, Dfa, Symbol, Word};
use serde::{Deserialize, Serialize};
use serde_json::Value;

pub use automaton::{Automaton, Unreadable};
pub use costs::{Costs, read_cost, read_strategy};
pub use examples::{Example, Practice, Practised, read_word};
pub use file::{Fault, TaskFile, Unusable};
pub use reader::{Fields, Malformed};
pub(crate) use situation::{LONGEST, STEPS};
pub use situation::{PriorText, Rule, Situation, Source, WorldText};
pub use symbols::{Colour, SymbolText};

use self::reader::Faults;
use self::situation::Files;
use crate::concept::Prior;
use crate::evidence::Fact;
use crate::learner::Strategy;
use crate::oracle::Target;
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
    /// The alphabet, in order.
    pub symbols: Vec<SymbolText>,
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
    situation: Option<Situation>,
    target: Option<Dfa>,
}

impl Task {
    /// Reads a task file's content. It may name no files, and no target.
    ///
    /// # Errors
    ///
    /// Names the JSON path of the first thing that is wrong, and what to do.
    pub fn from_json(value: &Value) -> Result<Self, Malformed> {
        match read(value, Files::None) {
            Ok(read) => Ok(read.task),
            Err(first) => Err(first.into_iter().next().unwrap_or_else(|| {
                Malformed::new("", "this is no task, look at `memrep task new` for one")
            })),
        }
    }

    /// The content of a task file, TOML, as [`Self::from_json`] reads it.
    ///
    /// # Errors
    ///
    /// Says where it ceases to be TOML.
    pub fn toml_content(text: &str) -> Result<Value, Fault> {
        file::content(text)
    }

    /// The alphabet of the symbols' names.
    ///
    /// # Panics
    ///
    /// If the task was put together by hand, and its names make no alphabet.
    pub fn alphabet(&self) -> Alphabet {
        Alphabet::new(self.symbols.iter().map(|symbol| symbol.name.as_str()))
            .expect("a task's symbols were checked when it was read")
    }

    /// What is known at the start, as facts over [`Task::alphabet`].
    ///
    /// # Panics
    ///
    /// If the task was put together by hand, and an example uses other names.
    pub fn known(&self, alphabet: &Alphabet) -> Vec<Fact<Word>> {
        self.examples
            .iter()
            .map(|example| Fact::Label {
                atom: alphabet
                    .word(&example.word)
                    .expect("a task's examples were checked when it was read"),
                accepted: example.label,
            })
            .collect()
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
        let alphabet = self.alphabet();
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
        let Some(situation) = self.situation_in(Some(world))? else {
            return Ok(());
        };
        examples::check(
            &self.examples,
            self.practice.as_ref(),
            &self.alphabet(),
            &situation,
        )
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

    /// What people read for a symbol of [`Task::alphabet`].
    pub fn text(&self, symbol: Symbol) -> &str {
        self.symbols[symbol.index()].text()
    }
}

impl TryFrom<Value> for Task {
    type Error = Malformed;

    fn try_from(value: Value) -> Result<Self, Malformed> {
        Self::from_json(&value)
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
    let is_file = matches!(files, Files::In(_));
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
    // Without symbols nothing else can be read.
    let Some((symbols, alphabet)) = symbols::read(&fields, &mut faults) else {
        return Err(faults.0);
    };
    let told = fields.get("world");
    let world = told.and_then(|value| situation::read_world(value, files, &mut faults));
    let prior = situation::read_prior(&fields, &alphabet, files, &mut faults);
    let mut built = None;
    // Without its letters a map would be called wrong for no fault of its own.
    let lettered = !faults.0.iter().any(|fault| fault.path.ends_with(".letter"));
    if let Some((text, prior)) = &prior
        && lettered
        && world.is_some() == told.is_some()
        && (world.is_some() || !text.is_empty())
        && !situation::is_uploaded(world.as_ref())
    {
        let path = if text.is_empty() { "world" } else { "prior" };
        let world = situation::build_world(world.as_ref(), &symbols, &alphabet);
        let whole = world.and_then(|world| situation::build(Arc::new(world), prior.clone(), path));
        built = faults.keep(whole);
    }
    let situation = built.as_ref();
    let examples = examples::read(&fields, &alphabet, situation, &mut faults);
    let practice = faults.keep(examples::read_practice(&fields, &alphabet, situation));
    let target = match fields.get("target") {
        Some(value) if is_file => {
            let target = read_target(value, &alphabet, files);
            faults.keep(target.and_then(|target| {
                suits(&target, &examples, &alphabet, situation).map(|()| target)
            }))
        }
        _ => None,
    };
    if !faults.0.is_empty() {
        return Err(faults.0);
    }
    let task = Task {
        name: name.unwrap_or_else(|| "own".to_owned()),
        title: title.unwrap_or_else(|| "My own rule".to_owned()),
        symbols,
        examples,
        max_states: max_states.unwrap_or(DEFAULT_STATES),
        guidelines: guidelines.unwrap_or_default(),
        empty: empty.unwrap_or_else(|| "nothing happens".to_owned()),
        world,
        prior: prior.map(|(text, _)| text).unwrap_or_default(),
        costs: costs.unwrap_or_default(),
        strategy,
        practice: practice.flatten(),
    };
    Ok(Read {
        task,
        max_states,
        situation: built,
        target,
    })
}

/// The whole language that a scripted teacher has in mind: a target by name, a rule
/// or an automaton, or a list of these, of which all hold.
fn read_target(value: &Value, alphabet: &Alphabet, files: Files<'_>) -> Result<Dfa, Malformed> {
    let Some(list) = value.as_array() else {
        return read_one_target(value, "target", alphabet, files);
    };
    let mut all: Option<Dfa> = None;
    for (place, value) in list.iter().enumerate() {
        let one = read_one_target(value, &format!("target[{place}]"), alphabet, files)?;
        all = Some(match all {
            None => one,
            // Both are over the alphabet of the task.
            Some(all) => all.and(&one).map_or(one, |both| both.minimise()),
        });
    }
    all.ok_or_else(|| Malformed::new("target", "the list is empty: give at least one rule"))
}

fn read_one_target(
    value: &Value,
    path: &str,
    alphabet: &Alphabet,
    files: Files<'_>,
) -> Result<Dfa, Malformed> {
    if let Some(Ok(target)) = value.as_str().map(Target::named) {
        return automaton::over(target.dfa().clone(), alphabet)
            .map_err(|error| Malformed::new(path, error.to_string()));
    }
    situation::read_rule(value, path, alphabet, files).map(|(_, dfa)| dfa)
}

/// Checks that the target says of the examples what they say, and nothing that is
/// known otherwise.
fn suits(
    target: &Dfa,
    examples: &[Example],
    alphabet: &Alphabet,
    situation: Option<&Situation>,
) -> Result<(), Malformed> {
    let spell = |word: &Word| {
        let names: Vec<&str> = alphabet.spell(word).collect();
        format!("[{}]", names.join(", "))
    };
    for example in examples {
        if let Ok(word) = alphabet.word(&example.word)
            && target.accepts(&word) != example.label
        {
            let verb = if example.label { "rejects" } else { "accepts" };
            return Err(Malformed::new(
                "target",
                format!(
                    "the target {verb} the example {}: correct one of them",
                    spell(&word)
                ),
            ));
        }
    }
    let Some(Situation { world, prior }) = situation else {
        return Ok(());
    };
    let wrong = prior.whole(target).xor(target);
    let first = wrong.ok().and_then(|wrong| world.simplest(&wrong, 1).pop());
    match first {
        None => Ok(()),
        Some(word) => {
            let verb = if target.accepts(&word) {
                "accepts"
            } else {
                "rejects"
            };
            Err(Malformed::new(
                "target",
                format!(
                    "the target {verb} {}, and what is known beforehand (`prior`) says the opposite: correct one of them",
                    spell(&word)
                ),
            ))
        }
    }
}

#[cfg(test)]
mod tests;
