//! `memrep bench`: runs an experiment and writes its tables.

mod passive;
mod thesis;

use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::Context as _;
use clap::Subcommand;
use indicatif::{ProgressBar, ProgressStyle};

/// Arguments of `memrep bench`.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// What to run.
    #[command(subcommand)]
    experiment: Experiment,
}

#[derive(Debug, Subcommand)]
enum Experiment {
    /// Chapter 5's targets at all costs: thesis.md and thesis.csv.
    Thesis(thesis::Args),
    /// Smallest automata for random samples, beside dfa-identify: identify.md.
    Identify(passive::Args),
}

/// Runs the command.
pub(crate) fn run(args: &Args) -> anyhow::Result<ExitCode> {
    match &args.experiment {
        Experiment::Thesis(args) => thesis::run(args),
        Experiment::Identify(args) => passive::run(args),
    }
}

/// Where an experiment writes.
#[derive(Debug, clap::Args)]
struct Out {
    /// Where to write the tables; made if it is not there.
    #[arg(long, value_name = "DIR", default_value = "docs/results")]
    out: PathBuf,
}

impl Out {
    /// Makes the folder: before the work, so that it is not lost on a folder
    /// that cannot be made.
    fn prepare(&self) -> anyhow::Result<()> {
        std::fs::create_dir_all(&self.out)
            .with_context(|| format!("{}: cannot make this folder", self.out.display()))
    }
}

/// A bar over so many runs, on the standard error.
fn bar(runs: u64) -> ProgressBar {
    let style = ProgressStyle::with_template("{bar:30} {pos}/{len} runs, {msg} ({eta} left)")
        .expect("the template is well formed");
    ProgressBar::new(runs).with_style(style)
}

/// What can be told of the machine without asking it much.
fn machine() -> String {
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let build = if cfg!(debug_assertions) {
        "a debug build"
    } else {
        "a release build"
    };
    let (os, arch) = (std::env::consts::OS, std::env::consts::ARCH);
    format!("{build} on {os} {arch}, {cores} cores, of which one is used")
}
