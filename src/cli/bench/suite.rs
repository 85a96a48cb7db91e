//! `memrep bench tomita` and the other experiments on how many questions are
//! asked.

use std::num::NonZeroUsize;
use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::{Context as _, bail};
use clap::builder::PossibleValuesParser;

use super::Out;
use crate::bench::{self, CONTENDERS, Contender, Experiment, Plan, Results};
use crate::cli::{files, output};
use crate::oracle::{Counterexamples, Order};

/// What all these experiments can be told.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:
  memrep bench tomita
  memrep bench tomita --quick --out results
  memrep bench tomita --trials 5 --seed 100 --strategy bayes,thesis
  memrep bench random --targets 10 --trials 2 --counterexample shortest
  memrep bench tomita --aalpy venv/bin/python

NAME.md, NAME.csv and NAME.svg are written, with NAME as the experiment's. The
same command gives the same bytes, but for the last section of NAME.md, on times.

Exit status: 0 if every run with right answers learned its target, 1 if one did
not, 2 if the arguments are at fault or a file cannot be written.")]
pub(super) struct Options {
    /// The runs of a cell: 20, and 5 for drawn targets, where nothing is said.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=100_000))]
    trials: Option<u64>,
    /// Few runs, so that it takes less than two minutes on two cores.
    #[arg(long)]
    quick: bool,
    /// The seed of the first run of a cell; the others follow.
    #[arg(long, value_name = "N", default_value_t = 0)]
    seed: u64,
    /// The teacher's preference order: random for the robot and `monotone` and
    /// ordered for all others, where nothing is said.
    #[arg(long, value_name = "ORDER")]
    teacher: Option<Order>,
    /// How the teacher refutes a wrong hypothesis.
    #[arg(long, value_name = "KIND", default_value = "random")]
    counterexample: Counterexamples,
    /// Only these contenders; ratios need `thesis` among them.
    #[arg(long, value_name = "NAME,…", value_delimiter = ',', value_parser = PossibleValuesParser::new(CONTENDERS.iter().map(|c| c.key)))]
    strategy: Vec<String>,
    /// Only these costs of a membership query, where a comparison costs 1; `none`
    /// is no cost but that comparisons are never asked.
    #[arg(long, value_name = "C,…", value_delimiter = ',', value_parser = cost)]
    costs: Vec<Cost>,
    /// The runs at a time: one a core, where nothing is said.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    threads: Option<u16>,
    /// A Python that has `AALpy`, to run L*, KV and L# on the same targets.
    #[arg(long, value_name = "PYTHON")]
    aalpy: Option<PathBuf>,
    #[command(flatten)]
    out: Out,
}

/// A cost of a membership query; none where comparisons are never asked.
#[derive(Clone, Copy, Debug)]
struct Cost(Option<u32>);

fn cost(text: &str) -> Result<Cost, String> {
    match text.parse::<u32>() {
        Ok(cost) if cost > 0 => Ok(Cost(Some(cost))),
        _ if text == "none" => Ok(Cost(None)),
        _ => Err("give whole numbers from 1, or `none`".to_owned()),
    }
}

/// Options of the experiment on wrong answers.
#[derive(Debug, clap::Args)]
pub(super) struct NoiseOptions {
    #[command(flatten)]
    options: Options,
    /// The shares of wrong answers, in percent: 0,2,5,10,20 where nothing is
    /// said; without 0 there is nothing to compare with.
    #[arg(long, value_name = "PERCENT,…", value_delimiter = ',',
          value_parser = clap::value_parser!(u32).range(0..=50))]
    errors: Vec<u32>,
}

/// Options of the experiments whose targets are drawn.
#[derive(Debug, clap::Args)]
pub(super) struct DrawnOptions {
    #[command(flatten)]
    options: Options,
    /// How many targets to draw: 30, and 100 for `monotone`, where nothing is said.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=100_000))]
    targets: Option<u64>,
}

/// Runs an experiment with drawn targets.
pub(super) fn run_drawn(experiment: Experiment, args: &DrawnOptions) -> anyhow::Result<ExitCode> {
    if experiment == Experiment::Monotone && args.options.aalpy.is_some() {
        bail!("`--aalpy`: these rivals learn automata, leave it out");
    }
    let targets = experiment.drawn_targets(args.options.quick);
    let targets = args.targets.unwrap_or(targets);
    run(plan(experiment, &args.options, targets)?, &args.options)
}

/// Runs the experiment on wrong answers.
pub(super) fn run_noise(args: &NoiseOptions) -> anyhow::Result<ExitCode> {
    if args.options.aalpy.is_some() {
        bail!("`--aalpy`: these rivals have no answer to wrong answers, leave it out");
    }
    if args.options.costs.len() > 1 {
        bail!("`--costs`: this experiment has one cost, give one");
    }
    let mut plan = plan(Experiment::Noise, &args.options, 0)?;
    if !args.errors.is_empty() {
        plan.errors.clone_from(&args.errors);
    }
    plan.errors.sort_unstable();
    plan.errors.dedup();
    run(plan, &args.options)
}

/// Runs an experiment whose targets have names.
pub(super) fn run_named(experiment: Experiment, options: &Options) -> anyhow::Result<ExitCode> {
    run(plan(experiment, options, 0)?, options)
}

/// Runs an experiment and writes what came of it.
fn run(plan: Plan, options: &Options) -> anyhow::Result<ExitCode> {
    options.out.prepare()?;
    if let Some(python) = &options.aalpy {
        bench::find_rivals(python).with_context(|| python.display().to_string())?;
    }
    let cores = std::thread::available_parallelism().unwrap_or(NonZeroUsize::MIN);
    let threads = options.threads.map_or(cores, |threads| {
        NonZeroUsize::new(threads.into()).unwrap_or(NonZeroUsize::MIN)
    });
    let progress = super::bar(bench::size(&plan));
    let mut runs = bench::run(&plan, threads, |run| {
        progress.set_message(plan.targets[run.target].name().to_owned());
        progress.inc(1);
    })?;
    progress.finish_and_clear();
    if let Some(python) = &options.aalpy {
        let rivals =
            bench::run_rivals(&plan, python).with_context(|| python.display().to_string())?;
        runs.extend(rivals);
    }
    let command = command(&plan, options);
    let results = Results { plan, runs };
    let machine = super::machine(threads.get());
    let file = |extension| {
        options
            .out
            .out
            .join(format!("{}.{extension}", results.plan.experiment.name()))
    };
    files::write(&file("csv"), &bench::csv(&results)?)?;
    files::write(&file("svg"), &bench::figure(&results)?)?;
    let page = file("md");
    files::write(&page, &bench::markdown(&results, &command, &machine))?;
    let failures = results.failures();
    let right = results.runs.iter().filter(|run| run.errors == 0).count();
    output::line(format!(
        "{} of {right} runs{} ended equivalent; see {}",
        right - failures,
        if right < results.runs.len() {
            " without wrong answers"
        } else {
            ""
        },
        page.display()
    ))?;
    Ok(ExitCode::from(u8::from(failures > 0)))
}

fn plan(experiment: Experiment, options: &Options, targets: u64) -> anyhow::Result<Plan> {
    let chosen = |contender: &&Contender| {
        options.strategy.is_empty() || options.strategy.iter().any(|key| key == contender.key)
    };
    let contenders: Vec<_> = experiment.contenders().into_iter().filter(chosen).collect();
    if contenders.is_empty() {
        let keys: Vec<_> = experiment.contenders().iter().map(|c| c.key).collect();
        bail!(
            "none of these contenders takes part in `{}`: give some of {} by `--strategy`",
            experiment.name(),
            keys.join(", ")
        );
    }
    Ok(Plan {
        experiment,
        targets: experiment.targets(targets)?,
        contenders,
        costs: if options.costs.is_empty() {
            experiment.costs()
        } else {
            options.costs.iter().map(|cost| cost.0).collect()
        },
        errors: experiment.errors(options.quick),
        seed: options.seed,
        trials: options.trials.unwrap_or(experiment.trials(options.quick)),
        order: options.teacher.unwrap_or(experiment.order()),
        counterexamples: options.counterexample,
    })
}

/// The command that does the same again, without what decides nothing.
fn command(plan: &Plan, options: &Options) -> String {
    use std::fmt::Write as _;

    use clap::ValueEnum as _;

    let mut command = format!("memrep bench {}", plan.experiment.name());
    let mut add = |name: &str, value: String| {
        let _ = write!(command, " --{name} {value}");
    };
    if plan.experiment.is_drawn() {
        add("targets", plan.targets.len().to_string());
    }
    add("trials", plan.trials.to_string());
    add("seed", plan.seed.to_string());
    let named = |value: Option<clap::builder::PossibleValue>| {
        value.map_or(String::new(), |value| value.get_name().to_owned())
    };
    add("teacher", named(plan.order.to_possible_value()));
    add(
        "counterexample",
        named(plan.counterexamples.to_possible_value()),
    );
    if plan.experiment == Experiment::Noise {
        let errors: Vec<_> = plan.errors.iter().map(u32::to_string).collect();
        add("errors", errors.join(","));
    }
    if !options.costs.is_empty() {
        let costs = plan.costs.iter();
        let costs = costs.map(|cost| cost.map_or("none".to_owned(), |cost| cost.to_string()));
        add("costs", costs.collect::<Vec<_>>().join(","));
    }
    if !options.strategy.is_empty() {
        let keys: Vec<_> = plan
            .contenders
            .iter()
            .map(|contender| contender.key)
            .collect();
        add("strategy", keys.join(","));
    }
    if options.aalpy.is_some() {
        add("aalpy", "PYTHON".to_owned());
    }
    command
}
