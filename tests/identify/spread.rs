//! Drawn automata against all there are: how far the drawn distribution is from
//! the exact one.

use std::collections::BTreeMap;

use automata::{Dfa, Word};
use memrep::evidence::{Budget, Comparison, Fact};
use memrep::identify::{Ending, EngineChoice, Identifier, Odds, Settings, Spread, Wish};

use crate::draw::Draw;

const ODDS: Odds = Odds {
    incomparable: 0.1,
    same_place: [0.4, 0.35, 0.25],
    same_label: [0.4, 0.35, 0.25],
};

type Answer = (Word, Word, Comparison);

/// A few labels and comparisons, true of a drawn automaton of four states.
fn evidence(draw: &mut Draw) -> (Vec<Fact<Word>>, Vec<Answer>) {
    let target = draw.dfa(&Draw::alphabet(2), 4);
    let mut facts = vec![Fact::Label {
        atom: Word::empty(),
        accepted: target.accepts(&Word::empty()),
    }];
    for _ in 0..3 {
        let atom = draw.word(2, 4);
        let accepted = target.accepts(&atom);
        facts.push(Fact::Label { atom, accepted });
    }
    let mut answers = Vec::new();
    for _ in 0..8 {
        let (first, second) = (draw.word(2, 4), draw.word(2, 4));
        let answer = match (target.accepts(&first), target.accepts(&second)) {
            (true, false) => Comparison::First,
            (false, true) => Comparison::Second,
            _ => [Comparison::Equal, Comparison::Incomparable][draw.number(2)],
        };
        facts.push(Fact::compared(first.clone(), second.clone(), answer));
        answers.push((first, second, answer));
    }
    (facts, answers)
}

/// The posterior of what was listed (all of up to four states) or drawn.
fn posterior(
    facts: &[Fact<Word>],
    answers: &[Answer],
    listed: usize,
    draws: usize,
) -> (BTreeMap<usize, f64>, Vec<(Dfa, f64)>, bool) {
    let settings = Settings {
        engine: EngineChoice::Auto,
        max_states: 4,
    };
    let mut identifier = Identifier::new(Draw::alphabet(2), settings);
    for fact in facts {
        identifier.add(None, fact.clone());
    }
    let wish = Wish {
        sizes: 4,
        decay: 0.5,
        listed,
        draws,
        answers,
        odds: &ODDS,
        seed: 1,
        work: u64::MAX,
    };
    let spread: Spread<Dfa> = identifier
        .spread(&wish, &mut Budget::unlimited())
        .expect("a target of four states is consistent");
    let weigh = |dfa: &Dfa, log_weight: f64| {
        let likelihood: f64 = answers
            .iter()
            .map(|(first, second, answer)| {
                let same = dfa.run(first) == dfa.run(second);
                let ending = Ending::of(dfa.accepts(first), dfa.accepts(second), same);
                ODDS.chance(ending, *answer)
            })
            .product();
        log_weight.exp() * likelihood
    };
    let mut all: Vec<(Dfa, f64)> = (spread.concepts.iter())
        .map(|weighted| {
            let dfa = weighted.concept.clone();
            assert!(
                facts
                    .iter()
                    .all(|fact| fact.holds(|word| dfa.accepts(word)))
            );
            let weight = weigh(&dfa, weighted.log_weight);
            (dfa, weight)
        })
        .collect();
    let sum: f64 = all.iter().map(|(_, weight)| weight).sum();
    let mut sizes = BTreeMap::new();
    for (dfa, weight) in &mut all {
        *weight /= sum;
        *sizes.entry(dfa.size()).or_insert(0.0) += *weight;
    }
    (sizes, all, spread.exact)
}

/// With four thousand draws, the chances of sizes and of labels are off by a few
/// hundredths at most, and by less on average.
#[test]
fn draws_are_near_the_exact_distribution() {
    let mut draw = Draw::new(7);
    let (mut sizes_off, mut labels_off, mut rounds) = (0.0, 0.0, 0);
    while rounds < 8 {
        let (facts, answers) = evidence(&mut draw);
        let (sizes, all, exact) = posterior(&facts, &answers, 1_000_000, 0);
        assert!(exact);
        let (drawn_sizes, drawn, drawn_exact) = posterior(&facts, &answers, 0, 4000);
        if drawn_exact {
            continue;
        }
        rounds += 1;
        let of = |sizes: &BTreeMap<usize, f64>, size| sizes.get(&size).copied().unwrap_or(0.0);
        let off: f64 = (1..=4)
            .map(|size| (of(&sizes, size) - of(&drawn_sizes, size)).abs())
            .sum();
        // Total variation.
        sizes_off += off / 2.0;
        let accept = |all: &[(Dfa, f64)], word: &Word| -> f64 {
            all.iter()
                .filter(|(dfa, _)| dfa.accepts(word))
                .map(|(_, weight)| weight)
                .sum()
        };
        let worst = Draw::alphabet(2)
            .words_up_to(4)
            .map(|word| (accept(&all, &word) - accept(&drawn, &word)).abs())
            .fold(0.0, f64::max);
        labels_off += worst;
        assert!(off / 2.0 < 0.15, "sizes: {sizes:?}, drawn {drawn_sizes:?}");
        assert!(worst < 0.15, "a label is off by {worst}");
    }
    println!(
        "mean distance: sizes {:.4}, labels {:.4}",
        sizes_off / f64::from(rounds),
        labels_off / f64::from(rounds)
    );
    assert!(sizes_off / f64::from(rounds) < 0.06);
    assert!(labels_off / f64::from(rounds) < 0.08);
}

/// What is listed is what a search of each size for itself would find: the
/// counts of minimal automata over two letters with the empty word accepted.
#[test]
fn lists_are_complete() {
    let empty = Fact::Label {
        atom: Word::empty(),
        accepted: true,
    };
    let (_, all, exact) = posterior(&[empty], &[], 1_000_000, 0);
    assert!(exact);
    let mut counts = BTreeMap::new();
    for (dfa, _) in &all {
        assert_eq!(dfa.minimise().size(), dfa.size());
        *counts.entry(dfa.size()).or_insert(0) += 1;
    }
    assert_eq!(
        counts,
        BTreeMap::from([(1, 1), (2, 12), (3, 514), (4, 28_007)])
    );
}
