//! Scripted people over real HTTP: what a server takes, and how long its people wait.
//!
//! A [`House`] is a server, a [`Crowd`] the people in it. Each of them teaches one
//! session after the other over a connection of their own, answers truly, and takes
//! time to think between two answers. Must not know how the server works.

mod client;
mod crowd;
mod house;
mod page;
mod person;

use std::time::Duration;

pub use client::ClientError;
pub use crowd::{Crowd, idle, settle};
pub use house::{Figures, House, HouseError};
pub use page::{Report, csv, figure, markdown};

use super::percentile;
use crate::oracle::Target;

/// How people teach.
#[derive(Clone, Debug)]
pub struct Habits {
    /// What they teach, in turn.
    pub targets: Vec<Target>,
    /// How long they think between two answers, on average.
    pub think: Duration,
    /// Decides the order of all that is random.
    pub seed: u64,
}

/// What so many people met in a while.
#[derive(Clone, Debug, Default)]
pub struct Met {
    /// How many there were.
    pub people: usize,
    /// For how long it was measured.
    pub lasted: Duration,
    /// From each answer to the next question; to the end of the while where that had
    /// not come.
    pub waits: Vec<Duration>,
    /// How many of these waits had not come to their end.
    pub unfinished: usize,
    /// From the wish for a session to its first question.
    pub beginnings: Vec<Duration>,
    /// From asking for a page whose question is there to having it.
    pub pages: Vec<Duration>,
    /// So many seconds 99 in a hundred appends took at most, as far as the server tells.
    pub appended: Option<f64>,
    /// The sessions that were taught to their end.
    pub ended: u64,
    /// What went wrong, by kind.
    pub errors: Vec<(String, u64)>,
    /// Connections that had to be made anew.
    pub reconnects: u64,
    /// How often somebody was told that the next question is still being thought about;
    /// their wait goes on.
    pub put_off: u64,
    /// The most memory that the server had, in bytes, where it tells.
    pub memory: Option<u64>,
    /// The cores that the server used, where it tells.
    pub server_cores: Option<f64>,
    /// The cores that the people used, on the same machine.
    pub people_cores: f64,
}

impl Met {
    /// The wait that so many percent do not exceed.
    pub fn wait(&self, percent: usize) -> Duration {
        percentile(&self.waits, percent)
    }

    /// The longest wait.
    pub fn longest(&self) -> Duration {
        self.waits.iter().max().copied().unwrap_or_default()
    }

    /// Answers in a second.
    pub fn rate(&self) -> f64 {
        self.waits.len() as f64 / self.lasted.as_secs_f64().max(1e-9)
    }

    /// How many requests went wrong.
    pub fn failed(&self) -> u64 {
        self.errors.iter().map(|(_, count)| count).sum()
    }
}

/// The memory of a server by the sessions that it keeps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Idle {
    /// The sessions that are stored and that nobody teaches.
    pub sessions: usize,
    /// Bytes of a server that was just started over an empty store.
    pub empty: Option<u64>,
    /// Bytes once the sessions were begun, one after the other.
    pub begun: Option<u64>,
    /// Bytes of a server that was started over all of them, and has listed them.
    pub stored: Option<u64>,
}

/// A moment of a long run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moment {
    /// Since the beginning.
    pub at: Duration,
    /// The server's memory in bytes, where it tells.
    pub memory: Option<u64>,
    /// The answers since the moment before.
    pub answers: usize,
    /// The requests that failed since then.
    pub failed: u64,
    /// The waits since then: 95 in a hundred were no longer.
    pub p95: Duration,
    /// And 99 in a hundred.
    pub p99: Duration,
}

/// How much a server's memory grows in an hour, in bytes: the slope of the line that
/// fits the later half of these moments best. None where that is no line.
pub fn growth(moments: &[Moment]) -> Option<f64> {
    let later = &moments[moments.len() / 2..];
    let points: Option<Vec<(f64, f64)>> = later
        .iter()
        .map(|moment| Some((moment.at.as_secs_f64() / 3600.0, moment.memory? as f64)))
        .collect();
    let points = points.filter(|points| points.len() >= 3)?;
    let count = points.len() as f64;
    let mean = |part: fn(&(f64, f64)) -> f64| points.iter().map(part).sum::<f64>() / count;
    let (x, y) = (mean(|point| point.0), mean(|point| point.1));
    let across: f64 = points
        .iter()
        .map(|point| (point.0 - x) * (point.1 - y))
        .sum();
    let along: f64 = points.iter().map(|point| (point.0 - x).powi(2)).sum();
    (along > 0.0).then(|| across / along)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn growth_is_the_slope_of_the_later_half() {
        let moment = |minute: u64, memory| Moment {
            at: Duration::from_secs(60 * minute),
            memory: Some(memory),
            answers: 0,
            failed: 0,
            p95: Duration::ZERO,
            p99: Duration::ZERO,
        };
        // A start that is steep, and then a megabyte an hour.
        let moments: Vec<Moment> = (0..60)
            .map(|m| {
                moment(
                    m,
                    if m < 30 {
                        m * 9_000_000
                    } else {
                        270_000_000 + (m - 30) * 1_000_000 / 60
                    },
                )
            })
            .collect();
        let grown = growth(&moments).unwrap();
        assert!((grown - 1e6).abs() < 1e3, "{grown}");
        assert_eq!(growth(&moments[..3]), None);
    }
}
