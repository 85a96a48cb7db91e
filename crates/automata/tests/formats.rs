//! Every format: good files read back as written, bad ones say where and why.

mod support;

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use automata::format::json::{Document, Provenance};
use automata::format::{ReadError, WriteError, abbadingo, dot, dot_people, hoa, json, jsonl};
use automata::{Alphabet, Dfa, Item, Sample, Word};
use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use support::{alphabet, dfa, generator, word};

/// The test files of a format, in the order of their names.
fn files(kind: &str, format: &str) -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data");
    let entries = std::fs::read_dir(folder.join(kind).join(format)).unwrap();
    let mut paths: Vec<PathBuf> = entries.map(|entry| entry.unwrap().path()).collect();
    paths.sort();
    assert!(!paths.is_empty());
    paths
}

/// What reading each bad file says, one line a file.
fn complaints<T: std::fmt::Debug>(
    format: &str,
    read: impl Fn(&str) -> Result<T, ReadError>,
) -> String {
    let mut all = String::new();
    for path in files("bad", format) {
        let text = std::fs::read_to_string(&path).unwrap();
        let name = path.file_name().unwrap().to_string_lossy();
        let error = read(&text).expect_err(&name);
        assert!(
            error.line().is_some() || error.path().is_some(),
            "{name} does not say where"
        );
        writeln!(all, "{name}: {error}").unwrap();
    }
    all
}

/// Reads each good file, and checks that it reads back as written.
fn round_trips<T: PartialEq + std::fmt::Debug>(
    format: &str,
    read: impl Fn(&str) -> Result<T, ReadError>,
    write: impl Fn(&T) -> String,
) -> String {
    let mut all = String::new();
    for path in files("good", format) {
        let text = std::fs::read_to_string(&path).unwrap();
        let found = read(&text).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        let written = write(&found);
        assert_eq!(read(&written).unwrap(), found, "{}", path.display());
        let name = path.file_name().unwrap().to_string_lossy();
        writeln!(all, "== {name}\n{written}").unwrap();
    }
    all
}

#[test]
fn bad_automaton_files_say_where_and_why() {
    insta::assert_snapshot!(complaints("json", json::read));
}

#[test]
fn bad_dot_files_say_where_and_why() {
    insta::assert_snapshot!(complaints("dot", dot::read));
}

#[test]
fn bad_abbadingo_files_say_where_and_why() {
    insta::assert_snapshot!(complaints("abbadingo", abbadingo::read));
}

#[test]
fn bad_jsonl_files_say_where_and_why() {
    insta::assert_snapshot!(complaints("jsonl", jsonl::read));
}

#[test]
fn good_automaton_files_read_back() {
    insta::assert_snapshot!(round_trips("json", json::read, json::write));
}

#[test]
fn good_dot_files_read_back() {
    insta::assert_snapshot!(round_trips("dot", dot::read, |dfa| dot::write(dfa).unwrap()));
}

#[test]
fn good_abbadingo_files_read_back() {
    let write = |sample: &Sample| abbadingo::write(sample).unwrap();
    insta::assert_snapshot!(round_trips("abbadingo", abbadingo::read, write));
}

#[test]
fn good_jsonl_files_read_back() {
    insta::assert_snapshot!(round_trips("jsonl", jsonl::read, jsonl::write));
}

/// A text with a piece cut out, doubled, or replaced.
fn damaged(text: &str, random: &mut ChaCha8Rng) -> String {
    let chars: Vec<char> = text.chars().collect();
    let from = random.random_range(0..=chars.len());
    let to = random.random_range(from..=chars.len().min(from + 8));
    let piece: String = match random.random_range(0..3) {
        0 => String::new(),
        1 => chars[from..to].iter().chain(&chars[from..to]).collect(),
        _ => ["{", "\"", "99", "-1", ",", "[]", "é", "\n", "null", "->"]
            [random.random_range(0..10)]
        .to_owned(),
    };
    let (before, after) = (&chars[..from], &chars[to..]);
    before.iter().collect::<String>() + &piece + &after.iter().collect::<String>()
}

#[test]
fn damaged_files_never_panic() {
    let mut random = generator(1);
    for format in ["json", "dot", "abbadingo", "jsonl"] {
        for path in files("good", format) {
            let text = std::fs::read_to_string(&path).unwrap();
            for _ in 0..500 {
                let text = damaged(&text, &mut random);
                let error = match format {
                    "json" => json::read(&text).err(),
                    "dot" => dot::read(&text).err(),
                    "abbadingo" => abbadingo::read(&text).err(),
                    _ => jsonl::read(&text).err(),
                };
                if let Some(error) = error {
                    assert!(error.line().is_some() || error.path().is_some());
                    let last = text.lines().count() + 1;
                    assert!(error.line().is_none_or(|line| (1..=last).contains(&line)));
                }
            }
        }
    }
}

/// Automata with all their states and symbols in their order.
#[test]
fn random_automata_read_back() {
    for seed in 0..2_000 {
        let mut random = generator(seed);
        let alphabet = alphabet(random.random_range(1..=5));
        let dfa = dfa(&alphabet, 8, &mut random);
        let read = dot::read(&dot::write(&dfa).unwrap()).unwrap();
        assert_eq!(read, dfa);
        let document = Document {
            dfa: dfa.clone(),
            name: Some(format!("\"{seed}\"\n")).filter(|_| random.random_bool(0.5)),
            provenance: Some(Provenance {
                version: None,
                seed: Some(seed),
                digest: Some("é".to_owned()),
            })
            .filter(|_| random.random_bool(0.5)),
        };
        assert_eq!(json::read(&json::write(&document)).unwrap(), document);
        // As a part of another JSON value, too.
        let value = serde_json::to_value(&dfa).unwrap();
        assert_eq!(serde_json::from_value::<Dfa>(value).unwrap(), dfa);
    }
}

/// A sample of every kind of item, or of labels only.
fn sample(alphabet: &Alphabet, preferences: bool, random: &mut ChaCha8Rng) -> Sample {
    let mut sample = Sample::new(alphabet.clone());
    for _ in 0..random.random_range(0..12) {
        let mut word = || word(alphabet, 5, random);
        let (first, second) = (word(), word());
        sample.push(
            match random.random_range(0..if preferences { 5 } else { 3 }) {
                0 => Item::Unknown { word: first },
                kind @ 1..=2 => Item::Label {
                    word: first,
                    accepted: kind == 1,
                },
                3 => Item::Below {
                    worse: first,
                    better: second,
                },
                _ => Item::Equal { first, second },
            },
        );
    }
    sample
}

#[test]
fn random_samples_read_back() {
    let mut declared = 0;
    for seed in 0..2_000 {
        let mut random = generator(seed);
        let symbols = random.random_range(1..=5);
        let names = sample(&alphabet(symbols), true, &mut random);
        let text = jsonl::write(&names);
        assert_eq!(jsonl::read(&text).unwrap(), names);
        assert_eq!(jsonl::read_over(&text, names.alphabet()).unwrap(), names);
        declared += u32::from(text.starts_with(r#"{"alphabet""#));

        let digits = Alphabet::new((0..symbols).map(|digit| digit.to_string())).unwrap();
        let numbers = sample(&digits, false, &mut random);
        let text = abbadingo::write(&numbers).unwrap();
        assert_eq!(abbadingo::read(&text).unwrap(), numbers);
    }
    // Both kinds of files were among them.
    assert!((100..1_900).contains(&declared), "{declared}");
}

#[test]
fn jsonl_over_a_known_alphabet() {
    let text = "{\"word\":[\"b\"],\"label\":true}\n";
    let alphabet = alphabet(2);
    let sample = jsonl::read_over(text, &alphabet).unwrap();
    assert_eq!(sample.alphabet(), &alphabet);
    assert_eq!(jsonl::read(text).unwrap().alphabet().len(), 1);

    let error = jsonl::read_over(text, &support::alphabet(1)).unwrap_err();
    assert_eq!(
        error.to_string(),
        r#"line 1, column 10, `word[0]`: expected a symbol of the alphabet {a}, found "b""#
    );
    let error = jsonl::read_over("\n{\"alphabet\":[\"b\",\"a\"]}\n", &alphabet).unwrap_err();
    assert_eq!(
        error.to_string(),
        "line 2, column 13, `alphabet`: expected the alphabet {a, b}, found {b, a}"
    );
}

#[test]
fn what_a_format_cannot_say_is_refused() {
    let alphabet = Alphabet::new(["1", "x", "01"]).unwrap();
    let mut preferences = Sample::new(alphabet.clone());
    preferences.extend([
        Item::Unknown {
            word: Word::empty(),
        },
        Item::Below {
            worse: Word::empty(),
            better: alphabet.word(["x"]).unwrap(),
        },
    ]);
    let all = Dfa::new(alphabet, 0, vec![true], &[vec![0; 3]]).unwrap();
    let large = Alphabet::new((0..129).map(|name| name.to_string())).unwrap();
    let large = Dfa::new(large, 0, vec![true], &[vec![0; 129]]).unwrap();
    let errors: Vec<WriteError> = vec![
        abbadingo::write(&preferences).unwrap_err(),
        dot::write(&all).unwrap_err(),
        hoa::write(&large).unwrap_err(),
    ];
    let messages: Vec<String> = errors.iter().map(ToString::to_string).collect();
    insta::assert_snapshot!(messages.join("\n"));
}

/// The robot that must recharge and may not do so wet; state 0 is its failure.
fn robot() -> Dfa {
    let alphabet = Alphabet::new(["R", "Y", "B", "O"]).unwrap();
    let rows = [
        vec![0, 0, 0, 0],
        vec![0, 0, 1, 2],
        vec![0, 3, 1, 2],
        vec![0, 3, 1, 3],
    ];
    Dfa::new(alphabet, 2, vec![false, false, false, true], &rows).unwrap()
}

#[test]
fn pictures_group_letters_and_hide_dead_states() {
    insta::assert_snapshot!(dot_people::write(&robot()));
}

#[test]
fn pictures_say_otherwise_where_nothing_is_hidden() {
    let alphabet = alphabet(5);
    let rows = [
        vec![1, 0, 0, 0, 2],
        vec![1, 1, 1, 1, 1],
        vec![0, 0, 1, 1, 2],
    ];
    let dfa = Dfa::new(alphabet, 0, vec![false, true, true], &rows).unwrap();
    insta::assert_snapshot!(dot_people::write(&dfa));
}

#[test]
fn pictures_of_empty_languages_show_their_states() {
    let dfa = Dfa::new(alphabet(2), 0, vec![false], &[vec![0, 0]]).unwrap();
    insta::assert_snapshot!(dot_people::write(&dfa));
}

#[test]
fn hoa_states_its_finite_semantics() {
    insta::assert_snapshot!(hoa::write(&robot()).unwrap());
}

#[test]
fn samples_tell_the_first_item_that_an_automaton_contradicts() {
    let text = r#"{"alphabet":["R","Y","B","O"]}
{"word":["Y"],"label":true}
{"word":["O"],"label":null}
{"worse":["B"],"better":["B","O","Y"]}
{"equal":[["Y"],["Y","Y"]]}
{"worse":["Y"],"better":["R"]}
"#;
    let sample = jsonl::read(text).unwrap();
    assert_eq!(sample.first_violated(&robot()), Some(4));
    let nothing = robot().and(&robot().complement()).unwrap();
    assert_eq!(sample.first_violated(&nothing), Some(0));
}
