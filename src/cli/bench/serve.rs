//! `memrep bench serve`: scripted people over real HTTP.

use std::net::SocketAddr;
use std::path::Path;
use std::process::ExitCode;
use std::sync::Arc;
use std::time::Duration;

use anyhow::{Context as _, bail};
use indicatif::{ProgressBar, ProgressStyle};

use super::Out;
use crate::bench::serve::{self as people, Crowd, Figures, Habits, House, Idle, Moment, Report};
use crate::cli::{files, output, serve};
use crate::oracle::Target;

/// A long run is told in pieces of this length at least.
const PIECE: Duration = Duration::from_secs(15);

/// Arguments of `memrep bench serve`.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:
  memrep bench serve
  memrep bench serve --people 500 --seconds 120 --tasks robot,tomita:5
  memrep bench serve --idle 10000 --soak 30
  memrep bench serve --url http://127.0.0.1:8080 --people 50

The server is this same program with a database of its own, which is deleted at
the end. Nothing is asked but 127.0.0.1 and ::1. Variables of the environment
such as MEMREP_LEASE reach the server.

Exit status: 0 if all requests were granted, 1 if some were not, 2 if the
arguments are at fault, or a server fails.")]
pub(super) struct Args {
    /// How many people at once, one crowd after the other.
    #[arg(long, value_name = "N,…", value_delimiter = ',', default_value = "50,100,200,500,1000",
          value_parser = clap::value_parser!(u16).range(1..=5000))]
    people: Vec<u16>,
    /// How long they think between two answers, in seconds, on average.
    #[arg(long, value_name = "SECONDS", default_value = "5", value_parser = seconds)]
    think: f64,
    /// How long a crowd is measured, once all are there.
    #[arg(long, value_name = "SECONDS", default_value = "60",
          value_parser = clap::value_parser!(u64).range(1..=86_400))]
    seconds: u64,
    /// What they teach, in turn.
    #[arg(
        long,
        value_name = "TASK,…",
        value_delimiter = ',',
        default_value = "robot,tomita:1,tomita:2,tomita:3,tomita:4,tomita:5,tomita:6,tomita:7"
    )]
    tasks: Vec<String>,
    /// Decides all that is random about them.
    #[arg(long, value_name = "SEED", default_value_t = 0)]
    seed: u64,
    /// Begins so many sessions first, which nobody goes on with.
    #[arg(long, value_name = "N", default_value_t = 0)]
    idle: usize,
    /// Then lets the first crowd go on for so long, and looks at growth.
    #[arg(long, value_name = "MINUTES", default_value_t = 0)]
    soak: u64,
    /// A server that runs on this machine, instead of one of its own.
    #[arg(long, value_name = "URL", value_parser = own_address, conflicts_with = "idle")]
    url: Option<SocketAddr>,
    /// A try: 5 and 20 people who think a second, for 5 seconds each.
    #[arg(long, conflicts_with_all = ["people", "think", "seconds"])]
    quick: bool,
    #[command(flatten)]
    out: Out,
}

fn seconds(text: &str) -> Result<f64, String> {
    let number: f64 = text.parse().map_err(|_| "give a number of seconds")?;
    if (0.01..=3600.0).contains(&number) {
        Ok(number)
    } else {
        Err("give seconds from 0.01 to 3600".to_owned())
    }
}

/// The address of a server on this machine.
fn own_address(url: &str) -> Result<SocketAddr, String> {
    let rest = url.strip_prefix("http://").unwrap_or(url);
    let address: SocketAddr = (rest.trim_end_matches('/').parse())
        .map_err(|_| "give the address of a server by its number, as in http://127.0.0.1:8080")?;
    if address.ip().is_loopback() {
        Ok(address)
    } else {
        Err("only servers on this machine are measured: give 127.0.0.1 or [::1]".to_owned())
    }
}

pub(super) fn run(args: &Args) -> anyhow::Result<ExitCode> {
    args.out.prepare()?;
    // The server has it from here.
    serve::allow_many_connections();
    let targets = args.tasks.iter().map(|name| Target::named(name));
    let think = if args.quick { 1.0 } else { args.think };
    let habits = Habits {
        targets: targets.collect::<Result<_, _>>()?,
        think: Duration::from_secs_f64(think),
        seed: args.seed,
    };
    let runtime = tokio::runtime::Builder::new_multi_thread()
        .enable_all()
        .build()
        .context("the async runtime cannot start")?;
    let report = runtime.block_on(async {
        // Whoever ends this ends its server too, which goes with what measures it.
        let stop = serve::stop_signal()?;
        tokio::select! {
            report = measure(args, habits) => report,
            () = stop => bail!("stopped before the end; nothing was written"),
        }
    })?;
    let file = |extension: &str| args.out.out.join(format!("serve.{extension}"));
    files::write(&file("csv"), &people::csv(&report)?)?;
    files::write(&file("svg"), &people::figure(&report)?)?;
    files::write(&file("md"), &people::markdown(&report))?;
    let failed = report.failed();
    output::line(report.findings())?;
    output::line(format!("See {}", file("md").display()))?;
    Ok(ExitCode::from(u8::from(failed > 0)))
}

async fn measure(args: &Args, habits: Habits) -> anyhow::Result<Report> {
    let habits = Arc::new(habits);
    let folder = tempfile::tempdir().context("cannot make a folder for the database")?;
    let progress = ProgressBar::new_spinner();
    if let Ok(style) = ProgressStyle::with_template("{spinner} {msg}") {
        progress.set_style(style);
    }
    progress.enable_steady_tick(Duration::from_millis(200));
    let (crowds, lasting) = if args.quick {
        (vec![5, 20], Duration::from_secs(5))
    } else {
        let crowds = args.people.iter().map(|people| usize::from(*people));
        (crowds.collect(), Duration::from_secs(args.seconds))
    };
    let idle = match args.idle {
        0 => None,
        sessions => Some(leave_idle(sessions, folder.path(), &habits, &progress).await?),
    };
    let (mut steps, mut stopped) = (Vec::new(), Vec::new());
    for (place, people) in crowds.iter().enumerate() {
        // Sessions that were left stay in the way of everybody.
        let within = place_of(args, folder.path(), place);
        let (house, address) = open(args, &within)?;
        progress.set_message(format!("{people} people come"));
        let mut crowd = Crowd::enter(address, *people, &habits);
        tokio::time::sleep(2 * habits.think).await;
        progress.set_message(format!("{people} people are at it"));
        steps.push(crowd.watch(lasting).await);
        if let Some(house) = house {
            stopped.push(house.close()?);
        }
        crowd.leave().await;
    }
    let soak = match (args.soak, crowds.first()) {
        (0, _) | (_, None) => None,
        (minutes, Some(people)) => {
            let within = place_of(args, folder.path(), crowds.len());
            let lasting = Duration::from_secs(60 * minutes);
            let (house, address) = open(args, &within)?;
            let moments = soak(address, *people, lasting, &habits, &progress).await;
            // Everybody has left, so that how long it takes to stop says little.
            house.map(House::close).transpose()?;
            Some((*people, moments))
        }
    };
    progress.finish_and_clear();
    let command = std::env::args().skip(1).collect::<Vec<_>>().join(" ");
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    Ok(Report {
        command: format!("memrep {command}"),
        machine: super::machine(cores),
        habits: (*habits).clone(),
        steps,
        stopped,
        idle,
        soak,
    })
}

/// Where a crowd's database is: over the idle sessions, if there are any.
fn place_of(args: &Args, folder: &Path, place: usize) -> std::path::PathBuf {
    if args.idle > 0 {
        folder.join("idle")
    } else {
        folder.join(place.to_string())
    }
}

/// A server of its own, or the one that was named.
fn open(args: &Args, folder: &Path) -> anyhow::Result<(Option<House>, SocketAddr)> {
    if let Some(address) = args.url {
        return Ok((None, address));
    }
    std::fs::create_dir_all(folder).context("cannot make a folder for the database")?;
    let house = House::open(folder)?;
    let address = house.address;
    Ok((Some(house), address))
}

async fn memory_of(address: SocketAddr) -> Option<u64> {
    Figures::of(address).await?.memory
}

async fn leave_idle(
    sessions: usize,
    folder: &Path,
    habits: &Habits,
    progress: &ProgressBar,
) -> anyhow::Result<Idle> {
    let folder = folder.join("idle");
    std::fs::create_dir_all(&folder).context("cannot make a folder for the database")?;
    let house = House::open(&folder)?;
    people::settle(house.address).await?;
    let empty = memory_of(house.address).await;
    let begun = std::cell::Cell::new(0);
    let told = || {
        begun.set(begun.get() + 1);
        progress.set_message(format!("{} of {sessions} sessions are begun", begun.get()));
    };
    let left = people::idle(house.address, sessions, habits, told).await;
    left.context("a session cannot be begun")?;
    let begun = memory_of(house.address).await;
    house.close()?;
    let house = House::open(&folder)?;
    people::settle(house.address).await?;
    let stored = memory_of(house.address).await;
    house.close()?;
    Ok(Idle {
        sessions,
        empty,
        begun,
        stored,
    })
}

async fn soak(
    address: SocketAddr,
    people: usize,
    lasting: Duration,
    habits: &Arc<Habits>,
    progress: &ProgressBar,
) -> Vec<Moment> {
    let mut crowd = Crowd::enter(address, people, habits);
    tokio::time::sleep(2 * habits.think).await;
    let piece = PIECE.max(lasting / 120);
    let (mut moments, mut at) = (Vec::new(), Duration::ZERO);
    while at < lasting {
        let minutes = (at.as_secs() / 60, lasting.as_secs() / 60);
        progress.set_message(format!(
            "{people} people for {} of {} minutes",
            minutes.0, minutes.1
        ));
        let met = crowd.watch(piece).await;
        at += met.lasted;
        moments.push(Moment {
            at,
            memory: memory_of(address).await,
            answers: met.waits.len(),
            failed: met.failed(),
            p95: met.wait(95),
            p99: met.wait(99),
        });
    }
    crowd.leave().await;
    moments
}

#[cfg(test)]
mod tests {
    use super::own_address;

    #[test]
    fn only_servers_on_this_machine_are_measured() {
        for own in ["http://127.0.0.1:8080", "http://[::1]:80/", "127.0.0.1:1"] {
            assert!(own_address(own).is_ok(), "{own}");
        }
        for other in [
            "http://192.0.2.1:80",
            "https://127.0.0.1:1",
            "http://example.org",
            "0.0.0.0:80",
        ] {
            assert!(own_address(other).is_err(), "{other}");
        }
    }
}
