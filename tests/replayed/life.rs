//! What somebody restless does in a session.

use std::collections::BTreeMap;

use memrep::evidence::Comparison;
use memrep::learner::{Question, Reply};
use memrep::session::{
    Atom, Concept, Decision, Event, Pooling, Position, Refusal, Session, Terms, Universe,
};
use rand::seq::IndexedRandom;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use crate::drawn::{some_setup, some_task};

/// What happened in a session, so that the test knows what it has seen.
pub(crate) type Seen = BTreeMap<&'static str, usize>;

/// A session that somebody restless lives through.
pub(crate) struct Life {
    pub(crate) session: Session,
    /// As it is kept: text.
    pub(crate) log: Vec<String>,
    pub(crate) random: ChaCha8Rng,
    pub(crate) seen: Seen,
}

/// What somebody who does not err says.
fn is_good(universe: &Universe, atom: &Atom) -> bool {
    match atom {
        Atom::Word(word) => {
            let sum: usize = word.iter().map(|symbol| symbol.index() + 1).sum();
            sum % 3 != 1
        }
        Atom::Item(place) => place % 2 == 0,
        Atom::Point(_) => universe.text(atom).bare()[0].as_f64().unwrap() < 30.0,
    }
}

impl Life {
    pub(crate) fn begin(seed: u64) -> Self {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let task = some_task(&mut random);
        let setup = some_setup(&mut random);
        let created = Session::created(task, setup);
        let mut life = Self {
            session: Session::replay(std::slice::from_ref(&created)).unwrap(),
            log: vec![serde_json::to_string(&created).unwrap()],
            random,
            seen: Seen::new(),
        };
        life.think();
        life
    }

    pub(crate) fn saw(&mut self, what: &'static str) {
        *self.seen.entry(what).or_default() += 1;
    }

    pub(crate) fn append(&mut self, event: &Event) {
        self.session.apply(event).unwrap();
        self.log.push(serde_json::to_string(event).unwrap());
    }

    pub(crate) fn think(&mut self) {
        while let Some(event) = self.session.think() {
            if matches!(event, Event::Conflict { .. }) {
                self.saw("conflict");
            }
            self.append(&event);
        }
    }

    pub(crate) fn act(&mut self, what: &'static str, decided: Result<Decision, Refusal>) {
        match decided {
            Ok(Decision::Append(event)) => {
                self.append(&event);
                self.saw(what);
                self.think();
            }
            Ok(Decision::Already(_)) => self.saw("already"),
            Err(_) => self.saw("refused"),
        }
    }

    pub(crate) fn reply(&mut self, question: &Question<Atom, Concept>) -> Option<Reply<Atom>> {
        use Comparison::{Equal, First, Incomparable, Second};
        let honest = self.random.random_range(0..4) > 0;
        let universe = self.session.universe();
        Some(match question {
            Question::Membership { atom } => {
                let good = if honest {
                    is_good(universe, atom)
                } else {
                    self.random.random()
                };
                if good { Reply::Accept } else { Reply::Reject }
            }
            Question::Comparison { first, second } => {
                let good = |atom| is_good(universe, atom);
                Reply::Compared(match (good(first), good(second)) {
                    _ if !honest => *[First, Second, Equal, Incomparable]
                        .choose(&mut self.random)
                        .unwrap(),
                    (true, false) => First,
                    (false, true) => Second,
                    _ => Equal,
                })
            }
            Question::Equivalence { hypothesis } => {
                let wrong = self.atoms().into_iter().find(|atom| {
                    let says = self.session.universe().accepts(hypothesis, atom);
                    says != is_good(self.session.universe(), atom)
                });
                match wrong {
                    Some(atom) if honest => {
                        let label = is_good(self.session.universe(), &atom);
                        Reply::Counterexample { atom, label }
                    }
                    _ if honest || self.random.random() => Reply::Correct,
                    _ => {
                        let atom = self.atoms().choose(&mut self.random).cloned()?;
                        let label = !self.session.universe().accepts(hypothesis, &atom);
                        Reply::Counterexample { atom, label }
                    }
                }
            }
        })
    }

    /// Some behaviours of the task.
    pub(crate) fn atoms(&self) -> Vec<Atom> {
        match self.session.universe() {
            Universe::Words { alphabet, .. } => {
                let mut words = vec![automata::Word::empty()];
                for length in 0..3 {
                    let longer: Vec<_> = words
                        .iter()
                        .filter(|word| word.len() == length)
                        .flat_map(|word| alphabet.symbols().map(|symbol| word.with(symbol)))
                        .collect();
                    words.extend(longer);
                }
                words.into_iter().map(Atom::Word).collect()
            }
            universe if universe.items().is_empty() => {
                let asked = (1..200).filter_map(|number| self.session.asked(number));
                let atoms = asked.filter_map(|asked| match &asked.question {
                    Question::Membership { atom } => Some(atom.clone()),
                    Question::Comparison { first, .. } => Some(first.clone()),
                    Question::Equivalence { .. } => None,
                });
                atoms.collect()
            }
            universe => (0..universe.items().len() as u32).map(Atom::Item).collect(),
        }
    }

    /// A standing answer's number.
    pub(crate) fn some_standing(&mut self) -> Option<u32> {
        let numbers: Vec<u32> = self.session.standing().iter().map(|s| s.number).collect();
        numbers.choose(&mut self.random).copied()
    }

    /// One thing that happens to a session of one person.
    pub(crate) fn turn(&mut self) {
        match (
            self.random.random_range(0..12),
            self.session.position().clone(),
        ) {
            (0, _) => {
                if let Some(number) = self.some_standing() {
                    let decided = self.session.retract(number);
                    self.act("retracted", decided);
                }
            }
            (1, _) => {
                if let Some(number) = self.some_standing() {
                    let question = self.session.asked(number).unwrap().question.clone();
                    if let Some(reply) = self.reply(&question) {
                        let decided = self.session.change(number, &reply);
                        self.act("changed", decided);
                    }
                }
            }
            (2, _) => {
                let decided = self.session.undo();
                self.act("undone", decided);
            }
            (3, Position::Asking(number)) => {
                let decided = self.session.answer(number, &Reply::Skip);
                self.act("skipped", decided);
            }
            (4, _) | (_, Position::Conflict(_) | Position::Done(_)) => {
                if self.random.random() {
                    let bound = self.session.task().max_states + 1;
                    let decided = self.session.enlarge(bound);
                    self.act("enlarged", decided);
                    return;
                }
                let blamed = match self.session.position() {
                    Position::Conflict(conflict) => conflict.answers.first().copied(),
                    _ => None,
                };
                if let Some(number) = blamed.or_else(|| self.some_standing()) {
                    let decided = self.session.retract(number);
                    self.act("retracted", decided);
                }
            }
            (_, Position::Asking(number)) => {
                let question = self.session.asked(number).unwrap().question.clone();
                if let Some(reply) = self.reply(&question) {
                    let decided = self.session.answer(number, &reply);
                    self.act("answered", decided);
                }
            }
            (_, Position::Thinking) => panic!("it has thought"),
        }
    }

    /// One thing that happens to a session of several people.
    pub(crate) fn shared_turn(&mut self) {
        let people = self.session.panel().people().len() as u32;
        let person = self.random.random_range(1..=people);
        match self.random.random_range(0..12) {
            0 => {
                let last = self.session.panel().answered_by(person).last().copied();
                if let Some(number) = last {
                    let decided = self.session.unsay(person, number);
                    self.act("unsaid", decided);
                }
            }
            1 => {
                let terms = Terms {
                    answers: self.random.random_range(1..3),
                    pooling: *[Pooling::Majority, Pooling::Reliability]
                        .choose(&mut self.random)
                        .unwrap(),
                    shows_rule: false,
                };
                let decided = self.session.set_terms(terms);
                self.act("terms", decided);
            }
            2 if people < 4 => {
                let decided = self.session.invite("One more", None);
                self.act("invited", decided);
            }
            3 if self.random.random_range(0..4) == 0 => {
                let decided = self.session.dismiss(person);
                self.act("dismissed", decided);
            }
            4 => self.turn(),
            _ => self.speak(person),
        }
        if let Position::Conflict(conflict) = self.session.position().clone()
            && let Some(number) = conflict.answers.first()
        {
            let decided = self.session.retract(*number);
            self.act("retracted", decided);
        }
    }

    /// What one of several people says.
    pub(crate) fn speak(&mut self, person: u32) {
        if let Some(due) = self.session.panel().due(person) {
            let question = self.session.asked(due).unwrap().question.clone();
            if let Some(reply) = self.reply(&question) {
                let decided = self.session.repeat(person, due, &reply);
                self.act("repeated", decided);
            }
            return;
        }
        let open = |session: &Session| session.open_to(person).next();
        if open(&self.session).is_none() {
            if let Some(event) = self.session.further() {
                self.check_further(&event);
                self.append(&event);
                self.saw("further");
            } else if let Position::Asking(number) = *self.session.position() {
                let question = self.session.asked(number).unwrap().question.clone();
                if let Some(reply) = self.reply(&question) {
                    let decided = self.session.answer(number, &reply);
                    self.act("answered", decided);
                }
            }
        }
        if let Some(number) = open(&self.session) {
            let question = self.session.asked(number).unwrap().question.clone();
            if let Some(reply) = self.reply(&question) {
                let decided = self.session.say(person, number, &reply, Some(700));
                self.act("said", decided);
            }
        }
    }
}
