//! Many scripted people at once, and what they met.

use std::collections::{BTreeMap, HashMap};
use std::net::SocketAddr;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use hyper::Method;
use tokio::task::JoinSet;

use super::client::{Client, ClientError};
use super::house::Figures;
use super::person::{Person, begin};
use super::{Habits, Met};
use crate::bench::process_cpu;

/// How often the server is asked for its figures.
const PULSE: Duration = Duration::from_secs(1);

/// How long people have to come to an end.
const FAREWELL: Duration = Duration::from_secs(10);

/// What is written down by everybody.
#[derive(Default)]
pub(super) struct Ledger {
    met: Mutex<Written>,
    ended: AtomicU64,
    reconnects: AtomicU64,
    put_off: AtomicU64,
    over: AtomicBool,
}

#[derive(Default)]
struct Written {
    /// Who waits at this moment, and since when.
    waiting: HashMap<usize, Instant>,
    waits: Vec<Duration>,
    beginnings: Vec<Duration>,
    pages: Vec<Duration>,
    errors: BTreeMap<String, u64>,
}

impl Ledger {
    /// This person waits for the next question from now on.
    pub(super) fn asks(&self, person: usize) {
        self.written().waiting.insert(person, Instant::now());
    }

    pub(super) fn waited(&self, person: usize) {
        let mut written = self.written();
        if let Some(since) = written.waiting.remove(&person) {
            written.waits.push(since.elapsed());
        }
    }

    /// What was written since the last time. Who waits still has waited so long at
    /// least: a server that hangs is not to look quick.
    fn take(&self) -> (Written, usize) {
        let mut written = self.written();
        let waiting = written.waiting.clone();
        let mut taken = std::mem::take(&mut *written);
        taken.waits.extend(waiting.values().map(Instant::elapsed));
        let unfinished = waiting.len();
        written.waiting = waiting;
        (taken, unfinished)
    }

    pub(super) fn began(&self, wait: Duration) {
        self.written().beginnings.push(wait);
    }

    pub(super) fn looked(&self, wait: Duration) {
        self.written().pages.push(wait);
    }

    pub(super) fn ended(&self) {
        self.ended.fetch_add(1, Ordering::Relaxed);
    }

    pub(super) fn failed(&self, person: usize, error: &ClientError) {
        let mut written = self.written();
        written.waiting.remove(&person);
        *written.errors.entry(error.kind()).or_default() += 1;
    }

    /// Somebody was told that the server is still thinking.
    pub(super) fn put_off(&self) {
        self.put_off.fetch_add(1, Ordering::Relaxed);
    }

    pub(super) fn reconnected(&self, times: u64) {
        self.reconnects.fetch_add(times, Ordering::Relaxed);
    }

    pub(super) fn is_over(&self) -> bool {
        self.over.load(Ordering::Relaxed)
    }

    fn written(&self) -> MutexGuard<'_, Written> {
        self.met.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// People who are at it.
pub struct Crowd {
    address: SocketAddr,
    people: usize,
    ledger: Arc<Ledger>,
    at_work: JoinSet<()>,
}

impl Crowd {
    /// Lets so many people come to the server at this address, each in their time.
    pub fn enter(address: SocketAddr, people: usize, habits: &Arc<Habits>) -> Self {
        let ledger = Arc::new(Ledger::default());
        let mut at_work = JoinSet::new();
        for number in 0..people {
            let client = Client::new(address);
            let person = Person::new(number, client, Arc::clone(habits), Arc::clone(&ledger));
            at_work.spawn(person.teach());
        }
        Self {
            address,
            people,
            ledger,
            at_work,
        }
    }

    /// What they meet in the time to come.
    pub async fn watch(&mut self, lasting: Duration) -> Met {
        // What was met before does not count: not all were there.
        drop(self.ledger.take());
        let (ended, reconnects, put_off) = (self.ended(), self.reconnects(), self.put_off());
        let (begun, own) = (Instant::now(), process_cpu());
        let first = Figures::of(self.address).await;
        let mut memory = first.as_ref().and_then(|figures| figures.memory);
        let mut last = first.clone();
        while begun.elapsed() < lasting {
            tokio::time::sleep(PULSE.min(lasting.saturating_sub(begun.elapsed()))).await;
            if let Some(figures) = Figures::of(self.address).await {
                memory = memory.max(figures.memory);
                last = Some(figures);
            }
        }
        let lasted = begun.elapsed();
        let (written, unfinished) = self.ledger.take();
        let ends = first.zip(last);
        let appended = ends
            .as_ref()
            .and_then(|(first, last)| last.appended_since(first, 99));
        let server = ends.and_then(|(first, last)| Some(last.cpu? - first.cpu?));
        let people = process_cpu().saturating_sub(own);
        Met {
            people: self.people,
            lasted,
            waits: written.waits,
            unfinished,
            beginnings: written.beginnings,
            pages: written.pages,
            appended,
            ended: self.ended() - ended,
            errors: written.errors.into_iter().collect(),
            reconnects: self.reconnects() - reconnects,
            put_off: self.put_off() - put_off,
            memory,
            server_cores: server.map(|cpu| cpu / lasted.as_secs_f64()),
            people_cores: people.as_secs_f64() / lasted.as_secs_f64(),
        }
    }

    /// Sends everybody home.
    pub async fn leave(mut self) {
        self.ledger.over.store(true, Ordering::Relaxed);
        let home = async { while self.at_work.join_next().await.is_some() {} };
        // Who is in a long thought does not finish it.
        if tokio::time::timeout(FAREWELL.min(PULSE), home)
            .await
            .is_err()
        {
            self.at_work.shutdown().await;
        }
    }

    fn ended(&self) -> u64 {
        self.ledger.ended.load(Ordering::Relaxed)
    }

    fn put_off(&self) -> u64 {
        self.ledger.put_off.load(Ordering::Relaxed)
    }

    fn reconnects(&self) -> u64 {
        self.ledger.reconnects.load(Ordering::Relaxed)
    }
}

/// Begins so many sessions that nobody goes on with, some at a time; `told` is called
/// after each.
///
/// # Errors
///
/// The first that cannot be begun.
pub async fn idle(
    address: SocketAddr,
    sessions: usize,
    habits: &Habits,
    told: impl Fn(),
) -> Result<(), ClientError> {
    const AT_ONCE: usize = 8;
    let mut left = JoinSet::new();
    let names: Vec<String> = habits.targets.iter().map(|t| t.name().to_owned()).collect();
    let (done, mut heard) = tokio::sync::mpsc::unbounded_channel();
    for lane in 0..AT_ONCE {
        let (names, done) = (names.clone(), done.clone());
        left.spawn(async move {
            let mut client = Client::new(address);
            for number in (lane..sessions).step_by(AT_ONCE) {
                let name = &names[number % names.len()];
                begin(&mut client, name, number as u64).await?;
                // Nobody listens any more only once it failed.
                let _ = done.send(());
            }
            Ok::<(), ClientError>(())
        });
    }
    drop(done);
    while heard.recv().await.is_some() {
        told();
    }
    while let Some(lane) = left.join_next().await {
        lane.map_err(|_| ClientError::Nonsense("a lane that panicked"))??;
    }
    Ok(())
}

/// Looks at the start page, which lists sessions, so that whatever a server does for
/// them is done.
///
/// # Errors
///
/// If it cannot be read.
pub async fn settle(address: SocketAddr) -> Result<(), ClientError> {
    let mut client = Client::new(address);
    for path in ["/", "/api/v1/sessions"] {
        let (status, _) = client.send(Method::GET, path, None).await?;
        if !status.is_success() {
            return Err(ClientError::Status(status.as_u16()));
        }
    }
    Ok(())
}
