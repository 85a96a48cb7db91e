//! The log is enough: random sessions of every kind are rebuilt from their logs, as
//! after a restart, and ask next what they had asked, byte for byte; and an answer
//! that was taken back leaves no trace in what is asked.
//!
//! `MEMREP_SESSIONS=1000` runs so many of them; `MEMREP_SESSION=17` that one alone.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use memrep::evidence::Comparison;
use memrep::learner::{Question, Reply, Strategy};
use memrep::session::{
    Atom, Concept, Decision, Event, Pooling, Position, Refusal, Session, Setup, Task, Terms,
    Universe, ready,
};
use rand::seq::IndexedRandom;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;
use serde_json::{Value, json};

/// How many run where nothing else is said.
const SESSIONS: u64 = 100;

/// What happened in a session, so that the test knows what it has seen.
type Seen = BTreeMap<&'static str, usize>;

/// A session that somebody restless lives through.
struct Life {
    session: Session,
    /// As it is kept: text.
    log: Vec<String>,
    random: ChaCha8Rng,
    seen: Seen,
}

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

fn some_task(random: &mut ChaCha8Rng) -> Task {
    const READY: [&str; 14] = [
        "tomita:1",
        "tomita:2",
        "tomita:3",
        "tomita:4",
        "tomita:5",
        "tomita:6",
        "tomita:7",
        "modulo:3",
        "zeros:2",
        "robot",
        "car",
        "repairs",
        "four-buttons",
        "robot-recharge",
    ];
    let of = |content: Value| {
        Task::from_json(&content).unwrap_or_else(|error| panic!("{content}: {error}"))
    };
    match random.random_range(0..10) {
        0..5 => ready(READY.choose(random).unwrap()).unwrap(),
        5..8 => {
            let symbols: Vec<&str> = ["a", "b", "c"][..random.random_range(1..=3)].to_vec();
            let mut task = json!({
                "symbols": symbols,
                "max_states": random.random_range(2..6),
                "examples": [{"word": [], "label": random.random::<bool>()}],
            });
            if symbols.len() > 1 && random.random_range(0..3) == 0 {
                task["prior"] = json!({"holds": ["avoid b"]});
                task["examples"] = json!([]);
            }
            if random.random_range(0..3) == 0 {
                task["world"] = json!({"kind": "words", "longest": random.random_range(3..9)});
            }
            of(task)
        }
        8 => {
            let rows = random.random_range(2..6_u32);
            let columns = random.random_range(3..7_u32);
            let mut table = String::from("is");
            for column in 0..columns {
                let _ = write!(table, ",c{column}");
            }
            for row in 0..rows {
                let _ = write!(table, "\nr{row}");
                // No two columns are alike: their numbers in binary, and noise below.
                for column in 0..columns {
                    let bit = if row < 3 {
                        column >> row & 1 == 1
                    } else {
                        random.random()
                    };
                    table += if bit { ",1" } else { ",0" };
                }
            }
            match Task::from_json(&json!({"class": {"kind": "finite", "table": table}})) {
                Ok(task) => task,
                // Two rows do not tell so many columns apart.
                Err(_) => ready("tomita:1").unwrap(),
            }
        }
        _ => of(
            json!({"class": {"kind": "monotone", "ticks": random.random_range(3..12), "axes": [
                {"name": "wait", "unit": "s", "best": 0, "worst": 10},
                {"name": "gap", "unit": "m", "best": 2, "worst": 0.5},
            ]}}),
        ),
    }
}

fn some_setup(random: &mut ChaCha8Rng) -> Setup {
    let strategies = [
        Strategy::Bayes,
        Strategy::Exp4Plus,
        Strategy::Thesis,
        Strategy::Membership,
    ];
    Setup {
        strategy: *strategies.choose(random).unwrap(),
        membership_cost: *[1.0, 4.0, 0.25].choose(random).unwrap(),
        comparison_cost: *[1.0, 1.0, 3.5, f64::INFINITY].choose(random).unwrap(),
        seed: random.random_range(0..1000),
        // Where little may be done, what was done before must not show.
        budget: *[300, 300, 3000, 3000, 20_000, 20_000, 200_000]
            .choose(random)
            .unwrap(),
    }
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
    fn begin(seed: u64) -> Self {
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

    fn saw(&mut self, what: &'static str) {
        *self.seen.entry(what).or_default() += 1;
    }

    fn append(&mut self, event: &Event) {
        self.session.apply(event).unwrap();
        self.log.push(serde_json::to_string(event).unwrap());
    }

    fn think(&mut self) {
        while let Some(event) = self.session.think() {
            if matches!(event, Event::Conflict { .. }) {
                self.saw("conflict");
            }
            self.append(&event);
        }
    }

    fn act(&mut self, what: &'static str, decided: Result<Decision, Refusal>) {
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

    fn reply(&mut self, question: &Question<Atom, Concept>) -> Option<Reply<Atom>> {
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
    fn atoms(&self) -> Vec<Atom> {
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
    fn some_standing(&mut self) -> Option<u32> {
        let numbers: Vec<u32> = self.session.standing().iter().map(|s| s.number).collect();
        numbers.choose(&mut self.random).copied()
    }

    /// One thing that happens to a session of one person.
    fn turn(&mut self) {
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
    fn shared_turn(&mut self) {
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
    fn speak(&mut self, person: u32) {
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

    /// A question beside others is the same from the log alone.
    fn check_further(&self, event: &Event) {
        let again = read(&self.log).further();
        assert_eq!(again.as_ref(), Some(event));
    }

    /// From the log alone, as after a restart: it stands where this one does; and
    /// where the last entry is the learner's and was lost, the same comes of the rest.
    fn check_rebuilt(&mut self) {
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
    fn check_traceless(&mut self) {
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

/// Lives through a session, and checks at random places what must hold.
fn live(seed: u64) -> Seen {
    let mut life = Life::begin(seed);
    let shared = seed % 4 == 3;
    if shared {
        for name in ["Ada", "Bo"] {
            let decided = life.session.invite(name, None);
            life.act("invited", decided);
        }
    }
    // Of several people each has a part of the turns.
    let most = if shared { 60 } else { 24 };
    for turn in 0..life.random.random_range(6..most) {
        if shared {
            life.shared_turn();
        } else {
            life.turn();
        }
        if turn % 3 == 0 {
            life.check_rebuilt();
            life.check_traceless();
        }
    }
    life.check_rebuilt();
    life.check_traceless();
    life.seen
}

fn told(variable: &str) -> Option<u64> {
    let told = std::env::var(variable).ok()?;
    Some(
        told.parse()
            .unwrap_or_else(|_| panic!("{variable} is a number")),
    )
}

#[test]
fn sessions_are_rebuilt_from_their_logs_and_forget_what_was_taken_back() {
    let seeds = match told("MEMREP_SESSION") {
        Some(seed) => seed..seed + 1,
        None => 0..told("MEMREP_SESSIONS").unwrap_or(SESSIONS),
    };
    let alone = seeds.end - seeds.start == 1;
    let seen: Seen = seeds
        .into_par_iter()
        .map(|seed| {
            let lived = std::panic::catch_unwind(|| live(seed));
            lived.unwrap_or_else(|_| panic!("once more with MEMREP_SESSION={seed}"))
        })
        .reduce(Seen::new, |mut all, one| {
            for (what, times) in one {
                *all.entry(what).or_default() += times;
            }
            all
        });
    eprintln!("{seen:?}");
    if alone {
        return;
    }
    for what in [
        "answered",
        "retracted",
        "changed",
        "undone",
        "skipped",
        "enlarged",
        "conflict",
        "said",
        "unsaid",
        "terms",
        "further",
        "repeated",
        "rebuilt",
        "traceless",
    ] {
        assert!(
            seen.get(what).is_some_and(|times| *times > 0),
            "{what}: {seen:?}"
        );
    }
}
