//! `memrep bench`: runs an experiment and writes its tables.

mod passive;
#[cfg(feature = "server")]
mod serve;
mod suite;

use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::Context as _;
use clap::Subcommand;
use indicatif::{ProgressBar, ProgressStyle};

use crate::bench::Experiment;

/// Arguments of `memrep bench`.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// What to run.
    #[command(subcommand)]
    experiment: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Tomita's seven languages (Tables 5.1 to 5.3, Fig. 5.4).
    Tomita(suite::Options),
    /// Lengths divisible by a number (Table 5.4).
    Modulo(suite::Options),
    /// Tomita's fourth language, generalised (Table 5.5).
    Zeros(suite::Options),
    /// The robot's task (Fig. 5.3, left).
    Robot(suite::Options),
    /// Wrong answers (Fig. 5.5).
    Noise(suite::NoiseOptions),
    /// Targets drawn at random: 3 to 8 states, 2 to 4 letters.
    Random(suite::DrawnOptions),
    /// Targets drawn at random in the shape of tasks.
    Tasks(suite::DrawnOptions),
    /// Monotone predicates (Fig. 5.3, right).
    Monotone(suite::DrawnOptions),
    /// Smallest automata for random samples, beside dfa-identify: identify.md.
    Identify(passive::Args),
    /// Scripted people over real HTTP, at a server of their own: serve.md.
    #[cfg(feature = "server")]
    Serve(serve::Args),
}

/// Runs the command.
pub(crate) fn run(args: &Args) -> anyhow::Result<ExitCode> {
    match &args.experiment {
        Command::Tomita(options) => suite::run_named(Experiment::Tomita, options),
        Command::Modulo(options) => suite::run_named(Experiment::Modulo, options),
        Command::Zeros(options) => suite::run_named(Experiment::Zeros, options),
        Command::Robot(options) => suite::run_named(Experiment::Robot, options),
        Command::Noise(options) => suite::run_noise(options),
        Command::Random(options) => suite::run_drawn(Experiment::Random, options),
        Command::Tasks(options) => suite::run_drawn(Experiment::Tasks, options),
        Command::Monotone(options) => suite::run_drawn(Experiment::Monotone, options),
        Command::Identify(args) => passive::run(args),
        #[cfg(feature = "server")]
        Command::Serve(args) => serve::run(args),
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

/// What can be told of the machine without asking it much, and how many of its
/// cores are used.
fn machine(used: usize) -> String {
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let build = if cfg!(debug_assertions) {
        "a debug build"
    } else {
        "a release build"
    };
    let (os, arch) = (std::env::consts::OS, std::env::consts::ARCH);
    format!("{build} on {os} {arch}, {cores} cores, {used} of them used")
}
