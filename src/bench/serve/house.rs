//! A server of its own as a child process, and the figures that a server tells.

use std::io::{BufRead as _, BufReader};
use std::net::SocketAddr;
use std::path::Path;
use std::process::{Child, Command, ExitStatus, Stdio};
use std::time::{Duration, Instant};

use hyper::Method;

use super::client::Client;

/// How long a server may take to stop.
const FAREWELL: Duration = Duration::from_secs(10);

/// Why a server is not there.
#[derive(Debug, thiserror::Error)]
pub enum HouseError {
    /// It does not start.
    #[error("the server does not start: {0}")]
    Start(String),
    /// It does not stop.
    #[error("the server was told to stop and is still there after 10 s")]
    Stuck,
    /// It failed.
    #[error("the server ended with {0}")]
    Failed(ExitStatus),
    /// The operating system refuses.
    #[error("the server cannot be run: {0}")]
    Io(#[from] std::io::Error),
}

/// A server in a process of its own.
pub struct House {
    child: Child,
    /// Where it is.
    pub address: SocketAddr,
}

impl House {
    /// Starts this program's own server over a database in this folder.
    ///
    /// # Errors
    ///
    /// If it does not start.
    pub fn open(folder: &Path) -> Result<Self, HouseError> {
        let mut child = Command::new(std::env::current_exe()?)
            .args([
                "serve",
                "--addr",
                "127.0.0.1:0",
                "--database",
                "bench.db",
                // That a question takes long is on the page of the run.
                "--log",
                "error",
            ])
            .current_dir(folder)
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .spawn()?;
        let mut line = String::new();
        if let Some(out) = child.stdout.as_mut() {
            BufReader::new(out).read_line(&mut line)?;
        }
        let address = line.trim().strip_prefix("memrep is at http://");
        let address = address.and_then(|rest| rest.trim_end_matches('/').parse().ok());
        if let Some(address) = address {
            return Ok(Self { child, address });
        }
        // It may be there, and not as expected.
        let _ = child.kill();
        let ended = child.wait()?;
        Err(HouseError::Start(format!("it ended with {ended}")))
    }

    /// Asks it to stop, and says how long that took.
    ///
    /// # Errors
    ///
    /// If it does not, or says that something is wrong.
    pub fn close(mut self) -> Result<Duration, HouseError> {
        let begun = Instant::now();
        ask_to_stop(&mut self.child)?;
        loop {
            match self.child.try_wait()? {
                Some(ended) if ended.success() => return Ok(begun.elapsed()),
                Some(ended) => return Err(HouseError::Failed(ended)),
                None if begun.elapsed() > FAREWELL => return Err(HouseError::Stuck),
                None => std::thread::sleep(Duration::from_millis(5)),
            }
        }
    }
}

impl Drop for House {
    fn drop(&mut self) {
        // It is gone already where it was closed.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

#[cfg(unix)]
fn ask_to_stop(child: &mut Child) -> Result<(), HouseError> {
    let id = rustix::process::Pid::from_child(child);
    rustix::process::kill_process(id, rustix::process::Signal::TERM)
        .map_err(|error| HouseError::Io(error.into()))
}

/// There is no way to ask.
#[cfg(not(unix))]
fn ask_to_stop(child: &mut Child) -> Result<(), HouseError> {
    Ok(child.kill()?)
}

/// What a server tells of itself.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Figures {
    /// The memory that it uses, in bytes.
    pub memory: Option<u64>,
    /// The CPU time that it has used, in seconds.
    pub cpu: Option<f64>,
    /// Of so many seconds at most, so many appends to the store.
    appends: Vec<(f64, u64)>,
}

impl Figures {
    /// Those of the server at this address; none if it does not tell.
    pub async fn of(address: SocketAddr) -> Option<Self> {
        let asked = Client::new(address)
            .send(Method::GET, "/metrics", None)
            .await;
        let (status, page) = asked.ok()?;
        let text = std::str::from_utf8(&page).ok()?;
        status.is_success().then(|| Self::read(text))
    }

    /// The bound, of those that the server counts by, which so many percent of the
    /// appends since then did not exceed.
    pub(super) fn appended_since(&self, before: &Self, percent: u64) -> Option<f64> {
        let since = self.appends.iter().zip(&before.appends);
        let since: Vec<(f64, u64)> = since
            .map(|(now, then)| (now.0, now.1.saturating_sub(then.1)))
            .collect();
        let all = since.last()?.1;
        let enough = |(_, count): &&(f64, u64)| count * 100 >= all * percent;
        since
            .iter()
            .find(enough)
            .map(|(bound, _)| *bound)
            .filter(|_| all > 0)
    }

    fn read(text: &str) -> Self {
        let value = |name: &str| {
            let mut lines = text.lines();
            lines.find_map(|line| line.strip_prefix(name)?.strip_prefix(' '))
        };
        let buckets = text.lines().filter_map(|line| {
            let rest = line.strip_prefix("memrep_store_append_seconds_bucket{le=\"")?;
            let (bound, count) = rest.split_once("\"} ")?;
            Some((bound.parse().ok()?, count.parse().ok()?))
        });
        Self {
            appends: buckets.collect(),
            memory: value("process_resident_memory_bytes").and_then(|v| v.parse().ok()),
            cpu: value("process_cpu_seconds_total").and_then(|v| v.parse().ok()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Figures;

    #[test]
    fn figures_are_read_and_compared() {
        let page = |few: u32, all: u32| {
            Figures::read(&format!(
                "# HELP x\nprocess_resident_memory_bytes 1024\nprocess_cpu_seconds_total 1.5\nmemrep_store_append_seconds_bucket{{le=\"0.005\"}} {few}\nmemrep_store_append_seconds_bucket{{le=\"0.01\"}} {all}\nmemrep_store_append_seconds_bucket{{le=\"+Inf\"}} {all}\n"
            ))
        };
        let (first, last) = (page(10, 100), page(205, 300));
        assert_eq!((first.memory, first.cpu), (Some(1024), Some(1.5)));
        assert_eq!(last.appended_since(&first, 95), Some(0.005));
        assert_eq!(last.appended_since(&first, 99), Some(0.01));
        assert_eq!(first.appended_since(&first, 99), None);
    }
}
