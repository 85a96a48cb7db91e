//! The one way in and out of a session: decide, append durably, fold; think, append,
//! show; one thing at a time for each session.
//!
//! What was sent is decided on and kept as soon as its session is free. To think, a
//! session then waits for one of a few permits, so that no answer waits for what is
//! thought about elsewhere.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use tokio::sync::{OwnedMutexGuard, OwnedSemaphorePermit, Semaphore, oneshot};

use super::Teaching;
use crate::evidence::Stop;
use crate::server::desks::{Desk, Unsettled};
use crate::server::error::WebError;
use crate::server::metrics::Clock;
use crate::session::{Decision, Position, Session};
use crate::store::SessionId;

/// A session at its desk, for whoever works on it alone; `None` where the store's word
/// counts.
type Held = OwnedMutexGuard<Option<Session>>;

/// What thinking needs: a permit, given back once only the disk is waited for, and
/// somebody to say when to end.
struct Licence {
    wanted: Wanted,
    permit: Option<OwnedSemaphorePermit>,
    stop: Stop,
    desk: Arc<Desk>,
}

/// Whether a question is wanted beside those that are open.
type Beside = Box<dyn Fn(&Session) -> bool + Send>;

/// What a session is to think about.
enum Wanted {
    /// The next question.
    Next,
    /// A question beside those that are open.
    Another,
}

/// Somebody waits, until this goes.
struct Here(Arc<AtomicBool>);

impl Drop for Here {
    fn drop(&mut self) {
        self.0.store(true, Ordering::Release);
    }
}

impl Teaching {
    /// Does what `decide` decides, durably, and shows where it led.
    ///
    /// `decide` is asked again where another writer was faster. Once this was called,
    /// it happens, whether or not anybody waits for it.
    ///
    /// # Errors
    ///
    /// After the patience that there is: [`WebError::Slow`] where all that was sent to
    /// the session is kept, [`WebError::Waiting`] where something is not yet.
    pub(crate) async fn act<T: Send + 'static>(
        &self,
        id: SessionId,
        decide: impl Fn(&Session) -> Result<Decision, WebError> + Send + 'static,
        view: impl FnOnce(&Session, &Position) -> T + Send + 'static,
    ) -> Result<T, WebError> {
        let sent = self.desks.of(id).sent();
        self.take_turn(id, decide, view, Some(sent), None).await
    }

    /// Shows the session to somebody whom `admit` lets in, after it has put a question
    /// beside those that are open, where it `wants` one and has one.
    pub(crate) async fn put_another<T: Send + 'static>(
        &self,
        id: SessionId,
        admit: impl Fn(&Session) -> Result<(), WebError> + Send + 'static,
        wants: impl Fn(&Session) -> bool + Send + 'static,
        view: impl FnOnce(&Session, &Position) -> T + Send + 'static,
    ) -> Result<T, WebError> {
        let decide = move |session: &Session| {
            admit(session)?;
            Ok(Decision::Already(Position::Thinking))
        };
        self.take_turn(id, decide, view, None, Some(Box::new(wants)))
            .await
    }

    /// The same; what was `sent`, if anything, is settled once it is decided on.
    pub(super) async fn take_turn<T: Send + 'static>(
        &self,
        id: SessionId,
        decide: impl Fn(&Session) -> Result<Decision, WebError> + Send + 'static,
        view: impl FnOnce(&Session, &Position) -> T + Send + 'static,
        sent: Option<Unsettled>,
        beside: Option<Beside>,
    ) -> Result<T, WebError> {
        let desk = self.desks.of(id);
        let _waiting = desk.wait(self.grace);
        let (tell, told) = oneshot::channel();
        let is_gone = Arc::new(AtomicBool::new(false));
        let _here = Here(Arc::clone(&is_gone));
        let view = move |session: &Session, position: &Position| {
            (!is_gone.load(Ordering::Acquire)).then(|| view(session, position))
        };
        let turn = (self.clone()).turn(id, Arc::clone(&desk), decide, view, sent, beside);
        tokio::spawn(async move {
            if let Some(result) = turn.await.transpose()
                && let Err(Err(unheard)) = tell.send(result)
            {
                unheard.log();
            }
        });
        match tokio::time::timeout(self.patience, told).await {
            Ok(Ok(result)) => result,
            Ok(Err(_)) => Err(WebError::internal("the work on a session broke off")),
            Err(_) if desk.is_settled() => Err(WebError::Slow),
            Err(_) => Err(WebError::Waiting),
        }
    }

    async fn turn<T: Send + 'static>(
        self,
        id: SessionId,
        desk: Arc<Desk>,
        decide: impl Fn(&Session) -> Result<Decision, WebError> + Send + 'static,
        view: impl FnOnce(&Session, &Position) -> Option<T> + Send + 'static,
        sent: Option<Unsettled>,
        beside: Option<Beside>,
    ) -> Result<Option<T>, WebError> {
        let wait = self.archive.metrics.wait();
        let mut held = desk.session().lock_owned().await;
        let fold = match *held {
            None => Some(permit(&self.folds).await?),
            Some(_) => None,
        };
        drop(wait.over());
        let here = self.clone();
        let settled = blocking(move || {
            let _fold = fold;
            let mut clock = Clock::default();
            let already = clock.run(|| here.settle(&id, &mut held, decide))?;
            Ok((held, already, clock))
        });
        let (held, already, clock) = settled.await?;
        drop(sent);

        // A look that was waited for in vain: whoever looks next has it all.
        let is_idle = |desk: &Desk| already.is_some() && desk.is_forsaken(self.grace);
        if is_idle(&desk) {
            return Ok(None);
        }
        let wanted = held.as_ref().and_then(|session| match &beside {
            _ if *session.position() == Position::Thinking => Some(Wanted::Next),
            Some(wants) if desk.may_have_more(session.entries()) && wants(session) => {
                Some(Wanted::Another)
            }
            _ => None,
        });
        let licence = if let Some(wanted) = wanted {
            let wait = self.archive.metrics.wait();
            let permit = permit(&self.permits).await?;
            if is_idle(&desk) {
                return Ok(None);
            }
            let stop = desk.begin();
            if self.over.is_set() {
                stop.set();
            }
            // Whoever waited may have gone by now.
            desk.end_unless_waited_for(self.grace);
            let licence = Licence {
                wanted,
                permit: Some(permit),
                stop,
                desk,
            };
            Some((licence, wait.over()))
        } else {
            None
        };
        // The guard and the permit go along: they are free again when the work is
        // done.
        blocking(move || self.conclude(id, held, licence, already, clock, view)).await
    }

    /// Decides, on the session as it stands in the store, and appends what was decided;
    /// where that had led, if it was there already.
    fn settle(
        &self,
        id: &SessionId,
        held: &mut Option<Session>,
        decide: impl Fn(&Session) -> Result<Decision, WebError>,
    ) -> Result<Option<Position>, WebError> {
        let archive = &self.archive;
        let mut session = match held.take() {
            Some(session) if archive.store.is_shared() => archive.catch_up(id, session)?,
            Some(session) => session,
            None => archive.load(id)?,
        };
        loop {
            let appended = match decide(&session) {
                Ok(Decision::Already(position)) => {
                    *held = Some(session);
                    return Ok(Some(position));
                }
                Ok(Decision::Append(event)) => match self.foresight.take(*id, &session, &event) {
                    Some(trial) => {
                        // Somebody would have waited for it.
                        self.busy.note(trial.took);
                        archive.adopt(id, &mut session, trial)?
                    }
                    None => archive.append(id, &mut session, &event)?,
                },
                Err(error) => {
                    *held = Some(session);
                    return Err(error);
                }
            };
            if appended {
                *held = Some(session);
                return Ok(None);
            }
        }
    }

    /// Thinks, if there is something to think about, and shows where all that led.
    fn conclude<T, W>(
        &self,
        id: SessionId,
        mut held: Held,
        licence: Option<(Licence, W)>,
        already: Option<Position>,
        mut clock: Clock,
        view: impl FnOnce(&Session, &Position) -> T,
    ) -> Result<T, WebError> {
        let Some(mut session) = held.take() else {
            return Err(WebError::internal("a session is gone from its desk"));
        };
        let mut is_new = already.is_none();
        if let Some((licence, _turn)) = licence {
            let thought = clock.run(|| match licence.wanted {
                Wanted::Next => self.think(&id, &mut session, licence),
                Wanted::Another => self.think_beside(&id, &mut session, licence),
            });
            self.busy.note(clock.wall());
            is_new |= thought?;
        }
        if is_new {
            self.archive.metrics.chosen(&clock);
        }
        let position = match already {
            Some(position) if position != Position::Thinking => position,
            _ => session.position().clone(),
        };
        self.live.tell(id, session.entries());
        let shown = view(&session, &position);
        self.foresight
            .prepare(id, &session, &self.permits, &self.busy);
        *held = Some(session);
        Ok(shown)
    }

    /// Thinks until a person is to answer; whether anything came of it.
    fn think(
        &self,
        id: &SessionId,
        session: &mut Session,
        mut licence: Licence,
    ) -> Result<bool, WebError> {
        let mut thought = false;
        while let Some(event) = session.think_until(&licence.stop) {
            // What is left is to wait for the disk: others may think meanwhile.
            drop(licence.permit.take());
            self.archive.append(id, session, &event)?;
            thought = true;
        }
        if licence.stop.is_set() && *session.position() == Position::Thinking {
            return Err(WebError::Slow);
        }
        Ok(thought)
    }

    /// Puts a question beside those that are open; whether there was one.
    fn think_beside(
        &self,
        id: &SessionId,
        session: &mut Session,
        mut licence: Licence,
    ) -> Result<bool, WebError> {
        let Some(event) = session.further_until(&licence.stop) else {
            if !licence.stop.is_set() {
                (licence.desk).found_nothing_beside(session.entries());
            }
            return Ok(false);
        };
        drop(licence.permit.take());
        self.archive.append(id, session, &event)?;
        Ok(true)
    }
}

async fn permit(of: &Arc<Semaphore>) -> Result<OwnedSemaphorePermit, WebError> {
    let permit = Arc::clone(of).acquire_owned().await;
    permit.map_err(WebError::internal)
}

/// Runs what may block; a panic is an error.
async fn blocking<T: Send + 'static>(
    work: impl FnOnce() -> Result<T, WebError> + Send + 'static,
) -> Result<T, WebError> {
    tokio::task::spawn_blocking(work)
        .await
        .map_err(WebError::internal)?
}
