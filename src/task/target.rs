//! What a scripted teacher of a task has in mind.

use automata::{Alphabet, Dfa};
use serde_json::Value;

use super::automaton::over;
use super::examples::Example;
use super::prior::read_rule;
use super::reader::{Fields, Malformed};
use super::situation::{Files, Situation};
use super::universe::{Atom, Concept, ConceptText, Universe};
use crate::concept::LinearReward;
use crate::oracle::Target;

/// Reads what stands under `target`.
///
/// # Errors
///
/// If it is no rule of the task's class.
pub(super) fn read(
    value: &Value,
    universe: &Universe,
    files: Files<'_>,
) -> Result<Concept, Malformed> {
    match universe {
        Universe::Words { alphabet, .. } => {
            read_language(value, alphabet, files).map(Concept::Automaton)
        }
        Universe::Monotone(_) => {
            let Atom::Point(limits) = universe.read(value, "target")? else {
                return Err(Malformed::new("target", "give one limit an axis"));
            };
            Ok(Concept::Parameter(limits))
        }
        Universe::Finite(_) => {
            let concept = value.as_str().unwrap_or_default().to_owned();
            let read = universe.parse_rule(&ConceptText::Named { concept });
            read.map_err(|error| Malformed::new("target", error.to_string()))
        }
        Universe::Linear(rewards) => {
            let fields = Fields::of(value, "target")?;
            fields.only(&["weights", "threshold"])?;
            let form = || {
                Malformed::new(
                    "target",
                    "give a reward as `{\"weights\": [0.5, -1.0], \"threshold\": 0.2}`",
                )
            };
            let weights: Option<Vec<f64>> =
                (fields.list("weights")?.iter().map(Value::as_f64)).collect();
            let reward = LinearReward {
                weights: weights.ok_or_else(form)?,
                threshold: (fields.get("threshold").and_then(Value::as_f64)).ok_or_else(form)?,
            };
            let parameter = rewards.simplest_like(&reward);
            let parameter = parameter.map_err(|message| Malformed::new("target", message))?;
            Ok(Concept::Parameter(parameter))
        }
    }
}

/// A whole language: a target by name, a rule or an automaton, or a list of these, of
/// which all hold.
fn read_language(value: &Value, alphabet: &Alphabet, files: Files<'_>) -> Result<Dfa, Malformed> {
    let Some(list) = value.as_array() else {
        return read_one(value, "target", alphabet, files);
    };
    let mut all: Option<Dfa> = None;
    for (place, value) in list.iter().enumerate() {
        let one = read_one(value, &format!("target[{place}]"), alphabet, files)?;
        all = Some(match all {
            None => one,
            // Both are over the alphabet of the task.
            Some(all) => all.and(&one).map_or(one, |both| both.minimise()),
        });
    }
    all.ok_or_else(|| Malformed::new("target", "the list is empty: give at least one rule"))
}

fn read_one(
    value: &Value,
    path: &str,
    alphabet: &Alphabet,
    files: Files<'_>,
) -> Result<Dfa, Malformed> {
    if let Some(Ok(target)) = value.as_str().map(Target::named) {
        return over(target.dfa().clone(), alphabet)
            .map_err(|error| Malformed::new(path, error.to_string()));
    }
    read_rule(value, path, alphabet, files).map(|(_, dfa)| dfa)
}

/// Checks that the target says of the examples what they say, and nothing that is
/// known otherwise.
pub(super) fn suits(
    target: &Concept,
    examples: &[Example],
    universe: &Universe,
) -> Result<(), Malformed> {
    let verb = |accepts: bool| if accepts { "accepts" } else { "rejects" };
    for example in examples {
        if let Ok(atom) = universe.parse(&example.atom)
            && universe.accepts(target, &atom) != example.label
        {
            return Err(Malformed::new(
                "target",
                format!(
                    "the target {} the example {}: correct one of them",
                    verb(!example.label),
                    universe.spell(&atom)
                ),
            ));
        }
    }
    let (Some(Situation { world, prior }), Some(target)) =
        (universe.situation(), target.automaton())
    else {
        return Ok(());
    };
    let wrong = prior.whole(target).xor(target);
    let first = wrong.ok().and_then(|wrong| world.simplest(&wrong, 1).pop());
    match first {
        None => Ok(()),
        Some(word) => Err(Malformed::new(
            "target",
            format!(
                "the target {} {}, and what is known beforehand (`prior`) says the opposite: correct one of them",
                verb(target.accepts(&word)),
                universe.spell(&Atom::Word(word))
            ),
        )),
    }
}
