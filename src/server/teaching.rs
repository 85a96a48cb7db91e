//! The one way in and out of a session: decide, append durably, fold, think,
//! append, show; on a bounded pool, one thing at a time for each session.

use std::sync::Arc;
use std::time::{Duration, Instant};

use tokio::sync::{OwnedSemaphorePermit, Semaphore};

use super::ahead::{Foresight, Trial};
use super::busy::Busy;
use super::desks::Desks;
use super::error::WebError;
use super::leases::Leases;
use super::live::Live;
use super::metrics::{Clock, Metrics};
use super::upload::{Pools, Upload};
use crate::evidence::Stop;
use crate::session::{Corrupt, Decision, Event, Position, Session, Setup, Task};
use crate::store::{Entry, InviteKey, Listed, SessionId, Store, StoreError, StoredFile};

/// How long a page waits for the learner before it says so; a form and the page that
/// follows it take twice as long. The learner goes on after that, and a later page
/// shows what came of it.
const SOON: Duration = Duration::from_millis(800);

/// So long after the last who waited has gone, a session thinks on: a page that waits
/// asks every other second.
const GRACE: Duration = Duration::from_secs(10);

/// How long a script waits: it would only ask again.
const PATIENCE: Duration = Duration::from_secs(30);

/// Where sessions are read from: the store, and what is in memory of its uploads.
struct Archive {
    store: Arc<dyn Store>,
    pools: Pools,
    metrics: Arc<Metrics>,
}

/// All sessions of a store, and the pool on which they think.
#[derive(Clone)]
pub(crate) struct Teaching {
    archive: Arc<Archive>,
    desks: Arc<Desks>,
    permits: Arc<Semaphore>,
    busy: Arc<Busy>,
    foresight: Arc<Foresight>,
    live: Arc<Live>,
    leases: Arc<Leases>,
    /// Set once the server stops.
    over: Stop,
    patience: Duration,
}

impl Teaching {
    /// Sessions of `store`, of which at most `width` think at the same time; each of
    /// several people has a question for as long as `lease`.
    pub(crate) fn new(
        store: Arc<dyn Store>,
        width: usize,
        lease: Duration,
        metrics: Arc<Metrics>,
    ) -> Self {
        let pools = Pools::default();
        let live: Arc<Live> = Arc::default();
        let told = Arc::clone(&live);
        store.follow(Box::new(move |id, entries| told.tell(id, entries)));
        Self {
            archive: Arc::new(Archive {
                store,
                pools,
                metrics,
            }),
            desks: Arc::default(),
            permits: Arc::new(Semaphore::new(width.max(1))),
            busy: Arc::default(),
            foresight: Arc::new(Foresight::new(width)),
            live,
            leases: Arc::new(Leases::new(lease)),
            over: Stop::default(),
            patience: SOON,
        }
    }

    /// The same, for those who rather wait than ask again.
    pub(crate) fn patient(&self) -> Self {
        Self {
            patience: PATIENCE,
            ..self.clone()
        }
    }

    /// Ends all news and all work: the server stops. What was not thought to its end
    /// is thought when somebody asks for it.
    pub(crate) fn end(&self) {
        self.over.set();
        self.live.end();
        self.desks.end();
        self.foresight.end();
    }

    /// Begins a session and puts its first question. Where the task's world is an
    /// upload, it is there already.
    pub(crate) async fn create(&self, task: Task, setup: Setup) -> Result<SessionId, WebError> {
        let id = SessionId::random().map_err(WebError::internal)?;
        let archive = Arc::clone(&self.archive);
        self.on_pool(move || {
            let Archive { store, pools, .. } = &*archive;
            let world = pools.world(&**store, &task)?;
            let upload = match (world, task.upload()) {
                (Some(world), Some(named)) => {
                    task.check_in(world)?;
                    Some(named.parse().map_err(WebError::internal)?)
                }
                _ => None,
            };
            let first = Session::created(task, setup);
            let body = serde_json::to_string(&first).map_err(WebError::internal)?;
            match upload {
                Some(upload) => store.begin(&id, &body, &upload, None),
                None => store.append(&id, 0, &body),
            }
            .map_err(WebError::internal)
        })
        .await?;
        self.wake(id).await
    }

    /// Begins a session with an upload of its own: both are there afterwards, or
    /// neither.
    pub(crate) async fn create_with(
        &self,
        task: Task,
        setup: Setup,
        upload: Upload,
    ) -> Result<SessionId, WebError> {
        let id = SessionId::random().map_err(WebError::internal)?;
        let archive = Arc::clone(&self.archive);
        self.on_pool(move || {
            let world = Arc::new(upload.world);
            task.check_in(Arc::clone(&world))?;
            let first = Session::created(task.clone(), setup);
            let body = serde_json::to_string(&first).map_err(WebError::internal)?;
            let mut files = upload.files.contents();
            let kept = (archive.store).begin(&id, &body, &upload.id, Some(&mut files));
            kept.map_err(WebError::internal)?;
            archive.pools.keep(upload.id, &task, world);
            Ok(())
        })
        .await?;
        self.wake(id).await
    }

    /// Lets a new session put its first question.
    async fn wake(&self, id: SessionId) -> Result<SessionId, WebError> {
        match self.look(id, |_| ()).await {
            // It is there, and its first question will be.
            Ok(()) | Err(WebError::Slow) => Ok(id),
            Err(error) => Err(error),
        }
    }

    /// A file of the upload that the session was created with.
    pub(crate) async fn file(
        &self,
        id: SessionId,
        name: String,
    ) -> Result<Option<StoredFile>, WebError> {
        let archive = Arc::clone(&self.archive);
        self.on_pool(move || {
            let store = &archive.store;
            let upload = store.upload_of(&id).map_err(WebError::internal)?;
            let find = |upload| store.file(&upload, &name).map_err(WebError::internal);
            upload.map_or(Ok(None), find)
        })
        .await
    }

    /// Who waits for news.
    pub(crate) fn live(&self) -> &Live {
        &self.live
    }

    /// Who is at which question.
    pub(crate) fn leases(&self) -> &Arc<Leases> {
        &self.leases
    }

    /// Who answers with this key.
    pub(crate) async fn invited(&self, key: InviteKey) -> Result<(SessionId, u32), WebError> {
        let store = self.store();
        let found = self.on_pool(move || store.invited(&key).map_err(WebError::internal));
        found.await?.ok_or(WebError::NotInvited)
    }

    /// A new key for this person of the session, in the place of the one before.
    pub(crate) async fn new_key(&self, id: SessionId, person: u32) -> Result<InviteKey, WebError> {
        let store = self.store();
        self.on_pool(move || {
            let key = InviteKey::random().map_err(WebError::internal)?;
            let kept = store.invite(&key, &id, person);
            kept.map_err(WebError::internal)?;
            Ok(key)
        })
        .await
    }

    /// How many sessions are in memory.
    pub(crate) fn in_memory(&self) -> usize {
        self.desks.len()
    }

    /// The store, for what is read piece by piece.
    pub(crate) fn store(&self) -> Arc<dyn Store> {
        Arc::clone(&self.archive.store)
    }

    /// What `view` shows of a session that has thought.
    pub(crate) async fn look<T: Send + 'static>(
        &self,
        id: SessionId,
        view: impl FnOnce(&Session) -> T + Send + 'static,
    ) -> Result<T, WebError> {
        let nothing = |_: &Session| Ok(Decision::Already(Position::Thinking));
        self.act(id, nothing, |session, _| view(session)).await
    }

    /// Does what `decide` decides, durably, and shows where it led.
    ///
    /// `decide` is asked again where another writer was faster.
    pub(crate) async fn act<T: Send + 'static>(
        &self,
        id: SessionId,
        decide: impl Fn(&Session) -> Result<Decision, WebError> + Send + 'static,
        view: impl FnOnce(&Session, &Position) -> T + Send + 'static,
    ) -> Result<T, WebError> {
        let here = self.clone();
        let desk = self.desks.of(id);
        let _waiting = desk.wait(GRACE);
        let work = async move {
            let wait = here.archive.metrics.wait();
            let mut held = desk.session().lock_owned().await;
            let permit = Arc::clone(&here.permits).acquire_owned().await;
            let permit = permit.map_err(WebError::internal)?;
            let turn = wait.over();
            let stop = desk.begin();
            if here.over.is_set() {
                stop.set();
            }
            // The guard and the permit go along: they are free again when the
            // work is done, even if nobody waits for it any more.
            tokio::task::spawn_blocking(move || {
                let (mut permit, _turn) = (Some(permit), turn);
                let begun = Instant::now();
                let (archive, foresight) = (&here.archive, &here.foresight);
                let mut session = match held.take() {
                    Some(session) if archive.store.is_shared() => catch_up(archive, &id, session)?,
                    Some(session) => session,
                    None => load(archive, &id)?,
                };
                match advance(
                    archive,
                    &id,
                    &mut session,
                    decide,
                    foresight,
                    &stop,
                    &mut permit,
                ) {
                    Ok(position) => {
                        here.live.tell(id, session.entries());
                        let shown = view(&session, &position);
                        here.busy.note(begun.elapsed());
                        foresight.prepare(id, &session, &here.permits, &here.busy);
                        *held = Some(session);
                        Ok(shown)
                    }
                    Err(error) => {
                        here.busy.note(begun.elapsed());
                        if error.is_refusal() {
                            *held = Some(session);
                        }
                        Err(error)
                    }
                }
            })
            .await
            .map_err(WebError::internal)?
        };
        match tokio::time::timeout(self.patience, work).await {
            Ok(result) => result,
            Err(_) => Err(WebError::Slow),
        }
    }

    /// What `view` shows of every answer that was tried out on the session as it
    /// stands with so many entries; those still to be tried are waited for, within
    /// `patience`.
    pub(crate) async fn survey<T>(
        &self,
        id: SessionId,
        entries: u64,
        patience: Duration,
        view: impl Fn(&Trial) -> T,
    ) -> Vec<T> {
        self.foresight.survey(id, entries, patience, view).await
    }

    /// A session's log, as it lies in the store.
    pub(crate) async fn log(&self, id: SessionId) -> Result<Vec<Entry>, WebError> {
        let store = self.store();
        self.on_pool(move || match store.read(&id) {
            Ok(entries) if entries.is_empty() => Err(WebError::NoSession),
            other => other.map_err(WebError::internal),
        })
        .await
    }

    /// The sessions last worked on.
    pub(crate) async fn list(&self, most: usize) -> Result<Vec<Listed>, WebError> {
        let store = self.store();
        self.on_pool(move || store.list(most).map_err(WebError::internal))
            .await
    }

    /// Runs what blocks but does not think.
    async fn on_pool<T: Send + 'static>(
        &self,
        work: impl FnOnce() -> Result<T, WebError> + Send + 'static,
    ) -> Result<T, WebError> {
        tokio::task::spawn_blocking(work)
            .await
            .map_err(WebError::internal)?
    }
}

fn load(archive: &Archive, id: &SessionId) -> Result<Session, WebError> {
    let events = events(archive, id, 0)?;
    if events.is_empty() {
        return Err(WebError::NoSession);
    }
    let world = match events.first() {
        Some(Event::Created { task, .. }) => archive.pools.world(&*archive.store, task),
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
fn catch_up(archive: &Archive, id: &SessionId, mut session: Session) -> Result<Session, WebError> {
    for event in events(archive, id, session.entries())? {
        session.apply(&event).map_err(WebError::Corrupt)?;
    }
    Ok(session)
}

/// A session's log from this entry on.
fn events(archive: &Archive, id: &SessionId, from: u64) -> Result<Vec<Event>, WebError> {
    let entries = match from {
        0 => archive.store.read(id),
        _ => archive.store.read_from(id, from),
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

/// Decides, appends and thinks; where that led. What was decided is kept even where
/// thinking was stopped; the permit to think is given back once that is done.
fn advance(
    archive: &Archive,
    id: &SessionId,
    session: &mut Session,
    decide: impl Fn(&Session) -> Result<Decision, WebError>,
    foresight: &Foresight,
    stop: &Stop,
    permit: &mut Option<OwnedSemaphorePermit>,
) -> Result<Position, WebError> {
    loop {
        let clock = Clock::start();
        let already = match decide(session)? {
            Decision::Append(event) => {
                let appended = match foresight.take(*id, session, &event) {
                    Some(trial) => {
                        drop(permit.take());
                        adopt(archive, id, session, trial)?
                    }
                    None => append(archive, id, session, &event)?,
                };
                if !appended {
                    continue;
                }
                None
            }
            Decision::Already(position) => Some(position),
        };
        let mut thought = already.is_none();
        while let Some(event) = session.think_until(stop) {
            // What is left is to wait for the disk: others may think meanwhile.
            drop(permit.take());
            append(archive, id, session, &event)?;
            thought = true;
        }
        if stop.is_set() && *session.position() == Position::Thinking {
            return Err(WebError::Slow);
        }
        if thought {
            archive.metrics.chosen(&clock);
        }
        return Ok(match already {
            Some(position) if position != Position::Thinking => position,
            _ => session.position().clone(),
        });
    }
}

/// Appends the entries of a trial to the store, and goes on with its session; if
/// another writer was faster with the first, reads the session again instead and
/// says `false`.
fn adopt(
    archive: &Archive,
    id: &SessionId,
    session: &mut Session,
    trial: Trial,
) -> Result<bool, WebError> {
    let causes = std::iter::once(&trial.cause);
    let first = session.entries();
    for (event, seq) in causes.chain(&trial.effects).zip(first..) {
        if !keep(archive, id, seq, event)? {
            *session = load(archive, id)?;
            // After the first the answer is there, whoever wrote what follows.
            return Ok(seq > first);
        }
    }
    *session = trial.session;
    Ok(true)
}

/// Appends an entry to the store, then to the session; if another writer was
/// faster, reads the session again instead and says `false`.
fn append(
    archive: &Archive,
    id: &SessionId,
    session: &mut Session,
    event: &Event,
) -> Result<bool, WebError> {
    if keep(archive, id, session.entries(), event)? {
        session.apply(event).map_err(WebError::Corrupt)?;
        Ok(true)
    } else {
        *session = load(archive, id)?;
        Ok(false)
    }
}

/// Appends an entry to the store; `false` if another writer was faster.
fn keep(archive: &Archive, id: &SessionId, seq: u64, event: &Event) -> Result<bool, WebError> {
    let body = serde_json::to_string(event).map_err(WebError::internal)?;
    let begun = Instant::now();
    match archive.store.append(id, seq, &body) {
        Ok(()) => {
            archive.metrics.appended(event, begun.elapsed());
            Ok(true)
        }
        Err(StoreError::Taken { .. }) => Ok(false),
        Err(error) => Err(WebError::internal(error)),
    }
}
