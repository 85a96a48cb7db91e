//! The width of words before any font is known, their wrapping and escaping.

use std::fmt::Write;

/// The size of labels in pixels.
pub(super) const FONT_SIZE: f64 = 15.0;

/// The distance between the base lines of two lines of a label, in pixels.
pub(super) const LINE_HEIGHT: f64 = 19.0;

/// The width at which a label goes on in a new line, in pixels.
const MEASURE: f64 = 150.0;

/// The width at which what stands below a circle goes on in a new line.
const NARROW: f64 = 110.0;

/// The lines a label may have; what is beyond is counted in the last one.
const MAX_LINES: usize = 5;

/// A label, broken into lines.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Label {
    /// The lines, at least one.
    pub(super) lines: Vec<String>,
    /// The width of the longest line, in pixels.
    pub(super) width: f64,
}

impl Label {
    /// The words in one list, commas between them, in as many lines as needed.
    pub(super) fn list(words: &[&str]) -> Self {
        let mut lines: Vec<String> = vec![String::new()];
        for (position, word) in words.iter().enumerate() {
            let last = position + 1 == words.len();
            let piece = if last {
                (*word).to_owned()
            } else {
                format!("{word},")
            };
            let line = lines.last().expect("there is always a line");
            let longer = if line.is_empty() {
                piece.clone()
            } else {
                format!("{line} {piece}")
            };
            if line.is_empty() || width(&longer) <= MEASURE {
                *lines.last_mut().expect("there is always a line") = longer;
            } else if lines.len() == MAX_LINES {
                let left = words.len() - position;
                *lines.last_mut().expect("there is always a line") = format!("{line} +{left} more");
                break;
            } else {
                lines.push(piece);
            }
        }
        let width = lines.iter().map(|line| width(line)).fold(0.0, f64::max);
        Self { lines, width }
    }

    /// A phrase, broken between its words into lines of about equal length.
    pub(super) fn wrapped(phrase: &str) -> Self {
        let lines = (width(phrase) / NARROW).ceil().max(1.0);
        let measure = (width(phrase) / lines).max(0.6 * NARROW);
        let mut label = Self {
            lines: Vec::new(),
            width: 0.0,
        };
        let mut line = String::new();
        for word in phrase.split_whitespace() {
            if !line.is_empty() && width(&line) + 0.5 * width(word) > measure {
                label = label.with(&std::mem::take(&mut line));
            }
            if !line.is_empty() {
                line.push(' ');
            }
            line.push_str(word);
        }
        label.with(&line)
    }

    /// The same with one more line.
    pub(super) fn with(mut self, line: &str) -> Self {
        self.width = self.width.max(width(line));
        self.lines.push(line.to_owned());
        self
    }

    /// The height of all lines, in pixels.
    pub(super) fn height(&self) -> f64 {
        LINE_HEIGHT * self.lines.len() as f64
    }
}

/// About how wide a sans-serif system font sets `text`, in pixels; rather a
/// little too wide than too narrow, so that nothing sticks out.
pub(super) fn width(text: &str) -> f64 {
    let ems: f64 = text
        .chars()
        .map(|c| match c {
            'i' | 'j' | 'l' | 'I' | '.' | ',' | ' ' | '\'' | ':' | '|' => 0.31,
            'f' | 'r' | 't' | '-' | '(' | ')' => 0.4,
            'm' | 'w' | 'M' | 'W' | '_' | '…' => 0.88,
            'A'..='Z' => 0.7,
            c if c.is_ascii() => 0.58,
            _ => 1.0,
        })
        .sum();
    ems * FONT_SIZE
}

/// Appends `text` so that it is text in markup and in attribute values, and
/// nothing else. Characters that XML does not know become `U+FFFD`.
pub(super) fn escape(out: &mut String, text: &str) {
    for c in text.chars() {
        match c {
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '&' => out.push_str("&amp;"),
            '"' => out.push_str("&quot;"),
            '\'' => out.push_str("&#39;"),
            '\t' | '\n' | '\r' => out.push(' '),
            c if c.is_control() || matches!(c, '\u{fffe}' | '\u{ffff}') => out.push('\u{fffd}'),
            c => out.push(c),
        }
    }
}

/// Appends a coordinate in pixels, to a tenth, without trailing zeros: short,
/// and the same on every machine.
pub(super) fn number(out: &mut String, value: f64) {
    let tenths = (value * 10.0).round() as i64;
    let sign = if tenths < 0 { "-" } else { "" };
    let (whole, tenth) = (tenths.unsigned_abs() / 10, tenths.unsigned_abs() % 10);
    let written = if tenth == 0 {
        write!(out, "{sign}{whole}")
    } else {
        write!(out, "{sign}{whole}.{tenth}")
    };
    written.expect("writing to a string cannot fail");
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn markup_in_words_stays_text() {
        let mut out = String::new();
        escape(&mut out, "</text><script>\"it's\" & \u{0}\u{1b}");
        assert_eq!(
            out,
            "&lt;/text&gt;&lt;script&gt;&quot;it&#39;s&quot; &amp; \u{fffd}\u{fffd}"
        );
    }

    #[test]
    fn numbers_are_short() {
        let check = |value, expect| {
            let mut out = String::new();
            number(&mut out, value);
            assert_eq!(out, expect);
        };
        check(0.0, "0");
        check(-0.01, "0");
        check(-0.5, "-0.5");
        check(12.34, "12.3");
        check(12.96, "13");
    }

    #[test]
    fn long_lists_break_and_end() {
        let words: Vec<String> = (0..100).map(|n| format!("symbol_{n}")).collect();
        let words: Vec<&str> = words.iter().map(String::as_str).collect();
        let label = Label::list(&words);
        assert_eq!(label.lines.len(), MAX_LINES);
        let last = label.lines.last().unwrap();
        assert!(last.ends_with("more"), "{last}");
        assert_eq!(Label::list(&["a", "b"]).lines, ["a, b"]);
    }
}
