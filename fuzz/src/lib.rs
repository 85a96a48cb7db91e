//! What the fuzz targets do with bytes: each reads them and panics where a promise
//! is broken.
//!
//! libFuzzer calls these through `fuzz_targets/`; `tests/corpora.rs` includes this
//! file and calls them with every file of `corpus/`, so that what was found once is
//! tested for ever after. It must not know libFuzzer.

mod formats;
mod logs;
mod tasks;

/// A target by name.
type Target = (&'static str, fn(&[u8]));

/// All targets; the corpus of each is the folder of its name.
pub const TARGETS: &[Target] = &[
    ("automaton", formats::automaton),
    ("abbadingo", formats::abbadingo),
    ("sample", formats::sample),
    ("dot", formats::dot),
    ("task_toml", tasks::toml),
    ("task_json", tasks::json),
    ("table", tasks::table),
    ("grid", tasks::grid),
    ("pool", tasks::pool),
    ("names", tasks::names),
    ("behaviour", tasks::behaviour),
    ("log", logs::log),
    ("edits", logs::edits),
];

/// Runs the target of this name.
///
/// # Panics
///
/// If there is none, or it finds a fault.
pub fn run(name: &str, data: &[u8]) {
    let target = TARGETS.iter().find(|(known, _)| *known == name);
    let (_, body) = target.expect("a target's file has its name");
    body(data);
}

/// The bytes as text, as far as they are: readers take nothing else.
fn text(data: &[u8]) -> &str {
    match std::str::from_utf8(data) {
        Ok(text) => text,
        Err(error) => {
            std::str::from_utf8(&data[..error.valid_up_to()]).expect("it is valid so far")
        }
    }
}

/// Checks that a fault's place is one that an editor can jump to: within the text,
/// or right behind it. Columns are counted in characters or bytes.
fn check_place(text: &str, line: usize, column: usize, message: &str) {
    assert!(!message.is_empty(), "a fault says nothing");
    let lines = text.split('\n').count();
    assert!(
        (1..=lines + 1).contains(&line),
        "line {line} of {lines}: {message}"
    );
    let length = text.split('\n').nth(line - 1).map_or(0, str::len);
    assert!(
        (1..=length + 2).contains(&column),
        "column {column} of {length} in line {line}: {message}"
    );
}
