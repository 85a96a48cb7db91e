//! The store in one `SQLite` file.

use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use rusqlite::ffi::{SQLITE_IOERR_SHMSIZE, SQLITE_IOERR_WRITE};
use rusqlite::{Connection, ErrorCode, OpenFlags, OptionalExtension, TransactionBehavior, params};

use super::schema::{bring_up_to_date, check_header, earlier_version, no_file};
use super::together::Together;
use super::{
    Entry, InviteKey, Listed, NewFile, SessionId, Store, StoreError, StoredFile, UploadId, Visits,
    backup, files,
};

/// The most bytes of the write-ahead log that stay on the disk once it is written
/// into the database.
const LOG_LIMIT: i64 = 16 << 20;

/// Logs in one `SQLite` file: write-ahead log, synced to the disk before an
/// append returns. Not for network file systems.
pub struct Sqlite {
    connection: Mutex<Connection>,
    together: Together,
    place: Option<Place>,
}

/// Which file a database was opened as.
struct Place {
    path: PathBuf,
    file: (u64, u64),
}

impl Place {
    fn of(path: &Path) -> Option<Self> {
        let path = path.canonicalize().ok()?;
        let file = file_at(&path)?;
        Some(Self { path, file })
    }
}

/// What tells the file at a path from all others, where the system has such numbers.
#[cfg(unix)]
fn file_at(path: &Path) -> Option<(u64, u64)> {
    use std::os::unix::fs::MetadataExt as _;
    let file = std::fs::metadata(path).ok()?;
    Some((file.dev(), file.ino()))
}

#[cfg(not(unix))]
fn file_at(_: &Path) -> Option<(u64, u64)> {
    None
}

impl Sqlite {
    /// Opens the file, or creates it.
    ///
    /// # Errors
    ///
    /// If it is no database, another program's, or of a later version; it is
    /// then left as it was. One of an earlier version is brought up to date.
    pub fn open(path: &Path) -> Result<Self, StoreError> {
        let shown = path.display().to_string();
        let unusable = |error: rusqlite::Error| {
            StoreError::Unusable {
            path: shown.clone(),
            message: match error.sqlite_error_code() {
                Some(ErrorCode::NotADatabase) => {
                    "it is not an SQLite file; name another file with --database".to_owned()
                }
                Some(ErrorCode::CannotOpen) => {
                    "it cannot be opened; check that its folder exists and may be written to"
                        .to_owned()
                }
                Some(ErrorCode::ReadOnly) => {
                    "it may not be written to; change its permissions or name another file with --database"
                        .to_owned()
                }
                Some(ErrorCode::DatabaseBusy | ErrorCode::DatabaseLocked) => {
                    "another program holds it; stop that program and try again".to_owned()
                }
                _ => error.to_string(),
            },
        }
        };
        if let Some(message) = no_file(path) {
            return Err(StoreError::Unusable {
                message: format!("{message} with --database"),
                path: shown,
            });
        }
        let flags = OpenFlags::SQLITE_OPEN_READ_WRITE
            | OpenFlags::SQLITE_OPEN_CREATE
            | OpenFlags::SQLITE_OPEN_NO_MUTEX;
        let connection = Connection::open_with_flags(path, flags).map_err(unusable)?;
        connection
            .busy_timeout(Duration::from_secs(5))
            .map_err(unusable)?;
        check_header(&connection, &shown, unusable)?;
        if let Some(version) = earlier_version(&connection).map_err(unusable)? {
            backup::before_upgrade(&connection, path, version)?;
        }
        let mut store = prepare(connection).map_err(unusable)?;
        store.place = Place::of(path);
        Ok(store)
    }

    /// A store that ends with the process.
    ///
    /// # Errors
    ///
    /// If the database fails.
    pub fn in_memory() -> Result<Self, StoreError> {
        Ok(prepare(Connection::open_in_memory()?)?)
    }

    /// Lets the database grow to so many bytes and no further.
    ///
    /// # Errors
    ///
    /// If the database fails.
    pub fn limit(&self, bytes: u64) -> Result<(), StoreError> {
        let connection = self.connection();
        let page = |row: &rusqlite::Row<'_>| row.get(0);
        let size: i64 = connection.query_row("PRAGMA page_size", [], page)?;
        let pages = i64::try_from(bytes).unwrap_or(i64::MAX) / size.max(1);
        connection.query_row(&format!("PRAGMA max_page_count = {pages}"), [], |_| Ok(()))?;
        Ok(())
    }

    /// Whether what is kept is there at the next start: a file that was removed, or has
    /// another in its place, would take everything without a word, and be gone.
    fn in_place(&self) -> Result<(), StoreError> {
        let Some(place) = &self.place else {
            return Ok(());
        };
        if file_at(&place.path) == Some(place.file) {
            return Ok(());
        }
        Err(StoreError::Away {
            message: format!(
                "{} was removed or replaced while memrep had it open: put it back, or start memrep again",
                place.path.display()
            ),
        })
    }

    /// A panic elsewhere cannot have left a transaction open: they roll back.
    pub(super) fn connection(&self) -> MutexGuard<'_, Connection> {
        self.connection
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
    }
}

fn prepare(mut connection: Connection) -> rusqlite::Result<Sqlite> {
    connection.pragma_update(None, "journal_mode", "WAL")?;
    connection.pragma_update(None, "synchronous", "FULL")?;
    connection.pragma_update(None, "foreign_keys", "ON")?;
    // After an upload the log gives its room back.
    connection.pragma_update(None, "journal_size_limit", LOG_LIMIT)?;
    bring_up_to_date(&mut connection)?;
    Ok(Sqlite {
        connection: Mutex::new(connection),
        together: Together::default(),
        place: None,
    })
}

impl Store for Sqlite {
    fn append_all(&self, session: &SessionId, seq: u64, bodies: &[&str]) -> Result<(), StoreError> {
        self.in_place()?;
        let connect = || self.connection();
        self.together.append(*session, seq, bodies, connect)
    }

    fn read(&self, session: &SessionId) -> Result<Vec<Entry>, StoreError> {
        self.read_from(session, 0)
    }

    fn read_from(&self, session: &SessionId, seq: u64) -> Result<Vec<Entry>, StoreError> {
        let connection = self.connection();
        let mut statement = connection.prepare_cached(
            "SELECT seq, at, body FROM entries WHERE session = ?1 AND seq >= ?2 ORDER BY seq",
        )?;
        let from = i64::try_from(seq).unwrap_or(i64::MAX);
        let entries =
            statement.query_map(params![session.to_string(), from], |row| entry(row, 0))?;
        Ok(entries.collect::<rusqlite::Result<_>>()?)
    }

    fn list(&self, most: usize) -> Result<Vec<Listed>, StoreError> {
        let connection = self.connection();
        let mut statement = connection.prepare_cached(
            "SELECT first.seq, first.at, first.body, last.seq, last.at, last.body, sessions.id
             FROM sessions
             JOIN entries AS first ON first.session = sessions.id AND first.seq = 0
             JOIN entries AS last ON last.session = sessions.id AND last.seq =
                 (SELECT max(seq) FROM entries WHERE session = sessions.id)
             ORDER BY last.at DESC, sessions.id
             LIMIT ?1",
        )?;
        let rows = statement.query_map([i64::try_from(most).unwrap_or(i64::MAX)], |row| {
            let id: String = row.get(6)?;
            let id = id
                .parse()
                .map_err(|_| rusqlite::Error::InvalidColumnName(id))?;
            Ok(Listed {
                id,
                first: entry(row, 0)?,
                last: entry(row, 3)?,
            })
        })?;
        Ok(rows.collect::<rusqlite::Result<_>>()?)
    }

    fn begin(
        &self,
        session: &SessionId,
        body: &str,
        upload: &UploadId,
        files: Option<&mut dyn Iterator<Item = NewFile<'_>>>,
    ) -> Result<(), StoreError> {
        self.in_place()?;
        let mut connection = self.connection();
        let transaction = connection.transaction_with_behavior(TransactionBehavior::Immediate)?;
        match files {
            Some(new) => files::insert(&transaction, upload, new)?,
            None if files::has(&transaction, upload)? => {}
            None => return Err(StoreError::NoUpload { upload: *upload }),
        }
        let id = session.to_string();
        let known = transaction
            .prepare("SELECT 1 FROM sessions WHERE id = ?1")?
            .exists([&id])?;
        if known {
            return Err(StoreError::Taken {
                session: *session,
                seq: 0,
            });
        }
        transaction.execute(
            "INSERT INTO sessions (id, upload) VALUES (?1, ?2)",
            params![id, upload.to_string()],
        )?;
        transaction.execute(
            "INSERT INTO entries (session, seq, body) VALUES (?1, 0, ?2)",
            params![id, body],
        )?;
        transaction.commit()?;
        Ok(())
    }

    fn invite(&self, key: &InviteKey, session: &SessionId, person: u32) -> Result<(), StoreError> {
        self.in_place()?;
        self.connection()
            .prepare_cached(
                "INSERT INTO invites (session, person, digest) VALUES (?1, ?2, ?3)
                 ON CONFLICT (session, person) DO UPDATE SET digest = excluded.digest,
                     at = strftime('%Y-%m-%dT%H:%M:%fZ', 'now')",
            )?
            .execute(params![session.to_string(), person, key.digest()])?;
        Ok(())
    }

    fn invited(&self, key: &InviteKey) -> Result<Option<(SessionId, u32)>, StoreError> {
        let connection = self.connection();
        let mut statement =
            connection.prepare_cached("SELECT session, person FROM invites WHERE digest = ?1")?;
        let found: Option<(String, u32)> = statement
            .query_row([key.digest()], |row| Ok((row.get(0)?, row.get(1)?)))
            .optional()?;
        found
            .map(|(id, person)| match id.parse() {
                Ok(session) => Ok((session, person)),
                Err(_) => Err(rusqlite::Error::InvalidColumnName(id).into()),
            })
            .transpose()
    }

    fn visits(&self) -> &dyn Visits {
        self
    }

    fn upload_of(&self, session: &SessionId) -> Result<Option<UploadId>, StoreError> {
        files::of_session(&self.connection(), session)
    }

    fn file(&self, upload: &UploadId, name: &str) -> Result<Option<StoredFile>, StoreError> {
        files::find(&self.connection(), upload, name)
    }

    fn chunk(&self, file: &StoredFile, place: u64) -> Result<Vec<u8>, StoreError> {
        files::chunk(&self.connection(), file, place)
    }

    fn probe(&self) -> Result<(), StoreError> {
        self.in_place()?;
        self.connection()
            .prepare_cached("SELECT id FROM sessions LIMIT 1")?
            .exists([])?;
        Ok(())
    }

    fn count(&self) -> Result<u64, StoreError> {
        let connection = self.connection();
        let mut statement = connection.prepare_cached("SELECT count(*) FROM sessions")?;
        let count: i64 = statement.query_row([], |row| row.get(0))?;
        Ok(count.cast_unsigned())
    }

    fn rest(&self) -> Result<(), StoreError> {
        let connection = self.connection();
        connection.execute_batch("PRAGMA optimize")?;
        connection.pragma_update(None, "wal_checkpoint", "TRUNCATE")?;
        Ok(())
    }
}

/// Whether what failed is that the file could not grow.
pub(super) fn is_full(error: &rusqlite::Error) -> bool {
    // A quota or a limit of size is met as a failed write.
    let met = error.sqlite_error().map(|error| error.extended_code);
    error.sqlite_error_code() == Some(ErrorCode::DiskFull)
        || matches!(met, Some(SQLITE_IOERR_WRITE | SQLITE_IOERR_SHMSIZE))
}

fn entry(row: &rusqlite::Row<'_>, at: usize) -> rusqlite::Result<Entry> {
    Ok(Entry {
        seq: row.get::<_, i64>(at)?.cast_unsigned(),
        at: row.get(at + 1)?,
        body: row.get(at + 2)?,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What was acknowledged is on the disk, and not only with the operating system.
    #[test]
    fn a_commit_in_a_file_is_on_the_disk_before_it_returns() {
        let folder = tempfile::tempdir().unwrap();
        let store = Sqlite::open(&folder.path().join("a.db")).unwrap();
        let connection = store.connection();
        let number = |name: &str| -> i64 {
            let value = connection.pragma_query_value(None, name, |row| row.get(0));
            value.unwrap()
        };
        let journal = connection.pragma_query_value(None, "journal_mode", |row| row.get(0));
        assert_eq!(journal, Ok("wal".to_owned()));
        assert_eq!(number("synchronous"), 2, "FULL");
        assert_eq!(number("foreign_keys"), 1);
        assert_eq!(number("busy_timeout"), 5000);
    }
}
