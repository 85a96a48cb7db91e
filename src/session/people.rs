//! What the people of a session may do: who answers which question, and the entry
//! that comes of it.

use super::decide::{Decision, Refusal};
use super::event::{Event, ReplyText};
use super::panel::{MAX_ANSWERS, MAX_NAME, MAX_PEOPLE, Panel, Person, Terms, is_for_people};
use super::{Position, Session};
use crate::evidence::{AnswerId, Stop};
use crate::learner::{Question, Reply};
use crate::task::{Atom, is_disruptive};

impl Session {
    /// The people who answer, and what they said.
    pub fn panel(&self) -> &Panel {
        &self.panel
    }

    /// Whether the question of this number can be answered.
    pub fn is_open(&self, number: u32) -> bool {
        self.open.contains(&number)
    }

    /// The questions that can be answered, oldest first.
    pub fn open(&self) -> impl Iterator<Item = u32> + '_ {
        self.open.iter().copied()
    }

    /// The open questions that people may answer and this one has not, oldest
    /// first.
    pub fn open_to(&self, person: u32) -> impl Iterator<Item = u32> + '_ {
        self.open().filter(move |number| {
            let asked = self.asked(*number).map(|asked| &asked.question);
            let for_people = !matches!(asked, None | Some(Question::Equivalence { .. }));
            for_people && self.panel.said(person, *number).is_none()
        })
    }

    /// How many more people are wanted for an open question.
    pub fn wanted(&self, number: u32) -> usize {
        let opinions = self.panel.opinions(number).iter();
        let told = opinions.filter(|one| one.reply != Reply::Skip).count();
        let answers = self.panel.terms().answers as usize;
        if told < answers {
            answers - told
        } else {
            // They do not agree: one more may decide.
            usize::from(self.panel.pooled(number).is_none())
        }
    }

    /// [`Self::further_until`] there is something, or it is known that there is nothing.
    pub fn further(&self) -> Option<Event> {
        self.further_until(&Stop::default())
    }

    /// A question beside those that are open, or a contradiction that was not seen
    /// while several answered: the entry to append. None where what comes next
    /// depends on the open questions, or `stop` is set before it is known. Takes as long
    /// as [`Self::think`].
    pub fn further_until(&self, stop: &Stop) -> Option<Event> {
        if !self.panel.is_shared() || !matches!(self.position(), Position::Asking(_)) {
            return None;
        }
        let mut beside = self.fork();
        for number in self.open() {
            let asked = self.asked(number)?;
            // As if nobody would answer them.
            let skipped =
                beside
                    .learner
                    .record(AnswerId(number), asked.question.clone(), None, Reply::Skip);
            skipped.ok()?;
        }
        beside.position = Position::Thinking;
        let event = beside.think_until(stop)?;
        let is_another = match &event {
            Event::Asked { question, .. } => {
                let question = question.read(self.universe()).ok()?;
                !matches!(question, Question::Equivalence { .. })
            }
            Event::Conflict { .. } => true,
            _ => false,
        };
        is_another.then_some(event)
    }

    /// The owner chooses what people are to answer.
    ///
    /// # Errors
    ///
    /// If that cannot be wanted.
    pub fn set_terms(&self, terms: Terms) -> Result<Decision, Refusal> {
        if !(1..=MAX_ANSWERS).contains(&terms.answers) {
            return Err(Refusal::BadAnswers);
        }
        if *self.panel.terms() == terms {
            return Ok(Decision::Already(self.position().clone()));
        }
        Ok(Decision::Append(Event::Terms { terms }))
    }

    /// The owner invites somebody; with a session's name to teach alone there.
    ///
    /// # Errors
    ///
    /// If there are too many, or the name is no name.
    pub fn invite(&self, name: &str, session: Option<String>) -> Result<Decision, Refusal> {
        let name = name.trim();
        if name.is_empty() || name.chars().count() > MAX_NAME {
            return Err(Refusal::BadName);
        }
        if name.chars().any(is_disruptive) {
            return Err(Refusal::UnshownName);
        }
        if self.panel.people().len() >= MAX_PEOPLE {
            return Err(Refusal::TooManyPeople);
        }
        Ok(Decision::Append(Event::Invited {
            person: self.panel.next_person(),
            name: name.to_owned(),
            session,
        }))
    }

    /// The owner asks somebody to leave.
    ///
    /// # Errors
    ///
    /// If there is no such person.
    pub fn dismiss(&self, person: u32) -> Result<Decision, Refusal> {
        match self.panel.people().get(&person) {
            None => Err(Refusal::NoPerson),
            Some(Person { left: true, .. }) => Ok(Decision::Already(self.position().clone())),
            Some(_) => Ok(Decision::Append(Event::Dismissed { person })),
        }
    }

    /// One of several people answers an open question, or once more one that they
    /// answered before.
    ///
    /// # Errors
    ///
    /// If the question is not open, or the reply not theirs to give.
    pub fn say(
        &self,
        person: u32,
        number: u32,
        reply: &Reply<Atom>,
        took: Option<u64>,
    ) -> Result<Decision, Refusal> {
        match self.panel.people().get(&person) {
            Some(person) if !person.left => {}
            _ => return Err(Refusal::NoPerson),
        }
        let said = self.panel.said(person, number);
        let text = ReplyText::of(reply, self.universe());
        if !is_for_people(&text) {
            return Err(Refusal::OwnersAnswer);
        }
        if said.is_some_and(|opinion| opinion.reply == *reply)
            && self.panel.due(person) != Some(number)
        {
            return Ok(Decision::Already(self.position().clone()));
        }
        if self.panel.repeated(person, number) == Some(reply) {
            // Sent once more.
            return Ok(Decision::Already(self.position().clone()));
        }
        if !self.is_open(number) {
            return Err(self.not_open(number));
        }
        if said.is_some() {
            return Err(Refusal::Said { number });
        }
        self.check_fit(number, reply)?;
        Ok(Decision::Append(Event::Said {
            number,
            person,
            reply: text,
            took,
        }))
    }

    /// One of several people answers once more what they answered before.
    ///
    /// # Errors
    ///
    /// If that is not [due](Panel::due).
    pub fn repeat(
        &self,
        person: u32,
        number: u32,
        reply: &Reply<Atom>,
    ) -> Result<Decision, Refusal> {
        if self.panel.due(person) != Some(number) {
            return Ok(Decision::Already(self.position().clone()));
        }
        self.check_fit(number, reply)?;
        Ok(Decision::Append(Event::Repeated {
            number,
            person,
            reply: ReplyText::of(reply, self.universe()),
        }))
    }

    /// One of several people takes an answer back.
    ///
    /// # Errors
    ///
    /// If they gave none to this question.
    pub fn unsay(&self, person: u32, number: u32) -> Result<Decision, Refusal> {
        if self.panel.said(person, number).is_none() {
            return Err(self.not_standing(number));
        }
        Ok(Decision::Append(Event::Unsaid { number, person }))
    }
}
