//! What a task is made of: task files, tables, grids, recordings, names.

use automata::Alphabet;
use memrep::concept::{FiniteTable, Template};
use memrep::oracle::Target;
use memrep::session::{Event, QuestionText, ReplyText, Session, Setup, ready};
use memrep::task::{Atom, Colour, Fault, Task, TaskFile, WorldText};
use memrep::world::World;
use memrep::world::grid::{GridMap, Labelling};
use memrep::world::pool::PoolReader;
use serde_json::{Value, json};

use super::{check_place, text};

/// A task that was read can be written and read again, and a session begin with it.
fn check_task(task: &Task) {
    let written = serde_json::to_value(task).expect("a task can be written");
    let again: Result<Task, _> = serde_json::from_value(written.clone());
    assert_eq!(again.as_ref().ok(), Some(task), "{again:?}");
    if task.upload().is_some() {
        return;
    }
    let Ok(universe) = task.universe() else {
        return;
    };
    for example in &task.examples {
        let atom = universe
            .parse(&example.atom)
            .expect("examples are behaviours");
        assert_eq!(universe.text(&atom), example.atom);
    }
    let setup = Setup {
        budget: 2000,
        ..Setup::of(task)
    };
    let mut session = Session::replay(&[Session::created(task.clone(), setup)])
        .expect("a task that was read begins a session");
    let thought = session.think().expect("a new session thinks");
    session.apply(&thought).expect("what it thinks makes sense");
}

fn check_faults(text: &str, faults: &[Fault]) {
    assert!(!faults.is_empty(), "refused for nothing");
    for fault in faults {
        let (line, column) = (fault.line.unwrap_or(0), fault.column.unwrap_or(0));
        check_place(text, line, column, &fault.message);
    }
}

pub(crate) fn toml(data: &[u8]) {
    let text = text(data);
    match TaskFile::sent(text) {
        Ok(file) => check_file(&file),
        Err(faults) => check_faults(text, &faults),
    }
    if let Ok(content) = Task::toml_content(text) {
        let _ = Task::from_json(&content);
    }
}

/// What was read is written as a file that says the same, unless that names files.
fn check_file(file: &TaskFile) {
    let task = &file.task;
    if matches!(task.world, Some(WorldText::Pool { .. })) {
        return;
    }
    let written = task.to_toml();
    let content =
        Task::toml_content(&written).unwrap_or_else(|fault| panic!("{}: {written}", fault.message));
    let again = Task::from_json(&content);
    assert_eq!(again.as_ref(), Ok(task), "{written}");
    check_task(task);
}

pub(crate) fn json(data: &[u8]) {
    let text = text(data);
    if text.trim_start().starts_with('{') {
        match TaskFile::sent(text) {
            Ok(file) => check_file(&file),
            Err(faults) => check_faults(text, &faults),
        }
    }
    if let Ok(value) = serde_json::from_str::<Value>(text) {
        match Task::from_json(&value) {
            Ok(task) => check_task(&task),
            Err(error) => assert!(!error.message.is_empty()),
        }
        let _ = TaskFile::of_content(&value);
    }
}

pub(crate) fn table(data: &[u8]) {
    let text = text(data);
    match FiniteTable::read(text) {
        Ok(table) => {
            assert!(table.atoms().len() > 0 || table.class().concepts().len() == 1);
        }
        Err(error) => check_place(text, error.line, error.column, &error.message),
    }
}

/// A map of the symbols `a` to `d`, each its own mark; the first byte says the rest.
pub(crate) fn grid(data: &[u8]) {
    let Some((first, rest)) = data.split_first() else {
        return;
    };
    let labelling = if first & 1 == 0 {
        Labelling::Entry
    } else {
        Labelling::EveryStep
    };
    let letters = Alphabet::new(["a", "b", "c", "d"]).expect("four letters are an alphabet");
    let map = text(rest);
    let grid = GridMap::new(&letters, map).grid(letters.clone(), labelling, usize::from(*first));
    let grid = match grid {
        Ok(grid) => World::Grid(grid),
        Err(error) => return assert!(!error.to_string().is_empty()),
    };
    for rule in ["reach a", "a before b", "never c after a", "avoid d"] {
        let rule = Template::parse(rule, &letters).expect("it is a rule");
        let rule = rule.dfa(&letters);
        let words = grid.simplest(&rule, 3);
        assert_eq!(grid.has_word(&rule), !words.is_empty());
        for word in &words {
            assert!(rule.accepts(word) && grid.is_feasible(word), "{word:?}");
            assert!(grid.trajectory(word).is_some() && grid.shown(word).is_some());
            assert!(grid.obstacle(word).is_none());
        }
    }
}

/// However a file is cut into pieces, the same is read.
pub(crate) fn pool(data: &[u8]) {
    let letters = || Alphabet::new(["a", "b"]).expect("two letters are an alphabet");
    let whole = PoolReader::read(letters(), data);
    let mut reader = PoolReader::new(letters());
    let size = data.first().map_or(1, |first| usize::from(first % 13) + 1);
    let fed = data.chunks(size).try_for_each(|piece| reader.feed(piece));
    let pieces = fed.and_then(|()| reader.finish());
    match (whole, pieces) {
        (Ok(whole), Ok(pieces)) => {
            assert_eq!(whole.recordings(), pieces.recordings());
            for recording in whole.recordings() {
                assert!(whole.recording(&recording.word).is_some());
            }
        }
        (Err(whole), Err(pieces)) => {
            assert_eq!(whole, pieces);
            let text = String::from_utf8_lossy(data);
            if std::str::from_utf8(data).is_ok() {
                let (line, column) = (whole.line.unwrap_or(0), whole.column.unwrap_or(0));
                check_place(&text, line, column, &whole.message);
            }
        }
        (whole, pieces) => panic!("{:?} / {:?}", whole.err(), pieces.err()),
    }
}

/// Names of targets and ready tasks, rules by name, colours.
pub(crate) fn names(data: &[u8]) {
    let name = text(data);
    let task = ready(name);
    match Target::named(name) {
        Ok(target) => {
            assert!(target.dfa().size() > 0);
            let again = Target::named(target.name()).expect("targets are called by their names");
            assert_eq!(again.dfa(), target.dfa());
        }
        Err(error) => assert!(!error.to_string().is_empty()),
    }
    if let Ok(task) = task {
        check_task(&task);
    }
    let letters = Alphabet::new(["a", "b", "before"]).expect("three words are an alphabet");
    if let Ok(rule) = Template::parse(name, &letters) {
        assert!(rule.dfa(&letters).size() > 1);
    }
    if let Some(colour) = Colour::parse(name) {
        assert_eq!(Colour::parse(colour.hex()).as_ref(), Some(&colour));
    }
}

/// Behaviours, answers and rules as requests and logs have them, over tasks of every
/// kind.
pub(crate) fn behaviour(data: &[u8]) {
    let Ok(value) = serde_json::from_str::<Value>(text(data)) else {
        return;
    };
    for task in kinds() {
        let universe = task.universe().expect("it was read");
        if let Ok(atom) = universe.read(&value, "here") {
            let text = universe.text(&atom);
            assert_eq!(universe.parse(&text), Ok(atom.clone()));
            assert_eq!(universe.read(&text.bare(), "here"), Ok(atom.clone()));
            assert!(!universe.spell(&atom).is_empty());
            if let Atom::Word(word) = &atom {
                assert!(word.len() <= memrep::task::MAX_WORD);
            }
        }
        if let Ok(text) = serde_json::from_value::<QuestionText>(value.clone())
            && let Ok(question) = text.read(&universe)
        {
            let again = QuestionText::of(&question, &universe);
            assert_eq!(again.read(&universe), Ok(question));
        }
        if let Ok(text) = serde_json::from_value::<ReplyText>(value.clone())
            && let Ok(reply) = text.read(&universe)
        {
            let again = ReplyText::of(&reply, &universe);
            assert_eq!(again.read(&universe), Ok(reply));
        }
    }
    if let Ok(event) = serde_json::from_value::<Event>(value) {
        let written = serde_json::to_string(&event).expect("an entry can be written");
        assert_eq!(serde_json::from_str::<Event>(&written).ok(), Some(event));
    }
}

/// A task of every kind of behaviour.
fn kinds() -> [Task; 4] {
    let letters = json!({"symbols": ["a", "b"]});
    let axes = json!({"class": {"kind": "monotone", "ticks": 5, "axes": [
        {"name": "wait", "unit": "s", "best": 0, "worst": 10},
    ]}});
    let table = json!({"class": {"kind": "finite", "table": "is,x,y\np,1,0\nq,0,1\n"}});
    let drives = json!({"class": {"kind": "linear", "features": ["f"], "behaviours": [
        {"name": "p", "features": [[0.5]]}, {"name": "q", "features": [[0.25], [0.75]]},
    ]}});
    [letters, axes, table, drives].map(|content| {
        Task::from_json(&content).unwrap_or_else(|error| panic!("{content}: {error}"))
    })
}
