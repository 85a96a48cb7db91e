//! What must hold of a session at any time.

use std::collections::BTreeMap;

use memrep::session::{Event, Position, Session};
use rand::RngExt;
use serde_json::Value;

use crate::life::Life;

fn read(log: &[String]) -> Session {
    let events: Vec<Event> = log
        .iter()
        .map(|line| serde_json::from_str(line).unwrap())
        .collect();
    Session::replay(&events).unwrap()
}

/// What the API shows as next.
fn next(session: &Session) -> String {
    session.describe(session.position()).to_string()
}

impl Life {
    /// A question beside others is the same from the log alone.
    pub(crate) fn check_further(&self, event: &Event) {
        let again = read(&self.log).further();
        assert_eq!(again.as_ref(), Some(event));
    }

    /// From the log alone, as after a restart: it stands where this one does; and
    /// where the last entry is the learner's and was lost, the same comes of the rest.
    pub(crate) fn check_rebuilt(&mut self) {
        let rebuilt = read(&self.log);
        assert_eq!(next(&rebuilt), next(&self.session));
        assert_eq!(rebuilt.entries(), self.session.entries());
        assert_eq!(rebuilt.counts(), self.session.counts());
        assert!(rebuilt.open().eq(self.session.open()));
        let (last, before) = self.log.split_last().unwrap();
        let mut cut = read(before);
        if *cut.position() == Position::Thinking {
            let thought = cut.think().unwrap();
            let text = serde_json::to_string(&thought).unwrap();
            assert_eq!(text, *last);
            cut.apply(&thought).unwrap();
            assert_eq!(next(&cut), next(&self.session));
            self.saw("rebuilt");
            // Life goes on with one of the two.
            if self.random.random() {
                self.session = cut;
            }
        }
    }

    /// An answer that was taken back, and one that was changed, equals one that was
    /// never given so: the log in which only what stands was ever asked and answered,
    /// in the order in which it was, comes to the same.
    ///
    /// The same is: the same question of the same words with the same outlook and the
    /// same hurry, or the same rule to agree with; of a conflict, the same cause and
    /// answers as many. Three things may differ by law. Questions have the numbers
    /// that are next: so they are left out, and a conflict's are those of the same
    /// questions in the other log. Which arm a bandit pulled for a question that
    /// stands is told with that question and goes along with it. And where a minimal
    /// conflict is not the only one, numbers may decide which is told.
    pub(crate) fn check_traceless(&mut self) {
        if self.session.panel().is_shared() {
            return;
        }
        let mut clean: Vec<String> = vec![self.created()];
        let mut numbers = BTreeMap::new();
        let events: Vec<Value> = self
            .log
            .iter()
            .map(|line| serde_json::from_str(line).unwrap())
            .collect();
        for (place, standing) in self.session.standing().iter().enumerate() {
            let number = place + 1;
            numbers.insert(standing.number, number as u32);
            let asked =
                |event: &&Value| event["event"] == "asked" && event["number"] == standing.number;
            let mut asked = events.iter().find(asked).unwrap().clone();
            asked["number"] = number.into();
            clean.push(asked.to_string());
            let reply = memrep::session::ReplyText::of(&standing.reply, self.session.universe());
            let mut answered = serde_json::to_value(reply).unwrap();
            answered["event"] = "answered".into();
            answered["number"] = number.into();
            clean.push(answered.to_string());
        }
        let mut clean = read(&clean);
        let thought = serde_json::to_value(clean.think().unwrap()).unwrap();
        let last: Value = serde_json::from_str(self.log.last().unwrap()).unwrap();
        let content = |mut event: Value| {
            let fields = event.as_object_mut().unwrap();
            fields.remove("number");
            if fields["event"] == "conflict" {
                let answers = fields.remove("answers").unwrap();
                fields.insert(
                    "answers".to_owned(),
                    answers.as_array().unwrap().len().into(),
                );
            }
            event.to_string()
        };
        let (last, thought) = (content(last), content(thought));
        assert_eq!(last, thought);
        self.saw("traceless");
    }

    /// The first entry, with the bound as it is now.
    fn created(&self) -> String {
        let mut created: Value = serde_json::from_str(&self.log[0]).unwrap();
        created["task"]["max_states"] = self.session.task().max_states.into();
        created.to_string()
    }
}
