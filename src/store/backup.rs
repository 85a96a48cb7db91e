//! Copies of a database file: made while a server writes, checked, put back.
//!
//! A copy is `SQLite`'s own (`VACUUM INTO`), never one of the file, which without
//! its write-ahead log is only a part of the database.

use std::fs::{self, File, OpenOptions, Permissions};
use std::io::{self, ErrorKind};
#[cfg(unix)]
use std::os::unix::fs::{OpenOptionsExt as _, PermissionsExt as _};
use std::path::{Path, PathBuf};
use std::time::Duration;

use rusqlite::{Connection, ErrorCode, OpenFlags};

use super::{SessionId, StoreError, schema};

/// How long a copy waits for a writer.
const WAIT: Duration = Duration::from_secs(5);

/// What is in a backup that was found to be sound.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Checked {
    /// The version of its tables.
    pub version: i64,
    /// How many sessions it has.
    pub sessions: u64,
    /// How many entries their logs have.
    pub entries: u64,
}

/// Copies the database to the new file `to`, which is there whole and sound
/// afterwards, or not at all; a server may write meanwhile.
///
/// # Errors
///
/// If there is no such database, `to` is there already or cannot be written, or the
/// database is damaged.
pub fn back_up(database: &Path, to: &Path) -> Result<Checked, StoreError> {
    if !database.exists() {
        return Err(fault(
            database,
            "there is no such database: name one with --database",
        ));
    }
    if to.exists() {
        return Err(fault(to, "it is there already: choose another name"));
    }
    let copy = Partial::beside(to)?;
    copy.fill_from(database)?;
    let checked = check_backup(&copy.path)?;
    copy.become_file(to)?;
    Ok(checked)
}

/// Whether a backup can be relied on: a memrep database of a version that can be
/// read, of which every page is sound and no log has a gap.
///
/// # Errors
///
/// If not, and why.
pub fn check_backup(path: &Path) -> Result<Checked, StoreError> {
    let connection = open(path)?;
    let unusable = |error: rusqlite::Error| damaged(path, &error);
    let text = |sql: &str| -> Result<String, StoreError> {
        let first = connection.query_row(sql, [], |row| row.get(0));
        first.map_err(unusable)
    };
    let found = text("PRAGMA integrity_check(1)")?;
    if found != "ok" {
        return Err(fault(
            path,
            format!("it is damaged ({found}): take another backup"),
        ));
    }
    let gap = connection
        .prepare(
            "SELECT id, 0 FROM sessions
             WHERE NOT EXISTS (SELECT 1 FROM entries WHERE session = id AND seq = 0)
             UNION ALL
             SELECT session, seq + 1 FROM
                 (SELECT session, seq, lead(seq) OVER (PARTITION BY session ORDER BY seq) AS next
                  FROM entries)
             WHERE next <> seq + 1
             LIMIT 1",
        )
        .and_then(|mut statement| {
            let row = |row: &rusqlite::Row<'_>| Ok((row.get::<_, String>(0)?, row.get(1)?));
            statement.query_map([], row)?.next().transpose()
        })
        .map_err(unusable)?;
    if let Some((session, seq)) = gap {
        let session: SessionId = session
            .parse()
            .map_err(|_| fault(path, "a session in it has no proper name"))?;
        let seq: i64 = seq;
        return Err(fault(
            path,
            format!("entry {seq} of session {session:?} is missing: take another backup"),
        ));
    }
    let number = |sql: &str| -> Result<i64, StoreError> {
        let first = connection.query_row(sql, [], |row| row.get(0));
        first.map_err(unusable)
    };
    Ok(Checked {
        version: number("PRAGMA user_version")?,
        sessions: number("SELECT count(*) FROM sessions")?.cast_unsigned(),
        entries: number("SELECT count(*) FROM entries")?.cast_unsigned(),
    })
}

/// Puts a backup in the place of the database. One that is there already is kept
/// under another name, which is returned, if `force`, and else nothing is done.
///
/// # Errors
///
/// If the backup is not sound, a server has the database open, or it is there and
/// not to be replaced; nothing has changed then.
pub fn restore(
    backup: &Path,
    database: &Path,
    force: bool,
) -> Result<(Checked, Option<PathBuf>), StoreError> {
    let checked = check_backup(backup)?;
    if let Some(message) = schema::no_file(database) {
        return Err(fault(database, message));
    }
    // Behind a link lies the database, with what belongs to it.
    let behind = fs::canonicalize(database);
    let database = match &behind {
        Ok(behind) => behind.as_path(),
        Err(_) if database.is_symlink() => {
            return Err(fault(database, "it is a link to nothing: remove it first"));
        }
        Err(_) => database,
    };
    let is_there = fs::metadata(database).is_ok_and(|file| file.len() > 0);
    if is_there && !force {
        return Err(fault(
            database,
            "there is a database already: name another with --database, or say --force to replace it (it is kept beside, under another name)",
        ));
    }
    let copy = Partial::beside(database)?;
    copy.fill_from(backup)?;
    check_backup(&copy.path)?;
    let mut aside = None;
    let mut lock = None;
    if is_there {
        lock = hold_alone(database)?;
        let kept = free_name(&format!("{}.before-restore-{}", database.display(), now()?));
        move_aside(database, &kept)?;
        aside = Some(kept);
    } else if with_suffix(database, "-wal").exists() || with_suffix(database, "-shm").exists() {
        // What is left of a database that is gone would be taken for a part of this.
        let kept = free_name(&format!("{}.left-{}", database.display(), now()?));
        move_aside(database, &kept)?;
        aside = Some(kept);
    }
    copy.become_file(database)?;
    drop(lock);
    Ok((checked, aside))
}

/// Keeps a copy beside a database of an earlier version that is about to be brought
/// up to date, unless there is one of it.
pub(super) fn before_upgrade(
    connection: &Connection,
    path: &Path,
    version: i64,
) -> Result<(), StoreError> {
    let usual = PathBuf::from(format!("{}.v{version}-backup", path.display()));
    if !usual.exists() {
        return back_up(path, &usual).map(drop);
    }
    // An upgrade that failed is tried again at every start, and is to keep one copy.
    let kept = open(&usual).and_then(|kept| Ok(outline(&kept)?));
    if kept.is_ok_and(|kept| outline(connection).is_ok_and(|now| now == kept)) {
        return Ok(());
    }
    let other = free_name(&format!("{}-{}", usual.display(), now()?));
    back_up(path, &other).map(drop)
}

/// The time in UTC, as a part of a file's name: `20260131T120000Z`.
///
/// # Errors
///
/// If `SQLite` fails.
pub(crate) fn now() -> Result<String, StoreError> {
    let clock = Connection::open_in_memory()?;
    Ok(
        clock.query_row("SELECT strftime('%Y%m%dT%H%M%SZ', 'now')", [], |row| {
            row.get(0)
        })?,
    )
}

/// This name, or one made of it that no file has yet.
fn free_name(name: &str) -> PathBuf {
    let more = (2..).map(|number| PathBuf::from(format!("{name}.{number}")));
    let mut names = std::iter::once(PathBuf::from(name)).chain(more);
    names
        .find(|name| !name.exists())
        .expect("there are more numbers than files")
}

/// What tells a database from another one of the same version.
fn outline(connection: &Connection) -> rusqlite::Result<(i64, Option<String>)> {
    connection.query_row("SELECT count(*), max(at) FROM entries", [], |row| {
        Ok((row.get(0)?, row.get(1)?))
    })
}

/// Opens a database of ours to read it.
fn open(path: &Path) -> Result<Connection, StoreError> {
    if let Some(message) = schema::no_file(path) {
        return Err(fault(path, message));
    }
    let unusable = |error: rusqlite::Error| damaged(path, &error);
    let flags = OpenFlags::SQLITE_OPEN_READ_ONLY | OpenFlags::SQLITE_OPEN_NO_MUTEX;
    let connection = Connection::open_with_flags(path, flags).map_err(unusable)?;
    connection.busy_timeout(WAIT).map_err(unusable)?;
    let shown = path.display().to_string();
    schema::check_header(&connection, &shown, unusable)?;
    let version: i64 = connection
        .pragma_query_value(None, "user_version", |row| row.get(0))
        .map_err(unusable)?;
    if version == 0 {
        return Err(fault(path, "it has no sessions: it is an empty file"));
    }
    Ok(connection)
}

/// Waits until nobody else has the database open, which also writes its log into it;
/// nobody can open it while the connection is there. None where it is damaged.
fn hold_alone(database: &Path) -> Result<Option<Connection>, StoreError> {
    let flags = OpenFlags::SQLITE_OPEN_READ_WRITE | OpenFlags::SQLITE_OPEN_NO_MUTEX;
    let alone = Connection::open_with_flags(database, flags).and_then(|connection| {
        connection.busy_timeout(Duration::from_millis(200))?;
        // Only a connection that is alone may leave the write-ahead log.
        let query = |row: &rusqlite::Row<'_>| row.get(0);
        let mode: String = connection.query_row("PRAGMA journal_mode = DELETE", [], query)?;
        if mode == "delete" {
            connection.execute_batch("BEGIN EXCLUSIVE")?;
        }
        Ok((connection, mode))
    });
    let held = || {
        let message = "a server has it open: stop that first";
        Err(fault(database, message))
    };
    match alone {
        Ok((connection, mode)) if mode == "delete" => Ok(Some(connection)),
        Ok(_) => held(),
        Err(error) => match error.sqlite_error_code() {
            Some(ErrorCode::DatabaseBusy | ErrorCode::DatabaseLocked) => held(),
            // It is to be replaced because it cannot be read any more.
            Some(ErrorCode::DatabaseCorrupt | ErrorCode::NotADatabase) => Ok(None),
            _ => Err(damaged(database, &error)),
        },
    }
}

/// Gives a database another name, with what belongs to it.
fn move_aside(database: &Path, kept: &Path) -> Result<(), StoreError> {
    for suffix in ["-wal", "-shm", "-journal", ""] {
        let from = with_suffix(database, suffix);
        match fs::rename(&from, with_suffix(kept, suffix)) {
            Err(error) if error.kind() != ErrorKind::NotFound => {
                return Err(fault(&from, format!("it cannot be set aside: {error}")));
            }
            _ => {}
        }
    }
    Ok(())
}

fn with_suffix(path: &Path, suffix: &str) -> PathBuf {
    let mut name = path.as_os_str().to_owned();
    name.push(suffix);
    name.into()
}

/// Between the name of a file and the number of what is not whole yet.
const PARTIAL: &str = ".partial-";

/// The name that a file would have got which was not whole yet; none of others.
pub fn partial_of(name: &str) -> Option<&str> {
    let (whole, number) = name.rsplit_once(PARTIAL)?;
    let is_number = number.len() == 16 && number.bytes().all(|digit| digit.is_ascii_hexdigit());
    is_number.then_some(whole)
}

/// A file that is not whole yet; goes away unless it becomes one.
struct Partial {
    path: PathBuf,
}

impl Partial {
    fn beside(to: &Path) -> Result<Self, StoreError> {
        // Not by the process: in a container all have the same number, and one that was
        // killed leaves its file behind.
        let number = getrandom::u64().map_err(|error| fault(to, error.to_string()))?;
        let path = with_suffix(to, &format!("{PARTIAL}{number:016x}"));
        let mut new = OpenOptions::new();
        // Nobody else may read what may become unreadable for them.
        #[cfg(unix)]
        new.mode(0o600);
        match new.write(true).create_new(true).open(&path) {
            Ok(_) => Ok(Self { path }),
            Err(error) => Err(fault(
                &path,
                format!(
                    "it cannot be written: {error}; check that its folder exists and may be written to"
                ),
            )),
        }
    }

    fn fill_from(&self, database: &Path) -> Result<(), StoreError> {
        let source = open(database)?;
        let cannot = |error: io::Error| self.fault(&error);
        let Some(name) = self.path.to_str() else {
            return Err(fault(&self.path, "its name is no text: choose another"));
        };
        source.execute("VACUUM INTO ?1", [name])?;
        let file = OpenOptions::new().write(true).open(&self.path);
        let rights = fs::metadata(database).map(|file| owned(file.permissions()));
        file.and_then(|file| {
            // Whoever may not read the sessions may not read their copy.
            file.set_permissions(rights?)?;
            file.sync_all()
        })
        .map_err(cannot)
    }

    fn become_file(self, to: &Path) -> Result<(), StoreError> {
        fs::rename(&self.path, to).map_err(|error| self.fault(&error))?;
        let folder = match to.parent() {
            Some(folder) if !folder.as_os_str().is_empty() => folder,
            _ => Path::new("."),
        };
        // Some systems cannot sync a folder; there the name may be lost with the power.
        if let Ok(folder) = File::open(folder) {
            let _ = folder.sync_all();
        }
        Ok(())
    }

    fn fault(&self, error: &io::Error) -> StoreError {
        fault(&self.path, format!("it cannot be written: {error}"))
    }
}

impl Drop for Partial {
    fn drop(&mut self) {
        // Gone already where it became a file.
        let _ = fs::remove_file(&self.path);
    }
}

/// The same rights, with which the owner can also write: a backup may be one that
/// nobody was to change, and is put back to go on.
#[cfg(unix)]
fn owned(mut rights: Permissions) -> Permissions {
    rights.set_mode(rights.mode() | 0o600);
    rights
}

#[cfg(not(unix))]
fn owned(mut rights: Permissions) -> Permissions {
    rights.set_readonly(false);
    rights
}

fn fault(path: &Path, message: impl Into<String>) -> StoreError {
    StoreError::Backup {
        path: path.display().to_string(),
        message: message.into(),
    }
}

fn damaged(path: &Path, error: &rusqlite::Error) -> StoreError {
    let why = match error.sqlite_error_code() {
        Some(ErrorCode::NotADatabase) => "it is not an SQLite file".to_owned(),
        Some(ErrorCode::CannotOpen) => "it cannot be opened: check that it is there".to_owned(),
        Some(ErrorCode::DatabaseCorrupt) => "it is damaged: take another backup".to_owned(),
        _ => error.to_string(),
    };
    fault(path, why)
}
