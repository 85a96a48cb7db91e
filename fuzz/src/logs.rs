//! The fold of a session's log: whatever it holds, it is refused at an entry, or
//! makes a session that can think and be told.

use std::sync::OnceLock;

use memrep::learner::{Question, Reply};
use memrep::session::{
    Atom, Decision, Event, Position, Refusal, Session, Setup, Task, Terms, ready,
};
use serde_json::{Value, json};

use crate::text;

/// The work for one question: enough for small sessions, and little for a fuzzer.
const BUDGET: u64 = 2000;
/// The longest log that is folded.
const MOST: usize = 200;

/// Bytes as the lines of a log.
pub(crate) fn log(data: &[u8]) {
    let lines = text(data).lines().filter(|line| !line.trim().is_empty());
    let read: Result<Vec<Event>, _> = lines.take(MOST).map(serde_json::from_str).collect();
    if let Ok(events) = read {
        fold(events);
    }
}

/// Bytes as edits of a log that is sound: four for each entry that is dropped,
/// doubled, moved, or changed in one value.
pub(crate) fn edits(data: &[u8]) {
    let Some((first, edits)) = data.split_first() else {
        return;
    };
    let logs = sound();
    let mut lines = logs[usize::from(*first) % logs.len()].clone();
    for edit in edits.chunks_exact(4).take(16) {
        let (at, other) = (usize::from(edit[1]), usize::from(edit[2]));
        let (at, other) = (at % lines.len(), other % lines.len());
        match edit[0] % 6 {
            0 if lines.len() > 1 => drop(lines.remove(at)),
            1 => lines.insert(other, lines[at].clone()),
            2 => lines.swap(at, other),
            3 => lines.truncate(at + 1),
            4 => {
                let donor = leaf(&mut lines[other].clone(), edit[3]).map(|leaf| leaf.take());
                if let (Some(donor), Some(leaf)) = (donor, leaf(&mut lines[at], edit[3])) {
                    *leaf = donor;
                }
            }
            _ => {
                let hostile = hostile(edit[2]);
                if let Some(leaf) = leaf(&mut lines[at], edit[3]) {
                    *leaf = hostile;
                }
            }
        }
    }
    let read: Result<Vec<Event>, _> = lines.into_iter().map(serde_json::from_value).collect();
    if let Ok(events) = read {
        fold(events);
    }
}

/// A value that is hardly ever meant.
fn hostile(which: u8) -> Value {
    match which % 16 {
        0 => json!(0),
        1 => json!(-1),
        2 => json!(u32::MAX),
        3 => json!(u64::MAX),
        4 => json!(1e308),
        5 => json!(-0.0),
        6 => json!(""),
        7 => json!("inf"),
        8 => json!(null),
        9 => json!([]),
        10 => json!({}),
        11 => json!(true),
        12 => json!("\u{202e}<script>"),
        13 => json!(1),
        14 => json!(101),
        _ => json!(5e-324),
    }
}

/// One of the values within, that are no objects.
fn leaf(value: &mut Value, which: u8) -> Option<&mut Value> {
    fn collect<'a>(value: &'a mut Value, found: &mut Vec<&'a mut Value>) {
        let is_leaf = match value {
            Value::Object(map) => map.is_empty(),
            Value::Array(list) => list.is_empty(),
            _ => true,
        };
        if is_leaf {
            found.push(value);
            return;
        }
        match value {
            Value::Object(map) => map.values_mut().for_each(|value| collect(value, found)),
            Value::Array(list) => list.iter_mut().for_each(|value| collect(value, found)),
            _ => {}
        }
    }
    let mut found = Vec::new();
    collect(value, &mut found);
    let count = found.len();
    (count > 0).then(|| found.swap_remove(usize::from(which) % count))
}

/// Folds a log, and goes on with what comes of it.
fn fold(mut events: Vec<Event>) {
    if let Some(Event::Created { setup, task, .. }) = events.first_mut() {
        setup.budget = setup.budget.min(BUDGET);
        if task.upload().is_some() {
            return;
        }
    }
    let session = Session::replay(&events);
    let mut session = match session {
        Ok(session) => session,
        Err(error) => {
            assert!(error.entry <= events.len() as u64, "{error}");
            assert!(!error.message.is_empty());
            // All before it folds.
            let before = &events[..error.entry as usize];
            assert!(before.is_empty() || Session::replay(before).is_ok(), "{error}");
            return;
        }
    };
    check_views(&session);
    for _ in 0..3 {
        go_on(&mut session, &mut events);
        check_again(&session, &events);
        check_views(&session);
        let Some(answer) = some_answer(&session) else {
            return;
        };
        append(&mut session, &mut events, answer);
    }
}

/// Thinks; what is thought is entries that fold.
fn go_on(session: &mut Session, events: &mut Vec<Event>) {
    if let Some(event) = session.think() {
        append(session, events, event);
        assert_ne!(*session.position(), Position::Thinking, "it thought in vain");
    }
}

fn append(session: &mut Session, events: &mut Vec<Event>, event: Event) {
    let written = serde_json::to_string(&event).expect("an entry can be written");
    let read: Event = serde_json::from_str(&written).unwrap_or_else(|e| panic!("{e}: {written}"));
    assert_eq!(read, event, "{written}");
    if let Err(error) = session.apply(&event) {
        panic!("{error}: {written}");
    }
    events.push(event);
}

/// The log gives the session once more.
fn check_again(session: &Session, events: &[Event]) {
    let again = Session::replay(events).expect("it folded before");
    assert_eq!(again.position(), session.position());
    assert_eq!(again.entries(), session.entries());
    assert_eq!(again.counts(), session.counts());
    let open = |session: &Session| session.open().collect::<Vec<_>>();
    assert_eq!(open(&again), open(session));
}

/// What pages and API show of a session can be shown.
fn check_views(session: &Session) {
    let hypothesis = session.hypothesis();
    if let Some(hypothesis) = &hypothesis {
        let _ = session.universe().rule(hypothesis);
    }
    let _ = (session.last_shown(), session.beyond(), session.counts());
    if let Position::Conflict(conflict) = session.position() {
        assert!(!session.explain(conflict).is_empty());
    }
    for event in session.foreseen() {
        let mut tried = session.fork();
        assert_eq!(tried.apply(&event), Ok(()), "{event:?}");
    }
}

/// An answer that fits what is open; in a conflict, one that is taken back.
fn some_answer(session: &Session) -> Option<Event> {
    let decided: Result<Decision, Refusal> = match session.position() {
        Position::Asking(number) => {
            let reply = match &session.asked(*number)?.question {
                Question::Membership { .. } => Reply::Accept,
                Question::Comparison { .. } => {
                    Reply::Compared(memrep::evidence::Comparison::First)
                }
                Question::Equivalence { .. } => Reply::Correct,
            };
            session.answer(*number, &reply)
        }
        Position::Conflict(conflict) => session.retract(*conflict.answers.first()?),
        Position::Done(_) => session.undo(),
        Position::Thinking => return None,
    };
    match decided {
        Ok(Decision::Append(event)) => Some(event),
        _ => None,
    }
}

/// Logs of sessions of several kinds, as they are written.
fn sound() -> &'static [Vec<Value>] {
    static LOGS: OnceLock<Vec<Vec<Value>>> = OnceLock::new();
    LOGS.get_or_init(|| {
        let own = |content: Value| {
            Task::from_json(&content).unwrap_or_else(|error| panic!("{content}: {error}"))
        };
        let tiny = own(json!({"symbols": ["a"], "max_states": 2}));
        let table = own(json!({"class": {"kind": "finite", "table": "is,x,y,z\np,1,0,1\nq,0,1,1\n"}}));
        let named = |name: &str| ready(name).expect("it is ready");
        let tasks = [tiny, table, named("tomita:5"), named("robot"), named("four-buttons"), named("car")];
        let mut logs = Vec::new();
        for (place, task) in tasks.into_iter().enumerate() {
            logs.push(lived(task.clone(), place as u64, false));
            if place < 3 {
                logs.push(lived(task, place as u64, true));
            }
        }
        logs
    })
}

/// The log of a session that was answered in one way after another.
fn lived(task: Task, seed: u64, shared: bool) -> Vec<Value> {
    let setup = Setup {
        budget: BUDGET,
        seed,
        ..Setup::of(&task)
    };
    let mut events = vec![Session::created(task, setup)];
    let mut session = Session::replay(&events).expect("it begins");
    go_on(&mut session, &mut events);
    if shared {
        for name in ["Ada", "Bo"] {
            decide(&mut session, &mut events, |session| session.invite(name, None));
        }
        let terms = Terms {
            answers: 2,
            ..Terms::default()
        };
        decide(&mut session, &mut events, |session| session.set_terms(terms.clone()));
    }
    for turn in 0..8_u32 {
        let Some(answer) = next_answer(&session, turn) else {
            break;
        };
        if shared && let Event::Answered { number, reply } = &answer {
            let reply = reply.read(session.universe()).expect("it was written here");
            for person in 1..=2 {
                decide(&mut session, &mut events, |session| {
                    session.say(person, *number, &reply, Some(900))
                });
            }
        } else {
            append(&mut session, &mut events, answer);
        }
        go_on(&mut session, &mut events);
        if turn == 5 {
            decide(&mut session, &mut events, Session::undo);
        }
    }
    let value = |event: &Event| serde_json::to_value(event).expect("an entry can be written");
    events.iter().map(value).collect()
}

fn decide(
    session: &mut Session,
    events: &mut Vec<Event>,
    decision: impl Fn(&Session) -> Result<Decision, Refusal>,
) {
    if let Ok(Decision::Append(event)) = decision(session) {
        append(session, events, event);
        go_on(session, events);
    }
}

/// The answer of a turn: each foreseen one has its turn.
fn next_answer(session: &Session, turn: u32) -> Option<Event> {
    let foreseen = session.foreseen();
    let fitting = |event: &&Event| !matches!(event, Event::Answered { reply, .. } if reply.read(session.universe()) == Ok(Reply::<Atom>::Correct));
    let found = foreseen.iter().filter(fitting).nth(turn as usize % 2).cloned();
    found.or_else(|| some_answer(session))
}
