//! `memrep password`: sets the owner's password, or removes it. It is typed, or comes
//! by a pipe: what is in arguments or in the environment, others can read.

use std::io::{BufRead as _, IsTerminal as _, Read as _, Write as _};
use std::process::ExitCode;

use anyhow::{Context as _, bail};
use clap::ArgMatches;

use super::{database, serve, settings};
use crate::server::hash_password;

/// More than any password has.
const MOST_BYTES: u64 = 4096;

/// Arguments of `memrep password`, and the settings of the server, of which the
/// database counts.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:
  memrep password
  memrep password --database lab.db
  pass show memrep | memrep password
  memrep password --remove

The password is asked for twice and not shown; if something is piped in, its first
line is the password. It has 8 characters or more, best 15. All visits end with it: the
owner's, and those of invited people, who come back by their links.")]
#[group(skip)]
pub(super) struct Args {
    /// Remove the password: only this machine is served then.
    #[arg(long)]
    remove: bool,
    #[command(flatten)]
    _serve: serve::Args,
}

/// Runs the command, given how it was called.
pub(super) fn run(args: &Args, flags: &ArgMatches) -> anyhow::Result<ExitCode> {
    let (serve, _) = settings::resolve::<serve::Args>(flags)?;
    let hash = if args.remove {
        None
    } else {
        Some(hash_password(&ask()?)?)
    };
    let store = database::open(&serve.database)?;
    store.visits().set_password(hash.as_deref())?;
    let done = if args.remove { "removed" } else { "set" };
    let named = settings::masked(&serve.database);
    println!("The owner's password of {named} is {done}. All visits have ended.");
    Ok(ExitCode::SUCCESS)
}

/// The password, as it is typed or piped in.
fn ask() -> anyhow::Result<String> {
    let input = std::io::stdin();
    if !input.is_terminal() {
        return line();
    }
    let first = unseen("New password: ")?;
    if first != unseen("The same once more: ")? {
        bail!("the two passwords differ, so nothing was changed: try again");
    }
    Ok(first)
}

fn line() -> anyhow::Result<String> {
    let mut line = String::new();
    let mut input = std::io::stdin().lock().take(MOST_BYTES);
    let read = input.read_line(&mut line);
    read.context("no password could be read from standard input")?;
    let line = line.strip_suffix('\n').unwrap_or(&line);
    Ok(line.strip_suffix('\r').unwrap_or(line).to_owned())
}

/// A line that is typed and not shown.
#[cfg(unix)]
fn unseen(prompt: &str) -> anyhow::Result<String> {
    use rustix::termios::{LocalModes, OptionalActions, tcgetattr, tcsetattr};
    let input = std::io::stdin();
    eprint!("{prompt}");
    std::io::stderr().flush()?;
    let shown = tcgetattr(&input).context("the terminal does not say how it is set")?;
    let mut hidden = shown.clone();
    hidden.local_modes.remove(LocalModes::ECHO);
    tcsetattr(&input, OptionalActions::Flush, &hidden).context("the terminal cannot hide")?;
    let typed = line();
    let back = tcsetattr(&input, OptionalActions::Flush, &shown);
    eprintln!();
    back.context("the terminal does not show what is typed again: `stty echo` mends that")?;
    typed
}

/// There is no way to hide it here.
#[cfg(not(unix))]
fn unseen(_: &str) -> anyhow::Result<String> {
    bail!("pipe the password in: what is typed cannot be hidden here");
}
