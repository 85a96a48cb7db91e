//! The pictures of known automata, as they were judged by eye, and what must
//! hold of every picture.

use automata::{Alphabet, Dfa};
use memrep::draw::{self, Captions};
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
    }
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
        ("one_state", bits(&[0], &[[0, 0]]), plain()),
        ("nothing_accepted", bits(&[], &[[0, 0]]), plain()),
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

#[test]
fn an_element_obeys_a_strict_content_policy() {
    for (name, dfa, captions) in gallery() {
        let svg = draw::svg(&dfa, &captions).unwrap();
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
        draw::svg(&robot(), &captions).unwrap(),
        draw::document(&robot(), &captions).unwrap(),
    ] {
        assert!(!svg.contains("<script"), "{svg}");
        assert!(!svg.contains('\u{0}'));
        assert!(svg.contains("&lt;script&gt;alert(&#39;1&#39;)"));
    }
}

#[test]
fn a_hidden_sink_is_told() {
    let told = |dfa: &Dfa| draw::svg(dfa, &Captions::default()).unwrap();
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
    assert!(draw::svg(&ring(draw::MAX_STATES), &Captions::default()).is_ok());
    let error = draw::svg(&ring(draw::MAX_STATES + 1), &Captions::default()).unwrap_err();
    assert_eq!(error.states, draw::MAX_STATES + 1);
    assert!(error.to_string().contains("use the table"), "{error}");
    // States that cannot be reached do not count.
    let mut rows = vec![vec![0, 0]; 100];
    rows[0] = vec![0, 1];
    rows[1] = vec![1, 0];
    assert!(draw::svg(&dfa(&["a", "b"], &[0], &rows), &Captions::default()).is_ok());
}

/// Any automaton with up to 24 states gives a picture or the refusal, the same
/// bytes each time.
#[test]
fn random_automata_are_drawn_twice_the_same() {
    let mut rng = ChaCha8Rng::seed_from_u64(5);
    for _ in 0..150 {
        let states = rng.random_range(1..=draw::MAX_STATES);
        let symbols = rng.random_range(1..=5);
        let names: Vec<String> = (0..symbols).map(|s| format!("s{s}")).collect();
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        let accepting: Vec<usize> = (0..states).filter(|_| rng.next_u32() % 3 == 0).collect();
        let rows: Vec<Vec<usize>> = (0..states)
            .map(|_| (0..symbols).map(|_| rng.random_range(0..states)).collect())
            .collect();
        let random = dfa(&names, &accepting, &rows);
        let first = draw::svg(&random, &Captions::default());
        assert_eq!(first, draw::svg(&random, &Captions::default()));
        if let Ok(svg) = first {
            assert!(!svg.contains("NaN") && !svg.contains("inf\""));
        }
    }
}
