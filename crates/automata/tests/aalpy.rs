//! `AALpy` reads the DOT that is written for programs, and what it writes is
//! read: the same words are accepted.
//!
//! Needs a Python with the package `aalpy`, named by the environment variable
//! `MEMREP_PYTHON`; skipped only where that is not set.

mod support;

use std::path::{Path, PathBuf};
use std::process::Command;

use automata::format::dot;
use automata::{Alphabet, Dfa, Word};
use rand::RngExt;
use support::{dfa, generator, word};

const AUTOMATA: usize = 500;
const WORDS: usize = 200;

/// Alphabets whose names have misled readers of DOT.
fn alphabets() -> [Alphabet; 5] {
    let names: [&[&str]; 5] = [
        &["a", "b"],
        &["0", "1"],
        &["go", "turn_left", "x2", "2x", "_"],
        &["label", "doublecircle", "__start0", "s0", "digraph"],
        &["007", "8", "eight"],
    ];
    names.map(|names| Alphabet::new(names.iter().copied()).unwrap())
}

/// An empty folder of this test.
fn folder() -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("aalpy");
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    folder
}

#[test]
fn aalpy_agrees_on_every_word() {
    let Some(python) = std::env::var_os("MEMREP_PYTHON") else {
        eprintln!("skipped: set MEMREP_PYTHON to a Python that has the package aalpy");
        return;
    };
    let folder = folder();
    let alphabets = alphabets();
    let cases: Vec<(Dfa, Vec<Word>)> = (0..AUTOMATA)
        .map(|case| {
            let mut random = generator(case as u64);
            let alphabet = &alphabets[random.random_range(0..alphabets.len())];
            let dfa = dfa(alphabet, 8, &mut random);
            let words = (0..WORDS)
                .map(|_| word(alphabet, 12, &mut random))
                .collect();
            (dfa, words)
        })
        .collect();
    for (case, (dfa, words)) in cases.iter().enumerate() {
        let lines: Vec<String> = words
            .iter()
            .map(|word| dfa.alphabet().spell(word).collect::<Vec<_>>().join(" "))
            .collect();
        let file = |extension: &str| folder.join(format!("{case}.{extension}"));
        std::fs::write(file("dot"), dot::write(dfa).unwrap()).unwrap();
        std::fs::write(file("words"), lines.join("\n") + "\n").unwrap();
    }

    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/aalpy_words.py");
    let output = Command::new(&python)
        .arg(script)
        .arg(&folder)
        .output()
        .unwrap_or_else(|error| panic!("cannot start {}: {error}", python.display()));
    let complaint = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{complaint}");
    // A warning here would be of an automaton that is not complete.
    let said = String::from_utf8_lossy(&output.stdout);
    assert!(!said.contains("Warning"), "{said}");

    for (case, (dfa, words)) in cases.iter().enumerate() {
        let labels = std::fs::read_to_string(folder.join(format!("{case}.labels"))).unwrap();
        let labels: Vec<&str> = labels.lines().collect();
        let ours: Vec<&str> = words
            .iter()
            .map(|word| if dfa.accepts(word) { "1" } else { "0" })
            .collect();
        assert_eq!(labels, ours, "automaton {case}");

        let saved = std::fs::read_to_string(folder.join(format!("{case}_saved.dot"))).unwrap();
        let saved = dot::read(&saved).unwrap_or_else(|error| panic!("{case}: {error}"));
        // AALpy writes `007` as the number 7.
        if dfa.alphabet().symbol("007").is_none() {
            let saved = saved.reordered(dfa.alphabet()).unwrap();
            assert!(saved.is_equivalent(dfa).unwrap(), "automaton {case}");
        }
    }
}
