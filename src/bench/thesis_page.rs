//! The runs of [`super::thesis`] as a table beside the published ones.

use std::fmt::Write as _;
use std::time::Duration;

use super::published::{self, Published};
use super::thesis::{COSTS, Run, TARGETS};
use super::trial::percentile;

/// The runs of one target at one cost.
struct Cell<'a> {
    runs: Vec<&'a Run>,
}

impl<'a> Cell<'a> {
    fn new(runs: &'a [Run], target: &str, cost: Option<u32>) -> Self {
        let fits = |run: &&Run| run.target == target && run.cost == cost;
        Self {
            runs: runs.iter().filter(fits).collect(),
        }
    }

    fn mean(&self, count: impl Fn(&Run) -> u32) -> f64 {
        let sum: f64 = self.runs.iter().map(|run| f64::from(count(run))).sum();
        sum / self.runs.len() as f64
    }

    /// Mean and standard deviation (of the sample).
    fn spread(&self, count: impl Fn(&Run) -> u32) -> String {
        let mean = self.mean(&count);
        let squares = self
            .runs
            .iter()
            .map(|run| (f64::from(count(run)) - mean).powi(2));
        let degrees = self.runs.len().saturating_sub(1).max(1) as f64;
        let deviation = (squares.sum::<f64>() / degrees).sqrt();
        format!("{mean:.1} ± {deviation:.1}")
    }

    /// Eq. 5.2 on the means.
    fn cost(&self, membership: u32) -> f64 {
        f64::from(membership) * self.mean(|r| r.counts.membership)
            + self.mean(|r| r.counts.comparison)
    }
}

/// One line a run: counts only, so that the same seeds give the same bytes.
pub fn csv(runs: &[Run]) -> String {
    let mut csv = String::from(
        "target,membership_cost,seed,equivalent,membership,comparison,equivalence,hurried\n",
    );
    for run in runs {
        let cost = run.cost.map_or("inf".to_owned(), |cost| cost.to_string());
        let Run {
            target,
            seed,
            equivalent,
            counts,
            hurried,
            ..
        } = run;
        let _ = writeln!(
            csv,
            "{target},{cost},{seed},{equivalent},{},{},{},{hurried}",
            counts.membership, counts.comparison, counts.equivalence
        );
    }
    csv
}

/// The page, as Markdown. `command` is what was run and `machine` where; only
/// the last section, on time, differs between runs with the same seeds.
pub fn markdown(runs: &[Run], trials: u64, command: &str, machine: &str) -> String {
    let mut page = String::new();
    let equivalent = runs.iter().filter(|run| run.equivalent).count();
    let _ = write!(
        page,
        "# Chapter 5's tables, with the strategy `thesis`

`{command}`, seeds 0 to {last}; {machine}.

{equivalent} of {all} runs ended equivalent to their target. {ratios}

The targets and the teacher's order are the dissertation's as we read it, and the
experts' temperature was chosen with these targets in view, so the table shows
that the algorithm was understood and not that it is better than its authors'.
`thesis` is Tables 5.1 and 5.3 (Tomita), 5.4 (`modulo`) and 5.5 (`zeros`);
`generalize` and `main` are runs of the two branches of its authors' public code,
which had random counterexamples and few trials in the slow cells. Tomita 3 in the
dissertation is most likely the three-state language `tomita:3t`; here it is the
usual five-state one, as in the runs of the authors' code. The `robot` row has a
random order and random counterexamples, all others the described order and
shortest counterexamples. `C` is the cost of a membership query where a
comparison costs 1, and `–` means that comparisons are never asked.

Cells are membership queries + comparisons / equivalence queries, means over
{trials} runs (± standard deviation for ours).

",
        last = trials.saturating_sub(1),
        all = runs.len(),
        ratios = ratios(runs),
    );
    page.push_str("| target | C | membership | comparisons | equivalence | thesis | `generalize` | `main` |\n");
    page.push_str("|---|---|---|---|---|---|---|---|\n");
    for target in TARGETS {
        for cost in COSTS {
            let cell = Cell::new(runs, target, cost);
            let published = published::on(target, cost);
            let _ = writeln!(
                page,
                "| {target} | {} | {} | {} | {:.1} | {} | {} | {} |",
                cost.map_or("–".to_owned(), |cost| cost.to_string()),
                cell.spread(|run| run.counts.membership),
                cell.spread(|run| run.counts.comparison),
                cell.mean(|run| run.counts.equivalence),
                published.map_or(String::new(), |p| format!(
                    "{:.1} + {:.1}",
                    p.thesis[0], p.thesis[1]
                )),
                measured(published.and_then(|p| p.generalize)),
                measured(published.and_then(|p| p.main)),
            );
        }
    }
    page.push_str(&times(runs));
    page
}

fn measured(counts: Option<[f64; 3]>) -> String {
    counts.map_or(String::new(), |[membership, comparison, equivalence]| {
        format!("{membership:.1} + {comparison:.1} / {equivalence:.1}")
    })
}

/// The mean cost against the dissertation's, over the Tomita languages.
fn ratios(runs: &[Run]) -> String {
    let ratio = |cost: u32| {
        let tomita: Vec<f64> = TARGETS
            .iter()
            .filter(|target| target.starts_with("tomita:"))
            .filter_map(|target| {
                let published: &Published = published::on(target, Some(cost))?;
                let [membership, comparison] = published.thesis;
                let theirs = f64::from(cost) * membership + comparison;
                Some(Cell::new(runs, target, Some(cost)).cost(cost) / theirs)
            })
            .collect();
        let logarithms: f64 = tomita.iter().map(|ratio| ratio.ln()).sum();
        (logarithms / tomita.len() as f64).exp()
    };
    let ratios: Vec<String> = COSTS
        .iter()
        .flatten()
        .map(|&cost| format!("{:.2} at C = {cost}", ratio(cost)))
        .collect();
    format!(
        "The cost of membership queries and
comparisons (Eq. 5.2) over that of Tables 5.1 and 5.3, as a geometric mean over the
seven Tomita languages: {}.",
        ratios.join(", ")
    )
}

fn times(runs: &[Run]) -> String {
    let milliseconds = |times: &[Duration], percent| {
        format!("{:.2}", percentile(times, percent).as_secs_f64() * 1e3)
    };
    let line = |name: &str, times: &[Duration]| {
        format!(
            "| {name} | {} | {} | {} | {} |\n",
            times.len(),
            milliseconds(times, 50),
            milliseconds(times, 95),
            milliseconds(times, 100)
        )
    };
    let of = |target: Option<&str>| -> Vec<Duration> {
        runs.iter()
            .filter(|run| target.is_none_or(|target| run.target == target))
            .flat_map(|run| run.question_times.iter().copied())
            .collect()
    };
    let mut section = String::from(
        "
## CPU time of choosing a question

In milliseconds. The authors' code took 11 to 690 on the Tomita languages
(`generalize`) on a machine of the same kind.

| target | questions | median | 95 % within | most |
|---|---|---|---|---|
",
    );
    for target in TARGETS {
        section.push_str(&line(target, &of(Some(target))));
    }
    section.push_str(&line("all", &of(None)));
    section
}
