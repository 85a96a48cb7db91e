//! The store keeps in `PostgreSQL` what it keeps in a file, under the same rules.

use std::sync::Arc;

use memrep::store::{CHUNK, InviteKey, NewFile, Postgres, SessionId, Store, StoreError, UploadId};

use crate::cluster::Cluster;

fn id() -> SessionId {
    SessionId::random().unwrap()
}

fn file<'a>(name: &str, content: &'a [u8]) -> NewFile<'a> {
    NewFile {
        name: name.to_owned(),
        kind: "text/plain".to_owned(),
        content: Box::new(content),
    }
}

#[test]
fn entries_that_belong_together_are_kept_all_or_none() {
    let cluster = Cluster::start();
    let store = Postgres::open(&cluster.database("a")).unwrap();
    let session = id();
    store.append_all(&session, 0, &["a", "b", "c"]).unwrap();
    let again = store.append_all(&session, 0, &["x", "y"]);
    assert!(matches!(again, Err(StoreError::Taken { seq: 0, .. })));
    let late = store.append_all(&session, 2, &["x", "y", "z"]);
    assert!(matches!(late, Err(StoreError::Taken { seq: 2, .. })));
    let early = store.append_all(&session, 4, &["x", "y"]);
    assert!(matches!(early, Err(StoreError::Gap { seq: 4, .. })));
    store.append_all(&session, 3, &["d", "e"]).unwrap();
    let entries = store.read(&session).unwrap();
    let kept: Vec<(u64, &str)> = entries.iter().map(|e| (e.seq, &*e.body)).collect();
    assert_eq!(kept, [(0, "a"), (1, "b"), (2, "c"), (3, "d"), (4, "e")]);
}

/// The database may have been told to acknowledge before the disk has it; a stronger
/// setting of its own is left.
#[test]
fn what_is_acknowledged_is_on_the_disk_whatever_the_database_does_otherwise() {
    let cluster = Cluster::start();
    for (own, expected) in [("off", "on"), ("remote_apply", "remote_apply")] {
        let name = format!("is_{own}");
        let address = cluster.database(&name);
        drop(Postgres::open(&address).unwrap());
        let alter = format!("ALTER DATABASE {name} SET synchronous_commit = {own}");
        cluster.ask(&name, &alter);
        // Writes down how every entry is written.
        cluster.ask(
            &name,
            "CREATE TABLE seen (setting TEXT);
             CREATE FUNCTION look() RETURNS trigger LANGUAGE plpgsql AS
                 'BEGIN INSERT INTO seen VALUES (current_setting(''synchronous_commit''));
                  RETURN NEW; END';
             CREATE TRIGGER look BEFORE INSERT ON entries
                 FOR EACH ROW EXECUTE FUNCTION look();",
        );
        let outside = cluster.ask(&name, "SHOW synchronous_commit");
        assert_eq!(outside, own, "the database's own setting holds elsewhere");
        let store = Postgres::open(&address).unwrap();
        store.append_all(&id(), 0, &["a", "b"]).unwrap();
        let seen = cluster.ask(&name, "SELECT DISTINCT setting FROM seen");
        assert_eq!(seen, expected);
    }
}

#[test]
fn what_was_appended_is_kept_once_in_order_and_without_gaps() {
    let cluster = Cluster::start();
    let address = cluster.database("a");
    let (one, two) = (id(), id());
    {
        let store = Postgres::open(&address).unwrap();
        assert!(matches!(
            store.append(&one, 1, ""),
            Err(StoreError::Gap { seq: 1, .. })
        ));
        store.append(&one, 0, "first").unwrap();
        store.append(&two, 0, "other").unwrap();
        store.append(&one, 1, "second '\" \u{1f600} \\0").unwrap();
        assert!(matches!(
            store.append(&one, 1, "b"),
            Err(StoreError::Taken { seq: 1, .. })
        ));
        assert!(matches!(
            store.append(&one, 0, "b"),
            Err(StoreError::Taken { seq: 0, .. })
        ));
        assert!(matches!(
            store.append(&one, 3, "b"),
            Err(StoreError::Gap { seq: 3, .. })
        ));
    }
    let store = Postgres::open(&address).unwrap();
    let entries = store.read(&one).unwrap();
    let bodies: Vec<&str> = entries.iter().map(|e| e.body.as_str()).collect();
    assert_eq!(bodies, ["first", "second '\" \u{1f600} \\0"]);
    let at = &entries[0].at;
    assert!(
        at.len() == 24 && at.starts_with("20") && at.ends_with('Z'),
        "{at}"
    );
    assert_eq!(store.read_from(&one, 1).unwrap(), entries[1..]);
    assert!(store.read_from(&one, 2).unwrap().is_empty());
    assert!(store.read(&id()).unwrap().is_empty());
    let listed = store.list(10).unwrap();
    assert_eq!(listed[0].id, one, "the latest first");
    assert_eq!((listed[0].first.seq, listed[0].last.seq), (0, 1));
    assert_eq!(
        (store.list(1).unwrap().len(), store.count().unwrap()),
        (1, 2)
    );
    store.probe().unwrap();
    uploads_are_kept_whole_or_not_at_all(&store);
    an_invitation_is_a_key_of_its_own(&store, &one);
}

fn uploads_are_kept_whole_or_not_at_all(store: &Postgres) {
    let (session, upload) = (id(), UploadId::random().unwrap());
    let failed = store.begin(&session, "first", &upload, None);
    assert!(matches!(failed, Err(StoreError::NoUpload { .. })));
    let long: Vec<u8> = (0..2 * CHUNK + 5).map(|i| (i % 251) as u8).collect();
    let broken = NewFile {
        content: Box::new(std::io::Read::chain(&long[..], Broken)),
        ..file("broken", &[])
    };
    let mut files = [file("whole", &long), broken].into_iter();
    let failed = store.begin(&session, "first", &upload, Some(&mut files));
    assert!(matches!(failed, Err(StoreError::Unread { name, .. }) if name == "broken"));
    assert!(store.read(&session).unwrap().is_empty());
    assert_eq!(store.file(&upload, "whole").unwrap(), None);

    let mut files = [file("empty", &[]), file("long", &long)].into_iter();
    store
        .begin(&session, "first", &upload, Some(&mut files))
        .unwrap();
    assert_eq!(store.upload_of(&session).unwrap(), Some(upload));
    let again = store.begin(&session, "first", &upload, None);
    assert!(matches!(again, Err(StoreError::Taken { seq: 0, .. })));
    store.begin(&id(), "second", &upload, None).unwrap();
    let found = store.file(&upload, "long").unwrap().unwrap();
    assert_eq!(found.size, long.len() as u64);
    let chunks: Vec<Vec<u8>> = (0..4)
        .map(|place| store.chunk(&found, place).unwrap())
        .collect();
    assert_eq!(chunks.concat(), long);
    assert!(chunks[3].is_empty());
    assert_eq!(store.upload_of(&id()).unwrap(), None);
}

struct Broken;

impl std::io::Read for Broken {
    fn read(&mut self, _: &mut [u8]) -> std::io::Result<usize> {
        Err(std::io::Error::other("the disk is gone"))
    }
}

fn an_invitation_is_a_key_of_its_own(store: &Postgres, session: &SessionId) {
    let keys: Vec<InviteKey> = (0..3).map(|_| InviteKey::random().unwrap()).collect();
    assert!(store.invite(&keys[0], &id(), 1).is_err(), "no such session");
    store.invite(&keys[0], session, 1).unwrap();
    store.invite(&keys[1], session, 2).unwrap();
    store.invite(&keys[2], session, 1).unwrap();
    assert_eq!(
        store.invited(&keys[0]).unwrap(),
        None,
        "there is a newer one"
    );
    assert_eq!(store.invited(&keys[1]).unwrap(), Some((*session, 2)));
    assert_eq!(store.invited(&keys[2]).unwrap(), Some((*session, 1)));
}

#[test]
fn of_writers_and_of_servers_that_start_at_once_one_is_first() {
    let cluster = Cluster::start();
    let address = cluster.database("a");
    // All find no tables, and one makes them.
    let starting: Vec<_> = (0..4)
        .map(|_| {
            let address = address.clone();
            std::thread::spawn(move || Arc::new(Postgres::open(&address).unwrap()))
        })
        .collect();
    let stores: Vec<Arc<Postgres>> = starting.into_iter().map(|s| s.join().unwrap()).collect();
    let made_twice = "SELECT count(*) - count(DISTINCT version) FROM memrep_versions";
    assert_eq!(cluster.ask("a", made_twice), "0");
    let steps = "SELECT count(*) = max(version) FROM memrep_versions";
    assert_eq!(cluster.ask("a", steps), "t");
    let session = id();
    for seq in 0..=15 {
        let writers: Vec<_> = (0..8)
            .map(|writer| {
                let store = Arc::clone(&stores[writer % 4]);
                std::thread::spawn(move || store.append(&session, seq, &format!("{writer}")))
            })
            .collect();
        let results: Vec<_> = writers.into_iter().map(|w| w.join().unwrap()).collect();
        let won = results.iter().filter(|r| r.is_ok()).count();
        assert_eq!(won, 1, "{results:?}");
        let known =
            |r: &Result<(), StoreError>| matches!(r, Ok(()) | Err(StoreError::Taken { .. }));
        assert!(results.iter().all(known), "{results:?}");
    }
    assert_eq!(stores[3].read(&session).unwrap().len(), 16);

    // What is not ours, or of a later version, is refused and left alone.
    let refusal = |address: &str| match Postgres::open(address) {
        Ok(_) => panic!("{address} was opened"),
        Err(error) => error.to_string(),
    };
    cluster.ask("a", "INSERT INTO memrep_versions VALUES (99)");
    assert!(refusal(&address).contains("of version 99"));
    let foreign = cluster.database("b");
    cluster.ask("b", "CREATE TABLE sessions (cookie TEXT)");
    assert!(refusal(&foreign).contains("another program"));
    assert_eq!(
        cluster.ask("b", "SELECT to_regclass('entries') IS NULL"),
        "t"
    );
    let wrong = foreign
        .replace("/b", "/none")
        .replace("memrep@", "memrep:hidden@");
    let said = refusal(&wrong);
    assert!(said.contains("none") && !said.contains("hidden"), "{said}");
    assert!(refusal("postgres://").contains("HOST"));
}
