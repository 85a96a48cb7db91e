//! The settings of the server, and where each comes from: a flag, the environment,
//! a file, or what holds by default, in this order.
//!
//! Everything here follows from the options that [`serve::Args`] declares. The
//! option `--idle-time` is also the variable `MEMREP_IDLE_TIME` and the file's key
//! `idle_time`; its type, its default and what it accepts are the option's.
//!
//! [`serve::Args`]: super::serve::Args

mod file;
mod secrets;

use std::any::TypeId;
use std::ffi::OsString;
use std::fmt;
use std::fs::File;
use std::io::Read as _;
use std::path::{Path, PathBuf};

use anyhow::{Context as _, bail};
use clap::builder::Command;
use clap::parser::ValueSource;
use clap::{Arg, ArgAction, ArgMatches, Args};

use self::file::Given;
pub(super) use self::secrets::{masked, without_passwords};
use super::files;

/// The file that is read where none is named.
const USUAL_FILE: &str = "memrep.toml";

/// The option that names the file.
const NAMES_FILE: &str = "config";

/// Variables that other programs use too, and that count where ours is not set.
const ALSO: [(&str, &str); 1] = [("log", "RUST_LOG")];

/// What a setting's values are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    Text,
    Whole,
    Switch,
}

/// Where a setting comes from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Source {
    /// This flag.
    Flag(String),
    /// This variable of the environment.
    Environment(String),
    /// This file, at this line and column.
    File(PathBuf, usize, usize),
    /// Nobody said anything.
    Default,
}

impl fmt::Display for Source {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Flag(flag) => f.write_str(flag),
            Self::Environment(variable) => f.write_str(variable),
            Self::File(path, line, column) => {
                write!(f, "{}, line {line}, column {column}", path.display())
            }
            Self::Default => f.write_str("default"),
        }
    }
}

/// A setting as it holds.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Held {
    /// Its name in a file.
    pub(super) key: String,
    /// What its values are.
    pub(super) kind: Kind,
    /// What was said, more than one text where it may be said more than once; nothing
    /// where it does not hold at all.
    pub(super) texts: Vec<String>,
    /// Who said so.
    pub(super) source: Source,
}

/// Where settings are looked for beside the flags.
pub(super) struct Around<'a> {
    /// The variables of the environment.
    pub(super) variable: &'a dyn Fn(&str) -> Option<OsString>,
    /// The working folder.
    pub(super) folder: &'a Path,
}

/// The settings of this process, given these flags.
pub(super) fn resolve<A: Args>(flags: &ArgMatches) -> anyhow::Result<(A, Vec<Held>)> {
    let around = Around {
        variable: &|name| std::env::var_os(name),
        folder: Path::new(""),
    };
    resolve_in(flags, &around)
}

/// The settings in these surroundings, given these flags.
fn resolve_in<A: Args>(flags: &ArgMatches, around: &Around<'_>) -> anyhow::Result<(A, Vec<Held>)> {
    let mut command = A::augment_args(Command::new("memrep").no_binary_name(true));
    command.build();
    let options: Vec<&Arg> = options(&command).collect();
    let said = read_file(&options, flags, around)?;
    let mut held = Vec::new();
    let mut line = Vec::new();
    for option in options {
        let setting = held_by(&command, option, flags, &said, around)?;
        if setting.source != Source::Default {
            let said = as_flags(&setting)?;
            check(&command, &said, &setting.source)?;
            line.extend(said);
        }
        held.push(setting);
    }
    let parsed = command.try_get_matches_from(line)?;
    Ok((A::from_arg_matches(&parsed)?, held))
}

/// The variable of a setting.
pub(super) fn variable(key: &str) -> String {
    format!("MEMREP_{}", key.to_ascii_uppercase())
}

/// The name that is most like a wrong one, if any is like it.
pub(super) fn nearest<'a>(wrong: &str, names: &'a [String]) -> Option<&'a str> {
    let names = names.iter().map(String::as_str);
    let (likeness, best) = names
        .map(|name| (strsim::jaro(wrong, name), name))
        .max_by(|one, other| one.0.total_cmp(&other.0))?;
    (likeness > 0.7).then_some(best)
}

fn options(command: &Command) -> impl Iterator<Item = &Arg> {
    let own = |option: &&Arg| !matches!(option.get_id().as_str(), "help" | "version");
    command.get_arguments().filter(own)
}

fn key(option: &Arg) -> String {
    let name = option.get_long().unwrap_or(option.get_id().as_str());
    name.replace('-', "_")
}

fn kind(option: &Arg) -> Kind {
    let parsed = option.get_value_parser().type_id();
    let numbers = [
        TypeId::of::<u16>(),
        TypeId::of::<u32>(),
        TypeId::of::<u64>(),
        TypeId::of::<usize>(),
    ];
    if matches!(option.get_action(), ArgAction::SetTrue) {
        Kind::Switch
    } else if numbers.into_iter().any(|number| parsed == number) {
        Kind::Whole
    } else {
        Kind::Text
    }
}

/// What the file says: the one that is named, or the usual one if it is there.
fn read_file(
    options: &[&Arg],
    flags: &ArgMatches,
    around: &Around<'_>,
) -> anyhow::Result<Vec<Given>> {
    let named = match flags.try_get_raw(NAMES_FILE) {
        Ok(Some(mut raw)) => raw.next().map(PathBuf::from),
        _ => (around.variable)(&variable(NAMES_FILE)).map(PathBuf::from),
    };
    let path = named.clone().unwrap_or_else(|| USUAL_FILE.into());
    let bytes = match read_most(&around.folder.join(&path)) {
        Ok(bytes) => bytes,
        Err(error) if named.is_none() && error.kind() == std::io::ErrorKind::NotFound => {
            return Ok(Vec::new());
        }
        Err(error) => {
            return Err(error).context(format!(
                "{}: cannot read the settings in this file: name another with --config or {}",
                masked(&path.display().to_string()),
                variable(NAMES_FILE)
            ));
        }
    };
    let text = files::utf8(bytes).with_context(|| path.display().to_string())?;
    let known: Vec<(String, Kind, bool)> = options
        .iter()
        .filter(|option| key(option) != NAMES_FILE)
        .map(|option| (key(option), kind(option), is_list(option)))
        .collect();
    file::read(&path, &text, &known)
}

/// What is in a file of settings, which is never large.
fn read_most(path: &Path) -> std::io::Result<Vec<u8>> {
    const MOST: u64 = 1 << 20;
    let mut bytes = Vec::new();
    File::open(path)?.take(MOST + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > MOST {
        return Err(std::io::Error::other("it has more than 1 MiB"));
    }
    Ok(bytes)
}

/// Whether it may be said more than once.
fn is_list(option: &Arg) -> bool {
    matches!(option.get_action(), ArgAction::Append)
}

fn held_by(
    command: &Command,
    option: &Arg,
    flags: &ArgMatches,
    said: &[Given],
    around: &Around<'_>,
) -> anyhow::Result<Held> {
    let (id, key) = (option.get_id().as_str(), key(option));
    let held = |texts, source| Held {
        key: key.clone(),
        kind: kind(option),
        texts,
        source,
    };
    // Commands beside the server have some of its options.
    let is_known = flags.try_contains_id(id).is_ok();
    if is_known && flags.value_source(id) == Some(ValueSource::CommandLine) {
        let raw = flags.get_raw(id).unwrap_or_default();
        let texts = raw.map(|text| text.to_string_lossy().into_owned());
        let flag = format!("--{}", key.replace('_', "-"));
        return Ok(held(texts.collect(), Source::Flag(flag)));
    }
    let others = ALSO.iter().filter(|(also, _)| *also == key);
    let names = std::iter::once(variable(&key)).chain(others.map(|(_, name)| (*name).to_owned()));
    for name in names {
        let Some(value) = (around.variable)(&name) else {
            continue;
        };
        let Ok(text) = value.into_string() else {
            bail!("{name}: this is no text: give it in UTF-8, or unset it");
        };
        // None of those that may be said several times has a blank in it.
        let texts = match kind(option) {
            _ if is_list(option) => text.split_whitespace().map(String::from).collect(),
            Kind::Switch => vec![switch(&text).map_or(text, |on| on.to_string())],
            _ => vec![text],
        };
        let given = held(texts, Source::Environment(name.clone()));
        // What is meant for other programs need not be a setting of this one.
        let is_others = ALSO.iter().any(|(_, also)| *also == name);
        if is_others && check(command, &as_flags(&given)?, &given.source).is_err() {
            continue;
        }
        return Ok(given);
    }
    if let Some(given) = said.iter().find(|given| given.key == key) {
        return Ok(held(given.texts.clone(), given.source.clone()));
    }
    let defaults = option.get_default_values().iter();
    let texts = defaults.map(|text| text.to_string_lossy().into_owned());
    Ok(held(texts.collect(), Source::Default))
}

/// The setting as flags that say the same.
fn as_flags(held: &Held) -> anyhow::Result<Vec<String>> {
    let flag = format!("--{}", held.key.replace('_', "-"));
    if held.kind != Kind::Switch {
        let texts = held.texts.iter();
        return Ok(texts.map(|text| format!("{flag}={text}")).collect());
    }
    match held.texts.first().map(|text| switch(text)) {
        Some(Some(true)) => Ok(vec![flag]),
        Some(Some(false)) | None => Ok(Vec::new()),
        Some(None) => bail!("{}: give true or false", held.source),
    }
}

/// What a text says of a switch.
fn switch(text: &str) -> Option<bool> {
    let is_one_of = |words: [&str; 4]| words.iter().any(|word| text.eq_ignore_ascii_case(word));
    if is_one_of(["true", "yes", "on", "1"]) {
        return Some(true);
    }
    is_one_of(["false", "no", "off", "0"]).then_some(false)
}

/// Says what is wrong with a setting where it was said.
fn check(command: &Command, said: &[String], source: &Source) -> anyhow::Result<()> {
    // What else is needed is somebody else's to say.
    let Err(error) = command
        .clone()
        .ignore_errors(false)
        .try_get_matches_from(said)
    else {
        return Ok(());
    };
    let text = without_passwords(&error).unwrap_or_else(|| error.to_string());
    let text = text.strip_prefix("error: ").unwrap_or(&text);
    let lines = text.lines().map(str::trim);
    let message: Vec<&str> = lines.take_while(|line| !line.is_empty()).collect();
    bail!("{source}: {}", message.join(" "))
}

/// A setting's text as it may be shown: passwords are not.
pub(super) fn shown(held: &Held) -> Vec<String> {
    let hide = held.key.ends_with("password");
    let show = |text: &String| {
        if hide { "***".to_owned() } else { masked(text) }
    };
    held.texts.iter().map(show).collect()
}

#[cfg(test)]
mod tests;
