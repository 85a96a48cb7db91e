//! What the fuzz targets were fed, once more: every file of `fuzz/corpus/` through the
//! function that libFuzzer calls, so that what was found stays mended.
//! `./scripts/fuzz` looks for more.

use std::path::Path;

#[expect(unreachable_pub, reason = "it is a library of its own too")]
#[path = "../fuzz/src/lib.rs"]
mod targets;

/// Runs a target with all of its corpus; the last file named is the one at fault.
fn check(target: &str) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("fuzz/corpus")
        .join(target);
    let entries =
        std::fs::read_dir(&folder).unwrap_or_else(|e| panic!("{}: {e}", folder.display()));
    let mut files: Vec<_> = entries.map(|entry| entry.unwrap().path()).collect();
    files.sort();
    assert!(!files.is_empty(), "{} is empty", folder.display());
    for file in files {
        eprintln!("{}", file.display());
        targets::run(target, &std::fs::read(&file).unwrap());
    }
}

#[test]
fn every_target_has_its_file_and_is_tested_here() {
    let here = include_str!("corpora.rs");
    let manifest = include_str!("../fuzz/Cargo.toml");
    for (name, _) in targets::TARGETS {
        assert!(here.contains(&format!("check(\"{name}\")")), "{name}");
        assert!(
            manifest.contains(&format!("path = \"fuzz_targets/{name}.rs\"")),
            "{name}"
        );
    }
    assert_eq!(manifest.matches("[[bin]]").count(), targets::TARGETS.len());
}

#[test]
fn automata_and_samples_are_read_or_refused() {
    check("automaton");
    check("dot");
    check("abbadingo");
    check("sample");
}

#[test]
fn tasks_are_read_or_refused() {
    check("task_toml");
    check("task_json");
    check("table");
    check("names");
}

#[test]
fn worlds_are_read_or_refused() {
    check("grid");
    check("pool");
}

#[test]
fn logs_are_folded_or_refused() {
    check("behaviour");
    check("log");
}

#[test]
fn sound_logs_with_an_edit_are_folded_or_refused() {
    check("edits");
}
