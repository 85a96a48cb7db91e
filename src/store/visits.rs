//! Who is signed in: visits, by the digests of their keys, and the hash of the
//! owner's password. Must not know cookies, nor how long a visit may last.

use std::fmt;
use std::str::FromStr;

use rusqlite::{OptionalExtension as _, TransactionBehavior, params};

use super::{SessionId, Sqlite, StoreError, id};

/// What a browser or a script shows to go on with a visit: 256 random bits, written as
/// 64 hexadecimal digits. The store has only its digest.
#[derive(Clone, Copy)]
pub struct VisitKey([u8; 32]);

/// A text that is no such key.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("a visit's key is 64 hexadecimal digits")]
pub struct NoVisitKey;

impl VisitKey {
    /// A new key from the operating system's generator.
    ///
    /// # Errors
    ///
    /// If the operating system has no randomness to give.
    pub fn random() -> Result<Self, getrandom::Error> {
        let mut bytes = [0; 32];
        getrandom::fill(&mut bytes)?;
        Ok(Self(bytes))
    }

    /// What is kept of it, and by which it is found: what differs from a key in one
    /// place differs from its digest in all, so that no comparison tells of a key.
    pub fn digest(&self) -> String {
        id::digest(&self.0)
    }
}

impl fmt::Display for VisitKey {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.iter().try_for_each(|byte| write!(f, "{byte:02x}"))
    }
}

impl fmt::Debug for VisitKey {
    /// Nothing of it: whoever reads a log is not to have it.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("VisitKey(…)")
    }
}

impl FromStr for VisitKey {
    type Err = NoVisitKey;

    fn from_str(text: &str) -> Result<Self, NoVisitKey> {
        let is_digit = |b: u8| matches!(b, b'0'..=b'9' | b'a'..=b'f');
        if text.len() != 64 || !text.bytes().all(is_digit) {
            return Err(NoVisitKey);
        }
        let mut bytes = [0; 32];
        for (at, byte) in bytes.iter_mut().enumerate() {
            *byte = u8::from_str_radix(&text[2 * at..2 * at + 2], 16).map_err(|_| NoVisitKey)?;
        }
        Ok(Self(bytes))
    }
}

/// Whose visit it is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Visitor {
    /// The owner's.
    Owner,
    /// An invited person's.
    Invited {
        /// The digest of the key by which they came.
        invite: String,
        /// The session to which they are invited.
        session: SessionId,
        /// Their number there.
        person: u32,
    },
}

/// A visit. Times are seconds since 1970.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Visit {
    /// Whose it is.
    pub visitor: Visitor,
    /// When it began.
    pub begun: u64,
    /// When it was last known to go on.
    pub seen: u64,
}

/// The visits, and the owner's password.
pub trait Visits: Send + Sync {
    /// The hash of the owner's password, if there is one.
    ///
    /// # Errors
    ///
    /// If the database fails.
    fn password(&self) -> Result<Option<String>, StoreError>;

    /// Sets the hash of the owner's password, or removes it, and ends all visits: both
    /// or nothing.
    ///
    /// # Errors
    ///
    /// If the database fails.
    fn set_password(&self, hash: Option<&str>) -> Result<(), StoreError>;

    /// Begins a visit of the owner's, or of whoever has the invitation of this digest.
    ///
    /// # Errors
    ///
    /// If the database fails.
    fn begin_visit(&self, digest: &str, invite: Option<&str>, now: u64) -> Result<(), StoreError>;

    /// The visit of this digest, if there is one and its invitation still stands.
    ///
    /// # Errors
    ///
    /// If the database fails.
    fn visit(&self, digest: &str) -> Result<Option<Visit>, StoreError>;

    /// The visit of this digest goes on now.
    ///
    /// # Errors
    ///
    /// If the database fails.
    fn see_visit(&self, digest: &str, now: u64) -> Result<(), StoreError>;

    /// Ends the visit of this digest, if there is one.
    ///
    /// # Errors
    ///
    /// If the database fails.
    fn end_visit(&self, digest: &str) -> Result<(), StoreError>;

    /// Forgets visits that began before this time.
    ///
    /// # Errors
    ///
    /// If the database fails.
    fn forget_visits(&self, before: u64) -> Result<(), StoreError>;
}

impl Visits for Sqlite {
    fn password(&self) -> Result<Option<String>, StoreError> {
        let connection = self.connection();
        let mut statement = connection.prepare_cached("SELECT password FROM owner")?;
        Ok(statement.query_row([], |row| row.get(0)).optional()?)
    }

    fn set_password(&self, hash: Option<&str>) -> Result<(), StoreError> {
        let mut connection = self.connection();
        let transaction = connection.transaction_with_behavior(TransactionBehavior::Immediate)?;
        transaction.execute("DELETE FROM owner", [])?;
        if let Some(hash) = hash {
            transaction.execute("INSERT INTO owner (only, password) VALUES (1, ?1)", [hash])?;
        }
        transaction.execute("DELETE FROM visits", [])?;
        transaction.commit()?;
        Ok(())
    }

    fn begin_visit(&self, digest: &str, invite: Option<&str>, now: u64) -> Result<(), StoreError> {
        self.connection()
            .prepare_cached(
                "INSERT INTO visits (digest, invite, begun, seen) VALUES (?1, ?2, ?3, ?3)",
            )?
            .execute(params![digest, invite, now.cast_signed()])?;
        Ok(())
    }

    fn visit(&self, digest: &str) -> Result<Option<Visit>, StoreError> {
        let connection = self.connection();
        let mut statement = connection.prepare_cached(
            "SELECT visits.invite, visits.begun, visits.seen, invites.session, invites.person
             FROM visits LEFT JOIN invites ON invites.digest = visits.invite
             WHERE visits.digest = ?1",
        )?;
        let found = statement.query_row([digest], |row| {
            let invite: Option<String> = row.get(0)?;
            let session: Option<String> = row.get(3)?;
            let visitor = match (invite, session) {
                (None, _) => Visitor::Owner,
                // The link was replaced.
                (Some(_), None) => return Ok(None),
                (Some(invite), Some(session)) => Visitor::Invited {
                    invite,
                    session: session
                        .parse()
                        .map_err(|_| rusqlite::Error::InvalidColumnName(session))?,
                    person: row.get(4)?,
                },
            };
            Ok(Some(Visit {
                visitor,
                begun: row.get::<_, i64>(1)?.cast_unsigned(),
                seen: row.get::<_, i64>(2)?.cast_unsigned(),
            }))
        });
        Ok(found.optional()?.flatten())
    }

    fn see_visit(&self, digest: &str, now: u64) -> Result<(), StoreError> {
        self.connection()
            .prepare_cached("UPDATE visits SET seen = max(seen, ?2) WHERE digest = ?1")?
            .execute(params![digest, now.cast_signed()])?;
        Ok(())
    }

    fn end_visit(&self, digest: &str) -> Result<(), StoreError> {
        self.connection()
            .prepare_cached("DELETE FROM visits WHERE digest = ?1")?
            .execute([digest])?;
        Ok(())
    }

    fn forget_visits(&self, before: u64) -> Result<(), StoreError> {
        self.connection()
            .prepare_cached("DELETE FROM visits WHERE begun < ?1")?
            .execute([before.cast_signed()])?;
        Ok(())
    }
}
