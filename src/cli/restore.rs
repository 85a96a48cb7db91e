//! `memrep restore`: a backup in the place of the database.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::bail;
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
pub(crate) struct Args {
    /// The backup.
    #[arg(value_name = "BACKUP")]
    backup: PathBuf,
    /// The database file that is to be made of it.
    #[arg(long, value_name = "PATH", default_value_t = database::usual())]
    database: String,
    /// Replace a database that is there.
    #[arg(long)]
    force: bool,
    /// For people, or one JSON object.
    #[arg(long, value_enum, default_value_t)]
    format: Output,
}

/// Runs the command.
pub(crate) fn run(args: &Args) -> anyhow::Result<ExitCode> {
    if database::is_elsewhere(&args.database) {
        bail!(
            "a PostgreSQL database is put back by its own tools: pg_restore --clean --if-exists --dbname='ADDRESS' memrep.dump"
        );
    }
    let database = Path::new(&args.database);
    let (checked, aside) = restore(&args.backup, database, args.force)?;
    match args.format {
        Output::Text => {
            output::line(database.display())?;
            eprintln!(
                "{} with {}; whole and sound",
                counted(checked.sessions, "session", "sessions"),
                counted(checked.entries, "entry", "entries"),
            );
            if let Some(aside) = aside {
                eprintln!("what was there is kept as {}", aside.display());
            }
        }
        Output::Json => output::line(json!({
            "path": database,
            "sessions": checked.sessions,
            "entries": checked.entries,
            "version": checked.version,
            "kept": aside,
        }))?,
    }
    Ok(ExitCode::SUCCESS)
}
