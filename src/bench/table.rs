//! The runs as a table for programs: one line a run, and no times in it, so that
//! the same seeds give the same bytes.

use super::experiment::Experiment;
use super::results::Results;

const HEADER: [&str; 16] = [
    "target",
    "states",
    "symbols",
    "contender",
    "membership_cost",
    "comparison_cost",
    "error_rate",
    "seed",
    "equivalent",
    "membership",
    "comparison",
    "equivalence",
    "dropped",
    "hurried",
    "cost",
    "all_in_cost",
];

/// The table as CSV.
///
/// # Errors
///
/// If the memory does not suffice.
pub fn csv(results: &Results) -> Result<String, csv::Error> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    let mut header = HEADER;
    if results.plan.experiment == Experiment::Monotone {
        [header[1], header[2]] = ["size", "dimensions"];
    }
    writer.write_record(header)?;
    for run in &results.runs {
        let target = &results.plan.targets[run.target];
        let record = [
            target.name().to_owned(),
            target.size().to_string(),
            target.width().to_string(),
            run.contender.to_owned(),
            run.cost.unwrap_or(1).to_string(),
            if run.cost.is_some() { "1" } else { "inf" }.to_owned(),
            (f64::from(run.errors) / 100.0).to_string(),
            run.seed.to_string(),
            run.equivalent.to_string(),
            run.counts.membership.to_string(),
            run.counts.comparison.to_string(),
            run.counts.equivalence.to_string(),
            run.dropped.to_string(),
            run.hurried.to_string(),
            run.paid().to_string(),
            run.all_in().to_string(),
        ];
        writer.write_record(&record)?;
    }
    let bytes = writer
        .into_inner()
        .map_err(|error| csv::Error::from(error.into_error()))?;
    // Every field is text.
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}
