//! Settings from all their sources, as a shell and a file give them.

use std::ffi::OsString;
use std::path::Path;

use clap::{Args as _, Command};

use super::{Around, Held, Source, masked, nearest, resolve_in, shown};
use crate::cli::serve::Args;

type Variables<'a> = &'a [(&'a str, &'a str)];

/// The settings with these flags, variables and file; or what is wrong.
fn settings(
    flags: &[&str],
    variables: Variables<'_>,
    file: Option<&str>,
) -> Result<(Args, Vec<Held>), String> {
    let folder = tempfile::tempdir().unwrap();
    if let Some(text) = file {
        std::fs::write(folder.path().join("memrep.toml"), text).unwrap();
    }
    let variable = |name: &str| {
        let found = variables.iter().find(|(known, _)| *known == name);
        found.map(|(_, value)| OsString::from(value))
    };
    let around = Around {
        variable: &variable,
        folder: folder.path(),
    };
    let command = Args::augment_args(Command::new("memrep").no_binary_name(true));
    let flags = command.try_get_matches_from(flags).unwrap();
    resolve_in(&flags, &around).map_err(|error| format!("{error:#}"))
}

fn source_of(held: &[Held], key: &str) -> Source {
    held.iter()
        .find(|held| held.key == key)
        .unwrap()
        .source
        .clone()
}

#[test]
fn a_flag_counts_before_the_environment_before_the_file_before_the_default() {
    let variables = [("MEMREP_LEASE", "7"), ("MEMREP_DATABASE", "env.db")];
    let file = "# Ours\nlease = 5\n  database = \"file.db\"\nlog = \"debug\"\n";
    let (args, held) = settings(&["--lease", "9"], &variables, Some(file)).unwrap();
    assert_eq!((args.lease, args.database.as_str()), (9, "env.db"));
    assert_eq!(args.log.to_string(), "debug");
    assert_eq!(args.addr.port(), 8080);
    assert_eq!(source_of(&held, "lease"), Source::Flag("--lease".into()));
    let variable = Source::Environment("MEMREP_DATABASE".into());
    assert_eq!(source_of(&held, "database"), variable);
    let line = Source::File("memrep.toml".into(), 4, 7);
    assert_eq!(source_of(&held, "log"), line);
    assert_eq!(source_of(&held, "addr"), Source::Default);
}

#[test]
fn the_level_of_logs_is_also_in_rust_log_and_ours_counts_first() {
    let (_, held) = settings(&[], &[("RUST_LOG", "warn")], Some("log = \"debug\"")).unwrap();
    assert_eq!(
        source_of(&held, "log"),
        Source::Environment("RUST_LOG".into())
    );
    let both = [("RUST_LOG", "warn"), ("MEMREP_LOG", "error")];
    let (args, _) = settings(&[], &both, None).unwrap();
    assert_eq!(args.log.to_string(), "error");
}

#[test]
fn what_is_wrong_is_told_with_its_place_and_the_remedy() {
    let cases: [(Variables<'_>, &str, &[&str]); 9] = [
        (
            &[],
            "\n leese = 3",
            &["memrep.toml, line 2, column 2", "did you mean `lease`?"],
        ),
        (
            &[],
            "zzz = 3",
            &["line 1, column 1", "the settings are addr, database"],
        ),
        (
            &[],
            "lease = \"3\"",
            &["line 1, column 9", "a whole number, not a string"],
        ),
        (
            &[],
            "addr = 8080",
            &["line 1, column 8", "a string in quotes, not a number"],
        ),
        (
            &[],
            "[addr]\nport = 1",
            &["line 1, column 1", "not a table"],
        ),
        (&[], "lease = 0", &["line 1, column 9", "1..=86400"]),
        (
            &[],
            "config = \"b.toml\"",
            &["line 1, column 1", "no setting"],
        ),
        (&[], "lease = = 3", &["line 1, column 9", "not TOML"]),
        (&[("MEMREP_ADDR", "here")], "", &["MEMREP_ADDR: ", "here"]),
    ];
    for (variables, file, parts) in cases {
        let fault = settings(&[], variables, Some(file)).err().unwrap();
        for part in parts {
            assert!(fault.contains(part), "{file:?}: {part:?} is not in {fault}");
        }
    }
    let fault = settings(&["--config", "nowhere.toml"], &[], None)
        .err()
        .unwrap();
    assert!(
        fault.contains("nowhere.toml") && fault.contains("MEMREP_CONFIG"),
        "{fault}"
    );
}

#[test]
fn a_named_file_is_read_instead_of_the_usual_one() {
    let folder = tempfile::tempdir().unwrap();
    let other = folder.path().join("other.toml");
    std::fs::write(&other, "lease = 60").unwrap();
    let other = other.to_str().unwrap();
    let (args, held) = settings(&[], &[("MEMREP_CONFIG", other)], Some("lease = 5")).unwrap();
    assert_eq!(args.lease, 60);
    assert_eq!(
        source_of(&held, "lease"),
        Source::File(Path::new(other).into(), 1, 9)
    );
}

#[test]
fn a_variable_has_several_values_with_blanks_between() {
    let both = "https://a.example  http://b.example:8080";
    let (args, held) = settings(&[], &[("MEMREP_ORIGIN", both)], None).unwrap();
    let told: Vec<String> = args.origin.iter().map(ToString::to_string).collect();
    assert_eq!(told, ["https://a.example", "http://b.example:8080"]);
    let origin = held.iter().find(|held| held.key == "origin").unwrap();
    assert_eq!(origin.texts, told);
}

#[test]
fn passwords_are_not_shown() {
    let cases = [
        ("postgres://ann:s3cret@db/x", "postgres://ann:***@db/x"),
        ("postgres://ann:a/b@c?d@db/x", "postgres://ann:***@db/x"),
        (
            "postgres://db:5432/x?password=s3cret&a=b",
            "postgres://db:5432/x?password=***&a=b",
        ),
        (
            "host=db password='a b' user=ann",
            "host=db password=*** user=ann",
        ),
        ("postgres://ann@db:5432/x", "postgres://ann@db:5432/x"),
        ("lab:2.db", "lab:2.db"),
    ];
    for (text, expected) in cases {
        assert_eq!(masked(text), expected);
    }
    let database = ["--database", "postgres://ann:s3cret@db/x"];
    let (_, held) = settings(&database, &[], None).unwrap();
    let all: Vec<String> = held.iter().flat_map(shown).collect();
    assert!(!all.join(" ").contains("s3cret"), "{all:?}");
}

#[test]
fn a_wrong_name_is_mended_only_by_one_that_is_like_it() {
    let keys = ["addr", "database", "lease"].map(String::from);
    assert_eq!(nearest("adress", &keys), Some("addr"));
    assert_eq!(nearest("colour", &keys), None);
}
