//! Power that goes while the write-ahead log is written leaves a torn end: what was
//! acknowledged lies before it.
//!
//! `SQLite` acknowledges a commit once its frames are synced. A torn end therefore
//! belongs to a commit that nobody was told of, and must be passed over.

use std::fs::{self, OpenOptions};
use std::io::Write as _;
use std::path::PathBuf;

use memrep::store::{SessionId, Sqlite, Store};
use rand::{Rng as _, RngExt as _, SeedableRng as _};
use rand_chacha::ChaCha8Rng;

use crate::server::assert_sound;

const PAGE: usize = 4096;
/// A frame of the log is a head and a page.
const FRAME: usize = 24 + PAGE;
const HEAD: usize = 32;

#[test]
fn a_torn_end_of_the_log_takes_nothing_that_was_acknowledged() {
    let seed = u64::from(std::process::id());
    println!("seed {seed}");
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let folder = tempfile::tempdir().unwrap();
    let session = SessionId::random().unwrap();
    let mut told = 0;
    for round in 0..60 {
        // What lies on the disk when the power goes: the files, while the store is
        // still open and has written nothing back.
        let live = folder.path().join(format!("{round}.db"));
        let dead = folder.path().join(format!("{round}-dead.db"));
        let wal = |path: &PathBuf| PathBuf::from(format!("{}-wal", path.display()));
        let store = Sqlite::open(&live).unwrap();
        let entries = rng.random_range(1..40_u64);
        for seq in 0..entries {
            store
                .append(&session, seq, &format!("entry {seq}"))
                .unwrap();
        }
        fs::copy(&live, &dead).unwrap();
        fs::copy(wal(&live), wal(&dead)).unwrap();
        let acknowledged = fs::metadata(wal(&dead)).unwrap().len() as usize;
        assert_eq!((acknowledged - HEAD) % FRAME, 0);

        // One more commit, of which only a part reached the disk; or what looks like
        // one, or anything else.
        store
            .append(&session, entries, "never acknowledged")
            .unwrap();
        let whole = fs::read(wal(&live)).unwrap();
        drop(store);
        let new = &whole[acknowledged.min(whole.len())..];
        let mut torn = match round % 3 {
            0 => new[..rng.random_range(0..new.len().max(1))].to_vec(),
            1 => {
                // Of the right length, but some sectors are not what was written.
                let mut torn = new.to_vec();
                let from = rng.random_range(0..torn.len());
                let sector = torn.len().min(from + 512);
                rng.fill_bytes(&mut torn[from..sector]);
                torn
            }
            _ => vec![0; rng.random_range(1..3 * FRAME)],
        };
        if round % 3 == 2 {
            rng.fill_bytes(&mut torn);
        }
        let mut log = OpenOptions::new().append(true).open(wal(&dead)).unwrap();
        log.write_all(&torn).unwrap();
        drop(log);

        let store = Sqlite::open(&dead).unwrap();
        let read = store.read(&session).unwrap();
        assert!(read.len() as u64 >= entries, "{} of {entries}", read.len());
        for (entry, seq) in read.iter().zip(0..entries) {
            assert_eq!((entry.seq, &*entry.body), (seq, &*format!("entry {seq}")));
        }
        assert!(
            read.len() as u64 <= entries,
            "half a commit was taken for one"
        );
        assert_sound(&dead);
        // It goes on.
        store
            .append(&session, entries, "after the power came back")
            .unwrap();
        told += entries;
    }
    println!("60 torn logs: {told} acknowledged entries, all there");
}
