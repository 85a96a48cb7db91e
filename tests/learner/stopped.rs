//! Thinking that is stopped ends without a move and leaves no trace.

use std::thread;
use std::time::Duration;

use automata::{Alphabet, Symbol, Word};
use memrep::concept::DfaClass;
use memrep::evidence::{Fact, Stop};
use memrep::identify::{EngineChoice, Settings};
use memrep::learner::{Config, Learner, Strategy};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use crate::finite::config;

/// Words with labels of which no small automaton makes sense: all engines are at
/// work until the budget ends.
fn noise() -> Vec<Fact<Word>> {
    let mut random = ChaCha8Rng::seed_from_u64(7);
    let mut word = || -> Word {
        let length = random.random_range(1..=16);
        let symbols = (0..length).map(|_| Symbol::new(random.random_range(0..2)));
        symbols.collect()
    };
    let mut words: Vec<Word> = (0..400).map(|_| word()).collect();
    words.sort();
    words.dedup();
    let label = |(place, atom): (usize, Word)| Fact::Label {
        atom,
        accepted: place % 3 == 0 || place % 7 == 1,
    };
    words.into_iter().enumerate().map(label).collect()
}

fn hard(strategy: Strategy) -> Learner<DfaClass> {
    let settings = Settings {
        engine: EngineChoice::Auto,
        max_states: 60,
    };
    let class = DfaClass::new(Alphabet::new(["a", "b"]).unwrap(), settings);
    let config = Config {
        budget: 200_000,
        ..config(strategy, 0)
    };
    Learner::new(class, config, noise())
}

#[test]
fn whoever_is_stopped_before_beginning_says_nothing() {
    let stop = Stop::default();
    stop.set();
    assert!(hard(Strategy::Thesis).next_until(&stop).is_none());
    assert!(hard(Strategy::Bayes).next_until(&stop).is_none());
}

#[test]
fn after_a_stop_the_same_is_asked_as_without_one() {
    for strategy in [Strategy::Thesis, Strategy::Bayes] {
        let undisturbed = hard(strategy).next();
        let mut learner = hard(strategy);
        for wait in [0, 1, 5, 20, 80] {
            let stop = Stop::default();
            let other = stop.clone();
            let stopping = thread::spawn(move || {
                thread::sleep(Duration::from_millis(wait));
                other.set();
            });
            let step = learner.next_until(&stop);
            stopping.join().unwrap();
            // On a machine that is fast enough it is done before.
            assert!(step.is_none_or(|step| step == undisturbed), "{strategy:?}");
        }
        assert_eq!(learner.next(), undisturbed, "{strategy:?}");
    }
}
