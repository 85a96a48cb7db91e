//! Where the logs of sessions last.
//!
//! A [`Store`] appends entries to logs and reads them back. An entry is a text
//! to it: it must not know the learner, nor what an entry means.

mod id;
mod sqlite;

pub use id::SessionId;
pub use sqlite::Sqlite;

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
    #[error("entry {seq} of session {session} is already there")]
    Taken {
        /// The session.
        session: SessionId,
        /// The number.
        seq: u64,
    },
    /// The entry would leave a gap.
    #[error("session {session} has no entry before {seq}")]
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
    /// The database failed.
    #[error("the database failed: {0}")]
    Database(#[from] rusqlite::Error),
}

/// Logs of sessions: append-only, one writer for each number.
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
    fn append(&self, session: &SessionId, seq: u64, body: &str) -> Result<(), StoreError>;

    /// A session's log in order, empty if there is no such session.
    ///
    /// # Errors
    ///
    /// If the database fails.
    fn read(&self, session: &SessionId) -> Result<Vec<Entry>, StoreError>;

    /// The sessions with the latest entries, latest first.
    ///
    /// # Errors
    ///
    /// If the database fails.
    fn list(&self, most: usize) -> Result<Vec<Listed>, StoreError>;
}
