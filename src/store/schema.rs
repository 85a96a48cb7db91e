//! The tables, and how those of an earlier version become those of this one.

use std::fs;
use std::path::Path;

use rusqlite::{Connection, Transaction, TransactionBehavior};

use super::StoreError;

/// "MemR": says in the file's header whose it is.
const APPLICATION: i64 = 0x4d65_6d52;
/// The schema's version, in the file's header.
const VERSION: i64 = 4;

/// What makes each version out of the one before, from version 1. A step that
/// was released is never changed.
const STEPS: [&str; VERSION as usize] = [
    "
CREATE TABLE sessions (
    id TEXT PRIMARY KEY
) STRICT, WITHOUT ROWID;
CREATE TABLE entries (
    session TEXT NOT NULL REFERENCES sessions (id),
    seq INTEGER NOT NULL CHECK (seq >= 0),
    at TEXT NOT NULL DEFAULT (strftime('%Y-%m-%dT%H:%M:%fZ', 'now')),
    body TEXT NOT NULL,
    PRIMARY KEY (session, seq)
) STRICT, WITHOUT ROWID;
",
    // Files are cut into rows, so that no row of megabytes is ever in memory.
    "
CREATE TABLE uploads (
    id TEXT PRIMARY KEY,
    at TEXT NOT NULL DEFAULT (strftime('%Y-%m-%dT%H:%M:%fZ', 'now'))
) STRICT, WITHOUT ROWID;
CREATE TABLE files (
    upload TEXT NOT NULL REFERENCES uploads (id),
    number INTEGER NOT NULL CHECK (number >= 0),
    name TEXT NOT NULL,
    kind TEXT NOT NULL,
    size INTEGER NOT NULL CHECK (size >= 0),
    PRIMARY KEY (upload, number),
    UNIQUE (upload, name)
) STRICT, WITHOUT ROWID;
CREATE TABLE chunks (
    upload TEXT NOT NULL,
    file INTEGER NOT NULL,
    place INTEGER NOT NULL CHECK (place >= 0),
    bytes BLOB NOT NULL,
    PRIMARY KEY (upload, file, place),
    FOREIGN KEY (upload, file) REFERENCES files (upload, number)
) STRICT;
ALTER TABLE sessions ADD COLUMN upload TEXT REFERENCES uploads (id);
",
    // A person has one link at a time; of the link only its digest is kept.
    "
CREATE TABLE invites (
    session TEXT NOT NULL REFERENCES sessions (id),
    person INTEGER NOT NULL CHECK (person > 0),
    digest TEXT NOT NULL UNIQUE,
    at TEXT NOT NULL DEFAULT (strftime('%Y-%m-%dT%H:%M:%fZ', 'now')),
    PRIMARY KEY (session, person)
) STRICT, WITHOUT ROWID;
",
    // A visit names its invitation by the digest, which a new link replaces: with the
    // old link end its visits. Times are seconds since 1970.
    "
CREATE TABLE owner (
    only INTEGER PRIMARY KEY CHECK (only = 1),
    password TEXT NOT NULL
) STRICT;
CREATE TABLE visits (
    digest TEXT PRIMARY KEY,
    invite TEXT,
    begun INTEGER NOT NULL,
    seen INTEGER NOT NULL
) STRICT, WITHOUT ROWID;
CREATE INDEX visits_by_time ON visits (begun);
",
];

/// Why no database can be at this path, if there is something that is no file.
pub(super) fn no_file(path: &Path) -> Option<&'static str> {
    let kind = fs::metadata(path).ok()?.file_type();
    match () {
        () if kind.is_file() => None,
        () if kind.is_dir() => Some("it is a folder; name a file"),
        () => Some("it is no ordinary file; name another"),
    }
}

/// Refuses a file that this program did not write, before anything touches it.
pub(super) fn check_header(
    connection: &Connection,
    path: &str,
    unusable: impl Fn(rusqlite::Error) -> StoreError,
) -> Result<(), StoreError> {
    let number = |sql: &str| -> Result<i64, StoreError> {
        connection
            .query_row(sql, [], |row| row.get(0))
            .map_err(&unusable)
    };
    let application = number("PRAGMA application_id")?;
    let version = number("PRAGMA user_version")?;
    if application == APPLICATION {
        if (1..=VERSION).contains(&version) {
            return Ok(());
        }
        return Err(StoreError::Version {
            path: path.to_owned(),
            found: version,
            expected: VERSION,
        });
    }
    if application != 0 || version != 0 || number("SELECT count(*) FROM sqlite_schema")? != 0 {
        return Err(StoreError::Foreign {
            path: path.to_owned(),
        });
    }
    Ok(())
}

/// The version of a database of ours that is to be brought up to date.
pub(super) fn earlier_version(connection: &Connection) -> rusqlite::Result<Option<i64>> {
    let version = connection.pragma_query_value(None, "user_version", |row| row.get(0))?;
    Ok((1..VERSION).contains(&version).then_some(version))
}

/// Makes the tables, or brings those of an earlier version to this one: all of it,
/// or nothing.
pub(super) fn bring_up_to_date(connection: &mut Connection) -> rusqlite::Result<()> {
    // Immediate, so that of two processes that find an empty file one waits.
    let transaction = connection.transaction_with_behavior(TransactionBehavior::Immediate)?;
    let found: i64 = transaction.query_row("PRAGMA user_version", [], |row| row.get(0))?;
    if found < VERSION {
        climb(&transaction, found)?;
    }
    transaction.commit()
}

fn climb(transaction: &Transaction<'_>, from: i64) -> rusqlite::Result<()> {
    let done = usize::try_from(from).unwrap_or(0);
    STEPS[done..]
        .iter()
        .try_for_each(|step| transaction.execute_batch(step))?;
    transaction.pragma_update(None, "application_id", APPLICATION)?;
    transaction.pragma_update(None, "user_version", VERSION)
}
