//! What the page on wrong answers shows: who still learns the target, and how
//! many questions it takes.

use super::contender::{Contender, name};
use super::markdown::{number, percent, spread_of, table};
use super::results::{Group, Results};
use super::run::Run;

/// What the page shows, in two sentences.
pub(super) fn findings(results: &Results) -> String {
    let all = results.everything();
    let clean = |run: &&Run| run.errors == 0;
    let runs = results.runs.iter().filter(clean).count();
    let ended = format!(
        "{} of {runs} runs without wrong answers ended equivalent to their target.",
        runs - results.failures()
    );
    let worst = results.plan.errors.last().copied().unwrap_or_default();
    let shares: Vec<String> = results
        .plan
        .contenders
        .iter()
        .map(|contender| {
            let cell = results.cell(&all, contender.key, cost(results), worst);
            let share = cell.count(|run| run.equivalent) as f64 / cell.len() as f64;
            format!("{} for `{}`", percent(share), name(contender.key))
        })
        .collect();
    format!(
        "{ended} With {worst} % of the answers to membership queries and comparisons wrong, the share that did is {}.",
        shares.join(", ")
    )
}

/// The one cost of the experiment.
fn cost(results: &Results) -> Option<u32> {
    results.plan.costs.first().copied().flatten()
}

/// The tables.
pub(super) fn sections(results: &Results) -> String {
    let mut text = format!(
        "\nA membership query costs {} and a comparison 1. Answers to equivalence queries are always right. Who is not told that answers may be wrong has the dissertation's way: where answers contradict each other, all those of a minimal set that cannot stand are dropped. A run ends with the teacher's agreement or after 500 questions.\n",
        cost(results).unwrap_or(1)
    );
    text.push_str("\n## Over all targets\n\n`equivalent` is the share of runs that ended equivalent, `worst` that of the target with the fewest. Questions are of all kinds; `times clean` is a geometric mean over targets of their number over that without wrong answers, and `times plain` over that of the contender that is not told of wrong answers, without any.\n\n");
    text.push_str(&overall(results));
    text.push_str("\n## By target\n\nMeans and standard deviations over runs.\n\n");
    text.push_str(&by_target(results));
    text
}

fn overall(results: &Results) -> String {
    let header = [
        "wrong",
        "",
        "equivalent",
        "worst",
        "times clean",
        "times plain",
        "dropped",
    ];
    let all = results.everything();
    let mut rows = Vec::new();
    for &errors in &results.plan.errors {
        for contender in &results.plan.contenders {
            let cell = results.cell(&all, contender.key, cost(results), errors);
            let plain = contender.plain();
            rows.push(vec![
                format!("{errors} %"),
                name(contender.key).to_owned(),
                share(results, &all, contender, errors),
                worst(results, contender, errors),
                times(results, contender, contender, errors),
                plain.map_or(String::new(), |plain| {
                    times(results, contender, plain, errors)
                }),
                cell.spread(|run| f64::from(run.dropped))
                    .map_or(String::new(), |spread| number(spread.mean)),
            ]);
        }
    }
    table(&header.map(String::from), &rows)
}

fn share_of(results: &Results, group: &Group, contender: &Contender, errors: u32) -> f64 {
    let cell = results.cell(group, contender.key, cost(results), errors);
    cell.count(|run| run.equivalent) as f64 / cell.len() as f64
}

fn share(results: &Results, group: &Group, contender: &Contender, errors: u32) -> String {
    percent(share_of(results, group, contender, errors))
}

fn worst(results: &Results, contender: &Contender, errors: u32) -> String {
    let groups = results.groups();
    let shares = groups
        .iter()
        .map(|group| share_of(results, group, contender, errors));
    shares.reduce(f64::min).map_or(String::new(), percent)
}

/// Questions over those of a contender without wrong answers: the geometric mean
/// over targets.
fn times(results: &Results, contender: &Contender, base: &Contender, errors: u32) -> String {
    let groups = results.groups();
    let logarithms: Option<Vec<f64>> = groups
        .iter()
        .map(|group| {
            let mean = |key, errors| {
                let cell = results.cell(group, key, cost(results), errors);
                Some(cell.spread(Run::questions)?.mean)
            };
            Some((mean(contender.key, errors)? / mean(base.key, 0)?).ln())
        })
        .collect();
    logarithms
        .filter(|logarithms| !logarithms.is_empty())
        .map_or("–".to_owned(), |logarithms| {
            let mean = logarithms.iter().sum::<f64>() / logarithms.len() as f64;
            format!("{:.2}", mean.exp())
        })
}

fn by_target(results: &Results) -> String {
    let header = [
        "target",
        "wrong",
        "",
        "equivalent",
        "membership",
        "comparisons",
        "equivalence",
        "questions",
        "dropped",
    ];
    let mut rows = Vec::new();
    for group in results.groups() {
        for &errors in &results.plan.errors {
            for contender in &results.plan.contenders {
                let cell = results.cell(&group, contender.key, cost(results), errors);
                rows.push(vec![
                    group.name.clone(),
                    format!("{errors} %"),
                    name(contender.key).to_owned(),
                    share(results, &group, contender, errors),
                    spread_of(&cell, |run| f64::from(run.counts.membership)),
                    spread_of(&cell, |run| f64::from(run.counts.comparison)),
                    spread_of(&cell, |run| f64::from(run.counts.equivalence)),
                    spread_of(&cell, Run::questions),
                    spread_of(&cell, |run| f64::from(run.dropped)),
                ]);
            }
        }
    }
    table(&header.map(String::from), &rows)
}
