//! What a session took: answers by kind and their cost, and the time.

use crate::session::Session;
use crate::store::Entry;

/// Nobody thinks about one question for longer: this was a break.
const BREAK: i64 = 5 * 60 * 1000;

/// Answers by kind.
pub(crate) struct Effort {
    pub(crate) kinds: Vec<KindView>,
    /// The cost of all.
    pub(crate) cost: String,
}

/// The answers of a kind.
pub(crate) struct KindView {
    /// What they are called, for this many.
    pub(crate) name: &'static str,
    pub(crate) count: u32,
    /// What one costs, and all.
    pub(crate) each: String,
    pub(crate) cost: String,
}

impl Effort {
    pub(crate) fn of(session: &Session) -> Self {
        let counts = session.counts();
        let config = session.setup().config();
        let kinds = [
            ("comparisons", counts.comparison, config.comparison_cost),
            (
                "judgements",
                counts.membership + counts.conformance,
                config.membership_cost,
            ),
            (
                "rules looked at",
                counts.equivalence,
                config.equivalence_cost,
            ),
        ];
        // A kind that is never asked has an infinite price.
        let price = |count: u32, each: f64| {
            if count == 0 {
                0.0
            } else {
                f64::from(count) * each
            }
        };
        Self {
            cost: number(
                kinds
                    .iter()
                    .map(|&(_, count, each)| price(count, each))
                    .sum(),
            ),
            kinds: kinds
                .into_iter()
                .map(|(name, count, each)| KindView {
                    name,
                    count,
                    each: number(each),
                    cost: number(price(count, each)),
                })
                .collect(),
        }
    }
}

/// With at most two digits after the point.
fn number(value: f64) -> String {
    if value.is_finite() {
        ((value * 100.0).round() / 100.0).to_string()
    } else {
        "not asked".to_owned()
    }
}

/// The time from the first to the last entry of a log, without breaks.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Spent {
    /// In milliseconds.
    milliseconds: i64,
    /// How many breaks were left out.
    pub(crate) breaks: usize,
}

impl Spent {
    /// The time of a log; none where the store has no readable times.
    pub(crate) fn of(entries: &[Entry]) -> Option<Self> {
        let times: Option<Vec<i64>> = entries.iter().map(|entry| instant(&entry.at)).collect();
        let times = times?;
        let gaps = || times.windows(2).map(|pair| (pair[1] - pair[0]).max(0));
        Some(Self {
            milliseconds: gaps().filter(|gap| *gap <= BREAK).sum(),
            breaks: gaps().filter(|gap| *gap > BREAK).count(),
        })
    }

    /// About how long, in words.
    pub(crate) fn about(&self) -> String {
        match (self.milliseconds + 30_000) / 60_000 {
            0 => "less than a minute".to_owned(),
            1 => "about a minute".to_owned(),
            minutes @ 2..=90 => format!("about {minutes} minutes"),
            minutes => format!("about {} hours", (minutes + 30) / 60),
        }
    }
}

/// Milliseconds since 1970 of `2026-01-31T12:00:00.000Z`.
fn instant(at: &str) -> Option<i64> {
    let part = |from: usize, to: usize| at.get(from..to)?.parse::<i64>().ok();
    let (year, month, day) = (part(0, 4)?, part(5, 7)?, part(8, 10)?);
    let (hour, minute, second) = (part(11, 13)?, part(14, 16)?, part(17, 19)?);
    let milliseconds = part(20, 23).unwrap_or(0);
    // Years begin in March, so that a leap day is a year's last.
    let (year, month) = if month > 2 {
        (year, month - 3)
    } else {
        (year - 1, month + 9)
    };
    let days =
        365 * year + year / 4 - year / 100 + year / 400 + (153 * month + 2) / 5 + day - 719_469;
    Some((((days * 24 + hour) * 60 + minute) * 60 + second) * 1000 + milliseconds)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn instants_are_those_of_the_calendar() {
        for (at, expected) in [
            ("1970-01-01T00:00:00.000Z", 0),
            ("1970-01-01T00:00:01.250Z", 1250),
            ("2000-03-01T00:00:00.000Z", 951_868_800_000),
            ("2024-02-29T12:34:56.789Z", 1_709_210_096_789),
            ("2026-12-31T23:59:59.999Z", 1_798_761_599_999),
        ] {
            assert_eq!(instant(at), Some(expected), "{at}");
        }
        assert_eq!(instant("yesterday"), None);
    }

    #[test]
    fn breaks_are_no_answering() {
        let entry = |seq, at: &str| Entry {
            seq,
            at: at.to_owned(),
            body: String::new(),
        };
        let spent = Spent::of(&[
            entry(0, "2026-01-31T12:00:00.000Z"),
            entry(1, "2026-01-31T12:02:00.000Z"),
            entry(2, "2026-02-01T09:00:00.000Z"),
            entry(3, "2026-02-01T09:01:40.000Z"),
        ]);
        let spent = spent.unwrap();
        assert_eq!(
            (spent.about().as_str(), spent.breaks),
            ("about 4 minutes", 1)
        );
    }
}
