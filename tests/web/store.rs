//! The store keeps what was appended, once, and leaves other files alone.

use std::path::Path;
use std::sync::Arc;

use memrep::store::{SessionId, Sqlite, Store, StoreError};

fn id() -> SessionId {
    SessionId::random().unwrap()
}

#[test]
fn entries_are_there_after_reopening() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.db");
    let (one, two) = (id(), id());
    {
        let store = Sqlite::open(&path).unwrap();
        store.append(&one, 0, "first").unwrap();
        store.append(&two, 0, "other").unwrap();
        store.append(&one, 1, "sec\u{0}ond '\"").unwrap();
    }
    let store = Sqlite::open(&path).unwrap();
    let entries = store.read(&one).unwrap();
    let bodies: Vec<&str> = entries.iter().map(|e| e.body.as_str()).collect();
    assert_eq!(bodies, ["first", "sec\u{0}ond '\""]);
    assert_eq!(entries[1].seq, 1);
    assert!(entries[0].at.starts_with("20") && entries[0].at.ends_with('Z'));
    assert!(store.read(&id()).unwrap().is_empty());
    let listed = store.list(10).unwrap();
    assert_eq!(listed.len(), 2);
    let of_one = listed.iter().find(|l| l.id == one).unwrap();
    assert_eq!((of_one.first.seq, of_one.last.seq), (0, 1));
    assert_eq!(store.list(1).unwrap().len(), 1);
}

#[test]
fn numbers_are_given_once_and_without_gaps() {
    let store = Sqlite::in_memory().unwrap();
    let session = id();
    assert!(matches!(
        store.append(&session, 1, ""),
        Err(StoreError::Gap { seq: 1, .. })
    ));
    store.append(&session, 0, "a").unwrap();
    assert!(matches!(
        store.append(&session, 0, "b"),
        Err(StoreError::Taken { seq: 0, .. })
    ));
    assert!(matches!(
        store.append(&session, 2, "b"),
        Err(StoreError::Gap { seq: 2, .. })
    ));
    assert_eq!(store.read(&session).unwrap().len(), 1);
}

#[test]
fn of_writers_that_saw_the_same_one_succeeds() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.db");
    let session = id();
    // Two connections, as two servers on one file would have.
    let stores = [
        Arc::new(Sqlite::open(&path).unwrap()),
        Arc::new(Sqlite::open(&path).unwrap()),
    ];
    stores[0].append(&session, 0, "begin").unwrap();
    for seq in 1..=10 {
        let writers: Vec<_> = (0..6)
            .map(|writer| {
                let store = Arc::clone(&stores[writer % 2]);
                std::thread::spawn(move || store.append(&session, seq, &format!("{writer}")))
            })
            .collect();
        let results: Vec<_> = writers.into_iter().map(|w| w.join().unwrap()).collect();
        let won = results.iter().filter(|r| r.is_ok()).count();
        assert_eq!(won, 1, "{results:?}");
        for result in results {
            assert!(
                matches!(result, Ok(()) | Err(StoreError::Taken { .. })),
                "{result:?}"
            );
        }
    }
    assert_eq!(stores[1].read(&session).unwrap().len(), 11);
}

fn refusal(path: &Path) -> String {
    match Sqlite::open(path) {
        Ok(_) => panic!("{} was opened", path.display()),
        Err(error) => error.to_string(),
    }
}

#[test]
fn other_files_are_refused_and_left_as_they_are() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);

    let text = at("notes.txt");
    std::fs::write(
        &text,
        "dear diary, this is certainly not a database\n".repeat(40),
    )
    .unwrap();

    let foreign = at("foreign.db");
    rusqlite::Connection::open(&foreign)
        .unwrap()
        .execute_batch("CREATE TABLE cookies (id INTEGER)")
        .unwrap();

    let newer = at("newer.db");
    drop(Sqlite::open(&newer).unwrap());
    rusqlite::Connection::open(&newer)
        .unwrap()
        .pragma_update(None, "user_version", 99)
        .unwrap();

    for (path, part) in [
        (
            &text,
            "not an SQLite file; name another file with --database",
        ),
        (&foreign, "a database of another program"),
        (&newer, "version 99, and this memrep reads version 2"),
    ] {
        let before = std::fs::read(path).unwrap();
        let message = refusal(path);
        assert!(message.contains(part), "{message}");
        assert!(message.contains(path.to_str().unwrap()), "{message}");
        assert_eq!(before, std::fs::read(path).unwrap());
    }
    let message = refusal(&at("no/such/folder/a.db"));
    assert!(
        message.contains("check that its folder exists"),
        "{message}"
    );
}
