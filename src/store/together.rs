//! Appends of several writers that meet are one transaction: they share the wait for
//! the disk, which is nearly all that an append takes.
//!
//! Whoever gets hold of the connection first appends for all who wait for it. A
//! writer alone is as quick as ever.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use rusqlite::{Connection, Transaction, TransactionBehavior, params};

use super::{SessionId, StoreError};

/// What is to be appended by writers who wait for the connection.
#[derive(Default)]
pub(super) struct Together {
    waiting: Mutex<Vec<Arc<Wish>>>,
}

/// Entries that somebody wants to append, one after the other.
struct Wish {
    session: SessionId,
    /// The number of the first.
    seq: u64,
    bodies: Vec<String>,
    /// None until somebody has seen to it.
    outcome: Mutex<Option<Outcome>>,
}

#[derive(Clone, Copy)]
enum Outcome {
    Kept,
    Taken,
    Gap,
    /// One of those that were to be appended together could not be, so nobody's was.
    Alone,
}

impl Together {
    /// Appends entries, as [`Store::append_all`](super::Store::append_all) says.
    /// `connect` waits for the connection.
    pub(super) fn append<'a>(
        &self,
        session: SessionId,
        seq: u64,
        bodies: &[&str],
        connect: impl FnOnce() -> MutexGuard<'a, Connection>,
    ) -> Result<(), StoreError> {
        let wish = Arc::new(Wish {
            session,
            seq,
            bodies: bodies.iter().map(|&body| body.to_owned()).collect(),
            outcome: Mutex::default(),
        });
        self.waiting().push(Arc::clone(&wish));
        let mut connection = connect();
        let mut outcome = *wish.outcome();
        if outcome.is_none() {
            outcome = Some(self.append_all(&mut connection, &wish));
        }
        if let Some(Outcome::Alone) = outcome {
            outcome = keep(&mut connection, std::slice::from_ref(&wish))?.pop();
        }
        match outcome {
            Some(Outcome::Kept) => Ok(()),
            Some(Outcome::Taken) => Err(StoreError::Taken { session, seq }),
            _ => Err(StoreError::Gap { session, seq }),
        }
    }

    /// Sees to everybody who waits, and says what came of this wish.
    fn append_all(&self, connection: &mut Connection, own: &Arc<Wish>) -> Outcome {
        let mut all = std::mem::take(&mut *self.waiting());
        if !all.iter().any(|wish| Arc::ptr_eq(wish, own)) {
            // Somebody took it along, and died of a panic.
            all.push(Arc::clone(own));
        }
        // What went wrong may be one writer's doing, and each is told their own.
        let outcomes = keep(connection, &all).unwrap_or_else(|_| vec![Outcome::Alone; all.len()]);
        for (wish, outcome) in all.iter().zip(outcomes) {
            *wish.outcome() = Some(outcome);
        }
        own.outcome().unwrap_or(Outcome::Alone)
    }

    fn waiting(&self) -> MutexGuard<'_, Vec<Arc<Wish>>> {
        self.waiting.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Wish {
    fn outcome(&self) -> MutexGuard<'_, Option<Outcome>> {
        self.outcome.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Appends what can be, in one transaction; after an error nothing has changed.
fn keep(connection: &mut Connection, wishes: &[Arc<Wish>]) -> rusqlite::Result<Vec<Outcome>> {
    let transaction = connection.transaction_with_behavior(TransactionBehavior::Immediate)?;
    let outcomes = wishes.iter().map(|wish| insert(&transaction, wish));
    let outcomes = outcomes.collect::<rusqlite::Result<_>>()?;
    transaction.commit()?;
    Ok(outcomes)
}

fn insert(transaction: &Transaction<'_>, wish: &Wish) -> rusqlite::Result<Outcome> {
    let id = wish.session.to_string();
    let last: Option<i64> = transaction
        .prepare_cached("SELECT max(seq) FROM entries WHERE session = ?1")?
        .query_row([&id], |row| row.get(0))?;
    let expected = last.map_or(0, |last| last.cast_unsigned() + 1);
    if wish.seq < expected {
        return Ok(Outcome::Taken);
    }
    if wish.seq > expected {
        return Ok(Outcome::Gap);
    }
    if wish.seq == 0 {
        transaction.execute("INSERT INTO sessions (id) VALUES (?1)", [&id])?;
    }
    let mut append = transaction
        .prepare_cached("INSERT INTO entries (session, seq, body) VALUES (?1, ?2, ?3)")?;
    for (body, seq) in wish.bodies.iter().zip(wish.seq..) {
        append.execute(params![id, seq.cast_signed(), body])?;
    }
    Ok(Outcome::Kept)
}
