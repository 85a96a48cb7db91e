//! One line of a log. Knows nothing of where it goes.

use std::fmt::Write as _;
use std::time::{SystemTime, UNIX_EPOCH};

use tracing::Level;

/// For whom lines are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::cli) enum Format {
    /// For people: words, then fields.
    Text,
    /// For programs: one JSON object a line.
    Json,
}

/// What a field says.
pub(super) enum Value {
    /// A number with a fraction.
    Number(f64),
    /// A number or a truth value, as JSON writes it.
    Plain(String),
    Text(String),
}

/// A line that is being written.
pub(super) struct Line {
    format: Format,
    text: String,
    target: String,
    named: Vec<String>,
}

impl Line {
    /// Begins with the time and the level.
    pub(super) fn new(format: Format, level: Level, target: &str) -> Self {
        let at = time(SystemTime::now());
        let text = match format {
            Format::Text => format!("{at} {:<5}", level.as_str()),
            Format::Json => format!(
                "{{\"at\":\"{at}\",\"level\":\"{}\"",
                level.as_str().to_ascii_lowercase()
            ),
        };
        Self {
            format,
            text,
            target: target.to_owned(),
            named: ["at", "level", "message", "target"]
                .map(String::from)
                .into(),
        }
    }

    pub(super) fn message(&mut self, message: &Value) {
        match self.format {
            // Its own marks are no marks of a value.
            Format::Text => {
                let quoted = quoted(&bare(message));
                self.text.push(' ');
                self.text
                    .push_str(&quoted[1..quoted.len() - 1].replace("\\\"", "\""));
            }
            Format::Json => self.pair("message", message),
        }
    }

    /// Adds a field; the innermost of one name counts.
    pub(super) fn field(&mut self, name: &str, value: &Value) {
        if self.named.iter().any(|known| known == name) {
            return;
        }
        self.named.push(name.to_owned());
        self.pair(name, value);
    }

    pub(super) fn end(mut self) -> String {
        let target = Value::Text(std::mem::take(&mut self.target));
        self.pair("target", &target);
        self.text.push_str(match self.format {
            Format::Text => "\n",
            Format::Json => "}\n",
        });
        self.text
    }

    fn pair(&mut self, name: &str, value: &Value) {
        let is_text = matches!(value, Value::Text(_));
        let shown = bare(value);
        let shown = if is_text && (self.format == Format::Json || !is_plain(&shown)) {
            quoted(&shown)
        } else {
            shown
        };
        // Names are the program's own. Writing to a string never fails.
        let _ = match self.format {
            Format::Text => write!(self.text, " {name}={shown}"),
            Format::Json => write!(self.text, ",\"{name}\":{shown}"),
        };
    }
}

fn bare(value: &Value) -> String {
    match value {
        Value::Number(number) if number.is_finite() => number.to_string(),
        Value::Number(_) => "null".to_owned(),
        Value::Plain(text) | Value::Text(text) => text.clone(),
    }
}

/// Whether a value reads well, and as one, without quotes.
fn is_plain(text: &str) -> bool {
    let plain = |c: char| c.is_ascii_alphanumeric() || "_-./:{}*+%,".contains(c);
    !text.is_empty() && text.chars().all(plain)
}

/// The text as a JSON string, in which everything that ends a line, steers a
/// terminal or turns the direction of what follows is escaped.
fn quoted(text: &str) -> String {
    let mut quoted = String::with_capacity(text.len() + 2);
    quoted.push('"');
    for c in text.chars() {
        match c {
            '"' => quoted.push_str("\\\""),
            '\\' => quoted.push_str("\\\\"),
            '\n' => quoted.push_str("\\n"),
            '\u{200e}' | '\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}' => {
                let _ = write!(quoted, "\\u{:04x}", c as u32);
            }
            c if c.is_control() => {
                let _ = write!(quoted, "\\u{:04x}", c as u32);
            }
            c => quoted.push(c),
        }
    }
    quoted.push('"');
    quoted
}

/// UTC, `2026-01-31T12:00:00.000Z`, as the store writes it too.
fn time(now: SystemTime) -> String {
    // A clock before 1970 is wrong in any case.
    let since = now.duration_since(UNIX_EPOCH).unwrap_or_default();
    let (seconds, millis) = (since.as_secs(), since.subsec_millis());
    let (year, month, day) = date(seconds / 86_400);
    let (hour, minute, second) = (seconds / 3600 % 24, seconds / 60 % 60, seconds % 60);
    format!("{year:04}-{month:02}-{day:02}T{hour:02}:{minute:02}:{second:02}.{millis:03}Z")
}

/// The date of so many days after 1970-01-01, by the Gregorian calendar.
fn date(mut days: u64) -> (u64, u64, u64) {
    let is_leap = |year: u64| {
        year.is_multiple_of(4) && (!year.is_multiple_of(100) || year.is_multiple_of(400))
    };
    let mut year = 1970;
    // Whole cycles of the calendar first.
    year += days / 146_097 * 400;
    days %= 146_097;
    loop {
        let length = 365 + u64::from(is_leap(year));
        if days < length {
            break;
        }
        days -= length;
        year += 1;
    }
    let february = 28 + u64::from(is_leap(year));
    let lengths = [31, february, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31];
    let mut month = 1;
    for length in lengths {
        if days < length {
            break;
        }
        days -= length;
        month += 1;
    }
    (year, month, days + 1)
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use super::*;

    #[test]
    fn times_are_those_of_the_calendar() {
        for (seconds, expected) in [
            (0, "1970-01-01T00:00:00.007Z"),
            (951_782_400, "2000-02-29T00:00:00.007Z"),
            (1_767_225_599, "2025-12-31T23:59:59.007Z"),
            (4_107_542_400, "2100-03-01T00:00:00.007Z"),
            (13_574_563_200, "2400-02-29T00:00:00.007Z"),
        ] {
            let at = UNIX_EPOCH + Duration::from_secs(seconds) + Duration::from_millis(7);
            assert_eq!(time(at), expected);
        }
    }
}
