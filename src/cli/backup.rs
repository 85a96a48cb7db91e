//! `memrep backup`: a copy of the database, made while a server writes.

use std::borrow::Cow;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Duration;

use anyhow::{Context as _, bail};
use clap::ArgMatches;
use serde_json::json;

use super::database;
use super::output::{self, Output, counted};
use crate::store::{Checked, back_up, now, partial_of};

/// Arguments of `memrep backup`.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:
  memrep backup
  memrep backup --database lab.db --to /var/backups/memrep --keep 30
  memrep backup --to before-the-study.db

The copy is whole and was checked when its name is printed. A folder keeps the
last ones that were made of this database, and nothing of one that was killed
more than a day ago; a file is never replaced.

Exit status: 0 if the backup is there, 2 if not.")]
pub(super) struct Args {
    #[command(flatten)]
    _which: database::Which,
    /// A folder, in which the backup is named by the time, or a new file; a name without
    /// an ending such as `.db` is a folder, which is made if it is not there.
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

/// Runs the command, given how it was called.
pub(super) fn run(args: &Args, flags: &ArgMatches) -> anyhow::Result<ExitCode> {
    let database = database::named(flags)?;
    if database::is_elsewhere(&database) {
        bail!(
            "a PostgreSQL database is backed up by its own tools: pg_dump --format=custom --file=memrep.dump 'ADDRESS', and pg_restore puts it back"
        );
    }
    let database = Path::new(&database);
    let is_folder = args.to.is_dir() || !args.to.exists() && is_named_as_folder(&args.to);
    let (path, checked, removed) = if is_folder {
        into_folder(database, &args.to, args.keep.into())?
    } else {
        (args.to.clone(), back_up(database, &args.to)?, Vec::new())
    };
    match args.format {
        Output::Text => {
            output::done(path.display());
            output::note(format_args!(
                "{} with {}; every page is whole, and no log has a gap",
                counted(checked.sessions, "session", "sessions"),
                counted(checked.entries, "entry", "entries"),
            ));
        }
        Output::Json => output::done(json!({
            "path": path,
            "sessions": checked.sessions,
            "entries": checked.entries,
            "version": checked.version,
            "removed": removed,
        })),
    }
    Ok(ExitCode::SUCCESS)
}

/// Whether somebody who writes this means a folder, which need not be there yet.
fn is_named_as_folder(path: &Path) -> bool {
    let text = path.as_os_str().to_string_lossy();
    path.extension().is_none() || text.ends_with(std::path::is_separator)
}

/// A backup named by the time; earlier ones beyond the last `keep` go.
fn into_folder(
    database: &Path,
    folder: &Path,
    keep: usize,
) -> anyhow::Result<(PathBuf, Checked, Vec<PathBuf>)> {
    let is_new = !folder.exists();
    fs::create_dir_all(folder)
        .with_context(|| format!("{}: the folder cannot be made", folder.display()))?;
    let stem = database
        .file_stem()
        .context("--database names no file")?
        .to_string_lossy();
    let at = now()?;
    // Of several in one second the number tells which came later: one that was given
    // and removed is not given again.
    let earlier = dated_in(folder, &stem)?;
    let last = earlier
        .iter()
        .filter(|old| old.at == at)
        .map(|old| old.number);
    let path = match last.max() {
        None => folder.join(format!("{stem}-{at}.db")),
        Some(last) => folder.join(format!("{stem}-{at}.db.{}", last + 1)),
    };
    let checked = back_up(database, &path).inspect_err(|_| {
        if is_new {
            // It was made for this one.
            let _ = fs::remove_dir(folder);
        }
    })?;
    let mut made = dated_in(folder, &stem)?;
    made.sort_unstable();
    let surplus = made.len().saturating_sub(keep);
    let mut removed = Vec::new();
    let surplus = made.into_iter().take(surplus).map(|old| old.path);
    let surplus = surplus.chain(abandoned_in(folder, &stem)?);
    for old in surplus.filter(|old| *old != path) {
        fs::remove_file(&old)
            .with_context(|| format!("{}: it cannot be removed", old.display()))?;
        removed.push(old);
    }
    Ok((path, checked, removed))
}

/// A backup that nobody wrote to for so long is not being made any more.
const ABANDONED: Duration = Duration::from_secs(24 * 60 * 60);

/// A backup by its name, in the order in which they were made.
#[derive(Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Dated {
    at: String,
    /// Which it is of that second, from 1.
    number: u64,
    path: PathBuf,
}

/// The backups of this database in the folder.
fn dated_in(folder: &Path, stem: &str) -> anyhow::Result<Vec<Dated>> {
    let mut found = Vec::new();
    for path in files_in(folder)? {
        if let Some((at, number)) = date(&name_of(&path), stem) {
            let at = at.to_owned();
            found.push(Dated { at, number, path });
        }
    }
    Ok(found)
}

/// What is left of backups of this database that were killed in the middle. Others may
/// be made right now, so these are older.
fn abandoned_in(folder: &Path, stem: &str) -> anyhow::Result<Vec<PathBuf>> {
    let is_abandoned = |path: &PathBuf| {
        let name = name_of(path);
        let of_this = partial_of(&name).is_some_and(|whole| date(whole, stem).is_some());
        let written = || fs::metadata(path)?.modified();
        of_this && written().is_ok_and(|at| at.elapsed().is_ok_and(|since| since > ABANDONED))
    };
    let mut files = files_in(folder)?;
    files.retain(is_abandoned);
    Ok(files)
}

fn files_in(folder: &Path) -> anyhow::Result<Vec<PathBuf>> {
    let cannot = || format!("{}: the folder cannot be read", folder.display());
    let files = fs::read_dir(folder).with_context(cannot)?;
    (files.map(|file| Ok(file.with_context(cannot)?.path()))).collect()
}

fn name_of(path: &Path) -> Cow<'_, str> {
    path.file_name().unwrap_or_default().to_string_lossy()
}

/// When a backup was made by its name, `memrep-20260131T120000Z.db`, or the same with
/// a number, and that number; none where a file has another name.
fn date<'a>(name: &'a str, stem: &str) -> Option<(&'a str, u64)> {
    let rest = name.strip_prefix(stem)?.strip_prefix('-')?;
    let (date, ending) = rest.split_at_checked("20260131T120000Z".len())?;
    let fits = |(place, byte): (usize, u8)| match place {
        8 => byte == b'T',
        15 => byte == b'Z',
        _ => byte.is_ascii_digit(),
    };
    let number = match ending.strip_prefix(".db")? {
        "" => 1,
        more => {
            let digits = more.strip_prefix('.')?;
            let is_number = digits.bytes().all(|byte| byte.is_ascii_digit());
            // The one after the largest has a name too.
            let number: u32 = digits.parse().ok().filter(|_| is_number)?;
            number.into()
        }
    };
    date.bytes().enumerate().all(fits).then_some((date, number))
}

#[cfg(test)]
mod tests {
    use super::date;

    #[test]
    fn only_backups_of_the_same_database_are_counted() {
        for (name, number) in [
            ("lab-20260131T120000Z.db", 1),
            ("lab-20260131T120000Z.db.2", 2),
            ("lab-20260131T120000Z.db.10", 10),
        ] {
            let found = date(name, "lab");
            assert_eq!(found, Some(("20260131T120000Z", number)), "{name}");
        }
        for name in [
            "lab.db",
            "lab-20260131T120000Z",
            "lab-20260131T120000Z.db-wal",
            "lab-20260131T120000Z.db.old",
            "lab-20260131T120000Z.db.",
            "lab-20260131T120000Z.db.+3",
            "lab-2026013xT120000Z.db",
            "lab-b-20260131T120000Z.db",
            "other-20260131T120000Z.db",
            "lab-ä",
        ] {
            assert_eq!(date(name, "lab"), None, "{name}");
        }
    }
}
