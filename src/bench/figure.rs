//! The figure of an experiment: what is drawn, before it is drawn.

use super::chart::{self, ChartError, Panel, Point, Series};
use super::contender::{BASE, name};
use super::experiment::Experiment;
use super::results::{Cell, Group, Measure, Results};
use super::run::Run;

/// More targets than this share one panel.
const MOST_PANELS: usize = 8;

/// The figure, as SVG: a panel a target with the mean costs and their standard
/// deviations, and one with the ratios to `thesis` and their intervals.
///
/// # Errors
///
/// If it cannot be drawn.
pub fn figure(results: &Results) -> Result<String, ChartError> {
    let mut groups = results.groups();
    if results.plan.experiment.is_drawn() || groups.len() > MOST_PANELS {
        let targets = results.plan.targets.len();
        groups = vec![Group {
            name: format!("all {targets} targets"),
            ..results.everything()
        }];
    }
    if results.plan.experiment == Experiment::Monotone {
        return chart::svg(&kinds(results, &results.everything()));
    }
    let noise = results.plan.experiment == Experiment::Noise;
    let mut panels: Vec<Panel> = groups
        .iter()
        .map(|group| {
            if noise {
                questions(results, group)
            } else {
                costs(results, group)
            }
        })
        .collect();
    panels.push(if noise {
        shares(results)
    } else {
        ratios(results)
    });
    chart::svg(&panels)
}

/// A panel with a tick a cost.
fn by_cost(
    results: &Results,
    title: &str,
    y_title: &str,
    point: impl Fn(&str, Option<u32>) -> Option<Point>,
) -> Panel {
    let series = |key: &&'static str| Series {
        name: name(key).to_owned(),
        points: results
            .plan
            .costs
            .iter()
            .map(|&cost| point(key, cost))
            .collect(),
    };
    Panel {
        title: title.to_owned(),
        x_title: "cost C of a membership query (–: no comparisons)".to_owned(),
        y_title: y_title.to_owned(),
        ticks: results
            .plan
            .costs
            .iter()
            .map(|cost| cost.map_or("–".to_owned(), |cost| cost.to_string()))
            .collect(),
        series: results.columns().iter().map(series).collect(),
        line: None,
    }
}

/// A panel a kind of question, as the parts of Fig. 5.3's bars, and the ratios.
fn kinds(results: &Results, group: &Group) -> Vec<Panel> {
    let kinds: [(&str, Measure); 3] = [
        ("membership queries", |run| f64::from(run.counts.membership)),
        ("comparisons", |run| f64::from(run.counts.comparison)),
        ("equivalence queries", |run| {
            f64::from(run.counts.equivalence)
        }),
    ];
    let panel = |(name, measure): (&str, Measure)| {
        by_cost(results, name, "mean ± deviation", |key, cost| {
            mean(&results.cell(group, key, cost, 0), measure)
        })
    };
    let mut panels: Vec<Panel> = kinds.into_iter().map(panel).collect();
    panels.push(costs(results, group));
    panels.push(ratios(results));
    panels
}

fn costs(results: &Results, group: &Group) -> Panel {
    by_cost(
        results,
        &group.name,
        "all-in cost, membership queries",
        |key, cost| {
            let cell = results.cell(group, key, cost, 0);
            mean(&cell, |run| run.all_in() / run.cost.map_or(1.0, f64::from))
        },
    )
}

fn mean(cell: &Cell<'_>, measure: Measure) -> Option<Point> {
    let spread = cell.spread(measure)?;
    Some(Point {
        value: spread.mean,
        low: spread.mean - spread.deviation,
        high: spread.mean + spread.deviation,
    })
}

fn ratios(results: &Results) -> Panel {
    let title = format!("all-in cost over that of {}", name(BASE));
    let panel = by_cost(results, &title, "ratio, 95 % interval", |key, cost| {
        let ratio = results.against_base(key, cost, Run::all_in)?;
        Some(Point {
            value: ratio.ratio,
            low: ratio.interval.0,
            high: ratio.interval.1,
        })
    });
    Panel {
        line: Some(1.0),
        ..panel
    }
}

/// A panel with a tick a share of wrong answers.
fn by_error(
    results: &Results,
    title: &str,
    y_title: &str,
    point: impl Fn(&Cell<'_>) -> Option<Point>,
) -> Panel {
    let all = results.everything();
    let places = |group: &Group| group.name == title;
    let group = results.groups().into_iter().find(places).unwrap_or(all);
    let cost = results.plan.costs.first().copied().flatten();
    let series = |key: &&'static str| Series {
        name: name(key).to_owned(),
        points: results
            .plan
            .errors
            .iter()
            .map(|&errors| point(&results.cell(&group, key, cost, errors)))
            .collect(),
    };
    Panel {
        title: title.to_owned(),
        x_title: "wrong answers, %".to_owned(),
        y_title: y_title.to_owned(),
        ticks: results.plan.errors.iter().map(u32::to_string).collect(),
        series: results.columns().iter().map(series).collect(),
        line: None,
    }
}

fn questions(results: &Results, group: &Group) -> Panel {
    by_error(results, &group.name, "questions", |cell| {
        mean(cell, Run::questions)
    })
}

fn shares(results: &Results) -> Panel {
    by_error(results, "all languages", "ended equivalent, %", |cell| {
        if cell.is_empty() {
            return None;
        }
        let share = 100.0 * cell.count(|run| run.equivalent) as f64 / cell.len() as f64;
        Some(Point {
            value: share,
            low: share,
            high: share,
        })
    })
}
