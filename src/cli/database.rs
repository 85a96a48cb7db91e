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

/// What names a database: a file, or an address in which nothing can be misread. What
/// is neither may hold a password, which must not become the name of a file.
///
/// # Errors
///
/// If it names none; its password is not told.
pub(super) fn name(text: &str) -> Result<String, String> {
    fault(text).map_or_else(|| Ok(text.to_owned()), Err)
}

fn fault(text: &str) -> Option<String> {
    const WAYS: &str =
        "write postgres://USER:PASSWORD@HOST:PORT/NAME, or ./ before the name of a file";
    // How libpq's tools are told where a database is.
    const PARTS: [&str; 8] = [
        "host", "hostaddr", "port", "dbname", "user", "password", "passfile", "service",
    ];
    if text.trim().is_empty() {
        return Some("it names no file: give one, such as memrep.db".to_owned());
    }
    if is_elsewhere(text) {
        return address_fault(text);
    }
    if let Some((scheme, _)) = text.split_once("://") {
        return Some(format!(
            "`{scheme}://` is no address of a database that memrep knows: give a file, or postgres://USER@HOST/NAME"
        ));
    }
    if text == ":memory:" || text.starts_with("file:") {
        return Some(
            "this is an address of SQLite's own, and no file: give one, such as memrep.db"
                .to_owned(),
        );
    }
    let is_pair = |(part, _): (&str, &str)| PARTS.contains(&part.trim());
    if text.split_once('=').is_some_and(is_pair) {
        return Some(format!("`key=value` pairs name no database here: {WAYS}"));
    }
    let slip = ["postgresql", "postgres"].into_iter().any(|scheme| {
        let rest = text.strip_prefix(scheme).unwrap_or_default();
        rest.starts_with(':') || rest.starts_with("//")
    });
    // As in `user:password@host`, and not as in `C:\`.
    let login = text
        .split_once(':')
        .is_some_and(|(_, rest)| rest.contains('@') && !rest.starts_with('\\'));
    (slip || login).then(|| format!("this looks like an address and is none: {WAYS}"))
}

/// What `PostgreSQL`'s client would read otherwise than it was meant.
fn address_fault(text: &str) -> Option<String> {
    let (_, rest) = text.split_once("://")?;
    if rest.matches('@').count() > 1 {
        return Some(
            "there is more than one `@` in it: those of a password are written %40, and its `/` %2F"
                .to_owned(),
        );
    }
    let rest = rest.split_once('@').map_or(rest, |(_, rest)| rest);
    let hosts = rest.split(['/', '?']).next()?;
    let is_wrong = |host: &str| {
        let port = host.rsplit_once(':').filter(|_| !host.ends_with(']'));
        port.is_some_and(|(_, port)| port.parse::<u16>().is_err())
    };
    hosts.split(',').any(is_wrong).then(|| {
        "after the host's `:` stands its port, from 1 to 65535: a user and a password end in `@`"
            .to_owned()
    })
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
