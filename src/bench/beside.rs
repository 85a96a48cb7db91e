//! Our counts beside the dissertation's and those of its authors' public code.

use super::contender::{Contender, name};
use super::experiment::Experiment;
use super::markdown::{cost_name, number, table};
use super::published::{self, Published};
use super::results::{Group, Results};

/// The section; empty where nobody published anything.
pub(super) fn section(results: &Results) -> String {
    if matches!(
        results.plan.experiment,
        Experiment::Robot | Experiment::Monotone
    ) {
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

/// What the dissertation says of Fig. 5.3: how many comparisons a saved membership
/// query costs.
fn exchange(results: &Results) -> String {
    let all = results.everything();
    let mut costs: Vec<u32> = results.plan.costs.iter().flatten().copied().collect();
    costs.sort_unstable();
    let (Some(&low), Some(&high)) = (costs.first(), costs.last()) else {
        return String::new();
    };
    let between = |contender: &Contender, low, high| {
        let cheap = means(results, &all, contender, Some(low))?;
        let dear = means(results, &all, contender, Some(high))?;
        Some((cheap[0] - dear[0], dear[1] - cheap[1]))
    };
    let steps: Vec<(u32, u32)> = costs.windows(2).map(|pair| (pair[0], pair[1])).collect();
    let rows: Vec<Vec<String>> = results
        .plan
        .contenders
        .iter()
        .filter_map(|contender| {
            let (saved, added) = between(contender, low, high)?;
            let each = if saved > 0.0 {
                format!("{:.2}", added / saved)
            } else {
                "–".to_owned()
            };
            let step = |&(low, high): &(u32, u32)| {
                between(contender, low, high).map_or(String::new(), |(saved, added)| {
                    // No change is neither more nor less.
                    format!("{:+.2} / {:+.2}", 0.0 - saved, 0.0 + added)
                })
            };
            let name = name(contender.key).to_owned();
            let row = [name].into_iter().chain(steps.iter().map(step));
            Some(row.chain([number(saved), number(added), each]).collect())
        })
        .collect();
    let step = |(low, high): &(u32, u32)| format!("C = {low} to {high}");
    let header: Vec<String> = [String::new()]
        .into_iter()
        .chain(steps.iter().map(step))
        .chain(
            [
                "membership queries saved",
                "comparisons added",
                "comparisons for one",
            ]
            .map(String::from),
        )
        .collect();
    let said = if results.plan.experiment == Experiment::Monotone {
        "The text says that each time the cost doubles, removing one membership query adds 2.4 queries on average (it prints membership queries, and from what follows it means comparisons; the 2.03 of the same figure is the robot's), that the mean number of equivalence queries is the same at all costs and in the membership-only baseline, and that to ask comparisons at all sometimes adds membership queries."
    } else {
        "The text says that every membership query removed adds 2.03 comparisons on average each time the cost doubles, and that L* needs 11 membership queries and 2 equivalence queries with the prior knowledge."
    };
    format!(
        "\n## Beside the dissertation\n\nFig. 5.3 has no numbers. {said} Here, the change of the mean membership queries / comparisons with every doubling, and from C = {low} to C = {high} how many were saved and added; the last column, their quotient, is the mean over the doublings of comparisons added for a membership query removed, each weighted by how many it removes:\n\n{}",
        table(&header, &rows)
    )
}
