//! Where sessions are kept: a file, or a `PostgreSQL` database that several servers
//! share.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use clap::ArgMatches;

use super::{serve, settings};
use crate::store::{Sqlite, Store};

/// Which database a command beside the server is for: the server's own, unless it says
/// another.
#[derive(Debug, clap::Args)]
pub(super) struct Which {
    /// The database: as for the server, if nothing is said: `memrep.db`, or what
    /// `MEMREP_DATABASE` or the file of settings says.
    #[arg(long, value_name = "PATH|URL")]
    database: Option<String>,
    /// The server's file of settings, if it is not `memrep.toml`.
    #[arg(long, value_name = "FILE")]
    config: Option<PathBuf>,
}

/// The database that the settings name, given the flags of a command with [`Which`].
pub(super) fn named(flags: &ArgMatches) -> anyhow::Result<String> {
    Ok(settings::resolve::<serve::Args>(flags)?.0.database)
}

/// What names a database: for `SQLite` nothing would be a database that is gone when it
/// is closed.
///
/// # Errors
///
/// If it names none, or one in a way that is not known here; its password is not told.
pub(super) fn name(text: &str) -> Result<String, String> {
    // How libpq's tools are told where a database is: a password among that must not
    // become the name of a file.
    const PARTS: [&str; 8] = [
        "host", "hostaddr", "port", "dbname", "user", "password", "passfile", "service",
    ];
    if text.trim().is_empty() {
        return Err("it names no file: give one, such as memrep.db".to_owned());
    }
    match text.split_once("://") {
        Some((scheme, _)) if !is_elsewhere(text) => Err(format!(
            "`{scheme}://` is no address of a database that memrep knows: give a file, or postgres://USER@HOST/NAME"
        )),
        None if text.split_once('=').is_some_and(|(part, _)| PARTS.contains(&part.trim())) => Err(
            "`key=value` pairs name no database here: write postgres://USER:PASSWORD@HOST:PORT/NAME, or ./ before the name of a file".to_owned(),
        ),
        _ => Ok(text.to_owned()),
    }
}

/// Whether this is the name of a file that is not there.
pub(super) fn is_missing(database: &str) -> bool {
    !is_elsewhere(database) && !Path::new(database).exists()
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
