//! What would follow every answer, worked out while a person still looks at the
//! question. Must not write: only an answer that was given is appended.

use std::collections::VecDeque;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use tokio::sync::{Semaphore, watch};

use super::busy::Busy;
use crate::evidence::Stop;
use crate::session::{Event, Position, Session};
use crate::store::SessionId;

/// For so many sessions answers are worked out at the same time, those that were
/// looked at last.
const SESSIONS: usize = 32;

/// An answer that might be given, and where it leads.
pub(crate) struct Trial {
    /// The entry that would be appended.
    pub(crate) cause: Event,
    /// The entries that the learner would append after it.
    pub(crate) effects: Vec<Event>,
    /// The session after all of them.
    pub(crate) session: Session,
    /// How long it took to work that out.
    pub(crate) took: Duration,
}

impl Trial {
    /// Where this entry leads; none if it makes no sense here, or nobody wants it.
    fn of(session: &Session, cause: Event, stop: &Stop) -> Option<Self> {
        let begun = Instant::now();
        let mut session = session.fork();
        session.apply(&cause).ok()?;
        let mut effects = Vec::new();
        while let Some(effect) = session.think_until(stop) {
            session.apply(&effect).ok()?;
            effects.push(effect);
        }
        (!stop.is_set()).then_some(Self {
            cause,
            effects,
            session,
            took: begun.elapsed(),
        })
    }
}

/// What is worked out about a session as it stands.
struct Ahead {
    /// The number of entries of its log.
    entries: u64,
    trials: Mutex<Vec<Trial>>,
    /// Whether all trials were made.
    ended: watch::Sender<bool>,
    /// Whether nobody wants them any more.
    stale: Stop,
}

/// So long the page that was asked for has the machine for itself. Nobody answers
/// sooner, and on a small machine trials would delay what they are to hasten.
const BREATH: Duration = Duration::from_millis(150);

/// Of the cores so much may be at work for people before nothing is tried out any
/// more: trials take several times as long as the answer that is given.
const SPARE: f64 = 0.25;

/// The trials of the sessions looked at last.
pub(crate) struct Foresight {
    sessions: Mutex<VecDeque<(SessionId, Arc<Ahead>)>>,
    /// Trials leave a core to those who wait, if there is more than one.
    spare: Arc<Semaphore>,
    width: usize,
}

impl Foresight {
    /// On a machine with so many cores.
    pub(crate) fn new(width: usize) -> Self {
        Self {
            sessions: Mutex::default(),
            spare: Arc::new(Semaphore::new((width / 2).max(1))),
            width,
        }
    }

    /// Begins to work out what may follow, unless that was begun already. Trials
    /// take their turns at `permits` with everybody's work, and are not made where the
    /// machine is busy with what people wait for.
    pub(crate) fn prepare(
        &self,
        id: SessionId,
        session: &Session,
        permits: &Arc<Semaphore>,
        busy: &Arc<Busy>,
    ) {
        // What mends a contradiction is told on the page itself, which waits for it.
        let is_told = matches!(session.position(), Position::Conflict(_));
        let most = SPARE * self.width as f64;
        if !is_told && busy.cores() > most {
            return;
        }
        let foreseen = session.foreseen();
        let Some(ahead) = self.open(id, session.entries(), foreseen.is_empty()) else {
            return;
        };
        let mut session = session.fork();
        let (spare, permits) = (Arc::clone(&self.spare), Arc::clone(permits));
        let busy = Arc::clone(busy);
        tokio::spawn(async move {
            if !is_told {
                tokio::time::sleep(BREATH).await;
            }
            for event in foreseen {
                let turn = (
                    spare.acquire().await,
                    Arc::clone(&permits).acquire_owned().await,
                );
                let is_over = ahead.stale.is_set() || !is_told && busy.cores() > most;
                let ((Ok(_spare), Ok(permit)), false) = (turn, is_over) else {
                    break;
                };
                let stale = ahead.stale.clone();
                let trial = tokio::task::spawn_blocking(move || {
                    let _permit = permit;
                    (Trial::of(&session, event, &stale), session)
                });
                match trial.await {
                    Ok((trial, back)) => {
                        session = back;
                        ahead.trials().extend(trial);
                    }
                    Err(panic) => {
                        tracing::error!(%panic, "a trial failed");
                        break;
                    }
                }
            }
            ahead.ended.send_replace(true);
        });
    }

    /// A place for new trials; none where they were begun already, or there is
    /// nothing to try.
    fn open(&self, id: SessionId, entries: u64, nothing: bool) -> Option<Arc<Ahead>> {
        let mut sessions = self.sessions();
        if let Some(place) = sessions.iter().position(|(known, _)| *known == id) {
            if sessions[place].1.entries == entries {
                return None;
            }
            sessions.remove(place).inspect(|(_, old)| old.give_up());
        }
        if nothing {
            return None;
        }
        if sessions.len() >= SESSIONS {
            sessions.pop_front().inspect(|(_, old)| old.give_up());
        }
        let ahead = Arc::new(Ahead {
            entries,
            trials: Mutex::default(),
            ended: watch::Sender::new(false),
            stale: Stop::default(),
        });
        sessions.push_back((id, Arc::clone(&ahead)));
        Some(ahead)
    }

    /// The trial of this entry, if it was made of the session as it stands. The
    /// others are of no use after it.
    pub(crate) fn take(&self, id: SessionId, session: &Session, cause: &Event) -> Option<Trial> {
        let mut sessions = self.sessions();
        let place = sessions.iter().position(|(known, _)| *known == id)?;
        let (_, ahead) = sessions.remove(place)?;
        ahead.give_up();
        if ahead.entries != session.entries() {
            return None;
        }
        let mut trials = ahead.trials();
        let place = trials.iter().position(|trial| trial.cause == *cause)?;
        Some(trials.swap_remove(place))
    }

    /// What `view` shows of every trial of the session as it stands, once all were
    /// made or `patience` has ended.
    pub(crate) async fn survey<T>(
        &self,
        id: SessionId,
        entries: u64,
        patience: Duration,
        view: impl Fn(&Trial) -> T,
    ) -> Vec<T> {
        let ahead = {
            let sessions = self.sessions();
            let known = sessions.iter().find(|(known, _)| *known == id);
            known.map(|(_, ahead)| Arc::clone(ahead))
        };
        let Some(ahead) = ahead.filter(|ahead| ahead.entries == entries) else {
            return Vec::new();
        };
        let mut ended = ahead.ended.subscribe();
        // What is there when time is up is shown.
        let _ = tokio::time::timeout(patience, ended.wait_for(|ended| *ended)).await;
        ahead.trials().iter().map(view).collect()
    }

    /// Ends all trials: the server stops.
    pub(crate) fn end(&self) {
        for (_, ahead) in self.sessions().drain(..) {
            ahead.give_up();
        }
    }

    fn sessions(&self) -> MutexGuard<'_, VecDeque<(SessionId, Arc<Ahead>)>> {
        self.sessions.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Ahead {
    fn give_up(&self) {
        self.stale.set();
    }

    fn trials(&self) -> MutexGuard<'_, Vec<Trial>> {
        self.trials.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
