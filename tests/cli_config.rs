//! `memrep config` as a shell sees it.
#![cfg(feature = "server")]

use std::path::Path;
use std::process::{Command, Output};

use serde_json::Value;

/// Runs it in this folder with these variables, and returns what it said.
fn config(folder: &Path, variables: &[(&str, &str)], arguments: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_memrep"));
    command.arg("config").args(arguments).current_dir(folder);
    command.env_remove("RUST_LOG");
    command.envs(variables.iter().copied()).output().unwrap()
}

fn text(bytes: Vec<u8>) -> String {
    String::from_utf8(bytes).unwrap()
}

#[test]
fn every_setting_is_told_with_where_it_comes_from() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("memrep.toml"), "lease = 60\n").unwrap();
    let variables = [("MEMREP_LOG", "warn")];
    let database = "postgres://ann:s3cret@db/lab";
    let arguments = ["--database", database];
    let table = config(folder.path(), &variables, &arguments);
    assert!(table.status.success());
    let table = text(table.stdout);
    let rows: Vec<Vec<&str>> = table
        .lines()
        .map(|line| {
            line.split("  ")
                .map(str::trim)
                .filter(|c| !c.is_empty())
                .collect()
        })
        .collect();
    assert_eq!(rows[0], ["setting", "value", "from"]);
    for row in [
        ["addr", "127.0.0.1:8080", "default"],
        ["database", "postgres://ann:***@db/lab", "--database"],
        ["lease", "60", "memrep.toml, line 1, column 9"],
        ["log", "warn", "MEMREP_LOG"],
    ] {
        assert!(rows.contains(&row.to_vec()), "{row:?} is not in\n{table}");
    }
    let arguments = ["--database", database, "--format", "json"];
    let lines = text(config(folder.path(), &variables, &arguments).stdout);
    assert!(!lines.contains("s3cret"), "{lines}");
    let objects: Vec<Value> = lines
        .lines()
        .map(|line| serde_json::from_str(line).unwrap())
        .collect();
    assert_eq!(objects.len(), rows.len() - 1);
    let lease = objects.iter().find(|o| o["setting"] == "lease").unwrap();
    assert_eq!(lease["value"], 60);
    assert_eq!(
        (&lease["from"], &lease["line"]),
        (&"file".into(), &1.into())
    );
}

#[test]
fn what_is_wrong_is_told_and_what_may_be_meant_is_asked() {
    let folder = tempfile::tempdir().unwrap();
    let wrong = config(folder.path(), &[("MEMREP_LEASE", "soon")], &[]);
    assert_eq!(wrong.status.code(), Some(2));
    let said = text(wrong.stderr);
    assert!(
        said.starts_with("error: MEMREP_LEASE: ") && said.contains("soon"),
        "{said}"
    );
    let strange = [("MEMREP_ADRR", "127.0.0.1:1"), ("MEMREP_PYTHON", "python3")];
    let odd = config(folder.path(), &strange, &[]);
    let notes = text(odd.stderr);
    assert_eq!(
        notes,
        "note: MEMREP_ADRR is no setting; did you mean MEMREP_ADDR?\n"
    );
}

#[test]
fn a_log_that_would_tell_nothing_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let said = |variables: &[(&str, &str)], arguments: &[&str]| {
        let output = config(folder.path(), variables, arguments);
        (
            output.status.code(),
            text(output.stdout) + &text(output.stderr),
        )
    };
    for wrong in [
        "inof",
        "",
        "info,wran",
        "memrep::server=debgu",
        "serve=debug",
    ] {
        let (code, told) = said(&[], &["--log", wrong]);
        assert_eq!(code, Some(2), "{wrong}: {told}");
        assert!(told.contains("debug, trace or off"), "{wrong}: {told}");
    }
    for right in [
        "OFF",
        "info, memrep::server=debug",
        "memrep",
        "warn,hyper=debug",
    ] {
        let (code, told) = said(&[("RUST_LOG", "wrong")], &["--log", right]);
        assert_eq!(code, Some(0), "{right}: {told}");
    }
    // What is meant for other programs does not stop this one, nor silence it.
    for others in ["hyper=debug", "", "nonsense"] {
        let (code, told) = said(&[("RUST_LOG", others)], &["--format", "json"]);
        assert_eq!(code, Some(0), "{told}");
        assert!(
            told.contains(r#"{"from":"default","setting":"log","value":"info"}"#),
            "{told}"
        );
    }
    std::fs::write(folder.path().join("memrep.toml"), "log = \"nonsense\"\n").unwrap();
    let (code, told) = said(&[], &[]);
    assert_eq!(code, Some(2));
    assert!(told.contains("memrep.toml, line 1, column 7: "), "{told}");
}

#[test]
fn what_is_no_database_is_refused_and_its_password_is_not_told() {
    let folder = tempfile::tempdir().unwrap();
    for (wrong, why) in [
        ("", "names no file"),
        (" ", "names no file"),
        ("mysql://ann:s3cret@db/lab", "`mysql://` is no address"),
        ("host=db user=ann password=s3cret", "postgres://USER"),
        ("postgres:/ann:s3cret@db/lab", "looks like an address"),
        ("postgres//ann:s3cret@db/lab", "looks like an address"),
        ("postgres:ann:s3cret@db/lab", "looks like an address"),
        ("ann:s3cret@db/lab", "looks like an address"),
        ("postgres://ann:s3cret", "stands its port"),
        ("postgres://ann:s3@cret@db/lab", "%40"),
        ("postgres://ann:s3@c/ret@db/lab", "%40"),
        ("postgres://ann:s3cret@db:99999/lab", "stands its port"),
        (":memory:", "SQLite's own"),
        ("file:lab.db?mode=memory", "SQLite's own"),
    ] {
        let flag = ["--database", wrong];
        let variable = [("MEMREP_DATABASE", wrong)];
        for output in [
            config(folder.path(), &[], &flag),
            config(folder.path(), &variable, &[]),
        ] {
            assert_eq!(output.status.code(), Some(2));
            let said = text(output.stderr);
            assert!(said.contains(why), "{said}");
            for part in ["s3", "cret", "ret@"] {
                assert!(!said.contains(part), "{said}");
            }
        }
    }
    for right in [
        "a:b.db",
        "./ann@lab/a:b.db",
        "postgres/lab.db",
        "postgres:///lab",
        "postgres://ann:a%40b@[::1]:5432,db:1/lab?sslmode=disable",
    ] {
        let output = config(folder.path(), &[], &["--database", right]);
        assert!(output.status.success(), "{right}: {}", text(output.stderr));
    }
    // Nor where it was never meant to stand.
    let misplaced = config(folder.path(), &[], &["postgres://ann:s3cret@db/lab"]);
    let said = text(misplaced.stderr);
    assert!(said.contains("postgres://ann:***@db/lab"), "{said}");
}

#[test]
fn a_file_of_settings_is_text_and_its_numbers_are_in_range() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("memrep.toml");
    for (bytes, why) in [
        (
            b"lease = 60\n# \xff\n".as_slice(),
            "memrep.toml: line 2, column 3: this is not UTF-8",
        ),
        (
            b"lease = 99999999999999999999\n",
            "column 9: invalid value '99999999999999999999'",
        ),
        (b"lease = 1.5\n", "`lease` is a whole number"),
    ] {
        std::fs::write(&file, bytes).unwrap();
        let wrong = config(folder.path(), &[], &[]);
        let said = text(wrong.stderr);
        assert_eq!(wrong.status.code(), Some(2), "{said}");
        assert!(said.contains(why), "{said}");
    }
    std::fs::write(&file, "\u{feff}lease = 60\n").unwrap();
    assert!(config(folder.path(), &[], &[]).status.success());
}

#[test]
fn commands_beside_the_server_take_its_database() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("memrep.toml"), "database = \"lab.db\"\n").unwrap();
    std::fs::write(folder.path().join("b.toml"), "database = \"other.db\"\n").unwrap();
    let backup = |arguments: &[&str]| {
        let output = Command::new(env!("CARGO_BIN_EXE_memrep"))
            .arg("backup")
            .args(arguments)
            .current_dir(folder.path())
            .env_remove("MEMREP_DATABASE")
            .output()
            .unwrap();
        (output.status.success(), text(output.stderr))
    };
    let (_, said) = backup(&[]);
    assert!(said.contains("lab.db"), "{said}");
    let (_, said) = backup(&["--config", "b.toml"]);
    assert!(said.contains("other.db"), "{said}");
    let (_, said) = backup(&["--database", "mine.db"]);
    assert!(said.contains("mine.db"), "{said}");
    drop(memrep::store::Sqlite::open(&folder.path().join("lab.db")).unwrap());
    let (done, said) = backup(&[]);
    assert!(done, "{said}");
}
