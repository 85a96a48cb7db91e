//! L*, KV and L# of the Python library `AALpy` on the same targets, as rivals
//! that ask no comparisons.

use std::io::Write as _;
use std::path::Path;
use std::process::{Command, Output, Stdio};

use automata::{Dfa, StateId, Symbol};
use serde::Deserialize;
use serde_json::json;

use super::case::Case;
use super::contender::RIVALS;
use super::experiment::Plan;
use super::run::Run;
use crate::evidence::Fact;
use crate::learner::Counts;
use crate::oracle::Counterexamples;
use crate::task::Situation;
use crate::world::World;

/// What Python runs; it tells its input and output itself.
const SCRIPT: &str = include_str!("rivals.py");

/// Why there are no rivals.
#[derive(Debug, thiserror::Error)]
pub enum RivalsError {
    /// Python cannot be started or talked to.
    #[error("cannot run this Python")]
    Start(#[from] std::io::Error),
    /// It ended badly.
    #[error("it complained: {0} (the rivals need AALpy: `pip install aalpy==2.0.0`)")]
    Complaint(String),
    /// What it printed is not what was expected.
    #[error("it printed something that was not understood: {0}")]
    Output(#[from] serde_json::Error),
}

#[derive(Deserialize)]
struct Line {
    target: usize,
    rival: String,
    seed: u64,
    membership: u32,
    equivalence: u32,
}

/// Whether this Python has the library: to be asked before much work is done.
///
/// # Errors
///
/// If Python or the library is missing.
pub fn find(python: &Path) -> Result<(), RivalsError> {
    let output = Command::new(python).args(["-c", "import aalpy"]).output()?;
    complaint(&output)
}

/// What it has to complain of, if it ended badly.
fn complaint(output: &Output) -> Result<(), RivalsError> {
    if output.status.success() {
        return Ok(());
    }
    let complaint = String::from_utf8_lossy(&output.stderr);
    let last = complaint.lines().last().unwrap_or("no reason given");
    Err(RivalsError::Complaint(last.trim().to_owned()))
}

/// The rivals' runs with the plan's targets, seeds and counterexamples, repeated
/// for every cost, as they look at none. Their teacher compares automata
/// exactly, so all end equivalent. Of random counterexamples theirs are drawn
/// from the same distribution, but they are not the same words.
///
/// # Errors
///
/// If Python or the library is missing, or fails.
pub fn run(plan: &Plan, python: &Path) -> Result<Vec<Run>, RivalsError> {
    let cases = plan.targets.iter().enumerate();
    let cases: Vec<(usize, &Case)> = cases
        .filter_map(|(place, subject)| Some((place, subject.language()?)))
        .filter(|(_, case)| case.situation().is_none_or(shows_all_words))
        .collect();
    let task = json!({
        "counterexamples": match plan.counterexamples {
            Counterexamples::Shortest => "shortest",
            Counterexamples::Random => "random",
        },
        "seeds": plan.seeds().collect::<Vec<_>>(),
        "targets": cases.iter().map(|(_, case)| table(case)).collect::<Vec<_>>(),
    });
    let mut child = Command::new(python)
        .args(["-c", SCRIPT])
        // The order of Python's sets must not depend on the run.
        .env("PYTHONHASHSEED", "0")
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()?;
    if let Some(mut input) = child.stdin.take() {
        // It may have died at once; its complaint says why.
        let _ = input.write_all(task.to_string().as_bytes());
    }
    let output = child.wait_with_output()?;
    complaint(&output)?;
    let lines = String::from_utf8_lossy(&output.stdout);
    let lines: Vec<Line> = lines
        .lines()
        .map(serde_json::from_str)
        .collect::<Result<_, _>>()?;
    let at_cost = |&cost: &Option<u32>| {
        let known = |line: &Line| {
            let rival = RIVALS.iter().find(|rival| rival.key == line.rival)?;
            Some(Run {
                target: cases.get(line.target)?.0,
                contender: rival.key,
                cost,
                errors: 0,
                seed: line.seed,
                equivalent: true,
                counts: Counts {
                    membership: line.membership,
                    comparison: 0,
                    equivalence: line.equivalence,
                    conformance: 0,
                },
                dropped: 0,
                hurried: 0,
                question_times: Vec::new(),
            })
        };
        lines.iter().filter_map(known).collect::<Vec<_>>()
    };
    Ok(plan.costs.iter().flat_map(at_cost).collect())
}

/// Whether words are shown as they are, however they go on: the rivals know no other
/// world.
fn shows_all_words(situation: &Situation) -> bool {
    matches!(*situation.world, World::Words(_))
}

/// A target for the script.
fn table(case: &Case) -> serde_json::Value {
    let target = case.target();
    let mut table = automaton(target.dfa());
    let known = target.known().iter().filter_map(|fact| match fact {
        Fact::Label { atom, .. } => Some(atom.iter().map(Symbol::index).collect::<Vec<_>>()),
        _ => None,
    });
    table["known"] = json!(known.collect::<Vec<_>>());
    if let Some(situation) = case.situation() {
        table["open"] = automaton(situation.prior.open());
    }
    table
}

fn automaton(dfa: &Dfa) -> serde_json::Value {
    let row = |state| {
        let symbols = dfa.alphabet().symbols();
        symbols
            .map(|symbol| dfa.next(state, symbol).index())
            .collect::<Vec<_>>()
    };
    let accepting = dfa.states().filter(|&state| dfa.is_accepting(state));
    json!({
        "symbols": dfa.alphabet().len(),
        "start": dfa.start().index(),
        "accepting": accepting.map(StateId::index).collect::<Vec<_>>(),
        "delta": dfa.states().map(row).collect::<Vec<_>>(),
    })
}
