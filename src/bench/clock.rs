//! How much computing was done: CPU time, which a busy machine does not stretch
//! as it does the time on the wall.

use std::time::Duration;

/// The CPU time that this process has used so far, over all its threads (an
/// engine may search on a thread of its own).
#[cfg(unix)]
pub fn process_cpu() -> Duration {
    read(rustix::time::ClockId::ProcessCPUTime)
}

/// The CPU time that the calling thread has used so far, for runs that go on side
/// by side. What an engine does on a thread of its own is not in it.
#[cfg(unix)]
pub fn thread_cpu() -> Duration {
    read(rustix::time::ClockId::ThreadCPUTime)
}

#[cfg(unix)]
fn read(clock: rustix::time::ClockId) -> Duration {
    let time = rustix::time::clock_gettime(clock);
    // Both parts of a clock of CPU time are never negative.
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

/// The time on the wall, as [`process_cpu`] has it there.
#[cfg(not(unix))]
pub fn thread_cpu() -> Duration {
    process_cpu()
}
