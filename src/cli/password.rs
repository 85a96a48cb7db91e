//! `memrep password`: sets the owner's password, or removes it. It is typed, or comes
//! by a pipe: what is in arguments or in the environment, others can read.

use std::io::{BufRead as _, IsTerminal as _, Read as _, Write as _};
use std::process::ExitCode;

use anyhow::{Context as _, bail};
use clap::ArgMatches;

use super::{database, output, settings};
use crate::server::hash_password;

/// More than any password has.
const MOST_BYTES: u64 = 4096;

/// Arguments of `memrep password`.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:
  memrep password
  memrep password --database lab.db
  pass show memrep | memrep password
  memrep password --remove

The password is asked for twice and not shown; if something is piped in, its first
line is the password. It has 8 characters or more, best 15. All visits end with it: the
owner's, and those of invited people, who come back by their links.")]
pub(super) struct Args {
    /// Remove the password: only this machine is served then.
    #[arg(long)]
    remove: bool,
    #[command(flatten)]
    _which: database::Which,
}

/// Runs the command, given how it was called.
pub(super) fn run(args: &Args, flags: &ArgMatches) -> anyhow::Result<ExitCode> {
    let database = database::named(flags)?;
    let named = settings::masked(&database);
    let is_new = database::is_missing(&database);
    if args.remove {
        if is_new {
            bail!("{named}: there is no such database: name one with --database");
        }
        let store = database::open(&database)?;
        if store.visits().password()?.is_none() {
            output::line(format!(
                "{named} has no owner's password: nothing was changed."
            ))?;
            return Ok(ExitCode::SUCCESS);
        }
        store.visits().set_password(None)?;
        output::done(format_args!(
            "The owner's password of {named} is removed. All visits have ended."
        ));
        return Ok(ExitCode::SUCCESS);
    }
    let hash = hash_password(&ask()?)?;
    let store = database::open(&database)?;
    store.visits().set_password(Some(&hash))?;
    let new = if is_new { ", a new database," } else { "" };
    output::done(format_args!(
        "The owner's password of {named}{new} is set. All visits have ended."
    ));
    Ok(ExitCode::SUCCESS)
}

/// The password, as it is typed or piped in.
fn ask() -> anyhow::Result<String> {
    if std::io::stdin().is_terminal() {
        at_terminal()
    } else {
        line()
    }
}

fn line() -> anyhow::Result<String> {
    let mut line = String::new();
    let mut input = std::io::stdin().lock().take(MOST_BYTES);
    let read = input.read_line(&mut line);
    read.context("no password could be read from standard input")?;
    let line = line.strip_suffix('\n').unwrap_or(&line);
    Ok(line.strip_suffix('\r').unwrap_or(line).to_owned())
}

/// What is typed twice and not shown.
#[cfg(unix)]
fn at_terminal() -> anyhow::Result<String> {
    use rustix::termios::{LocalModes, OptionalActions, SpecialCodeIndex, tcgetattr, tcsetattr};
    let input = std::io::stdin();
    let shown = tcgetattr(&input).context("the terminal does not say how it is set")?;
    let mut hidden = shown.clone();
    // Every key comes here, also the one that would end the program in between: the
    // terminal would then never show again what is typed.
    hidden
        .local_modes
        .remove(LocalModes::ECHO | LocalModes::ICANON | LocalModes::ISIG);
    hidden.special_codes[SpecialCodeIndex::VMIN] = 1;
    hidden.special_codes[SpecialCodeIndex::VTIME] = 0;
    tcsetattr(&input, OptionalActions::Flush, &hidden).context("the terminal cannot hide")?;
    let asked =
        unseen("New password: ").and_then(|first| Ok((first, unseen("The same once more: ")?)));
    let back = tcsetattr(&input, OptionalActions::Flush, &shown);
    back.context("the terminal does not show what is typed again: `stty sane` mends that")?;
    let (first, second) = asked?;
    if first != second {
        bail!("the two passwords differ, so nothing was changed: try again");
    }
    Ok(first)
}

/// A line of keys from a terminal that does nothing by itself.
#[cfg(unix)]
fn unseen(prompt: &str) -> anyhow::Result<String> {
    const INTERRUPT: u8 = 0x03;
    const END: u8 = 0x04;
    const BACKSPACE: u8 = 0x08;
    const CLEAR: u8 = 0x15;
    const DELETE: u8 = 0x7f;
    let mut screen = std::io::stderr();
    write!(screen, "{prompt}")?;
    screen.flush()?;
    let mut typed: Vec<u8> = Vec::new();
    let mut keys = std::io::stdin().lock().take(MOST_BYTES).bytes();
    let ended = loop {
        match keys.next().transpose().context("the terminal is gone")? {
            None | Some(INTERRUPT) => break false,
            Some(END) if typed.is_empty() => break false,
            Some(b'\n' | b'\r') => break true,
            Some(BACKSPACE | DELETE) => {
                // A whole character, of however many bytes.
                while typed.pop().is_some_and(|byte| byte & 0xc0 == 0x80) {}
            }
            Some(CLEAR) => typed.clear(),
            Some(byte) => typed.push(byte),
        }
    };
    output::note("");
    if !ended {
        bail!("no password was given, so nothing was changed");
    }
    String::from_utf8(typed).context("what was typed is no text in UTF-8: nothing was changed")
}

/// There is no way to hide it here.
#[cfg(not(unix))]
fn at_terminal() -> anyhow::Result<String> {
    bail!("pipe the password in: what is typed cannot be hidden here");
}
