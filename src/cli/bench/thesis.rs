//! `memrep bench thesis`: chapter 5's targets at all costs.

use std::process::ExitCode;

use super::Out;
use crate::bench::{thesis, thesis_page};
use crate::cli::{files, output};

/// Arguments of `memrep bench thesis`.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:
  memrep bench thesis
  memrep bench thesis --trials 3 --out /tmp/results

Exit status: 0 if every run learned its target, 1 if one did not, 2 if the
arguments are at fault or a file cannot be written.")]
pub(super) struct Args {
    /// How many runs a cell, with the seeds from 0.
    #[arg(long, value_name = "N", default_value = "20", value_parser = clap::value_parser!(u64).range(1..))]
    trials: u64,
    #[command(flatten)]
    out: Out,
}

pub(super) fn run(args: &Args) -> anyhow::Result<ExitCode> {
    args.out.prepare()?;
    let all = (thesis::TARGETS.len() * thesis::COSTS.len()) as u64 * args.trials;
    let progress = super::bar(all);
    let runs = thesis::run(args.trials, |run| {
        progress.set_message(run.target);
        progress.inc(1);
    })?;
    progress.finish_and_clear();
    let command = format!("memrep bench thesis --trials {}", args.trials);
    let page = thesis_page::markdown(&runs, args.trials, &command, &super::machine());
    let out = &args.out.out;
    files::write(&out.join("thesis.md"), &page)?;
    files::write(&out.join("thesis.csv"), &thesis_page::csv(&runs))?;
    let failed = runs.iter().filter(|run| !run.equivalent).count();
    output::line(format!(
        "{} runs, {failed} of them not equivalent; see {}",
        runs.len(),
        out.join("thesis.md").display()
    ))?;
    Ok(ExitCode::from(u8::from(failed > 0)))
}
