//! How often somebody may do something: a bucket of tokens each, that fills slowly.

use std::collections::HashMap;
use std::hash::Hash;
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// So many are known at once.
const MOST: usize = 10_000;

/// So many at once, and then one in so much time, for each that asks.
pub(crate) struct Budget<K> {
    burst: u32,
    every: Duration,
    /// When the bucket of each would be full again; whose is full is not in it.
    full_at: Mutex<HashMap<K, Instant>>,
}

impl<K: Hash + Eq + Clone> Budget<K> {
    pub(crate) fn new(burst: u32, every: Duration) -> Self {
        Self {
            burst,
            every,
            full_at: Mutex::default(),
        }
    }

    /// Takes so many, or none and says how long to wait for them.
    pub(crate) fn take(&self, who: &K, amount: u32, now: Instant) -> Result<(), Duration> {
        let mut full_at = self.full_at();
        if full_at.len() >= MOST && !full_at.contains_key(who) {
            make_room(&mut full_at, now);
        }
        let full = full_at.get(who).map_or(now, |full| (*full).max(now));
        let next = full + self.every * amount;
        // An empty bucket is full after `burst` times `every`.
        let over = next.saturating_duration_since(now + self.every * self.burst);
        if over > Duration::ZERO {
            return Err(over);
        }
        full_at.insert(who.clone(), next);
        Ok(())
    }

    /// Gives back what was taken.
    pub(crate) fn give_back(&self, who: &K, amount: u32) {
        if let Some(full) = self.full_at().get_mut(who)
            && let Some(earlier) = full.checked_sub(self.every * amount)
        {
            *full = earlier;
        }
    }

    fn full_at(&self) -> MutexGuard<'_, HashMap<K, Instant>> {
        self.full_at.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Forgets who has a full bucket; if nobody has, those who are nearest to it.
fn make_room<K: Hash + Eq + Clone>(full_at: &mut HashMap<K, Instant>, now: Instant) {
    full_at.retain(|_, full| *full > now);
    if full_at.len() < MOST {
        return;
    }
    let mut times: Vec<Instant> = full_at.values().copied().collect();
    let (_, middle, _) = times.select_nth_unstable(MOST / 10);
    let middle = *middle;
    full_at.retain(|_, full| *full > middle);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ten_at_once_and_then_one_a_minute() {
        let budget = Budget::new(10, Duration::from_secs(60));
        let start = Instant::now();
        for _ in 0..10 {
            assert_eq!(budget.take(&"a", 1, start), Ok(()));
        }
        assert_eq!(budget.take(&"a", 1, start), Err(Duration::from_secs(60)));
        assert_eq!(
            budget.take(&"b", 1, start),
            Ok(()),
            "everybody has their own"
        );
        let soon = start + Duration::from_secs(59);
        assert_eq!(budget.take(&"a", 1, soon), Err(Duration::from_secs(1)));
        let then = start + Duration::from_secs(60);
        assert_eq!(budget.take(&"a", 1, then), Ok(()));
        assert!(budget.take(&"a", 1, then).is_err());
        let later = start + Duration::from_secs(3600);
        for _ in 0..10 {
            assert_eq!(
                budget.take(&"a", 1, later),
                Ok(()),
                "full again, and no fuller"
            );
        }
        assert!(budget.take(&"a", 1, later).is_err());
    }

    #[test]
    fn however_many_ask_few_are_known_and_those_who_asked_most_stay_known() {
        let budget = Budget::new(3, Duration::from_secs(60));
        let now = Instant::now();
        while budget.take(&u32::MAX, 1, now).is_ok() {}
        for who in 0..3 * MOST as u32 {
            let _ = budget.take(&who, 1, now);
            assert!(budget.full_at().len() <= MOST);
        }
        assert!(budget.take(&u32::MAX, 1, now).is_err());
    }
}
