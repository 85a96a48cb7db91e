//! Connections: how many there may be, and how long they may keep us waiting. Must not
//! know what is asked.

use std::io::{self, ErrorKind};
use std::net::SocketAddr;
use std::pin::pin;
use std::sync::Arc;
use std::time::Duration;

use axum::Router;
use axum::extract::{ConnectInfo, Request};
use hyper::body::Incoming;
use hyper::server::conn::http1;
use hyper::service::service_fn;
use hyper_util::rt::{TokioIo, TokioTimer};
use hyper_util::server::graceful::GracefulShutdown;
use tokio::io::{AsyncReadExt as _, AsyncWriteExt as _};
use tokio::net::{TcpListener, TcpStream};
use tokio::sync::Semaphore;
use tower::ServiceExt as _;

/// The largest head of a request, and the most that a connection holds of what has come
/// and was not yet asked for.
const HEAD_LIMIT: usize = 32 * 1024;
/// So many who are turned away are told so at the same time; others are only let go.
const TOLD: usize = 64;
/// How long somebody who is turned away has to listen.
const LISTEN: Duration = Duration::from_secs(1);
/// How long to wait where no connection can be taken: others have to end first.
const BREATH: Duration = Duration::from_millis(200);
/// What is said then.
const FULL: &str = "HTTP/1.1 503 Service Unavailable\r\nConnection: close\r\nRetry-After: 10\r\nCache-Control: no-store\r\nContent-Type: text/plain; charset=utf-8\r\nContent-Length: 97\r\n\r\nToo many connections are open at once. What was kept before is safe: try again in a few seconds.\n";

/// How much and how long connections may ask of the server.
#[derive(Clone, Copy, Debug)]
pub struct Limits {
    /// So many at once; who comes then is told to come again.
    pub connections: usize,
    /// How long the head of a request may take to arrive, counted from the moment when
    /// it could begin: so long may a connection be quiet, too.
    pub head: Duration,
    /// How long a body may take to arrive.
    pub body: Duration,
    /// How long an upload may take: 64 MiB over a slow line.
    pub upload: Duration,
    /// How often it is looked whether whoever follows a session may stay.
    pub stays: Duration,
}

impl Default for Limits {
    fn default() -> Self {
        Self {
            connections: 2048,
            head: Duration::from_secs(10),
            body: Duration::from_secs(30),
            upload: Duration::from_secs(15 * 60),
            stays: Duration::from_secs(15),
        }
    }
}

/// Serves `app` until `shutdown` resolves, and then until what had begun is answered.
pub(super) async fn serve(
    listener: TcpListener,
    app: Router,
    limits: &Limits,
    shutdown: impl Future<Output = ()>,
) {
    let mut http = http1::Builder::new();
    http.timer(TokioTimer::new())
        .header_read_timeout(limits.head)
        .max_header_size(HEAD_LIMIT)
        .max_buf_size(HEAD_LIMIT);
    // So that this is not done for every connection.
    let app: Router = app.with_state(());
    let places = Arc::new(Semaphore::new(limits.connections));
    let told = Arc::new(Semaphore::new(TOLD));
    let ending = GracefulShutdown::new();
    let mut is_full = false;
    let mut shutdown = pin!(shutdown);
    loop {
        let (stream, peer) = tokio::select! {
            accepted = accept(&listener) => accepted,
            () = &mut shutdown => break,
        };
        let Ok(place) = Arc::clone(&places).try_acquire_owned() else {
            if !is_full {
                tracing::warn!(limits.connections, "no more connections are taken");
            }
            is_full = true;
            turn_away(stream, &told);
            continue;
        };
        is_full = false;
        let app = app.clone();
        let answer = service_fn(move |mut request: Request<Incoming>| {
            request.extensions_mut().insert(ConnectInfo(peer));
            app.clone().oneshot(request)
        });
        let connection = http.serve_connection(TokioIo::new(stream), answer);
        let connection = ending.watch(connection);
        tokio::spawn(async move {
            // How a connection ends is the matter of whoever is at its other end.
            let _ = connection.await;
            drop(place);
        });
    }
    drop(listener);
    ending.shutdown().await;
}

/// The next connection.
async fn accept(listener: &TcpListener) -> (TcpStream, SocketAddr) {
    loop {
        match listener.accept().await {
            Ok((stream, peer)) => {
                // Answers are written as a whole; events would wait for the next.
                let _ = stream.set_nodelay(true);
                return (stream, peer);
            }
            Err(error) if is_theirs(&error) => {}
            Err(error) => {
                tracing::error!(%error, "no connection can be taken");
                tokio::time::sleep(BREATH).await;
            }
        }
    }
}

/// Whether only the connection that came has failed.
fn is_theirs(error: &io::Error) -> bool {
    use ErrorKind::{ConnectionAborted, ConnectionRefused, ConnectionReset};
    matches!(
        error.kind(),
        ConnectionAborted | ConnectionRefused | ConnectionReset
    )
}

/// Says that there is no place. Whoever has not sent all would lose that with the
/// connection, so it ends only once they have, or after a moment.
fn turn_away(mut stream: TcpStream, told: &Arc<Semaphore>) {
    let Ok(turn) = Arc::clone(told).try_acquire_owned() else {
        return;
    };
    tokio::spawn(async move {
        let telling = async {
            stream.write_all(FULL.as_bytes()).await?;
            stream.shutdown().await?;
            let mut rest = [0; 1024];
            while stream.read(&mut rest).await? > 0 {}
            io::Result::Ok(())
        };
        // It is said, or they do not listen.
        let _ = tokio::time::timeout(LISTEN, telling).await;
        drop(turn);
    });
}

#[cfg(test)]
mod tests {
    use super::FULL;

    #[test]
    fn what_is_said_to_those_who_are_turned_away_has_the_length_that_it_says() {
        let (head, body) = FULL.split_once("\r\n\r\n").unwrap();
        assert!(
            head.contains(&format!("Content-Length: {}\r\n", body.len()))
                || head.ends_with(&format!("Content-Length: {}", body.len())),
            "{}",
            body.len()
        );
    }
}
