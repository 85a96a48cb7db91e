//! `memrep equivalent`.

use std::process::ExitCode;

/// Arguments of `memrep equivalent`.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {}

/// Runs the command.
pub(crate) fn run(_args: Args) -> anyhow::Result<ExitCode> {
    anyhow::bail!("not there yet")
}
