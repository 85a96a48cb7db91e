//! The store in a `PostgreSQL` database, which any number of servers share.
//!
//! The log's key decides between writers. A commit is on the database's disk before
//! an append returns. Where a connection breaks, what was asked is asked again on
//! another one: an append that had happened is then [`StoreError::Taken`], and
//! whoever asked finds it in the log.

mod connect;
mod fault;
mod files;
mod news;
mod schema;
mod visits;

use std::sync::Arc;
use std::time::Duration;

use deadpool_postgres::{Client, Pool};
use tokio::runtime::Runtime;
use tokio::sync::mpsc::UnboundedSender;
use tokio_postgres::Row;
use tokio_postgres::types::ToSql;

use self::connect::Door;
pub(super) use self::fault::told;
use self::fault::{fault, is_taken, is_worth_another_try, no_connection};
use self::news::Ears;
use super::{
    Entry, Hear, InviteKey, Listed, NewFile, SessionId, Store, StoreError, StoredFile, UploadId,
    Visits,
};

/// How long anything but an upload may take before the database counts as away.
const DEADLINE: Duration = Duration::from_secs(15);
/// How often a question is asked again where its connection broke: after a restart of
/// the database all connections that lie ready are broken ones.
const TRIES: usize = 3;

/// How a row tells an entry: its number, its time as text, its body.
macro_rules! entry_columns {
    ($table:literal) => {
        concat!(
            $table,
            ".seq, to_char(",
            $table,
            r#".at AT TIME ZONE 'UTC', 'YYYY-MM-DD"T"HH24:MI:SS.MS"Z"'), "#,
            $table,
            ".body"
        )
    };
}

/// Logs in a `PostgreSQL` database. Its methods block, and must not be called where
/// asynchronous code runs.
pub struct Postgres {
    /// Taken when this goes, so that nothing waits for it.
    runtime: Option<Runtime>,
    pool: Pool,
    grown: UnboundedSender<(SessionId, u64)>,
    ears: Arc<Ears>,
}

impl Postgres {
    /// Opens the database at this address (`postgres://USER@HOST/DATABASE`), and
    /// makes its tables where there are none.
    ///
    /// # Errors
    ///
    /// If the address is none, the database cannot be reached, or has tables of
    /// another program or a later version.
    pub fn open(address: &str) -> Result<Self, StoreError> {
        let door = Door::read(address)?;
        let runtime = tokio::runtime::Builder::new_multi_thread()
            .worker_threads(1)
            .thread_name("store")
            .enable_all()
            .build()
            .map_err(|error| door.unusable(error.to_string()))?;
        let pool = door.pool()?;
        runtime.block_on(async {
            let mut client = pool.get().await.map_err(|error| match error {
                deadpool_postgres::PoolError::Backend(error) => door.unusable(told(&error)),
                other => door.unusable(other.to_string()),
            })?;
            schema::bring_up_to_date(&mut client, &door).await
        })?;
        let ears = Arc::new(Ears::default());
        let grown = news::start(runtime.handle(), door, Arc::clone(&ears));
        Ok(Self {
            runtime: Some(runtime),
            pool,
            grown,
            ears,
        })
    }

    fn block_on<T>(&self, work: impl Future<Output = T>) -> T {
        let runtime = self.runtime.as_ref();
        runtime
            .expect("the runtime goes only with the store")
            .block_on(work)
    }

    /// What `work` finds, on another connection where one broke.
    fn ask<T>(
        &self,
        work: &impl AsyncFn(&mut Client) -> Result<T, tokio_postgres::Error>,
    ) -> Result<T, StoreError> {
        let attempts = async {
            let mut tries = 1;
            loop {
                let mut client = self.pool.get().await.map_err(|e| no_connection(&e))?;
                match work(&mut client).await {
                    Err(error) if tries < TRIES && is_worth_another_try(&error) => tries += 1,
                    Err(error) => return Err(fault(error)),
                    Ok(found) => return Ok(found),
                }
            }
        };
        let in_time = self.block_on(async { tokio::time::timeout(DEADLINE, attempts).await });
        in_time.unwrap_or_else(|_| {
            let message = format!("it did not answer within {} s", DEADLINE.as_secs());
            Err(StoreError::Away { message })
        })
    }

    /// The rows that a statement finds.
    fn rows(&self, statement: &str, given: &[&(dyn ToSql + Sync)]) -> Result<Vec<Row>, StoreError> {
        self.ask(&async |client: &mut Client| {
            let statement = client.prepare_cached(statement).await?;
            client.query(&statement, given).await
        })
    }

    /// An entry that was not appended: the number is taken, or comes too early.
    fn refuse(&self, session: &SessionId, seq: u64) -> StoreError {
        let sql = "SELECT count(*) FROM entries WHERE session = $1";
        let session = *session;
        match self.rows(sql, &[&session.to_string()]) {
            Ok(rows) if rows.first().is_some_and(|row| whole(row, 0) > seq) => {
                StoreError::Taken { session, seq }
            }
            Ok(_) => StoreError::Gap { session, seq },
            Err(error) => error,
        }
    }

    fn tell(&self, session: &SessionId, entries: u64) {
        // The listener is there as long as the runtime.
        let _ = self.grown.send((*session, entries));
    }
}

impl Drop for Postgres {
    fn drop(&mut self) {
        if let Some(runtime) = self.runtime.take() {
            runtime.shutdown_background();
        }
    }
}

impl Store for Postgres {
    fn append_all(&self, session: &SessionId, seq: u64, bodies: &[&str]) -> Result<(), StoreError> {
        let id = session.to_string();
        // Whether the number is free, the unique key decides for all of them at once.
        let appended = if seq == 0 {
            self.rows(
                "WITH new AS (INSERT INTO sessions (id) VALUES ($1) ON CONFLICT DO NOTHING RETURNING id)
                 INSERT INTO entries (session, seq, body)
                 SELECT id, place - 1, body FROM new, unnest($2::text[]) WITH ORDINALITY AS given(body, place)
                 RETURNING seq",
                &[&id, &bodies],
            )
        } else {
            self.rows(
                "INSERT INTO entries (session, seq, body)
                 SELECT $1::text, $2::bigint + place - 1, body
                 FROM unnest($3::text[]) WITH ORDINALITY AS given(body, place)
                 WHERE EXISTS (SELECT 1 FROM entries WHERE session = $1 AND seq = $2 - 1)
                 RETURNING seq",
                &[&id, &seq.cast_signed(), &bodies],
            )
        };
        match appended {
            Err(StoreError::Postgres(error)) if is_taken(&error) => Err(StoreError::Taken {
                session: *session,
                seq,
            }),
            Err(error) => Err(error),
            Ok(rows) if rows.is_empty() => Err(self.refuse(session, seq)),
            Ok(rows) => {
                self.tell(session, seq + rows.len() as u64);
                Ok(())
            }
        }
    }

    fn read(&self, session: &SessionId) -> Result<Vec<Entry>, StoreError> {
        self.read_from(session, 0)
    }

    fn read_from(&self, session: &SessionId, seq: u64) -> Result<Vec<Entry>, StoreError> {
        let sql = concat!(
            "SELECT ",
            entry_columns!("entries"),
            " FROM entries WHERE session = $1 AND seq >= $2 ORDER BY seq"
        );
        let from = i64::try_from(seq).unwrap_or(i64::MAX);
        let rows = self.rows(sql, &[&session.to_string(), &from])?;
        Ok(rows.iter().map(|row| entry(row, 0)).collect())
    }

    fn is_shared(&self) -> bool {
        true
    }

    fn follow(&self, hear: Hear) {
        self.ears.add(hear);
    }

    fn list(&self, most: usize) -> Result<Vec<Listed>, StoreError> {
        let sql = concat!(
            "SELECT ",
            entry_columns!("first"),
            ", ",
            entry_columns!("last"),
            ", sessions.id FROM sessions
             JOIN entries AS first ON first.session = sessions.id AND first.seq = 0
             JOIN LATERAL (SELECT seq, at, body FROM entries WHERE session = sessions.id
                           ORDER BY seq DESC LIMIT 1) AS last ON true
             ORDER BY last.at DESC, sessions.id LIMIT $1"
        );
        let most = i64::try_from(most).unwrap_or(i64::MAX);
        let rows = self.rows(sql, &[&most])?;
        let listed = rows.iter().map(|row| {
            Ok(Listed {
                id: name(row, 6)?,
                first: entry(row, 0),
                last: entry(row, 3),
            })
        });
        listed.collect()
    }

    fn begin(
        &self,
        session: &SessionId,
        body: &str,
        upload: &UploadId,
        files: Option<&mut dyn Iterator<Item = NewFile<'_>>>,
    ) -> Result<(), StoreError> {
        self.block_on(async {
            let mut client = self.pool.get().await.map_err(|e| no_connection(&e))?;
            let begun = files::begin(&mut client, session, body, upload, files);
            begun.await
        })?;
        self.tell(session, 1);
        Ok(())
    }

    fn invite(&self, key: &InviteKey, session: &SessionId, person: u32) -> Result<(), StoreError> {
        self.rows(
            "INSERT INTO invites (session, person, digest) VALUES ($1, $2, $3)
             ON CONFLICT (session, person) DO UPDATE SET digest = excluded.digest, at = now()",
            &[&session.to_string(), &i64::from(person), &key.digest()],
        )?;
        Ok(())
    }

    fn invited(&self, key: &InviteKey) -> Result<Option<(SessionId, u32)>, StoreError> {
        let sql = "SELECT session, person FROM invites WHERE digest = $1";
        let rows = self.rows(sql, &[&key.digest()])?;
        let person = |row: &Row| Ok((name(row, 0)?, whole(row, 1) as u32));
        rows.first().map(person).transpose()
    }

    fn visits(&self) -> &dyn Visits {
        self
    }

    fn upload_of(&self, session: &SessionId) -> Result<Option<UploadId>, StoreError> {
        let sql = "SELECT upload FROM sessions WHERE id = $1 AND upload IS NOT NULL";
        let rows = self.rows(sql, &[&session.to_string()])?;
        rows.first().map(|row| name(row, 0)).transpose()
    }

    fn file(&self, upload: &UploadId, name: &str) -> Result<Option<StoredFile>, StoreError> {
        let sql = "SELECT number, kind, size FROM files WHERE upload = $1 AND name = $2";
        let rows = self.rows(sql, &[&upload.to_string(), &name])?;
        Ok(rows.first().map(|row| StoredFile {
            upload: *upload,
            number: whole(row, 0) as u32,
            kind: row.get(1),
            size: whole(row, 2),
        }))
    }

    fn chunk(&self, file: &StoredFile, place: u64) -> Result<Vec<u8>, StoreError> {
        let sql = "SELECT bytes FROM chunks WHERE upload = $1 AND file = $2 AND place = $3";
        let place = i64::try_from(place).unwrap_or(i64::MAX);
        let number = i64::from(file.number);
        let rows = self.rows(sql, &[&file.upload.to_string(), &number, &place])?;
        Ok(rows.first().map(|row| row.get(0)).unwrap_or_default())
    }

    fn probe(&self) -> Result<(), StoreError> {
        self.rows("SELECT id FROM sessions LIMIT 1", &[]).map(drop)
    }

    fn count(&self) -> Result<u64, StoreError> {
        let rows = self.rows("SELECT count(*) FROM sessions", &[])?;
        Ok(rows.first().map_or(0, |row| whole(row, 0)))
    }
}

/// An entry, from three columns.
fn entry(row: &Row, at: usize) -> Entry {
    Entry {
        seq: whole(row, at),
        at: row.get(at + 1),
        body: row.get(at + 2),
    }
}

/// A number that is never negative.
fn whole(row: &Row, at: usize) -> u64 {
    row.get::<_, i64>(at).cast_unsigned()
}

/// The name of a session or an upload.
fn name<T: std::str::FromStr>(row: &Row, at: usize) -> Result<T, StoreError> {
    let text: String = row.get(at);
    text.parse().map_err(|_| StoreError::Unusable {
        path: "the PostgreSQL database".to_owned(),
        message: "a name in it was not written by memrep".to_owned(),
    })
}
