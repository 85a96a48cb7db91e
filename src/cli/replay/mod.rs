//! `memrep replay`: a session from its log alone, and whether all that the learner
//! wrote there follows from what it was told.

mod lines;
mod report;

use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::Arc;

use anyhow::{Context as _, anyhow, bail};
use automata::format::json::{Document, Provenance};
use serde_json::Value;

use self::lines::Line;
use self::report::Put;
use super::files::{self, Content, Format};
use super::output::{self, Output};
use crate::session::{Concept, Event, Position, Session, Task};
use crate::world::World;
use crate::world::pool::PoolReader;

/// Arguments of `memrep replay`.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:
  curl -s localhost:8080/api/v1/sessions/ID/log > session.jsonl
  memrep replay session.jsonl
  memrep replay session.jsonl --next                 the question that is open
  memrep replay session.jsonl --at 20 --next         the one that was, after entry 20
  memrep replay session.jsonl --automaton rule.svg
  curl -s localhost:8080/api/v1/sessions/ID/log | memrep replay - --format json

Every question, conflict and rule in the log is worked out once more from the
entries before it, which takes as long as it took then; --fold leaves that out.

Exit status: 0 if the log stands, 1 if it does not: an entry is missing, makes no
sense, or does not follow from those before it. 2 if a file or the arguments are
at fault.")]
pub(crate) struct Args {
    /// A session's log, one JSON object a line; `-` is the standard input.
    #[arg(value_name = "LOG")]
    log: PathBuf,
    /// Go on to this entry only, by its number (`seq`).
    #[arg(long, value_name = "N")]
    at: Option<u64>,
    /// Print what is next, as the API gives it, in place of the summary.
    #[arg(long)]
    next: bool,
    /// Only rebuild the session, and work out nothing again.
    #[arg(long)]
    fold: bool,
    /// Write the rule that is on show to this file.
    #[arg(long, value_name = "FILE")]
    automaton: Option<PathBuf>,
    /// The recordings that were uploaded for the session, JSON lines.
    #[arg(long, value_name = "FILE")]
    recordings: Option<PathBuf>,
    /// How to print the summary.
    #[arg(long, value_name = "FORMAT", default_value = "text")]
    format: Output,
}

/// Reads a log as `memrep replay` does before it folds it: how many entries there are.
///
/// # Errors
///
/// With the line at fault, where there is one.
pub fn read_log(text: &str) -> anyhow::Result<usize> {
    Ok(lines::read(text)?.len())
}

/// A session that was rebuilt.
struct Rebuilt {
    session: Session,
    /// The version of memrep that began the log.
    memrep: String,
    /// What the log had put, before the learner went on from there.
    put: Put,
    /// The entries that the log had.
    entries: usize,
    /// The entries that were worked out again.
    rethought: usize,
    /// Those of them that say less than this version does.
    terse: usize,
}

/// Runs the command.
pub(crate) fn run(args: &Args) -> anyhow::Result<ExitCode> {
    let format = match &args.automaton {
        Some(path) => {
            files::check_folder(path)?;
            Some(Format::of_automaton(path)?)
        }
        None => None,
    };
    let bytes = files::bytes(&args.log)?;
    let mut rebuilt = match rebuild(args, bytes) {
        Ok(rebuilt) => rebuilt,
        Err(error) => {
            output::note(format_args!("error: {}: {error:#}", args.log.display()));
            // Files beside the log are not the log's fault.
            let is_mine = error.downcast_ref::<Elsewhere>().is_none();
            return Ok(ExitCode::from(if is_mine { 1 } else { 2 }));
        }
    };
    // The last entry may be an answer that the learner has not heard.
    if let Some(event) = rebuilt.session.think() {
        rebuilt.session.apply(&event)?;
    }
    if args.next {
        let session = &rebuilt.session;
        output::line(session.describe(session.position()))?;
    } else {
        match args.format {
            Output::Text => report::text(&rebuilt)?,
            Output::Json => output::line(report::json(&rebuilt))?,
        }
    }
    if let (Some(path), Some(format)) = (&args.automaton, format) {
        write_rule(&rebuilt.session, path, format)?;
    }
    Ok(ExitCode::SUCCESS)
}

/// What is wrong lies in another file than the log, or in the arguments.
#[derive(Debug, thiserror::Error)]
#[error("{0}")]
struct Elsewhere(String);

/// The session, up to the entry that was asked for.
fn rebuild(args: &Args, log: Vec<u8>) -> anyhow::Result<Rebuilt> {
    let text = files::utf8(log)?;
    let mut lines = lines::read(&text)?;
    if let Some(at) = args.at {
        let last = lines.len() - 1;
        if at > last as u64 {
            bail!(Elsewhere(format!(
                "there is no entry {at}: the last one is {last}"
            )));
        }
        lines.truncate(at as usize + 1);
    }
    fold(args, &lines)
}

/// Folds the log entry by entry, and works out again what the learner wrote.
fn fold(args: &Args, lines: &[Line<'_>]) -> anyhow::Result<Rebuilt> {
    let first = &lines[0];
    let begun = |line: &Line<'_>, message: String| anyhow!("line {}: {message}", line.number);
    let event = first.event()?;
    let Event::Created { memrep, task, .. } = &event else {
        let message = "the first entry of a log creates the session, and this one does not";
        return Err(begun(first, message.to_owned()));
    };
    let world = world(args, task)?;
    let session = Session::replay_in(world, std::slice::from_ref(&event));
    let session = session.map_err(|error| begun(first, error.message))?;
    let mut rebuilt = Rebuilt {
        session,
        memrep: memrep.clone(),
        put: Put::default(),
        entries: lines.len(),
        rethought: 0,
        terse: 0,
    };
    for line in &lines[1..] {
        let event = line.event()?;
        if !args.fold {
            rebuilt.check(line, &event)?;
        }
        let applied = rebuilt.session.apply(&event);
        applied.map_err(|error| anyhow!("line {}: {error}", line.number))?;
    }
    rebuilt.put = Put::of(&rebuilt.session);
    Ok(rebuilt)
}

impl Rebuilt {
    /// Works out an entry of the learner's again, with a learner that was told what
    /// stands before it and has never thought: as after a restart.
    fn check(&mut self, line: &Line<'_>, event: &Event) -> anyhow::Result<()> {
        let is_learners = matches!(
            event,
            Event::Asked { .. } | Event::Conflict { .. } | Event::Done { .. }
        );
        if !is_learners {
            return Ok(());
        }
        let mut fresh = self.session.fork();
        let follows = match fresh.position() {
            Position::Thinking => fresh.think(),
            // Several people have a question each.
            _ => fresh.further(),
        };
        let mut follows = match follows {
            Some(event) => serde_json::to_value(&event)?,
            None => Value::Null,
        };
        let logged = line.body()?;
        if says_less(&logged, &follows) {
            self.terse += 1;
            if let Value::Object(fields) = &mut follows {
                fields.remove("left");
                fields.remove("removed");
            }
        }
        self.rethought += 1;
        // Byte for byte, whatever the order of the keys in the file.
        let (logged, follows) = (logged.to_string(), follows.to_string());
        if logged == follows {
            return Ok(());
        }
        Err(anyhow!(
            "line {}: entry {} does not follow from those before it\n  the log has {logged}\n  what follows {follows}",
            line.number,
            self.session.entries(),
        ))
    }
}

/// Whether this is an entry of a version that did not tell yet what was left.
fn says_less(logged: &Value, follows: &Value) -> bool {
    logged["left"].is_null() && logged["removed"].is_null() && !follows["left"].is_null()
}

/// The world of a task whose recordings were uploaded.
fn world(args: &Args, task: &Task) -> anyhow::Result<Option<Arc<World>>> {
    let (upload, path) = match (task.upload(), &args.recordings) {
        (None, None) => return Ok(None),
        (None, Some(_)) => bail!(Elsewhere(
            "its task has no recordings: leave `--recordings` out".to_owned()
        )),
        (Some(upload), None) => bail!(Elsewhere(format!(
            "its behaviours are the recordings of the upload `{upload}`, which are not in the log: name their file by `--recordings FILE`"
        ))),
        (Some(upload), Some(path)) => (upload, path),
    };
    let alphabet = task
        .alphabet()
        .with_context(|| format!("the upload `{upload}` is of words, and the task has none"))?;
    let place = |error: &dyn std::fmt::Display| Elsewhere(format!("{}: {error}", path.display()));
    let file = std::fs::File::open(path).map_err(|error| place(&error))?;
    let pool = PoolReader::read(alphabet, file).map_err(|error| place(&error))?;
    Ok(Some(Arc::new(World::Pool(pool))))
}

fn write_rule(session: &Session, path: &Path, format: Format) -> anyhow::Result<()> {
    let rule = session.hypothesis().with_context(|| {
        "there is no rule on show here: end with `--at` at an entry that shows one, or that is done"
    })?;
    let provenance = Provenance {
        version: Some(env!("CARGO_PKG_VERSION").to_owned()),
        seed: Some(session.setup().seed),
        ..Provenance::default()
    };
    let title = &session.task().title;
    let text = match rule {
        Concept::Automaton(dfa) => {
            let document = Document {
                dfa,
                name: Some(title.clone()),
                provenance: Some(provenance),
            };
            files::render(&Content::Automaton(document), format)?
        }
        other if format == Format::Json => {
            let saved = session.universe().saved(&other, title, provenance);
            format!("{}\n", serde_json::to_string(&saved)?)
        }
        _ => bail!("this task learns no automaton: write its rule as .json"),
    };
    files::write(path, &text)
}
