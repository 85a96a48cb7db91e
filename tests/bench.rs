//! The figures of the experiments, against the same counted by hand.

use std::time::Duration;

use memrep::bench::{
    CONTENDERS, Contender, Experiment, Plan, Results, Run, Uncertainty, ratio, spread,
};
use memrep::learner::{Counts, Strategy};
use memrep::oracle::{Counterexamples, Order, Shape, Target};

fn close(left: f64, right: f64) -> bool {
    (left - right).abs() < 1e-9
}

fn plan(targets: &[&str]) -> Plan {
    Plan {
        experiment: Experiment::Tomita,
        targets: targets
            .iter()
            .map(|name| Target::named(name).unwrap().into())
            .collect(),
        contenders: ["bayes", "thesis"]
            .map(|key| Contender::of(key).unwrap())
            .to_vec(),
        costs: vec![Some(4), None],
        errors: vec![0],
        seed: 0,
        trials: 2,
        order: Order::Ordered,
        counterexamples: Counterexamples::Random,
    }
}

fn run(target: usize, contender: &'static str, seed: u64, counts: [u32; 3]) -> Run {
    Run {
        target,
        contender,
        cost: Some(4),
        errors: 0,
        seed,
        equivalent: true,
        counts: Counts {
            membership: counts[0],
            comparison: counts[1],
            equivalence: counts[2],
            ..Counts::default()
        },
        dropped: 0,
        hurried: 0,
        question_times: vec![Duration::from_millis(1)],
    }
}

/// Two targets, two seeds, two contenders: every number here was worked out by
/// hand.
#[test]
fn summaries_are_as_counted_by_hand() {
    let results = Results {
        plan: plan(&["tomita:1", "tomita:2"]),
        runs: vec![
            run(0, "bayes", 0, [1, 4, 1]),  // 4 + 4 + 16 = 24
            run(0, "bayes", 1, [0, 8, 2]),  // 8 + 32 = 40
            run(0, "thesis", 0, [4, 0, 2]), // 16 + 32 = 48
            run(0, "thesis", 1, [8, 0, 3]), // 32 + 48 = 80
            run(1, "bayes", 0, [2, 2, 1]),  // 10 + 16 = 26
            run(1, "bayes", 1, [2, 2, 1]),
            run(1, "thesis", 0, [2, 1, 1]), // 9 + 16 = 25
            run(1, "thesis", 1, [3, 2, 1]), // 14 + 16 = 30 (mean 27.5)
        ],
    };
    let groups = results.groups();
    let cell = results.cell(&groups[0], "bayes", Some(4), 0);
    let all_in = cell.spread(Run::all_in).unwrap();
    assert!(close(all_in.mean, 32.0));
    assert!(close(all_in.deviation, 128.0_f64.sqrt()));
    let paid = cell.spread(Run::paid).unwrap();
    assert!(close(paid.mean, 8.0) && close(paid.deviation, 0.0));

    // 32/64 and 26/27.5; 8/24 and 10/11.5.
    let all_in = results.against_base("bayes", Some(4), Run::all_in).unwrap();
    assert!(close(all_in.ratio, (0.5 * 26.0 / 27.5_f64).sqrt()));
    let paid = results.against_base("bayes", Some(4), Run::paid).unwrap();
    assert!(close(paid.ratio, (8.0 / 24.0 * 10.0 / 11.5_f64).sqrt()));
    // The extremes of resampling the seeds: each seed twice.
    let (low, high) = all_in.interval;
    let extreme = |x: f64| (0.5 * x).sqrt();
    assert!(low >= extreme(26.0 / 30.0) - 1e-9 && high <= extreme(26.0 / 25.0) + 1e-9);
    assert!(low < all_in.ratio && all_in.ratio < high);

    // Nobody ran without comparisons, and nobody beats itself.
    assert_eq!(results.against_base("bayes", None, Run::all_in), None);
    let own = results
        .against_base("thesis", Some(4), Run::all_in)
        .unwrap();
    assert!(close(own.ratio, 1.0) && close(own.interval.0, 1.0) && close(own.interval.1, 1.0));
}

#[test]
fn spreads_and_ratios_have_their_edges() {
    assert_eq!(spread(&[]), None);
    assert!(close(spread(&[3.0]).unwrap().deviation, 0.0));
    let four = spread(&[2.0, 4.0, 4.0, 6.0]).unwrap();
    assert!(close(four.mean, 4.0) && close(four.deviation, (8.0_f64 / 3.0).sqrt()));

    assert_eq!(ratio(&[], Uncertainty::Runs), None);
    assert_eq!(ratio(&[vec![]], Uncertainty::Runs), None);
    // Something against nothing is no ratio; nothing against something is 0.
    assert_eq!(ratio(&[vec![(1.0, 0.0)]], Uncertainty::Runs), None);
    let nothing = ratio(&[vec![(0.0, 1.0)], vec![(2.0, 1.0)]], Uncertainty::Runs).unwrap();
    assert!(close(nothing.ratio, 0.0));
    // Where targets are drawn, the interval tells how they differ: with one run
    // a target, drawing runs anew changes nothing.
    let targets = [vec![(1.0, 4.0)], vec![(1.0, 1.0)]];
    let fixed = ratio(&targets, Uncertainty::Runs).unwrap();
    assert!(close(fixed.interval.0, 0.5) && close(fixed.interval.1, 0.5));
    let drawn = ratio(&targets, Uncertainty::TargetsAndRuns).unwrap();
    assert!(close(drawn.ratio, 0.5));
    assert!(close(drawn.interval.0, 0.25) && close(drawn.interval.1, 1.0));
}

#[test]
fn contenders_are_told_what_their_names_say() {
    let config = |key: &str, cost| Contender::of(key).unwrap().config(cost, 3);
    assert_eq!(config("bayes", Some(2)).strategy, Strategy::Bayes);
    assert!(close(config("bayes", Some(2)).equivalence_cost, 8.0));
    assert!(close(config("bayes-eager", Some(2)).equivalence_cost, 2.35));
    assert!(config("bayes-robust", Some(2)).robust);
    assert_eq!(config("exp4+", Some(8)).strategy, Strategy::Exp4Plus);
    assert_eq!(config("thesis", Some(8)).strategy, Strategy::Thesis);
    assert!(config("thesis", None).comparison_cost.is_infinite());
    assert_eq!(config("membership", Some(8)).strategy, Strategy::Membership);
    for contender in CONTENDERS {
        let same = CONTENDERS.iter().filter(|other| other.key == contender.key);
        assert_eq!(same.count(), 1, "{}", contender.key);
        let told = contender.config(Some(1), 3);
        assert!(!told.shortest_counterexamples && told.seed == 3);
        assert!(contender.clean || contender.noisy, "{}", contender.key);
    }
    let robust = Contender::of("bayes-robust").unwrap();
    assert_eq!(robust.plain().unwrap().key, "bayes");
    assert_eq!(
        Contender::of("thesis").unwrap().plain().unwrap().key,
        "thesis"
    );
}

/// Drawn targets are minimal, of the promised shape, different, and the same
/// for the same number.
#[test]
fn drawn_targets_have_their_shape() {
    let mut sizes = std::collections::BTreeSet::new();
    for number in 0..100 {
        let random = Target::drawn(Shape::Random, number);
        let task = Target::drawn(Shape::Task, number);
        assert_eq!(random.name(), format!("random:{number}"));
        for (target, fewest) in [(&random, 2), (&task, 3)] {
            let dfa = target.dfa();
            assert!((3..=8).contains(&dfa.size()), "{}", target.name());
            assert!((fewest..=4).contains(&dfa.alphabet().len()));
            assert_eq!(dfa.minimise().size(), dfa.size());
            assert!(target.known().is_empty());
            let again = Target::named(target.name()).unwrap();
            assert_eq!(again.dfa(), dfa);
        }
        sizes.insert((random.dfa().size(), random.dfa().alphabet().len()));
        let dfa = task.dfa();
        let sink = dfa.states().find(|&state| {
            let mut next = dfa
                .alphabet()
                .symbols()
                .map(|symbol| dfa.next(state, symbol));
            !dfa.is_accepting(state) && next.all(|next| next == state)
        });
        assert!(sink.is_some(), "{}", task.name());
    }
    assert!(sizes.len() > 12, "{sizes:?}");
    // Of a task's edges, most stay.
    let (mut stay, mut all) = (0, 0);
    for number in 0..100 {
        let dfa = Shape::Task.draw(number);
        for state in dfa.states() {
            for symbol in dfa.alphabet().symbols() {
                all += 1;
                stay += usize::from(dfa.next(state, symbol) == state);
            }
        }
    }
    assert!(2 * stay > all, "{stay} of {all}");
    assert!(Target::named("random:x").is_err());
}
