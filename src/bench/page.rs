//! The page of an experiment: how the contenders stand against `thesis` and KV,
//! what they asked, and what the dissertation has.

use std::fmt::Write as _;

use super::beside;
use super::contender::{BASE, KV, name};
use super::experiment::Experiment;
use super::markdown::{cost_name, intro, number, percent, spread_of, table};
use super::noise_page;
use super::results::{Measure, Results};
use super::run::Run;
use super::times;

/// The page, as Markdown. `command` is what was run and `machine` where; only the
/// last section, on times, depends on more than the plan.
pub fn markdown(results: &Results, command: &str, machine: &str) -> String {
    let mut page = intro(results, command, &findings(results));
    if results.plan.experiment == Experiment::Noise {
        page.push_str(&noise_page::sections(results));
    } else {
        page.push_str(&against(results, BASE));
        if results.columns().contains(&KV) {
            page.push_str(&against(results, KV));
        }
        page.push_str(&ends(results));
        page.push_str(&questions(results));
        page.push_str(&beside::section(results));
    }
    page.push_str(&times::section(results, machine));
    page
}

/// What the page shows, in two sentences.
fn findings(results: &Results) -> String {
    if results.plan.experiment == Experiment::Noise {
        return noise_page::findings(results);
    }
    let ours = |run: &&Run| super::Contender::of(run.contender).is_some();
    let runs: Vec<&Run> = results.runs.iter().filter(ours).collect();
    let equivalent = runs.iter().filter(|run| run.equivalent).count();
    let hurried = runs.iter().filter(|run| run.hurried > 0).count();
    let ended = format!(
        "{equivalent} of {} runs ended equivalent to their target, and {hurried} of them met the bound of work at some question.",
        runs.len(),
    );
    let others = results.plan.contenders.iter();
    let first = others
        .map(|contender| contender.key)
        .find(|key| *key != BASE);
    let ratios = first.map_or(Vec::new(), |key| {
        let at = |cost: &Option<u32>| {
            let ratio = results.against_base(key, *cost, Run::all_in)?;
            let cost = (*cost).map_or("without comparisons".to_owned(), |cost| {
                format!("at C = {cost}")
            });
            Some(format!("{} {cost}", interval(ratio)))
        };
        results.plan.costs.iter().filter_map(at).collect()
    });
    let measured = match first {
        Some(key) if !ratios.is_empty() => format!(
            "The all-in cost of `{}` over that of `{}` in the same run, {} with its 95 % interval, is {}.",
            name(key),
            name(BASE),
            match results.plan.targets.len() {
                targets if results.plan.experiment == Experiment::Monotone =>
                    format!("as the ratio of means over {targets} concepts"),
                1 => "as a geometric mean over the one target".to_owned(),
                targets => format!("as a geometric mean over {targets} targets"),
            },
            ratios.join(", ")
        ),
        _ => format!(
            "Nothing was run beside `{}` that could be measured by it.",
            name(BASE)
        ),
    };
    format!("{ended} {measured}")
}

/// A ratio with its interval; without one where all resampled ratios are the
/// same, as they are for a single run or against oneself.
fn interval(ratio: super::Ratio) -> String {
    let (low, high) = ratio.interval;
    if high - low < 1e-9 {
        return format!("{:.2}", ratio.ratio);
    }
    format!("{:.2} ({low:.2}–{high:.2})", ratio.ratio)
}

/// How everybody stands against one, by both costs.
fn against(results: &Results, base: &str) -> String {
    let (ratio, drawn) = match results.plan.experiment {
        Experiment::Monotone => ("Ratios of the mean costs over all concepts", "runs"),
        experiment => (
            "Geometric means over the targets on which both were run of the ratio of mean costs",
            if experiment.is_drawn() {
                "targets and runs"
            } else {
                "runs"
            },
        ),
    };
    let mut section = format!(
        "\n## Costs over those of `{}`\n\n{ratio}; in brackets the 95 % interval of a bootstrap that draws {drawn} anew. `–`: comparisons are never asked.\n",
        name(base),
    );
    let costs: [(&str, Measure); 2] = [
        (
            "All-in cost, `C·memberships + comparisons + 4C·equivalence queries`",
            Run::all_in,
        ),
        (
            "The dissertation's cost, `C·memberships + comparisons`",
            Run::paid,
        ),
    ];
    for (title, measure) in costs {
        let row = |key: &&str| {
            let ratio = |cost: &Option<u32>| {
                results
                    .ratio(key, base, *cost, measure)
                    .map_or("–".to_owned(), interval)
            };
            let cells = results.plan.costs.iter().map(ratio);
            std::iter::once(name(key).to_owned()).chain(cells).collect()
        };
        let rows = results.columns().iter().map(row).collect::<Vec<_>>();
        let _ = write!(
            section,
            "\n{title}:\n\n{}",
            table(&cost_header(results), &rows)
        );
    }
    section
}

fn cost_header(results: &Results) -> Vec<String> {
    let costs = results.plan.costs.iter();
    let costs = costs.map(|cost| (*cost).map_or("–".to_owned(), |cost| format!("C = {cost}")));
    std::iter::once(String::new()).chain(costs).collect()
}

/// How the runs ended, and how many equivalence queries they took.
fn ends(results: &Results) -> String {
    let all = results.everything();
    let section = String::from(
        "\n## How the runs ended\n\nEquivalence queries are means over all runs, by the cost of a membership query. A question is hurried if the bound of work ended before the strategy had weighed all it wanted.\n\n",
    );
    let row = |key: &&str| {
        let runs: Vec<&Run> = results
            .runs
            .iter()
            .filter(|run| run.contender == *key)
            .collect();
        let equivalent = runs.iter().filter(|run| run.equivalent).count();
        let hurried: f64 = runs.iter().map(|run| f64::from(run.hurried)).sum();
        let asked: f64 = runs.iter().map(|run| run.questions()).sum();
        let equivalence = |cost: &Option<u32>| {
            let cell = results.cell(&all, key, *cost, 0);
            cell.spread(|run| f64::from(run.counts.equivalence))
                .map_or(String::new(), |spread| number(spread.mean))
        };
        let mut row = vec![
            name(key).to_owned(),
            runs.len().to_string(),
            equivalent.to_string(),
            percent(hurried / asked),
        ];
        row.extend(results.plan.costs.iter().map(equivalence));
        row
    };
    let mut header: Vec<String> = ["", "runs", "ended equivalent", "questions hurried"]
        .map(String::from)
        .to_vec();
    header.extend(cost_header(results).into_iter().skip(1));
    let rows = results.columns().iter().map(row).collect::<Vec<_>>();
    section + &table(&header, &rows)
}

/// What was asked and paid, by target, cost and contender.
fn questions(results: &Results) -> String {
    let mut section = String::from(
        "\n## Questions asked\n\nMeans and standard deviations over runs. `cost` is the dissertation's (equivalence queries are free), `all-in` counts each as four membership queries.\n\n",
    );
    let header = [
        "target",
        "C",
        "",
        "membership",
        "comparisons",
        "equivalence",
        "cost",
        "all-in",
        "equivalent",
    ];
    let mut rows = Vec::new();
    for group in results.groups() {
        for &cost in &results.plan.costs {
            for key in results.columns() {
                let cell = results.cell(&group, key, cost, 0);
                if cell.is_empty() {
                    continue;
                }
                rows.push(vec![
                    group.name.clone(),
                    cost_name(cost),
                    name(key).to_owned(),
                    spread_of(&cell, |run| f64::from(run.counts.membership)),
                    spread_of(&cell, |run| f64::from(run.counts.comparison)),
                    spread_of(&cell, |run| f64::from(run.counts.equivalence)),
                    spread_of(&cell, Run::paid),
                    spread_of(&cell, Run::all_in),
                    format!("{} of {}", cell.count(|run| run.equivalent), cell.len()),
                ]);
            }
        }
    }
    section.push_str(&table(&header.map(String::from), &rows));
    section
}
