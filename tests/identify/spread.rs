//! What chains meet against all there are: how far their distribution is from
//! the exact one.

use std::collections::BTreeMap;

use automata::{Dfa, Word};
use memrep::belief::{Belief, Ending, Heard, Tally, compared};
use memrep::evidence::{Budget, Fact};
use memrep::identify::{EngineChoice, Identifier, Settings, Spread, Wish, end};

use crate::draw::Draw;

const SIZES: usize = 4;

fn sure(fact: Fact<Word>) -> Vec<Heard<Word>> {
    vec![Heard { fact, sure: true }]
}

/// A few labels and comparisons, true of a drawn automaton of three states.
fn evidence(draw: &mut Draw, labels: usize, comparisons: usize) -> Vec<Vec<Heard<Word>>> {
    let target = draw.dfa(&Draw::alphabet(2), 3);
    let mut heard = Vec::new();
    for _ in 0..labels {
        let atom = draw.word(2, 4);
        let accepted = target.accepts(&atom);
        heard.push(sure(Fact::Label { atom, accepted }));
    }
    for _ in 0..comparisons {
        let (first, second) = (draw.word(2, 4), draw.word(2, 4));
        heard.push(sure(
            match (target.accepts(&first), target.accepts(&second)) {
                (true, false) => Fact::Below {
                    worse: second,
                    better: first,
                },
                (false, true) => Fact::Below {
                    worse: first,
                    better: second,
                },
                _ if draw.number(2) == 0 => Fact::Equal { first, second },
                _ => Fact::Incomparable { first, second },
            },
        ));
    }
    heard
}

/// Consistent automata of up to three states, listed if there are at most so
/// many, otherwise as chains meet them.
fn spread(heard: &[Vec<Heard<Word>>], listed: usize, seed: u64) -> Spread<Dfa> {
    let settings = Settings {
        engine: EngineChoice::Auto,
        max_states: 3,
    };
    let mut identifier = Identifier::new(Draw::alphabet(2), settings);
    for heard in heard.iter().flatten().filter(|heard| heard.sure) {
        identifier.add(None, heard.fact.clone());
    }
    let wish = Wish {
        sizes: SIZES,
        decay: 0.5,
        listed,
        heard,
        seed,
    };
    identifier
        .spread(&wish, &mut Budget::unlimited())
        .expect("a target of three states is consistent")
}

/// The chances of a spread.
fn chances(spread: &Spread<Dfa>) -> BTreeMap<String, f64> {
    let weights = spread.concepts.iter().map(|concept| concept.log_weight);
    let top = weights.fold(f64::NEG_INFINITY, f64::max);
    let shares: Vec<(String, f64)> = (spread.concepts.iter())
        .map(|concept| {
            let share = (concept.log_weight - top).exp();
            (format!("{:?}", concept.concept), share)
        })
        .collect();
    let sum: f64 = shares.iter().map(|(_, share)| share).sum();
    shares
        .into_iter()
        .map(|(dfa, share)| (dfa, share / sum))
        .collect()
}

fn distance(one: &BTreeMap<String, f64>, other: &BTreeMap<String, f64>) -> f64 {
    let in_both: f64 = (one.iter())
        .filter_map(|(dfa, share)| other.get(dfa).map(|there| share.min(*there)))
        .sum();
    1.0 - in_both
}

/// All minimal automata over two letters with up to three states: as many as are
/// known to exist (Domaratzki, Kisman, Shallit 2002).
#[test]
fn with_nothing_heard_all_are_listed() {
    let all = spread(&[], 2000, 0);
    assert!(all.exact);
    let of_size = |size| {
        all.concepts
            .iter()
            .filter(|c| c.concept.size() == size)
            .count()
    };
    assert_eq!([1, 2, 3].map(of_size), [2, 24, 1028]);
}

/// The distance in total variation between what chains meet and what there is:
/// the mean over drawn evidence.
#[test]
fn chains_meet_what_is_likely() {
    let mut draw = Draw::new(5);
    let mut distances = Vec::new();
    for case in 0..12 {
        let heard = evidence(&mut draw, case % 4, 4 + case);
        let exact = spread(&heard, 5000, 1);
        assert!(exact.exact, "there are at most 1054");
        let met = spread(&heard, 0, 1);
        assert!(!met.exact && !met.hurried);
        distances.push(distance(&chances(&exact), &chances(&met)));
    }
    let mean = distances.iter().sum::<f64>() / distances.len() as f64;
    println!("total variation: mean {mean:.3}, all {distances:.3?}");
    assert!(mean < 0.1, "{distances:?}");
}

/// Doubted labels weigh as the urn of errors has it: the listed chances against
/// those that a twin makes from prior ratios of automata of one table shape.
#[test]
fn doubted_labels_do_not_refute() {
    let alphabet = Draw::alphabet(2);
    let label = |word: Word, accepted| Fact::Label {
        atom: word,
        accepted,
    };
    let mut heard: Vec<Vec<Heard<Word>>> = (alphabet.words().take(15))
        .map(|word| {
            let fact = label(word, true);
            vec![Heard { fact, sure: false }]
        })
        .collect();
    let odd = alphabet.words().nth(9).expect("words never end");
    let fact = label(odd.clone(), false);
    heard[9] = vec![Heard { fact, sure: false }];
    let all = spread(&heard, 5000, 0);
    let likeliest = (all.concepts.iter())
        .max_by(|one, other| one.log_weight.total_cmp(&other.log_weight))
        .expect("there are many");
    assert!(likeliest.concept.accepts(&odd), "one slip among fifteen");
    assert_eq!(likeliest.concept.size(), 1);
    // A complement explains nothing of it.
    let belief = Belief::new(15);
    let log = |inverted: bool| {
        let mut tally = Tally::default();
        for heard in heard.iter().flatten() {
            if let Fact::Label { accepted, .. } = &heard.fact {
                tally.label(*accepted != inverted, heard.sure);
            }
        }
        belief.log_chance(&tally)
    };
    let weight = |accepting: bool| {
        let trivial = (all.concepts.iter())
            .find(|c| c.concept.size() == 1 && c.concept.accepts(&odd) == accepting);
        trivial.expect("all of one state are listed").log_weight
    };
    let gain = weight(true) - weight(false);
    assert!((gain - (log(false) - log(true))).abs() < 1e-9, "{gain}");
}

/// What is listed is consistent, and its chances are those of the belief: two
/// automata with one table have the same prior.
#[test]
fn comparisons_weigh_as_believed() {
    let mut draw = Draw::new(9);
    let heard = evidence(&mut draw, 1, 10);
    let all = spread(&heard, 5000, 0);
    let belief = Belief::new(heard.len());
    let log = |dfa: &Dfa| {
        let mut tally = Tally::default();
        for Heard { fact, sure } in heard.iter().flatten() {
            if let Fact::Label { atom, accepted } = fact {
                tally.label(dfa.accepts(atom) == *accepted, *sure);
            }
            if let Some((first, second, verdict)) = compared(fact) {
                let ending = Ending::of(end(dfa, first), end(dfa, second));
                tally.comparison(ending, verdict, *sure);
            }
        }
        assert!(!tally.is_refuted());
        belief.log_chance(&tally)
    };
    let table = |dfa: &Dfa| -> Vec<usize> {
        let symbols = || dfa.alphabet().symbols();
        (dfa.states())
            .flat_map(|state| symbols().map(move |symbol| dfa.next(state, symbol).index()))
            .collect()
    };
    let mut priors: BTreeMap<Vec<usize>, f64> = BTreeMap::new();
    for concept in &all.concepts {
        let prior = concept.log_weight - log(&concept.concept);
        let known = *priors.entry(table(&concept.concept)).or_insert(prior);
        assert!((known - prior).abs() < 1e-9);
    }
    assert!(priors.len() > 10);
}

/// Where an answer is taken back, the chains come to where they would have been.
#[test]
fn chains_forget() {
    let mut draw = Draw::new(3);
    let heard = evidence(&mut draw, 2, 12);
    let settings = Settings {
        engine: EngineChoice::Auto,
        max_states: 6,
    };
    let mut wanders = Identifier::new(Draw::alphabet(2), settings.clone());
    let mut all = |heard: &[Vec<Heard<Word>>]| {
        let wish = Wish {
            sizes: SIZES,
            decay: 0.5,
            listed: 0,
            heard,
            seed: 4,
        };
        let mut fresh = Identifier::new(Draw::alphabet(2), settings.clone());
        let [one, other] = [&mut wanders, &mut fresh].map(|identifier| {
            let spread = identifier.spread(&wish, &mut Budget::unlimited());
            chances(&spread.expect("no facts, no contradiction"))
        });
        assert_eq!(one, other);
    };
    all(&heard[..8]);
    all(&heard);
    all(&heard[..8]);
    let mut without = heard.clone();
    without.remove(5);
    all(&without);
    all(&heard[..0]);
}
