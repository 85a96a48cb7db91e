//! What `memrep learn` tells at its end.

use std::time::Duration;

use serde::Serialize;

use super::teller::Teller;
use super::{Args, check, doubts};
use crate::bench::{Report, percentile};
use crate::cli::output::{self, Key, Output, counted};
use crate::learner::{Doubts, Strategy};

/// What `--format json` prints last.
#[derive(Serialize)]
struct Summary<'a, A> {
    target: &'a str,
    strategy: Strategy,
    seed: u64,
    equivalent: bool,
    /// The number of states learned.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[expect(clippy::option_option, reason = "no key, null, or a number")]
    states: Option<Option<usize>>,
    /// The size of what was learned, where it is no automaton.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[expect(clippy::option_option, reason = "no key, null, or a number")]
    size: Option<Option<usize>>,
    membership: u32,
    comparison: u32,
    equivalence: u32,
    cost: f64,
    dropped: u32,
    /// The share of the answers that seem wrong, and which these are.
    #[serde(skip_serializing_if = "Option::is_none")]
    wrong: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    doubted: Option<Vec<u32>>,
    hurried: u32,
    /// A behaviour that would decide what nothing that can be shown does.
    #[serde(skip_serializing_if = "Option::is_none")]
    beyond: Option<A>,
    #[serde(skip_serializing_if = "Option::is_none")]
    conformance: Option<check::Checked>,
    question_ms: Milliseconds,
    cpu_s: f64,
}

/// The CPU time that choosing a question took.
#[derive(Serialize)]
struct Milliseconds {
    p50: f64,
    p95: f64,
    max: f64,
}

impl Milliseconds {
    fn of(times: &[Duration]) -> Self {
        let at = |percent| rounded(percentile(times, percent).as_secs_f64() * 1e3);
        Self {
            p50: at(50),
            p95: at(95),
            max: at(100),
        }
    }
}

/// To three places, as more would be noise.
fn rounded(number: f64) -> f64 {
    (number * 1e3).round() / 1e3
}

/// Tells what came of it.
pub(super) fn tell<L: Teller>(
    args: &Args,
    strategy: Strategy,
    target: &str,
    teller: &L,
    report: &Report<L::Concept>,
    doubts: Option<&Doubts>,
    beyond: Option<&L::Atom>,
) -> anyhow::Result<()> {
    let atoms = L::NOUNS.atoms;
    let counts = report.counts;
    let times = Milliseconds::of(&report.question_times);
    if args.format == Output::Json {
        let size = (report.learned.as_ref()).map(|learned| teller.size(learned));
        let summary = Summary {
            target,
            strategy,
            seed: args.seed,
            equivalent: report.learned.is_some(),
            states: (L::NOUNS.key == Key::Word).then_some(size),
            size: (L::NOUNS.key == Key::Atom).then_some(size),
            membership: counts.membership,
            comparison: counts.comparison,
            equivalence: counts.equivalence,
            cost: report.cost,
            dropped: report.dropped,
            wrong: doubts.map(|doubts| rounded(doubts.error_rate)),
            doubted: doubts.map(|doubts| doubts::doubted(doubts).collect()),
            hurried: report.hurried,
            beyond: beyond.map(|atom| teller.atom_line(atom)),
            conformance: (report.check.as_ref())
                .map(|check| check::Checked::of(check, counts.conformance)),
            question_ms: times,
            cpu_s: rounded(report.cpu.as_secs_f64()),
        };
        return output::line(serde_json::to_string(&summary)?);
    }
    match &report.learned {
        Some(learned) => output::line(format!("learned: {target} {}", teller.learned(learned)))?,
        None => output::line(format!(
            "not learned: {target} within {}; allow more by `--max-questions`",
            counted(args.max_questions, "question", "questions")
        ))?,
    }
    if let Some(atom) = beyond {
        output::line(format!(
            "undecided: nothing that can be shown is like {}, where the {} was chosen for its simplicity",
            teller.spelled(atom),
            L::NOUNS.concept
        ))?;
    }
    if let Some(check) = &report.check {
        check::tell(check, args.max_questions, atoms)?;
    }
    let judged = args.conformance.map_or(String::new(), |_| {
        let judged = counted(counts.conformance, "judgement", "judgements");
        format!(", {judged} to check the result")
    });
    output::line(format!(
        "asked: {}, {}, {}{judged}",
        counted(counts.membership, "membership query", "membership queries"),
        counted(counts.comparison, "comparison", "comparisons"),
        counted(
            counts.equivalence,
            "equivalence query",
            "equivalence queries"
        )
    ))?;
    output::line(format!(
        "cost: {} (equivalence queries{} not counted)",
        report.cost,
        if args.conformance.is_some() {
            " and the check"
        } else {
            ""
        }
    ))?;
    if report.dropped > 0 {
        output::line(format!(
            "dropped: {} that contradicted others",
            counted(report.dropped, "answer", "answers")
        ))?;
    }
    if let Some(doubts) = doubts {
        doubts::tell(doubts)?;
    }
    output::line(format!(
        "CPU time: {} ms a question (median; 95 % within {} ms)",
        times.p50, times.p95
    ))
}
