//! Whatever an engine says cannot be: of every such answer the facts that it blames are
//! given to a fresh solver, which says so too.
//!
//! 2,000 answers; `MEMREP_UNSAT=400000` looks at so many.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::tests::{add_all, alphabet, random_dfa, random_fact, search};
use super::{batsat_engine, varisat_engine};
use crate::identify::engine::Verdict;
use crate::identify::problem::{FactId, Problem};

/// How many are looked at where nothing else is said.
const ANSWERS: usize = 2000;

#[test]
fn what_is_blamed_for_a_no_cannot_be_for_a_fresh_solver_either() {
    let wanted = match std::env::var("MEMREP_UNSAT") {
        Ok(text) => text
            .parse()
            .unwrap_or_else(|e| panic!("MEMREP_UNSAT={text}: {e}")),
        Err(_) => ANSWERS,
    };
    let mut rng = ChaCha8Rng::seed_from_u64(11);
    let (mut answers, mut found, mut blamed, mut given) = (0, 0_usize, 0, 0);
    while answers < wanted {
        let symbols = rng.random_range(1..=3);
        let states = rng.random_range(2..=5);
        let dfa = random_dfa(&mut rng, symbols, states);
        let mut problem = Problem::new(alphabet(symbols));
        // The same two solvers over all of a session: what they learned stays.
        let mut old = [varisat_engine(), batsat_engine()];
        let mut standing: Vec<FactId> = Vec::new();
        for _ in 0..rng.random_range(2..10) {
            let facts: Vec<_> = (0..rng.random_range(1..5))
                .map(|_| random_fact(&mut rng, &dfa, 6, true))
                .collect();
            standing.extend(add_all(&mut problem, &facts));
            // Somebody takes an answer back.
            if rng.random_ratio(1, 4) && !standing.is_empty() {
                let place = rng.random_range(0..standing.len());
                standing.remove(place);
            }
            let size = rng.random_range(1..=states);
            for (number, engine) in old.iter_mut().enumerate() {
                let Verdict::None { core } = search(&mut **engine, &problem, &standing, size, 1)
                else {
                    found += 1;
                    continue;
                };
                assert!(core.iter().all(|fact| standing.contains(fact)));
                let mut fresh = if number == 0 {
                    batsat_engine()
                } else {
                    varisat_engine()
                };
                let again = search(&mut *fresh, &problem, &core, size, 1);
                assert!(
                    matches!(again, Verdict::None { .. }),
                    "{core:?} of {standing:?} with {size} states: {again:?}"
                );
                answers += 1;
                blamed += core.len();
                given += standing.len();
            }
        }
    }
    println!(
        "{answers} answers that nothing fits, {found} that something does: \
         {blamed} of {given} facts blamed, and a fresh solver found none that fits"
    );
    assert!(
        blamed < given && found > wanted / 10,
        "{blamed} {given} {found}"
    );
}
