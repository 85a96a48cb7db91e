//! `memrep restore`: a backup in the place of the database.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::bail;
use clap::ArgMatches;
use serde_json::json;

use super::database;
use super::output::{self, Output, counted};
use crate::store::restore;

/// Arguments of `memrep restore`.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:
  memrep restore backups/memrep-20260131T120000Z.db
  memrep restore --force --database lab.db lab-20260131T120000Z.db

The backup is checked first and stays where it is. A database that it replaces is
kept beside, under another name.

Exit status: 0 if the database is there, 2 if nothing was changed.")]
pub(super) struct Args {
    /// The backup.
    #[arg(value_name = "BACKUP")]
    backup: PathBuf,
    #[command(flatten)]
    _which: database::Which,
    /// Replace a database that is there.
    #[arg(long)]
    force: bool,
    /// For people, or one JSON object.
    #[arg(long, value_enum, default_value_t)]
    format: Output,
}

/// Runs the command, given how it was called.
pub(super) fn run(args: &Args, flags: &ArgMatches) -> anyhow::Result<ExitCode> {
    let database = database::named(flags)?;
    if database::is_elsewhere(&database) {
        bail!(
            "a PostgreSQL database is put back by its own tools: pg_restore --clean --if-exists --dbname='ADDRESS' memrep.dump"
        );
    }
    let database = Path::new(&database);
    let (checked, aside) = restore(&args.backup, database, args.force)?;
    match args.format {
        Output::Text => {
            output::done(database.display());
            output::note(format_args!(
                "{} with {}; every page is whole, and no log has a gap",
                counted(checked.sessions, "session", "sessions"),
                counted(checked.entries, "entry", "entries"),
            ));
            if let Some(aside) = aside {
                output::note(format_args!(
                    "what was there is kept as {}",
                    aside.display()
                ));
            }
        }
        Output::Json => output::done(json!({
            "path": database,
            "sessions": checked.sessions,
            "entries": checked.entries,
            "version": checked.version,
            "kept": aside,
        })),
    }
    Ok(ExitCode::SUCCESS)
}
