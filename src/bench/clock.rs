//! How much computing was done: CPU time, which a busy machine does not stretch
//! as it does the time on the wall.

use std::time::Duration;

/// The CPU time that this process has used so far, over all its threads (an
/// engine may search on a thread of its own).
#[cfg(unix)]
pub fn process_cpu() -> Duration {
    use rustix::time::{ClockId, clock_gettime};

    let time = clock_gettime(ClockId::ProcessCPUTime);
    // Both parts of a process's clock are never negative.
    Duration::new(
        u64::try_from(time.tv_sec).unwrap_or(0),
        u32::try_from(time.tv_nsec).unwrap_or(0),
    )
}

/// The time on the wall since this was first asked, where there is no portable
/// clock for CPU time.
#[cfg(not(unix))]
pub fn process_cpu() -> Duration {
    use std::sync::OnceLock;
    use std::time::Instant;

    static START: OnceLock<Instant> = OnceLock::new();
    START.get_or_init(Instant::now).elapsed()
}
