//! The measurements of [`super::passive`] as a table, ours beside the rival's.

use std::fmt::Write as _;
use std::time::Duration;

use super::passive::Outcome;

/// What both made of one sample.
#[derive(Clone, Debug)]
pub struct Row {
    /// The sample's name.
    pub sample: String,
    /// Our runs, one or more.
    pub ours: Vec<Outcome>,
    /// The rival's run; none where it was not tried.
    pub rival: Option<Outcome>,
}

impl Row {
    /// The states of the smallest automaton, by our first run; or how many it
    /// has at least, if the budget ended.
    fn states(&self) -> String {
        let size = match self.ours.first() {
            Some(Outcome::Done { output, .. }) => automaton_size(output).map(|n| n.to_string()),
            Some(Outcome::Failed { output, .. }) => bound(output).map(|n| format!("≥ {n}")),
            _ => None,
        };
        size.unwrap_or_else(|| "?".to_owned())
    }

    fn times(&self) -> Vec<Duration> {
        let mut times: Vec<Duration> = self.ours.iter().filter_map(cpu).collect();
        times.sort();
        times
    }
}

fn cpu(outcome: &Outcome) -> Option<Duration> {
    match outcome {
        Outcome::Done { cpu, .. } => Some(*cpu),
        _ => None,
    }
}

/// The states of an automaton file.
fn automaton_size(text: &str) -> Option<usize> {
    let document = automata::format::json::read(text.lines().next()?).ok()?;
    Some(document.dfa.size())
}

/// The bound that `memrep identify` reports when its budget ends.
fn bound(text: &str) -> Option<u64> {
    let report: serde_json::Value = serde_json::from_str(text.lines().next()?).ok()?;
    report["over_budget"]["at_least"].as_u64()
}

/// The page: a row a sample, with the median and the spread of our CPU times.
pub fn markdown(rows: &[Row], command: &str, limit: Duration, machine: &str) -> String {
    let mut page = String::from("# Smallest consistent automata for random samples\n\n");
    let _ = writeln!(
        page,
        "CPU seconds of the whole process, user and system. `memrep identify` beside \
         `dfa-identify` (PyPI) in the same run, which has {} wall seconds for a sample. \
         Ours is the median of the runs, with the fastest and the slowest; every automaton \
         was run on the whole sample, and one state fewer was refuted.\n",
        limit.as_secs()
    );
    let _ = writeln!(page, "Made by `{command}` ({machine}).\n");
    page.push_str("| sample | states | memrep, s | dfa-identify, s | ratio |\n|---|---|---|---|---|\n");
    for row in rows {
        let times = row.times();
        let states = row.states();
        let ours = match (times.first(), times.last(), row.ours.first()) {
            (Some(fast), Some(slow), _) => format!(
                "{:.2} ({:.2}–{:.2})",
                times[times.len() / 2].as_secs_f64(),
                fast.as_secs_f64(),
                slow.as_secs_f64()
            ),
            (_, _, Some(other)) => describe(other),
            _ => "–".to_owned(),
        };
        let rival = row.rival.as_ref();
        let theirs = rival.map_or("–".to_owned(), describe);
        let ratio = match (times.get(times.len() / 2), rival.and_then(cpu)) {
            (Some(ours), Some(rival)) => format!("{:.3}", ours.as_secs_f64() / rival.as_secs_f64()),
            _ => "–".to_owned(),
        };
        let _ = writeln!(page, "| {} | {states} | {ours} | {theirs} | {ratio} |", row.sample);
    }
    page
}

/// A single run, for a cell.
fn describe(outcome: &Outcome) -> String {
    match outcome {
        Outcome::Done { cpu, .. } => format!("{:.2}", cpu.as_secs_f64()),
        Outcome::Failed { complaint, .. } => {
            let kind = complaint.split(':').next().unwrap_or_default();
            format!("failed {kind}").trim_end().to_owned()
        }
        Outcome::Stopped => "stopped at the limit".to_owned(),
    }
}
