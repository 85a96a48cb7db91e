//! `memrep replay`: what was asked is worked out again from the log, and what is made
//! up, missing or moved is told with its line.

use std::io::Write as _;
use std::path::Path;
use std::process::{Command, Output, Stdio};
use std::sync::Arc;

use automata::format::json;
use memrep::learner::{Question, Reply};
use memrep::oracle::{ScriptedTeacher, Target, Teacher, TeacherSettings};
use memrep::session::{Atom, Decision, Event, Position, Session, Setup, Task, ready};
use memrep::world::World;
use memrep::world::pool::PoolReader;
use serde_json::{Value, json};

/// Runs it on a log; `-` stands for the text.
fn replay(log: &str, args: &[&str]) -> Output {
    let mut child = Command::new(env!("CARGO_BIN_EXE_memrep"))
        .args(["replay", "-"])
        .args(args)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    // It may have seen enough before the end.
    let _ = child.stdin.take().unwrap().write_all(log.as_bytes());
    child.wait_with_output().unwrap()
}

fn out(output: &Output) -> String {
    let fault = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{fault}");
    String::from_utf8(output.stdout.clone()).unwrap()
}

/// What it says of a log that does not stand.
fn fault(output: &Output, code: i32) -> String {
    let text = String::from_utf8(output.stderr.clone()).unwrap();
    assert_eq!(output.status.code(), Some(code), "{text}");
    text
}

/// As the API gives it.
fn written(events: &[Event]) -> String {
    let line = |(seq, event): (usize, &Event)| {
        let body = serde_json::to_string(event).unwrap();
        format!(
            "{{\"seq\":{seq},\"at\":\"2026-01-31T12:00:00.000Z\",{}\n",
            &body[1..]
        )
    };
    events.iter().enumerate().map(line).collect()
}

/// A session that a scripted teacher answers, with an answer taken back on the way.
fn taught(name: &str) -> (Session, Vec<Event>) {
    let mut teacher =
        ScriptedTeacher::new(&Target::named(name).unwrap(), TeacherSettings::default());
    let mut events = vec![Session::created(ready(name).unwrap(), Setup::default())];
    let mut session = Session::replay(&events).unwrap();
    let mut undone = false;
    for _ in 0..200 {
        while let Some(event) = session.think() {
            session.apply(&event).unwrap();
            events.push(event);
        }
        let Position::Asking(number) = *session.position() else {
            break;
        };
        let decided = if number == 4 && !undone {
            undone = true;
            session.undo()
        } else {
            let reply = match &session.asked(number).unwrap().question {
                Question::Membership {
                    atom: Atom::Word(word),
                } => [Reply::Reject, Reply::Accept][usize::from(teacher.membership(word))].clone(),
                Question::Comparison {
                    first: Atom::Word(first),
                    second: Atom::Word(second),
                } => Reply::Compared(teacher.comparison(first, second)),
                Question::Equivalence { hypothesis } => {
                    match teacher.counterexample(hypothesis.automaton().unwrap()) {
                        Some((word, label)) => Reply::Counterexample {
                            atom: Atom::Word(word),
                            label,
                        },
                        None => Reply::Correct,
                    }
                }
                other => panic!("{other:?}"),
            };
            session.answer(number, &reply)
        };
        let Ok(Decision::Append(event)) = decided else {
            panic!("{decided:?}");
        };
        session.apply(&event).unwrap();
        events.push(event);
    }
    (session, events)
}

#[test]
fn a_log_gives_the_session_and_its_rule() {
    let (session, events) = taught("tomita:5");
    let log = written(&events);
    let folder = tempfile::tempdir().unwrap();
    let rule = folder.path().join("rule.json");
    let said = replay(
        &log,
        &["--format", "json", "--automaton", rule.to_str().unwrap()],
    );
    let said: Value = serde_json::from_str(&out(&said)).unwrap();
    assert_eq!(said["entries"], events.len());
    assert_eq!(said["state"], "done");
    assert_eq!(said["counts"], json!(session.counts()));
    let learners = |event: &&Event| matches!(event, Event::Asked { .. } | Event::Done { .. });
    assert_eq!(said["rethought"], events.iter().filter(learners).count());
    let learned = json::read(&std::fs::read_to_string(&rule).unwrap())
        .unwrap()
        .dfa;
    let target = Target::named("tomita:5").unwrap();
    assert_eq!(learned.is_equivalent(target.dfa()), Ok(true));
    let next = out(&replay(&log, &["--next"]));
    let expected = session.describe(session.position());
    assert_eq!(serde_json::from_str::<Value>(&next).unwrap(), expected);

    let text = out(&replay(&log, &[]));
    for line in [
        "worked out again: all the same",
        "next: nothing, the session is done",
    ] {
        assert!(text.contains(line), "{text}");
    }
}

#[test]
fn any_moment_of_the_past_can_be_looked_at() {
    let (_, events) = taught("tomita:1");
    let log = written(&events);
    for (at, event) in events.iter().enumerate().skip(1).step_by(2) {
        let next = out(&replay(
            &log,
            &["--next", "--at", &at.to_string(), "--fold"],
        ));
        let next: Value = serde_json::from_str(&next).unwrap();
        match event {
            Event::Asked { number, .. } => assert_eq!(next["number"], *number),
            Event::Done { .. } => assert_eq!(next["kind"], "done"),
            // The learner has not heard it there, and is asked what follows.
            _ => {
                let follows = serde_json::to_value(&events[at + 1]).unwrap();
                assert_eq!(next["number"], follows["number"], "{follows}");
            }
        }
    }
    // What the learner would go on with is no entry of the log.
    let begun = out(&replay(&log, &["--at", "0", "--format", "json"]));
    let begun: Value = serde_json::from_str(&begun).unwrap();
    assert_eq!(
        (&begun["entries"], &begun["state"]),
        (&json!(1), &json!("asking"))
    );
    let none = json!({"membership": 0, "comparison": 0, "equivalence": 0});
    assert_eq!(begun["questions"], none);
    let beyond = fault(&replay(&log, &["--at", "9999"]), 2);
    assert!(beyond.contains("there is no entry 9999"), "{beyond}");
}

#[test]
fn what_does_not_follow_is_told_with_its_line() {
    let (_, events) = taught("tomita:1");
    let log = written(&events);
    let lines: Vec<&str> = log.lines().collect();
    let with = |place: usize, line: &str| {
        let mut lines = lines.clone();
        lines[place] = line;
        lines.join("\n")
    };
    let without = |place: usize| {
        let mut lines = lines.clone();
        lines.remove(place);
        lines.join("\n")
    };
    let mut asked: Value = serde_json::from_str(lines[1]).unwrap();
    asked["left"]["bits"] = json!(99.5);
    for (log, expected) in [
        (
            with(1, &asked.to_string()),
            "line 2: entry 1 does not follow from those before it",
        ),
        (
            without(2),
            "line 3: this is entry 3, and entry 2 comes next",
        ),
        (
            with(3, lines[2]),
            "line 4: this is entry 2, and entry 3 comes next",
        ),
        (
            with(
                1,
                "{\"seq\":1,\"event\":\"answered\",\"number\":1,\"answer\":\"accept\"}",
            ),
            "line 2: entry 1 of the log cannot be read: question 1 is not open",
        ),
        (with(1, "{\"seq\":1,"), "line 2: column 9: this is not JSON"),
        (
            with(1, "{\"seq\":1,\"event\":\"sung\"}"),
            "line 2: entry 1 is none of a session's log: unknown variant `sung`",
        ),
        (
            with(2, &lines[2].replace('}', ",\"mood\":1}")),
            "line 3: entry 2 has `mood`, which no entry of its kind has",
        ),
        (
            with(1, "{\"event\":\"undone\"}"),
            "line 2: some entries have a number",
        ),
        (
            lines[1..].join("\n"),
            "line 1: this is entry 1, and entry 0 comes next",
        ),
        (String::new(), "the log is empty"),
    ] {
        let told = fault(&replay(&log, &[]), 1);
        assert!(told.contains(expected), "{told}");
    }
    let folded = replay(&with(1, &asked.to_string()), &["--fold"]);
    assert_eq!(
        folded.status.code(),
        Some(0),
        "it makes sense, if nobody thinks about it"
    );
    let nowhere = Command::new(env!("CARGO_BIN_EXE_memrep"))
        .args(["replay", "no-such-file.jsonl"])
        .output()
        .unwrap();
    assert!(fault(&nowhere, 2).contains("no-such-file.jsonl: cannot read it"));
}

#[test]
fn bytes_that_are_no_text_are_the_logs_fault_and_a_mark_before_it_is_none() {
    let (_, events) = taught("tomita:1");
    let log = written(&events);
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("log.jsonl");
    let command = || {
        let mut command = Command::new(env!("CARGO_BIN_EXE_memrep"));
        command.arg("replay").arg(&file).arg("--fold");
        command
    };
    std::fs::write(&file, format!("\u{feff}{log}")).unwrap();
    out(&command().output().unwrap());
    let (first, rest) = log.split_once('\n').unwrap();
    let torn = [first.as_bytes(), b"\n\xff", rest.as_bytes()].concat();
    std::fs::write(&file, torn).unwrap();
    let told = fault(&command().output().unwrap(), 1);
    assert!(
        told.contains("log.jsonl: line 2, column 1: this is not UTF-8"),
        "{told}"
    );
    #[cfg(target_os = "linux")]
    {
        // Nobody hears why; the status still tells that it does not stand.
        let full = std::fs::File::options()
            .write(true)
            .open("/dev/full")
            .unwrap();
        let unheard = command().stderr(full).status().unwrap();
        assert_eq!(unheard.code(), Some(1));
    }
}

#[test]
fn a_rule_is_written_by_an_ending_that_automata_have() {
    let (_, events) = taught("tomita:1");
    let log = written(&events);
    for name in ["rule.zzz", "rule", "rule.abb", "rule.jsonl"] {
        let told = fault(&replay(&log, &["--automaton", name]), 2);
        assert!(told.contains("choose .json, .dot, .svg or .hoa"), "{told}");
    }
}

#[test]
fn logs_of_an_earlier_version_said_less() {
    let (_, events) = taught("tomita:1");
    let shorter: Vec<Event> = events
        .into_iter()
        .map(|event| match event {
            Event::Asked {
                number,
                question,
                round,
                hurried,
                ..
            } => Event::Asked {
                number,
                question,
                round,
                hurried,
                left: None,
                removed: Vec::new(),
            },
            other => other,
        })
        .collect();
    let text = out(&replay(&written(&shorter), &[]));
    assert!(text.contains("of an earlier version"), "{text}");
}

#[test]
fn recordings_are_named_beside_the_log() {
    let task = Task::from_json(&json!({
        "symbols": ["a", "b"],
        "world": {"kind": "pool", "upload": "0123456789abcdef0123456789abcdef"},
    }))
    .unwrap();
    let words = ["a", "b", "a\",\"b", "b\",\"a"];
    let lines = (words.iter().enumerate())
        .map(|(place, word)| format!("{{\"id\":\"{place}\",\"word\":[\"{word}\"]}}\n"));
    let recordings = lines.collect::<Vec<_>>().concat();
    let pool = PoolReader::read(task.alphabet().unwrap(), recordings.as_bytes()).unwrap();
    let mut events = vec![Session::created(task, Setup::default())];
    let world = Arc::new(World::Pool(pool));
    let mut session = Session::replay_in(Some(world), &events).unwrap();
    let asked = session.think().unwrap();
    session.apply(&asked).unwrap();
    events.push(asked);
    let log = written(&events);
    let missing = fault(&replay(&log, &[]), 2);
    assert!(
        missing.contains("name their file by `--recordings FILE`"),
        "{missing}"
    );
    let folder = tempfile::tempdir().unwrap();
    let kept = |name: &str, text: &str| {
        let path = folder.path().join(name);
        std::fs::write(&path, text).unwrap();
        path.to_str().unwrap().to_owned()
    };
    let path = kept("recordings.jsonl", &recordings);
    let text = out(&replay(&log, &["--recordings", &path]));
    assert!(
        text.contains("1 entry of the learner's worked out again"),
        "{text}"
    );
    let bad = kept("bad.jsonl", "{\"id\":\"x\",\"word\":[\"c\"]}\n");
    let told = fault(&replay(&log, &["--recordings", &bad]), 2);
    assert!(told.contains("line 1, column 19, `word[0]`"), "{told}");
    assert!(Path::new(&path).exists());
}
