//! The tasks that come with memrep: what the person should have in mind, the
//! symbols, and what is known at the start; never the target itself.

use std::path::Path;

use crate::task::{
    AtomText, Costs, DEFAULT_STATES, Example, MAX_STATES, Malformed, PriorText, SymbolText, Task,
    TaskFile,
};

/// The names under which [`ready`] finds a task, for people.
pub const NAMES: &str = "robot-recharge, patrol, deliver, repairs, four-buttons, car, robot, tomita:1 to tomita:7, modulo:K, zeros:N";

/// Those that are task files, in the order in which they are offered. Their targets
/// are for scripted teachers alone.
const FILES: [(&str, &str); 6] = [
    (
        "robot-recharge",
        include_str!("../../examples/tasks/robot-recharge.toml"),
    ),
    ("patrol", include_str!("../../examples/tasks/patrol.toml")),
    ("deliver", include_str!("../../examples/tasks/deliver.toml")),
    ("repairs", include_str!("../../examples/tasks/repairs.toml")),
    (
        "four-buttons",
        include_str!("../../examples/tasks/four-buttons.toml"),
    ),
    ("car", include_str!("../../examples/tasks/car.toml")),
];

const TOMITA: [(&str, &str); 7] = [
    (
        "Only ones",
        "A sequence is acceptable if it has no 0 in it.",
    ),
    (
        "Pairs of one and zero",
        "A sequence is acceptable if it is made of whole pairs: 1 0, 1 0 1 0, and so on.",
    ),
    (
        "Odd runs apart",
        "A sequence is acceptable unless an odd run of 1s is directly followed by an odd run of 0s.",
    ),
    (
        "No three zeros",
        "A sequence is acceptable if it nowhere has three 0s in a row.",
    ),
    (
        "Both even",
        "A sequence is acceptable if the number of its 0s is even and the number of its 1s is even.",
    ),
    (
        "Difference of three",
        "A sequence is acceptable if the number of its 1s minus the number of its 0s is divisible by three.",
    ),
    (
        "Four blocks",
        "A sequence is acceptable if it is some 0s, then some 1s, then some 0s, then some 1s; any of the four may be missing.",
    ),
];

const COMPARING: &str = "Of two sequences, an acceptable one is better than one that is not; two of the same kind are equally good or bad.";

/// The ready task of this name, one of [`NAMES`].
///
/// # Errors
///
/// Names the tasks there are.
pub fn ready(name: &str) -> Result<Task, Malformed> {
    if let Some((_, text)) = FILES.iter().find(|(known, _)| *known == name) {
        let file = TaskFile::from_toml(text, Path::new(""));
        return file.map(|file| file.task).map_err(|faults| {
            let first = faults.first().map(|fault| fault.message.as_str());
            Malformed::new("", first.unwrap_or("this ready task is at fault"))
        });
    }
    let (family, number) = match name.split_once(':') {
        Some((family, number)) => (family, Some(number)),
        None => (name, None),
    };
    let within = |least: usize, most: usize| {
        number
            .and_then(|n| n.parse::<usize>().ok())
            .filter(|n| (least..=most).contains(n))
            .ok_or_else(|| {
                Malformed::new(
                    "",
                    format!(
                        "`{name}`: give a number from {least} to {most}, as in `{family}:{least}`"
                    ),
                )
            })
    };
    match family {
        "robot" if number.is_none() => Ok(robot()),
        "tomita" => Ok(tomita(within(1, 7)?)),
        "modulo" => Ok(modulo(within(1, 50)?)),
        "zeros" => Ok(zeros(within(0, 50)?)),
        _ => Err(Malformed::new(
            "",
            format!("there is no task `{name}`: the ready ones are {NAMES}"),
        )),
    }
}

/// The tasks offered on the start page, by name.
pub fn offered() -> impl Iterator<Item = Task> {
    let files = FILES.iter().map(|(name, _)| (*name).to_owned());
    let names = files
        .chain(std::iter::once("robot".to_owned()))
        .chain((1..=7).map(|n| format!("tomita:{n}")))
        .chain(["modulo:3".to_owned(), "zeros:3".to_owned()]);
    names.filter_map(|name| ready(&name).ok())
}

fn robot() -> Task {
    let symbol = |name: &str, word: &str| SymbolText {
        name: name.to_owned(),
        word: Some(word.to_owned()),
        ..SymbolText::default()
    };
    let example = |label: bool| {
        move |word: &str| Example {
            atom: AtomText::Word(word.chars().map(String::from).collect()),
            label,
        }
    };
    let accepted = ["Y", "YY", "OY"].map(example(true));
    let rejected = ["", "R", "RY", "YR", "BR", "RB", "OR", "RO"].map(example(false));
    Task {
        name: "robot".to_owned(),
        title: "The robot in words alone".to_owned(),
        class: None,
        symbols: vec![
            symbol("R", "lava"),
            symbol("Y", "recharge"),
            symbol("B", "water"),
            symbol("O", "dryer"),
        ],
        examples: accepted.into_iter().chain(rejected).collect(),
        max_states: DEFAULT_STATES,
        guidelines: format!(
            "A walk is acceptable if the robot ends it recharged: it never touched lava, it never recharged while wet, and it recharged after it was last in the water. The dryer dries it. {COMPARING}"
        ),
        empty: "the robot touches nothing".to_owned(),
        world: None,
        prior: PriorText::default(),
        costs: Costs::default(),
        strategy: None,
        practice: None,
    }
}

fn tomita(number: usize) -> Task {
    let (title, rule) = TOMITA[number - 1];
    binary(format!("tomita:{number}"), title.to_owned(), rule, 10)
}

fn zeros(most: usize) -> Task {
    let rule = format!("A sequence is acceptable if it nowhere has more than {most} 0s in a row.");
    let title = format!("At most {most} zeros in a row");
    binary(format!("zeros:{most}"), title, &rule, most + 2)
}

fn modulo(divisor: usize) -> Task {
    Task {
        name: format!("modulo:{divisor}"),
        title: format!("Count to {divisor}"),
        class: None,
        symbols: plain(["a"]),
        examples: empty_word_accepted(),
        max_states: bound(divisor),
        guidelines: format!(
            "A sequence is acceptable if its length is divisible by {divisor}. {COMPARING}"
        ),
        empty: "an empty sequence".to_owned(),
        world: None,
        prior: PriorText::default(),
        costs: Costs::default(),
        strategy: None,
        practice: None,
    }
}

fn binary(name: String, title: String, rule: &str, needed: usize) -> Task {
    Task {
        name,
        title,
        class: None,
        symbols: plain(["0", "1"]),
        examples: empty_word_accepted(),
        max_states: bound(needed),
        guidelines: format!("{rule} The empty sequence is acceptable. {COMPARING}"),
        empty: "an empty sequence".to_owned(),
        world: None,
        prior: PriorText::default(),
        costs: Costs::default(),
        strategy: None,
        practice: None,
    }
}

fn plain<const N: usize>(names: [&str; N]) -> Vec<SymbolText> {
    names.map(SymbolText::named).into()
}

fn empty_word_accepted() -> Vec<Example> {
    vec![Example {
        atom: AtomText::Word(Vec::new()),
        label: true,
    }]
}

/// The usual bound, or twice what the rule needs where that is more.
fn bound(needed: usize) -> usize {
    (2 * needed).clamp(DEFAULT_STATES, MAX_STATES)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ready_tasks_are_valid_by_the_rules_for_own_ones() {
        for task in offered() {
            let again: Task = serde_json::from_value(serde_json::to_value(&task).unwrap()).unwrap();
            assert_eq!(task, again);
            assert!(!task.guidelines.is_empty());
        }
        assert_eq!(offered().count(), 16);
    }

    #[test]
    fn ready_tasks_in_files_are_called_as_their_files() {
        for (name, _) in FILES {
            let task = ready(name).unwrap();
            assert_eq!(task.name, name);
            assert!(NAMES.split(", ").any(|known| known == name), "{name}");
            let again: Task = serde_json::from_value(serde_json::to_value(&task).unwrap()).unwrap();
            assert_eq!(task, again);
        }
    }

    #[test]
    fn unknown_names_are_answered_with_the_known_ones() {
        for name in [
            "tomita", "tomita:8", "tomita:0", "modulo:x", "robot:1", "", "zeros:-1",
        ] {
            let error = ready(name).unwrap_err();
            assert!(
                error.message.contains("give a number") || error.message.contains(NAMES),
                "{error}"
            );
        }
    }
}
