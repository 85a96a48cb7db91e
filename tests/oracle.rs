//! Scripted teachers: targets, preference orders, counterexamples and errors.

use automata::{Dfa, Word};
use memrep::evidence::{Comparison, Fact};
use memrep::oracle::{
    Counterexamples, Order, PreferenceOrder, ScriptedTeacher, Target, TargetError, Teacher,
    TeacherSettings,
};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

/// Membership by the sentence that describes the language.
fn described(name: &str, word: &str) -> bool {
    let runs = || {
        let mut runs: Vec<(char, usize)> = Vec::new();
        for c in word.chars() {
            match runs.last_mut() {
                Some((last, length)) if *last == c => *length += 1,
                _ => runs.push((c, 1)),
            }
        }
        runs
    };
    let count = |c| word.chars().filter(|&w| w == c).count();
    match name {
        "tomita:1" => !word.contains('0'),
        "tomita:2" => word.len().is_multiple_of(2) && word == "10".repeat(word.len() / 2),
        "tomita:3" => !runs()
            .windows(2)
            .any(|w| w[0].0 == '1' && w[0].1 % 2 == 1 && w[1].1 % 2 == 1),
        "tomita:3t" => !runs().windows(2).any(|w| w[0].0 == '1' && w[0].1 % 2 == 1),
        "tomita:4" | "zeros:2" => !word.contains("000"),
        "tomita:5" => count('0') % 2 == 0 && count('1') % 2 == 0,
        "tomita:6" => count('1').abs_diff(count('0')) % 3 == 0,
        "tomita:7" => {
            let runs = runs();
            runs.len() <= 4 && (runs.first().is_none_or(|r| r.0 == '0') || runs.len() <= 3)
        }
        "zeros:1" => !word.contains("00"),
        "modulo:5" => word.len().is_multiple_of(5),
        "robot" => {
            // Reach Y, never R, and after B not Y before O.
            let mut wet = false;
            let mut reached = false;
            for c in word.chars() {
                match c {
                    'R' => return false,
                    'Y' if wet => return false,
                    'Y' => reached = true,
                    'B' => wet = true,
                    _ => {}
                }
                if c == 'O' && wet {
                    wet = false;
                }
                // Water and then the dryer lead back to the dry state, where
                // the recharge tile must be reached again.
                if c == 'B' {
                    reached = false;
                }
            }
            reached
        }
        other => panic!("{other} is not described"),
    }
}

#[test]
fn targets_are_what_their_descriptions_say() {
    let sizes = [
        ("tomita:1", 2),
        ("tomita:2", 3),
        ("tomita:3", 5),
        ("tomita:3t", 3),
        ("tomita:4", 4),
        ("tomita:5", 4),
        ("tomita:6", 3),
        ("tomita:7", 5),
        ("zeros:1", 3),
        ("zeros:2", 4),
        ("modulo:5", 5),
        ("robot", 4),
    ];
    for (name, size) in sizes {
        let target = Target::named(name).unwrap();
        assert_eq!(target.dfa().size(), size, "{name}");
        let alphabet = target.dfa().alphabet();
        let longest = if alphabet.len() == 4 { 6 } else { 10 };
        for word in alphabet.words_up_to(longest) {
            let spelled: String = alphabet.spell(&word).collect();
            let accepted = target.dfa().accepts(&word);
            assert_eq!(accepted, described(name, &spelled), "{name}: {spelled}");
        }
        for fact in target.known() {
            assert!(fact.holds(|word| target.dfa().accepts(word)), "{fact:?}");
        }
    }
    assert_eq!(Target::named("robot").unwrap().known().len(), 11);
    assert!(matches!(
        Target::named("modulo:3").unwrap().known(),
        [Fact::Label { accepted: true, atom }] if atom.is_empty()
    ));
}

#[test]
fn other_names_are_refused_with_the_remedy() {
    for name in [
        "tomita", "tomita:8", "tomita:", "modulo:0", "modulo:x", "zeros:-1", "robot:2", "",
    ] {
        let error = Target::named(name).unwrap_err();
        assert!(error.to_string().contains("give "), "{error}");
        let unknown = matches!(error, TargetError::Unknown(_));
        assert_eq!(unknown, matches!(name, "tomita" | "robot:2" | ""), "{name}");
    }
}

/// Definition 5.1.1 and the definition of a preorder, on all words up to 6.
fn check_order(order: &PreferenceOrder, target: &Dfa) -> [f64; 3] {
    let longest = if target.alphabet().len() == 4 { 3 } else { 6 };
    let words: Vec<Word> = target.alphabet().words_up_to(longest).collect();
    let table: Vec<Vec<Comparison>> = words
        .iter()
        .map(|x| words.iter().map(|y| order.compare(x, y)).collect())
        .collect();
    let below = |x: usize, y: usize| matches!(table[x][y], Comparison::Second | Comparison::Equal);
    let (mut strict, mut equal, mut incomparable, mut alike, mut pairs) = (0, 0, 0, 0, 0);
    for x in 0..words.len() {
        assert_eq!(table[x][x], Comparison::Equal);
        for y in 0..words.len() {
            assert_eq!(table[x][y], table[y][x].mirrored());
            let labels = [x, y].map(|w| target.accepts(&words[w]));
            assert!(!below(x, y) || labels[0] <= labels[1], "{x} {y}");
            assert!((0..words.len()).all(|z| !below(x, y) || !below(y, z) || below(x, z)));
            if x < y {
                pairs += 1;
                incomparable += i32::from(table[x][y] == Comparison::Incomparable);
                if labels[0] == labels[1] {
                    alike += 1;
                    equal += i32::from(table[x][y] == Comparison::Equal);
                    strict += i32::from(matches!(
                        table[x][y],
                        Comparison::First | Comparison::Second
                    ));
                }
            }
        }
    }
    let share = |count: i32, of: i32| f64::from(count) / f64::from(of.max(1));
    [
        share(incomparable, pairs),
        share(strict, alike),
        share(equal, alike),
    ]
}

#[test]
fn orders_are_preorders_that_respect_membership() {
    let names = [
        "tomita:1", "tomita:3", "tomita:4", "tomita:5", "tomita:7", "modulo:5", "robot",
    ];
    for name in names {
        let target = Target::named(name).unwrap();
        for seed in 0..3 {
            let random = PreferenceOrder::new(Order::Random, target.dfa(), seed);
            check_order(&random, target.dfa());
        }
        let ordered = PreferenceOrder::new(Order::Ordered, target.dfa(), 0);
        let [incomparable, ..] = check_order(&ordered, target.dfa());
        assert!(incomparable == 0.0, "the described order is total");
    }
}

/// About a tenth incomparable, and of equally labelled pairs about a third
/// strict, on average over seeds.
#[test]
fn a_random_order_has_the_shares_of_the_dissertation() {
    let target = Target::named("tomita:5").unwrap();
    let seeds = 60;
    let mut sums = [0.0; 3];
    for seed in 0..seeds {
        let order = PreferenceOrder::new(Order::Random, target.dfa(), seed);
        for (sum, share) in sums.iter_mut().zip(check_order(&order, target.dfa())) {
            *sum += share / seeds as f64;
        }
    }
    let [incomparable, strict, equal] = sums;
    assert!((0.08..0.12).contains(&incomparable), "{sums:?}");
    assert!((0.29..0.37).contains(&strict), "{sums:?}");
    assert!((0.5..0.62).contains(&equal), "{sums:?}");
}

/// The order's own words, on Tomita 4 (no three zeros).
#[test]
fn the_described_order_is_as_described() {
    let target = Target::named("tomita:4").unwrap();
    let order = PreferenceOrder::new(Order::Ordered, target.dfa(), 0);
    let alphabet = target.dfa().alphabet();
    let compare = |first: &str, second: &str| {
        let [first, second] =
            [first, second].map(|w| alphabet.word(w.chars().map(String::from)).unwrap());
        order.compare(&first, &second)
    };
    assert_eq!(compare("1", "000"), Comparison::First);
    // Later into the sink, however long after it.
    assert_eq!(compare("0001111", "1000"), Comparison::Second);
    assert_eq!(compare("0001", "0000"), Comparison::Equal);
    // After one zero three of four extensions are accepted, after none all four.
    assert_eq!(compare("0", ""), Comparison::Second);
    assert_eq!(compare("01", "11"), Comparison::Equal);

    // Without a sink, the longest accepted prefix decides.
    let target = Target::named("tomita:5").unwrap();
    let order = PreferenceOrder::new(Order::Ordered, target.dfa(), 0);
    let word = |w: &str| alphabet.word(w.chars().map(String::from)).unwrap();
    assert_eq!(order.compare(&word("0001"), &word("01")), Comparison::First);
    assert_eq!(order.compare(&word("10"), &word("0")), Comparison::Equal);
}

#[test]
fn counterexamples_are_counterexamples() {
    let target = Target::named("tomita:7").unwrap();
    let mut random = ChaCha8Rng::seed_from_u64(5);
    for other in ["tomita:1", "tomita:2", "tomita:4", "tomita:6"] {
        let hypothesis = Target::named(other).unwrap().dfa().clone();
        let mut lengths = std::collections::BTreeSet::new();
        for _ in 0..200 {
            let word = Counterexamples::Random
                .find(target.dfa(), &hypothesis, &mut random)
                .unwrap()
                .expect("they differ");
            assert_ne!(target.dfa().accepts(&word), hypothesis.accepts(&word));
            assert!(word.len() <= 10);
            lengths.insert(word.len());
        }
        assert!(lengths.len() > 5, "the lengths vary: {lengths:?}");
        let shortest = Counterexamples::Shortest
            .find(target.dfa(), &hypothesis, &mut random)
            .unwrap();
        let words = target.dfa().alphabet().words();
        let expected = words
            .into_iter()
            .find(|w| target.dfa().accepts(w) != hypothesis.accepts(w));
        assert_eq!(shortest, expected);
    }
    let same = Counterexamples::Random.find(target.dfa(), target.dfa(), &mut random);
    assert_eq!(same, Ok(None));
}

/// A word so long that none of up to 10 symbols refutes the hypothesis.
#[test]
fn long_counterexamples_are_found() {
    let [target, hypothesis] =
        ["modulo:13", "modulo:26"].map(|name| Target::named(name).unwrap().dfa().clone());
    let mut random = ChaCha8Rng::seed_from_u64(0);
    let found = Counterexamples::Random.find(&target, &hypothesis, &mut random);
    assert_eq!(found.unwrap().unwrap().len(), 13);
}

#[test]
fn errors_come_at_their_rate_and_never_on_hypotheses() {
    let target = Target::named("tomita:5").unwrap();
    let settings = |error_rate, seed| TeacherSettings {
        order: Order::Random,
        error_rate,
        seed,
        ..TeacherSettings::default()
    };
    let truth = PreferenceOrder::new(Order::Random, target.dfa(), 3);
    let mut teacher = ScriptedTeacher::new(&target, settings(0.2, 3));
    let mut again = ScriptedTeacher::new(&target, settings(0.2, 3));
    let words: Vec<Word> = target.dfa().alphabet().words_up_to(5).collect();
    let (mut wrong, mut asked) = (0, 0);
    for first in &words {
        for second in &words {
            let answer = teacher.comparison(first, second);
            assert_eq!(answer, again.comparison(first, second), "the seed decides");
            wrong += u32::from(answer != truth.compare(first, second));
            let label = teacher.membership(first);
            assert_eq!(label, again.membership(first));
            wrong += u32::from(label != target.dfa().accepts(first));
            asked += 2;
        }
        assert_eq!(teacher.counterexample(target.dfa()), None);
    }
    let rate = f64::from(wrong) / f64::from(asked);
    assert!((0.18..0.22).contains(&rate), "{rate}");

    let mut honest = ScriptedTeacher::new(&target, settings(0.0, 3));
    let mut liar = ScriptedTeacher::new(&target, settings(1.0, 3));
    for (first, second) in words.iter().zip(words.iter().rev()) {
        assert_eq!(honest.membership(first), target.dfa().accepts(first));
        assert_ne!(liar.membership(first), target.dfa().accepts(first));
        let answer = truth.compare(first, second);
        assert_eq!(honest.comparison(first, second), answer);
        let lie = liar.comparison(first, second);
        assert!(lie == Comparison::First || lie == Comparison::Second);
        assert_ne!(lie, answer);
    }
}
