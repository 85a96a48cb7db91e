//! `memrep backup`: a copy of the database, made while a server writes.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::{Context as _, bail};
use serde_json::json;

use super::database;
use super::output::{self, Output, counted};
use crate::store::{Checked, back_up, free_name, now};

/// Arguments of `memrep backup`.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:
  memrep backup
  memrep backup --database lab.db --to /var/backups/memrep --keep 30
  memrep backup --to before-the-study.db

The copy is whole and was checked when its name is printed. A folder keeps the
last ones that were made of this database; a file is never replaced.

Exit status: 0 if the backup is there, 2 if not.")]
pub(crate) struct Args {
    /// The database file.
    #[arg(long, value_name = "PATH", default_value_t = database::usual())]
    database: String,
    /// A folder, in which the backup is named by the time, or a new file.
    #[arg(long, value_name = "DIR|FILE", default_value = "backups")]
    to: PathBuf,
    /// How many backups a folder keeps of this database.
    #[arg(long, value_name = "NUMBER", default_value_t = 7,
          value_parser = clap::value_parser!(u16).range(1..))]
    keep: u16,
    /// For people, or one JSON object.
    #[arg(long, value_enum, default_value_t)]
    format: Output,
}

/// Runs the command.
pub(crate) fn run(args: &Args) -> anyhow::Result<ExitCode> {
    if database::is_elsewhere(&args.database) {
        bail!(
            "a PostgreSQL database is backed up by its own tools: pg_dump --format=custom --file=memrep.dump 'ADDRESS', and pg_restore puts it back"
        );
    }
    let database = Path::new(&args.database);
    let is_folder = args.to.is_dir() || args.to == Path::new("backups") || ends_as_folder(&args.to);
    let (path, checked, removed) = if is_folder {
        into_folder(database, &args.to, args.keep.into())?
    } else {
        (args.to.clone(), back_up(database, &args.to)?, Vec::new())
    };
    match args.format {
        Output::Text => {
            output::line(path.display())?;
            eprintln!(
                "{} with {}; whole and sound",
                counted(checked.sessions, "session", "sessions"),
                counted(checked.entries, "entry", "entries"),
            );
        }
        Output::Json => output::line(json!({
            "path": path,
            "sessions": checked.sessions,
            "entries": checked.entries,
            "version": checked.version,
            "removed": removed,
        }))?,
    }
    Ok(ExitCode::SUCCESS)
}

fn ends_as_folder(path: &Path) -> bool {
    path.as_os_str()
        .to_string_lossy()
        .ends_with(std::path::is_separator)
}

/// A backup named by the time; earlier ones beyond the last `keep` go.
fn into_folder(
    database: &Path,
    folder: &Path,
    keep: usize,
) -> anyhow::Result<(PathBuf, Checked, Vec<PathBuf>)> {
    fs::create_dir_all(folder)
        .with_context(|| format!("{}: the folder cannot be made", folder.display()))?;
    let stem = database
        .file_stem()
        .context("--database names no file")?
        .to_string_lossy();
    let at = now()?;
    let named = folder.join(format!("{stem}-{at}.db"));
    let path = if named.exists() {
        // Two in one second.
        free_name(&named.display().to_string())
    } else {
        named
    };
    let checked = back_up(database, &path)?;
    let mut made = earlier(folder, &stem)?;
    // Their names are in the order of their times.
    made.sort_unstable();
    let surplus = made.len().saturating_sub(keep);
    let mut removed = Vec::new();
    for old in made.into_iter().take(surplus).filter(|old| *old != path) {
        fs::remove_file(&old)
            .with_context(|| format!("{}: it cannot be removed", old.display()))?;
        removed.push(old);
    }
    Ok((path, checked, removed))
}

/// The backups of this database in the folder.
fn earlier(folder: &Path, stem: &str) -> anyhow::Result<Vec<PathBuf>> {
    let files = fs::read_dir(folder)
        .with_context(|| format!("{}: the folder cannot be read", folder.display()))?;
    let mut found = Vec::new();
    for file in files {
        let path = file.context("the folder cannot be read")?.path();
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        if is_dated(&name, stem) {
            found.push(path);
        }
    }
    Ok(found)
}

/// Whether a file has the name of a backup: `memrep-20260131T120000Z.db`, or the
/// same with a number.
fn is_dated(name: &str, stem: &str) -> bool {
    let Some(rest) = name
        .strip_prefix(stem)
        .and_then(|rest| rest.strip_prefix('-'))
    else {
        return false;
    };
    let Some((date, number)) = rest.split_at_checked("20260131T120000Z".len()) else {
        return false;
    };
    let fits = |(place, byte): (usize, u8)| match place {
        8 => byte == b'T',
        15 => byte == b'Z',
        _ => byte.is_ascii_digit(),
    };
    let is_number = |text: &str| text.bytes().all(|byte| byte.is_ascii_digit());
    let is_ours = match number.strip_prefix(".db") {
        Some("") => true,
        Some(rest) => rest.strip_prefix('.').is_some_and(is_number),
        None => false,
    };
    is_ours && date.bytes().enumerate().all(fits)
}

#[cfg(test)]
mod tests {
    use super::is_dated;

    #[test]
    fn only_backups_of_the_same_database_are_counted() {
        for name in ["lab-20260131T120000Z.db", "lab-20260131T120000Z.db.2"] {
            assert!(is_dated(name, "lab"), "{name}");
        }
        for name in [
            "lab.db",
            "lab-20260131T120000Z",
            "lab-20260131T120000Z.db-wal",
            "lab-20260131T120000Z.db.old",
            "lab-2026013xT120000Z.db",
            "lab-b-20260131T120000Z.db",
            "other-20260131T120000Z.db",
            "lab-ä",
        ] {
            assert!(!is_dated(name, "lab"), "{name}");
        }
    }
}
