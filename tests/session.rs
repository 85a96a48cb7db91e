//! A session is a fold over its log: replaying, withdrawing and mending give
//! what they should, whatever happened before.

use automata::Word;
use memrep::learner::{Question, Reply};
use memrep::oracle::{ScriptedTeacher, Target, Teacher, TeacherSettings};
use memrep::session::{
    Atom, Concept, Decision, Event, Position, Refusal, Session, Setup, Task, ready,
};
use proptest::prelude::*;
use serde_json::json;

/// A session with its log, as the server keeps them together.
struct Kept {
    session: Session,
    log: Vec<Event>,
}

impl Kept {
    fn begin(task: Task, setup: Setup) -> Self {
        let log = vec![Session::created(task, setup)];
        let session = Session::replay(&log).unwrap();
        let mut kept = Self { session, log };
        kept.think();
        kept
    }

    fn think(&mut self) {
        while let Some(event) = self.session.think() {
            self.append(&event);
        }
    }

    fn append(&mut self, event: &Event) {
        self.session.apply(event).unwrap();
        // What is kept is the text.
        let text = serde_json::to_string(event).unwrap();
        self.log.push(serde_json::from_str(&text).unwrap());
        assert_eq!(self.log.last(), Some(event), "{text}");
    }

    fn act(
        &mut self,
        decide: impl Fn(&Session) -> Result<Decision, Refusal>,
    ) -> Result<(), Refusal> {
        if let Decision::Append(event) = decide(&self.session)? {
            self.append(&event);
            self.think();
        }
        Ok(())
    }

    fn open(&self) -> Option<(u32, Question<Atom, Concept>)> {
        match self.session.position() {
            Position::Asking(number) => {
                let asked = self.session.asked(*number).unwrap();
                Some((*number, asked.question.clone()))
            }
            _ => None,
        }
    }

    fn replayed(&self) -> Session {
        Session::replay(&self.log).unwrap()
    }
}

/// What is open, whatever its number is.
fn shown(session: &Session) -> Option<Question<Atom, Concept>> {
    match session.position() {
        Position::Asking(number) => Some(session.asked(*number).unwrap().question.clone()),
        _ => None,
    }
}

fn word(atom: &Atom) -> &Word {
    match atom {
        Atom::Word(word) => word,
        other => panic!("{other:?} is no word"),
    }
}

fn accepts(concept: &Concept, atom: &Atom) -> bool {
    concept.automaton().unwrap().accepts(word(atom))
}

fn truthfully(teacher: &mut ScriptedTeacher, question: &Question<Atom, Concept>) -> Reply<Atom> {
    match question {
        Question::Membership { atom } => {
            if teacher.membership(word(atom)) {
                Reply::Accept
            } else {
                Reply::Reject
            }
        }
        Question::Comparison { first, second } => {
            Reply::Compared(teacher.comparison(word(first), word(second)))
        }
        Question::Equivalence { hypothesis } => {
            match teacher.counterexample(hypothesis.automaton().unwrap()) {
                Some((atom, label)) => Reply::Counterexample {
                    atom: Atom::Word(atom),
                    label,
                },
                None => Reply::Correct,
            }
        }
    }
}

fn teacher_of(name: &str) -> ScriptedTeacher {
    ScriptedTeacher::new(&Target::named(name).unwrap(), TeacherSettings::default())
}

#[test]
fn ready_tasks_are_over_the_alphabets_of_their_targets() {
    for name in ["robot", "tomita:1", "tomita:7", "modulo:4", "zeros:2"] {
        let task = ready(name).unwrap();
        let target = Target::named(name).unwrap();
        assert_eq!(task.alphabet().unwrap(), *target.dfa().alphabet(), "{name}");
        assert_eq!(
            task.known::<Word>(&task.universe().unwrap()),
            target.known(),
            "{name}"
        );
        assert!(target.dfa().size() <= task.max_states, "{name}");
    }
}

#[test]
fn a_truthful_teacher_is_understood() {
    for name in ["tomita:2", "tomita:5", "modulo:4", "zeros:1", "robot"] {
        let mut teacher = teacher_of(name);
        let mut kept = Kept::begin(ready(name).unwrap(), Setup::default());
        while let Some((number, question)) = kept.open() {
            assert!(number < 200, "{name}: too many questions");
            let reply = truthfully(&mut teacher, &question);
            kept.act(|session| session.answer(number, &reply)).unwrap();
        }
        let Position::Done(learned) = kept.session.position() else {
            panic!("{name}: {:?}", kept.session.position());
        };
        let target = Target::named(name).unwrap();
        let learned = learned.automaton().unwrap();
        assert!(learned.is_equivalent(target.dfa()).unwrap(), "{name}");
    }
}

#[test]
fn a_done_session_goes_on_when_the_agreement_is_taken_back() {
    let mut teacher = teacher_of("tomita:1");
    let mut kept = Kept::begin(ready("tomita:1").unwrap(), Setup::default());
    while let Some((number, question)) = kept.open() {
        let reply = truthfully(&mut teacher, &question);
        kept.act(|session| session.answer(number, &reply)).unwrap();
    }
    let hypothesis = kept.session.hypothesis().unwrap().clone();
    kept.act(Session::undo).unwrap();
    assert_eq!(
        shown(&kept.session),
        Some(Question::Equivalence { hypothesis })
    );
}

#[test]
fn contradictory_answers_are_shown_and_mending_one_goes_on() {
    let task =
        Task::from_json(&json!({"symbols": ["a"], "examples": [{"word": [], "label": true}]}))
            .unwrap();
    let mut kept = Kept::begin(task, Setup::default());
    // Whatever is asked: a lie until there is a contradiction.
    let mut seen = 0;
    while let Some((number, question)) = kept.open() {
        assert!(number < 100, "no contradiction came");
        let reply = match &question {
            Question::Membership { .. } => Reply::Accept,
            Question::Comparison { .. } => Reply::Compared(memrep::evidence::Comparison::First),
            Question::Equivalence { hypothesis } => {
                // Twice the same word, once with either label.
                let atom = Atom::Word(Word::empty());
                let label = !accepts(hypothesis, &atom);
                seen += 1;
                Reply::Counterexample { atom, label }
            }
        };
        kept.act(|session| session.answer(number, &reply)).unwrap();
    }
    assert!(seen > 0);
    let Position::Conflict(conflict) = kept.session.position().clone() else {
        panic!("{:?}", kept.session.position());
    };
    assert!(!conflict.answers.is_empty());
    let liar = *conflict.answers.last().unwrap();
    let refused = kept.session.answer(liar + 1, &Reply::Accept).unwrap_err();
    assert!(
        refused.to_string().contains("cannot all be true"),
        "{refused}"
    );
    kept.act(|session| session.retract(liar)).unwrap();
    assert!(kept.open().is_some(), "{:?}", kept.session.position());
}

#[test]
fn too_small_a_bound_is_a_conflict_that_a_larger_one_resolves() {
    let mut task = ready("modulo:5").unwrap();
    task.max_states = 3;
    let mut teacher = teacher_of("modulo:5");
    let mut kept = Kept::begin(task, Setup::default());
    let mut enlarged = false;
    loop {
        match kept.session.position().clone() {
            Position::Asking(number) => {
                let question = kept.session.asked(number).unwrap().question.clone();
                let reply = truthfully(&mut teacher, &question);
                kept.act(|session| session.answer(number, &reply)).unwrap();
            }
            Position::Conflict(conflict) => {
                assert_eq!(conflict.bound, Some(3));
                assert!(!enlarged);
                assert_eq!(kept.session.enlarge(2), Err(Refusal::BadBound { now: 3 }));
                kept.act(|session| session.enlarge(6)).unwrap();
                enlarged = true;
            }
            Position::Done(learned) => {
                assert!(enlarged);
                assert_eq!(learned.automaton().unwrap().size(), 5);
                break;
            }
            Position::Thinking => panic!("it has thought"),
        }
    }
    assert_eq!(kept.replayed().position(), kept.session.position());
}

#[test]
fn refusals_say_what_to_do() {
    let mut kept = Kept::begin(ready("robot").unwrap(), Setup::default());
    let session = &kept.session;
    let (open, question) = kept.open().unwrap();
    let wrong = Reply::Correct;
    for (result, expected) in [
        (
            session.answer(99, &Reply::Accept),
            "there is no question 99: question 1 is open now",
        ),
        (
            session.retract(99),
            "there is no question 99: question 1 is open now",
        ),
        (session.retract(1), "question 1 has no standing answer yet"),
        (session.undo(), "there is no answer to take back yet"),
        (
            session.change(1, &Reply::Accept),
            "question 1 has no standing answer yet",
        ),
        (
            session.enlarge(1000),
            "give a bound larger than 24 and at most 100",
        ),
    ] {
        assert_eq!(result.unwrap_err().to_string(), expected);
    }
    let unfit = session.answer(open, &wrong).unwrap_err().to_string();
    assert!(unfit.contains("does not fit question 1"), "{unfit}");
    let reply = truthfully(&mut teacher_of("robot"), &question);
    kept.act(|session| session.answer(open, &reply)).unwrap();
    let closed = kept
        .session
        .answer(open, &Reply::Skip)
        .unwrap_err()
        .to_string();
    assert_eq!(closed, "question 1 is closed: question 2 is open now");
    // The same again is counted once, and leads where it led.
    assert_eq!(
        kept.session.answer(open, &reply),
        Ok(Decision::Already(Position::Asking(2)))
    );
}

#[test]
fn logs_that_make_no_sense_are_refused_at_the_entry() {
    let mut kept = Kept::begin(ready("tomita:5").unwrap(), Setup::default());
    let (number, question) = kept.open().unwrap();
    let reply = truthfully(&mut teacher_of("tomita:5"), &question);
    kept.act(|session| session.answer(number, &reply)).unwrap();
    let text: Vec<serde_json::Value> = kept
        .log
        .iter()
        .map(|event| serde_json::to_value(event).unwrap())
        .collect();
    let refold = |events: &[serde_json::Value]| {
        let events: Vec<Event> = events
            .iter()
            .map(|event| serde_json::from_value(event.clone()).unwrap())
            .collect();
        Session::replay(&events).err().map(|e| (e.entry, e.message))
    };
    assert_eq!(refold(&text), None);
    assert_eq!(refold(&[]).unwrap().0, 0);
    assert_eq!(refold(&text[1..]).unwrap().0, 0);
    let mut newer = text.clone();
    newer[0]["log"] = 2.into();
    assert!(refold(&newer).unwrap().1.contains("version 2"));
    let mut twice = text.clone();
    twice.push(text[2].clone());
    assert_eq!(refold(&twice).unwrap().0, 4);
    let mut skipped = text.clone();
    skipped[3]["number"] = 7.into();
    assert_eq!(
        refold(&skipped),
        Some((3, "question 7 comes out of turn".to_owned()))
    );
}

/// One thing that a restless person does.
#[derive(Clone, Debug)]
enum Whim {
    Answer(u8),
    Retract(u8),
    Change(u8, u8),
    Skip,
}

fn whim() -> impl Strategy<Value = Whim> {
    prop_oneof![
        6 => any::<u8>().prop_map(Whim::Answer),
        1 => any::<u8>().prop_map(Whim::Retract),
        1 => (any::<u8>(), any::<u8>()).prop_map(|(a, b)| Whim::Change(a, b)),
        1 => Just(Whim::Skip),
    ]
}

/// Some reply that fits, by the number drawn.
fn some_reply(question: &Question<Atom, Concept>, drawn: u8) -> Reply<Atom> {
    use memrep::evidence::Comparison::{Equal, First, Incomparable, Second};
    match question {
        Question::Membership { .. } => {
            [Reply::Accept, Reply::Reject][usize::from(drawn) % 2].clone()
        }
        Question::Comparison { .. } => {
            Reply::Compared([First, Second, Equal, Incomparable][usize::from(drawn) % 4])
        }
        Question::Equivalence { hypothesis } => {
            let alphabet = hypothesis.automaton().unwrap().alphabet();
            let symbols: Vec<_> = alphabet.symbols().collect();
            let atom: Word = (0..drawn % 4)
                .map(|i| symbols[usize::from(drawn >> i) % symbols.len()])
                .collect();
            let atom = Atom::Word(atom);
            let label = !accepts(hypothesis, &atom);
            Reply::Counterexample { atom, label }
        }
    }
}

fn live(task: Task, whims: &[Whim]) -> Kept {
    let mut kept = Kept::begin(task, Setup::default());
    for whim in whims {
        let numbers: Vec<u32> = kept.session.standing().iter().map(|s| s.number).collect();
        let pick = |drawn: u8| {
            numbers
                .get(usize::from(drawn) % numbers.len().max(1))
                .copied()
        };
        let result = match whim {
            Whim::Answer(drawn) => match kept.open() {
                Some((number, question)) => {
                    let reply = some_reply(&question, *drawn);
                    kept.act(|session| session.answer(number, &reply))
                }
                // Nothing is open: withdraw something.
                None => kept.act(Session::undo),
            },
            Whim::Skip => match kept.open() {
                Some((number, _)) => kept.act(|session| session.answer(number, &Reply::Skip)),
                None => Ok(()),
            },
            Whim::Retract(drawn) => match pick(*drawn) {
                Some(number) => kept.act(|session| session.retract(number)),
                None => Ok(()),
            },
            Whim::Change(drawn, how) => match pick(*drawn) {
                Some(number) => {
                    let question = kept.session.asked(number).unwrap().question.clone();
                    let reply = some_reply(&question, *how);
                    kept.act(|session| session.change(number, &reply))
                }
                None => Ok(()),
            },
        };
        // Only an unfit skip is refused: equivalence questions are not skipped.
        assert!(
            matches!(result, Ok(()) | Err(Refusal::Unfit { .. })),
            "{whim:?}: {result:?}"
        );
    }
    kept
}

fn small_task() -> Task {
    Task::from_json(&json!({"symbols": ["a", "b"], "max_states": 4})).unwrap()
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 60, ..ProptestConfig::default() })]

    /// Replaying the log gives the same session, and the same next question
    /// even if the last entry was lost.
    #[test]
    fn the_log_is_the_session(whims in prop::collection::vec(whim(), 0..25)) {
        let kept = live(small_task(), &whims);
        let again = kept.replayed();
        prop_assert_eq!(again.position(), kept.session.position());
        prop_assert_eq!(again.entries(), kept.log.len() as u64);
        prop_assert_eq!(again.counts(), kept.session.counts());

        let mut cut = Session::replay(&kept.log[..kept.log.len() - 1]).unwrap();
        prop_assert_eq!(cut.position(), &Position::Thinking);
        let thought = cut.think();
        prop_assert_eq!(thought.as_ref(), kept.log.last());
    }

    /// What is asked depends on the answers that stand alone: a log in which
    /// only those were ever given asks the same.
    #[test]
    fn withdrawn_and_mended_answers_leave_no_trace(whims in prop::collection::vec(whim(), 0..25)) {
        let kept = live(small_task(), &whims);
        let mut clean = vec![kept.log[0].clone()];
        for standing in kept.session.standing() {
            let asked = kept.log.iter().find(|event| {
                matches!(event, Event::Asked { number, .. } if *number == standing.number)
            });
            let number = clean.len() as u32 / 2 + 1;
            let mut asked = asked.unwrap().clone();
            if let Event::Asked { number: n, .. } = &mut asked {
                *n = number;
            }
            clean.push(asked);
            clean.push(Event::Answered {
                number,
                reply: memrep::session::ReplyText::of(&standing.reply, kept.session.universe()),
            });
        }
        let mut clean = Session::replay(&clean).unwrap();
        let next = clean.think().unwrap();
        clean.apply(&next).unwrap();
        if let (Position::Conflict(a), Position::Conflict(b)) =
            (clean.position(), kept.session.position())
        {
            prop_assert_eq!(a.cause, b.cause);
        } else {
            prop_assert_eq!(shown(&clean), shown(&kept.session));
        }
    }

    /// No hypothesis contradicts an answer that stands.
    #[test]
    fn hypotheses_are_sound(whims in prop::collection::vec(whim(), 0..25)) {
        let kept = live(small_task(), &whims);
        if let Some(hypothesis) = kept.session.hypothesis() {
            for standing in kept.session.standing() {
                match (&kept.session.asked(standing.number).unwrap().question, &standing.reply) {
                    (Question::Membership { atom }, Reply::Accept) => prop_assert!(accepts(&hypothesis, atom)),
                    (Question::Membership { atom }, Reply::Reject) => prop_assert!(!accepts(&hypothesis, atom)),
                    (_, Reply::Counterexample { atom, label }) => prop_assert_eq!(accepts(&hypothesis, atom), *label),
                    (Question::Comparison { first, second }, Reply::Compared(answer)) => {
                        let fact = memrep::evidence::Fact::compared(first.clone(), second.clone(), *answer);
                        prop_assert!(fact.holds(|word| accepts(&hypothesis, word)));
                    }
                    _ => {}
                }
            }
        }
    }
}
