//! Monotone families: what is consistent against all parameters tried one by one,
//! and every strategy on random targets.

use std::collections::BTreeSet;

use memrep::belief::Heard;
use memrep::bench::{process_cpu, teach};
use memrep::concept::{
    Behaviour, Cause, ConceptClass, Corners, Failure, Family, LinearReward, LinearRewards,
    MonotoneClass, Point, Wish,
};
use memrep::evidence::{AnswerId, Budget, Comparison, Fact};
use memrep::learner::{Config, Learner, Strategy as Way};
use memrep::oracle::{ClassGoal, Counterexamples, Order, ScriptedTeacher, TeacherSettings};
use proptest::prelude::*;

use crate::finite::config;

/// All vectors with entries from 0 to `top`.
fn vectors(dimensions: usize, top: u32) -> Vec<Vec<u32>> {
    (0..dimensions).fold(vec![Vec::new()], |vectors, _| {
        let longer = |vector: &Vec<u32>| {
            let vector = vector.clone();
            (0..=top).map(move |tick| [vector.clone(), vec![tick]].concat())
        };
        vectors.iter().flat_map(longer).collect()
    })
}

/// `Φ_i`.
fn grid(dimensions: usize, size: usize) -> BTreeSet<Point> {
    let top = size as u32 - 1;
    let points = vectors(dimensions, top).into_iter();
    points.map(|ticks| Point::new(ticks, top)).collect()
}

/// `x ∈ φ_θ` by the numbers that are shown.
fn contains(parameter: &Point, atom: &Point) -> bool {
    let mut pairs = parameter.coordinates().zip(atom.coordinates());
    pairs.all(|(high, low)| low <= high + 1e-9)
}

const FINEST: usize = 5;

fn point(dimensions: usize) -> impl Strategy<Value = Point> {
    (1..FINEST as u32).prop_flat_map(move |steps| {
        let ticks = proptest::collection::vec(0..=steps, dimensions);
        ticks.prop_map(move |ticks| Point::new(ticks, steps))
    })
}

fn fact(dimensions: usize) -> impl Strategy<Value = Fact<Point>> {
    let pair = (point(dimensions), point(dimensions));
    (pair, any::<bool>(), 0..5).prop_map(|((first, second), accepted, kind)| match kind {
        0 => Fact::Below {
            worse: first,
            better: second,
        },
        1 => Fact::Equal { first, second },
        2 => Fact::Incomparable { first, second },
        _ => Fact::Label {
            atom: first,
            accepted,
        },
    })
}

fn situation() -> impl Strategy<Value = (usize, Vec<Fact<Point>>)> {
    (1..=3_usize).prop_flat_map(|dimensions| {
        let facts = proptest::collection::vec(fact(dimensions), 0..7);
        (Just(dimensions), facts)
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn samples_are_the_smallest_grid_that_fits((dimensions, facts) in situation()) {
        let consistent = |size| -> BTreeSet<Point> {
            let fits = |parameter: &Point| {
                facts.iter().all(|fact| fact.holds(|atom| contains(parameter, atom)))
            };
            grid(dimensions, size).into_iter().filter(fits).collect()
        };
        let mut class = MonotoneClass::new(Corners::new(dimensions, FINEST), FINEST);
        for (number, fact) in facts.iter().enumerate() {
            class.add(Some(AnswerId(number as u32)), fact.clone());
        }
        let wish = Wish { sizes: 3, decay: 0.5, listed: 1000, heard: &[], seed: 0 };
        let found = class.sample(1000, 0, &mut Budget::unlimited());
        let spread = class.spread(&wish, &mut Budget::unlimited());
        if let Some(least) = (1..=FINEST).find(|&size| !consistent(size).is_empty()) {
            let found = found.unwrap();
            prop_assert!(found.complete);
            let all: BTreeSet<Point> = found.concepts.iter().cloned().collect();
            prop_assert_eq!(all.len(), found.concepts.len(), "no two are the same");
            prop_assert_eq!(&all, &consistent(least));
            prop_assert!(found.concepts.iter().all(|concept| concept.size() == least));
            // Fewer are some of these, and the same for the same seed.
            let some = class.sample(2, 7, &mut Budget::unlimited()).unwrap();
            prop_assert!(some.concepts.iter().all(|concept| all.contains(concept)));
            prop_assert_eq!(some.complete, all.len() <= 2);
            let again = class.sample(2, 7, &mut Budget::unlimited()).unwrap();
            prop_assert_eq!(&some.concepts, &again.concepts);

            let spread = spread.unwrap();
            let sizes = least..=(least + 2).min(FINEST);
            let listed: BTreeSet<Point> = sizes.clone().flat_map(consistent).collect();
            let weighted: BTreeSet<Point> =
                spread.concepts.iter().map(|weighted| weighted.concept.clone()).collect();
            prop_assert_eq!(&weighted, &listed);
            prop_assert_eq!(spread.concepts.len(), listed.len());
            prop_assert!(spread.exact);
            // Every grid has its share, and every parameter of it the same.
            for weighted in &spread.concepts {
                let on = sizes.clone().filter(|&size| consistent(size).contains(&weighted.concept));
                let chance: f64 = on.map(|size| {
                    0.5_f64.powf((size - least) as f64) / (size as f64).powf(dimensions as f64)
                }).sum();
                prop_assert!((weighted.log_weight - chance.ln()).abs() < 1e-9);
            }
        } else {
            let Err(Failure::Contradiction(conflict)) = found else {
                panic!("{found:?}");
            };
            prop_assert!(conflict.minimal);
            prop_assert!(spread.is_err());
            // They cannot stand, and without any one of them the others can.
            let stands = |answers: &[AnswerId]| (1..=FINEST).any(|size| {
                grid(dimensions, size).iter().any(|parameter| answers.iter().all(|answer| {
                    facts[answer.0 as usize].holds(|atom| contains(parameter, atom))
                }))
            });
            prop_assert!(!stands(&conflict.answers));
            for place in 0..conflict.answers.len() {
                let mut rest = conflict.answers.clone();
                rest.remove(place);
                prop_assert!(stands(&rest));
            }
            let known = [Cause::MemRep, Cause::States { bound: FINEST }];
            prop_assert!(known.contains(&conflict.cause));
            // All taken back, everything is consistent again.
            for number in 0..facts.len() {
                class.retract(AnswerId(number as u32));
            }
            let sample = class.sample(1, 0, &mut Budget::unlimited()).unwrap();
            prop_assert_eq!(sample.concepts[0].size(), 1);
        }
    }

    #[test]
    fn witnesses_are_the_simplest(dimensions in 1..=3_usize, seed in any::<u64>()) {
        use rand::{RngExt, SeedableRng};
        let mut random = rand_chacha::ChaCha8Rng::seed_from_u64(seed);
        let family = Corners::new(dimensions, FINEST);
        let mut draw = || {
            let steps = random.random_range(1..FINEST as u32);
            let ticks = (0..dimensions).map(|_| random.random_range(0..=steps)).collect();
            Point::new(ticks, steps)
        };
        let (inside, outside) = (draw(), draw());
        let universe: Vec<Point> = family.atoms().collect();
        prop_assert!(universe.is_sorted());
        let all: BTreeSet<Point> = (1..=FINEST).flat_map(|size| grid(dimensions, size)).collect();
        prop_assert_eq!(universe.iter().cloned().collect::<BTreeSet<_>>(), all);
        let separates = |atom: &&Point| contains(&inside, atom) && !contains(&outside, atom);
        let expected: Vec<Point> = universe.iter().filter(separates).take(5).cloned().collect();
        prop_assert_eq!(family.witnesses(&inside, &outside, 5), expected);
        // None exactly if the one contains the other.
        let below = contains(&outside, &inside);
        prop_assert_eq!(family.witnesses(&inside, &outside, 1).is_empty(), below);
    }
}

fn learn<F: Family + Clone>(
    family: &F,
    finest: usize,
    target: &Point,
    config: Config,
    settings: TeacherSettings,
) -> memrep::bench::Report<Point> {
    let class = || MonotoneClass::new(family.clone(), finest);
    let goal = ClassGoal::new(class(), target.clone(), settings.order, settings.seed);
    let mut learner = Learner::new(class(), config, Vec::new());
    let mut teacher = ScriptedTeacher::of(goal, settings);
    teach(&mut learner, &mut teacher, 400, process_cpu, |_| ()).expect("the setup is sound")
}

#[test]
fn every_strategy_ends_with_the_target() {
    for (dimensions, finest, parameters) in [
        (1, 9, vec![vec![3], vec![8]]),
        (2, 7, vec![vec![2, 5], vec![0, 0], vec![6, 1]]),
        (3, 5, vec![vec![1, 4, 3]]),
        (4, 4, vec![vec![1, 0, 3, 2]]),
    ] {
        let family = Corners::new(dimensions, finest);
        for ticks in parameters {
            let target = Point::new(ticks, finest as u32 - 1);
            for way in [Way::Bayes, Way::Exp4Plus, Way::Thesis, Way::Membership] {
                for (order, counterexamples) in [
                    (Order::Random, Counterexamples::Random),
                    (Order::Ordered, Counterexamples::Shortest),
                ] {
                    let settings = TeacherSettings {
                        order,
                        counterexamples,
                        error_rate: 0.0,
                        seed: 3,
                    };
                    let config = Config {
                        shortest_counterexamples: counterexamples == Counterexamples::Shortest,
                        ..config(way, 3)
                    };
                    let report = learn(&family, finest, &target, config, settings);
                    assert_eq!(report.learned.as_ref(), Some(&target), "{way:?}, {order:?}");
                    assert_eq!(report.dropped, 0, "the teacher does not err");
                    assert_eq!(report.hurried, 0, "the class is small");
                    if way == Way::Membership {
                        assert_eq!(report.counts.comparison, 0);
                    }
                }
            }
        }
    }
}

/// A teacher of a monotone family respects membership, and of the random order a
/// tenth of the pairs cannot be compared.
#[test]
fn orders_respect_membership() {
    use memrep::oracle::Goal;
    let family = Corners::new(2, 11);
    let target = Point::new(vec![6, 3], 10);
    let atoms: Vec<Point> = family.atoms().take(400).collect();
    for order in [Order::Ordered, Order::Random] {
        let class = MonotoneClass::new(family.clone(), 11);
        let goal = ClassGoal::new(class, target.clone(), order, 5);
        let (mut pairs, mut incomparable) = (0.0, 0.0);
        for (place, first) in atoms.iter().enumerate() {
            assert_eq!(goal.compare(first, first), Comparison::Equal);
            for second in &atoms[..place] {
                let answer = goal.compare(first, second);
                assert_eq!(goal.compare(second, first), answer.mirrored());
                let fact = Fact::compared(first.clone(), second.clone(), answer);
                assert!(fact.holds(|atom| contains(&target, atom)), "{fact:?}");
                pairs += 1.0;
                incomparable += f64::from(u8::from(answer == Comparison::Incomparable));
            }
        }
        let share: f64 = incomparable / pairs;
        match order {
            Order::Ordered => assert!(share == 0.0),
            Order::Random => assert!((share - 0.1).abs() < 0.04, "{share}"),
        }
    }
}

/// With answers that may be wrong, an error is found out.
#[test]
fn errors_are_found_out() {
    let target = Point::new(vec![2, 4], 5);
    for (way, robust) in [(Way::Thesis, false), (Way::Bayes, true)] {
        let settings = TeacherSettings {
            order: Order::Random,
            counterexamples: Counterexamples::Random,
            error_rate: 0.1,
            seed: 1,
        };
        let config = Config {
            robust,
            ..config(way, 1)
        };
        let report = learn(&Corners::new(2, 6), 6, &target, config, settings);
        assert_eq!(report.learned, Some(target.clone()), "{way:?}");
    }
}

/// All rewards of a grid by their own numbers, against the family.
#[test]
fn linear_rewards_are_a_monotone_family() {
    let step = |one: f64, other: f64| vec![one, other];
    let behaviours = [
        vec![step(0.0, 0.0)],
        vec![step(1.0, 0.0), step(0.5, 0.25)],
        vec![step(0.0, 1.0)],
        vec![step(0.3, 0.9), step(0.1, 0.2), step(1.0, 1.0)],
        vec![step(0.7, 0.1)],
    ];
    let family = LinearRewards::new(&behaviours).unwrap();
    let (bound, finest) = (6.0, 5);
    assert!((family.bound() - bound).abs() < 1e-12);
    let mut concepts: Vec<BTreeSet<Behaviour>> = Vec::new();
    for parameter in grid(3, finest) {
        let reward = family.reward(&parameter);
        // Eq. 5.7, with the reflection that makes more accept more.
        let theta: Vec<f64> = parameter.coordinates().map(|at| 1.0 - at).collect();
        for (weight, theta) in reward.weights.iter().zip(&theta) {
            assert!((theta - (1.0 - weight) / 2.0).abs() < 1e-12);
        }
        assert!((theta[2] - f64::midpoint(reward.threshold / bound, 1.0)).abs() < 1e-12);
        let back = family.parameter(&reward).unwrap();
        assert!(
            back.iter()
                .zip(parameter.coordinates())
                .all(|(a, b)| (a - b).abs() < 1e-12)
        );

        let class = MonotoneClass::new(family.clone(), finest);
        let contained = |behaviour: &Behaviour| class.contains(&parameter, behaviour);
        for behaviour in family.behaviours() {
            let sum = |feature: usize| -> f64 {
                behaviours[behaviour.0 as usize]
                    .iter()
                    .map(|step| step[feature])
                    .sum()
            };
            let total = reward.weights[0] * sum(0) + reward.weights[1] * sum(1);
            if (total - reward.threshold).abs() > 1e-9 {
                assert_eq!(
                    contained(&behaviour),
                    total > reward.threshold,
                    "{reward:?}"
                );
                assert_eq!(
                    family.accepts(&reward, behaviour),
                    Ok(total > reward.threshold)
                );
            }
        }
        concepts.push(family.behaviours().filter(contained).collect());
    }
    // Greater parameters accept more.
    let grid: Vec<Point> = grid(3, finest).into_iter().collect();
    for (one, low) in grid.iter().zip(&concepts) {
        for (other, high) in grid.iter().zip(&concepts) {
            if one
                .coordinates()
                .zip(other.coordinates())
                .all(|(a, b)| a <= b)
            {
                assert!(low.is_subset(high));
            }
        }
    }
    // A sample has no concept twice, and all there are.
    let mut class = MonotoneClass::new(family.clone(), finest);
    for behaviour in family.behaviours() {
        let labelled = |concept: &&BTreeSet<Behaviour>| concept.contains(&behaviour);
        assert!(concepts.iter().any(|c| labelled(&c)) && !concepts.iter().all(|c| labelled(&c)));
    }
    let atom = Behaviour(3);
    class.add(
        None,
        Fact::Label {
            atom,
            accepted: true,
        },
    );
    let sample = class.sample(100, 0, &mut Budget::unlimited()).unwrap();
    let sets: BTreeSet<BTreeSet<Behaviour>> = (sample.concepts.iter())
        .map(|c| {
            family
                .behaviours()
                .filter(|b| class.contains(c, b))
                .collect()
        })
        .collect();
    assert_eq!(sets.len(), sample.concepts.len());
    assert!(sample.complete);
    // And it is learned like any other.
    for way in [Way::Bayes, Way::Exp4Plus, Way::Thesis, Way::Membership] {
        let target = Point::new(vec![4, 1, 2], 4);
        let settings = TeacherSettings {
            order: Order::Random,
            ..TeacherSettings::default()
        };
        let report = learn(&family, finest, &target, config(way, 0), settings);
        let learned = report.learned.unwrap();
        for behaviour in family.behaviours() {
            assert_eq!(
                class.contains(&learned, &behaviour),
                class.contains(&target, &behaviour)
            );
        }
    }
}

#[test]
fn bad_rewards_are_named() {
    let message =
        |behaviours: &[Vec<Vec<f64>>]| LinearRewards::new(behaviours).unwrap_err().to_string();
    assert!(message(&[]).contains("no behaviour"));
    assert!(message(&[vec![]]).contains("no behaviour"));
    let uneven = message(&[vec![vec![0.0, 1.0]], vec![vec![0.5]]]);
    assert!(
        uneven.contains("behaviour 2, step 1 has 1 features"),
        "{uneven}"
    );
    let high = message(&[vec![vec![0.0], vec![1.5]]]);
    assert!(
        high.contains("behaviour 1, step 2, feature 1 is 1.5"),
        "{high}"
    );
    let family = LinearRewards::new(&[vec![vec![0.5]]]).unwrap();
    let reward = |weights: &[f64], threshold| {
        let weights = weights.to_vec();
        family
            .parameter(&LinearReward { weights, threshold })
            .unwrap_err()
            .to_string()
    };
    assert!(reward(&[0.1, 0.2], 0.0).contains("2 weights for 1 features"));
    assert!(reward(&[-1.5], 0.0).contains("weight 1 is -1.5"));
    assert!(reward(&[0.5], 2.0).contains("threshold is 2"));
    assert!(reward(&[f64::NAN], 0.0).contains("weight 1"));
}

/// Few units of work end early, with the size that was come to.
#[test]
fn little_work_is_no_answer() {
    let mut class = MonotoneClass::new(Corners::new(4, 30), 30);
    for number in 0..8 {
        let worse = Point::new(vec![7, number, 3, 11], 29);
        let better = Point::new(vec![5, 2, number, 12], 29);
        class.add(None, Fact::Below { worse, better });
    }
    class.add(
        None,
        Fact::Label {
            atom: Point::new(vec![15, 1, 1, 1], 29),
            accepted: false,
        },
    );
    class.add(
        None,
        Fact::Label {
            atom: Point::new(vec![14, 1, 1, 1], 29),
            accepted: true,
        },
    );
    assert!(matches!(
        class.sample(8, 0, &mut Budget::new(100)),
        Err(Failure::OverBudget { at_least: 2.. })
    ));
    let wish = Wish {
        sizes: 3,
        decay: 0.5,
        listed: 50,
        heard: &[vec![Heard {
            fact: Fact::Label {
                atom: Point::new(vec![0; 4], 0),
                accepted: true,
            },
            sure: true,
        }]],
        seed: 0,
    };
    let spread = class.spread(&wish, &mut Budget::new(2_000_000)).unwrap();
    assert_eq!(spread.concepts.len(), 50);
    assert!(!spread.exact);
}
