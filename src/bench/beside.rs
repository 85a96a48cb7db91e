//! Our counts beside the dissertation's and those of its authors' public code.

use super::contender::{Contender, name};
use super::experiment::Experiment;
use super::markdown::{cost_name, number, table};
use super::published::{self, Published};
use super::results::{Group, Results};

/// The section; empty where nobody published anything.
pub(super) fn section(results: &Results) -> String {
    if results.plan.experiment == Experiment::Robot {
        return exchange(results);
    }
    let groups = results.groups();
    let costs = &results.plan.costs;
    let cells = groups
        .iter()
        .flat_map(|group| costs.iter().map(move |&cost| (group, cost)));
    let rows: Vec<Vec<String>> = cells
        .filter_map(|(group, cost)| {
            let published = published::on(&group.name, cost)?;
            let mut row = vec![group.name.clone(), cost_name(cost), printed(published)];
            let ours = results.plan.contenders.iter();
            row.extend(ours.map(|contender| counts(results, group, contender, cost)));
            row.extend([measured(published.generalize), measured(published.main)]);
            Some(row)
        })
        .collect();
    if rows.is_empty() {
        return String::new();
    }
    let mut header: Vec<String> = ["target", "C", "dissertation"].map(String::from).to_vec();
    let ours = results.plan.contenders.iter();
    header.extend(ours.map(|contender| name(contender.key).to_owned()));
    header.extend(["`generalize`", "`main`"].map(String::from));
    format!(
        "\n## Beside the dissertation\n\nCells are membership queries + comparisons / equivalence queries, means over runs. The dissertation's are Tables 5.1 and 5.3 (Tomita; in brackets Table 5.2's variance and Table 5.3's `σ`, as printed), 5.4 (`modulo`, with the equivalence queries of section 5.3) and 5.5 (`zeros`). `generalize` and `main` are runs of the two branches of its authors' public code, which had random counterexamples and few trials in the slow cells. The targets and the teacher's order are the dissertation's as we read it.\n\n{}",
        table(&header, &rows)
    )
}

fn printed(published: &Published) -> String {
    let [membership, comparison] = published.thesis;
    let counts = match published.spread {
        Some([variance, sigma]) => {
            format!("{membership:.1} ({variance}) + {comparison:.1} ({sigma})")
        }
        None => format!("{membership:.1} + {comparison:.1}"),
    };
    match published.equivalence {
        Some(equivalence) => format!("{counts} / {equivalence:.1}"),
        None => counts,
    }
}

fn measured(counts: Option<[f64; 3]>) -> String {
    counts.map_or(String::new(), |[membership, comparison, equivalence]| {
        format!("{membership:.1} + {comparison:.1} / {equivalence:.1}")
    })
}

fn counts(results: &Results, group: &Group, contender: &Contender, cost: Option<u32>) -> String {
    measured(means(results, group, contender, cost))
}

/// Mean membership queries, comparisons and equivalence queries.
fn means(
    results: &Results,
    group: &Group,
    contender: &Contender,
    cost: Option<u32>,
) -> Option<[f64; 3]> {
    let cell = results.cell(group, contender.key, cost, 0);
    Some([
        cell.spread(|run| f64::from(run.counts.membership))?.mean,
        cell.spread(|run| f64::from(run.counts.comparison))?.mean,
        cell.spread(|run| f64::from(run.counts.equivalence))?.mean,
    ])
}

/// What the dissertation says about the robot: how many comparisons a saved
/// membership query costs.
fn exchange(results: &Results) -> String {
    let all = results.everything();
    let costs: Vec<u32> = results.plan.costs.iter().flatten().copied().collect();
    let (Some(&low), Some(&high)) = (costs.iter().min(), costs.iter().max()) else {
        return String::new();
    };
    let rows: Vec<Vec<String>> = results
        .plan
        .contenders
        .iter()
        .filter_map(|contender| {
            let cheap = means(results, &all, contender, Some(low))?;
            let dear = means(results, &all, contender, Some(high))?;
            let (saved, added) = (cheap[0] - dear[0], dear[1] - cheap[1]);
            let each = if saved > 0.0 {
                format!("{:.2}", added / saved)
            } else {
                "–".to_owned()
            };
            let name = name(contender.key).to_owned();
            Some(vec![name, number(saved), number(added), each])
        })
        .collect();
    let header = [
        "",
        "membership queries saved",
        "comparisons added",
        "comparisons for one",
    ];
    format!(
        "\n## Beside the dissertation\n\nFig. 5.3 has no numbers. The text says that every membership query removed adds 2.03 comparisons on average each time the cost doubles, and that L* needs 11 membership queries and 2 equivalence queries with the prior knowledge. Here, from C = {low} to C = {high}:\n\n{}",
        table(&header.map(String::from), &rows)
    )
}
