//! `memrep serve`: the pages and the API, from one file of sessions.

use std::io::ErrorKind;
use std::net::SocketAddr;
use std::path::PathBuf;
use std::process::ExitCode;
use std::sync::Arc;
use std::time::Duration;

use anyhow::{Context as _, anyhow, bail};
use clap::ArgMatches;
use tokio::net::TcpListener;
use tracing_subscriber::filter::Targets;

use super::{database, log, output, settings};
use crate::server::{self, AppState, Limits, Origin, Reached};
use crate::store::Store;

/// How long work that nobody waits for any more may go on at the end.
const LAST_WORK: Duration = Duration::from_secs(1);

/// Arguments of `memrep serve`, and with that all settings of the server.
///
/// A new setting is a field here, and nothing else: an option `--idle-time` becomes
/// the variable `MEMREP_IDLE_TIME` and the key `idle_time` of `memrep.toml`, and is
/// told by `memrep config`. `Option<T>` is one that need not hold, `Vec<T>` one that
/// may be said several times (an array in the file, with blanks between in the
/// variable), `bool` a switch, `u16` to `u64`
/// a number in the file, and anything else a string there. One whose name ends in
/// `password` is never shown, nor is a password in an address (`scheme://user:…@`).
#[derive(Debug, clap::Args)]
#[command(
    after_help = "Every option but --config is also a key of memrep.toml and a variable of the
environment: --lease is `lease` and MEMREP_LEASE. A flag counts before the
environment, and that before the file; `memrep config` tells what holds and why.

Examples:
  memrep serve
  memrep serve --addr 127.0.0.1:9000 --database lab.db
  MEMREP_LOG=debug memrep serve
  memrep serve --config /etc/memrep.toml"
)]
pub(crate) struct Args {
    /// The address and port to serve on; port 0 takes a free one.
    #[arg(long, value_name = "ADDRESS:PORT", default_value = "127.0.0.1:8080")]
    pub(super) addr: SocketAddr,
    /// The database file in which sessions are kept, created if there is none; or the
    /// address of a `PostgreSQL` database that several servers share.
    #[arg(long, value_name = "PATH|ADDRESS", default_value = "memrep.db",
          value_parser = database::name)]
    pub(super) database: String,
    /// How long one of several people has a question before it is offered to
    /// another, in seconds.
    #[arg(long, value_name = "SECONDS", default_value = "120",
          value_parser = clap::value_parser!(u32).range(1..=86400))]
    pub(super) lease: u32,
    /// What is logged: error, warn, info, debug, trace or off, also by the part of
    /// the program, as in `info,memrep::server=debug`. `RUST_LOG` is heard too.
    #[arg(long, value_name = "LEVEL", default_value = "info", value_parser = log::levels)]
    pub(super) log: Targets,
    /// Lines of the log for people, or one JSON object a line.
    #[arg(long, value_name = "FORMAT", value_enum, default_value_t = log::Format::Text)]
    pub(super) log_format: log::Format,
    /// An address of its own for /metrics and /healthz; without it they are on the
    /// main one, and /metrics answers nobody but this machine.
    #[arg(long, value_name = "ADDRESS:PORT")]
    pub(super) metrics_addr: Option<SocketAddr>,
    /// An address under which people reach the server, as in
    /// `https://teach.example.org`, where a proxy has the certificate; may be said
    /// several times.
    #[arg(long, value_name = "URL")]
    pub(super) origin: Vec<Origin>,
    /// A proxy is before the server and says for whom it asks: the last address in
    /// X-Forwarded-For counts for limits.
    #[arg(long)]
    pub(super) behind_proxy: bool,
    /// How many connections may be open at once: a page that is open is one or two. Who
    /// comes then is told to come again.
    #[arg(long, value_name = "N", default_value = "2048",
          value_parser = clap::value_parser!(u16).range(16..))]
    pub(super) connections: u16,
    /// A file of settings; without it memrep.toml in the working folder, if it is there.
    #[arg(long, value_name = "FILE")]
    pub(super) config: Option<PathBuf>,
}

/// Runs the command, given how it was called.
pub(super) fn run(flags: &ArgMatches) -> anyhow::Result<ExitCode> {
    let (args, _) = settings::resolve::<Args>(flags)?;
    allow_many_connections();
    let _written = log::start(args.log_format, args.log.clone());
    let runtime = tokio::runtime::Builder::new_multi_thread()
        .enable_all()
        .build()
        .context("the async runtime cannot start")?;
    let opened = runtime.block_on(open(&args))?;
    let store = Arc::clone(&opened.store);
    let served = runtime.block_on(serve(args, opened));
    runtime.shutdown_timeout(LAST_WORK);
    // Nobody is asked any more: what the store put off can be done now.
    if let Err(cause) = store.rest() {
        tracing::warn!(%cause, "the store could not be left in order; it will be at the next start");
    }
    tracing::info!("stopped");
    served.map(|()| ExitCode::SUCCESS)
}

/// What the server has in its hands when it starts.
struct Opened {
    listener: TcpListener,
    figures: Option<TcpListener>,
    store: Arc<dyn Store>,
}

/// The ports first: a second server on the same port must not touch the file.
async fn open(args: &Args) -> anyhow::Result<Opened> {
    let listener = bind(args.addr, "--addr").await?;
    let figures = match args.metrics_addr {
        Some(address) => Some(bind(address, "--metrics-addr").await?),
        None => None,
    };
    let (named, is_public) = (args.database.clone(), is_public(args));
    let opening = tokio::task::spawn_blocking(move || {
        if is_public && database::is_missing(&named) {
            return Err(unlocked(&named));
        }
        let store = database::open(&named)?;
        if is_public && store.visits().password()?.is_none() {
            return Err(unlocked(&named));
        }
        anyhow::Ok(store)
    });
    let store = opening.await.context("the store cannot be opened")??;
    Ok(Opened {
        listener,
        figures,
        store,
    })
}

async fn bind(address: SocketAddr, flag: &str) -> anyhow::Result<TcpListener> {
    match TcpListener::bind(address).await {
        Ok(listener) => Ok(listener),
        Err(error) if error.kind() == ErrorKind::AddrInUse => bail!(
            "port {} is in use, perhaps by another memrep: stop that program, or choose another port with {flag} {}:0",
            address.port(),
            address.ip()
        ),
        Err(error) if error.kind() == ErrorKind::PermissionDenied => bail!(
            "port {} needs special rights: choose one above 1023 with {flag}",
            address.port()
        ),
        Err(error) => Err(error).context(format!(
            "cannot serve on {address}: choose another address with {flag}"
        )),
    }
}

async fn serve(args: Args, opened: Opened) -> anyhow::Result<()> {
    let at = opened.listener.local_addr();
    let at = at.context("the address is unknown")?;
    let stop = stop_signal()?;
    let lease = Duration::from_secs(args.lease.into());
    let reached = Reached {
        is_public: is_public(&args),
        behind_proxy: args.behind_proxy,
        origins: args.origin,
    };
    let origins = reached.origins.clone();
    let limits = Limits {
        connections: usize::from(args.connections),
        ..Limits::default()
    };
    let state = AppState::with_lease(opened.store, lease);
    let mut state = state.reached(reached).with_limits(limits);
    say(format_args!("memrep is at http://{at}/"));
    for origin in origins {
        say(format_args!("People reach it at {origin}/"));
    }
    let database = settings::masked(&args.database);
    say(format_args!(
        "Sessions are kept in {database}. Stop with Ctrl+C."
    ));
    tracing::info!(version = env!("CARGO_PKG_VERSION"), addr = %at, database, "started");
    if let Some(listener) = opened.figures {
        let at = listener.local_addr().context("the address is unknown")?;
        say(format_args!("Figures are at http://{at}/metrics"));
        state = state.with_figures_apart();
        tokio::spawn(server::run_figures(listener, state.clone()));
    }
    let stop = async {
        stop.await;
        tracing::info!("stopping: requests in progress are answered first");
    };
    server::run(opened.listener, state, stop).await;
    Ok(())
}

/// Tells whoever started the server; it serves also where nobody reads that.
fn say(text: std::fmt::Arguments<'_>) {
    // A reader that is gone, or a full disk, is nobody's loss here.
    let _ = output::line(text);
}

/// Lets the process have as many connections as the system allows it: a common bound
/// is 1024, and every open page of a session is one.
#[cfg(unix)]
pub(super) fn allow_many_connections() {
    use rustix::process::{Resource, getrlimit, setrlimit};
    let mut limit = getrlimit(Resource::Nofile);
    limit.current = limit.maximum;
    // Where this is refused, the bound stays as it was.
    let _ = setrlimit(Resource::Nofile, limit);
}

/// There is no such bound.
#[cfg(not(unix))]
pub(super) fn allow_many_connections() {}

/// Whether other machines can reach the server, by itself or through a proxy.
fn is_public(args: &Args) -> bool {
    !args.addr.ip().is_loopback() || !args.origin.is_empty() || args.behind_proxy
}

/// Whoever reaches a server without a password can read and answer: it does not start.
fn unlocked(database: &str) -> anyhow::Error {
    anyhow!(
        "other machines could reach this server, and it has no owner's password: set one with `memrep password --database {}`; then serve on 127.0.0.1 behind a proxy that has a certificate (memrep serve --behind-proxy --origin https://teach.example.org), since without TLS the password can be read on its way. Or stay on 127.0.0.1, and come from elsewhere by an SSH tunnel (ssh -L 8080:127.0.0.1:8080 HOST)",
        settings::masked(database)
    )
}

/// Resolves at Ctrl+C, and where there are signals at SIGTERM.
#[cfg(unix)]
pub(super) fn stop_signal() -> anyhow::Result<impl Future<Output = ()> + Send + 'static> {
    use tokio::signal::unix::{SignalKind, signal};
    let mut interrupt = signal(SignalKind::interrupt()).context("no handler for SIGINT")?;
    let mut terminate = signal(SignalKind::terminate()).context("no handler for SIGTERM")?;
    Ok(async move {
        tokio::select! {
            _ = interrupt.recv() => {}
            _ = terminate.recv() => {}
        }
    })
}

/// Resolves at Ctrl+C.
#[cfg(not(unix))]
pub(super) fn stop_signal() -> anyhow::Result<impl Future<Output = ()> + Send + 'static> {
    Ok(async {
        if tokio::signal::ctrl_c().await.is_err() {
            // No handler: only the operating system can stop us.
            std::future::pending::<()>().await;
        }
    })
}
