//! What a `PostgreSQL` server's failures mean for whoever asked.

use std::error::Error as _;
use std::io;

use deadpool_postgres::PoolError;
use tokio_postgres::Error;
use tokio_postgres::error::SqlState;

use crate::store::StoreError;

/// All that an error says; its own `Display` leaves the cause out.
pub(in crate::store) fn told(error: &Error) -> String {
    match (error.as_db_error(), error.source()) {
        (Some(said), _) => format!("{} ({})", said.message(), said.code().code()),
        (None, Some(cause)) => format!("{error}: {cause}"),
        (None, None) => error.to_string(),
    }
}

/// An error of a statement.
pub(super) fn fault(error: Error) -> StoreError {
    let message = told(&error);
    match error.code() {
        Some(code) if *code == SqlState::DISK_FULL => StoreError::Full { message },
        Some(code) if means_away(code) => StoreError::Away { message },
        None if is_broken(&error) => StoreError::Away { message },
        _ => StoreError::Postgres(error),
    }
}

/// No connection was to be had.
pub(super) fn no_connection(error: &PoolError) -> StoreError {
    let message = match error {
        PoolError::Backend(error) => told(error),
        PoolError::Timeout(_) => "no connection became free in time".to_owned(),
        other => other.to_string(),
    };
    StoreError::Away { message }
}

/// Whether the same may well succeed on another connection, at once.
pub(super) fn is_worth_another_try(error: &Error) -> bool {
    match error.code() {
        Some(code) => [
            SqlState::ADMIN_SHUTDOWN,
            SqlState::CRASH_SHUTDOWN,
            SqlState::T_R_DEADLOCK_DETECTED,
            SqlState::T_R_SERIALIZATION_FAILURE,
        ]
        .contains(code),
        None => is_broken(error),
    }
}

/// Whether another writer was faster with what is to be there once.
pub(super) fn is_taken(error: &Error) -> bool {
    error.code() == Some(&SqlState::UNIQUE_VIOLATION)
}

fn means_away(code: &SqlState) -> bool {
    // 08: connections; 57P: the server starts or stops.
    code.code().starts_with("08")
        || code.code().starts_with("57P")
        || [
            SqlState::TOO_MANY_CONNECTIONS,
            // It took too long, or waited too long for another.
            SqlState::QUERY_CANCELED,
            SqlState::LOCK_NOT_AVAILABLE,
            // A server that only reads: another one is to take over.
            SqlState::READ_ONLY_SQL_TRANSACTION,
        ]
        .contains(code)
}

fn is_broken(error: &Error) -> bool {
    let is_io = |cause: &(dyn std::error::Error + 'static)| cause.is::<io::Error>();
    error.is_closed() || error.source().is_some_and(is_io)
}
