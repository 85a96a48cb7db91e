//! Servers tell each other by LISTEN and NOTIFY which sessions have grown.
//!
//! News are sent after the commit, from a connection of their own: a NOTIFY inside
//! the transaction would make all commits of the database wait for each other. A
//! server that dies in between, or a connection that breaks, loses some; what was
//! written lately is therefore looked up when a connection comes about, and every
//! few seconds.

use std::collections::HashMap;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use tokio::runtime::Handle;
use tokio::sync::mpsc::{UnboundedReceiver, UnboundedSender, unbounded_channel};
use tokio::time::{interval, sleep};
use tokio_postgres::{AsyncMessage, Client};

use super::connect::Door;
use crate::store::{Hear, SessionId};

const CHANNEL: &str = "memrep";
/// How often what was written lately is looked up.
const ROUND: Duration = Duration::from_secs(10);
/// How long to wait before the database is tried again.
const PAUSE: Duration = Duration::from_millis(500);

/// Who wants to hear.
#[derive(Default)]
pub(super) struct Ears(Mutex<Vec<Hear>>);

impl Ears {
    pub(super) fn add(&self, hear: Hear) {
        self.hears().push(hear);
    }

    fn tell(&self, session: SessionId, entries: u64) {
        for hear in self.hears().iter() {
            hear(session, entries);
        }
    }

    fn hears(&self) -> MutexGuard<'_, Vec<Hear>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Listens from now on; what is sent to the channel is told to all other servers.
pub(super) fn start(
    runtime: &Handle,
    door: Door,
    ears: Arc<Ears>,
) -> UnboundedSender<(SessionId, u64)> {
    let (grown, mut told) = unbounded_channel();
    runtime.spawn(async move {
        // The last time that is known to have been looked up.
        let mut since = None;
        loop {
            match listen(&door, &ears, &mut told, &mut since).await {
                Ok(()) => return,
                Err(cause) => tracing::warn!(
                    cause = super::told(&cause),
                    "news of other servers are interrupted"
                ),
            }
            sleep(PAUSE).await;
        }
    });
    grown
}

/// Listens until the connection breaks, or the store goes.
async fn listen(
    door: &Door,
    ears: &Ears,
    told: &mut UnboundedReceiver<(SessionId, u64)>,
    since: &mut Option<String>,
) -> Result<(), tokio_postgres::Error> {
    let (client, mut connection) = door.connect().await?;
    let (heard, mut news) = unbounded_channel();
    // The connection is at work for as long as somebody asks it for messages.
    tokio::spawn(async move {
        loop {
            let message = std::future::poll_fn(|context| connection.poll_message(context)).await;
            let passed = match message {
                Some(Ok(AsyncMessage::Notification(note))) => {
                    heard.send(Ok(note.payload().to_owned()))
                }
                Some(Ok(_)) => Ok(()),
                Some(Err(error)) => {
                    let _ = heard.send(Err(error));
                    return;
                }
                None => return,
            };
            if passed.is_err() {
                return;
            }
        }
    });
    let listen = format!("SET statement_timeout = '10s'; LISTEN {CHANNEL}");
    client.batch_execute(&listen).await?;
    let mut round = interval(ROUND);
    loop {
        tokio::select! {
            note = news.recv() => match note {
                Some(Ok(payload)) => {
                    if let Some((session, entries)) = read(&payload) {
                        ears.tell(session, entries);
                    }
                }
                Some(Err(error)) => return Err(error),
                // Its last words are those of the next statement.
                None => return client.batch_execute("").await,
            },
            grown = told.recv() => match grown {
                Some(first) => pass_on(&client, first, told).await?,
                None => return Ok(()),
            },
            _ = round.tick() => look_up(&client, ears, since).await?,
        }
    }
}

/// Tells the other servers, of every session the latest only.
async fn pass_on(
    client: &Client,
    first: (SessionId, u64),
    told: &mut UnboundedReceiver<(SessionId, u64)>,
) -> Result<(), tokio_postgres::Error> {
    let mut latest = HashMap::from([first]);
    while let Ok((session, entries)) = told.try_recv() {
        latest.insert(session, entries);
    }
    let payloads = latest.iter().map(|(id, entries)| format!("{id} {entries}"));
    let payloads: Vec<String> = payloads.collect();
    let notify = "SELECT pg_notify($1::text, payload) FROM unnest($2::text[]) AS payload";
    client
        .execute(notify, &[&CHANNEL, &payloads])
        .await
        .map(drop)
}

/// Tells what was written since the last time, a little more than that: an entry's
/// time is earlier than its commit.
async fn look_up(
    client: &Client,
    ears: &Ears,
    since: &mut Option<String>,
) -> Result<(), tokio_postgres::Error> {
    let now = client
        .query_one("SELECT clock_timestamp()::text", &[])
        .await?;
    let Some(before) = since.as_ref() else {
        *since = Some(now.get(0));
        return Ok(());
    };
    let grown = "SELECT session, max(seq) + 1 FROM entries
         WHERE at > $1::text::timestamptz - interval '30 seconds' GROUP BY session";
    for row in client.query(grown, &[before]).await? {
        let id: String = row.get(0);
        if let Ok(session) = id.parse() {
            ears.tell(session, row.get::<_, i64>(1).cast_unsigned());
        }
    }
    *since = Some(now.get(0));
    Ok(())
}

/// What a note says: a session and how many entries it has.
fn read(payload: &str) -> Option<(SessionId, u64)> {
    let (session, entries) = payload.split_once(' ')?;
    Some((session.parse().ok()?, entries.parse().ok()?))
}
