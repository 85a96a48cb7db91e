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
