//! Sessions that several people answer: folds over their logs, with questions that
//! nobody is asked in vain, and answers pooled as the owner chose.

use std::collections::BTreeMap;

use memrep::learner::{Question, Reply};
use memrep::oracle::{Order, ScriptedTeacher, Target, Teacher, TeacherSettings};
use memrep::session::{
    Atom, Concept, Decision, Event, Opinion, Pooling, Position, Refusal, Session, Setup, Terms,
    ready,
};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// A session with its log.
struct Kept {
    session: Session,
    log: Vec<Event>,
}

impl Kept {
    fn begin(task: &str, seed: u64) -> Self {
        let setup = Setup {
            seed,
            ..Setup::default()
        };
        let log = vec![Session::created(ready(task).unwrap(), setup)];
        let session = Session::replay(&log).unwrap();
        let mut kept = Self { session, log };
        kept.think();
        kept
    }

    fn think(&mut self) {
        while let Some(event) = self.session.think() {
            self.append(event);
        }
    }

    fn append(&mut self, event: Event) {
        self.session.apply(&event).unwrap();
        let text = serde_json::to_string(&event).unwrap();
        assert_eq!(serde_json::from_str::<Event>(&text).unwrap(), event);
        self.log.push(event);
    }

    fn act(&mut self, decision: Result<Decision, Refusal>) -> bool {
        match decision.unwrap() {
            Decision::Append(event) => {
                self.append(event);
                self.think();
                true
            }
            Decision::Already(_) => false,
        }
    }

    fn invite(&mut self, people: u32) {
        for person in 0..people {
            let invited = self.session.invite(&format!("Person {person}"), None);
            self.act(invited);
        }
    }

    fn asked(&self, number: u32) -> Question<Atom, Concept> {
        self.session.asked(number).unwrap().question.clone()
    }

    /// A question that this person has not answered, put for them if need be.
    fn question_for(&mut self, person: u32) -> Option<u32> {
        let wanted = |session: &Session| {
            let mut open = session.open_to(person);
            open.find(|number| session.wanted(*number) > 0)
        };
        wanted(&self.session).or_else(|| {
            let event = self.session.further()?;
            self.append(event);
            wanted(&self.session)
        })
    }

    /// The log gives this session once more.
    fn check_log(&self) {
        let replayed = Session::replay(&self.log).unwrap();
        assert_eq!(replayed.position(), self.session.position());
        assert_eq!(replayed.counts(), self.session.counts());
        assert_eq!(
            replayed.open().collect::<Vec<_>>(),
            self.session.open().collect::<Vec<_>>()
        );
        let standing = |session: &Session| -> Vec<(u32, Reply<Atom>)> {
            let standing = session.standing().iter();
            standing.map(|s| (s.number, s.reply.clone())).collect()
        };
        assert_eq!(standing(&replayed), standing(&self.session));
        for number in self.session.panel().questions() {
            let (one, other) = (replayed.panel(), self.session.panel());
            assert_eq!(one.opinions(number), other.opinions(number));
        }
    }

    /// What is open is asked once, and not answered by what stands.
    fn check_open(&self) {
        let open: Vec<_> = self
            .session
            .open()
            .map(|number| self.asked(number))
            .collect();
        let same =
            |one: &Question<Atom, Concept>, other: &Question<Atom, Concept>| match (one, other) {
                (Question::Membership { atom: one }, Question::Membership { atom: other }) => {
                    one == other
                }
                (
                    Question::Comparison { first, second },
                    Question::Comparison {
                        first: third,
                        second: fourth,
                    },
                ) => (first, second) == (third, fourth) || (first, second) == (fourth, third),
                _ => false,
            };
        for (place, one) in open.iter().enumerate() {
            assert!(
                !open[..place].iter().any(|other| same(one, other)),
                "{one:?} is open twice"
            );
            for standing in self.session.standing() {
                let other = self.asked(standing.number);
                let told = standing.reply != Reply::Skip;
                assert!(!(told && same(one, &other)), "{one:?} is answered");
            }
        }
        let equivalence = |q: &&Question<_, _>| matches!(q, Question::Equivalence { .. });
        if open.iter().filter(equivalence).count() > 0 {
            assert_eq!(open.len(), 1, "a rule is judged when nothing else is open");
        }
    }
}

fn word(atom: &Atom) -> &automata::Word {
    match atom {
        Atom::Word(word) => word,
        other => panic!("{other:?}"),
    }
}

fn truth(teacher: &mut ScriptedTeacher, question: &Question<Atom, Concept>) -> Reply<Atom> {
    match question {
        Question::Membership { atom } if teacher.membership(word(atom)) => Reply::Accept,
        Question::Membership { .. } => Reply::Reject,
        Question::Comparison { first, second } => {
            Reply::Compared(teacher.comparison(word(first), word(second)))
        }
        Question::Equivalence { hypothesis } => {
            let Concept::Automaton(dfa) = hypothesis else {
                panic!("{hypothesis:?}")
            };
            match teacher.counterexample(dfa) {
                Some((atom, label)) => Reply::Counterexample {
                    atom: Atom::Word(atom),
                    label,
                },
                None => Reply::Correct,
            }
        }
    }
}

fn teacher(task: &str) -> ScriptedTeacher {
    let settings = TeacherSettings {
        order: Order::Ordered,
        ..TeacherSettings::default()
    };
    ScriptedTeacher::new(&Target::named(task).unwrap(), settings)
}

fn terms(answers: u32, pooling: Pooling) -> Terms {
    Terms {
        answers,
        pooling,
        shows_rule: false,
    }
}

#[test]
fn honest_people_teach_the_target() {
    for (people, answers) in [(1, 1), (2, 1), (3, 2), (3, 3), (5, 1)] {
        let mut kept = Kept::begin("tomita:4", 7);
        kept.invite(people);
        let set = kept.session.set_terms(terms(answers, Pooling::Majority));
        kept.act(set);
        let mut teacher = teacher("tomita:4");
        for turn in 0..2000 {
            if let Position::Done(Concept::Automaton(dfa)) = kept.session.position() {
                let target = Target::named("tomita:4").unwrap();
                assert_eq!(dfa.is_equivalent(target.dfa()), Ok(true));
                break;
            }
            assert!(turn < 1999, "{people} people never end");
            let person = turn % people + 1;
            if let Some(number) = kept.question_for(person) {
                let reply = truth(&mut teacher, &kept.asked(number));
                let said = kept.session.say(person, number, &reply, None);
                kept.act(said);
            } else if let Position::Asking(number) = *kept.session.position()
                && let question @ Question::Equivalence { .. } = kept.asked(number)
            {
                let reply = truth(&mut teacher, &question);
                let judged = kept.session.answer(number, &reply);
                kept.act(judged);
            }
            kept.check_open();
        }
        kept.check_log();
    }
}

/// By the words of the documentation: as many as are wanted have said something
/// other than to skip, and one answer has more weight than every other.
fn pooled_by_hand(session: &Session, number: u32) -> Option<Reply<Atom>> {
    let panel = session.panel();
    let told: Vec<&Opinion> = panel
        .opinions(number)
        .iter()
        .filter(|opinion| opinion.reply != Reply::Skip)
        .collect();
    if told.len() < panel.terms().answers as usize {
        return None;
    }
    let mut counts: Vec<(Reply<Atom>, usize)> = Vec::new();
    for opinion in told {
        match counts.iter_mut().find(|(reply, _)| *reply == opinion.reply) {
            Some((_, count)) => *count += 1,
            None => counts.push((opinion.reply.clone(), 1)),
        }
    }
    let most = counts.iter().map(|(_, count)| *count).max()?;
    let mut best = counts.into_iter().filter(|(_, count)| *count == most);
    let first = best.next()?;
    best.next().is_none().then_some(first.0)
}

fn some_reply(question: &Question<Atom, Concept>, random: &mut ChaCha8Rng) -> Reply<Atom> {
    use memrep::evidence::Comparison::{Equal, First, Incomparable, Second};
    let replies = match question {
        Question::Membership { .. } => vec![Reply::Accept, Reply::Reject, Reply::Skip],
        _ => vec![
            Reply::Compared(First),
            Reply::Compared(Second),
            Reply::Compared(Equal),
            Reply::Compared(Incomparable),
            Reply::Skip,
        ],
    };
    replies[random.random_range(0..replies.len())].clone()
}

/// People who say anything, take it back, and an owner who changes the terms and
/// meddles: whatever happens, the log is the session, and nothing is asked in vain.
#[test]
fn whims_leave_the_session_its_log() {
    let (mut pooled, mut unsaid, mut conflicts, mut repeats) = (0, 0, 0, 0);
    for seed in 0..10 {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let mut kept = Kept::begin(["tomita:4", "tomita:7", "robot"][seed as usize % 3], seed);
        let people = random.random_range(1..5);
        kept.invite(people);
        let mut teachers = teacher(["tomita:4", "tomita:7", "robot"][seed as usize % 3]);
        for _ in 0..60 {
            let person = random.random_range(1..=people);
            match random.random_range(0..12) {
                0 => {
                    let pooling = if random.random() {
                        Pooling::Majority
                    } else {
                        Pooling::Reliability
                    };
                    let set = kept
                        .session
                        .set_terms(terms(random.random_range(1..4), pooling));
                    kept.act(set);
                }
                1 => {
                    let answered = kept.session.panel().answered_by(person).to_vec();
                    if let Some(number) = answered.last() {
                        let taken = kept.session.unsay(person, *number);
                        kept.act(taken);
                        assert!(kept.session.panel().said(person, *number).is_none());
                        unsaid += 1;
                    }
                }
                2 => {
                    let standing = kept.session.standing();
                    let place = random.random_range(0..standing.len().max(1));
                    if let Some(number) = standing.get(place).map(|s| s.number) {
                        let question = kept.asked(number);
                        if !matches!(question, Question::Equivalence { .. }) {
                            let reply = some_reply(&question, &mut random);
                            let changed = kept.session.change(number, &reply);
                            kept.act(changed);
                        }
                    }
                }
                _ => {
                    if let Some(due) = kept.session.panel().due(person) {
                        let last = kept.session.panel().answered_by(person).last();
                        assert_ne!(last, Some(&due), "not what was just answered");
                        let counts = kept.session.counts();
                        let reply = some_reply(&kept.asked(due), &mut random);
                        let again = kept.session.repeat(person, due, &reply);
                        kept.act(again);
                        assert_eq!(counts, kept.session.counts(), "it tells of the person");
                        // Sent once more, by a hand that saw no reply.
                        let twice = kept.session.say(person, due, &reply, None);
                        assert!(matches!(twice, Ok(Decision::Already(_))), "{twice:?}");
                        repeats += 1;
                    } else if let Some(number) = kept.question_for(person) {
                        let question = kept.asked(number);
                        let reply = if random.random_range(0..4) > 0 {
                            truth(&mut teachers, &question)
                        } else {
                            some_reply(&question, &mut random)
                        };
                        let said = kept.session.say(person, number, &reply, Some(900));
                        kept.act(said);
                        let standing = kept.session.answer_to(number).map(|s| s.reply.clone());
                        if kept.session.panel().terms().pooling == Pooling::Majority {
                            assert_eq!(standing, pooled_by_hand(&kept.session, number));
                        }
                        pooled += usize::from(standing.is_some());
                    }
                }
            }
            if let Position::Conflict(conflict) = kept.session.position().clone() {
                conflicts += 1;
                let Some(worst) = conflict.answers.first() else {
                    break;
                };
                let taken = kept.session.retract(*worst);
                kept.act(taken);
            }
            kept.check_open();
        }
        kept.check_log();
    }
    assert!(
        pooled > 100 && unsaid > 20 && conflicts > 0 && repeats > 10,
        "{pooled} {unsaid} {conflicts} {repeats}"
    );
}

/// A fork that is taken somewhere leaves the session where it was, and comes to what
/// the session itself would have come to.
#[test]
fn forks_foresee() {
    let mut tried = 0;
    for (task, seed) in [
        ("tomita:5", 1),
        ("robot-recharge", 2),
        ("car", 3),
        ("repairs", 4),
    ] {
        let mut kept = Kept::begin(task, seed);
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        for _ in 0..10 {
            let before = kept.log.len() as u64;
            let mut foreseen: BTreeMap<String, Vec<Event>> = BTreeMap::new();
            for cause in kept.session.foreseen() {
                let mut fork = kept.session.fork();
                fork.apply(&cause).unwrap();
                let mut effects = Vec::new();
                while let Some(event) = fork.think() {
                    fork.apply(&event).unwrap();
                    effects.push(event);
                }
                foreseen.insert(serde_json::to_string(&cause).unwrap(), effects);
                tried += 1;
            }
            assert_eq!(kept.session.entries(), before);
            let causes: Vec<String> = foreseen.keys().cloned().collect();
            let Some(text) = causes.get(random.random_range(0..causes.len().max(1))) else {
                break;
            };
            let cause: Event = serde_json::from_str(text).unwrap();
            let at = kept.log.len();
            kept.append(cause);
            // From the log alone, as after a restart.
            kept.session = Session::replay(&kept.log).unwrap();
            kept.think();
            assert_eq!(kept.log[at + 1..], foreseen[text][..], "{task}: {text}");
            if matches!(kept.session.position(), Position::Done(_)) {
                break;
            }
        }
    }
    assert!(tried > 60, "{tried}");
}
