//! A disk that is full: said so, nothing damaged, and once there is room it goes on.

use std::path::Path;
use std::process::Command;

use memrep::store::{SessionId, Sqlite, Store, StoreError};
use serde_json::{Value, json};

use crate::server::{Server, answer, answers_in, assert_sound, memrep};

/// The database that other tests fill until this limit, deterministic on every
/// machine.
#[test]
fn an_append_for_which_there_is_no_room_changes_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.db");
    let session = SessionId::random().unwrap();
    let store = Sqlite::open(&path).unwrap();
    store.append(&session, 0, "first").unwrap();
    store.limit(40 * 4096).unwrap();
    let body = "x".repeat(1500);
    let (kept, error) = (1..)
        .find_map(|seq| {
            let error = store.append(&session, seq, &body).err()?;
            Some((seq, error))
        })
        .unwrap();
    assert!(matches!(error, StoreError::Full { .. }), "{error}");
    assert!(kept > 10);
    assert_eq!(store.read(&session).unwrap().len() as u64, kept);
    assert_sound(&path);
    store.limit(400 * 4096).unwrap();
    store.append(&session, kept, &body).unwrap();
    assert_eq!(store.read(&session).unwrap().len() as u64, kept + 1);
}

/// A file without a name, or under another one, takes what is written and is not there
/// at the next start.
#[test]
#[cfg(unix)]
fn a_database_that_is_taken_away_takes_no_answers() {
    let folder = tempfile::tempdir().unwrap();
    let (path, away) = (folder.path().join("a.db"), folder.path().join("away.db"));
    let server = Server::at(&path);
    let created = server.json("POST", "/api/v1/sessions", &json!({"task": "tomita:4"}));
    let session = format!("/api/v1/sessions/{}", created["id"].as_str().unwrap());
    let question = server.json("GET", &format!("{session}/question"), &Value::Null);
    let said = answer(&question).unwrap();
    std::fs::rename(&path, &away).unwrap();
    for other in [None, Some("of something else")] {
        if let Some(other) = other {
            std::fs::write(&path, other).unwrap();
        }
        let refused = server.ask("POST", &format!("{session}/answers"), &said);
        assert_eq!(refused.status, 503, "{}", refused.body);
        let message = refused.json()["error"]["message"].to_string();
        assert!(message.contains("reached"), "{message}");
        assert_eq!(server.ask("GET", "/healthz", &Value::Null).status, 503);
    }
    std::fs::rename(&away, &path).unwrap();
    let next = server.json("POST", &format!("{session}/answers"), &said);
    assert_ne!(next["number"], question["number"], "{next}");
    drop(server);
    let again = Server::at(&path);
    let open = again.json("GET", &format!("{session}/question"), &Value::Null);
    assert_eq!(open, next);
    drop(again);
    assert_sound(&path);
}

/// A file system of its own that is small; gone when this goes.
struct SmallDisk<'a>(&'a Path);

impl<'a> SmallDisk<'a> {
    /// None where the machine does not let us mount.
    fn mount(folder: &'a Path) -> Option<Self> {
        let mut mount = Command::new("mount");
        mount
            .args(["-t", "tmpfs", "-o", "size=1m", "tmpfs"])
            .arg(folder);
        let done = mount.output().is_ok_and(|output| output.status.success());
        done.then_some(Self(folder))
    }
}

impl Drop for SmallDisk<'_> {
    fn drop(&mut self) {
        let _ = Command::new("umount").arg(self.0).status();
    }
}

/// Answers until the server refuses: the acknowledged answers, and the refusal.
fn answer_until_refused(server: &Server, path: &str) -> (usize, Value, Value) {
    let mut question = server.json("GET", &format!("{path}/question"), &Value::Null);
    for acknowledged in 0..2000 {
        let body = answer(&question).expect("the disk is full before the session ends");
        let reply = server.ask("POST", &format!("{path}/answers"), &body);
        if reply.status != 200 {
            assert_eq!(reply.status, 507, "{reply:?}");
            return (acknowledged, body, reply.json());
        }
        question = reply.json();
    }
    panic!("the disk never became full");
}

/// Fills the disk, answers until that is noticed, makes room, goes on.
fn goes_on_once_there_is_room(
    server: &mut Server,
    database: &Path,
    fill: impl FnOnce(),
    make_room: impl FnOnce(&Server),
) {
    let created = server.json("POST", "/api/v1/sessions", &json!({"task": "tomita:4"}));
    let path = format!("/api/v1/sessions/{}", created["id"].as_str().unwrap());
    server.json("GET", &format!("{path}/question"), &Value::Null);
    fill();
    let (acknowledged, refused, reply) = answer_until_refused(server, &path);
    assert_eq!(reply["error"]["code"], "disk_full", "{reply}");
    let message = reply["error"]["message"].as_str().unwrap();
    assert!(
        message.contains("Free space") && message.contains("send it again"),
        "{message}"
    );
    // The page says the same, and what was kept can still be read.
    let page = server.ask("POST", "/sessions", &json!("task=tomita:4"));
    assert_eq!(page.status, 507, "{page:?}");
    assert!(page.body.contains("The disk is full") && page.body.contains("send it again"));
    let log = server.ask("GET", &format!("{path}/log"), &Value::Null);
    assert!(answers_in(&log.body).len() >= acknowledged, "{log:?}");
    assert_sound(database);

    make_room(server);
    let again = server.ask("POST", &format!("{path}/answers"), &refused);
    assert_eq!(again.status, 200, "{again:?}");
    let log = server.ask("GET", &format!("{path}/log"), &Value::Null);
    assert_eq!(answers_in(&log.body).len(), acknowledged + 1);
    server.kill();
    assert_sound(database);
    println!(
        "{acknowledged} answers, then 507; after there was room all of them and the one sent again"
    );
}

#[test]
fn on_a_full_disk_it_says_so_and_goes_on_once_there_is_room() {
    let folder = tempfile::tempdir().unwrap();
    let Some(disk) = SmallDisk::mount(folder.path()) else {
        println!("SKIPPED: this machine lets nobody mount a small disk");
        return;
    };
    let database = disk.0.join("a.db");
    let mut server = Server::at(&database);
    let ballast = disk.0.join("ballast");
    let fill = || {
        // Until the last byte: the error is what this is for.
        let full = std::fs::write(&ballast, vec![0; 2 << 20]);
        assert!(full.is_err(), "the disk is larger than it should be");
    };
    goes_on_once_there_is_room(&mut server, &database, fill, |_| {
        std::fs::remove_file(&ballast).unwrap();
    });
}

/// The same where no mount is allowed: files of this process may not grow beyond a
/// limit, which another program lifts.
#[test]
fn files_that_may_not_grow_are_a_full_disk() {
    let folder = tempfile::tempdir().unwrap();
    let database = folder.path().join("a.db");
    if !Command::new("prlimit")
        .arg("--version")
        .output()
        .is_ok_and(|out| out.status.success())
    {
        println!("SKIPPED: this machine has no prlimit");
        return;
    }
    // The signal that a file is too large would end the process; a shell ignores it
    // and hands that down.
    let mut shell = Command::new("sh");
    let binary = memrep(&[]);
    shell
        .args(["-c", "trap '' XFSZ; exec \"$0\" \"$@\""])
        .arg(binary.get_program());
    let mut server = Server::start(shell, database.to_str().unwrap());
    let limit = |server: u32, bytes: &str| {
        let mut prlimit = Command::new("prlimit");
        prlimit.args([
            "--pid",
            &server.to_string(),
            &format!("--fsize={bytes}:unlimited"),
        ]);
        assert!(prlimit.status().unwrap().success());
    };
    let pid = server.child.id();
    goes_on_once_there_is_room(
        &mut server,
        &database,
        || limit(pid, "70000"),
        |server| {
            limit(server.child.id(), "unlimited");
        },
    );
}
