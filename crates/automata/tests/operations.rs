//! Every operation against brute force over all words up to length 8, on 10,000
//! random automata.

mod support;

use std::collections::BTreeSet;

use automata::{Alphabet, BigUint, Dfa, StateId, Word};
use rand::RngExt;
use support::{alphabet, dfa, generator};

/// The longest words that brute force looks at.
const LONGEST: usize = 8;

/// Pairs of random automata: 10,000 automata.
const CASES: u64 = 5_000;

/// All words up to [`LONGEST`] over 1, 2 and 3 symbols, made once.
fn all_words() -> [Vec<Word>; 3] {
    [1, 2, 3].map(|symbols| alphabet(symbols).words_up_to(LONGEST).collect())
}

/// Runs `check` on pairs of random automata over the same alphabet and all
/// words of that alphabet.
fn for_pairs(check: impl Fn(&Dfa, &Dfa, &[Word])) {
    let words = all_words();
    for seed in 0..CASES {
        let mut random = generator(seed);
        let alphabet = alphabet(random.random_range(1..=3));
        let first = dfa(&alphabet, 8, &mut random);
        let second = dfa(&alphabet, 8, &mut random);
        check(&first, &second, &words[alphabet.len() - 1]);
    }
}

/// Which of `words` an automaton accepts.
fn language(dfa: &Dfa, words: &[Word]) -> Vec<bool> {
    words.iter().map(|word| dfa.accepts(word)).collect()
}

/// The number of classes of reachable states that no word tells apart, by
/// rounds over the definition: two states with 8 states or fewer differ on a
/// word of at most 7 symbols or on none.
fn nerode_classes(dfa: &Dfa, words: &[Word]) -> usize {
    let reachable: BTreeSet<StateId> = words.iter().map(|word| dfa.run(word)).collect();
    reachable
        .into_iter()
        .map(|from| {
            let tails = words.iter().filter(|word| word.len() < 8);
            tails
                .map(|word| {
                    let end = word.iter().fold(from, |q, symbol| dfa.next(q, symbol));
                    dfa.is_accepting(end)
                })
                .collect::<Vec<bool>>()
        })
        .collect::<BTreeSet<_>>()
        .len()
}

#[test]
fn boolean_operations_are_pointwise() {
    for_pairs(|first, second, words| {
        let p = language(first, words);
        let q = language(second, words);
        let zip = |f: fn(bool, bool) -> bool| -> Vec<bool> {
            p.iter().zip(&q).map(|(&p, &q)| f(p, q)).collect()
        };
        assert_eq!(language(&first.complement(), words), zip(|p, _| !p));
        assert_eq!(
            language(&first.and(second).unwrap(), words),
            zip(|p, q| p && q)
        );
        assert_eq!(
            language(&first.or(second).unwrap(), words),
            zip(|p, q| p || q)
        );
        assert_eq!(
            language(&first.xor(second).unwrap(), words),
            zip(|p, q| p != q)
        );
        let minus = first.product(second, |p, q| p && !q).unwrap();
        assert_eq!(language(&minus, words), zip(|p, q| p && !q));
    });
}

#[test]
fn minimal_automata_have_one_state_a_nerode_class() {
    for_pairs(|first, second, words| {
        for dfa in [first, second] {
            let minimal = dfa.minimise();
            assert_eq!(language(&minimal, words), language(dfa, words));
            assert_eq!(minimal.size(), nerode_classes(dfa, words));
            assert_eq!(minimal, minimal.canonical());
            assert_eq!(minimal, minimal.minimise());
        }
    });
}

#[test]
fn minimal_automata_are_equal_exactly_for_equal_languages() {
    for_pairs(|first, second, _| {
        let equivalent = first.is_equivalent(second).unwrap();
        assert_eq!(first.minimise() == second.minimise(), equivalent);
        // The same language by another, larger automaton.
        let doubled = first.or(&first.and(second).unwrap()).unwrap();
        assert_eq!(doubled.minimise(), first.minimise());
    });
}

#[test]
fn minimises_products_of_thousands_of_states() {
    let mut random = generator(7);
    let alphabet = alphabet(3);
    let mut large = dfa(&alphabet, 8, &mut random);
    while large.size() < 4_000 {
        large = large.xor(&dfa(&alphabet, 8, &mut random)).unwrap();
    }
    let minimal = large.minimise();
    assert!(minimal.is_equivalent(&large).unwrap());
    // No two states of the minimal automaton accept the same words.
    let from = |start: usize| {
        let rows: Vec<Vec<usize>> = minimal
            .states()
            .map(|q| {
                let symbols = alphabet.symbols();
                symbols.map(|a| minimal.next(q, a).index()).collect()
            })
            .collect();
        let accepting = minimal.states().map(|q| minimal.is_accepting(q)).collect();
        Dfa::new(alphabet.clone(), start, accepting, &rows).unwrap()
    };
    for _ in 0..20 {
        let p = random.random_range(0..minimal.size());
        let q = random.random_range(0..minimal.size());
        assert_eq!(from(p).is_equivalent(&from(q)).unwrap(), p == q);
    }
}

#[test]
fn canonical_numbering_is_breadth_first() {
    for_pairs(|first, _, words| {
        let canonical = first.canonical();
        assert_eq!(language(&canonical, words), language(first, words));
        assert_eq!(canonical, canonical.canonical());
        // The words come in length-lexicographic order, so states appear for
        // the first time in breadth-first order: 0, 1, 2, …
        let mut seen = Vec::new();
        let mut states = BTreeSet::new();
        for word in words {
            let state = canonical.run(word);
            if !seen.contains(&state) {
                seen.push(state);
            }
            states.insert(first.run(word));
        }
        assert_eq!(seen, canonical.states().collect::<Vec<_>>());
        assert_eq!(states.len(), canonical.size());
        assert_eq!(
            first.reachable().into_iter().collect::<BTreeSet<_>>(),
            states
        );
    });
}

#[test]
fn canonical_forms_forget_how_states_were_numbered() {
    for seed in 0..500 {
        let mut random = generator(seed);
        let alphabet = alphabet(random.random_range(1..=3));
        let original = dfa(&alphabet, 8, &mut random);
        // A random permutation of the states.
        let mut to: Vec<usize> = (0..original.size()).collect();
        for i in (1..to.len()).rev() {
            to.swap(i, random.random_range(0..=i));
        }
        let mut rows = vec![Vec::new(); to.len()];
        let mut accepting = vec![false; to.len()];
        for state in original.states() {
            let symbols = alphabet.symbols();
            rows[to[state.index()]] = symbols
                .map(|a| to[original.next(state, a).index()])
                .collect();
            accepting[to[state.index()]] = original.is_accepting(state);
        }
        let start = to[original.start().index()];
        let renamed = Dfa::new(alphabet, start, accepting, &rows).unwrap();
        assert_eq!(renamed.canonical(), original.canonical());
    }
}

#[test]
fn witnesses_are_least() {
    for_pairs(|first, second, words| {
        let difference = first.shortest_difference(second).unwrap();
        let brute = words.iter().find(|w| first.accepts(w) != second.accepts(w));
        match brute {
            Some(word) => assert_eq!(difference.as_ref(), Some(word)),
            // Two automata of 8 states may differ only on longer words.
            None => assert!(difference.is_none_or(|word| {
                word.len() > LONGEST && first.accepts(&word) != second.accepts(&word)
            })),
        }
        let accepted = words.iter().find(|word| first.accepts(word));
        assert_eq!(first.shortest_accepted().as_ref(), accepted);
        assert_eq!(first.is_empty(), accepted.is_none());
        assert_eq!(first.shortest_difference(first).unwrap(), None);
        assert!(first.is_equivalent(&first.minimise()).unwrap());
    });
}

#[test]
fn accepted_words_come_in_order_and_end_with_the_language() {
    for_pairs(|first, second, words| {
        // A part of the cases is finite: the words that the first accepts of
        // those with fewer than 4 symbols.
        for dfa in [first.clone(), first.and(&shorter_than(4, second)).unwrap()] {
            let expected: Vec<&Word> = words.iter().filter(|w| dfa.accepts(w)).collect();
            let found: Vec<Word> = dfa
                .accepted_words()
                .take_while(|word| word.len() <= LONGEST)
                .collect();
            assert_eq!(found.iter().collect::<Vec<_>>(), expected);
            // With 8 states or fewer, an infinite language has a word of 8 to
            // 15 symbols; the finite ones here have none of 8 or more.
            let longer = dfa.accepted_words().find(|word| word.len() >= 8);
            assert_eq!(dfa.is_finite(), longer.is_none());
        }
    });
}

/// Accepts the words of fewer than `length` symbols.
fn shorter_than(length: usize, like: &Dfa) -> Dfa {
    let symbols = like.alphabet().len();
    let rows: Vec<Vec<usize>> = (0..=length)
        .map(|q| vec![(q + 1).min(length); symbols])
        .collect();
    let accepting = (0..=length).map(|q| q < length).collect();
    Dfa::new(like.alphabet().clone(), 0, accepting, &rows).unwrap()
}

#[test]
fn live_states_are_those_that_still_accept() {
    for_pairs(|first, _, words| {
        for (state, live) in first.states().zip(first.live()) {
            let accepts = words.iter().any(|word| {
                let end = word.iter().fold(state, |q, symbol| first.next(q, symbol));
                first.is_accepting(end)
            });
            assert_eq!(live, accepts);
        }
    });
}

#[test]
fn counts_are_exact() {
    for_pairs(|first, _, words| {
        let counts = first.word_counts(LONGEST);
        let mut sum = 0u32;
        for length in 0..=LONGEST {
            let of_length = words.iter().filter(|w| w.len() == length);
            let number = of_length.filter(|w| first.accepts(w)).count() as u32;
            sum += number;
            assert_eq!(first.count_of_length(length), BigUint::from(number));
            assert_eq!(first.count_up_to(length), BigUint::from(sum));
            assert_eq!(*counts.of_length(length), BigUint::from(number));
        }
        assert_eq!(counts.total(), BigUint::from(sum));
        // Ranks run through the accepted words in order.
        let mut accepted = words.iter().filter(|w| first.accepts(w));
        for rank in 0..10u32 {
            assert_eq!(counts.word(rank.into()).as_ref(), accepted.next());
        }
        assert_eq!(counts.word(sum.into()), None);
    });
}

#[test]
fn counts_outgrow_every_machine_word() {
    let alphabet = alphabet(3);
    let all = Dfa::new(alphabet, 0, vec![true], &[vec![0, 0, 0]]).unwrap();
    assert_eq!(all.count_of_length(200), BigUint::from(3u8).pow(200));
    let sum = (BigUint::from(3u8).pow(201) - 1u8) / 2u8;
    assert_eq!(all.count_up_to(200), sum);
}

/// Whether `observed` fits a uniform distribution: the chi-square statistic
/// stays below its mean plus five standard deviations.
fn is_uniform(observed: &[u32]) -> bool {
    let cells = observed.len() as f64;
    let expected = f64::from(observed.iter().sum::<u32>()) / cells;
    let statistic: f64 = observed
        .iter()
        .map(|&n| (f64::from(n) - expected).powi(2) / expected)
        .sum();
    let freedom = cells - 1.0;
    statistic < freedom + 5.0 * (2.0 * freedom).sqrt()
}

#[test]
fn samples_are_uniform() {
    let alphabet = alphabet(2);
    // An even number of `a`, no `bb`: few words, unevenly spread over states.
    let rows = [vec![2, 1], vec![2, 4], vec![0, 3], vec![0, 4], vec![4, 4]];
    let accepting = vec![true, true, false, false, false];
    let dfa = Dfa::new(alphabet, 0, accepting, &rows).unwrap();
    let counts = dfa.word_counts(7);
    let mut random = generator(11);
    let draws = 40_000;

    let words: Vec<Word> = dfa.accepted_words().take_while(|w| w.len() <= 7).collect();
    let mut observed = vec![0; words.len()];
    for _ in 0..draws {
        let word = counts.sample(&mut random).unwrap();
        observed[words.binary_search(&word).unwrap()] += 1;
    }
    assert!(is_uniform(&observed), "{observed:?}");

    let words: Vec<Word> = words.into_iter().filter(|w| w.len() == 7).collect();
    let mut observed = vec![0; words.len()];
    for _ in 0..draws {
        let word = counts.sample_of_length(7, &mut random).unwrap();
        observed[words.binary_search(&word).unwrap()] += 1;
    }
    assert!(is_uniform(&observed), "{observed:?}");
    // The test can fail: a remainder in place of a uniform draw would not pass.
    assert!(!is_uniform(&[2_000, 1_000, 1_000, 1_000]));
}

#[test]
fn samples_are_the_same_on_every_machine() {
    let alphabet = alphabet(2);
    let dfa = Dfa::new(
        alphabet.clone(),
        0,
        vec![true, false],
        &[vec![1, 0], vec![0, 1]],
    )
    .unwrap();
    let counts = dfa.word_counts(40);
    let mut random = generator(3);
    let drawn: Vec<String> = (0..3)
        .map(|_| {
            alphabet
                .spell(&counts.sample(&mut random).unwrap())
                .collect()
        })
        .collect();
    insta::assert_debug_snapshot!(drawn);
}

#[test]
fn nothing_is_drawn_where_nothing_is_accepted() {
    let alphabet = alphabet(1);
    let none = Dfa::new(alphabet.clone(), 0, vec![false], &[vec![0]]).unwrap();
    let mut random = generator(0);
    assert_eq!(none.word_counts(5).sample(&mut random), None);
    let only_empty = Dfa::new(alphabet, 0, vec![true, false], &[vec![1], vec![1]]).unwrap();
    let counts = only_empty.word_counts(5);
    assert_eq!(counts.sample_of_length(2, &mut random), None);
    assert_eq!(counts.sample(&mut random), Some(Word::empty()));
}

#[test]
fn different_alphabets_are_refused() {
    let first = dfa(&alphabet(2), 3, &mut generator(0));
    let second = dfa(&alphabet(3), 3, &mut generator(0));
    let error = first.shortest_difference(&second).unwrap_err();
    assert_eq!(
        error.to_string(),
        "the alphabets differ: {a, b} and {a, b, c}; give both the same symbols in the same order"
    );
    assert_eq!(first.and(&second).unwrap_err(), error);
    assert_eq!(first.is_equivalent(&second).unwrap_err(), error);
}

#[test]
fn reordering_symbols_keeps_the_language() {
    for seed in 0..200 {
        let first = dfa(&alphabet(3), 8, &mut generator(seed));
        let other = Alphabet::new(["c", "a", "b"]).unwrap();
        let turned = first.reordered(&other).unwrap();
        for word in alphabet(3).words_up_to(5) {
            let same = other.word(first.alphabet().spell(&word)).unwrap();
            assert_eq!(turned.accepts(&same), first.accepts(&word));
        }
        assert_eq!(turned.reordered(first.alphabet()).unwrap(), first);
    }
    let first = dfa(&alphabet(3), 8, &mut generator(0));
    assert!(first.reordered(&alphabet(2)).is_err());
    assert!(
        first
            .reordered(&Alphabet::new(["a", "b", "d"]).unwrap())
            .is_err()
    );
}

#[test]
fn words_of_an_alphabet_come_in_order_without_gaps() {
    for symbols in 1..=3 {
        let words: Vec<Word> = alphabet(symbols).words_up_to(6).collect();
        assert!(words.windows(2).all(|pair| pair[0] < pair[1]));
        let expected: usize = (0..=6).map(|n| symbols.pow(n)).sum();
        assert_eq!(words.len(), expected);
    }
}
