//! The fold of a session's log: whatever it holds, it is refused at an entry, or
//! makes a session that can think and be told.

use std::sync::OnceLock;

use memrep::learner::{Question, Reply};
use memrep::session::{Decision, Event, Position, Refusal, Session};
use serde_json::{Value, json};

use super::text;

/// The work for one question: enough for small sessions, and little for a fuzzer.
const BUDGET: u64 = 300;
/// The longest log that is folded.
const MOST: usize = 200;

/// Bytes as the lines of a log.
pub(crate) fn log(data: &[u8]) {
    read(text(data));
    let lines = text(data).lines().filter(|line| !line.trim().is_empty());
    let read: Result<Vec<Event>, _> = lines.take(MOST).map(serde_json::from_str).collect();
    if let Ok(events) = read {
        fold(events);
    }
}

/// Reads a log as `memrep replay` does: as many entries as lines, or the line at fault.
fn read(text: &str) {
    let lines = text.lines().filter(|line| !line.trim().is_empty()).count();
    match memrep::cli::read_log(text) {
        Ok(entries) => assert_eq!(entries, lines, "one entry a line"),
        Err(error) if lines == 0 => assert!(error.to_string().contains("empty"), "{error:#}"),
        Err(error) => {
            let told = format!("{error:#}");
            let after = told
                .strip_prefix("line ")
                .and_then(|rest| rest.split_once(": "));
            let (line, fault) = after.unwrap_or_else(|| panic!("no line: {told}"));
            let number: usize = line.parse().unwrap_or_else(|e| panic!("{e}: {told}"));
            let at = number
                .checked_sub(1)
                .and_then(|index| text.lines().nth(index));
            assert!(
                at.is_some_and(|at| !at.trim().is_empty()),
                "no such line: {told}"
            );
            assert!(!fault.is_empty(), "a fault says nothing: {told}");
        }
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
                let donor = leaf(&mut lines[other].clone(), edit[3]).map(Value::take);
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
            assert!(
                before.is_empty() || Session::replay(before).is_ok(),
                "{error}"
            );
            return;
        }
    };
    check_views(&session);
    for _ in 0..2 {
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
        assert_ne!(
            *session.position(),
            Position::Thinking,
            "it thought in vain"
        );
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
                Question::Comparison { .. } => Reply::Compared(memrep::evidence::Comparison::First),
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

/// Logs of sessions of several kinds, as they were written once.
fn sound() -> &'static [Vec<Value>] {
    const TEXTS: [&str; 9] = [
        include_str!("../sound/alone-tiny.jsonl"),
        include_str!("../sound/shared-tiny.jsonl"),
        include_str!("../sound/alone-table.jsonl"),
        include_str!("../sound/shared-table.jsonl"),
        include_str!("../sound/alone-tomita.jsonl"),
        include_str!("../sound/shared-tomita.jsonl"),
        include_str!("../sound/robot.jsonl"),
        include_str!("../sound/four-buttons.jsonl"),
        include_str!("../sound/car.jsonl"),
    ];
    static LOGS: OnceLock<Vec<Vec<Value>>> = OnceLock::new();
    LOGS.get_or_init(|| {
        let entry =
            |line: &str| -> Value { serde_json::from_str(line).expect("every line is an entry") };
        let log = |text: &str| -> Vec<Value> { text.lines().map(&entry).collect() };
        let logs: Vec<Vec<Value>> = TEXTS.into_iter().map(log).collect();
        for log in &logs {
            let events: Result<Vec<Event>, _> =
                log.iter().cloned().map(serde_json::from_value).collect();
            let folded = Session::replay(&events.expect("what was written is read"));
            assert!(folded.is_ok(), "{:?}", folded.err());
        }
        logs
    })
}
