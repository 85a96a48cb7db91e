//! A store that does as it is told until it is told to be slow, or to break.

use std::sync::{Condvar, Mutex};
use std::time::Duration;

use memrep::store::{
    Entry, InviteKey, Listed, NewFile, SessionId, Sqlite, Store, StoreError, StoredFile, UploadId,
    Visits,
};

/// What goes wrong.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Fault {
    /// Nothing does.
    None,
    /// Questions are not kept before the fault is another.
    Slow,
    /// Nothing is kept before the fault is another.
    Stuck,
    /// What comes next is kept, and nobody is told: asked once more, as when a connection
    /// broke, the store finds that it is there.
    Unsure,
    /// The log of this session breaks whoever reads it.
    Panics(SessionId),
}

/// The store.
pub(crate) struct Unreliable {
    store: Sqlite,
    fault: Mutex<Fault>,
    changed: Condvar,
}

impl Unreliable {
    /// One that works.
    pub(crate) fn in_memory() -> Self {
        Self {
            store: Sqlite::in_memory().unwrap(),
            fault: Mutex::new(Fault::None),
            changed: Condvar::new(),
        }
    }

    /// From now on this goes wrong.
    pub(crate) fn fail(&self, fault: Fault) {
        *self.fault.lock().unwrap() = fault;
        self.changed.notify_all();
    }
}

impl Store for Unreliable {
    fn append_all(&self, session: &SessionId, seq: u64, bodies: &[&str]) -> Result<(), StoreError> {
        let asks = bodies
            .iter()
            .any(|body| body.contains("\"event\":\"asked\""));
        let waits = |fault: &mut Fault| *fault == Fault::Stuck || (asks && *fault == Fault::Slow);
        let fault = self.fault.lock().unwrap();
        // A test that fails meanwhile is to end.
        let most = Duration::from_secs(30);
        let (mut fault, _) = self.changed.wait_timeout_while(fault, most, waits).unwrap();
        let is_unsure = *fault == Fault::Unsure;
        if is_unsure {
            *fault = Fault::None;
        }
        drop(fault);
        self.store.append_all(session, seq, bodies)?;
        if is_unsure {
            let session = *session;
            return Err(StoreError::Taken { session, seq });
        }
        Ok(())
    }

    fn read(&self, session: &SessionId) -> Result<Vec<Entry>, StoreError> {
        let breaks = *self.fault.lock().unwrap() == Fault::Panics(*session);
        assert!(!breaks, "the log of {session:?} breaks its reader");
        self.store.read(session)
    }

    fn list(&self, most: usize) -> Result<Vec<Listed>, StoreError> {
        self.store.list(most)
    }

    fn begin(
        &self,
        session: &SessionId,
        body: &str,
        upload: &UploadId,
        files: Option<&mut dyn Iterator<Item = NewFile<'_>>>,
    ) -> Result<(), StoreError> {
        self.store.begin(session, body, upload, files)
    }

    fn invite(&self, key: &InviteKey, session: &SessionId, person: u32) -> Result<(), StoreError> {
        self.store.invite(key, session, person)
    }

    fn invited(&self, key: &InviteKey) -> Result<Option<(SessionId, u32)>, StoreError> {
        self.store.invited(key)
    }

    fn visits(&self) -> &dyn Visits {
        self.store.visits()
    }

    fn upload_of(&self, session: &SessionId) -> Result<Option<UploadId>, StoreError> {
        self.store.upload_of(session)
    }

    fn file(&self, upload: &UploadId, name: &str) -> Result<Option<StoredFile>, StoreError> {
        self.store.file(upload, name)
    }

    fn chunk(&self, file: &StoredFile, place: u64) -> Result<Vec<u8>, StoreError> {
        self.store.chunk(file, place)
    }
}
