//! The sessions that are in memory, each at a desk of its own, at which one thing is
//! done at a time; and who waits for what is done there. Must not know what is done.

use std::collections::HashMap;
use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use tokio::sync::Mutex as AsyncMutex;

use crate::evidence::Stop;
use crate::session::Session;
use crate::store::SessionId;

/// How many folded sessions are kept in memory; the others wait in the store.
const KEPT: usize = 600;

/// So long a session is kept that nobody asks for. Whoever thinks longer about a question
/// waits a moment for the next, whose session is read and thought through anew.
const LINGER: Duration = Duration::from_secs(120);

/// So often those that linger are looked for.
const TIDY: Duration = Duration::from_secs(5);

/// A session's place in memory.
#[derive(Default)]
pub(crate) struct Desk {
    /// `None` until it is read from the store, or once its work has failed, so that
    /// the store's word counts again.
    session: Arc<AsyncMutex<Option<Session>>>,
    waiting: AtomicUsize,
    unsettled: AtomicUsize,
    stop: Mutex<Stop>,
    /// When the last who waited went.
    left: Mutex<Option<Instant>>,
    /// With so many entries the session has no question beside those that are open.
    nothing_beside: AtomicU64,
}

impl Desk {
    /// The session, for whoever is to work on it alone.
    pub(crate) fn session(&self) -> Arc<AsyncMutex<Option<Session>>> {
        Arc::clone(&self.session)
    }

    /// Whoever begins to work asks with this whether to end.
    pub(crate) fn begin(&self) -> Stop {
        let fresh = Stop::default();
        self.stop().clone_from(&fresh);
        fresh
    }

    /// Somebody waits for what is done here, until the guard goes. So long after the
    /// last who waited has gone, work goes on.
    pub(crate) fn wait(self: &Arc<Self>, grace: Duration) -> Waiting {
        self.waiting.fetch_add(1, Ordering::AcqRel);
        Waiting {
            desk: Arc::clone(self),
            grace,
        }
    }

    /// Something was sent here, and is neither kept nor refused until the guard goes.
    pub(crate) fn sent(self: &Arc<Self>) -> Unsettled {
        self.unsettled.fetch_add(1, Ordering::AcqRel);
        Unsettled(Arc::clone(self))
    }

    /// Whether all that was sent here is kept, or refused.
    pub(crate) fn is_settled(&self) -> bool {
        self.unsettled.load(Ordering::Acquire) == 0
    }

    /// Whether nobody has waited for so long.
    pub(crate) fn is_forsaken(&self, grace: Duration) -> bool {
        let left = *self.left.lock().unwrap_or_else(PoisonError::into_inner);
        self.is_abandoned() && left.is_some_and(|left| left.elapsed() >= grace)
    }

    /// Ends what is done here after a while, should nobody wait for it now or then.
    pub(crate) fn end_unless_waited_for(self: &Arc<Self>, grace: Duration) {
        if !self.is_abandoned() || !self.is_at_work() {
            return;
        }
        let Ok(runtime) = tokio::runtime::Handle::try_current() else {
            return;
        };
        let desk = Arc::clone(self);
        let stop = desk.stop().clone();
        runtime.spawn(async move {
            tokio::time::sleep(grace).await;
            // Other work may have begun since: that has a stop of its own.
            if desk.is_abandoned() {
                stop.set();
            }
        });
    }

    /// Takes note that there is no question beside those that are open, as the session
    /// stands with so many entries.
    pub(crate) fn found_nothing_beside(&self, entries: u64) {
        self.nothing_beside.store(entries, Ordering::Release);
    }

    /// Whether there may be one.
    pub(crate) fn may_have_more(&self, entries: u64) -> bool {
        self.nothing_beside.load(Ordering::Acquire) != entries
    }

    fn is_abandoned(&self) -> bool {
        self.waiting.load(Ordering::Acquire) == 0
    }

    fn is_at_work(&self) -> bool {
        self.session.try_lock().is_err()
    }

    fn stop(&self) -> MutexGuard<'_, Stop> {
        self.stop.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Something that was sent.
pub(crate) struct Unsettled(Arc<Desk>);

impl Drop for Unsettled {
    fn drop(&mut self) {
        self.0.unsettled.fetch_sub(1, Ordering::AcqRel);
    }
}

/// Somebody who waits.
pub(crate) struct Waiting {
    desk: Arc<Desk>,
    grace: Duration,
}

impl Drop for Waiting {
    /// Ends what nobody waits for, after a while.
    fn drop(&mut self) {
        self.desk.waiting.fetch_sub(1, Ordering::AcqRel);
        *(self.desk.left.lock()).unwrap_or_else(PoisonError::into_inner) = Some(Instant::now());
        self.desk.end_unless_waited_for(self.grace);
    }
}

/// The desks of the sessions used last, and when that was.
#[derive(Default)]
pub(crate) struct Desks(Mutex<Kept>);

#[derive(Default)]
struct Kept {
    desks: HashMap<SessionId, (Instant, Arc<Desk>)>,
    tidied: Option<Instant>,
}

impl Kept {
    /// Takes away what need not be kept. Only desks at which nobody is: two desks of
    /// one session would be two writers.
    fn tidy(&mut self, now: Instant) -> Vec<Arc<Desk>> {
        let is_idle = |desk: &Arc<Desk>| {
            Arc::strong_count(desk) == 1 && Arc::strong_count(&desk.session) == 1
        };
        let mut gone = Vec::new();
        let is_due = |tidied| now.duration_since(tidied) >= TIDY;
        if self.tidied.is_none_or(is_due) {
            self.tidied = Some(now);
            let lingering = self
                .desks
                .extract_if(|_, (used, desk)| now.duration_since(*used) >= LINGER && is_idle(desk));
            gone.extend(lingering.map(|(_, (_, desk))| desk));
        }
        if self.desks.len() > KEPT {
            let idle = (self.desks.iter()).filter(|(_, (_, desk))| is_idle(desk));
            let oldest = idle.min_by_key(|(_, (used, _))| *used).map(|(id, _)| *id);
            gone.extend(
                oldest
                    .and_then(|id| self.desks.remove(&id))
                    .map(|(_, desk)| desk),
            );
        }
        gone
    }
}

impl Desks {
    /// The desk of this session.
    pub(crate) fn of(&self, id: SessionId) -> Arc<Desk> {
        self.at(id, Instant::now())
    }

    fn at(&self, id: SessionId, now: Instant) -> Arc<Desk> {
        let mut kept = self.kept();
        let desk = {
            let entry = (kept.desks.entry(id)).or_insert_with(|| (now, Arc::default()));
            entry.0 = now;
            Arc::clone(&entry.1)
        };
        let gone = kept.tidy(now);
        drop(kept);
        drop(gone); // which takes longer than others are to wait
        desk
    }

    /// Ends all work: the server stops.
    pub(crate) fn end(&self) {
        for (_, desk) in self.kept().desks.values() {
            desk.stop().set();
        }
    }

    /// How many sessions are in memory.
    pub(crate) fn len(&self) -> usize {
        self.kept().desks.len()
    }

    fn kept(&self) -> MutexGuard<'_, Kept> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SHORT: Duration = Duration::from_millis(30);
    const LONG: Duration = Duration::from_secs(600);

    async fn ends(stop: &Stop) -> bool {
        for _ in 0..200 {
            if stop.is_set() {
                return true;
            }
            tokio::time::sleep(SHORT / 3).await;
        }
        false
    }

    #[tokio::test]
    async fn work_ends_once_nobody_has_waited_for_a_while() {
        let desk = Arc::new(Desk::default());
        let at_work = desk.session().lock_owned().await;
        let stop = desk.begin();
        let (first, second) = (desk.wait(SHORT), desk.wait(SHORT));
        drop(first);
        tokio::time::sleep(2 * SHORT).await;
        assert!(!stop.is_set(), "somebody waits still");
        drop(second);
        assert!(ends(&stop).await);
        drop(at_work);
    }

    #[test]
    fn sessions_that_nobody_asks_for_go_from_memory() {
        let desks = Desks::default();
        let [gone, at_work, fresh] = [0; 3].map(|_| SessionId::random().unwrap());
        let then = Instant::now();
        drop(desks.at(gone, then));
        let held = desks.at(at_work, then).session();
        drop(desks.at(fresh, then + TIDY));
        assert_eq!(desks.len(), 3, "nobody has lingered yet");
        drop(desks.at(fresh, then + LINGER));
        assert_eq!(desks.len(), 2);
        assert!(Arc::ptr_eq(
            &held,
            &desks.at(at_work, then + LINGER).session()
        ));
    }

    #[tokio::test]
    async fn whoever_comes_back_in_time_finds_it_going_on() {
        let desk = Arc::new(Desk::default());
        let _at_work = desk.session().lock_owned().await;
        let stop = desk.begin();
        drop(desk.wait(SHORT));
        let _back = desk.wait(LONG);
        tokio::time::sleep(3 * SHORT).await;
        assert!(!stop.is_set());
    }

    #[tokio::test]
    async fn all_work_ends_with_the_server() {
        let desks = Desks::default();
        let desk = desks.of(SessionId::random().unwrap());
        let stop = desk.begin();
        desks.end();
        assert!(stop.is_set());
    }

    #[tokio::test]
    async fn a_desk_at_which_somebody_is_stays() {
        let desks = Desks::default();
        let id = SessionId::random().unwrap();
        let busy = desks.of(id);
        for _ in 0..2 * KEPT {
            desks.of(SessionId::random().unwrap());
        }
        assert!(Arc::ptr_eq(&busy, &desks.of(id)));
        assert!(desks.len() <= KEPT + 1);
    }
}
