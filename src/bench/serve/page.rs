//! The page, the table and the chart of what people met.

use std::fmt::Write as _;
use std::time::Duration;

use super::{Habits, Idle, Met, Moment, growth};
use crate::bench::chart::{self, ChartError, Panel, Point, Series};
use crate::bench::markdown::table;

/// What is aimed at: so many percent wait so long at most.
const AIMS: [(usize, Duration); 2] = [
    (95, Duration::from_millis(100)),
    (99, Duration::from_millis(300)),
];

/// The crowd and the memory at which the aims are meant.
const AIMED_PEOPLE: usize = 500;
const AIMED_MEMORY: u64 = 512 << 20;

/// All that was measured.
#[derive(Clone, Debug)]
pub struct Report {
    /// What was run.
    pub command: String,
    /// Where.
    pub machine: String,
    /// How the people teach.
    pub habits: Habits,
    /// A crowd after the other.
    pub steps: Vec<Met>,
    /// How long the servers took to stop, with the crowd still there.
    pub stopped: Vec<Duration>,
    /// What stored sessions cost, if that was measured.
    pub idle: Option<Idle>,
    /// A long run of so many people, if there was one.
    pub soak: Option<(usize, Vec<Moment>)>,
}

impl Report {
    /// How many requests went wrong, the long run among them.
    pub fn failed(&self) -> u64 {
        let long = self.soak.iter().flat_map(|(_, moments)| moments);
        let steps: u64 = self.steps.iter().map(Met::failed).sum();
        steps + long.map(|moment| moment.failed).sum::<u64>()
    }

    /// What the measurements say, in a sentence or three.
    pub fn findings(&self) -> String {
        let mut text = String::new();
        if let Some(met) = self.steps.iter().find(|met| met.people == AIMED_PEOPLE) {
            let waits = AIMS.map(|(percent, aim)| {
                format!("p{percent} {} (aim {})", ms(met.wait(percent)), ms(aim))
            });
            let memory = met.memory.map_or("not told".to_owned(), mib);
            let _ = write!(
                text,
                "With {AIMED_PEOPLE} people at once a reply with the next question takes {}; the server's memory is {memory} at most (aim {}).",
                waits.join(", "),
                mib(AIMED_MEMORY)
            );
        } else if let Some(met) = self.steps.last() {
            let _ = write!(
                text,
                "With {} people at once, 95 in a hundred replies with the next question take at most {}.",
                met.people,
                ms(met.wait(95))
            );
        }
        let long = self.soak.iter().flat_map(|(_, moments)| moments);
        let answers: usize = self.steps.iter().map(|met| met.waits.len()).sum();
        let answers = answers + long.map(|moment| moment.answers).sum::<usize>();
        let failed = self.failed();
        let _ = write!(
            text,
            " {answers} answers were given; {failed} requests failed."
        );
        if let Some(slowest) = self.stopped.iter().max() {
            let _ = write!(
                text,
                " Told to stop with everybody at work, the server was gone after {} at most.",
                ms(*slowest)
            );
        }
        text.trim_start().to_owned()
    }
}

fn ms(time: Duration) -> String {
    let ms = time.as_secs_f64() * 1000.0;
    if ms < 10.0 {
        format!("{ms:.1} ms")
    } else {
        format!("{ms:.0} ms")
    }
}

fn mib(bytes: u64) -> String {
    format!("{:.0} MiB", bytes as f64 / f64::from(1 << 20))
}

fn cores(cores: f64) -> String {
    format!("{cores:.2}")
}

/// The page, as Markdown.
pub fn markdown(report: &Report) -> String {
    let habits = &report.habits;
    let names: Vec<String> = habits
        .targets
        .iter()
        .map(|t| format!("`{}`", t.name()))
        .collect();
    let mut page = format!(
        "# Many people at once\n\n`{}` ({}).\n\n{}\n\n",
        report.command,
        report.machine,
        report.findings()
    );
    let _ = write!(
        page,
        "Every scripted person teaches one session after the other ({}), truly, over a connection of their own to the JSON interface, and thinks {:.1} s between two answers on average (exponentially distributed). A wait is from sending an answer to having the next question: the answer is on the disk by then. *Unfinished* are those still waiting when the time was over; they count with what they had waited. After every fourth answer they look at the session's page, whose question is there already. *Append* is what the server tells of its store: the bound that 99 in a hundred do not exceed. *Put off* is how often somebody was told that the question is still being thought about; their wait goes on. Unless `--url` names one, the server is a process of its own on the same machine as the people, with a database of its own: for each crowd a new one, or with `--idle` the one that holds those sessions.\n\n![Waits by people](serve.svg)\n\nEvery row is a line of [serve.csv](serve.csv).\n\n## Waits\n\n",
        names.join(", "),
        habits.think.as_secs_f64()
    );
    let header = [
        "people",
        "seconds",
        "answers",
        "answers/s",
        "p50",
        "p95",
        "p99",
        "longest",
        "first question p95",
        "page p95",
        "append p99",
        "sessions ended",
        "put off",
        "unfinished",
        "failed",
        "server memory",
        "server cores",
        "people cores",
    ];
    let rows: Vec<Vec<String>> = report.steps.iter().map(row).collect();
    page.push_str(&table(&header.map(String::from), &rows));
    let errors: Vec<&(String, u64)> = report.steps.iter().flat_map(|met| &met.errors).collect();
    if !errors.is_empty() {
        page.push_str("\nWhat failed: ");
        let told: Vec<String> = errors
            .iter()
            .map(|(kind, count)| format!("{count} × {kind}"))
            .collect();
        let _ = writeln!(page, "{}.", told.join(", "));
    }
    if let Some(idle) = &report.idle {
        page.push_str(&idle_section(idle));
    }
    if let Some((people, moments)) = &report.soak {
        page.push_str(&soak_section(*people, moments));
    }
    page
}

fn row(met: &Met) -> Vec<String> {
    let first = super::percentile(&met.beginnings, 95);
    vec![
        met.people.to_string(),
        format!("{:.0}", met.lasted.as_secs_f64()),
        met.waits.len().to_string(),
        format!("{:.1}", met.rate()),
        ms(met.wait(50)),
        ms(met.wait(95)),
        ms(met.wait(99)),
        ms(met.longest()),
        ms(first),
        ms(super::percentile(&met.pages, 95)),
        met.appended.map_or("–".to_owned(), |seconds| {
            format!("≤ {}", ms(Duration::from_secs_f64(seconds.min(1e6))))
        }),
        met.ended.to_string(),
        met.put_off.to_string(),
        met.unfinished.to_string(),
        met.failed().to_string(),
        met.memory.map_or("–".to_owned(), mib),
        met.server_cores.map_or("–".to_owned(), cores),
        cores(met.people_cores),
    ]
}

fn idle_section(idle: &Idle) -> String {
    let told = |bytes: Option<u64>| bytes.map_or("–".to_owned(), mib);
    let each = idle.stored.zip(idle.empty).map(|(stored, empty)| {
        let more = stored.saturating_sub(empty) as f64 / idle.sessions.max(1) as f64;
        format!(" That is {more:.0} bytes for each of them.")
    });
    format!(
        "\n## Sessions that nobody teaches\n\nThe memory of a server over an empty store, of the same one after {} sessions were begun and left, and of a server that was then started over them and has listed them.{}\n\n| empty | after beginning them | started over them |\n|---|---|---|\n| {} | {} | {} |\n",
        idle.sessions,
        each.unwrap_or_default(),
        told(idle.empty),
        told(idle.begun),
        told(idle.stored)
    )
}

fn soak_section(people: usize, moments: &[Moment]) -> String {
    let lasted = moments.last().map_or(Duration::ZERO, |moment| moment.at);
    let grown = match growth(moments) {
        Some(bytes) => format!(
            "In its later half the server's memory grows by {:.1} MiB in an hour, by the line that fits best.",
            bytes / f64::from(1 << 20)
        ),
        None => "The run is too short to tell growth.".to_owned(),
    };
    let mut section = format!(
        "\n## A long run\n\n{people} people for {:.0} minutes. {grown}\n\n",
        lasted.as_secs_f64() / 60.0
    );
    // No more rows than can be read.
    let every = moments.len().div_ceil(30).max(1);
    let shown = moments.iter().enumerate();
    let rows: Vec<Vec<String>> = shown
        .filter(|(place, _)| (place + 1) % every == 0)
        .map(|(_, moment)| {
            vec![
                format!("{:.1}", moment.at.as_secs_f64() / 60.0),
                moment.memory.map_or("–".to_owned(), mib),
                moment.answers.to_string(),
                moment.failed.to_string(),
                ms(moment.p95),
                ms(moment.p99),
            ]
        })
        .collect();
    let header = ["minute", "server memory", "answers", "failed", "p95", "p99"].map(String::from);
    section.push_str(&table(&header, &rows));
    section
}

/// A line a crowd, for programs. Times are in milliseconds, memory in bytes.
///
/// # Errors
///
/// If a line cannot be written.
pub fn csv(report: &Report) -> Result<String, csv::Error> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record([
        "people",
        "seconds",
        "answers",
        "p50_ms",
        "p95_ms",
        "p99_ms",
        "max_ms",
        "begin_p95_ms",
        "page_p95_ms",
        "append_p99_ms",
        "begun",
        "ended",
        "failed",
        "reconnects",
        "put_off",
        "unfinished",
        "memory",
        "server_cores",
        "people_cores",
    ])?;
    let ms = |time: Duration| format!("{:.3}", time.as_secs_f64() * 1000.0);
    for met in &report.steps {
        writer.write_record([
            met.people.to_string(),
            format!("{:.1}", met.lasted.as_secs_f64()),
            met.waits.len().to_string(),
            ms(met.wait(50)),
            ms(met.wait(95)),
            ms(met.wait(99)),
            ms(met.longest()),
            ms(super::percentile(&met.beginnings, 95)),
            ms(super::percentile(&met.pages, 95)),
            met.appended
                .map_or(String::new(), |seconds| format!("{:.3}", seconds * 1000.0)),
            met.beginnings.len().to_string(),
            met.ended.to_string(),
            met.failed().to_string(),
            met.reconnects.to_string(),
            met.put_off.to_string(),
            met.unfinished.to_string(),
            met.memory.map_or(String::new(), |bytes| bytes.to_string()),
            met.server_cores
                .map_or(String::new(), |cores| format!("{cores:.3}")),
            format!("{:.3}", met.people_cores),
        ])?;
    }
    let bytes = writer
        .into_inner()
        .map_err(csv::IntoInnerError::into_error)?;
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}

/// Waits against people, as SVG.
///
/// # Errors
///
/// If it cannot be drawn.
pub fn figure(report: &Report) -> Result<String, ChartError> {
    let series = |percent: usize| Series {
        name: format!("p{percent}"),
        points: (report.steps.iter())
            .map(|met| {
                let value = met.wait(percent).as_secs_f64() * 1000.0;
                let (low, high) = (value, value);
                Some(Point { value, low, high })
            })
            .collect(),
    };
    let panel = |percents: &[usize], title: &str, line| Panel {
        title: title.to_owned(),
        x_title: "people at once".to_owned(),
        y_title: "wait for the next question, ms".to_owned(),
        ticks: report
            .steps
            .iter()
            .map(|met| met.people.to_string())
            .collect(),
        series: percents.iter().map(|percent| series(*percent)).collect(),
        line: Some(line),
    };
    let aims = AIMS.map(|(_, aim)| aim.as_secs_f64() * 1000.0);
    chart::svg(&[
        panel(&[50, 95], "half, and 95 in a hundred", aims[0]),
        panel(&[50, 95, 99], "and 99 in a hundred", aims[1]),
    ])
}
