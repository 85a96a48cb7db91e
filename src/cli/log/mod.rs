//! The log of the server: one line an event, for people or for programs, on the
//! standard error.
//!
//! No value can forge a line: whatever would end one, or hide what it says, is
//! escaped. Logging holds nobody up: lines wait in a bounded [`queue`].

mod line;
mod queue;

use std::sync::Arc;

use clap::ValueEnum;
use tracing::field::{Field, Visit};
use tracing::span::{Attributes, Id, Record};
use tracing::{Event, Subscriber};
use tracing_subscriber::Layer;
use tracing_subscriber::filter::{FilterExt as _, LevelFilter, ParseError, Targets, filter_fn};
use tracing_subscriber::layer::{Context, SubscriberExt as _};
use tracing_subscriber::registry::LookupSpan;
use tracing_subscriber::util::SubscriberInitExt as _;

pub(super) use self::line::Format;
use self::line::{Line, Value};
use self::queue::{Queue, Writer};

/// Begins to log, and goes on until what it returns is dropped, which waits a moment
/// for what is still to be written.
pub(super) fn start(format: Format, levels: Targets) -> Writer {
    let (queue, writer) = queue::start(format, std::io::stderr());
    let lines = Lines { format, queue };
    let levels = levels.and(filter_fn(|of| is_ours(of.target())));
    tracing_subscriber::registry()
        .with(lines.with_filter(levels))
        .init();
    std::panic::set_hook(Box::new(|panic| {
        let payload = panic.payload();
        let text = payload.downcast_ref::<String>().map(String::as_str);
        let text = text.or_else(|| payload.downcast_ref::<&str>().copied());
        let cause = text.unwrap_or("a panic without words");
        let place = panic.location().map(ToString::to_string);
        tracing::error!(cause, place = place.as_deref(), "panicked");
    }));
    writer
}

/// What is to be logged: a level, or parts of the program with one each, with commas
/// between.
///
/// # Errors
///
/// If a part is neither, or nothing of this program is meant, as with a level that is
/// misspelt: that would be a log in which nothing is ever told.
pub(super) fn levels(text: &str) -> Result<Targets, String> {
    const LEVELS: &str = "error, warn, info, debug, trace or off";
    // The parser takes nothing at all for a level as well.
    let is_level = |text: &str| !text.is_empty() && text.parse::<LevelFilter>().is_ok();
    let mut is_any = false;
    for part in text.split(',').map(str::trim) {
        let target = match part.split_once('=') {
            Some((target, level)) if is_level(level) => target,
            Some((_, level)) => return Err(format!("`{level}` is no level: give {LEVELS}")),
            None if is_level(part) => {
                is_any = true;
                continue;
            }
            None if is_ours(part) => part,
            None => return Err(format!("`{part}` is no level: give {LEVELS}")),
        };
        is_any |= is_ours(target);
    }
    if !is_any {
        return Err(format!(
            "no part of memrep is named: give {LEVELS}, or parts as in `memrep::server=debug`"
        ));
    }
    text.parse().map_err(|error: ParseError| error.to_string())
}

/// Whether this program tells it. Others are not heard, whatever level is asked for:
/// they tell whole addresses and headers, and in some of these there are keys.
fn is_ours(target: &str) -> bool {
    let name = env!("CARGO_CRATE_NAME");
    target
        .strip_prefix(name)
        .is_some_and(|rest| rest.is_empty() || rest.starts_with("::"))
}

/// Writes every event as a line, with the fields of the spans that it happens in.
struct Lines {
    format: Format,
    queue: Arc<Queue>,
}

/// What was said of an event or a span.
#[derive(Default)]
struct Fields(Vec<(&'static str, Value)>);

impl<S: Subscriber + for<'a> LookupSpan<'a>> Layer<S> for Lines {
    fn on_new_span(&self, attributes: &Attributes<'_>, id: &Id, context: Context<'_, S>) {
        let mut fields = Fields::default();
        attributes.record(&mut fields);
        if let Some(span) = context.span(id) {
            span.extensions_mut().insert(fields);
        }
    }

    fn on_record(&self, id: &Id, values: &Record<'_>, context: Context<'_, S>) {
        if let Some(span) = context.span(id)
            && let Some(fields) = span.extensions_mut().get_mut::<Fields>()
        {
            values.record(fields);
        }
    }

    fn on_event(&self, event: &Event<'_>, context: Context<'_, S>) {
        let mut fields = Fields::default();
        event.record(&mut fields);
        let metadata = event.metadata();
        let mut line = Line::new(self.format, *metadata.level(), metadata.target());
        let message = fields.0.iter().find(|(name, _)| *name == "message");
        line.message(message.map_or(&Value::Text(String::new()), |(_, value)| value));
        for (name, value) in fields.0.iter().filter(|(name, _)| *name != "message") {
            line.field(name, value);
        }
        for span in context.event_scope(event).into_iter().flatten() {
            if let Some(fields) = span.extensions().get::<Fields>() {
                for (name, value) in &fields.0 {
                    line.field(name, value);
                }
            }
        }
        self.queue.push(line.end());
    }
}

impl Visit for Fields {
    fn record_f64(&mut self, field: &Field, value: f64) {
        self.0.push((field.name(), Value::Number(value)));
    }

    fn record_i64(&mut self, field: &Field, value: i64) {
        self.0.push((field.name(), Value::Plain(value.to_string())));
    }

    fn record_u64(&mut self, field: &Field, value: u64) {
        self.0.push((field.name(), Value::Plain(value.to_string())));
    }

    fn record_bool(&mut self, field: &Field, value: bool) {
        self.0.push((field.name(), Value::Plain(value.to_string())));
    }

    fn record_str(&mut self, field: &Field, value: &str) {
        self.0.push((field.name(), Value::Text(value.to_owned())));
    }

    fn record_debug(&mut self, field: &Field, value: &dyn std::fmt::Debug) {
        self.0
            .push((field.name(), Value::Text(format!("{value:?}"))));
    }
}

impl ValueEnum for Format {
    fn value_variants<'a>() -> &'a [Self] {
        &[Self::Text, Self::Json]
    }

    fn to_possible_value(&self) -> Option<clap::builder::PossibleValue> {
        Some(clap::builder::PossibleValue::new(match self {
            Self::Text => "text",
            Self::Json => "json",
        }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What is logged of `events` in this format, line by line.
    fn lines_of(format: Format, events: impl FnOnce()) -> Vec<String> {
        let out = queue::Kept::default();
        let (queue, writer) = queue::start(format, out.clone());
        let lines = tracing_subscriber::registry().with(Lines { format, queue });
        tracing::subscriber::with_default(lines, events);
        drop(writer);
        let text = String::from_utf8(out.bytes()).unwrap();
        // As lenient readers divide lines.
        let ends = [
            '\n', '\r', '\u{b}', '\u{c}', '\u{85}', '\u{2028}', '\u{2029}',
        ];
        let lines = text.strip_suffix('\n').unwrap().split(ends);
        lines.map(String::from).collect()
    }

    const HOSTILE: &str =
        "a\n2026-01-01T00:00:00.000Z ERROR forged\r\u{85}\u{2028}\u{1b}[31m\u{202e}\" b=1";

    fn hostile_events() {
        let span = tracing::info_span!("request", request = HOSTILE, route = "/sessions/{id}");
        let _in = span.enter();
        tracing::error!(cause = %HOSTILE, debug = ?HOSTILE, status = 500, ms = 1.25, "went {HOSTILE}");
    }

    #[test]
    fn no_value_forges_a_line_or_hides_one() {
        for format in [Format::Text, Format::Json] {
            let lines = lines_of(format, hostile_events);
            assert_eq!(lines.len(), 1, "{lines:?}");
            let hidden = |c: char| c.is_control() || ('\u{202a}'..='\u{202e}').contains(&c);
            assert!(!lines[0].contains(hidden), "{lines:?}");
        }
    }

    #[test]
    fn a_line_for_programs_is_an_object_with_the_fields_of_its_spans() {
        let lines = lines_of(Format::Json, hostile_events);
        let line: serde_json::Value = serde_json::from_str(&lines[0]).unwrap();
        assert_eq!(line["level"], "error");
        assert_eq!(line["message"], format!("went {HOSTILE}"));
        assert_eq!(line["cause"], HOSTILE);
        assert_eq!(line["request"], HOSTILE);
        assert_eq!((&line["status"], &line["ms"]), (&500.into(), &1.25.into()));
        let at = line["at"].as_str().unwrap();
        assert!(
            at.starts_with("20") && at.ends_with('Z') && at.len() == 24,
            "{at}"
        );
    }

    #[test]
    fn a_line_for_people_quotes_only_what_needs_it() {
        let lines = lines_of(Format::Text, || {
            tracing::info!(route = "/sessions/{id}", said = "two words", "answered");
        });
        let (_, rest) = lines[0].split_once(' ').unwrap();
        assert_eq!(
            rest,
            "INFO  answered route=/sessions/{id} said=\"two words\" target=memrep::cli::log::tests"
        );
    }
}
