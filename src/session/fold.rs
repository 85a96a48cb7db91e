//! What every entry of a log does to its session.

use super::event::{Event, ReplyText};
use super::panel::Opinion;
use super::{Asked, Position, Session, Standing, pupil};
use crate::evidence::AnswerId;
use crate::learner::Reply;
use crate::task::{Atom, MAX_STATES};

impl Session {
    pub(super) fn fold(&mut self, event: &Event) -> Result<(), String> {
        match event {
            Event::Created { .. } => Err("the session is created a second time".to_owned()),
            Event::Asked {
                number,
                question,
                round,
                hurried,
                left,
                removed,
            } => {
                let question = question.read(&self.universe).map_err(|e| e.to_string())?;
                let asked = Asked {
                    question,
                    hurried: *hurried,
                    left: *left,
                    removed: removed.clone(),
                    round: round.clone(),
                };
                self.put(*number, asked)
            }
            Event::Answered { number, reply } => {
                if !self.open.contains(number) {
                    return Err(format!("question {number} is not open"));
                }
                let looked = match reply {
                    ReplyText::Correct { looked } => *looked,
                    _ => None,
                };
                let reply = reply.read(&self.universe).map_err(|e| e.to_string())?;
                self.settle(*number, reply, looked)
            }
            Event::Retracted { number } => {
                self.withdraw(*number)?;
                self.leave();
                Ok(())
            }
            Event::Changed { number, reply } => {
                let reply = reply.read(&self.universe).map_err(|e| e.to_string())?;
                self.replace(*number, reply)
            }
            Event::Enlarged { max_states } => {
                if !(1..=MAX_STATES).contains(max_states) {
                    return Err(format!(
                        "a bound of {max_states} states is beyond all bounds"
                    ));
                }
                self.task.max_states = *max_states;
                self.rebuild()?;
                self.leave();
                Ok(())
            }
            Event::Conflict { conflict } => {
                if !self.panel.is_shared() {
                    self.expect_thinking()?;
                }
                self.arrive(Position::Conflict(conflict.clone()));
                Ok(())
            }
            Event::Done { hypothesis } => {
                self.expect_thinking()?;
                let hypothesis = self.universe.parse_rule(hypothesis);
                let hypothesis = hypothesis.map_err(|e| e.to_string())?;
                self.open.clear();
                self.arrive(Position::Done(hypothesis));
                Ok(())
            }
            Event::Terms { .. }
            | Event::Invited { .. }
            | Event::Dismissed { .. }
            | Event::Said { .. }
            | Event::Unsaid { .. }
            | Event::Repeated { .. } => self.fold_panel(event),
        }
    }

    /// What is told of several people.
    fn fold_panel(&mut self, event: &Event) -> Result<(), String> {
        match event {
            Event::Terms { terms } => {
                self.panel.set_terms(terms.clone());
                // Fewer answers may be wanted now.
                let open: Vec<u32> = self.open.iter().copied().collect();
                open.into_iter().try_for_each(|number| self.pool(number))
            }
            Event::Invited {
                person,
                name,
                session,
            } => self.panel.invite(*person, name, session.as_ref()),
            Event::Dismissed { person } => self.panel.dismiss(*person),
            Event::Said {
                number,
                person,
                reply,
                took,
            } => {
                let reply = reply.read(&self.universe).map_err(|e| e.to_string())?;
                let opinion = Opinion {
                    person: *person,
                    reply,
                    took: *took,
                };
                self.hear(*number, opinion)
            }
            Event::Unsaid { number, person } => {
                let pooled = self.panel.pooled(*number);
                self.panel.unsay(*number, *person)?;
                let standing = self.answer_to(*number).map(|standing| &standing.reply);
                // What the owner decided otherwise stands, whatever people come to.
                if standing.is_some() && standing == pooled.as_ref() {
                    self.reopen(*number)?;
                }
                Ok(())
            }
            Event::Repeated {
                number,
                person,
                reply,
            } => {
                let reply = reply.read(&self.universe).map_err(|e| e.to_string())?;
                self.panel.repeat(*number, *person, &reply)
            }
            _ => Err("it is told of no people".to_owned()),
        }
    }

    fn expect_thinking(&self) -> Result<(), String> {
        match self.position {
            Position::Thinking => Ok(()),
            _ => Err("nothing led to it".to_owned()),
        }
    }

    /// A question to one person, or to one of several, who may have one each.
    fn put(&mut self, number: u32, asked: Asked) -> Result<(), String> {
        if !self.panel.is_shared() || !matches!(self.position, Position::Asking(_)) {
            self.expect_thinking()?;
        }
        if number != self.next_number() {
            return Err(format!("question {number} comes out of turn"));
        }
        self.asked.insert(number, asked);
        self.open.insert(number);
        if self.position == Position::Thinking {
            self.arrive(Position::Asking(number));
        }
        Ok(())
    }

    /// What one of several people says of an open question.
    fn hear(&mut self, number: u32, opinion: Opinion) -> Result<(), String> {
        if !self.open.contains(&number) {
            return Err(format!("question {number} is not open"));
        }
        self.panel.say(number, opinion)?;
        self.pool(number)
    }

    /// The answer to an open question.
    fn settle(
        &mut self,
        number: u32,
        reply: Reply<Atom>,
        looked: Option<u32>,
    ) -> Result<(), String> {
        self.record(number, &reply)?;
        self.standing.push(Standing {
            number,
            reply,
            looked,
            then: None,
        });
        self.open.remove(&number);
        self.shed();
        self.go_on(Some(number));
        Ok(())
    }

    /// The learner has to think after this answer, unless other questions are still
    /// open: what follows is then asked when somebody wants a question.
    fn go_on(&mut self, answer: Option<u32>) {
        match self.open.first() {
            Some(first) => {
                self.position = Position::Asking(*first);
                self.awaiting = None;
            }
            None => self.depart(answer),
        }
    }

    /// Settles an open question if what people said of it is enough.
    fn pool(&mut self, number: u32) -> Result<(), String> {
        match self.panel.pooled(number) {
            Some(reply) => self.settle(number, reply, None),
            None => Ok(()),
        }
    }

    /// Opens a question again if what people say of it now is not the answer that
    /// stands.
    fn reopen(&mut self, number: u32) -> Result<(), String> {
        let Some(standing) = self.answer_to(number) else {
            return Ok(());
        };
        if self.panel.pooled(number).as_ref() == Some(&standing.reply) {
            return Ok(());
        }
        self.withdraw(number)?;
        self.withdrawn.remove(&number);
        self.open.insert(number);
        self.shed();
        self.go_on(None);
        self.pool(number)
    }

    /// What was said before is otherwise now: only questions that people answer
    /// stay open, if there is still something to ask.
    fn leave(&mut self) {
        let panel = &self.panel;
        self.open
            .retain(|number| !panel.opinions(*number).is_empty());
        self.shed();
        self.go_on(None);
    }

    /// Closes open questions that are answered by what was said to others. A rule
    /// on the table is another after every answer.
    fn shed(&mut self) {
        let (asked, learner) = (&self.asked, &self.learner);
        self.open.retain(|number| {
            (asked.get(number)).is_some_and(|asked| learner.wants(&asked.question))
        });
    }

    /// The learner has thought; the answer that led here remembers where to.
    fn arrive(&mut self, position: Position) {
        if let Some(number) = self.awaiting.take()
            && let Some(standing) = self.standing.iter_mut().find(|s| s.number == number)
        {
            standing.then = Some(position.clone());
        }
        self.position = position;
    }

    /// Something is new; the learner has to think.
    fn depart(&mut self, answer: Option<u32>) {
        self.position = Position::Thinking;
        self.awaiting = answer;
    }

    fn record(&mut self, number: u32, reply: &Reply<Atom>) -> Result<(), String> {
        let Some(asked) = self.asked.get(&number) else {
            return Err(format!("question {number} was never asked"));
        };
        self.learner.record(
            AnswerId(number),
            asked.question.clone(),
            asked.round.clone(),
            reply.clone(),
        )
    }

    fn withdraw(&mut self, number: u32) -> Result<(), String> {
        let Some(place) = self.standing.iter().position(|s| s.number == number) else {
            return Err(format!("question {number} has no standing answer"));
        };
        self.standing.remove(place);
        self.withdrawn.insert(number);
        if self.learner.retract(AnswerId(number)) {
            Ok(())
        } else {
            Err(format!("the learner has no answer {number} to withdraw"))
        }
    }

    /// Another answer in the place of one that stands.
    fn replace(&mut self, number: u32, reply: Reply<Atom>) -> Result<(), String> {
        let Some(standing) = self.standing.iter_mut().find(|s| s.number == number) else {
            return Err(format!("question {number} has no standing answer"));
        };
        standing.reply = reply;
        standing.looked = None;
        standing.then = None;
        self.rebuild()?;
        self.leave();
        Ok(())
    }

    /// A learner that was told the standing answers as they are now, in order.
    fn rebuild(&mut self) -> Result<(), String> {
        self.learner = pupil::new(&self.task, &self.universe, &self.setup)?;
        let replies: Vec<_> = self
            .standing
            .iter()
            .map(|s| (s.number, s.reply.clone()))
            .collect();
        replies
            .into_iter()
            .try_for_each(|(number, reply)| self.record(number, &reply))
    }
}
