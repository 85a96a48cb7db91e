//! The dissertation's robot: the recharge rule is known, the dryer rule is learned,
//! on words and on a grid.

use std::ops::Range;
use std::sync::Arc;

use automata::{Alphabet, Dfa, Word};
use memrep::bench::Report;
use memrep::concept::{Prior, PriorError, Template};
use memrep::learner::{Config, EQUIVALENCE_COST, Strategy};
use memrep::oracle::{Counterexamples, Order, Target, TeacherSettings};
use memrep::world::grid::{GridMap, Labelling};
use memrep::world::{Words, World};

use crate::learn::{agree, learn};

/// Lava, recharge, water and dryer tiles.
const ROOM: &str = "\
....B...
.R..BB..
.RR...Y.
....S...
.O....R.
.OO.B.R.
....B..Y
Y.......";

/// The robot's symbols.
fn symbols() -> Alphabet {
    Alphabet::new(["R", "Y", "B", "O"]).unwrap()
}

fn rules(texts: &[&str]) -> Vec<Dfa> {
    let symbols = symbols();
    let rule = |text: &&str| Template::parse(text, &symbols).unwrap().dfa(&symbols);
    texts.iter().map(rule).collect()
}

/// Never lava, and at some time a recharge tile.
fn recharge() -> Prior {
    Prior::new(&symbols(), rules(&["avoid R", "reach Y"]), Vec::new()).unwrap()
}

fn words() -> Arc<World> {
    Arc::new(World::Words(Words::new(symbols(), 1000)))
}

fn room() -> Arc<World> {
    let map = GridMap::new(&symbols(), ROOM);
    let grid = map.grid(symbols(), Labelling::Entry, 40).unwrap();
    Arc::new(World::Grid(grid))
}

/// Teaches the robot task in a world.
fn run(world: &Arc<World>, strategy: Strategy, seed: u64) -> Report<Dfa> {
    let target = Target::named("robot").unwrap();
    let config = Config {
        strategy,
        seed,
        ..Config::default()
    };
    let teacher = TeacherSettings {
        order: Order::Random,
        counterexamples: Counterexamples::Random,
        error_rate: 0.0,
        seed,
    };
    learn(world, &recharge(), &target, config, teacher)
}

/// What a run costs on average, equivalence queries and all.
fn cost(world: &Arc<World>, strategy: Strategy, seeds: Range<u32>) -> f64 {
    let target = Target::named("robot").unwrap();
    let prior = recharge();
    let runs = f64::from(seeds.end - seeds.start);
    let mut sums = [0.0; 4];
    for seed in seeds {
        let report = run(world, strategy, u64::from(seed));
        let learned = report.learned.expect("500 questions are enough");
        assert!(agree(world, &prior, &learned, target.dfa()), "seed {seed}");
        let whole = prior.whole(&learned);
        assert!(!world.has_word(&whole.xor(target.dfa()).unwrap()));
        let counts = report.counts;
        let costs = [
            f64::from(counts.membership),
            f64::from(counts.comparison),
            f64::from(counts.equivalence),
            report.cost + 4.0 * EQUIVALENCE_COST * f64::from(counts.equivalence),
        ];
        for (sum, cost) in sums.iter_mut().zip(costs) {
            *sum += cost / runs;
        }
    }
    let [membership, comparison, equivalence, all_in] = sums;
    println!(
        "{strategy:?}: {membership:.2} membership, {comparison:.2} comparisons, {equivalence:.2} equivalence, all-in {all_in:.1}"
    );
    all_in
}

/// Every question of every run is feasible and open: `learn` asserts it.
fn check(world: &Arc<World>, seeds: Range<u32>) {
    let bayes = cost(world, Strategy::Bayes, seeds.clone());
    let thesis = cost(world, Strategy::Thesis, seeds);
    println!("{:.2} of it", bayes / thesis);
    assert!(bayes <= 0.6 * thesis, "{bayes} and {thesis}");
}

#[test]
fn the_robot_is_taught_what_it_does_not_know_by_words() {
    check(&words(), 0..4);
}

#[test]
fn the_robot_is_taught_what_it_does_not_know_in_its_room() {
    check(&room(), 4..10);
}

#[test]
fn the_known_rules_and_the_dryer_rule_are_the_robots() {
    let target = Target::named("robot").unwrap();
    let prior = recharge();
    // Fine, wet, dried but not recharged since, and lost: by hand.
    let dryer = [[0, 0, 1, 0], [1, 3, 1, 2], [2, 0, 1, 2], [3, 3, 3, 3]];
    let accepting = vec![true, false, false, false];
    let dryer = Dfa::new(symbols(), 0, accepting, &dryer.map(Vec::from)).unwrap();
    assert!(prior.whole(&dryer).is_equivalent(target.dfa()).unwrap());
    for word in symbols().words_up_to(4) {
        if let Some(label) = prior.settled(&word) {
            assert_eq!(label, target.dfa().accepts(&word));
        }
    }
}

#[test]
fn what_suffices_is_not_asked_and_counts() {
    let symbols = symbols();
    let prior = Prior::new(&symbols, rules(&["avoid R"]), rules(&["reach Y"])).unwrap();
    let word = |names: &str| -> Word { symbols.word(names.chars().map(String::from)).unwrap() };
    assert_eq!(prior.settled(&word("B")), None);
    assert_eq!(prior.settled(&word("BY")), Some(true));
    assert_eq!(prior.settled(&word("RY")), Some(true));
    assert_eq!(prior.settled(&word("RB")), Some(false));
    let nothing = Dfa::new(symbols.clone(), 0, vec![false], &[vec![0; 4]]).unwrap();
    let whole = prior.whole(&nothing);
    for word in symbols.words_up_to(4) {
        let expected = prior.settled(&word).unwrap_or(false);
        assert_eq!(whole.accepts(&word), expected);
    }
}

#[test]
fn a_prior_that_leaves_nothing_is_refused() {
    let refused = |holding: &[&str], sufficing: &[&str]| {
        Prior::new(&symbols(), rules(holding), rules(sufficing)).unwrap_err()
    };
    assert_eq!(refused(&["avoid Y", "reach Y"], &[]), PriorError::Excluded);
    assert_eq!(refused(&["reach Y"], &["reach Y"]), PriorError::NothingOpen);
    let other = Alphabet::new(["Y", "R", "B", "O"]).unwrap();
    let error = Prior::new(&other, rules(&["avoid R"]), Vec::new()).unwrap_err();
    assert_eq!(
        error.to_string(),
        "automaton 1 of those that hold reads {R, Y, B, O}, and the task has {Y, R, B, O}: give it the same symbols in the same order"
    );
}
