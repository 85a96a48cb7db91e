//! The sessions of a server: begun, looked at, acted on and listed. Must not know what
//! a request is.

mod turn;

use std::sync::Arc;
use std::time::Duration;

use tokio::sync::Semaphore;

use super::ahead::{Foresight, Trial};
use super::archive::Archive;
use super::busy::Busy;
use super::desks::Desks;
use super::error::WebError;
use super::leases::Leases;
use super::live::Live;
use super::metrics::Metrics;
use super::upload::{Pools, Upload};
use crate::evidence::Stop;
use crate::session::{Decision, Position, Session, Setup, Task};
use crate::store::{Entry, InviteKey, Listed, SessionId, Store, StoredFile};

/// How long a page waits for the learner before it says so; a form and the page that
/// follows it take twice as long. The learner goes on after that, and a later page
/// shows what came of it.
const SOON: Duration = Duration::from_millis(800);

/// So long after the last who waited has gone, a session thinks on: a page that waits
/// asks every other second.
const GRACE: Duration = Duration::from_secs(10);

/// How long a script waits: it would only ask again.
const PATIENCE: Duration = Duration::from_secs(30);

/// So many sessions for each core think at once: what takes long then does not hold up
/// what takes a moment, and the system shares the cores out.
const TURNS: usize = 2;

/// All sessions of a store, and the pool on which they think.
#[derive(Clone)]
pub(crate) struct Teaching {
    archive: Arc<Archive>,
    desks: Arc<Desks>,
    /// To think.
    permits: Arc<Semaphore>,
    /// To read a session from its log, which does not wait for those who think.
    folds: Arc<Semaphore>,
    busy: Arc<Busy>,
    foresight: Arc<Foresight>,
    live: Arc<Live>,
    leases: Arc<Leases>,
    /// Set once the server stops.
    over: Stop,
    patience: Duration,
    grace: Duration,
}

impl Teaching {
    /// Sessions of `store` on a machine with `width` cores; each of several people has a
    /// question for as long as `lease`.
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
            permits: Arc::new(Semaphore::new(TURNS * width.max(1))),
            folds: Arc::new(Semaphore::new(width.max(1))),
            busy: Arc::default(),
            foresight: Arc::new(Foresight::new(width)),
            live,
            leases: Arc::new(Leases::new(lease)),
            over: Stop::default(),
            patience: SOON,
            grace: GRACE,
        }
    }

    /// The same, which thinks on for so long once nobody waits.
    pub(crate) fn with_grace(self, grace: Duration) -> Self {
        Self { grace, ..self }
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
            let kept = match upload {
                Some(upload) => store.begin(&id, &body, &upload, None),
                None => store.append(&id, 0, &body),
            };
            archive.begun(&id, &body, kept)
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
            archive.begun(&id, &body, kept)?;
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
            Ok(()) | Err(WebError::Slow | WebError::Waiting) => Ok(id),
            Err(error) => Err(error),
        }
    }

    /// A file of the upload that the session was created with.
    pub(crate) async fn file(
        &self,
        id: SessionId,
        name: String,
    ) -> Result<Option<StoredFile>, WebError> {
        // No file is called so, and PostgreSQL would not even look.
        if name.contains('\0') {
            return Ok(None);
        }
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
        self.take_turn(id, nothing, |session, _| view(session), None, None)
            .await
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
