//! The lines of a log as `GET /sessions/{id}/log` gives it: every entry with its
//! number and its time.

use anyhow::{Context as _, anyhow, ensure};
use serde_json::Value;

use crate::session::Event;

/// One entry of the log.
pub(super) struct Line<'a> {
    /// Where it stands in the file, from 1.
    pub(super) number: usize,
    /// What stands there. It is read again when it is wanted: all entries together would
    /// take many times as much memory as the log.
    text: &'a str,
}

impl Line<'_> {
    /// What it says.
    pub(super) fn event(&self) -> anyhow::Result<Event> {
        Ok(serde_json::from_value(self.body()?)?)
    }

    /// What stands there, without its number and time.
    pub(super) fn body(&self) -> anyhow::Result<Value> {
        Ok(parse(self.text)?.1)
    }
}

/// Reads the lines of a log. Empty ones are passed over.
///
/// # Errors
///
/// With the line, where it is no entry, or its number is not the next one.
pub(super) fn read(text: &str) -> anyhow::Result<Vec<Line<'_>>> {
    let mut lines: Vec<Line<'_>> = Vec::new();
    let mut numbered = None;
    for (index, line) in text.lines().enumerate() {
        if line.trim().is_empty() {
            continue;
        }
        let number = index + 1;
        let (seq, body) = parse(line).with_context(|| format!("line {number}"))?;
        let is_numbered = *numbered.get_or_insert(seq.is_some());
        ensure!(
            is_numbered == seq.is_some(),
            "line {number}: some entries have a number (`seq`) and others have none: take the log as the server gives it"
        );
        let expected = lines.len() as u64;
        if let Some(seq) = seq {
            ensure!(
                seq == expected,
                "line {number}: this is entry {seq}, and entry {expected} comes next: an entry is missing, doubled or in another place"
            );
        }
        let event: Result<Event, _> = serde_json::from_value(body.clone());
        let event = event.map_err(|error| {
            anyhow!("line {number}: entry {expected} is none of a session's log: {error}")
        })?;
        if let Some(key) = unread(&body, &serde_json::to_value(&event)?) {
            return Err(anyhow!(
                "line {number}: entry {expected} has `{key}`, which no entry of its kind has"
            ));
        }
        lines.push(Line { number, text: line });
    }
    ensure!(
        !lines.is_empty(),
        "the log is empty: give what `GET /api/v1/sessions/{{id}}/log` gives"
    );
    Ok(lines)
}

/// A key of an entry that is not read: somebody else wrote it.
fn unread<'a>(body: &'a Value, read: &Value) -> Option<&'a String> {
    let mut said = body.as_object()?.iter();
    let odd = said.find(|(key, value)| !value.is_null() && read.get(key.as_str()).is_none());
    odd.map(|(key, _)| key)
}

/// The entry's number, if it has one, and what it says.
fn parse(line: &str) -> anyhow::Result<(Option<u64>, Value)> {
    let value: Value = serde_json::from_str(line).map_err(|error| {
        let text = error.to_string();
        let place = format!(" at line {} column {}", error.line(), error.column());
        let text = text.strip_suffix(&place).unwrap_or(&text);
        anyhow!("column {}: this is not JSON: {text}", error.column().max(1))
    })?;
    let Value::Object(mut fields) = value else {
        return Err(anyhow!(
            "column 1: expected an object, one entry of the log"
        ));
    };
    fields.remove("at");
    let seq = match fields.remove("seq") {
        None => None,
        Some(seq) => Some(
            seq.as_u64()
                .ok_or_else(|| anyhow!("`seq` is {seq}: it is the number of the entry, from 0"))?,
        ),
    };
    Ok((seq, Value::Object(fields)))
}
