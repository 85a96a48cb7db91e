//! The log is enough: random sessions of every kind are rebuilt from their logs, as
//! after a restart, and ask next what they had asked, byte for byte; and an answer
//! that was taken back leaves no trace in what is asked.
//!
//! `MEMREP_SESSIONS=1000` runs so many of them; `MEMREP_SESSION=17` that one alone.

mod checks;
mod drawn;
mod life;

use rand::RngExt;
use rayon::prelude::*;

use crate::life::{Life, Seen};

/// How many run where nothing else is said.
const SESSIONS: u64 = 100;

/// Lives through a session, and checks at random places what must hold.
fn live(seed: u64) -> Seen {
    let mut life = Life::begin(seed);
    let shared = seed % 4 == 3;
    if shared {
        for name in ["Ada", "Bo"] {
            let decided = life.session.invite(name, None);
            life.act("invited", decided);
        }
    }
    // Of several people each has a part of the turns.
    let most = if shared { 60 } else { 24 };
    for turn in 0..life.random.random_range(6..most) {
        if shared {
            life.shared_turn();
        } else {
            life.turn();
        }
        if turn % 3 == 0 {
            life.check_rebuilt();
            life.check_traceless();
        }
    }
    life.check_rebuilt();
    life.check_traceless();
    life.seen
}

fn told(variable: &str) -> Option<u64> {
    let told = std::env::var(variable).ok()?;
    Some(
        told.parse()
            .unwrap_or_else(|_| panic!("{variable} is a number")),
    )
}

#[test]
fn sessions_are_rebuilt_from_their_logs_and_forget_what_was_taken_back() {
    let seeds = match told("MEMREP_SESSION") {
        Some(seed) => seed..seed + 1,
        None => 0..told("MEMREP_SESSIONS").unwrap_or(SESSIONS),
    };
    let alone = seeds.end - seeds.start == 1;
    let seen: Seen = seeds
        .into_par_iter()
        .map(|seed| {
            let lived = std::panic::catch_unwind(|| live(seed));
            lived.unwrap_or_else(|_| panic!("once more with MEMREP_SESSION={seed}"))
        })
        .reduce(Seen::new, |mut all, one| {
            for (what, times) in one {
                *all.entry(what).or_default() += times;
            }
            all
        });
    eprintln!("{seen:?}");
    if alone {
        return;
    }
    for what in [
        "answered",
        "retracted",
        "changed",
        "undone",
        "skipped",
        "enlarged",
        "conflict",
        "said",
        "unsaid",
        "terms",
        "further",
        "repeated",
        "rebuilt",
        "traceless",
    ] {
        assert!(
            seen.get(what).is_some_and(|times| *times > 0),
            "{what}: {seen:?}"
        );
    }
}
