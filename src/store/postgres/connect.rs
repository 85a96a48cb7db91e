//! The way to a `PostgreSQL` server: its address, encryption, a pool of connections.

use std::sync::Arc;
use std::time::Duration;

use deadpool_postgres::{Hook, HookError, Manager, ManagerConfig, Pool, RecyclingMethod, Runtime};
use rustls::{ClientConfig, RootCertStore};
use tokio_postgres::config::{Host, SslMode};
use tokio_postgres::{Client, Config, Connection, Socket};
use tokio_postgres_rustls::MakeRustlsConnect;

use crate::store::StoreError;

/// How long a connection may take to come about, and how long one is waited for.
const PATIENCE: Duration = Duration::from_secs(5);
/// The most connections of one server.
const CONNECTIONS: usize = 16;

/// What holds on every connection. A commit that was acknowledged is on the disk,
/// whatever the database's own setting; stronger ones are left.
const SETTINGS: &str = "
SELECT set_config('synchronous_commit', 'on', false)
    WHERE current_setting('synchronous_commit') = 'off';
SET statement_timeout = '10s';
SET lock_timeout = '5s';
SET idle_in_transaction_session_timeout = '60s';
SET client_min_messages = warning;
";

/// An address, and how to go through it.
pub(super) struct Door {
    config: Config,
    tls: MakeRustlsConnect,
    shown: String,
}

impl Door {
    pub(super) fn read(address: &str) -> Result<Self, StoreError> {
        // What it says of certificates is what is done anyway.
        let plain = ["verify-full", "verify-ca"]
            .iter()
            .fold(address.to_owned(), |text, strict| {
                text.replace(&format!("sslmode={strict}"), "sslmode=require")
            });
        let unreadable = |message: String| StoreError::Unusable {
            path: "the address".to_owned(),
            message: format!(
                "{message}; it looks like postgres://USER:PASSWORD@HOST:5432/DATABASE"
            ),
        };
        let mut config: Config = plain
            .parse()
            .map_err(|error: tokio_postgres::Error| unreadable(super::told(&error)))?;
        if config.get_hosts().is_empty() {
            return Err(unreadable("it names no host".to_owned()));
        }
        if !plain.contains("sslmode=") {
            // Answers do not travel in the clear unless somebody says so.
            let mode = if config.get_hosts().iter().all(is_here) {
                SslMode::Disable
            } else {
                SslMode::Require
            };
            config.ssl_mode(mode);
        }
        config.tcp_user_timeout(2 * PATIENCE);
        config.keepalives_idle(Duration::from_secs(60));
        if config.get_connect_timeout().is_none() {
            config.connect_timeout(PATIENCE);
        }
        if config.get_application_name().is_none() {
            config.application_name("memrep");
        }
        let shown = shown(&config);
        let tls = tls(config.get_ssl_mode()).map_err(|message| StoreError::Unusable {
            path: shown.clone(),
            message,
        })?;
        Ok(Self { config, tls, shown })
    }

    /// Connections that are made when they are wanted.
    pub(super) fn pool(&self) -> Result<Pool, StoreError> {
        let recycling_method = RecyclingMethod::Fast;
        let config = ManagerConfig { recycling_method };
        let manager = Manager::from_config(self.config.clone(), self.tls.clone(), config);
        let settings = Hook::async_fn(|client: &mut deadpool_postgres::ClientWrapper, _| {
            Box::pin(async move {
                let set = client.batch_execute(SETTINGS).await;
                set.map_err(HookError::Backend)
            })
        });
        Pool::builder(manager)
            .max_size(CONNECTIONS)
            .runtime(Runtime::Tokio1)
            .wait_timeout(Some(PATIENCE))
            .create_timeout(Some(PATIENCE))
            .recycle_timeout(Some(PATIENCE))
            .post_create(settings)
            .build()
            .map_err(|error| self.unusable(error.to_string()))
    }

    /// A connection of its own.
    pub(super) async fn connect(
        &self,
    ) -> Result<(Client, Connection<Socket, Encrypted>), tokio_postgres::Error> {
        self.config.connect(self.tls.clone()).await
    }

    pub(super) fn unusable(&self, message: String) -> StoreError {
        StoreError::Unusable {
            path: self.shown.clone(),
            message,
        }
    }
}

/// What a connection is read through.
pub(super) type Encrypted =
    <MakeRustlsConnect as tokio_postgres::tls::MakeTlsConnect<Socket>>::Stream;

fn is_here(host: &Host) -> bool {
    match host {
        Host::Tcp(name) => {
            let address = name.parse::<std::net::IpAddr>();
            name == "localhost" || address.is_ok_and(|address| address.is_loopback())
        }
        #[cfg(unix)]
        Host::Unix(_) => true,
    }
}

/// The address without who may come in.
fn shown(config: &Config) -> String {
    let hosts = config.get_hosts().iter().map(|host| match host {
        Host::Tcp(name) => name.clone(),
        #[cfg(unix)]
        Host::Unix(folder) => folder.display().to_string(),
    });
    let hosts: Vec<String> = hosts.collect();
    let database = config.get_dbname().unwrap_or("postgres");
    format!("the PostgreSQL database {database} at {}", hosts.join(", "))
}

/// Encryption with the certificates that this machine trusts; none are looked for
/// where nothing is encrypted.
fn tls(mode: SslMode) -> Result<MakeRustlsConnect, String> {
    let mut roots = RootCertStore::empty();
    if mode != SslMode::Disable {
        let found = rustls_native_certs::load_native_certs();
        roots.add_parsable_certificates(found.certs);
        if roots.is_empty() {
            return Err(
                "this machine trusts no certificates, so that nothing can be encrypted: install ca-certificates, name a file of them in SSL_CERT_FILE, or say sslmode=disable in the address"
                    .to_owned(),
            );
        }
    }
    let provider = Arc::new(rustls::crypto::ring::default_provider());
    let versions =
        ClientConfig::builder_with_provider(provider).with_safe_default_protocol_versions();
    let config = versions.map_err(|error| error.to_string())?;
    let config = config.with_root_certificates(roots).with_no_client_auth();
    Ok(MakeRustlsConnect::new(config))
}
