//! Pools that were read from the store: sessions on one upload share one in memory.

use std::collections::{HashMap, VecDeque};
use std::sync::{Arc, Mutex, PoisonError, Weak};

use super::RECORDINGS;
use crate::server::error::WebError;
use crate::session::{Malformed, Task};
use crate::store::{CHUNK, Store, UploadId};
use crate::world::World;
use crate::world::pool::PoolReader;

/// Pools that stay in memory although no session there uses them.
const KEPT: usize = 4;

/// An upload as it reads over these symbols, in this order.
type Key = (UploadId, Vec<String>);

/// The pools in memory.
#[derive(Default)]
pub(crate) struct Pools(Mutex<Known>);

#[derive(Default)]
struct Known {
    /// Those that somebody uses.
    used: HashMap<Key, Weak<World>>,
    /// The latest, the last of them at the end.
    kept: VecDeque<Arc<World>>,
}

fn key(upload: UploadId, task: &Task) -> Key {
    let names = task.symbols.iter().map(|symbol| symbol.name.clone());
    (upload, names.collect())
}

impl Pools {
    /// The world of a task whose world is an upload; none where it is not.
    ///
    /// # Errors
    ///
    /// If there is no such upload, or it has symbols that the task has not.
    pub(crate) fn world(
        &self,
        store: &dyn Store,
        task: &Task,
    ) -> Result<Option<Arc<World>>, WebError> {
        let Some(named) = task.upload() else {
            return Ok(None);
        };
        let unknown = || {
            let message =
                format!("there is no upload `{named}` here: send the recordings with the task");
            WebError::from(Malformed::new("world.upload", message))
        };
        let upload = named.parse().map_err(|_| unknown())?;
        if let Some(world) = self.find(&key(upload, task)) {
            return Ok(Some(world));
        }
        let file = store
            .file(&upload, RECORDINGS)
            .map_err(WebError::internal)?;
        let file = file.ok_or_else(unknown)?;
        let unfit = |error: &dyn std::fmt::Display| {
            Malformed::new("world.upload", format!("{RECORDINGS}: {error}"))
        };
        // Only a task of words has a world.
        let alphabet = task.alphabet().ok_or_else(unknown)?;
        let mut reader = PoolReader::new(alphabet);
        for place in 0..file.size.div_ceil(CHUNK as u64) {
            let chunk = store.chunk(&file, place).map_err(WebError::internal)?;
            reader.feed(&chunk).map_err(|error| unfit(&error))?;
        }
        let pool = reader.finish().map_err(|error| unfit(&error))?;
        Ok(Some(self.keep(upload, task, Arc::new(World::Pool(pool)))))
    }

    fn find(&self, key: &Key) -> Option<Arc<World>> {
        let known = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        known.used.get(key).and_then(Weak::upgrade)
    }

    /// Shares a pool that was read; the one that is shared already if there is one.
    pub(crate) fn keep(&self, upload: UploadId, task: &Task, world: Arc<World>) -> Arc<World> {
        let mut known = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let key = key(upload, task);
        if let Some(world) = known.used.get(&key).and_then(Weak::upgrade) {
            return world;
        }
        known.used.retain(|_, world| world.strong_count() > 0);
        known.used.insert(key, Arc::downgrade(&world));
        known.kept.push_back(Arc::clone(&world));
        if known.kept.len() > KEPT {
            known.kept.pop_front();
        }
        world
    }
}
