//! The parts that all pages of experiments share: how they open, and how tables
//! and numbers look.

use std::fmt::Write as _;

use super::contender::{Contender, RIVALS};
use super::experiment::Experiment;
use super::results::{Cell, Measure, Results};
use crate::oracle::{Counterexamples, Order};

/// A table.
pub(super) fn table(header: &[String], rows: &[Vec<String>]) -> String {
    let mut text = format!(
        "| {} |\n|{}\n",
        header.join(" | "),
        "---|".repeat(header.len())
    );
    for row in rows {
        let _ = writeln!(text, "| {} |", row.join(" | "));
    }
    text
}

/// One digit after the point.
pub(super) fn number(value: f64) -> String {
    format!("{value:.1}")
}

/// A share; nothing for none.
pub(super) fn percent(share: f64) -> String {
    if share.is_finite() {
        format!("{:.1} %", 100.0 * share)
    } else {
        String::new()
    }
}

/// Mean and standard deviation; nothing for no runs.
pub(super) fn spread_of(cell: &Cell<'_>, measure: Measure) -> String {
    cell.spread(measure).map_or(String::new(), |spread| {
        format!("{:.1} ± {:.1}", spread.mean, spread.deviation)
    })
}

/// The cost of a membership query; a dash where comparisons are never asked.
pub(super) fn cost_name(cost: Option<u32>) -> String {
    cost.map_or("–".to_owned(), |cost| cost.to_string())
}

/// How a page opens: its title, the command, what it shows, and what was done.
pub(super) fn intro(results: &Results, command: &str, findings: &str) -> String {
    let plan = &results.plan;
    let experiment = plan.experiment;
    let mut seeds = plan.seeds();
    let first = seeds.next().unwrap_or_default();
    let last = seeds.last().unwrap_or(first);
    let mut page = format!(
        "# {}\n\n`{command}`, seeds {first} to {last}.\n\n{findings}\n\n",
        experiment.title()
    );
    let order = match plan.order {
        Order::Ordered if experiment == Experiment::Monotone => {
            "prefers points that are deeper inside, or less far outside (Examples 3 and 5)"
        }
        Order::Ordered => {
            "prefers words by the order that the dissertation describes for Tomita's languages"
        }
        Order::Random => {
            "has a fixed random preference order in which a tenth of the pairs are incomparable"
        }
    };
    let counterexamples = match plan.counterexamples {
        Counterexamples::Shortest if experiment == Experiment::Monotone => {
            "its counterexamples are simplest"
        }
        Counterexamples::Shortest => "its counterexamples are shortest",
        Counterexamples::Random => "its counterexamples are random",
    };
    let _ = write!(
        page,
        "{} The teacher {order}; {counterexamples}, and nothing is promised about them. `C` is the cost of a membership query where a comparison costs 1.\n\n",
        experiment.targets_in_words()
    );
    for contender in &plan.contenders {
        let _ = writeln!(page, "- `{}`: {}.", contender.name, contender.about);
    }
    if results
        .columns()
        .iter()
        .any(|key| Contender::of(key).is_none())
    {
        let names: Vec<&str> = RIVALS.iter().map(|rival| rival.name).collect();
        let _ = writeln!(
            page,
            "- {}: the algorithms of the Python library with their usual settings, on the same targets and with the same kind of counterexamples. Counted are the different words whose labels they are told, without counterexamples and words known at the start. They ask no comparisons, and the same questions whatever `C` is.",
            names.join(", ")
        );
    }
    let _ = write!(
        page,
        "\n![The figure of this page]({name}.svg)\n\nEvery run is a line of [{name}.csv]({name}.csv).\n",
        name = experiment.name()
    );
    page
}
