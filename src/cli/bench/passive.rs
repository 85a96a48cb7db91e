//! `memrep bench identify`: smallest automata for random samples.

use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Duration;

use anyhow::{Context as _, bail};
use automata::format::abbadingo;

use super::Out;
use crate::bench::passive::{self, Outcome};
use crate::bench::passive_page::{self, Row};
use crate::cli::{files, output};

/// Units of work that take about a second, generously: the budget then ends our
/// runs a little before the limit does.
const WORK_PER_SECOND: u64 = 2_000_000;

/// How much longer than its CPU time a run may take on a busy machine.
const PATIENCE: u32 = 10;

/// Arguments of `memrep bench identify`.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:
  memrep bench identify
  memrep bench identify --states 10,12 --words 200,1000 --trials 5
  memrep bench identify --rival venv/bin/python
  memrep bench identify samples/*.abb --limit 120

The rival is dfa-identify, in a Python that has it:
  python3 -m venv venv
  venv/bin/pip install --pre python-sat
  venv/bin/pip install --no-deps dfa-identify dfa
  venv/bin/pip install attrs funcy networkx bidict more-itertools bitarray

Exit status: 0 if every sample was solved, 1 if one was not, 2 if the arguments
are at fault or a file cannot be written.")]
pub(super) struct Args {
    /// Abbadingo files; without any, samples are drawn.
    #[arg(value_name = "FILE")]
    samples: Vec<PathBuf>,
    /// The sizes of the targets to draw.
    #[arg(long, value_name = "N,…", value_delimiter = ',', default_value = "5,8,10,12,15",
          value_parser = clap::value_parser!(u8).range(1..=60))]
    states: Vec<u8>,
    /// The numbers of words to draw for each.
    #[arg(long, value_name = "M,…", value_delimiter = ',', default_value = "50,200,500,1000",
          value_parser = clap::value_parser!(u16).range(1..))]
    words: Vec<u16>,
    /// The seed of the targets and words that are drawn.
    #[arg(long, value_name = "SEED", default_value_t = 1)]
    seed: u64,
    /// How often ours is timed on each sample.
    #[arg(long, value_name = "N", default_value = "3", value_parser = clap::value_parser!(u32).range(1..))]
    trials: u32,
    /// The seconds of CPU time that a run may take.
    #[arg(long, value_name = "SECONDS", default_value = "60", value_parser = clap::value_parser!(u64).range(1..))]
    limit: u64,
    /// A Python with dfa-identify, to be timed beside.
    #[arg(long, value_name = "PYTHON")]
    rival: Option<PathBuf>,
    #[command(flatten)]
    out: Out,
}

pub(super) fn run(args: &Args) -> anyhow::Result<ExitCode> {
    args.out.prepare()?;
    let drawn = tempfile::tempdir().context("cannot make a temporary folder for the samples")?;
    let samples = if args.samples.is_empty() {
        draw(args, drawn.path())?
    } else {
        args.samples.clone()
    };
    let limit = Duration::from_secs(args.limit);
    let progress = super::bar(samples.len() as u64);
    let mut rows = Vec::new();
    for path in &samples {
        let sample = path.file_stem().unwrap_or_default().to_string_lossy();
        progress.set_message(sample.clone().into_owned());
        rows.push(measure(args, path, sample.into_owned(), limit)?);
        progress.inc(1);
    }
    progress.finish_and_clear();
    let command = std::env::args().skip(1).collect::<Vec<_>>().join(" ");
    let command = format!("memrep {command}");
    let page = passive_page::markdown(&rows, &command, limit, &super::machine(1));
    let path = args.out.out.join("identify.md");
    files::write(&path, &page)?;
    let solved = |row: &&Row| matches!(row.ours.first(), Some(Outcome::Done { .. }));
    let unsolved = rows.len() - rows.iter().filter(solved).count();
    output::line(format!(
        "{} samples, {unsolved} of them not solved; see {}",
        rows.len(),
        path.display()
    ))?;
    Ok(ExitCode::from(u8::from(unsolved > 0)))
}

/// Draws the samples into files.
fn draw(args: &Args, folder: &Path) -> anyhow::Result<Vec<PathBuf>> {
    let mut paths = Vec::new();
    for &states in &args.states {
        for &words in &args.words {
            let states = usize::from(states);
            let most = passive::most_words(states);
            if usize::from(words) > most {
                bail!(
                    "there are only {most} words for a target of {states} states: give fewer than {words} by `--words`"
                );
            }
            let (_, sample) = passive::random_sample(states, words.into(), args.seed);
            let path = folder.join(format!("n{states}_m{words}_s{}.abb", args.seed));
            files::write(&path, &abbadingo::write(&sample)?)?;
            paths.push(path);
        }
    }
    Ok(paths)
}

/// Times ours, then the rival.
fn measure(args: &Args, path: &Path, sample: String, limit: Duration) -> anyhow::Result<Row> {
    let place = || path.display().to_string();
    let budget = args.limit.saturating_mul(WORK_PER_SECOND);
    let mut ours = Vec::new();
    for _ in 0..args.trials {
        let command = passive::ours(path, budget).with_context(place)?;
        let outcome = passive::measure(command, PATIENCE * limit).with_context(place)?;
        let solved = matches!(outcome, Outcome::Done { .. });
        ours.push(outcome);
        if !solved {
            break;
        }
    }
    let rival = args.rival.as_deref().map(|python| {
        passive::measure(passive::dfa_identify(python, path, limit), PATIENCE * limit)
            .with_context(|| format!("{}: cannot run this Python", python.display()))
    });
    Ok(Row {
        sample,
        ours,
        rival: rival.transpose()?,
    })
}
