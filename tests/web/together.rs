//! Writers who meet at the store share a transaction, and none of them notices.

use std::sync::{Arc, Barrier};

use memrep::store::{SessionId, Sqlite, Store, StoreError};

const WRITERS: u64 = 12;
const EACH: u64 = 20;

#[test]
fn of_many_writers_at_once_each_has_what_is_theirs_and_one_of_two_rivals_wins() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.db");
    let store = Arc::new(Sqlite::open(&path).unwrap());
    let shared = SessionId::random().unwrap();
    let start = Arc::new(Barrier::new(WRITERS as usize));
    let writers: Vec<_> = (0..WRITERS)
        .map(|number| {
            let (store, start) = (Arc::clone(&store), Arc::clone(&start));
            std::thread::spawn(move || {
                let own = SessionId::random().unwrap();
                start.wait();
                let mut won = 0;
                for seq in 0..EACH {
                    store.append(&own, seq, &format!("{number} {seq}")).unwrap();
                    // A gap is refused whoever else is at it.
                    let gap = store.append(&own, seq + 2, "never");
                    assert!(matches!(gap, Err(StoreError::Gap { .. })), "{gap:?}");
                    loop {
                        match store.append(&shared, seq, &number.to_string()) {
                            Ok(()) => won += 1,
                            Err(StoreError::Taken { .. }) => {}
                            // The rivals are not there yet.
                            Err(StoreError::Gap { .. }) => continue,
                            Err(other) => panic!("{other}"),
                        }
                        break;
                    }
                }
                (own, number, won)
            })
        })
        .collect();
    let ends: Vec<(SessionId, u64, u64)> = writers.into_iter().map(|w| w.join().unwrap()).collect();
    drop(store);
    let store = Sqlite::open(&path).unwrap();
    for (own, number, won) in &ends {
        let log = store.read(own).unwrap();
        let bodies: Vec<&str> = log.iter().map(|entry| entry.body.as_str()).collect();
        let expected: Vec<String> = (0..EACH).map(|seq| format!("{number} {seq}")).collect();
        assert_eq!(bodies, expected);
        let shared = store.read(&shared).unwrap();
        let kept = shared
            .iter()
            .filter(|entry| entry.body == number.to_string());
        assert_eq!(kept.count() as u64, *won);
    }
    let won: u64 = ends.iter().map(|(_, _, won)| won).sum();
    assert_eq!(won, EACH);
    assert_eq!(store.count().unwrap(), WRITERS + 1);
}
