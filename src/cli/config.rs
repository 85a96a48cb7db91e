//! `memrep config`: the settings that the server would run with, and where each
//! comes from.

use std::process::ExitCode;

use clap::{ArgMatches, ValueEnum};
use serde_json::{Value, json};

use super::settings::{self, Held, Kind, Source};
use super::{output, serve};

/// Arguments of `memrep config`.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:
  memrep config
  MEMREP_LEASE=60 memrep config --addr 127.0.0.1:9000
  memrep config --config lab.toml --format json

Exit status: 0, or 2 if a setting is wrong; what is wrong is told with its place.")]
#[group(skip)]
pub(super) struct Args {
    /// As a table for people, or one JSON object a setting.
    #[arg(long, value_enum, default_value_t)]
    format: Format,
    #[command(flatten)]
    _serve: serve::Args,
}

#[derive(Clone, Copy, Debug, Default, ValueEnum)]
enum Format {
    #[default]
    Table,
    Json,
}

/// Runs the command, given how it was called.
pub(super) fn run(args: &Args, flags: &ArgMatches) -> anyhow::Result<ExitCode> {
    let (_, held) = settings::resolve::<serve::Args>(flags)?;
    match args.format {
        Format::Table => table(&held)?,
        Format::Json => {
            for setting in &held {
                output::line(object(setting))?;
            }
        }
    }
    tell_strangers(&held);
    Ok(ExitCode::SUCCESS)
}

fn table(held: &[Held]) -> anyhow::Result<()> {
    let value = |setting: &Held| match settings::shown(setting).as_slice() {
        [] => "–".to_owned(),
        texts => texts.join(", "),
    };
    let rows = held.iter().map(|setting| {
        [
            setting.key.clone(),
            value(setting),
            setting.source.to_string(),
        ]
    });
    let head = ["setting", "value", "from"].map(String::from);
    let rows: Vec<[String; 3]> = std::iter::once(head).chain(rows).collect();
    let width = |column: usize| {
        let cells = rows.iter().map(|row| row[column].chars().count());
        cells.max().unwrap_or_default()
    };
    let (first, second) = (width(0), width(1));
    for [setting, value, source] in &rows {
        output::line(format!("{setting:first$}  {value:second$}  {source}"))?;
    }
    Ok(())
}

fn object(held: &Held) -> Value {
    let typed = |text: String| match held.kind {
        Kind::Text => Value::from(text),
        Kind::Switch => Value::from(text == "true"),
        // It was read as a number before.
        Kind::Whole => text.parse::<u64>().map_or(Value::Null, Value::from),
    };
    let mut values: Vec<Value> = settings::shown(held).into_iter().map(typed).collect();
    let value = match values.len() {
        0 => Value::Null,
        1 => values.remove(0),
        _ => Value::Array(values),
    };
    let mut object = json!({"setting": held.key, "value": value});
    match &held.source {
        Source::Flag(flag) => {
            object["from"] = "flag".into();
            object["flag"] = flag.as_str().into();
        }
        Source::Environment(name) => {
            object["from"] = "environment".into();
            object["variable"] = name.as_str().into();
        }
        Source::File(path, line, column) => {
            object["from"] = "file".into();
            object["file"] = path.to_string_lossy().into();
            object["line"] = (*line).into();
            object["column"] = (*column).into();
        }
        Source::Default => object["from"] = "default".into(),
    }
    object
}

/// Names the variables that may be meant as settings and are none.
fn tell_strangers(held: &[Held]) {
    let keys: Vec<String> = held.iter().map(|held| held.key.clone()).collect();
    let names = std::env::vars_os().filter_map(|(name, _)| name.into_string().ok());
    for name in names {
        let Some(key) = name.strip_prefix("MEMREP_").map(str::to_ascii_lowercase) else {
            continue;
        };
        if let Some(near) = settings::nearest(&key, &keys).filter(|near| *near != key) {
            let near = settings::variable(near);
            output::note(format_args!(
                "note: {name} is no setting; did you mean {near}?"
            ));
        }
    }
}
