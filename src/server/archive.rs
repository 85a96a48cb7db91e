//! Where sessions come from and what becomes of them: their logs in the store, read
//! from the beginning or from where they were left, and written entry by entry. Must
//! not know who asks, nor think.

use std::sync::Arc;
use std::time::Instant;

use super::ahead::Trial;
use super::error::WebError;
use super::metrics::Metrics;
use super::upload::Pools;
use crate::session::{Corrupt, Event, Session};
use crate::store::{Entry, SessionId, Store, StoreError};

/// The store, and what is in memory of its uploads.
pub(crate) struct Archive {
    pub(crate) store: Arc<dyn Store>,
    pub(crate) pools: Pools,
    pub(crate) metrics: Arc<Metrics>,
}

impl Archive {
    /// The session as its whole log says.
    pub(crate) fn load(&self, id: &SessionId) -> Result<Session, WebError> {
        let events = self.events(id, 0)?;
        if events.is_empty() {
            return Err(WebError::NoSession);
        }
        let world = match events.first() {
            Some(Event::Created { task, .. }) => self.pools.world(&*self.store, task),
            _ => Ok(None),
        };
        // Whoever asks for the session cannot have caused it.
        let world = world.map_err(|error| match error {
            WebError::Malformed(fault) => WebError::internal(fault),
            other => other,
        })?;
        Session::replay_in(world, &events).map_err(WebError::Corrupt)
    }

    /// The session with what other servers wrote since it was last here.
    pub(crate) fn catch_up(
        &self,
        id: &SessionId,
        mut session: Session,
    ) -> Result<Session, WebError> {
        for event in self.events(id, session.entries())? {
            session.apply(&event).map_err(WebError::Corrupt)?;
        }
        Ok(session)
    }

    /// A session's log from this entry on.
    fn events(&self, id: &SessionId, from: u64) -> Result<Vec<Event>, WebError> {
        let entries = match from {
            0 => self.store.read(id),
            _ => self.store.read_from(id, from),
        };
        let entries = entries.map_err(WebError::internal)?;
        let events = entries.iter().map(|entry| {
            serde_json::from_str(&entry.body).map_err(|error| Corrupt {
                entry: entry.seq,
                message: error.to_string(),
            })
        });
        let events: Result<Vec<Event>, Corrupt> = events.collect();
        events.map_err(WebError::Corrupt)
    }

    /// Appends the entries of a trial to the store, all or none, and goes on with its
    /// session; if another writer was faster, reads the session again instead and says
    /// `false`.
    pub(crate) fn adopt(
        &self,
        id: &SessionId,
        session: &mut Session,
        trial: Trial,
    ) -> Result<bool, WebError> {
        let Trial {
            cause,
            effects,
            session: then,
            ..
        } = trial;
        let events: Vec<&Event> = std::iter::once(&cause).chain(&effects).collect();
        if !self.keep(id, session.entries(), &events)? {
            *session = self.load(id)?;
            return Ok(false);
        }
        *session = then;
        Ok(true)
    }

    /// Appends an entry to the store, then to the session; if another writer was
    /// faster, reads the session again instead and says `false`.
    pub(crate) fn append(
        &self,
        id: &SessionId,
        session: &mut Session,
        event: &Event,
    ) -> Result<bool, WebError> {
        if self.keep(id, session.entries(), &[event])? {
            session.apply(event).map_err(WebError::Corrupt)?;
            Ok(true)
        } else {
            *session = self.load(id)?;
            Ok(false)
        }
    }

    /// Appends entries to the store, all or none; `false` if another writer was faster.
    fn keep(&self, id: &SessionId, first: u64, events: &[&Event]) -> Result<bool, WebError> {
        let bodies: Result<Vec<String>, _> = events.iter().map(serde_json::to_string).collect();
        let bodies = bodies.map_err(WebError::internal)?;
        let bodies: Vec<&str> = bodies.iter().map(String::as_str).collect();
        let begun = Instant::now();
        match self.store.append_all(id, first, &bodies) {
            Ok(()) => {
                self.metrics.appended(events, begun.elapsed());
                Ok(true)
            }
            Err(StoreError::Taken { .. }) => self.has(id, first, &bodies),
            Err(error) => Err(WebError::internal(error)),
        }
    }

    /// Whether a session's log goes on with these entries from there. They are ours: a
    /// store that was out of reach for a moment may have kept what it could not say
    /// that it kept. Or another writer decided the very same, which then happened once.
    fn has(&self, id: &SessionId, first: u64, bodies: &[&str]) -> Result<bool, WebError> {
        let there = match first {
            0 => self.store.read(id),
            _ => self.store.read_from(id, first),
        };
        let there = there.map_err(WebError::internal)?;
        let same = |(entry, body): (&Entry, &&str)| entry.body == **body;
        Ok(there.len() >= bodies.len() && there.iter().zip(bodies).all(same))
    }

    /// What became of the beginning of a new session with this first entry.
    pub(crate) fn begun(
        &self,
        id: &SessionId,
        body: &str,
        kept: Result<(), StoreError>,
    ) -> Result<(), WebError> {
        match kept {
            Err(StoreError::Taken { .. }) if self.has(id, 0, &[body])? => Ok(()),
            other => other.map_err(WebError::internal),
        }
    }
}
