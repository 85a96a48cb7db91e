//! What chains visited, and what that says of the whole posterior.
//!
//! How likely a visited automaton is, is known exactly; how many there are that
//! nobody visited is not. Where automata are many and each is unlikely, chains
//! never come to the same one twice, and what they missed outweighs what they
//! met. How much they missed is seen from what only one of them came to (Chao,
//! "Estimating the population size for capture-recapture data with unequal
//! catchability", 1987).

use std::collections::BTreeMap;

use super::chain::Machine;
use super::memo::{self, Memo};
use super::{AGREEING, LADDERS, NEAR, numberings};
use crate::identify::completion::{Table, breadth_first};
use crate::identify::spread::is_minimal;

/// A share of the posterior that does not matter.
const NEGLIGIBLE: f64 = 1e-7;
/// Automata of one size whose chances have logarithms that differ by less are
/// taken for equally easy to come to.
const ALIKE: f64 = 3.0;

/// The consistent automata that ladders visited.
#[derive(Default)]
pub(super) struct Visits {
    /// The logarithm of its chance, and a bit for every ladder that was there.
    seen: BTreeMap<Table, (f64, u32)>,
    /// The largest such logarithm of every ladder.
    best: [Option<f64>; LADDERS],
    /// What every ladder visited lately: once is as good as often.
    lately: [Memo<(), 8>; LADDERS],
    /// Room for the next table.
    spare: Table,
}

/// Of automata that are alike, how many were seen at all, by one ladder only, and
/// by exactly two.
#[derive(Clone, Copy, Default)]
struct Seen {
    all: u32,
    once: u32,
    twice: u32,
}

impl Visits {
    /// Takes note of a visit; of automata that are refuted or not minimal none is
    /// taken.
    pub(super) fn add(&mut self, ladder: usize, machine: &Machine) {
        if machine.standing.refuted {
            return;
        }
        if let Some(key) = memo::key(&machine.delta, &machine.output) {
            let lately = &mut self.lately[ladder];
            if lately.get(key).is_some() {
                return;
            }
            lately.keep(key, ());
        }
        let (delta, output) = &mut self.spare;
        delta.clear();
        delta.extend(machine.delta.iter().map(|&target| u32::from(target)));
        output.clone_from(&machine.output);
        if is_minimal(&self.spare) {
            let chance = machine.log_chance() + numberings(machine.states());
            let seen = self.seen.entry(breadth_first(&self.spare));
            seen.or_insert((chance, 0)).1 |= 1 << ladder;
            let best = self.best[ladder].get_or_insert(chance);
            *best = best.max(chance);
        }
    }

    /// Whether most ladders came to something nearly as likely as the likeliest
    /// of all.
    pub(super) fn agree(&self) -> bool {
        let best = self.best.iter().flatten();
        let top = best.clone().copied().fold(f64::NEG_INFINITY, f64::max);
        best.filter(|best| **best > top - NEAR).count() >= AGREEING
    }

    /// The chances of all that was visited, up to a number that all share; each
    /// stands for those like it that nobody came to.
    pub(super) fn shares(self) -> BTreeMap<Table, f64> {
        // Chances are at most a few thousand nats.
        let kind = |table: &Table, chance: f64| (table.1.len(), (chance / ALIKE).floor() as i64);
        let mut kinds: BTreeMap<(usize, i64), Seen> = BTreeMap::new();
        for (table, &(chance, ladders)) in &self.seen {
            let seen = kinds.entry(kind(table, chance)).or_default();
            seen.all += 1;
            match ladders.count_ones() {
                1 => seen.once += 1,
                2 => seen.twice += 1,
                _ => {}
            }
        }
        let top = (self.seen.values().map(|(chance, _)| *chance)).fold(f64::NEG_INFINITY, f64::max);
        let weighted = self.seen.into_iter().map(|(table, (chance, _))| {
            let stands_for = kinds[&kind(&table, chance)].richness();
            (table, (chance - top).exp() * stands_for)
        });
        weighted.filter(|(_, share)| *share > NEGLIGIBLE).collect()
    }
}

impl Seen {
    /// How many there are, over how many were seen: Chao's estimate from visits
    /// by several ladders, with the correction that needs no pair.
    fn richness(self) -> f64 {
        let [all, once, twice] = [self.all, self.once, self.twice].map(f64::from);
        let ladders = LADDERS as f64;
        let missed = (ladders - 1.0) / ladders * once * (once - 1.0) / (2.0 * (twice + 1.0));
        1.0 + missed.max(0.0) / all
    }
}

#[cfg(test)]
mod tests {
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    use super::*;

    /// Of 1,000 that are alike every ladder comes to a tenth.
    #[test]
    fn what_nobody_saw_is_counted_in() {
        let mut rng = ChaCha8Rng::seed_from_u64(7);
        let mut seen = Seen::default();
        for _ in 0..1000 {
            let ladders = (0..LADDERS).filter(|_| rng.random_ratio(1, 10)).count();
            seen.all += u32::from(ladders > 0);
            seen.once += u32::from(ladders == 1);
            seen.twice += u32::from(ladders == 2);
        }
        let estimate = f64::from(seen.all) * seen.richness();
        assert!(seen.all < 700, "{}", seen.all);
        assert!((800.0..1250.0).contains(&estimate), "{estimate}");
    }
}
