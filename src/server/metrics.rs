//! What is counted and timed while the server runs, as Prometheus reads it. Must
//! not know sessions, people or answers by their names.

use std::sync::Mutex;
use std::sync::PoisonError;
use std::sync::atomic::{AtomicI64, AtomicU64};
use std::time::{Duration, Instant};

use prometheus_client::collector::Collector;
use prometheus_client::encoding::{DescriptorEncoder, EncodeLabelSet, EncodeMetric, text};
use prometheus_client::metrics::counter::{ConstCounter, Counter};
use prometheus_client::metrics::family::Family;
use prometheus_client::metrics::gauge::{ConstGauge, Gauge};
use prometheus_client::metrics::histogram::Histogram;
use prometheus_client::metrics::info::Info;
use prometheus_client::registry::{Registry, Unit};

use crate::session::Event;

/// The upper bounds of all histograms, in seconds: those that promises are made of
/// are among them.
const BOUNDS: [f64; 15] = [
    0.001, 0.0025, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.3, 0.5, 1.0, 2.0, 5.0, 10.0, 30.0,
];

/// What a request asked for, without what it named.
#[derive(Clone, Debug, PartialEq, Eq, Hash, EncodeLabelSet)]
pub(crate) struct Asked {
    pub(crate) method: &'static str,
    pub(crate) route: String,
}

/// And how it was answered.
#[derive(Clone, Debug, PartialEq, Eq, Hash, EncodeLabelSet)]
struct Answered {
    method: &'static str,
    route: String,
    status: &'static str,
}

/// What is known only by looking, at the moment of looking.
pub(crate) struct Standing {
    pub(crate) in_memory: usize,
    pub(crate) stored: Option<u64>,
    pub(crate) followers: usize,
}

type Histograms = Family<Asked, Histogram, fn() -> Histogram>;

/// All that is counted.
pub(crate) struct Metrics {
    registry: Mutex<Registry>,
    requests: Family<Answered, Counter>,
    request_time: Histograms,
    in_progress: Gauge,
    question_time: Histogram,
    thinking_cpu: Counter<f64, AtomicU64>,
    asked: Counter,
    hurried: Counter,
    answers: Counter,
    waiting: Gauge,
    wait: Histogram,
    thinking: Gauge,
    append: Histogram,
    in_memory: Gauge,
    stored: Gauge<i64, AtomicI64>,
    followers: Gauge,
}

impl Default for Metrics {
    fn default() -> Self {
        let metrics = Self {
            registry: Mutex::default(),
            requests: Family::default(),
            request_time: Family::new_with_constructor(histogram),
            in_progress: Gauge::default(),
            question_time: histogram(),
            thinking_cpu: Counter::default(),
            asked: Counter::default(),
            hurried: Counter::default(),
            answers: Counter::default(),
            waiting: Gauge::default(),
            wait: histogram(),
            thinking: Gauge::default(),
            append: histogram(),
            in_memory: Gauge::default(),
            stored: Gauge::default(),
            followers: Gauge::default(),
        };
        metrics.register();
        metrics
    }
}

fn whole(count: usize) -> i64 {
    i64::try_from(count).unwrap_or(i64::MAX)
}

fn histogram() -> Histogram {
    Histogram::new(BOUNDS)
}

impl Metrics {
    fn register(&self) {
        let mut registry = self.registry.lock().unwrap_or_else(PoisonError::into_inner);
        registry.register_collector(Box::new(Process));
        let ours = registry.sub_registry_with_prefix("memrep");
        let version = Info::new([("version", env!("CARGO_PKG_VERSION"))]);
        ours.register("build", "The memrep that runs", version);
        ours.register(
            "http_requests",
            "Requests by route pattern, method and class of status",
            self.requests.clone(),
        );
        let gauges = [
            (
                "http_in_progress",
                "Requests that wait for their answer",
                &self.in_progress,
            ),
            (
                "queue_length",
                "Requests that wait for their session or a core",
                &self.waiting,
            ),
            (
                "thinking",
                "Sessions that are worked on at this moment",
                &self.thinking,
            ),
            (
                "sessions_in_memory",
                "Sessions that are held in memory",
                &self.in_memory,
            ),
            ("sessions_stored", "Sessions in the store", &self.stored),
            ("live_followers", "Open streams of news", &self.followers),
        ];
        for (name, help, gauge) in gauges {
            ours.register(name, help, gauge.clone());
        }
        let counters = [
            ("questions_asked", "Questions that were put", &self.asked),
            (
                "questions_hurried",
                "Those put when the bound of work had ended the search",
                &self.hurried,
            ),
            ("answers_accepted", "Answers that were kept", &self.answers),
        ];
        for (name, help, counter) in counters {
            ours.register(name, help, counter.clone());
        }
        let seconds = || Unit::Seconds;
        ours.register_with_unit(
            "http_request",
            "From a request's head to its answer's, by route pattern and method",
            seconds(),
            self.request_time.clone(),
        );
        ours.register_with_unit(
            "solver_cpu",
            "CPU time of choosing questions that somebody waited for",
            seconds(),
            self.thinking_cpu.clone(),
        );
        let times = [
            (
                "question",
                "Deciding, choosing the next question and appending both",
                &self.question_time,
            ),
            (
                "queue_wait",
                "Waiting for a session, or for leave to think about it",
                &self.wait,
            ),
            (
                "store_append",
                "Appending an entry until it is on the disk",
                &self.append,
            ),
        ];
        for (name, help, time) in times {
            ours.register_with_unit(name, help, seconds(), time.clone());
        }
    }

    /// A request came.
    pub(crate) fn arrived(&self) -> Held {
        Held::of(&self.in_progress)
    }

    /// A request was answered.
    pub(crate) fn answered(&self, asked: &Asked, status: u16, took: Duration) {
        let status = match status / 100 {
            2 => "2xx",
            3 => "3xx",
            4 => "4xx",
            5 => "5xx",
            _ => "other",
        };
        let (method, route) = (asked.method, asked.route.clone());
        let answered = Answered {
            method,
            route,
            status,
        };
        self.requests.get_or_create(&answered).inc();
        let times = self.request_time.get_or_create(asked);
        times.observe(took.as_secs_f64());
    }

    /// Something waits for its turn.
    pub(crate) fn wait(&self) -> Wait {
        Wait {
            since: Instant::now(),
            waiting: Held::of(&self.waiting),
            waited: self.wait.clone(),
            thinking: self.thinking.clone(),
        }
    }

    /// It was chosen, and all that belongs to it is kept.
    pub(crate) fn chosen(&self, clock: &Clock) {
        self.question_time.observe(clock.wall.as_secs_f64());
        self.thinking_cpu.inc_by(clock.cpu.as_secs_f64());
    }

    /// Entries were appended, in one transaction.
    pub(crate) fn appended(&self, events: &[&Event], took: Duration) {
        self.append.observe(took.as_secs_f64());
        for event in events {
            match event {
                Event::Answered { .. } | Event::Said { .. } => {
                    self.answers.inc();
                }
                Event::Asked { hurried, .. } => {
                    self.asked.inc();
                    self.hurried.inc_by(u64::from(*hurried));
                }
                _ => {}
            }
        }
    }

    /// All of it, in the text format of `OpenMetrics`.
    pub(crate) fn text(&self, standing: &Standing) -> Result<String, std::fmt::Error> {
        self.in_memory.set(whole(standing.in_memory));
        if let Some(stored) = standing.stored {
            self.stored.set(stored.cast_signed());
        }
        self.followers.set(whole(standing.followers));
        let registry = self.registry.lock().unwrap_or_else(PoisonError::into_inner);
        let mut page = String::new();
        text::encode(&mut page, &registry)?;
        Ok(page)
    }
}

/// One that is counted while it lasts.
pub(crate) struct Held(Gauge);

impl Held {
    fn of(gauge: &Gauge) -> Self {
        gauge.inc();
        Self(gauge.clone())
    }
}

impl Drop for Held {
    fn drop(&mut self) {
        self.0.dec();
    }
}

/// Somebody's wait for their turn.
pub(crate) struct Wait {
    since: Instant,
    waiting: Held,
    waited: Histogram,
    thinking: Gauge,
}

impl Wait {
    /// The wait is over, and work begins.
    pub(crate) fn over(self) -> Held {
        self.waited.observe(self.since.elapsed().as_secs_f64());
        drop(self.waiting);
        Held::of(&self.thinking)
    }
}

/// What the choice of a question took, with whatever belongs to it.
#[derive(Default)]
pub(crate) struct Clock {
    wall: Duration,
    cpu: Duration,
}

impl Clock {
    /// Runs a part of it.
    pub(crate) fn run<T>(&mut self, work: impl FnOnce() -> T) -> T {
        let (begun, cpu) = (Instant::now(), thread_cpu());
        let result = work();
        self.wall += begun.elapsed();
        self.cpu += thread_cpu().saturating_sub(cpu);
        result
    }

    /// So long it took, without waiting for a turn.
    pub(crate) fn wall(&self) -> Duration {
        self.wall
    }
}

/// What the operating system knows of the process.
#[derive(Debug)]
struct Process;

impl Collector for Process {
    fn encode(&self, mut encoder: DescriptorEncoder<'_>) -> Result<(), std::fmt::Error> {
        let cpu = ConstCounter::new(process_cpu().as_secs_f64());
        let kind = cpu_kind(&cpu);
        cpu.encode(encoder.encode_descriptor(
            "process_cpu_seconds",
            "CPU time, user and system",
            None,
            kind,
        )?)?;
        let Some(bytes) = resident_bytes() else {
            return Ok(());
        };
        let resident = ConstGauge::new(bytes.cast_signed());
        let kind = cpu_kind(&resident);
        resident.encode(encoder.encode_descriptor(
            "process_resident_memory_bytes",
            "Memory that is in use and not swapped",
            None,
            kind,
        )?)
    }
}

fn cpu_kind(metric: &impl EncodeMetric) -> prometheus_client::metrics::MetricType {
    metric.metric_type()
}

/// The memory of this process; none where the system does not say.
fn resident_bytes() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status
        .lines()
        .find_map(|line| line.strip_prefix("VmRSS:"))?;
    let kilobytes: u64 = line.split_whitespace().next()?.parse().ok()?;
    Some(kilobytes * 1024)
}

#[cfg(unix)]
fn cpu_of(clock: rustix::time::ClockId) -> Duration {
    let time = rustix::time::clock_gettime(clock);
    Duration::new(
        time.tv_sec.unsigned_abs(),
        time.tv_nsec.unsigned_abs() as u32,
    )
}

#[cfg(unix)]
fn thread_cpu() -> Duration {
    cpu_of(rustix::time::ClockId::ThreadCPUTime)
}

#[cfg(unix)]
fn process_cpu() -> Duration {
    cpu_of(rustix::time::ClockId::ProcessCPUTime)
}

/// Not known there.
#[cfg(not(unix))]
fn thread_cpu() -> Duration {
    Duration::ZERO
}

/// Not known there.
#[cfg(not(unix))]
fn process_cpu() -> Duration {
    Duration::ZERO
}
