//! The CPU time of choosing a question: the one part of a page that is not the
//! same everywhere.

use std::time::Duration;

use super::contender::name;
use super::experiment::Experiment;
use super::markdown::table;
use super::results::Results;
use super::trial::percentile;

/// The section, with `machine` as where it was measured.
pub(super) fn section(results: &Results, machine: &str) -> String {
    let milliseconds = |times: &[Duration], percent| {
        format!("{:.1}", percentile(times, percent).as_secs_f64() * 1e3)
    };
    let mut groups = results.groups();
    if groups.len() > 1 {
        groups.push(results.everything());
    }
    let mut rows = Vec::new();
    for group in &groups {
        for contender in &results.plan.contenders {
            let times = results.question_times(group, contender.key);
            rows.push(vec![
                group.name.clone(),
                name(contender.key).to_owned(),
                times.len().to_string(),
                milliseconds(&times, 50),
                milliseconds(&times, 95),
                milliseconds(&times, 100),
            ]);
        }
    }
    let header = ["target", "", "questions", "median", "95 % within", "most"];
    let theirs = if results.plan.experiment == Experiment::Monotone {
        ""
    } else {
        " The authors' code took 11 to 690 on the Tomita languages (`generalize`)."
    };
    format!(
        "\n## CPU time of choosing a question\n\nThis section varies from run to run; all above it and the other files are the same for the same command. Milliseconds of the run's own thread ({machine}); what a SAT engine does on a thread of its own is not in it.{theirs}\n\n{}",
        table(&header.map(String::from), &rows)
    )
}
