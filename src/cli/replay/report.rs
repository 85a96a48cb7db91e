//! What `memrep replay` says of a session that stands.

use serde_json::{Value, json};

use super::Rebuilt;
use crate::cli::output::{counted, line};
use crate::learner::{Counts, Question, Reply};
use crate::session::{Position, Session};

/// The questions that were put, and those skipped, by kind.
#[derive(Default)]
pub(super) struct Put {
    membership: usize,
    comparison: usize,
    equivalence: usize,
    skipped: usize,
}

impl Put {
    pub(super) fn of(session: &Session) -> Self {
        let mut put = Self::default();
        let mut number = 1;
        while let Some(asked) = session.asked(number) {
            match asked.question {
                Question::Membership { .. } => put.membership += 1,
                Question::Comparison { .. } => put.comparison += 1,
                Question::Equivalence { .. } => put.equivalence += 1,
            }
            number += 1;
        }
        let skipped = session.standing().iter();
        put.skipped = skipped.filter(|s| s.reply == Reply::Skip).count();
        put
    }
}

fn state(session: &Session) -> &'static str {
    match session.position() {
        Position::Thinking => "thinking",
        Position::Asking(_) => "asking",
        Position::Conflict(_) => "conflict",
        Position::Done(_) => "done",
    }
}

/// For programs.
pub(super) fn json(rebuilt: &Rebuilt) -> Value {
    let session = &rebuilt.session;
    let put = &rebuilt.put;
    let standing: Vec<u32> = session.standing().iter().map(|s| s.number).collect();
    json!({
        "entries": rebuilt.entries,
        "memrep": rebuilt.memrep,
        "task": session.task().name,
        "setup": session.setup(),
        "rethought": rebuilt.rethought,
        "terse": rebuilt.terse,
        "questions": {
            "membership": put.membership,
            "comparison": put.comparison,
            "equivalence": put.equivalence,
        },
        "skipped": put.skipped,
        "counts": session.counts(),
        "answers": standing,
        "state": state(session),
        "hypothesis": session.hypothesis().map(|rule| session.universe().rule(&rule)),
        "next": session.describe(session.position()),
    })
}

/// For people.
pub(super) fn text(rebuilt: &Rebuilt) -> anyhow::Result<()> {
    let session = &rebuilt.session;
    let setup = serde_json::to_value(session.setup()).unwrap_or_default();
    line(format_args!(
        "{} of `{}` ({}), begun by memrep {}; strategy {}, seed {}",
        counted(rebuilt.entries as u64, "entry", "entries"),
        session.task().name,
        session.task().title,
        rebuilt.memrep,
        setup["strategy"].as_str().unwrap_or_default(),
        session.setup().seed,
    ))?;
    let put = &rebuilt.put;
    let total = put.membership + put.comparison + put.equivalence;
    line(format_args!(
        "{} put: {} membership, {} comparison, {} equivalence",
        counted(total as u64, "question", "questions"),
        put.membership,
        put.comparison,
        put.equivalence,
    ))?;
    let Counts {
        membership,
        comparison,
        equivalence,
        ..
    } = session.counts();
    line(format_args!(
        "{}: {membership} membership, {comparison} comparison, {equivalence} equivalence, {} skipped",
        counted(
            session.standing().len() as u64,
            "answer stands",
            "answers stand"
        ),
        put.skipped,
    ))?;
    if rebuilt.rethought > 0 {
        line(format_args!(
            "{} of the learner's worked out again: all the same",
            counted(rebuilt.rethought as u64, "entry", "entries"),
        ))?;
    }
    if rebuilt.terse > 0 {
        line(format_args!(
            "{} of an earlier version, which did not tell what was left to learn",
            counted(rebuilt.terse as u64, "entry is", "entries are"),
        ))?;
    }
    if let Some(rule) = session.hypothesis() {
        let shown = serde_json::to_string(&session.universe().rule(&rule))?;
        line(format_args!("rule on show: {shown}"))?;
    }
    line(format_args!("next: {}", next(session)))
}

fn next(session: &Session) -> String {
    let universe = session.universe();
    match session.position() {
        Position::Thinking => "the learner has yet to think".to_owned(),
        Position::Asking(number) => {
            let asked = session.asked(*number).map(|asked| &asked.question);
            let question = match asked {
                Some(Question::Membership { atom }) => {
                    format!("is {} acceptable?", universe.spell(atom))
                }
                Some(Question::Comparison { first, second }) => format!(
                    "which is better, {} or {}?",
                    universe.spell(first),
                    universe.spell(second)
                ),
                Some(Question::Equivalence { .. }) | None => "is this the rule?".to_owned(),
            };
            format!("question {number}, {question}")
        }
        Position::Conflict(conflict) => format!("a conflict: {}", session.explain(conflict)),
        Position::Done(_) => "nothing, the session is done".to_owned(),
    }
}
