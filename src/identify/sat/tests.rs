//! The two SAT engines against each other, brute force, and their own past.

use std::collections::BTreeSet;

use automata::{Alphabet, Dfa, Symbol, Word};
use rand::seq::SliceRandom;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::incremental::consistent;
use super::{batsat_engine, varisat_engine};
use crate::evidence::{AnswerId, Budget, Fact};
use crate::identify::engine::{Engine, Query, Verdict};
use crate::identify::problem::{FactId, Problem};

type Engines = Vec<(&'static str, Box<dyn Engine + Send>)>;

fn engines() -> Engines {
    vec![("varisat", varisat_engine()), ("batsat", batsat_engine())]
}

pub(super) fn alphabet(symbols: usize) -> Alphabet {
    Alphabet::new((0..symbols).map(|i| format!("s{i}"))).unwrap()
}

/// A table as something that can be compared and put in order.
fn table(dfa: &Dfa) -> Vec<usize> {
    dfa.states()
        .flat_map(|state| {
            let targets = dfa.alphabet().symbols();
            targets
                .map(move |symbol| dfa.next(state, symbol).index())
                .chain([usize::from(dfa.is_accepting(state))])
        })
        .collect()
}

/// All tables with this many states, numbered breadth first, that satisfy the
/// facts: by trying every one.
fn brute_force(problem: &Problem, standing: &[FactId], states: usize) -> BTreeSet<Vec<usize>> {
    let symbols = problem.alphabet().len();
    let edges = states * symbols;
    let mut found = BTreeSet::new();
    for code in 0..states.pow(edges as u32) << states {
        let accepting = (0..states).map(|i| code >> i & 1 == 1).collect();
        let mut rest = code >> states;
        let mut targets = Vec::new();
        for _ in 0..edges {
            targets.push(rest % states);
            rest /= states;
        }
        let mut used = 0;
        let numbered = targets.iter().enumerate().all(|(edge, &target)| {
            let reached = edge / symbols <= used;
            used = used.max(target.min(used + 1));
            reached && target <= used
        });
        if !numbered || used + 1 < states {
            continue;
        }
        let rows: Vec<Vec<usize>> = targets.chunks(symbols).map(<[usize]>::to_vec).collect();
        let dfa = Dfa::new(problem.alphabet().clone(), 0, accepting, &rows).unwrap();
        if consistent(&dfa, problem, standing) {
            found.insert(table(&dfa));
        }
    }
    found
}

fn random_word(rng: &mut ChaCha8Rng, symbols: usize, longest: usize) -> Word {
    let length = rng.random_range(0..=longest);
    (0..length)
        .map(|_| Symbol::new(rng.random_range(0..symbols)))
        .collect()
}

pub(super) fn random_dfa(rng: &mut ChaCha8Rng, symbols: usize, states: usize) -> Dfa {
    let rows: Vec<Vec<usize>> = (0..states)
        .map(|_| (0..symbols).map(|_| rng.random_range(0..states)).collect())
        .collect();
    let accepting = (0..states).map(|_| rng.random()).collect();
    Dfa::new(alphabet(symbols), 0, accepting, &rows).unwrap()
}

/// A fact that is true of the automaton, or with `lies` often not.
pub(super) fn random_fact(
    rng: &mut ChaCha8Rng,
    dfa: &Dfa,
    longest: usize,
    lies: bool,
) -> Fact<Word> {
    let symbols = dfa.alphabet().len();
    let first = random_word(rng, symbols, longest);
    let second = random_word(rng, symbols, longest);
    if lies && rng.random_ratio(1, 8) {
        return Fact::Label {
            accepted: !dfa.accepts(&first),
            atom: first,
        };
    }
    match (dfa.accepts(&first), dfa.accepts(&second)) {
        (accepted, _) if rng.random() => Fact::Label {
            atom: first,
            accepted,
        },
        (worse, better) if worse == better && rng.random() => Fact::Equal { first, second },
        (true, false) => Fact::Below {
            worse: second,
            better: first,
        },
        _ => Fact::Below {
            worse: first,
            better: second,
        },
    }
}

pub(super) fn add_all(problem: &mut Problem, facts: &[Fact<Word>]) -> Vec<FactId> {
    let known = problem.facts().len() as u32;
    let ids = facts
        .iter()
        .enumerate()
        .filter_map(|(i, fact)| problem.add(Some(AnswerId(known + i as u32)), fact));
    ids.collect()
}

pub(super) fn search(
    engine: &mut dyn Engine,
    problem: &Problem,
    standing: &[FactId],
    states: usize,
    count: usize,
) -> Verdict {
    let query = Query {
        problem,
        standing,
        states,
        count,
        seed: 7,
    };
    engine.search(&query, &mut Budget::unlimited())
}

#[test]
fn finds_what_brute_force_finds_and_proves_what_it_refutes() {
    let mut rng = ChaCha8Rng::seed_from_u64(1);
    for round in 0..60 {
        let symbols = rng.random_range(1..=2);
        let dfa = random_dfa(&mut rng, symbols, 3);
        let mut problem = Problem::new(alphabet(symbols));
        let lies = round % 3 == 0;
        let facts: Vec<_> = (0..rng.random_range(3..14))
            .map(|_| random_fact(&mut rng, &dfa, 4, lies))
            .collect();
        let all = add_all(&mut problem, &facts);
        for (name, mut engine) in engines() {
            for states in 1..=3 {
                let expected = brute_force(&problem, &all, states);
                match search(&mut *engine, &problem, &all, states, 10_000) {
                    Verdict::Found { automata, complete } => {
                        assert!(complete, "{name}");
                        let found: BTreeSet<_> = automata.iter().map(table).collect();
                        assert_eq!(found.len(), automata.len(), "{name}: one found twice");
                        assert_eq!(found, expected, "{name}");
                    }
                    Verdict::None { core } => {
                        assert!(expected.is_empty(), "{name}");
                        assert!(brute_force(&problem, &core, states).is_empty(), "{name}");
                        assert!(core.iter().all(|fact| all.contains(fact)), "{name}");
                    }
                    Verdict::OverBudget => panic!("{name} gave up without a budget"),
                }
            }
        }
    }
}

#[test]
fn the_choice_depends_on_the_standing_facts_and_the_seed_alone() {
    let mut rng = ChaCha8Rng::seed_from_u64(2);
    for _ in 0..12 {
        let dfa = random_dfa(&mut rng, 2, 4);
        let facts: Vec<_> = (0..14)
            .map(|_| random_fact(&mut rng, &dfa, 5, false))
            .collect();
        let mut plain = Problem::new(alphabet(2));
        let standing = add_all(&mut plain, &facts);

        // The same facts in another order, between others that are retracted
        // after the engine has worked with them.
        let mut shuffled = facts.clone();
        shuffled.shuffle(&mut rng);
        let mut other = Problem::new(alphabet(2));
        let wrong = random_dfa(&mut rng, 2, 4);
        let retracted: Vec<_> = (0..5)
            .map(|_| random_fact(&mut rng, &wrong, 7, true))
            .collect();
        let mut seen = add_all(&mut other, &retracted);
        let mut kept = Vec::new();

        let (mut one, mut two) = (varisat_engine(), batsat_engine());
        for fact in &shuffled {
            let new = add_all(&mut other, std::slice::from_ref(fact));
            kept.extend_from_slice(&new);
            seen.extend(new);
            search(&mut *one, &other, &seen, 4, 1);
            search(&mut *two, &other, &kept, 3, 5);
        }
        let tables = |verdict: Verdict| match verdict {
            Verdict::Found { automata, .. } => automata.iter().map(table).collect(),
            Verdict::None { .. } => Vec::new(),
            Verdict::OverBudget => panic!("gave up without a budget"),
        };
        for states in 3..=4 {
            let fresh = tables(search(&mut *varisat_engine(), &plain, &standing, states, 3));
            let old = tables(search(&mut *one, &other, &kept, states, 3));
            assert_eq!(fresh, old);
            let old = tables(search(&mut *two, &other, &kept, states, 3));
            assert_eq!(fresh, old);
        }
    }
}

#[test]
fn a_choice_of_some_is_part_of_all_and_differs_between_seeds() {
    let problem = {
        let mut problem = Problem::new(alphabet(2));
        for (length, accepted) in [(0, true), (1, false)] {
            let atom = Word::from(vec![Symbol::new(0); length]);
            problem.add(None, &Fact::Label { atom, accepted });
        }
        problem
    };
    let standing: Vec<_> = (0..2).map(FactId).collect();
    for (name, mut engine) in engines() {
        let all = brute_force(&problem, &standing, 2);
        assert!(all.len() > 4);
        let mut firsts = BTreeSet::new();
        for seed in 0..400 {
            let query = Query {
                problem: &problem,
                standing: &standing,
                states: 2,
                count: 2,
                seed,
            };
            let Verdict::Found { automata, complete } =
                engine.search(&query, &mut Budget::unlimited())
            else {
                panic!("{name} found nothing");
            };
            assert!(!complete);
            assert_eq!(automata.len(), 2);
            assert!(automata.iter().all(|dfa| all.contains(&table(dfa))));
            firsts.insert(table(&automata[0]));
        }
        assert_eq!(
            firsts, all,
            "{name}: every automaton is chosen by some seed"
        );
    }
}

/// Labels that no small automaton explains: random ones.
fn noise(words: usize, longest: usize) -> Problem {
    let mut rng = ChaCha8Rng::seed_from_u64(3);
    let mut problem = Problem::new(alphabet(2));
    let mut seen = BTreeSet::new();
    while seen.len() < words {
        let atom = random_word(&mut rng, 2, longest);
        if seen.insert(atom.clone()) {
            let accepted = rng.random();
            problem.add(None, &Fact::Label { atom, accepted });
        }
    }
    problem
}

#[test]
fn the_budget_stops_a_hard_search_and_the_next_is_answered() {
    let hard = noise(90, 9);
    let all: Vec<_> = (0..90).map(FactId).collect();
    for (name, mut engine) in engines() {
        let query = |standing, states| Query {
            problem: &hard,
            standing,
            states,
            count: 1,
            seed: 0,
        };
        let mut budget = Budget::new(200_000);
        let verdict = engine.search(&query(&all, 14), &mut budget);
        assert!(
            matches!(verdict, Verdict::OverBudget),
            "{name}: {verdict:?}"
        );
        assert!(budget.is_spent(), "{name}");
        // Nothing left, nothing done.
        let verdict = engine.search(&query(&all[..2], 2), &mut budget);
        assert!(
            matches!(verdict, Verdict::OverBudget),
            "{name}: {verdict:?}"
        );
        // The same size, hence the same formula and solver.
        for (standing, states) in [(&all[..5], 14), (&all[..5], 4), (&all[..8], 6)] {
            let mut budget = Budget::new(2_000_000);
            let verdict = engine.search(&query(standing, states), &mut budget);
            assert!(
                matches!(verdict, Verdict::Found { .. }),
                "{name}: {verdict:?}"
            );
            assert!(!budget.is_spent(), "{name}");
        }
    }
}

#[test]
fn the_same_budget_ends_at_the_same_place() {
    let hard = noise(40, 8);
    let all: Vec<_> = (0..40).map(FactId).collect();
    for (name, _) in engines() {
        let run = || {
            let mut engine = match name {
                "varisat" => varisat_engine(),
                _ => batsat_engine(),
            };
            let mut budget = Budget::new(200_000);
            let states = (1..100)
                .find(|&states| {
                    let query = Query {
                        problem: &hard,
                        standing: &all,
                        states,
                        count: 1,
                        seed: 0,
                    };
                    !matches!(engine.search(&query, &mut budget), Verdict::None { .. })
                })
                .unwrap();
            (states, budget.left())
        };
        assert_eq!(run(), run(), "{name}");
    }
}

#[test]
fn an_engine_notices_that_it_is_asked_about_another_problem() {
    for (name, mut engine) in engines() {
        for (symbols, accepted) in [(1, true), (1, false), (2, true)] {
            let mut problem = Problem::new(alphabet(symbols));
            problem.add(
                None,
                &Fact::Label {
                    atom: Word::empty(),
                    accepted,
                },
            );
            let verdict = search(&mut *engine, &problem, &[FactId(0)], 1, 10);
            let Verdict::Found { automata, complete } = verdict else {
                panic!("{name}: {verdict:?}");
            };
            assert!(complete);
            assert_eq!(automata.len(), 1);
            assert_eq!(automata[0].accepts(&Word::empty()), accepted, "{name}");
            assert_eq!(automata[0].alphabet(), problem.alphabet(), "{name}");
        }
    }
}
