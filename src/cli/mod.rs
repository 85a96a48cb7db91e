//! The commands of the `memrep` binary: one file a command.
//!
//! Results go to stdout, progress and errors to stderr. The exit status is 0
//! for done, 1 where the answer is "no", 2 for bad input or usage.

#[cfg(feature = "server")]
mod backup;
mod bench;
#[cfg(feature = "server")]
mod config;
mod convert;
#[cfg(feature = "server")]
mod database;
mod equivalent;
mod files;
mod identify;
mod learn;
#[cfg(feature = "server")]
mod log;
mod output;
#[cfg(feature = "server")]
mod password;
mod replay;
#[cfg(feature = "server")]
mod restore;
#[cfg(feature = "server")]
mod serve;
#[cfg(feature = "server")]
mod settings;
mod task;

use std::process::ExitCode;

pub use replay::read_log;

use clap::{CommandFactory as _, FromArgMatches as _, Parser, Subcommand};

/// Learns a formal task specification from comparisons and membership answers.
#[derive(Debug, Parser)]
#[command(
    name = "memrep",
    version,
    about,
    args_conflicts_with_subcommands = true
)]
struct Cli {
    #[command(subcommand)]
    command: Option<Command>,
    #[cfg(feature = "server")]
    #[command(flatten)]
    serve: serve::Args,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Serve the pages and the API (also what `memrep` alone does).
    #[cfg(feature = "server")]
    Serve(serve::Args),
    /// Tell the settings that `serve` would run with, and where each comes from.
    #[cfg(feature = "server")]
    Config(config::Args),
    /// Set the owner's password, without which nobody else's machine is served.
    #[cfg(feature = "server")]
    Password(password::Args),
    /// Copy the database while a server writes to it.
    #[cfg(feature = "server")]
    Backup(backup::Args),
    /// Put a backup in the place of the database.
    #[cfg(feature = "server")]
    Restore(restore::Args),
    /// Learn a target from a scripted teacher.
    Learn(learn::Args),
    /// Find the smallest automaton consistent with a sample.
    Identify(identify::Args),
    /// Compare the languages of two automata.
    Equivalent(equivalent::Args),
    /// Convert automata and samples between file formats.
    Convert(convert::Args),
    /// Rebuild a session from its log, and check that nothing in it is made up.
    Replay(replay::Args),
    /// Check task files, and write new ones.
    Task(task::Args),
    /// Run an experiment and write its tables.
    Bench(bench::Args),
}

/// Parses the command line, runs the command, and reports what went wrong.
pub fn main() -> ExitCode {
    let given = Cli::command().try_get_matches();
    let given = given.unwrap_or_else(|error| refuse(&error));
    let cli = Cli::from_arg_matches(&given);
    let cli = cli.unwrap_or_else(|error| refuse(&error.format(&mut Cli::command())));
    // Which flags were given, and not only what holds, is for the settings to know.
    #[cfg(feature = "server")]
    let flags = given.subcommand().map_or(&given, |(_, flags)| flags);
    let result = match cli.command {
        Some(Command::Learn(args)) => learn::run(&args),
        Some(Command::Identify(args)) => identify::run(&args),
        Some(Command::Equivalent(args)) => equivalent::run(&args),
        Some(Command::Convert(args)) => convert::run(&args),
        Some(Command::Replay(args)) => replay::run(&args),
        Some(Command::Task(args)) => task::run(&args),
        Some(Command::Bench(args)) => bench::run(&args),
        #[cfg(feature = "server")]
        Some(Command::Backup(args)) => backup::run(&args, flags),
        #[cfg(feature = "server")]
        Some(Command::Restore(args)) => restore::run(&args, flags),
        #[cfg(feature = "server")]
        Some(Command::Config(args)) => config::run(&args, flags),
        #[cfg(feature = "server")]
        Some(Command::Password(args)) => password::run(&args, flags),
        #[cfg(feature = "server")]
        Some(Command::Serve(_)) | None => serve::run(flags),
        #[cfg(not(feature = "server"))]
        None => {
            let _ = Cli::command().print_help();
            return ExitCode::from(2);
        }
    };
    result.unwrap_or_else(|error| {
        if output::is_closed(&error) {
            // Whoever reads has seen enough, as `head` does.
            return ExitCode::SUCCESS;
        }
        output::note(format_args!("error: {error:#}"));
        ExitCode::from(2)
    })
}

/// Says what is wrong with the arguments, or gives the help that they ask for, and ends.
fn refuse(error: &clap::Error) -> ! {
    #[cfg(feature = "server")]
    if let Some(told) = settings::without_passwords(error) {
        output::note(told.trim_end());
        std::process::exit(error.exit_code());
    }
    error.exit()
}
