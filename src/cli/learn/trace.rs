//! `--trace`: every question with its answer, and answers that contradict each
//! other, a line each.

use automata::{Alphabet, Dfa, Word};
use serde::Serialize;

use crate::bench::{Asked, Dropped};
use crate::cli::output::{self, Output};
use crate::evidence::{AnswerId, Comparison};
use crate::learner::{Question, Reply};
use crate::world::{Shown, World};

/// One line of the trace for programs.
#[derive(Serialize)]
struct Line<'a> {
    question: u32,
    kind: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    first: Option<Vec<&'a str>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    second: Option<Vec<&'a str>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    hypothesis: Option<&'a Dfa>,
    #[serde(skip_serializing_if = "Option::is_none")]
    word: Option<Vec<&'a str>>,
    /// What shows the words of the question, in their order.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    shown: Vec<Shown<'a>>,
    answer: &'static str,
    #[serde(rename = "word", skip_serializing_if = "Option::is_none")]
    counterexample: Option<Vec<&'a str>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    label: Option<bool>,
    /// The number of the check that the question belongs to.
    #[serde(skip_serializing_if = "Option::is_none")]
    check: Option<u32>,
}

/// One line about answers that contradict each other.
#[derive(Serialize)]
struct ConflictLine<'a> {
    /// By the numbers of their questions.
    conflict: &'a [AnswerId],
    cause: &'static str,
    minimal: bool,
    dropped: &'a [AnswerId],
}

/// Prints answers that contradict each other.
pub(super) fn conflict(format: Output, conflict: &Dropped) -> anyhow::Result<()> {
    let Dropped {
        contradiction,
        answers,
    } = conflict;
    if format == Output::Json {
        return output::line(serde_json::to_string(&ConflictLine {
            conflict: &contradiction.answers,
            cause: output::cause(contradiction.cause),
            minimal: contradiction.minimal,
            dropped: answers,
        })?);
    }
    let numbers = |answers: &[AnswerId]| {
        let numbers: Vec<String> = answers.iter().map(|answer| answer.0.to_string()).collect();
        numbers.join(", ")
    };
    output::line(format!(
        "   answers {} cannot all be true. {} Dropped: {}",
        numbers(&contradiction.answers),
        output::because(contradiction.cause),
        numbers(answers)
    ))
}

/// Prints one question with its answer.
pub(super) fn line(
    format: Output,
    alphabet: &Alphabet,
    world: Option<&World>,
    asked: &Asked<'_, Word, Dfa>,
) -> anyhow::Result<()> {
    for dropped in asked.conflicts {
        conflict(format, dropped)?;
    }
    let number = asked.number;
    let answer = answer(asked.reply);
    if format == Output::Text {
        let spelled = |word| output::spelled(alphabet, word);
        let question = match asked.question {
            Question::Membership { atom } => format!("is {} acceptable?", spelled(atom)),
            Question::Comparison { first, second } => {
                format!(
                    "which is better, {} or {}?",
                    spelled(first),
                    spelled(second)
                )
            }
            Question::Equivalence { hypothesis } => {
                let states = output::counted(hypothesis.size(), "state", "states");
                format!("is it this automaton with {states}?")
            }
        };
        let shown = match asked.reply {
            Reply::Counterexample { atom, label } => {
                let verb = if *label { "accepted" } else { "rejected" };
                format!("{answer}: {} is {verb}", spelled(atom))
            }
            _ => answer.to_owned(),
        };
        return output::line(format!("{number}. {question} {shown}"));
    }
    let spell = |word| Some(alphabet.spell(word).collect());
    let show = |words: &[&Word]| match world {
        Some(world) => (words.iter())
            .filter_map(|word| world.shown(word))
            .collect(),
        None => Vec::new(),
    };
    let mut line = Line {
        question: number,
        kind: "",
        first: None,
        second: None,
        hypothesis: None,
        word: None,
        shown: Vec::new(),
        answer,
        counterexample: None,
        label: None,
        check: asked.check.map(|check| check.round),
    };
    match asked.question {
        Question::Membership { atom } => {
            line.kind = "membership";
            line.word = spell(atom);
            line.shown = show(&[atom]);
        }
        Question::Comparison { first, second } => {
            line.kind = "comparison";
            line.first = spell(first);
            line.second = spell(second);
            line.shown = show(&[first, second]);
        }
        Question::Equivalence { hypothesis } => {
            line.kind = "equivalence";
            line.hypothesis = Some(hypothesis);
        }
    }
    if let Reply::Counterexample { atom, label } = asked.reply {
        line.counterexample = spell(atom);
        line.label = Some(*label);
    }
    output::line(serde_json::to_string(&line)?)
}

/// A reply's name in files and on the wire.
fn answer<A>(reply: &Reply<A>) -> &'static str {
    match reply {
        Reply::Accept => "accept",
        Reply::Reject => "reject",
        Reply::Compared(Comparison::First) => "first",
        Reply::Compared(Comparison::Second) => "second",
        Reply::Compared(Comparison::Equal) => "equal",
        Reply::Compared(Comparison::Incomparable) => "incomparable",
        Reply::Correct => "correct",
        Reply::Counterexample { .. } => "counterexample",
        Reply::Skip => "skip",
    }
}
