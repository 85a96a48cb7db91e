//! How busy the machine is with what people wait for, so that what nobody waits for
//! can stand back.

use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

/// What was done so long ago counts for a third.
const MEMORY: Duration = Duration::from_secs(2);

/// A running mean of the cores at work.
pub(crate) struct Busy(Mutex<(Instant, f64)>);

impl Default for Busy {
    fn default() -> Self {
        Self(Mutex::new((Instant::now(), 0.0)))
    }
}

impl Busy {
    /// A core was at work for so long, until now.
    pub(crate) fn note(&self, work: Duration) {
        self.fade(|cores| *cores += work.div_duration_f64(MEMORY));
    }

    /// The mean number of cores at work lately.
    pub(crate) fn cores(&self) -> f64 {
        self.fade(|cores| *cores)
    }

    fn fade<T>(&self, then: impl FnOnce(&mut f64) -> T) -> T {
        let mut held = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let (last, cores) = &mut *held;
        let now = Instant::now();
        *cores *= (-(now.duration_since(*last).div_duration_f64(MEMORY))).exp();
        *last = now;
        then(cores)
    }
}
