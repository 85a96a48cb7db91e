//! The tables in `PostgreSQL`, and how those of an earlier version become those of
//! this one.

use deadpool_postgres::Client;

use super::connect::Door;
use super::fault::{fault, told};
use crate::store::StoreError;

/// The schema's version; not that of the `SQLite` files.
const VERSION: i64 = 2;

/// Held while tables are made, so that of several servers that start one does.
const LOCK: i64 = 0x4d65_6d52;

/// What makes each version out of the one before, from nothing. A step that was
/// released is never changed.
const STEPS: [&str; VERSION as usize] = [
    "
CREATE TABLE uploads (
    id TEXT PRIMARY KEY,
    at TIMESTAMPTZ NOT NULL DEFAULT clock_timestamp()
);
CREATE TABLE files (
    upload TEXT NOT NULL REFERENCES uploads (id),
    number BIGINT NOT NULL CHECK (number >= 0),
    name TEXT NOT NULL,
    kind TEXT NOT NULL,
    size BIGINT NOT NULL CHECK (size >= 0),
    PRIMARY KEY (upload, number),
    UNIQUE (upload, name)
);
CREATE TABLE chunks (
    upload TEXT NOT NULL,
    file BIGINT NOT NULL,
    place BIGINT NOT NULL CHECK (place >= 0),
    bytes BYTEA NOT NULL,
    PRIMARY KEY (upload, file, place),
    FOREIGN KEY (upload, file) REFERENCES files (upload, number)
);
-- Pictures and films are packed already.
ALTER TABLE chunks ALTER COLUMN bytes SET STORAGE EXTERNAL;
CREATE TABLE sessions (
    id TEXT PRIMARY KEY,
    upload TEXT REFERENCES uploads (id)
);
CREATE TABLE entries (
    session TEXT NOT NULL REFERENCES sessions (id),
    seq BIGINT NOT NULL CHECK (seq >= 0),
    at TIMESTAMPTZ NOT NULL DEFAULT clock_timestamp(),
    body TEXT NOT NULL,
    PRIMARY KEY (session, seq)
);
-- For servers that ask what happened while they did not hear.
CREATE INDEX entries_at ON entries (at);
CREATE TABLE invites (
    session TEXT NOT NULL REFERENCES sessions (id),
    person BIGINT NOT NULL CHECK (person > 0),
    digest TEXT NOT NULL UNIQUE,
    at TIMESTAMPTZ NOT NULL DEFAULT clock_timestamp(),
    PRIMARY KEY (session, person)
);
",
    // A visit names its invitation by the digest, which a new link replaces: with the
    // old link end its visits. Times are seconds since 1970.
    "
CREATE TABLE owner (
    one BIGINT PRIMARY KEY CHECK (one = 1),
    password TEXT NOT NULL
);
CREATE TABLE visits (
    digest TEXT PRIMARY KEY,
    invite TEXT,
    begun BIGINT NOT NULL,
    seen BIGINT NOT NULL
);
CREATE INDEX visits_by_time ON visits (begun);
",
];

/// Makes the tables, or brings those of an earlier version to this one: all of it,
/// or nothing.
pub(super) async fn bring_up_to_date(client: &mut Client, door: &Door) -> Result<(), StoreError> {
    let transaction = client.transaction().await.map_err(fault)?;
    // Another server may be at it, for longer than a statement may wait otherwise.
    let wait = "SET LOCAL lock_timeout = '60s'; SET LOCAL statement_timeout = '10min'";
    transaction.batch_execute(wait).await.map_err(fault)?;
    let lock = "SELECT pg_advisory_xact_lock($1)";
    transaction.execute(lock, &[&LOCK]).await.map_err(fault)?;
    let known =
        "SELECT to_regclass('memrep_versions') IS NOT NULL, to_regclass('sessions') IS NOT NULL";
    let known = transaction.query_one(known, &[]).await.map_err(fault)?;
    let (is_ours, is_taken): (bool, bool) = (known.get(0), known.get(1));
    let found: i64 = match (is_ours, is_taken) {
        (true, _) => {
            let last = "SELECT coalesce(max(version), 0) FROM memrep_versions";
            let last = transaction.query_one(last, &[]).await.map_err(fault)?;
            last.get(0)
        }
        (false, false) => 0,
        (false, true) => {
            let message = "it has a table `sessions` of another program: give memrep a database of its own (CREATE DATABASE memrep)";
            return Err(door.unusable(message.to_owned()));
        }
    };
    if found > VERSION {
        return Err(door.unusable(format!(
            "its tables are of version {found}, and this memrep knows version {VERSION}: use the memrep that made them"
        )));
    }
    if found == VERSION {
        return Ok(());
    }
    let may_not = |error: tokio_postgres::Error| {
        door.unusable(format!(
            "its tables cannot be made: {}; the user needs the right to create tables there (ALTER DATABASE ... OWNER TO ...)",
            told(&error)
        ))
    };
    let versions = "CREATE TABLE IF NOT EXISTS memrep_versions (
        version BIGINT PRIMARY KEY, at TIMESTAMPTZ NOT NULL DEFAULT clock_timestamp())";
    transaction.batch_execute(versions).await.map_err(may_not)?;
    let done = usize::try_from(found).unwrap_or(0);
    for (step, version) in STEPS.iter().zip(1_i64..).skip(done) {
        transaction.batch_execute(step).await.map_err(may_not)?;
        let note = "INSERT INTO memrep_versions (version) VALUES ($1)";
        transaction
            .execute(note, &[&version])
            .await
            .map_err(fault)?;
    }
    transaction.commit().await.map_err(fault)
}
