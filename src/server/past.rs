//! Standing answers, and how they could be mended.

use super::behaviour::{BehaviourView, Brief};
use crate::evidence::Comparison;
use crate::learner::{Question, Reply};
use crate::session::{Atom, ReplyText, Session};

/// A standing answer, and how it could be mended.
pub(crate) struct PastView {
    pub(crate) number: u32,
    pub(crate) asked: &'static str,
    pub(crate) first: Option<BehaviourView>,
    pub(crate) second: Option<BehaviourView>,
    pub(crate) said: String,
    pub(crate) others: Vec<Choice>,
    /// What would follow if it was withdrawn, where that was worked out.
    pub(crate) withdrawn: Option<String>,
}

/// How many of the last answers are within reach while answering.
const RECENT: usize = 10;

/// A standing answer in a line.
pub(crate) struct RecentView {
    pub(crate) number: u32,
    pub(crate) first: Option<Brief>,
    pub(crate) second: Option<Brief>,
    pub(crate) said: &'static str,
}

impl RecentView {
    /// The last ones, the latest first.
    pub(crate) fn last(session: &Session) -> Vec<Self> {
        let standing = session.standing().iter().rev();
        Self::of(standing.map(|s| (s.number, &s.reply)), session)
    }

    /// The last ones of this person, the latest first.
    pub(crate) fn said_by(person: u32, session: &Session) -> Vec<Self> {
        let panel = session.panel();
        let said = panel
            .answered_by(person)
            .iter()
            .rev()
            .filter_map(|&number| {
                let opinion = panel.said(person, number)?;
                Some((number, &opinion.reply))
            });
        Self::of(said, session)
    }

    fn of<'a>(
        latest: impl Iterator<Item = (u32, &'a Reply<Atom>)>,
        session: &Session,
    ) -> Vec<Self> {
        let brief = |atom: &Atom| Some(Brief::of(atom, session));
        let view = |number: u32, reply: &Reply<Atom>| {
            let (first, second) = match (&session.asked(number)?.question, reply) {
                (Question::Membership { atom }, _) => (brief(atom), None),
                (Question::Comparison { first, second }, _) => (brief(first), brief(second)),
                (Question::Equivalence { .. }, Reply::Counterexample { atom, .. }) => {
                    (brief(atom), None)
                }
                (Question::Equivalence { .. }, _) => (None, None),
            };
            Some(Self {
                number,
                first,
                second,
                said: said(reply),
            })
        };
        latest
            .take(RECENT)
            .filter_map(|(number, reply)| view(number, reply))
            .collect()
    }
}

/// An answer that could be given instead.
pub(crate) struct Choice {
    pub(crate) value: &'static str,
    pub(crate) text: &'static str,
    /// What would follow, where that was worked out.
    pub(crate) follows: Option<String>,
}

const JUDGEMENTS: [(&str, &str, Reply<Atom>); 2] = [
    ("accept", "acceptable", Reply::Accept),
    ("reject", "not acceptable", Reply::Reject),
];
const COMPARISONS: [(&str, &str, Reply<Atom>); 4] = [
    ("first", "A is better", Reply::Compared(Comparison::First)),
    ("second", "B is better", Reply::Compared(Comparison::Second)),
    (
        "equal",
        "equally good or bad",
        Reply::Compared(Comparison::Equal),
    ),
    (
        "incomparable",
        "I can’t compare these",
        Reply::Compared(Comparison::Incomparable),
    ),
];

impl PastView {
    /// The standing answer of this number.
    pub(crate) fn of(number: u32, session: &Session) -> Option<Self> {
        Self::said(number, &session.answer_to(number)?.reply, session)
    }

    /// What somebody said to the question of this number.
    pub(crate) fn said(number: u32, reply: &Reply<Atom>, session: &Session) -> Option<Self> {
        let (asked, first, second, choices): (_, _, _, &[_]) = match &session
            .asked(number)?
            .question
        {
            Question::Membership { atom } => (
                "Is this acceptable?",
                Some(BehaviourView::of(atom, session)),
                None,
                &JUDGEMENTS,
            ),
            Question::Comparison { first, second } => {
                let (first, second) = BehaviourView::pair(first, second, session);
                ("Which is closer?", Some(first), Some(second), &COMPARISONS)
            }
            Question::Equivalence { .. } => {
                let word = match reply {
                    Reply::Counterexample { atom, .. } => Some(BehaviourView::of(atom, session)),
                    _ => None,
                };
                ("Is this the rule?", word, None, &[])
            }
        };
        Some(Self {
            number,
            asked,
            first,
            second,
            said: said(reply).to_owned(),
            others: choices
                .iter()
                .filter(|(_, _, r)| r != reply)
                .map(|&(value, text, _)| Choice {
                    value,
                    text,
                    follows: None,
                })
                .collect(),
            withdrawn: None,
        })
    }
}

/// What was said, for people.
pub(crate) fn said(reply: &Reply<Atom>) -> &'static str {
    match reply {
        Reply::Skip => "nothing, you skipped it",
        Reply::Correct => "this is right",
        Reply::Counterexample { label: true, .. } => "no, this should be accepted",
        Reply::Counterexample { label: false, .. } => "no, this should not be accepted",
        Reply::Accept | Reply::Reject | Reply::Compared(_) => {
            let mut choices = JUDGEMENTS.iter().chain(&COMPARISONS);
            choices
                .find(|(_, _, choice)| choice == reply)
                .map_or("", |(_, text, _)| text)
        }
    }
}

/// The value under which a form sends this answer, if a button can.
pub(crate) fn value(reply: &ReplyText) -> Option<&'static str> {
    let reply = match reply {
        ReplyText::Accept => Reply::Accept,
        ReplyText::Reject => Reply::Reject,
        ReplyText::First => Reply::Compared(Comparison::First),
        ReplyText::Second => Reply::Compared(Comparison::Second),
        ReplyText::Equal => Reply::Compared(Comparison::Equal),
        ReplyText::Incomparable => Reply::Compared(Comparison::Incomparable),
        _ => return None,
    };
    let mut choices = JUDGEMENTS.iter().chain(&COMPARISONS);
    choices
        .find(|(_, _, choice)| *choice == reply)
        .map(|(value, _, _)| *value)
}
