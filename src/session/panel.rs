//! Several people who answer for one session, blind to each other: what each said,
//! and how that becomes the session's answer. Must not know links, leases or time.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::agreement::Agreement;
use super::event::ReplyText;
use crate::evidence::Comparison;
use crate::learner::Reply;
use crate::task::Atom;

/// The most people of a session.
pub const MAX_PEOPLE: usize = 100;
/// The most answers that a question may want.
pub const MAX_ANSWERS: u32 = 20;
/// The longest name of a person, in characters.
pub const MAX_NAME: usize = 60;
/// Every so many answers a person is asked once more what was asked before.
const REPEAT_EVERY: usize = 8;
/// Such a question was answered at least so many answers ago.
const REPEAT_AFTER: usize = 4;

/// How the answers of several people become one.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Pooling {
    /// What most of them say.
    #[default]
    Majority,
    /// What most of them say, each as heavy as that person was reliable so far.
    Reliability,
    /// They do not: everybody who is invited teaches a rule of their own, in a
    /// session of their own.
    Alone,
}

/// What the owner of a session chooses for its people.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Terms {
    /// The answers that every question wants, from 1 to [`MAX_ANSWERS`].
    pub answers: u32,
    /// How they become one.
    #[serde(default)]
    pub pooling: Pooling,
    /// Whether people see the rule as it is now; it would lead them.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub shows_rule: bool,
}

impl Default for Terms {
    fn default() -> Self {
        Self {
            answers: 1,
            pooling: Pooling::Majority,
            shows_rule: false,
        }
    }
}

/// What one person said to a question.
#[derive(Clone, Debug, PartialEq)]
pub struct Opinion {
    /// The person.
    pub person: u32,
    /// The answer.
    pub reply: Reply<Atom>,
    /// How long it took, in milliseconds, as the person's browser says.
    pub took: Option<u64>,
}

/// An answer to a question that the same person had answered before.
#[derive(Clone, Debug, PartialEq)]
struct Repeat {
    person: u32,
    number: u32,
    reply: Reply<Atom>,
    /// Whether it was the same answer.
    same: bool,
}

/// What is known of a person.
#[derive(Clone, Debug, PartialEq)]
pub struct Person {
    /// As the owner calls them.
    pub name: String,
    /// Whether they were asked to leave.
    pub left: bool,
    /// The name of the session that is theirs alone, where they have one.
    pub session: Option<String>,
}

/// The people of a session, and what they said.
#[derive(Clone, Debug, Default)]
pub struct Panel {
    terms: Terms,
    people: BTreeMap<u32, Person>,
    /// By question, in the order in which they were given.
    opinions: BTreeMap<u32, Vec<Opinion>>,
    /// The questions in the order in which each person answered them.
    answered: BTreeMap<u32, Vec<u32>>,
    repeats: Vec<Repeat>,
}

/// How a person answers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Record {
    /// The answers given, repeated questions aside.
    pub answers: usize,
    /// The questions skipped.
    pub skipped: usize,
    /// The median time of an answer in milliseconds, where it is known.
    pub median_ms: Option<u64>,
    /// The repeated questions.
    pub repeated: usize,
    /// Those of them that were answered as before.
    pub consistent: usize,
    /// The chance that an answer of this person is the one the others give, as
    /// far as was seen; between 0 and 1.
    pub reliability: f64,
}

impl Panel {
    /// What the owner chose.
    pub fn terms(&self) -> &Terms {
        &self.terms
    }

    /// The people, by number.
    pub fn people(&self) -> &BTreeMap<u32, Person> {
        &self.people
    }

    /// Whether anybody answers for the session itself.
    pub fn is_shared(&self) -> bool {
        self.people.values().any(|person| person.session.is_none())
    }

    /// What was said to a question, in the order in which it was.
    pub fn opinions(&self, number: u32) -> &[Opinion] {
        self.opinions.get(&number).map_or(&[], Vec::as_slice)
    }

    /// What this person last said to a question that was put to them once more.
    pub(super) fn repeated(&self, person: u32, number: u32) -> Option<&Reply<Atom>> {
        let mut repeats = self.repeats.iter().rev();
        let repeat = repeats.find(|one| one.person == person && one.number == number);
        repeat.map(|repeat| &repeat.reply)
    }

    /// The questions that anybody answered.
    pub fn questions(&self) -> impl Iterator<Item = u32> + '_ {
        self.opinions.keys().copied()
    }

    /// The questions that this person answered, in their order.
    pub fn answered_by(&self, person: u32) -> &[u32] {
        self.answered.get(&person).map_or(&[], Vec::as_slice)
    }

    /// What this person said to the question.
    pub fn said(&self, person: u32, number: u32) -> Option<&Opinion> {
        let mut opinions = self.opinions(number).iter();
        opinions.find(|opinion| opinion.person == person)
    }

    /// The question to be repeated to this person, if it is time for one.
    pub fn due(&self, person: u32) -> Option<u32> {
        let answered = self.answered_by(person);
        let repeated = self.repeats.iter().filter(|repeat| repeat.person == person);
        let repeated = repeated.count();
        if answered.len() < REPEAT_EVERY * (repeated + 1) {
            return None;
        }
        let old = &answered[..answered.len() - REPEAT_AFTER];
        let said = |number: &&u32| {
            let said = self.said(person, **number);
            said.is_some_and(|opinion| opinion.reply != Reply::Skip)
        };
        let old: Vec<&u32> = old.iter().filter(said).collect();
        // One after another, from the oldest.
        (!old.is_empty()).then(|| *old[(repeated * REPEAT_AFTER) % old.len()])
    }

    /// The answer that the opinions on a question come to; none while there are
    /// too few of them, or as many say one thing as another.
    pub fn pooled(&self, number: u32) -> Option<Reply<Atom>> {
        let opinions = self.opinions(number).iter();
        let told: Vec<&Opinion> = opinions.filter(|one| one.reply != Reply::Skip).collect();
        if told.len() < self.terms.answers as usize {
            return None;
        }
        let mut votes: Vec<(&Reply<Atom>, f64)> = Vec::new();
        for opinion in told {
            let weight = match self.terms.pooling {
                // Who teaches alone has no voice here.
                Pooling::Majority | Pooling::Alone => 1.0,
                Pooling::Reliability => weight(self.reliability(opinion.person, Some(number))),
            };
            match votes.iter_mut().find(|(reply, _)| **reply == opinion.reply) {
                Some((_, sum)) => *sum += weight,
                None => votes.push((&opinion.reply, weight)),
            }
        }
        let most = votes.iter().map(|(_, sum)| *sum).fold(f64::MIN, f64::max);
        let mut best = votes.iter().filter(|(_, sum)| *sum > most - 1e-9);
        match (best.next(), best.next()) {
            (Some((reply, _)), None) => Some((*reply).clone()),
            _ => None,
        }
    }

    /// Whether the people who were to answer have, and do not agree.
    pub fn disagrees(&self, number: u32) -> bool {
        let told = |opinion: &&Opinion| opinion.reply != Reply::Skip;
        let told = self.opinions(number).iter().filter(told).count();
        told >= self.terms.answers as usize && self.pooled(number).is_none()
    }

    /// How often this person said what most others did, questions of one voice
    /// aside: (agreements + 2) of (all + 3), so that nobody starts without weight.
    /// What is said to the question `but` is not looked at.
    fn reliability(&self, person: u32, but: Option<u32>) -> f64 {
        let (mut same, mut all) = (0.0, 0.0);
        for (number, opinions) in &self.opinions {
            let mine = self.said(person, *number);
            let Some(mine) = mine.filter(|one| one.reply != Reply::Skip) else {
                continue;
            };
            if but == Some(*number) {
                continue;
            }
            let others = opinions
                .iter()
                .filter(|one| one.person != person && one.reply != Reply::Skip);
            let (with, against): (Vec<_>, Vec<_>) = others.partition(|one| one.reply == mine.reply);
            if with.is_empty() && against.is_empty() {
                continue;
            }
            all += 1.0;
            same += match with.len().cmp(&against.len()) {
                std::cmp::Ordering::Greater => 1.0,
                std::cmp::Ordering::Equal => 0.5,
                std::cmp::Ordering::Less => 0.0,
            };
        }
        for repeat in self.repeats.iter().filter(|repeat| repeat.person == person) {
            all += 1.0;
            same += f64::from(u8::from(repeat.same));
        }
        (same + 2.0) / (all + 3.0)
    }

    /// How a person answers.
    pub fn record(&self, person: u32) -> Record {
        let answered = self.answered_by(person).iter();
        let opinions: Vec<&Opinion> = answered
            .filter_map(|number| self.said(person, *number))
            .collect();
        let skipped = opinions
            .iter()
            .filter(|one| one.reply == Reply::Skip)
            .count();
        let mut times: Vec<u64> = opinions.iter().filter_map(|one| one.took).collect();
        times.sort_unstable();
        let repeats = self.repeats.iter().filter(|repeat| repeat.person == person);
        Record {
            answers: opinions.len() - skipped,
            skipped,
            median_ms: times.get(times.len() / 2).copied(),
            repeated: repeats.clone().count(),
            consistent: repeats.filter(|repeat| repeat.same).count(),
            reliability: self.reliability(person, None),
        }
    }

    /// How far the people agree.
    pub fn agreement(&self) -> Agreement {
        let row = |opinions: &Vec<Opinion>| -> BTreeMap<u32, u8> {
            let told = opinions
                .iter()
                .filter_map(|one| Some((one.person, kind(&one.reply)?)));
            told.collect()
        };
        let rows: Vec<BTreeMap<u32, u8>> = self.opinions.values().map(row).collect();
        Agreement::of(&rows)
    }

    pub(super) fn set_terms(&mut self, terms: Terms) {
        self.terms = terms;
    }

    /// Adds a person of the next number.
    pub(super) fn invite(
        &mut self,
        person: u32,
        name: &str,
        session: Option<&String>,
    ) -> Result<(), String> {
        if person != self.next_person() {
            return Err(format!("person {person} comes out of turn"));
        }
        let person_of = Person {
            name: name.to_owned(),
            left: false,
            session: session.cloned(),
        };
        self.people.insert(person, person_of);
        Ok(())
    }

    pub(super) fn dismiss(&mut self, person: u32) -> Result<(), String> {
        self.person(person)?.left = true;
        Ok(())
    }

    pub(super) fn next_person(&self) -> u32 {
        self.people.last_key_value().map_or(1, |(last, _)| last + 1)
    }

    pub(super) fn say(&mut self, number: u32, opinion: Opinion) -> Result<(), String> {
        let person = opinion.person;
        self.person(person)?;
        if self.said(person, number).is_some() {
            return Err(format!("person {person} answered question {number} before"));
        }
        self.opinions.entry(number).or_default().push(opinion);
        self.answered.entry(person).or_default().push(number);
        Ok(())
    }

    pub(super) fn unsay(&mut self, number: u32, person: u32) -> Result<(), String> {
        let found = self.opinions.get_mut(&number).and_then(|opinions| {
            let place = opinions.iter().position(|one| one.person == person)?;
            Some(opinions.remove(place))
        });
        found.ok_or_else(|| format!("person {person} has not answered question {number}"))?;
        if let Some(answered) = self.answered.get_mut(&person) {
            answered.retain(|one| *one != number);
        }
        Ok(())
    }

    pub(super) fn repeat(
        &mut self,
        number: u32,
        person: u32,
        reply: &Reply<Atom>,
    ) -> Result<(), String> {
        let said = self.said(person, number);
        let said = said.ok_or_else(|| format!("person {person} has not answered {number} yet"))?;
        let same = said.reply == *reply;
        self.repeats.push(Repeat {
            person,
            number,
            reply: reply.clone(),
            same,
        });
        Ok(())
    }

    fn person(&mut self, person: u32) -> Result<&mut Person, String> {
        let known = self.people.get_mut(&person);
        known.ok_or_else(|| format!("there is no person {person}"))
    }
}

/// The weight of a vote, by the chance that it is right: its logarithmic odds
/// (Nitzan and Paroush, "Optimal decision rules in uncertain dichotomous choice
/// situations", 1982). Who is right less often than wrong has next to none.
fn weight(reliability: f64) -> f64 {
    let chance = reliability.clamp(0.51, 0.99);
    (chance / (1.0 - chance)).ln()
}

/// The kind of an answer, for counting; none for a skipped question.
fn kind(reply: &Reply<Atom>) -> Option<u8> {
    match reply {
        Reply::Accept => Some(0),
        Reply::Reject => Some(1),
        Reply::Compared(Comparison::First) => Some(2),
        Reply::Compared(Comparison::Second) => Some(3),
        Reply::Compared(Comparison::Equal) => Some(4),
        Reply::Compared(Comparison::Incomparable) => Some(5),
        Reply::Correct | Reply::Counterexample { .. } | Reply::Skip => None,
    }
}

/// Whether a person may give this answer to a question: what needs the rule on the
/// table is the owner's to say.
pub(super) fn is_for_people(reply: &ReplyText) -> bool {
    !matches!(
        reply,
        ReplyText::Correct { .. } | ReplyText::Counterexample { .. }
    )
}
