//! `memrep bench tomita` and the other experiments on how many questions are
//! asked.

use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::Context as _;
use clap::builder::PossibleValuesParser;

use super::Out;
use crate::bench::{self, CONTENDERS, Contender, Experiment, Plan, Results};
use crate::cli::{files, output};
use crate::oracle::{Counterexamples, Order};

/// What all these experiments can be told.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:
  memrep bench tomita
  memrep bench tomita --quick --out /tmp/results
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
    /// The teacher's preference order: random for the robot and ordered for all
    /// others, where nothing is said.
    #[arg(long, value_name = "ORDER")]
    teacher: Option<Order>,
    /// How the teacher refutes a wrong hypothesis.
    #[arg(long, value_name = "KIND", default_value = "random")]
    counterexample: Counterexamples,
    /// Only these contenders; ratios need `thesis` among them.
    #[arg(long, value_name = "NAME,…", value_delimiter = ',', value_parser = PossibleValuesParser::new(CONTENDERS.iter().map(|c| c.key)))]
    strategy: Vec<String>,
    /// The runs at a time: one a core, where nothing is said.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    threads: Option<u16>,
    /// A Python that has AALpy, to run L*, KV and L# on the same targets.
    #[arg(long, value_name = "PYTHON")]
    aalpy: Option<PathBuf>,
    #[command(flatten)]
    out: Out,
}

/// Options of the experiments whose targets are drawn.
#[derive(Debug, clap::Args)]
pub(super) struct DrawnOptions {
    #[command(flatten)]
    options: Options,
    /// How many targets to draw: 30, where nothing is said.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=100_000))]
    targets: Option<u64>,
}

/// Runs an experiment with drawn targets.
pub(super) fn run_drawn(experiment: Experiment, args: &DrawnOptions) -> anyhow::Result<ExitCode> {
    run(experiment, &args.options, args.targets)
}

/// Runs an experiment and writes what came of it.
pub(super) fn run(
    experiment: Experiment,
    options: &Options,
    targets: Option<u64>,
) -> anyhow::Result<ExitCode> {
    if experiment == Experiment::Noise && options.aalpy.is_some() {
        anyhow::bail!("`--aalpy`: these rivals have no answer to wrong answers, leave it out");
    }
    options.out.prepare()?;
    let targets = targets.unwrap_or(Experiment::drawn_targets(options.quick));
    let plan = plan(experiment, options, targets)?;
    let threads = usize::from(options.threads.unwrap_or(0));
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build()
        .context("cannot start the threads: give fewer by `--threads`")?;
    let progress = super::bar(bench::size(&plan));
    let mut runs = pool.install(|| {
        bench::run(&plan, |run| {
            progress.set_message(plan.targets[run.target].name().to_owned());
            progress.inc(1);
        })
    })?;
    progress.finish_and_clear();
    if let Some(python) = &options.aalpy {
        let rivals =
            bench::run_rivals(&plan, python).with_context(|| python.display().to_string())?;
        runs.extend(rivals);
    }
    let command = command(&plan, options);
    let results = Results { plan, runs };
    let machine = super::machine(pool.current_num_threads());
    let file = |extension| {
        options
            .out
            .out
            .join(format!("{}.{extension}", experiment.name()))
    };
    files::write(&file("csv"), &bench::csv(&results)?)?;
    files::write(&file("svg"), &bench::figure(&results)?)?;
    let page = file("md");
    files::write(&page, &bench::markdown(&results, &command, &machine))?;
    let failures = results.failures();
    output::line(format!(
        "{} runs, {failures} of those with right answers not equivalent; see {}",
        results.runs.len(),
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
        anyhow::bail!(
            "none of these contenders takes part in `{}`: give some of {} by `--strategy`",
            experiment.name(),
            keys.join(", ")
        );
    }
    Ok(Plan {
        experiment,
        targets: experiment.targets(targets)?,
        contenders,
        costs: experiment.costs(),
        errors: experiment.errors(),
        seed: options.seed,
        trials: options.trials.unwrap_or(experiment.trials(options.quick)),
        order: options.teacher.unwrap_or(experiment.order()),
        counterexamples: options.counterexample,
    })
}

/// The command that does the same again, without what decides nothing.
fn command(plan: &Plan, options: &Options) -> String {
    use clap::ValueEnum as _;

    let mut command = format!("memrep bench {}", plan.experiment.name());
    let mut add = |name: &str, value: String| {
        command.push_str(&format!(" --{name} {value}"));
    };
    if plan.experiment.drawn().is_some() {
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
