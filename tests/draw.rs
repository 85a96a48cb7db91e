//! The pictures of known automata, as they were judged by eye, and what must
//! hold of every picture.

use std::collections::BTreeSet;
use std::time::Duration;

use automata::{Alphabet, Dfa, StateId, Symbol, Word};
use memrep::bench::process_cpu;
use memrep::draw::{self, Captions, Marks, TooLarge};
use rand::{Rng, RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

fn dfa(names: &[&str], accepting: &[usize], delta: &[Vec<usize>]) -> Dfa {
    let alphabet = Alphabet::new(names.iter().copied()).unwrap();
    let accepting = (0..delta.len()).map(|state| accepting.contains(&state));
    Dfa::new(alphabet, 0, accepting.collect(), delta).unwrap()
}

/// Over `0`, `1`; one row a state.
fn bits(accepting: &[usize], delta: &[[usize; 2]]) -> Dfa {
    let rows: Vec<Vec<usize>> = delta.iter().map(|row| row.to_vec()).collect();
    dfa(&["0", "1"], accepting, &rows)
}

/// Fig. 5.2: R lava, Y recharge, B water, O dryer.
fn robot() -> Dfa {
    let (failed, wet, dry, recharged) = (3, 1, 0, 2);
    dfa(
        &["R", "Y", "B", "O"],
        &[recharged],
        &[
            vec![failed, recharged, wet, dry],
            vec![failed, failed, wet, dry],
            vec![failed, recharged, wet, recharged],
            vec![failed; 4],
        ],
    )
}

fn human() -> Captions {
    let words = [
        ("R", "lava"),
        ("Y", "recharge"),
        ("B", "water"),
        ("O", "dryer"),
    ];
    Captions {
        title: Some("The robot's rule".to_owned()),
        words: words.map(|(a, b)| (a.to_owned(), b.to_owned())).into(),
        phrases: false,
    }
}

fn with_phrases() -> Captions {
    Captions {
        phrases: true,
        ..human()
    }
}

fn unmarked(dfa: &Dfa, captions: &Captions) -> Result<String, TooLarge> {
    draw::svg(dfa, captions, &Marks::default())
}

fn gallery() -> Vec<(&'static str, Dfa, Captions)> {
    let plain = Captions::default;
    vec![
        ("tomita_1", bits(&[0], &[[1, 0], [1, 1]]), plain()),
        ("tomita_2", bits(&[0], &[[1, 2], [1, 1], [0, 1]]), plain()),
        (
            "tomita_3",
            bits(&[0, 1, 3], &[[0, 1], [2, 0], [3, 4], [2, 3], [4, 4]]),
            plain(),
        ),
        (
            "tomita_4",
            bits(&[0, 1, 2], &[[1, 0], [2, 0], [3, 0], [3, 3]]),
            plain(),
        ),
        (
            "tomita_5",
            bits(&[0], &[[1, 2], [0, 3], [3, 0], [2, 1]]),
            plain(),
        ),
        ("tomita_6", bits(&[0], &[[1, 2], [2, 0], [0, 1]]), plain()),
        (
            "tomita_7",
            bits(&[0, 1, 2, 3], &[[0, 1], [2, 1], [2, 3], [4, 3], [4, 4]]),
            plain(),
        ),
        ("robot", robot(), plain()),
        ("robot_in_words", robot(), human()),
        ("robot_with_phrases", robot(), with_phrases()),
        ("one_state", bits(&[0], &[[0, 0]]), plain()),
        ("nothing_accepted", bits(&[], &[[0, 0]]), plain()),
        ("twenty_four_states", ring(draw::MAX_STATES), plain()),
        (
            "otherwise",
            dfa(
                &["a", "b", "c", "d", "e", "f"],
                &[2],
                &[vec![1, 0, 0, 0, 0, 2], vec![1, 1, 2, 0, 2, 1], vec![2; 6]],
            ),
            plain(),
        ),
        (
            "eight_states",
            dfa(
                &["a", "b", "c"],
                &[3, 6],
                &[
                    vec![1, 2, 0],
                    vec![3, 4, 1],
                    vec![2, 5, 4],
                    vec![6, 0, 5],
                    vec![4, 7, 1],
                    vec![5, 5, 6],
                    vec![7, 3, 6],
                    vec![0, 7, 2],
                ],
            ),
            plain(),
        ),
    ]
}

#[test]
fn pictures_stay_as_they_were_judged() {
    for (name, dfa, captions) in gallery() {
        insta::assert_snapshot!(name, draw::document(&dfa, &captions).unwrap());
    }
}

/// To be written anew, by `memrep convert` or from the snapshot, when drawings
/// change.
#[test]
fn the_picture_in_the_readme_is_drawn_by_us() {
    let drawn = draw::document(&robot(), &human()).unwrap();
    assert_eq!(drawn, include_str!("../docs/images/robot.svg"));
}

#[test]
fn an_element_obeys_a_strict_content_policy() {
    for (name, dfa, captions) in gallery() {
        let svg = unmarked(&dfa, &captions).unwrap();
        assert!(svg.starts_with("<svg "), "{name}");
        for banned in ["style", "<script", " on", "href", "NaN", "inf"] {
            let found = svg.find(banned).map(|at| &svg[at..]);
            // Words of the description may begin with "on" or hold "inf".
            let text = svg.split("</desc>").nth(1).unwrap();
            assert!(!text.contains(banned), "{name}: {banned} in {found:?}");
        }
    }
}

#[test]
fn hostile_words_stay_words() {
    let mut captions = human();
    let hostile = "</text><script>alert('1')</script>&\"\u{0}";
    captions.words.insert("Y".to_owned(), hostile.to_owned());
    captions.title = Some(hostile.to_owned());
    for svg in [
        unmarked(&robot(), &captions).unwrap(),
        draw::document(&robot(), &captions).unwrap(),
    ] {
        assert!(!svg.contains("<script"), "{svg}");
        assert!(!svg.contains('\u{0}'));
        assert!(svg.contains("&lt;script&gt;alert(&#39;1&#39;)"));
    }
}

#[test]
fn a_hidden_sink_is_told() {
    let told = |dfa: &Dfa| unmarked(dfa, &Captions::default()).unwrap();
    assert!(told(&robot()).contains("Anything else fails.</text>"));
    assert!(!told(&robot()).contains("data-state=\"4\""));
    let even = bits(&[0], &[[1, 0], [0, 1]]);
    assert!(!told(&even).contains("Anything else fails."));
    // Nothing is hidden where the start itself is the sink.
    assert!(told(&bits(&[], &[[0, 0]])).contains("data-state=\"0\""));
}

/// A ring of `states` in which every state can also be left for two others.
fn ring(states: usize) -> Dfa {
    let rows: Vec<Vec<usize>> = (0..states)
        .map(|q| vec![(q + 1) % states, q * 7 % states, q * 5 % states])
        .collect();
    dfa(&["a", "b", "c"], &[0], &rows)
}

#[test]
fn a_crowd_is_not_drawn() {
    assert!(unmarked(&ring(draw::MAX_STATES), &Captions::default()).is_ok());
    let error = unmarked(&ring(draw::MAX_STATES + 1), &Captions::default()).unwrap_err();
    assert_eq!(error.states, draw::MAX_STATES + 1);
    assert!(error.to_string().contains("use the table"), "{error}");
    // States that cannot be reached do not count.
    let mut rows = vec![vec![0, 0]; 100];
    rows[0] = vec![0, 1];
    rows[1] = vec![1, 0];
    assert!(unmarked(&dfa(&["a", "b"], &[0], &rows), &Captions::default()).is_ok());
}

/// Any automaton with up to 24 states gives a picture or the refusal, the same
/// bytes each time.
#[test]
fn random_automata_are_drawn_twice_the_same() {
    let mut rng = ChaCha8Rng::seed_from_u64(5);
    for _ in 0..60 {
        let states = rng.random_range(1..=draw::MAX_STATES);
        let symbols = rng.random_range(1..=5);
        let names: Vec<String> = (0..symbols).map(|s| format!("s{s}")).collect();
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        let accepting: Vec<usize> = (0..states).filter(|_| rng.next_u32() % 3 == 0).collect();
        let rows: Vec<Vec<usize>> = (0..states)
            .map(|_| (0..symbols).map(|_| rng.random_range(0..states)).collect())
            .collect();
        let random = dfa(&names, &accepting, &rows);
        let first = unmarked(&random, &Captions::default());
        assert_eq!(first, unmarked(&random, &Captions::default()));
        if let Ok(svg) = first {
            assert!(!svg.contains("NaN") && !svg.contains("inf\""));
        }
    }
}

/// A random automaton of so many states, all of them reachable, of which each has as
/// many ways out as there are symbols.
fn crowd(states: usize, symbols: usize, rng: &mut ChaCha8Rng) -> Dfa {
    let names: Vec<String> = (0..symbols).map(|s| format!("symbol{s}")).collect();
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    let accepting: Vec<usize> = (0..states).filter(|state| state % 3 == 1).collect();
    let mut any = |state: usize, symbol: usize| match symbol {
        0 => (state + 1) % states,
        _ => rng.random_range(0..states),
    };
    let rows: Vec<Vec<usize>> = (0..states)
        .map(|state| (0..symbols).map(|symbol| any(state, symbol)).collect())
        .collect();
    dfa(&names, &accepting, &rows)
}

/// Tests are not optimised: the released program takes a fraction of this.
#[test]
fn the_largest_pictures_take_300_milliseconds_at_most() {
    let mut rng = ChaCha8Rng::seed_from_u64(9);
    let captions = Captions {
        phrases: true,
        ..Captions::default()
    };
    let (mut slowest, mut drawn) = (Duration::ZERO, 0);
    for (symbols, states) in [(2, 24), (4, 24), (5, 24), (8, 15)] {
        for _ in 0..5 {
            let crowd = crowd(states, symbols, &mut rng);
            let begun = process_cpu();
            drawn += usize::from(unmarked(&crowd, &captions).is_ok());
            slowest = slowest.max(process_cpu().saturating_sub(begun));
        }
    }
    println!("the slowest of {drawn} pictures took {slowest:?}");
    assert!(drawn > 15, "only {drawn} were small enough");
    assert!(slowest < Duration::from_millis(300), "{slowest:?}");
}

/// The words for the states of a rule that only its table shows.
#[test]
fn a_hundred_states_are_told_in_words_at_once() {
    let mut rng = ChaCha8Rng::seed_from_u64(10);
    for symbols in [1, 2, 8, 64] {
        let crowd = crowd(100, symbols, &mut rng);
        let begun = process_cpu();
        assert_eq!(draw::phrases(&crowd, &Captions::default().words).len(), 100);
        let took = process_cpu().saturating_sub(begun);
        println!("{symbols} symbols: {took:?}");
        assert!(took < Duration::from_millis(300), "{took:?}");
    }
}

/// The robot's rule as it might have been before: there, water is no harm.
fn robot_before() -> Dfa {
    dfa(
        &["R", "Y", "B", "O"],
        &[1],
        &[vec![2, 1, 0, 0], vec![2, 1, 0, 1], vec![2; 4]],
    )
}

#[test]
fn marked_pictures_stay_as_they_were_judged() {
    let (shown, before) = (robot().minimise(), robot_before());
    let new = Marks::new_since(&shown, &before);
    let svg = |dfa: &Dfa, marks: &Marks| draw::svg(dfa, &with_phrases(), marks).unwrap();
    insta::assert_snapshot!("robot_new", svg(&shown, &new));
    let there = Marks::in_dispute(&shown, &before);
    let here = Marks::in_dispute(&before, &shown);
    insta::assert_snapshot!("robot_disputed", svg(&shown, &there));
    insta::assert_snapshot!("robot_disputed_other", svg(&before, &here));
    // Colour alone would not do.
    for (picture, word) in [
        (svg(&shown, &new), "new"),
        (svg(&before, &here), "in dispute"),
    ] {
        let (description, drawn) = picture.split_once("</desc>").unwrap();
        assert!(description.contains(&format!("({word}")), "{description}");
        assert!(drawn.contains(&format!("({word}")), "{drawn}");
    }
    assert!(svg(&before, &here).contains("stroke-dasharray"));
}

#[test]
fn a_marked_sink_is_drawn() {
    // Only the third `a` in a row fails, or the second does.
    let names = ["a", "b"];
    let three = dfa(
        &names,
        &[0, 1, 2],
        &[vec![1, 0], vec![2, 0], vec![3, 0], vec![3, 3]],
    );
    let two = dfa(&names, &[0, 1], &[vec![1, 0], vec![2, 0], vec![2, 2]]);
    let plain = unmarked(&two, &Captions::default()).unwrap();
    assert!(!plain.contains("data-to=\"2\""));
    let marks = Marks::in_dispute(&two, &three);
    let marked = draw::svg(&two, &Captions::default(), &marks).unwrap();
    assert!(
        marked.contains("class=\"state disputed\" data-state=\"2\""),
        "{marked}"
    );
    assert_eq!(marked.matches("data-to=\"2\"").count(), 1, "{marked}");
}

/// A minimal automaton of up to so many states over two symbols.
fn random(rng: &mut ChaCha8Rng, most: usize) -> Dfa {
    let states = rng.random_range(1..=most);
    let accepting: Vec<usize> = (0..states)
        .filter(|_| rng.next_u32().is_multiple_of(2))
        .collect();
    let rows: Vec<[usize; 2]> = (0..states)
        .map(|_| [0; 2].map(|_| rng.random_range(0..states)))
        .collect();
    bits(&accepting, &rows).minimise()
}

/// The definition word by word: for each state the least of its shortest words,
/// of all words in their order.
fn differing(one: &Dfa, other: &Dfa) -> (BTreeSet<StateId>, BTreeSet<(StateId, Symbol)>) {
    let mut words = vec![Word::empty()];
    let mut from = 0;
    for _ in 0..one.size() {
        let to = words.len();
        for at in from..to {
            for symbol in one.alphabet().symbols() {
                let mut longer = words[at].clone();
                longer.push(symbol);
                words.push(longer);
            }
        }
        from = to;
    }
    let access = |state: StateId| words.iter().find(|word| one.run(word) == state).unwrap();
    let home = |there: StateId| {
        let mut states: Vec<StateId> = one.states().collect();
        states.sort_by_key(|&state| (access(state).len(), access(state).clone()));
        let mut homes = states.into_iter();
        homes.find(|&state| other.run(access(state)) == there)
    };
    let mut states = BTreeSet::new();
    let mut arrows = BTreeSet::new();
    for state in one.states() {
        let there = other.run(access(state));
        if home(there) != Some(state) || one.is_accepting(state) != other.is_accepting(there) {
            states.insert(state);
        }
        for symbol in one.alphabet().symbols() {
            if home(other.next(there, symbol)) != Some(one.next(state, symbol)) {
                arrows.insert((state, symbol));
            }
        }
    }
    (states, arrows)
}

#[test]
fn marks_are_what_their_definition_says() {
    let mut rng = ChaCha8Rng::seed_from_u64(7);
    let mut equal = 0;
    for round in 0..400 {
        let one = random(&mut rng, 4);
        let other = random(&mut rng, 4);
        let marks = Marks::in_dispute(&one, &other);
        let found = (marks.states().collect(), marks.arrows().collect());
        assert_eq!(found, differing(&one, &other), "{round}: {one:?} {other:?}");
        assert_eq!(marks.is_empty(), one == other, "{one:?} {other:?}");
        assert_eq!(marks.is_empty(), Marks::new_since(&one, &other).is_empty());
        equal += usize::from(one == other);
    }
    assert!((1..400).contains(&equal), "{equal}");
}

/// Every state has a phrase of its own, whatever the automaton.
#[test]
fn no_two_states_share_a_phrase() {
    let mut rng = ChaCha8Rng::seed_from_u64(8);
    for _ in 0..300 {
        let random = random(&mut rng, 12);
        let phrases = draw::phrases(&random, &human().words);
        assert_eq!(phrases.len(), random.size());
        let different: BTreeSet<&String> = phrases.iter().collect();
        assert_eq!(different.len(), phrases.len(), "{phrases:?}");
    }
}

#[test]
fn the_robot_is_told_in_words() {
    assert_eq!(
        draw::phrases(&robot(), &human().words),
        [
            "at the start",
            "fine so far",
            "waiting for the dryer",
            "failed for good"
        ]
    );
    let even = bits(&[0], &[[1, 0], [0, 1]]);
    assert_eq!(
        draw::phrases(&even, &Captions::default().words),
        ["at the start", "waiting for 0"]
    );
    let once = bits(&[1], &[[1, 0], [1, 1]]);
    assert_eq!(
        draw::phrases(&once, &Captions::default().words),
        ["at the start", "done"]
    );
}

#[test]
fn drawn_states_are_numbered_without_gaps() {
    for (name, dfa, captions) in gallery() {
        let svg = unmarked(&dfa, &captions).unwrap();
        let drawn = svg.matches("data-state=").count();
        for number in 0..drawn {
            assert!(svg.contains(&format!("data-state=\"{number}\"")), "{name}");
        }
        assert!(draw::numbered(&dfa).len() <= drawn + 1, "{name}");
    }
}

/// The number and the place of every circle.
fn circles(svg: &str) -> Vec<(String, f64, f64)> {
    let value = |text: &str, name: &str| -> String {
        let rest = text.split_once(&format!("{name}=\"")).unwrap().1;
        rest.split('"').next().unwrap().to_owned()
    };
    (svg.split("data-state=\"").skip(1))
        .map(|part| {
            let number = part.split('"').next().unwrap().to_owned();
            let at = |name| value(part, name).parse().unwrap();
            (number, at("cx"), at("cy"))
        })
        .collect()
}

/// The circles of each column, from left to right.
fn columns(circles: &[(String, f64, f64)]) -> Vec<Vec<&String>> {
    let mut sorted: Vec<_> = circles.iter().collect();
    sorted.sort_by(|a, b| a.1.total_cmp(&b.1));
    let columns = sorted.chunk_by(|a, b| (a.1 - b.1).abs() < 1.0);
    columns
        .map(|column| column.iter().map(|(number, ..)| number).collect())
        .collect()
}

/// One arrow that goes elsewhere, and is nobody's first way to a state, leaves
/// every number and every column alone.
#[test]
fn one_other_arrow_moves_little() {
    let rows = [[1, 2], [3, 1], [2, 4], [3, 0], [4, 3]];
    let draw = |rows: &[[usize; 2]]| unmarked(&bits(&[3], rows), &Captions::default()).unwrap();
    let before = circles(&draw(&rows));
    for (from, symbol, to) in [(1, 1, 3), (3, 0, 1), (4, 0, 2), (3, 1, 1), (2, 0, 4)] {
        let mut other = rows;
        assert_ne!(other[from][symbol], to);
        other[from][symbol] = to;
        let after = circles(&draw(&other));
        assert_eq!(columns(&before), columns(&after), "{from} {symbol} {to}");
        for ((number, x, _), (same, moved, _)) in before.iter().zip(&after) {
            assert_eq!(number, same);
            // Labels on fewer arrows take less room.
            assert!((x - moved).abs() <= 44.0, "{number}: {x} {moved}");
        }
    }
}
