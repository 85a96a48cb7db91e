//! Who thinks: so many sessions at once, on threads that do nothing else. Must not know
//! what is thought about.
//!
//! What a session remembers stays in the memory of the thread on which it was thought.
//! On the threads for what blocks, of which there is one for everybody who waits for
//! the disk, sessions that come and go would leave holes in the memory of all of them.

use std::sync::Arc;

use rayon::{ThreadPool, ThreadPoolBuilder};
use tokio::sync::{AcquireError, OwnedSemaphorePermit, Semaphore};

/// The threads, and a permit for each.
pub(crate) struct Thinkers {
    permits: Arc<Semaphore>,
    /// None where the system has no threads to give: whoever asks thinks.
    threads: Option<ThreadPool>,
}

impl Thinkers {
    /// So many, and one at least.
    pub(crate) fn new(count: usize) -> Self {
        let count = count.max(1);
        let threads = ThreadPoolBuilder::new()
            .num_threads(count)
            .thread_name(|number| format!("thinker-{number}"))
            .build()
            .inspect_err(|cause| tracing::warn!(%cause, "no threads to think on"));
        Self {
            permits: Arc::new(Semaphore::new(count)),
            threads: threads.ok(),
        }
    }

    /// The right to think, once one is free: who came first has it first.
    pub(crate) async fn permit(&self) -> Result<OwnedSemaphorePermit, AcquireError> {
        Arc::clone(&self.permits).acquire_owned().await
    }

    /// What comes of this work, for whoever has a permit and may block. A panic goes on
    /// to the caller.
    pub(crate) fn think<T: Send>(&self, work: impl FnOnce() -> T + Send) -> T {
        match &self.threads {
            Some(threads) => threads.install(work),
            None => work(),
        }
    }
}
