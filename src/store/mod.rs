//! Where the logs of sessions last, and the files that were uploaded for them.
//!
//! A [`Store`] appends entries to logs and reads them back. An entry is a text
//! to it: it must not know the learner, nor what an entry means; a file is bytes
//! with a name and a type; and a person is a number that a key opens.

mod backup;
mod files;
mod id;
#[cfg(feature = "postgres")]
mod postgres;
mod schema;
mod sqlite;
mod together;
mod visits;

use std::io::Read;

pub(crate) use backup::now;
pub use backup::{Checked, back_up, check_backup, partial_of, restore};
pub use id::{InviteKey, NoInviteKey, NoSessionId, NoUploadId, SessionId, UploadId};
#[cfg(feature = "postgres")]
pub use postgres::Postgres;
pub use sqlite::Sqlite;
pub use visits::{NoVisitKey, Visit, VisitKey, Visitor, Visits};

/// The bytes of a file lie in pieces of this size, the last one shorter.
pub const CHUNK: usize = 256 * 1024;

/// A file that is to be kept with an upload.
pub struct NewFile<'a> {
    /// Its path in the upload, unique there.
    pub name: String,
    /// Its media type.
    pub kind: String,
    /// Its bytes.
    pub content: Box<dyn Read + 'a>,
}

/// A file that is kept with an upload.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct StoredFile {
    /// The upload that it belongs to.
    pub upload: UploadId,
    /// Its number there.
    pub number: u32,
    /// Its media type.
    pub kind: String,
    /// Its length in bytes.
    pub size: u64,
}

/// One entry of a log, as it lies in the store.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Entry {
    /// Its number, from 0, without gaps.
    pub seq: u64,
    /// When it was appended: UTC, `2026-01-31T12:00:00.000Z`.
    pub at: String,
    /// The text that was appended.
    pub body: String,
}

/// A session in the list of them all.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Listed {
    /// The session.
    pub id: SessionId,
    /// The first entry of its log.
    pub first: Entry,
    /// The last entry of its log.
    pub last: Entry,
}

/// Why the store did not do what it was asked.
#[derive(Debug, thiserror::Error)]
pub enum StoreError {
    /// Another writer has appended an entry of this number: read it and decide
    /// again.
    #[error("entry {seq} of session {session:?} is already there")]
    Taken {
        /// The session.
        session: SessionId,
        /// The number.
        seq: u64,
    },
    /// The entry would leave a gap.
    #[error("session {session:?} has no entry before {seq}")]
    Gap {
        /// The session.
        session: SessionId,
        /// The number.
        seq: u64,
    },
    /// The file belongs to another program.
    #[error("{path} is a database of another program: name another file with --database")]
    Foreign {
        /// The file.
        path: String,
    },
    /// The file is of a version that this program does not read.
    #[error(
        "{path} is a memrep database of version {found}, and this memrep reads version {expected}: use the memrep that wrote it, or name another file with --database"
    )]
    Version {
        /// The file.
        path: String,
        /// Its version.
        found: i64,
        /// The version that can be read.
        expected: i64,
    },
    /// The file cannot be used at all.
    #[error("{path} cannot be used as a database: {message}")]
    Unusable {
        /// The file.
        path: String,
        /// Why, and what to do.
        message: String,
    },
    /// There is no such upload.
    #[error("there is no upload {upload:?}")]
    NoUpload {
        /// Its name.
        upload: UploadId,
    },
    /// A file that was to be kept could not be read.
    #[error("`{name}` could not be read to be kept: {error}")]
    Unread {
        /// The file.
        name: String,
        /// Why.
        error: std::io::Error,
    },
    /// There is no room for what was to be kept.
    #[error("there is no room left for the database: {message}")]
    Full {
        /// What was met.
        message: String,
    },
    /// The database is elsewhere, and does not answer.
    #[error("the database cannot be reached: {message}")]
    Away {
        /// What was met.
        message: String,
    },
    /// A log has a gap: something else than memrep wrote there.
    #[error("entry {seq} of session {session:?} is missing")]
    Missing {
        /// The session.
        session: SessionId,
        /// The number.
        seq: u64,
    },
    /// A backup could not be made or put back.
    #[error("{path}: {message}")]
    Backup {
        /// The file that is meant.
        path: String,
        /// What is wrong, and what to do.
        message: String,
    },
    /// The database failed.
    #[error("the database failed: {0}")]
    Database(rusqlite::Error),
    /// The `PostgreSQL` server did not do what it was asked.
    #[cfg(feature = "postgres")]
    #[error("the database failed: {}", postgres::told(.0))]
    Postgres(tokio_postgres::Error),
}

impl From<rusqlite::Error> for StoreError {
    fn from(error: rusqlite::Error) -> Self {
        if sqlite::is_full(&error) {
            let message = error.to_string();
            return Self::Full { message };
        }
        Self::Database(error)
    }
}

/// Who wants to hear that a session has so many entries now.
pub type Hear = Box<dyn Fn(SessionId, u64) + Send + Sync>;

/// Logs of sessions: append-only, one writer for each number; and uploads, which
/// never change.
pub trait Store: Send + Sync {
    /// Appends an entry. When this returns, the entry outlives the process and
    /// the machine's power.
    ///
    /// `seq` is the number of entries that the writer has seen: of several
    /// writers that have seen the same, one succeeds. Number 0 creates the
    /// session.
    ///
    /// # Errors
    ///
    /// [`StoreError::Taken`] if the number is taken; nothing has changed after
    /// any error.
    fn append(&self, session: &SessionId, seq: u64, body: &str) -> Result<(), StoreError> {
        self.append_all(session, seq, &[body])
    }

    /// Appends entries that belong together, the first with this number: all of them
    /// are kept or none, as [`append`](Self::append) keeps one.
    ///
    /// # Errors
    ///
    /// As [`append`](Self::append) has, for the first of them.
    fn append_all(&self, session: &SessionId, seq: u64, bodies: &[&str]) -> Result<(), StoreError>;

    /// A session's log in order, empty if there is no such session.
    ///
    /// # Errors
    ///
    /// If the database fails.
    fn read(&self, session: &SessionId) -> Result<Vec<Entry>, StoreError>;

    /// The entries of a session's log from this number on, in order.
    ///
    /// # Errors
    ///
    /// If the database fails.
    fn read_from(&self, session: &SessionId, seq: u64) -> Result<Vec<Entry>, StoreError> {
        let mut entries = self.read(session)?;
        entries.retain(|entry| entry.seq >= seq);
        Ok(entries)
    }

    /// Whether other servers write to the same logs, so that what is in memory may be
    /// behind them.
    fn is_shared(&self) -> bool {
        false
    }

    /// Tells from now on which sessions have grown, whoever wrote to them, where the
    /// store [is shared](Self::is_shared). News may come twice, and late.
    fn follow(&self, _hear: Hear) {}

    /// The sessions with the latest entries, latest first.
    ///
    /// # Errors
    ///
    /// If the database fails.
    fn list(&self, most: usize) -> Result<Vec<Listed>, StoreError>;

    /// Creates a session that has an upload: appends entry 0 of its log. With
    /// `files` the upload is new and has these files; without, it is there.
    /// Either all of this happens, or nothing.
    ///
    /// # Errors
    ///
    /// [`StoreError::NoUpload`] if it should be there and is not, [`StoreError::Taken`]
    /// if the session is there already, [`StoreError::Unread`] if a file cannot
    /// be read; nothing has changed after any error.
    fn begin(
        &self,
        session: &SessionId,
        body: &str,
        upload: &UploadId,
        files: Option<&mut dyn Iterator<Item = NewFile<'_>>>,
    ) -> Result<(), StoreError>;

    /// Lets whoever has this key answer as that person of the session, and nobody
    /// who has an earlier one. Only the key's digest is kept.
    ///
    /// # Errors
    ///
    /// If the database fails, or there is no such session.
    fn invite(&self, key: &InviteKey, session: &SessionId, person: u32) -> Result<(), StoreError>;

    /// Who answers with this key.
    ///
    /// # Errors
    ///
    /// If the database fails.
    fn invited(&self, key: &InviteKey) -> Result<Option<(SessionId, u32)>, StoreError>;

    /// Who is signed in, and the owner's password.
    fn visits(&self) -> &dyn Visits;

    /// The upload that the session was created with, if it was with one.
    ///
    /// # Errors
    ///
    /// If the database fails.
    fn upload_of(&self, session: &SessionId) -> Result<Option<UploadId>, StoreError>;

    /// The file of this name in the upload.
    ///
    /// # Errors
    ///
    /// If the database fails.
    fn file(&self, upload: &UploadId, name: &str) -> Result<Option<StoredFile>, StoreError>;

    /// A piece of a file, from 0: [`CHUNK`] bytes, or what is left at its end;
    /// nothing after that.
    ///
    /// # Errors
    ///
    /// If the database fails.
    fn chunk(&self, file: &StoredFile, place: u64) -> Result<Vec<u8>, StoreError>;

    /// Whether the store answers at all; cheap.
    ///
    /// # Errors
    ///
    /// If it does not.
    fn probe(&self) -> Result<(), StoreError> {
        self.list(1).map(|_| ())
    }

    /// How many sessions there are.
    ///
    /// # Errors
    ///
    /// If the database fails.
    fn count(&self) -> Result<u64, StoreError> {
        Ok(self.list(usize::MAX)?.len() as u64)
    }

    /// Leaves nothing to be done at the next start: the process is about to end.
    /// Without it nothing is lost.
    ///
    /// # Errors
    ///
    /// If the database fails.
    fn rest(&self) -> Result<(), StoreError> {
        Ok(())
    }
}
