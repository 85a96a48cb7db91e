//! `memrep bench`: runs an experiment and writes its tables.

use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::Context as _;
use clap::ValueEnum;
use indicatif::{ProgressBar, ProgressStyle};

use super::{files, output};
use crate::bench::{thesis, thesis_page};

/// Arguments of `memrep bench`.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:
  memrep bench thesis
  memrep bench thesis --trials 3 --out /tmp/results

Exit status: 0 if every run learned its target, 1 if one did not, 2 if the
arguments are at fault or a file cannot be written.")]
pub(crate) struct Args {
    /// What to run.
    experiment: Experiment,
    /// How many runs a cell, with the seeds from 0.
    #[arg(long, value_name = "N", default_value = "20", value_parser = clap::value_parser!(u64).range(1..))]
    trials: u64,
    /// Where to write the tables; made if it is not there.
    #[arg(long, value_name = "DIR", default_value = "docs/results")]
    out: PathBuf,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Experiment {
    /// Chapter 5's targets at all costs: thesis.md and thesis.csv.
    Thesis,
}

/// Runs the command.
pub(crate) fn run(args: &Args) -> anyhow::Result<ExitCode> {
    match args.experiment {
        Experiment::Thesis => thesis(args),
    }
}

fn thesis(args: &Args) -> anyhow::Result<ExitCode> {
    // Before the work, so that it is not lost on a folder that cannot be made.
    std::fs::create_dir_all(&args.out)
        .with_context(|| format!("{}: cannot make this folder", args.out.display()))?;
    let all = (thesis::TARGETS.len() * thesis::COSTS.len()) as u64 * args.trials;
    let style = ProgressStyle::with_template("{bar:30} {pos}/{len} runs, {msg} ({eta} left)")
        .expect("the template is well formed");
    let progress = ProgressBar::new(all).with_style(style);
    let runs = thesis::run(args.trials, |run| {
        progress.set_message(run.target);
        progress.inc(1);
    })?;
    progress.finish_and_clear();
    let command = format!("memrep bench thesis --trials {}", args.trials);
    let page = thesis_page::markdown(&runs, args.trials, &command, &machine());
    files::write(&args.out.join("thesis.md"), &page)?;
    files::write(&args.out.join("thesis.csv"), &thesis_page::csv(&runs))?;
    let failed = runs.iter().filter(|run| !run.equivalent).count();
    output::line(format!(
        "{} runs, {failed} of them not equivalent; see {}",
        runs.len(),
        args.out.join("thesis.md").display()
    ))?;
    Ok(ExitCode::from(u8::from(failed > 0)))
}

/// What can be told of the machine without asking it much.
fn machine() -> String {
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let build = if cfg!(debug_assertions) {
        "a debug build"
    } else {
        "a release build"
    };
    format!(
        "{build} on {} {}, {cores} cores, of which one is used",
        std::env::consts::OS,
        std::env::consts::ARCH
    )
}
