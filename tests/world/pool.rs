//! Pools of recordings: what is wrong in a file is named, and what is right is
//! asked about.

use std::fmt::Write;
use std::sync::Arc;
use std::time::Instant;

use automata::{Alphabet, Symbol, Word};
use memrep::bench::process_cpu;
use memrep::concept::{ConceptClass, Prior, Situated};
use memrep::evidence::{Budget, Fact};
use memrep::learner::Config;
use memrep::oracle::{Target, TeacherSettings};
use memrep::world::pool::{Media, Pool, PoolReader};
use memrep::world::{Trajectory, World};
use rand::RngExt;

use crate::draw::{self, alphabet, automaton, since};
use crate::learn::{learn, settings};

/// A file of so many random recordings of so many steps.
fn file(recordings: usize, steps: usize, letters: usize) -> String {
    let mut random = draw::random(7);
    let symbols = alphabet(letters);
    let mut text = String::new();
    for number in 0..recordings {
        let names: Vec<String> = (0..steps)
            .map(|_| {
                format!(
                    "\"{}\"",
                    symbols.name(Symbol::new(random.random_range(0..letters)))
                )
            })
            .collect();
        writeln!(
            text,
            r#"{{"id":"run-{number}","word":[{}],"complete":{}}}"#,
            names.join(","),
            number % 10 > 0
        )
        .unwrap();
    }
    text
}

fn read(symbols: &Alphabet, text: &str) -> Result<Pool, String> {
    PoolReader::read(symbols.clone(), text.as_bytes()).map_err(|error| error.to_string())
}

#[test]
fn ten_thousand_recordings_load_and_separate() {
    let symbols = alphabet(4);
    let text = file(10_000, 50, 4);
    let start = Instant::now();
    let cpu = process_cpu();
    let pool = read(&symbols, &text).unwrap();
    println!(
        "10 000 recordings of 50 steps: loaded in {:?}, CPU {:?}",
        start.elapsed(),
        since(cpu)
    );
    assert_eq!(pool.recordings().len(), 10_000);
    let words: Vec<Word> = pool.recordings().iter().map(|r| r.word.clone()).collect();
    let world = Arc::new(World::Pool(pool));
    let class = Situated::new(Arc::clone(&world), Prior::none(&symbols), settings()).unwrap();
    let mut random = draw::random(8);
    let mut slowest = std::time::Duration::ZERO;
    for _ in 0..60 {
        let [one, other] = [0; 2].map(|_| automaton(&symbols, 6, &mut random));
        let start = process_cpu();
        let found = class.witnesses(&one, &other, 2);
        slowest = slowest.max(since(start));
        let mut expected: Vec<&Word> = words
            .iter()
            .filter(|word| one.accepts(word) && !other.accepts(word))
            .collect();
        expected.sort();
        expected.dedup();
        expected.truncate(2);
        assert_eq!(found.iter().collect::<Vec<_>>(), expected);
    }
    println!("which of them separates two automata: at most {slowest:?}");
    let target = Target::automaton("drawn", &automaton(&symbols, 3, &mut random));
    let prior = Prior::none(&symbols);
    let config = Config::default();
    let report = learn(&world, &prior, &target, config, TeacherSettings::default());
    let learned = report.learned.expect("500 questions are enough");
    let agrees = |word: &Word| learned.accepts(word) == target.dfa().accepts(word);
    assert!(words.iter().all(agrees));
    let times = &report.question_times;
    println!(
        "{} questions, at most {:?}",
        times.len(),
        times.iter().max()
    );
}

#[test]
fn what_is_shown_is_a_recording_of_the_word() {
    let symbols = alphabet(2);
    let text = r#"
{"id":"cut","word":["a"],"complete":false}
{"id":"whole","word":["a"],"media":{"kind":"video","path":"runs/whole.mp4"}}
{"id":"again","word":["a"],"complete":true,"media":null}
{"id":"frames","word":["b","a"],"media":{"kind":"frames","paths":["1.PNG","2.webp"]}}
{"id":"cells","word":[],"media":{"kind":"cells","cells":[[0,0],[0,1]]}}
{"id":"moving","word":["b"],"complete":false,"media":{"kind":"animation","path":"x.gif"}}
"#;
    let pool = read(&symbols, text).unwrap();
    assert_eq!((pool.recordings().len(), pool.different()), (6, 4));
    let world = World::Pool(pool);
    let shown = |names: &str| {
        let word = symbols.word(names.chars().map(String::from)).unwrap();
        match world.trajectory(&word) {
            Some(Trajectory::Recording(recording)) => {
                assert_eq!(recording.word, word);
                Some((
                    recording.id.clone(),
                    recording.complete,
                    recording.media.clone(),
                ))
            }
            None => None,
            Some(other) => panic!("a pool shows recordings: {other:?}"),
        }
    };
    let path = "runs/whole.mp4".to_owned();
    assert_eq!(
        shown("a"),
        Some(("whole".to_owned(), true, Some(Media::Video { path })))
    );
    let cells = vec![[0, 0], [0, 1]];
    assert_eq!(
        shown(""),
        Some(("cells".to_owned(), true, Some(Media::Cells { cells })))
    );
    assert_eq!(shown("b").map(|shown| shown.1), Some(false));
    assert_eq!(shown("ab"), None);
    assert!(!world.is_feasible(&symbols.word(["b", "b"]).unwrap()));
}

#[test]
fn the_first_broken_line_is_named_with_its_field() {
    let symbols = alphabet(2);
    let check = |line: &str, expected: &str| {
        let good = r#"{"id":"good","word":["a"]}"#;
        let error = read(&symbols, &format!("{good}\n\n{line}\n{good}")).unwrap_err();
        assert_eq!(error, expected, "{line}");
    };
    check(
        r#"{"id":"x","word":["a","c"]}"#,
        "line 3, column 23, `word[1]`: expected a symbol of the alphabet {a, b}, found \"c\"",
    );
    check(
        r#"{"id":"good","word":["a"]}"#,
        "line 3, column 7, `id`: `good` is the name of line 1 already: give every recording its own",
    );
    check(
        r#"{"id":"","word":["a"]}"#,
        "line 3, column 7, `id`: the name has 0 bytes: give 1 to 200",
    );
    check(
        r#"{"id":"x","word":["a"}"#,
        r#"line 3, column 22: expected `,` or `]`: expected an object like {"id":"run-1","word":["a","b"],"complete":true}"#,
    );
    check(
        r#"{"id":"x"}"#,
        r#"line 3, column 10: missing field `word`: expected an object like {"id":"run-1","word":["a","b"],"complete":true}"#,
    );
    check(
        r#"["x",["a"]]"#,
        r#"line 3, column 1: expected an object like {"id":"run-1","word":["a","b"],"complete":true}"#,
    );
    let media = |media: &str, expected: &str| {
        let line = format!(r#"{{"id":"x","word":[],"media":{media}}}"#);
        check(&line, expected);
    };
    media(
        r#"{"kind":"video","path":"x.png"}"#,
        "line 3, column 52, `media.path`: `x.png` is no video that a browser shows: give a file that ends in .mp4, .webm",
    );
    media(
        r#"{"kind":"frames","paths":["a.png","b.svg"]}"#,
        "line 3, column 63, `media.paths[1]`: `b.svg` is no picture that a browser shows: give a file that ends in .png, .jpg, .jpeg, .webp",
    );
    media(
        r#"{"kind":"cells","cells":[[3,1],[3,500]]}"#,
        "line 3, column 53, `media.cells`: the cells lie in 1 rows and 500 columns: at most 200 of each can be drawn",
    );
    media(
        r#"{"kind":"frames","paths":[]}"#,
        "line 3, column 54, `media.paths`: it has 0 entries: give 1 to 1001",
    );
    for path in [
        "../x.gif",
        "/x.gif",
        "a//x.gif",
        "c:x.gif",
        "a\\\\x.gif",
        "./x.gif",
    ] {
        let line =
            format!(r#"{{"id":"x","word":[],"media":{{"kind":"animation","path":"{path}"}}}}"#);
        let error = read(&symbols, &line).unwrap_err();
        assert!(
            error.starts_with("line 1, column 56, `media.path`: "),
            "{error}"
        );
        assert!(error.contains("is no path within the upload"), "{error}");
    }
    let error = read(
        &symbols,
        r#"{"id":"x","word":[],"media":{"kind":"song","path":"x"}}"#,
    );
    let error = error.unwrap_err();
    assert!(
        error.starts_with("line 1, column 29, `media`: unknown variant `song`"),
        "{error}"
    );
    let error = read(&symbols, "\n\n").unwrap_err();
    assert_eq!(
        error,
        "line 1, column 1: there is no recording: give at least one line like {\"id\":\"run-1\",\"word\":[\"a\",\"b\"],\"complete\":true}"
    );
}

#[test]
fn line_7312_of_a_large_file_is_named() {
    let symbols = alphabet(3);
    let text = file(8000, 20, 3);
    let mut lines: Vec<&str> = text.lines().collect();
    lines[7311] = r#"{"id":"run-7311","word":["a","b","a" "b"]}"#;
    let error = read(&symbols, &lines.join("\n")).unwrap_err();
    assert!(error.starts_with("line 7312, column 38: "), "{error}");
}

/// A file comes in pieces of any size.
#[test]
fn pieces_are_the_same_as_the_whole() {
    let symbols = alphabet(3);
    let text = file(40, 9, 3);
    let whole = read(&symbols, &text).unwrap();
    for size in [1, 7, 64, 1000] {
        let mut reader = PoolReader::new(symbols.clone());
        for piece in text.trim_end().as_bytes().chunks(size) {
            reader.feed(piece).unwrap();
        }
        let pool = reader.finish().unwrap();
        assert_eq!(pool.recordings(), whole.recordings());
    }
    let mut reader = PoolReader::new(symbols);
    let error = (0..40)
        .find_map(|_| reader.feed(&vec![b'x'; 1 << 16]).err())
        .unwrap();
    assert!(error.to_string().starts_with("line 1: the line is longer"));
}

/// Where the recordings do not suffice, the class tells what would.
#[test]
fn what_the_pool_lacks_is_told() {
    let symbols = alphabet(2);
    let pool = read(
        &symbols,
        "{\"id\":\"1\",\"word\":[\"a\"]}\n{\"id\":\"2\",\"word\":[\"a\",\"a\"]}\n",
    )
    .unwrap();
    let world = Arc::new(World::Pool(pool));
    let target = Target::automaton("drawn", &automaton(&symbols, 3, &mut draw::random(3)));
    let prior = Prior::none(&symbols);
    let config = Config::default();
    let report = learn(&world, &prior, &target, config, TeacherSettings::default());
    assert!(report.counts.membership + report.counts.comparison <= 3);
    let learned = report.learned.unwrap();
    let words = ["a", "aa"].map(|w| symbols.word(w.chars().map(String::from)).unwrap());
    for word in &words {
        assert_eq!(learned.accepts(word), target.dfa().accepts(word));
    }
    let mut class = Situated::new(Arc::clone(&world), prior, settings()).unwrap();
    for (atom, accepted) in words.into_iter().zip([true, false]) {
        class.add(None, Fact::Label { atom, accepted });
    }
    let sample = class.sample(32, 0, &mut Budget::unlimited()).unwrap();
    assert_eq!(sample.concepts.len(), 1, "nothing tells them apart");
    let beyond = class
        .beyond(&sample.concepts[0])
        .expect("something is lacking");
    // No recording has a `b`.
    assert_eq!(beyond, symbols.word(["b"]).unwrap());
}
