//! The store keeps what was appended, once, and leaves other files alone.

use std::io::Read;
use std::path::Path;
use std::sync::Arc;

use memrep::store::{CHUNK, InviteKey, NewFile, SessionId, Sqlite, Store, StoreError, UploadId};

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
fn entries_that_belong_together_are_kept_all_or_none() {
    let store = Sqlite::in_memory().unwrap();
    let session = id();
    store.append_all(&session, 0, &["a", "b", "c"]).unwrap();
    let late = store.append_all(&session, 2, &["x", "y", "z"]);
    assert!(matches!(late, Err(StoreError::Taken { seq: 2, .. })));
    let early = store.append_all(&session, 4, &["x", "y"]);
    assert!(matches!(early, Err(StoreError::Gap { seq: 4, .. })));
    store.append_all(&session, 3, &["d", "e"]).unwrap();
    let entries = store.read(&session).unwrap();
    let kept: Vec<(u64, &str)> = entries.iter().map(|e| (e.seq, &*e.body)).collect();
    assert_eq!(kept, [(0, "a"), (1, "b"), (2, "c"), (3, "d"), (4, "e")]);
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

/// A file that an earlier version wrote is brought up to date, keeps its sessions, and
/// takes uploads and invitations.
#[test]
fn files_of_earlier_versions_are_brought_up_to_date() {
    let version_1: &[u8] = include_bytes!("fixtures/version-1.db");
    let version_2: &[u8] = include_bytes!("fixtures/version-2.db");
    brought_up_to_date(version_1, "49e2833f13f9b31ccbe73e5bdd7afc88", 10);
    brought_up_to_date(version_2, "c364a5ceb7de0076eb77565e5d87f8d9", 6);
}

fn brought_up_to_date(file_of_then: &[u8], session: &str, entries_then: usize) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.db");
    std::fs::write(&path, file_of_then).unwrap();
    let old: SessionId = session.parse().unwrap();
    for _ in 0..2 {
        let store = Sqlite::open(&path).unwrap();
        let entries = store.read(&old).unwrap();
        assert_eq!(entries.len(), entries_then);
        assert!(entries[0].body.contains("created"), "{}", entries[0].body);
        assert_eq!(store.upload_of(&old).unwrap(), None);
        assert_eq!(store.list(5).unwrap()[0].id, old);
    }
    let store = Sqlite::open(&path).unwrap();
    let upload = UploadId::random().unwrap();
    let new = id();
    let mut files = [file("a", &[1, 2, 3])].into_iter();
    store
        .begin(&new, "first", &upload, Some(&mut files))
        .unwrap();
    assert_eq!(store.upload_of(&new).unwrap(), Some(upload));
    let version: i64 = rusqlite::Connection::open(&path)
        .unwrap()
        .pragma_query_value(None, "user_version", |row| row.get(0))
        .unwrap();
    assert_eq!(version, 4);
    let key = InviteKey::random().unwrap();
    store.invite(&key, &old, 1).unwrap();
    assert_eq!(store.invited(&key).unwrap(), Some((old, 1)));
}

/// A key opens one person, the last one given; and the file does not have it.
#[test]
fn an_invitation_is_a_key_of_its_own() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.db");
    let store = Sqlite::open(&path).unwrap();
    let (session, other) = (id(), id());
    store.append(&session, 0, "first").unwrap();
    let keys: Vec<InviteKey> = (0..3).map(|_| InviteKey::random().unwrap()).collect();
    assert!(
        store.invite(&keys[0], &other, 1).is_err(),
        "no such session"
    );
    store.invite(&keys[0], &session, 1).unwrap();
    store.invite(&keys[1], &session, 2).unwrap();
    assert_eq!(store.invited(&keys[0]).unwrap(), Some((session, 1)));
    assert_eq!(store.invited(&keys[1]).unwrap(), Some((session, 2)));
    store.invite(&keys[2], &session, 1).unwrap();
    assert_eq!(
        store.invited(&keys[0]).unwrap(),
        None,
        "there is a newer one"
    );
    assert_eq!(store.invited(&keys[2]).unwrap(), Some((session, 1)));
    drop(store);
    let bytes = std::fs::read(&path).unwrap();
    for key in &keys {
        let text = key.to_string();
        let found = bytes
            .windows(text.len())
            .any(|part| part == text.as_bytes());
        assert!(!found, "only its digest is kept");
    }
}

fn file<'a>(name: &str, content: &'a [u8]) -> NewFile<'a> {
    NewFile {
        name: name.to_owned(),
        kind: "text/plain".to_owned(),
        content: Box::new(content),
    }
}

/// A reader that fails after some bytes.
struct Broken(usize);

impl Read for Broken {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        if self.0 == 0 {
            return Err(std::io::Error::other("the disk is gone"));
        }
        let read = self.0.min(buffer.len());
        self.0 -= read;
        Ok(read)
    }
}

/// Files come back byte by byte, in chunks; what fails leaves nothing.
#[test]
fn uploads_are_kept_whole_or_not_at_all() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.db");
    let store = Sqlite::open(&path).unwrap();
    let rows = || -> Vec<i64> {
        let connection = rusqlite::Connection::open(&path).unwrap();
        let count = |table: &&str| {
            let sql = format!("SELECT count(*) FROM {table}");
            connection.query_row(&sql, [], |row| row.get(0)).unwrap()
        };
        let tables = ["sessions", "entries", "uploads", "files", "chunks"];
        tables.iter().map(count).collect()
    };
    let (session, upload) = (id(), UploadId::random().unwrap());
    let long: Vec<u8> = (0..2 * CHUNK + 5).map(|i| (i % 251) as u8).collect();

    let broken = NewFile {
        content: Box::new(Broken(CHUNK + 1)),
        ..file("broken", &[])
    };
    let mut files = [file("whole", &long), broken].into_iter();
    let failed = store.begin(&session, "first", &upload, Some(&mut files));
    assert!(matches!(failed, Err(StoreError::Unread { name, .. }) if name == "broken"));
    let failed = store.begin(&session, "first", &upload, None);
    assert!(matches!(failed, Err(StoreError::NoUpload { .. })));
    assert_eq!(rows(), [0; 5]);

    let mut files = [file("empty", &[]), file("long", &long)].into_iter();
    store
        .begin(&session, "first", &upload, Some(&mut files))
        .unwrap();
    assert_eq!(rows(), [1, 1, 1, 2, 3]);
    let again = store.begin(&session, "first", &upload, None);
    assert!(matches!(again, Err(StoreError::Taken { seq: 0, .. })));
    store.begin(&id(), "second", &upload, None).unwrap();
    assert_eq!(rows(), [2, 2, 1, 2, 3]);

    let found = store.file(&upload, "long").unwrap().unwrap();
    assert_eq!(
        (found.size, &*found.kind),
        (long.len() as u64, "text/plain")
    );
    let chunks = (0..4).map(|place| store.chunk(&found, place).unwrap());
    let chunks: Vec<Vec<u8>> = chunks.collect();
    let lengths: Vec<usize> = chunks.iter().map(Vec::len).collect();
    assert_eq!(lengths, [CHUNK, CHUNK, 5, 0]);
    assert_eq!(chunks.concat(), long);
    let empty = store.file(&upload, "empty").unwrap().unwrap();
    assert_eq!(store.chunk(&empty, 0).unwrap(), Vec::<u8>::new());
    assert_eq!(store.file(&upload, "other").unwrap(), None);
    let other = UploadId::random().unwrap();
    assert_eq!(store.file(&other, "long").unwrap(), None);
    assert_eq!(store.upload_of(&id()).unwrap(), None);
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
        (&newer, "version 99, and this memrep reads version 4"),
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
