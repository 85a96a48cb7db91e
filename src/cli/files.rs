//! The files that commands read and write: finds the format, and says in errors
//! which file it was, where in it, and what to do.

use std::fmt;
use std::io::{Read as _, Write as _};
use std::path::Path;

use anyhow::{Context as _, anyhow, bail};
use automata::Sample;
use automata::format::json::Document;
use automata::format::{abbadingo, dot, dot_people, hoa, json, jsonl};
use clap::ValueEnum;

use crate::draw::{self, Captions};

/// The formats of files, by the names that `--from` and `--to` take.
///
/// A new one is a name here and in [`Format::of_extension`], and an arm wherever
/// the compiler then asks for one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Format {
    /// Automaton: memrep's own file (.json).
    Json,
    /// Automaton: DOT for programs such as `AALpy` (.dot, .gv).
    Dot,
    /// Automaton: DOT for a picture; write only.
    DotPeople,
    /// Automaton: a picture (.svg); write only.
    Svg,
    /// Automaton: Hanoi omega-automata, finite semantics (.hoa); write only.
    Hoa,
    /// Sample: Abbadingo, labelled words (.abb).
    Abb,
    /// Sample: JSON lines, labelled words and preferences (.jsonl).
    Jsonl,
}

impl fmt::Display for Format {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let value = self.to_possible_value();
        f.write_str(value.as_ref().map_or("", |value| value.get_name()))
    }
}

/// What a file holds.
pub(crate) enum Content {
    /// An automaton.
    Automaton(Document),
    /// A sample.
    Sample(Sample),
}

impl Format {
    /// The format that an extension stands for.
    fn of_extension(extension: &str) -> Option<Self> {
        Some(match extension.to_ascii_lowercase().as_str() {
            "json" => Self::Json,
            "dot" | "gv" => Self::Dot,
            "svg" => Self::Svg,
            "hoa" => Self::Hoa,
            "abb" => Self::Abb,
            "jsonl" => Self::Jsonl,
            _ => return None,
        })
    }

    /// The format that was asked for by `option`, or else that of the path.
    pub(crate) fn choose(asked: Option<Self>, path: &Path, option: &str) -> anyhow::Result<Self> {
        asked.or_else(|| Self::of_path(path)).ok_or_else(|| {
            anyhow!(
                "{}: the extension does not tell the format: name it by `{option} FORMAT`",
                path.display()
            )
        })
    }

    /// The format that a path's extension stands for.
    fn of_path(path: &Path) -> Option<Self> {
        let extension = path.extension().and_then(|extension| extension.to_str());
        extension.and_then(Self::of_extension)
    }

    /// The format in which an automaton is to be written to this path.
    pub(crate) fn of_automaton(path: &Path) -> anyhow::Result<Self> {
        match Self::of_path(path) {
            Some(format) if !matches!(format, Self::Abb | Self::Jsonl) => Ok(format),
            _ => bail!(
                "{}: no automaton is written by this ending: choose .json, .dot, .svg or .hoa",
                path.display()
            ),
        }
    }
}

/// Reads an automaton or a sample. The path `-` is the standard input.
pub(crate) fn read(path: &Path, asked: Option<Format>) -> anyhow::Result<Content> {
    let format = Format::choose(asked, path, "--from")?;
    let parse: fn(&str) -> anyhow::Result<Content> = match format {
        Format::Json => |text| Ok(Content::Automaton(json::read(text)?)),
        Format::Dot => |text| Ok(Content::Automaton(dot::read(text)?.into())),
        Format::Abb => |text| Ok(Content::Sample(abbadingo::read(text)?)),
        Format::Jsonl => |text| Ok(Content::Sample(jsonl::read(text)?)),
        Format::DotPeople | Format::Svg | Format::Hoa => bail!(
            "{}: the format {format} is only written: read json, dot, abb or jsonl",
            path.display()
        ),
    };
    parse(&text(path)?).with_context(|| path.display().to_string())
}

/// Whether the file is a task: TOML, or JSON with symbols. One that cannot be read is
/// none.
pub(crate) fn is_task(path: &Path) -> bool {
    match path.extension().and_then(|extension| extension.to_str()) {
        Some("toml") => true,
        Some("json") => {
            let text = std::fs::read(path).unwrap_or_default();
            let value: Option<serde_json::Value> = serde_json::from_slice(&text).ok();
            value.is_some_and(|value| value.get("symbols").is_some())
        }
        _ => false,
    }
}

/// Reads an automaton with its name and provenance.
pub(crate) fn read_automaton(path: &Path, asked: Option<Format>) -> anyhow::Result<Document> {
    match read(path, asked)? {
        Content::Automaton(document) => Ok(document),
        Content::Sample(_) => bail!(
            "{}: expected an automaton (json or dot), found a sample; `memrep identify` finds the automaton of a sample",
            path.display()
        ),
    }
}

/// An item's line in its file: the number, from 1, and the text.
pub(crate) struct ItemLine {
    pub(crate) number: usize,
    pub(crate) text: String,
}

/// Reads a sample, with the line of each of its items.
pub(crate) fn read_sample(
    path: &Path,
    asked: Option<Format>,
) -> anyhow::Result<(Sample, Vec<ItemLine>)> {
    let parse = match Format::choose(asked, path, "--from")? {
        Format::Abb => abbadingo::read,
        Format::Jsonl => jsonl::read,
        other => bail!(
            "{}: expected a sample (abb or jsonl), not the format {other}, which holds an automaton",
            path.display()
        ),
    };
    let text = text(path)?;
    let sample = parse(&text).with_context(|| path.display().to_string())?;
    // In both formats an item is a line that is not empty; what comes before
    // the items, the sizes or the alphabet, is one as well.
    let filled = (text.lines().enumerate()).filter(|(_, line)| !line.trim().is_empty());
    let mut lines: Vec<ItemLine> = filled
        .map(|(index, line)| ItemLine {
            number: index + 1,
            text: line.trim().to_owned(),
        })
        .collect();
    lines.drain(..lines.len() - sample.items().len());
    Ok((sample, lines))
}

/// The text of a file; of the standard input, if the path is `-`.
pub(crate) fn text(path: &Path) -> anyhow::Result<String> {
    utf8(bytes(path)?).with_context(|| path.display().to_string())
}

/// What is in a file, whatever it is; in the standard input, if the path is `-`.
pub(crate) fn bytes(path: &Path) -> anyhow::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    if path == Path::new("-") {
        std::io::stdin().lock().read_to_end(&mut bytes)
    } else {
        std::fs::File::open(path).and_then(|mut file| file.read_to_end(&mut bytes))
    }
    .with_context(|| format!("{}: cannot read it", path.display()))?;
    Ok(bytes)
}

/// These bytes as a text, without the mark that some editors put before one.
pub(crate) fn utf8(mut bytes: Vec<u8>) -> anyhow::Result<String> {
    const MARK: &[u8] = "\u{feff}".as_bytes();
    if bytes.starts_with(MARK) {
        bytes.drain(..MARK.len());
    }
    String::from_utf8(bytes).map_err(|error| {
        // As many characters as were read before the bad byte.
        let good = String::from_utf8_lossy(&error.as_bytes()[..error.utf8_error().valid_up_to()]);
        let line = good.split('\n').count();
        let column = good.chars().rev().take_while(|&c| c != '\n').count() + 1;
        anyhow!("line {line}, column {column}: this is not UTF-8: save the file as UTF-8 text")
    })
}

/// An automaton or a sample as the text of a file.
pub(crate) fn render(content: &Content, format: Format) -> anyhow::Result<String> {
    Ok(match (content, format) {
        (Content::Automaton(document), Format::Json) => json::write(document),
        (Content::Automaton(document), Format::Dot) => dot::write(&document.dfa)?,
        (Content::Automaton(document), Format::DotPeople) => dot_people::write(&document.dfa),
        (Content::Automaton(document), Format::Svg) => picture(document)?,
        (Content::Automaton(document), Format::Hoa) => hoa::write(&document.dfa)?,
        (Content::Sample(sample), Format::Abb) => abbadingo::write(sample)?,
        (Content::Sample(sample), Format::Jsonl) => jsonl::write(sample),
        (Content::Automaton(_), Format::Abb | Format::Jsonl) => {
            bail!(
                "an automaton cannot be written as a sample ({format}): choose json, dot, dot-people, svg or hoa"
            )
        }
        (
            Content::Sample(_),
            Format::Json | Format::Dot | Format::DotPeople | Format::Svg | Format::Hoa,
        ) => {
            bail!(
                "a sample cannot be written as an automaton ({format}): choose abb or jsonl, or find an automaton by `memrep identify`"
            )
        }
    })
}

/// An automaton as a picture under its name.
fn picture(document: &Document) -> anyhow::Result<String> {
    let captions = Captions {
        title: document.name.clone(),
        ..Captions::default()
    };
    draw::document(&document.dfa, &captions).context("choose dot-people and draw it with Graphviz")
}

/// Checks that there is a folder for a file that is written after long work.
pub(crate) fn check_folder(path: &Path) -> anyhow::Result<()> {
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() && !folder.is_dir() => bail!(
            "{}: there is no folder {}: make it first",
            path.display(),
            folder.display()
        ),
        _ => Ok(()),
    }
}

/// Writes a file, or to the standard output if the path is `-`.
pub(crate) fn write(path: &Path, text: &str) -> anyhow::Result<()> {
    if path == Path::new("-") {
        let mut output = std::io::stdout().lock();
        output
            .write_all(text.as_bytes())
            .and_then(|()| output.flush())
            .context("the standard output: cannot write to it")
    } else {
        std::fs::write(path, text).with_context(|| format!("{}: cannot write it", path.display()))
    }
}
