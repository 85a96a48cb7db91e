//! The runs of a plan, and the cells they make.

use std::time::Duration;

use super::contender::{BASE, RIVALS};
use super::experiment::{Experiment, Plan};
use super::run::Run;
use super::subject::Subject;
use super::summary::{self, Pairs, Ratio, Spread, Uncertainty};

/// A plan and all its runs.
#[derive(Clone, Debug)]
pub struct Results {
    /// What was to be done.
    pub plan: Plan,
    /// What came of it; those of rivals, if there are any, last.
    pub runs: Vec<Run>,
}

/// What a number is taken of.
pub type Measure = fn(&Run) -> f64;

/// Targets that share a row.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Group {
    /// What they are called.
    pub name: String,
    /// Their places in the plan.
    pub targets: Vec<usize>,
}

impl Results {
    /// The keys of everybody who has runs, in the order of the tables.
    pub fn columns(&self) -> Vec<&'static str> {
        let contenders = self.plan.contenders.iter().map(|contender| contender.key);
        let ran = |key: &&str| self.runs.iter().any(|run| run.contender == *key);
        let rivals = RIVALS.iter().map(|rival| rival.key).filter(ran);
        contenders.chain(rivals).collect()
    }

    /// Every target for itself; those that were drawn by their number of states.
    pub fn groups(&self) -> Vec<Group> {
        let targets = &self.plan.targets;
        if self.plan.experiment == Experiment::Monotone {
            return vec![Group {
                name: format!("all {} concepts", targets.len()),
                ..self.everything()
            }];
        }
        if !self.plan.experiment.is_drawn() {
            let group = |(place, target): (usize, &Subject)| Group {
                name: target.name().to_owned(),
                targets: vec![place],
            };
            return targets.iter().enumerate().map(group).collect();
        }
        let mut sizes: Vec<usize> = targets.iter().map(Subject::size).collect();
        sizes.sort_unstable();
        sizes.dedup();
        let group = |size| Group {
            name: format!("{size} states"),
            targets: (0..targets.len())
                .filter(|&place| targets[place].size() == size)
                .collect(),
        };
        sizes.into_iter().map(group).collect()
    }

    /// All targets together.
    pub fn everything(&self) -> Group {
        Group {
            name: "all".to_owned(),
            targets: (0..self.plan.targets.len()).collect(),
        }
    }

    /// The runs on these targets.
    pub fn cell<'a>(
        &'a self,
        group: &'a Group,
        contender: &'a str,
        cost: Option<u32>,
        errors: u32,
    ) -> Cell<'a> {
        let fits = |run: &&Run| {
            run.contender == contender
                && run.cost == cost
                && run.errors == errors
                && group.targets.contains(&run.target)
        };
        Cell {
            runs: self.runs.iter().filter(fits).collect(),
        }
    }

    /// What a contender pays at a cost, in right answers, against what another
    /// does, on the targets on which both have runs; none if there are none, or the
    /// other never pays.
    pub fn ratio(
        &self,
        contender: &str,
        base: &str,
        cost: Option<u32>,
        measure: Measure,
    ) -> Option<Ratio> {
        let single = |target| Group {
            name: String::new(),
            targets: vec![target],
        };
        // Some concepts of a monotone family are learned by equivalence queries
        // alone, and over nothing there is no ratio: all of them are one target.
        let groups = match self.plan.experiment {
            Experiment::Monotone => vec![self.everything()],
            _ => (0..self.plan.targets.len()).map(single).collect(),
        };
        let targets: Vec<Pairs> = groups
            .iter()
            .map(|group| {
                let ours = self.cell(group, contender, cost, 0);
                let theirs = self.cell(group, base, cost, 0);
                // The runs of a cell are in the order of their seeds.
                let costs = |cell: &Cell<'_>| cell.values(measure);
                costs(&ours).into_iter().zip(costs(&theirs)).collect()
            })
            .filter(|pairs: &Pairs| !pairs.is_empty())
            .collect();
        let uncertainty = if groups.len() > 1 && self.plan.experiment.is_drawn() {
            Uncertainty::TargetsAndRuns
        } else {
            Uncertainty::Runs
        };
        summary::ratio(&targets, uncertainty)
    }

    /// The same against [`BASE`].
    pub fn against_base(
        &self,
        contender: &str,
        cost: Option<u32>,
        measure: Measure,
    ) -> Option<Ratio> {
        self.ratio(contender, BASE, cost, measure)
    }

    /// The runs whose teacher did not err and that did not learn their target.
    pub fn failures(&self) -> usize {
        let failed = |run: &&Run| run.errors == 0 && !run.equivalent;
        self.runs.iter().filter(failed).count()
    }

    /// The CPU times of choosing a question, in right and wrong answers.
    pub fn question_times(&self, group: &Group, contender: &str) -> Vec<Duration> {
        let fits = |run: &&Run| run.contender == contender && group.targets.contains(&run.target);
        let times = |run: &Run| run.question_times.clone();
        self.runs.iter().filter(fits).flat_map(times).collect()
    }
}

/// The runs that share everything but target and seed.
#[derive(Clone, Debug)]
pub struct Cell<'a> {
    runs: Vec<&'a Run>,
}

impl Cell<'_> {
    /// Mean and standard deviation; none for no runs. Over several targets, the
    /// targets' differences are part of it.
    pub fn spread(&self, measure: Measure) -> Option<Spread> {
        summary::spread(&self.values(measure))
    }

    /// How many of the runs this holds for.
    pub fn count(&self, holds: fn(&Run) -> bool) -> usize {
        self.runs.iter().filter(|run| holds(run)).count()
    }

    /// How many runs there are.
    pub fn len(&self) -> usize {
        self.runs.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.runs.is_empty()
    }

    fn values(&self, measure: Measure) -> Vec<f64> {
        self.runs.iter().map(|run| measure(run)).collect()
    }
}
