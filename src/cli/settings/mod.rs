//! The settings of the server, and where each comes from: a flag, the environment,
//! a file, or what holds by default, in this order.
//!
//! Everything here follows from the options that [`serve::Args`] declares. The
//! option `--idle-time` is also the variable `MEMREP_IDLE_TIME` and the file's key
//! `idle_time`; its type, its default and what it accepts are the option's.
//!
//! [`serve::Args`]: super::serve::Args

mod file;

use std::any::TypeId;
use std::ffi::OsString;
use std::fmt;
use std::path::{Path, PathBuf};

use anyhow::{Context as _, bail};
use clap::builder::Command;
use clap::error::ContextValue;
use clap::parser::ValueSource;
use clap::{Arg, ArgAction, ArgMatches, Args};

use self::file::Given;
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
        let setting = held_by(option, flags, &said, around)?;
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
    let bytes = match std::fs::read(around.folder.join(&path)) {
        Ok(bytes) => bytes,
        Err(error) if named.is_none() && error.kind() == std::io::ErrorKind::NotFound => {
            return Ok(Vec::new());
        }
        Err(error) => {
            return Err(error).context(format!(
                "{}: cannot read the settings in this file: name another with --config or {}",
                path.display(),
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

/// Whether it may be said more than once.
fn is_list(option: &Arg) -> bool {
    matches!(option.get_action(), ArgAction::Append)
}

fn held_by(
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
        // What is set for other programs is often set to nothing.
        if text.is_empty() && ALSO.iter().any(|(_, also)| *also == name) {
            continue;
        }
        // None of those that may be said several times has a blank in it.
        let texts = if is_list(option) {
            text.split_whitespace().map(String::from).collect()
        } else {
            vec![text]
        };
        return Ok(held(texts, Source::Environment(name)));
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
    match held.texts.first().map(String::as_str) {
        Some("true" | "1" | "yes" | "on") => Ok(vec![flag]),
        Some("false" | "0" | "no" | "off") | None => Ok(Vec::new()),
        Some(_) => bail!("{}: give true or false", held.source),
    }
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

/// What an error says, without the passwords in what was given; nothing where there are
/// none.
pub(super) fn without_passwords(error: &clap::Error) -> Option<String> {
    let given = error.context().filter_map(|(_, value)| match value {
        ContextValue::String(text) => Some((text, masked(text))),
        _ => None,
    });
    let mut told = None;
    for (text, masked) in given.filter(|(text, masked)| *text != masked) {
        let so_far = told.unwrap_or_else(|| error.to_string());
        told = Some(so_far.replace(text, &masked));
    }
    told
}

/// The text without the passwords in it: those of addresses such as
/// `postgres://user:password@host/name`, and of `password=…`.
pub(super) fn masked(text: &str) -> String {
    const HIDDEN: &str = "***";
    let mut shown = text.to_owned();
    if let Some(scheme) = shown.find("://") {
        let user = scheme + "://".len();
        // A password may have any character in it, even those that end it elsewhere.
        if let Some(end) = shown.rfind('@').filter(|end| *end > user)
            && let Some(colon) = shown[user..end].find(':')
        {
            shown.replace_range(user + colon + 1..end, HIDDEN);
        }
    }
    let mut from = 0;
    while let Some(found) = shown[from..].to_ascii_lowercase().find("password=") {
        let start = from + found + "password=".len();
        let rest = &shown[start..];
        let end = match rest.strip_prefix('\'') {
            Some(quoted) => quoted.find('\'').map(|end| end + 2),
            None => rest.find(|c: char| c == '&' || c.is_whitespace()),
        };
        shown.replace_range(start..start + end.unwrap_or(rest.len()), HIDDEN);
        from = start + HIDDEN.len();
    }
    shown
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
