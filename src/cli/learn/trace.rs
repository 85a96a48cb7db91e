//! `--trace`: every question with its answer, and answers that contradict each
//! other, a line each.

use serde::Serialize;

use super::teller::Teller;
use crate::bench::{Asked, Dropped};
use crate::cli::output::{self, Key, Nouns, Output};
use crate::evidence::{AnswerId, Comparison};
use crate::learner::{Left, Question, Reply};
use crate::world::Shown;

/// One line of the trace for programs; words stand under `word`, and the atoms of
/// other classes under `atom`.
#[derive(Serialize)]
struct Line<'a, A, C> {
    question: u32,
    kind: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    first: Option<A>,
    #[serde(skip_serializing_if = "Option::is_none")]
    second: Option<A>,
    #[serde(skip_serializing_if = "Option::is_none")]
    hypothesis: Option<C>,
    #[serde(skip_serializing_if = "Option::is_none")]
    word: Option<A>,
    #[serde(skip_serializing_if = "Option::is_none")]
    atom: Option<A>,
    /// What shows the words of the question, in their order.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    shown: Vec<Shown<'a>>,
    answer: &'static str,
    /// The counterexample.
    #[serde(rename = "word", skip_serializing_if = "Option::is_none")]
    word_shown: Option<A>,
    #[serde(rename = "atom", skip_serializing_if = "Option::is_none")]
    atom_shown: Option<A>,
    #[serde(skip_serializing_if = "Option::is_none")]
    label: Option<bool>,
    /// The number of the check that the question belongs to.
    #[serde(skip_serializing_if = "Option::is_none")]
    check: Option<u32>,
    /// What was left to be learned as the question was put.
    #[serde(skip_serializing_if = "Option::is_none")]
    left: Option<Left>,
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
pub(super) fn conflict(format: Output, nouns: &Nouns, conflict: &Dropped) -> anyhow::Result<()> {
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
        output::because(contradiction.cause, nouns),
        numbers(answers)
    ))
}

/// Prints one question with its answer.
pub(super) fn line<L: Teller>(
    format: Output,
    teller: &L,
    asked: &Asked<'_, L::Atom, L::Concept>,
) -> anyhow::Result<()> {
    for dropped in asked.conflicts {
        conflict(format, &L::NOUNS, dropped)?;
    }
    let number = asked.number;
    let answer = answer(asked.reply);
    if format == Output::Text {
        let spelled = |atom| teller.spelled(atom);
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
                format!("is it {}?", teller.described(hypothesis))
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
    let tell = |atom| Some(teller.atom_line(atom));
    let show = |atoms: &[&L::Atom]| {
        let shown = atoms.iter().filter_map(|atom| teller.shown(atom));
        shown.collect()
    };
    let mut line = Line {
        question: number,
        kind: "",
        first: None,
        second: None,
        hypothesis: None,
        word: None,
        atom: None,
        shown: Vec::new(),
        answer,
        word_shown: None,
        atom_shown: None,
        label: None,
        check: asked.check.map(|check| check.round),
        left: asked.left,
    };
    match asked.question {
        Question::Membership { atom } => {
            line.kind = "membership";
            match L::NOUNS.key {
                Key::Word => line.word = tell(atom),
                Key::Atom => line.atom = tell(atom),
            }
            line.shown = show(&[atom]);
        }
        Question::Comparison { first, second } => {
            line.kind = "comparison";
            line.first = tell(first);
            line.second = tell(second);
            line.shown = show(&[first, second]);
        }
        Question::Equivalence { hypothesis } => {
            line.kind = "equivalence";
            line.hypothesis = Some(teller.concept_line(hypothesis));
        }
    }
    if let Reply::Counterexample { atom, label } = asked.reply {
        match L::NOUNS.key {
            Key::Word => line.word_shown = tell(atom),
            Key::Atom => line.atom_shown = tell(atom),
        }
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
