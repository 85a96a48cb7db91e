//! Where sessions are kept: a file, or a `PostgreSQL` database that several servers
//! share.

use std::path::Path;
use std::sync::Arc;

use crate::store::{Sqlite, Store};

/// What `serve` would take as well, unless a flag or a file of settings says another.
pub(super) fn usual() -> String {
    std::env::var("MEMREP_DATABASE").unwrap_or_else(|_| "memrep.db".to_owned())
}

/// Whether this is the address of a database and no file.
pub(super) fn is_elsewhere(database: &str) -> bool {
    database.starts_with("postgres://") || database.starts_with("postgresql://")
}

/// The store in this file or at this address. Blocks.
pub(super) fn open(database: &str) -> anyhow::Result<Arc<dyn Store>> {
    if is_elsewhere(database) {
        return elsewhere(database);
    }
    Ok(Arc::new(Sqlite::open(Path::new(database))?))
}

#[cfg(feature = "postgres")]
fn elsewhere(address: &str) -> anyhow::Result<Arc<dyn Store>> {
    Ok(Arc::new(crate::store::Postgres::open(address)?))
}

#[cfg(not(feature = "postgres"))]
fn elsewhere(_: &str) -> anyhow::Result<Arc<dyn Store>> {
    anyhow::bail!(
        "this memrep was built without PostgreSQL: build it with `cargo install --path . --features postgres`, or name a file with --database"
    )
}
