//! Tells open pages and scripts that a session has gone on: the number of entries
//! of its log, as server-sent events.

use std::collections::HashMap;
use std::convert::Infallible;
use std::sync::{Mutex, MutexGuard, PoisonError};

use axum::extract::{Path, State};
use axum::http::HeaderMap;
use axum::response::IntoResponse;
use axum::response::sse::{Event, KeepAlive, Sse};
use tokio::sync::mpsc::channel;
use tokio::sync::watch;
use tokio::time::interval;
use tokio_stream::wrappers::ReceiverStream;
use tokio_stream::{Stream, StreamExt};

use super::AppState;
use super::api::session_id;
use super::error::{ApiError, WebError};
use super::invited::Guest;
use super::owner::{self, Seat};
use crate::session::Session;
use crate::store::SessionId;

/// Who waits for news of which session.
#[derive(Default)]
pub(crate) struct Live {
    sessions: Mutex<HashMap<SessionId, watch::Sender<u64>>>,
}

impl Live {
    /// News of this session, which has so many entries now; the first at once.
    pub(crate) fn follow(&self, id: SessionId, entries: u64) -> watch::Receiver<u64> {
        let mut sessions = self.sessions();
        let news = sessions
            .entry(id)
            .or_insert_with(|| watch::Sender::new(entries));
        news.send_if_modified(|known| set(known, entries));
        news.subscribe()
    }

    /// The session has so many entries now.
    pub(crate) fn tell(&self, id: SessionId, entries: u64) {
        let mut sessions = self.sessions();
        if let Some(news) = sessions.get(&id) {
            if news.is_closed() {
                sessions.remove(&id);
            } else {
                news.send_if_modified(|known| set(known, entries));
            }
        }
    }

    /// How many wait for news.
    pub(crate) fn followers(&self) -> usize {
        let sessions = self.sessions();
        sessions.values().map(watch::Sender::receiver_count).sum()
    }

    /// Ends everybody's news: the server stops.
    pub(crate) fn end(&self) {
        self.sessions().clear();
    }

    fn sessions(&self) -> MutexGuard<'_, HashMap<SessionId, watch::Sender<u64>>> {
        self.sessions.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Logs only grow.
fn set(known: &mut u64, entries: u64) -> bool {
    let is_news = entries > *known;
    *known = entries.max(*known);
    is_news
}

/// `GET /sessions/{id}/live`, and the same of the API: `entries` events, the
/// first at once, until the reader goes or may not stay, or the server stops.
pub(crate) async fn live(
    State(app): State<AppState>,
    Path(id): Path<String>,
    headers: HeaderMap,
) -> Result<impl IntoResponse, ApiError> {
    let session = session_id(&id)?;
    Ok(news(&app, session, headers, Seat::Teacher { session }, None).await?)
}

/// News of this session for whoever sits there and may have them, for as long as they
/// visit and the session knows them.
pub(crate) async fn news(
    app: &AppState,
    id: SessionId,
    headers: HeaderMap,
    seat: Seat,
    guest: Option<Guest>,
) -> Result<Sse<impl Stream<Item = Result<Event, Infallible>> + use<>>, WebError> {
    let entries = app.teaching.look(id, Session::entries).await?;
    let mut news = app.teaching.live().follow(id, entries);
    let (sender, events) = channel(1);
    let app = app.clone();
    tokio::spawn(async move {
        let mut tick = interval(app.limits.stays);
        // The first is at once, and they have just come in.
        tick.tick().await;
        let mut entries = *news.borrow_and_update();
        while sender.send(entries).await.is_ok() {
            entries = loop {
                tokio::select! {
                    changed = news.changed() => match changed {
                        Ok(()) => break *news.borrow_and_update(),
                        Err(_) => return,
                    },
                    _ = tick.tick() => {
                        // A session that is busy says nothing against them.
                        let knows = move |session: &Session| {
                            guest.is_none_or(|guest| guest.admit(session).is_ok())
                        };
                        let known = app.teaching.look(id, knows).await;
                        if !known.unwrap_or(true) || !owner::stays(&app, &headers, &seat).await {
                            return;
                        }
                    }
                    () = sender.closed() => return,
                }
            };
        }
    });
    let events = ReceiverStream::new(events).map(|entries| {
        let event = Event::default().event("entries");
        Ok(event.data(entries.to_string()))
    });
    Ok(Sse::new(events).keep_alive(KeepAlive::default()))
}
