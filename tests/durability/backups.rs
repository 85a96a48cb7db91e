//! Backups are whole, and what was backed up can be put back.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::{Duration, Instant, SystemTime};

use memrep::store::{SessionId, Sqlite, Store, back_up, check_backup};
use serde_json::{Value, json};

use crate::server::{Server, answer, answers_in, assert_sound, done, memrep, refused};

fn text(path: &Path) -> &str {
    path.to_str().unwrap()
}

fn files_in(folder: &Path) -> Vec<PathBuf> {
    let mut files: Vec<PathBuf> = std::fs::read_dir(folder)
        .unwrap()
        .map(|file| file.unwrap().path())
        .collect();
    files.sort();
    files
}

/// A backup that is made while people answer folds, and has every answer that was
/// acknowledged before it began.
#[test]
fn a_backup_made_while_people_answer_is_put_back_and_goes_on() {
    let folder = tempfile::tempdir().unwrap();
    let database = folder.path().join("lab.db");
    let backups = folder.path().join("kept");
    let mut server = Server::at(&database);
    let created = server.json("POST", "/api/v1/sessions", &json!({"task": "tomita:4"}));
    let session = format!("/api/v1/sessions/{}", created["id"].as_str().unwrap());
    let mut question = server.json("GET", &format!("{session}/question"), &Value::Null);
    let mut made = Vec::new();
    for answered in 1..=5 {
        question = server.json(
            "POST",
            &format!("{session}/answers"),
            &answer(&question).unwrap(),
        );
        let busy = std::thread::scope(|scope| {
            let others = scope.spawn(|| {
                (0..5)
                    .map(|_| server.json("POST", "/api/v1/sessions", &json!({"task": "tomita:1"})))
                    .count()
            });
            let mut command = memrep(&["backup", "--database", text(&database)]);
            command.args([
                "--to",
                &format!("{}/", text(&backups)),
                "--keep",
                "3",
                "--format",
                "json",
            ]);
            let told: Value = serde_json::from_str(&done(&mut command)).unwrap();
            made.push((PathBuf::from(told["path"].as_str().unwrap()), answered));
            others.join().unwrap()
        });
        assert_eq!(busy, 5);
    }
    let last_three: Vec<PathBuf> = made[2..].iter().map(|(path, _)| path.clone()).collect();
    assert_eq!(files_in(&backups), last_three, "the last three are kept");

    // While a server has it open nothing is replaced, not even by force.
    let (backup, answered) = &made[2];
    let restore = |force: &[&str]| {
        let mut command = memrep(&["restore", text(backup), "--database", text(&database)]);
        command.args(force);
        command
    };
    let said = refused(&mut restore(&[]));
    assert!(said.contains("--force"), "{said}");
    let said = refused(&mut restore(&["--force"]));
    assert!(said.contains("a server has it open"), "{said}");
    let later = server.json("GET", &format!("{session}/question"), &Value::Null);
    server.kill();
    done(&mut restore(&["--force"]));
    assert_sound(&database);
    let kept: Vec<PathBuf> = files_in(folder.path())
        .into_iter()
        .filter(|path| text(path).contains(".before-restore-"))
        .collect();
    assert_eq!(kept.len(), 1, "{kept:?}");

    let mut server = Server::at(&database);
    let log = server.ask("GET", &format!("{session}/log"), &Value::Null);
    assert_eq!(answers_in(&log.body).len(), *answered);
    let mut again = server.json("GET", &format!("{session}/question"), &Value::Null);
    for _ in *answered..5 {
        again = server.json(
            "POST",
            &format!("{session}/answers"),
            &answer(&again).unwrap(),
        );
    }
    assert_eq!(again, later, "the same answers lead to the same question");
    server.kill();
    // What was there before is whole too.
    let before = Server::at(&kept[0]);
    let question = before.json("GET", &format!("{session}/question"), &Value::Null);
    assert_eq!(question, later);
}

/// However fast one comes after the other: those that go are the oldest.
#[test]
fn of_many_backups_in_one_second_the_last_ones_are_kept() {
    let folder = tempfile::tempdir().unwrap();
    let database = folder.path().join("lab.db");
    let store = Sqlite::open(&database).unwrap();
    let session = SessionId::random().unwrap();
    // It is no folder yet, and its name says that it is to be one.
    let kept = folder.path().join("var").join("kept");
    let mut made = Vec::new();
    for seq in 0..12 {
        store.append(&session, seq, "{}").unwrap();
        let mut command = memrep(&["backup", "--database", text(&database)]);
        command.args(["--to", text(&kept), "--keep", "2"]);
        made.push(PathBuf::from(done(&mut command).trim()));
        let mut last = made[made.len().saturating_sub(2)..].to_vec();
        last.sort();
        assert_eq!(files_in(&kept), last, "after {made:?}");
    }
    let newest = Sqlite::open(made.last().unwrap()).unwrap();
    assert_eq!(newest.read(&session).unwrap().len(), 12);
}

/// What a backup left that was killed goes, once nobody can be writing to it.
#[test]
fn what_a_killed_backup_left_goes_after_a_day() {
    let folder = tempfile::tempdir().unwrap();
    let database = folder.path().join("lab.db");
    drop(Sqlite::open(&database).unwrap());
    let kept = folder.path().join("kept");
    std::fs::create_dir(&kept).unwrap();
    let hour = Duration::from_secs(60 * 60);
    let left = |name: &str, hours: u32| {
        let path = kept.join(name);
        let file = std::fs::File::create(&path).unwrap();
        file.set_modified(SystemTime::now() - hours * hour).unwrap();
        path
    };
    let partial = "20260131T120000Z.db.partial-0123456789abcdef";
    let old = left(&format!("lab-{partial}"), 25);
    let others = [
        left(&format!("lab-{}", partial.replace('0', "1")), 1),
        left(&format!("other-{partial}"), 25),
        left("lab.db.partial-notes", 25),
    ];
    let mut command = memrep(&["backup", "--database", text(&database)]);
    command.args(["--to", text(&kept), "--format", "json"]);
    let told: Value = serde_json::from_str(&done(&mut command)).unwrap();
    assert_eq!(told["removed"], json!([old]));
    assert!(!old.exists());
    assert!(others.iter().all(|other| other.exists()));
}

#[test]
fn what_is_no_sound_backup_is_refused_and_changes_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let store = Sqlite::open(&at("a.db")).unwrap();
    let session = SessionId::random().unwrap();
    for seq in 0..200 {
        store.append(&session, seq, &"entry ".repeat(50)).unwrap();
    }
    back_up(&at("a.db"), &at("good.db")).unwrap();
    assert_eq!(check_backup(&at("good.db")).unwrap().entries, 200);

    let good = std::fs::read(at("good.db")).unwrap();
    std::fs::write(at("short.db"), &good[..good.len() / 2]).unwrap();
    let mut changed = good.clone();
    let middle = changed.len() / 2;
    changed[middle..middle + 3000].fill(0x5a);
    std::fs::write(at("changed.db"), changed).unwrap();
    std::fs::write(at("notes.txt"), "not a database at all ".repeat(60)).unwrap();
    std::fs::write(at("empty.db"), "").unwrap();
    back_up(&at("a.db"), &at("gap.db")).unwrap();
    let gap = rusqlite::Connection::open(at("gap.db")).unwrap();
    gap.execute("DELETE FROM entries WHERE seq = 7", [])
        .unwrap();
    drop(gap);
    let target = at("new.db");
    for (name, part) in [
        ("short.db", "damaged"),
        ("changed.db", "damaged"),
        ("notes.txt", "not an SQLite file"),
        ("empty.db", "empty"),
        ("gap.db", "entry 7 of session"),
        ("nowhere.db", "check that it is there"),
        ("", "it is a folder"),
    ] {
        let said = refused(&mut memrep(&[
            "restore",
            text(&at(name)),
            "--database",
            text(&target),
        ]));
        assert!(said.contains(part), "{name}: {said}");
        assert!(!target.exists());
    }
    let elsewhere = "postgres://someone:secret@db/memrep";
    let said = refused(&mut memrep(&["backup", "--database", elsewhere]));
    assert!(
        said.contains("pg_dump") && !said.contains("secret"),
        "{said}"
    );
    let copies = at("copies");
    for (name, part) in [("none.db", "no such database"), ("", "it is a folder")] {
        let said = refused(&mut memrep(&[
            "backup",
            "--database",
            text(&at(name)),
            "--to",
            text(&copies),
        ]));
        assert!(said.contains(part), "{said}");
        assert!(!copies.exists(), "a folder is made for a backup alone");
    }
    #[cfg(unix)]
    {
        let made = Command::new("mkfifo").arg(at("pipe.db")).status().unwrap();
        assert!(made.success());
        std::os::unix::fs::symlink(at("nowhere.db"), at("link.db")).unwrap();
        for (name, part) in [
            ("pipe.db", "no ordinary file"),
            ("link.db", "link to nothing"),
        ] {
            let good = at("good.db");
            let target = at(name);
            let arguments = [
                "restore",
                text(&good),
                "--force",
                "--database",
                text(&target),
            ];
            let said = refused(&mut memrep(&arguments));
            assert!(said.contains(part), "{name}: {said}");
            assert!(!target.is_file(), "{name}");
        }
    }
    let (a, good) = (at("a.db"), at("good.db"));
    let said = refused(&mut memrep(&[
        "backup",
        "--database",
        text(&a),
        "--to",
        text(&good),
    ]));
    assert!(said.contains("there already"), "{said}");
    assert!(
        files_in(folder.path())
            .iter()
            .all(|file| !text(file).contains("partial"))
    );
}

#[test]
#[cfg(unix)]
fn a_backup_that_nobody_may_change_is_put_back_to_go_on_also_behind_a_link() {
    use std::os::unix::fs::{PermissionsExt as _, symlink};
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let session = SessionId::random().unwrap();
    let store = Sqlite::open(&at("a.db")).unwrap();
    store.append(&session, 0, "kept").unwrap();
    back_up(&at("a.db"), &at("b.db")).unwrap();
    store.append(&session, 1, "later").unwrap();
    drop(store);
    let mode = |path: &Path| std::fs::metadata(path).unwrap().permissions().mode() & 0o777;
    std::fs::set_permissions(at("b.db"), std::fs::Permissions::from_mode(0o440)).unwrap();
    symlink(at("a.db"), at("link.db")).unwrap();
    let (backup, link) = (at("b.db"), at("link.db"));
    done(&mut memrep(&[
        "restore",
        text(&backup),
        "--force",
        "--database",
        text(&link),
    ]));
    assert!(link.is_symlink(), "what it leads to is replaced");
    assert_eq!((mode(&at("a.db")), mode(&at("b.db"))), (0o640, 0o440));
    let store = Sqlite::open(&at("a.db")).unwrap();
    assert_eq!(store.read(&session).unwrap().len(), 1);
    store.append(&session, 1, "anew").unwrap();
}

/// A log that is left of a database that is gone must not become a part of another.
#[test]
fn what_is_left_of_another_database_is_set_aside() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let session = SessionId::random().unwrap();
    let store = Sqlite::open(&at("a.db")).unwrap();
    store.append(&session, 0, "first").unwrap();
    back_up(&at("a.db"), &at("backup.db")).unwrap();
    store.append(&session, 1, "later").unwrap();
    std::fs::copy(at("a.db-wal"), at("b.db-wal")).unwrap();
    done(&mut memrep(&[
        "restore",
        text(&at("backup.db")),
        "--database",
        text(&at("b.db")),
    ]));
    assert!(!at("b.db-wal").exists());
    assert_eq!(
        Sqlite::open(&at("b.db"))
            .unwrap()
            .read(&session)
            .unwrap()
            .len(),
        1
    );
}

/// A session of every version that was released is there with all that belongs to it,
/// and goes on.
#[test]
fn a_database_of_every_released_version_opens_and_goes_on() {
    let folder = tempfile::tempdir().unwrap();
    let released = [
        (1, "49e2833f13f9b31ccbe73e5bdd7afc88", 10),
        (2, "c364a5ceb7de0076eb77565e5d87f8d9", 6),
        (3, "1055d2b08709d82c2ae8bcfbe57ac12c", 9),
    ];
    for (version, session, entries) in released {
        let database = folder.path().join(format!("{version}.db"));
        std::fs::copy(fixture(version), &database).unwrap();
        let server = Server::at(&database);
        let path = format!("/api/v1/sessions/{session}");
        let log = server.ask("GET", &format!("{path}/log"), &Value::Null);
        assert_eq!(log.body.lines().count(), entries, "version {version}");
        let question = server.ask("GET", &format!("{path}/question"), &Value::Null);
        assert_eq!(question.status, 200, "version {version}: {question:?}");
        drop(server);
        check_backup(&database).unwrap();
    }
    let store = Sqlite::open(&folder.path().join("3.db")).unwrap();
    let session: SessionId = released[2].1.parse().unwrap();
    let upload = store.upload_of(&session).unwrap().unwrap();
    let recordings = store.file(&upload, "recordings").unwrap().unwrap();
    assert_eq!(store.chunk(&recordings, 0).unwrap().len(), 1319);
    let key = "31f07e64cfecfc4a7ded1a3fc0e38028".parse().unwrap();
    assert_eq!(store.invited(&key).unwrap(), Some((session, 1)));
}

fn check_version(database: &Path) -> i64 {
    let connection = rusqlite::Connection::open(database).unwrap();
    let version = connection.pragma_query_value(None, "user_version", |row| row.get(0));
    version.unwrap()
}

fn fixture(version: i64) -> String {
    let folder = env!("CARGO_MANIFEST_DIR");
    format!("{folder}/tests/web/fixtures/version-{version}.db")
}

/// Before a database of an earlier version is brought up to date there is a copy of
/// it, once.
#[test]
fn an_upgrade_leaves_a_copy_of_what_was_there() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    drop(Sqlite::open(&at("new.db")).unwrap());
    let current = check_version(&at("new.db"));
    assert!(current >= 3);
    for version in 1..current {
        let database = at(&format!("{version}.db"));
        std::fs::copy(fixture(version), &database).unwrap();
        drop(Sqlite::open(&database).unwrap());
        drop(Sqlite::open(&database).unwrap());
        let copy = at(&format!("{version}.db.v{version}-backup"));
        assert_eq!(check_backup(&copy).unwrap().version, version);
        let copies = files_in(folder.path());
        let copies = copies
            .iter()
            .filter(|file| text(file).contains(&format!("{version}.db.v")));
        assert_eq!(copies.count(), 1);
    }
    assert!(
        files_in(folder.path())
            .iter()
            .all(|file| !text(file).contains("new.db.v"))
    );
}

/// `cargo nextest run --run-ignored only -E 'test(hundred_thousand)' --no-capture`
#[test]
#[ignore = "a measurement: a hundred thousand entries take a while to write"]
fn a_hundred_thousand_entries_are_backed_up_within_a_second() {
    let folder = tempfile::tempdir().unwrap();
    let database = folder.path().join("a.db");
    drop(Sqlite::open(&database).unwrap());
    let mut connection = rusqlite::Connection::open(&database).unwrap();
    let transaction = connection.transaction().unwrap();
    let body = format!("{{\"event\":\"asked\",\"round\":\"{}\"}}", "x".repeat(350));
    for _ in 0..1000 {
        let session = SessionId::random().unwrap().to_string();
        transaction
            .execute("INSERT INTO sessions (id) VALUES (?1)", [&session])
            .unwrap();
        let mut entry = transaction
            .prepare_cached("INSERT INTO entries (session, seq, body) VALUES (?1, ?2, ?3)")
            .unwrap();
        for seq in 0..100 {
            entry
                .execute(rusqlite::params![session, seq, body])
                .unwrap();
        }
    }
    transaction.commit().unwrap();
    drop(connection);
    let begun = Instant::now();
    let told = back_up(&database, &folder.path().join("b.db")).unwrap();
    let took = begun.elapsed();
    println!(
        "backup of {} entries: {:.2} s",
        told.entries,
        took.as_secs_f64()
    );
    assert_eq!(told.entries, 100_000);
    assert!(took < Duration::from_secs(1), "{took:?}");
}
