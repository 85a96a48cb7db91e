//! Tasks written as files read as the same tasks.

use std::path::Path;

use memrep::task::{Task, TaskFile, toml_text};
use proptest::prelude::*;
use serde_json::{Value, json};

/// The task that the text of a file tells, where no other file is at hand.
fn read(text: &str) -> Task {
    let content = Task::toml_content(text).unwrap_or_else(|e| panic!("{e:?} in\n{text}"));
    Task::from_json(&content).unwrap_or_else(|e| panic!("{e} in\n{text}"))
}

#[test]
fn every_example_is_written_and_read_again() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/tasks");
    let mut seen = 0;
    for file in std::fs::read_dir(folder).unwrap() {
        let path = file.unwrap().path();
        let file = TaskFile::open(&path).unwrap();
        let text = file.task.to_toml();
        assert_eq!(read(&text), file.task, "{}", path.display());
        // With its target too, through its content.
        let mut content = Task::toml_content(&std::fs::read_to_string(&path).unwrap()).unwrap();
        if file.task.class.is_none() {
            let again = Task::toml_content(&toml_text(&content)).unwrap();
            content["guidelines"] = content["guidelines"].as_str().unwrap().trim().into();
            let mut trimmed = again;
            trimmed["guidelines"] = trimmed["guidelines"].as_str().unwrap().trim().into();
            // A map has rows, and texts that are alone are names.
            assert_eq!(trimmed["target"], content["target"]);
            assert_eq!(trimmed["symbols"], content["symbols"]);
        }
        seen += 1;
    }
    assert!(seen >= 6);
}

/// One-line text as people might type it, with what TOML gives a meaning.
fn line() -> impl Strategy<Value = String> {
    prop_oneof![
        "[a-z ]{1,12}",
        r#"[\\"'#=\[\]{}.üλ🙂\u{7f}a-c ]{1,12}"#,
        "\\PC{1,20}",
    ]
    .prop_filter("not blank", |text| !text.trim().is_empty())
}

fn prose() -> impl Strategy<Value = String> {
    let lines = prop::collection::vec(line(), 1..5);
    (lines, prop::bool::ANY)
        .prop_map(|(lines, windows)| lines.join(if windows { "\r\n" } else { "\n\n" }))
}

/// A word and a colour, where there are any.
type Looks = (Option<String>, Option<&'static str>);

fn symbols() -> impl Strategy<Value = Vec<Value>> {
    let marks = Just("ABCDE\"\\'üλ=0".chars().collect::<Vec<_>>()).prop_shuffle();
    let one = (
        prop::option::of(line()),
        prop::option::of(prop::sample::select(vec!["#d55e00", "gold", "#0072B2"])),
    );
    (marks, prop::collection::vec(one, 1..5), prop::bool::ANY).prop_map(|(marks, looks, bare)| {
        let symbols = looks.into_iter().zip(marks).enumerate();
        let symbol = |(i, ((word, colour), letter)): (usize, (Looks, char))| {
            let mut symbol = json!({"name": format!("s{i}")});
            if !bare {
                symbol["letter"] = letter.to_string().into();
                if let Some(word) = word {
                    symbol["word"] = word.into();
                }
                if let Some(colour) = colour {
                    symbol["colour"] = colour.into();
                }
            }
            symbol
        };
        symbols.map(symbol).collect()
    })
}

/// A world of these symbols: none, words, a grid in a row of which all can be reached,
/// or recordings.
fn world(symbols: &[Value], kind: usize, number: usize) -> Value {
    let marks: String = symbols
        .iter()
        .filter_map(|s| s["letter"].as_str())
        .collect();
    match kind {
        1 => json!({"kind": "words", "longest": number}),
        2 => {
            let open = format!("S.{marks} ");
            let wall = "#".repeat(open.chars().count());
            json!({"kind": "grid", "map": [wall, open], "steps": 20 + number,
                "labelling": if number.is_multiple_of(2) { "entry" } else { "every-step" }})
        }
        3 => json!({"kind": "pool", "upload": format!("u{number}")}),
        _ => Value::Null,
    }
}

prop_compose! {
    fn of_words()(
        symbols in symbols(),
        kind in 0..4_usize,
        number in 2..30_usize,
        words in prop::collection::vec((prop::collection::vec(0..5_usize, 0..2), any::<bool>()), 0..4),
        rules in prop::collection::vec(0..5_usize, 0..2),
        enough in any::<bool>(),
        why in prop::option::of(prose()),
    ) -> Value {
        let name = |i: &usize| format!("s{}", i % symbols.len());
        let names = |word: &[usize]| word.iter().map(name).collect::<Vec<_>>();
        let examples: Vec<Value> = words.iter()
            .map(|(word, label)| json!({"word": names(word), "label": label})).collect();
        let holds: Vec<Value> = rules.iter().map(|i| json!(format!("avoid {}", name(i)))).collect();
        let mut task = json!({"symbols": symbols, "examples": examples, "prior": {"holds": holds}});
        if enough {
            let row: Vec<usize> = vec![1; symbols.len()];
            task["prior"]["suffices"] = json!([{"start": 0, "accepting": [0], "delta": [row, row]}]);
        }
        let world = world(&symbols, kind, number);
        if !world.is_null() {
            task["world"] = world;
        }
        if let Some(why) = why {
            task["practice"] = json!({"first": [], "second": [name(&0)], "answer": "incomparable", "why": why});
        }
        task
    }
}

fn of_classes() -> impl Strategy<Value = Value> {
    let axis = |name: &'static str| {
        (line(), -1e6..1e6_f64, 0.5..1e3_f64).prop_map(move |(unit, best, far)| {
            json!({"name": name, "unit": unit.chars().take(20).collect::<String>(), "best": best, "worst": best + far})
        })
    };
    let limits = (axis("time"), axis("far \"off\""), prop::option::of(2..9_usize)).prop_map(
        |(one, other, ticks)| {
            let mut class = json!({"kind": "monotone", "axes": [one, other]});
            if let Some(ticks) = ticks {
                class["ticks"] = ticks.into();
            }
            json!({"class": class, "examples": [{"point": [one["best"], other["best"]], "label": true}]})
        },
    );
    let end = prop::sample::select(vec!["", "\n"]);
    let table = end.prop_map(|end| {
        json!({"class": {"kind": "finite", "table": format!("behaviour,x,y\n\"a \"\"b\"\"\",1,0\nc,0,1{end}")}})
    });
    let share = 0.0..1.0_f64;
    let reward = prop::collection::vec(prop::collection::vec(share, 2), 1..3).prop_map(|steps| {
        json!({"class": {"kind": "linear", "features": ["speed", "near, or far"],
            "behaviours": [{"name": "b\\c", "features": steps}, {"name": "d", "features": steps}]}})
    });
    prop_oneof![limits, table, reward]
}

fn tasks() -> impl Strategy<Value = Task> {
    let about = prop_oneof![of_words(), of_classes()];
    let told = (
        prop::option::of(line()),
        prop::option::of(line()),
        prop::option::of(prose()),
        prop::option::of(1..100_usize),
        prop::option::of((1e-3..1e3_f64, any::<bool>())),
        prop::option::of(prop::sample::select(vec![
            "bayes",
            "exp4+",
            "thesis",
            "membership",
        ])),
    );
    (about, told).prop_filter_map("no task", |(mut task, told)| {
        let (title, empty, guidelines, states, costs, strategy) = told;
        for (key, text) in [
            ("title", title),
            ("empty", empty),
            ("guidelines", guidelines),
        ] {
            if let Some(text) = text {
                task[key] = text.into();
            }
        }
        if let Some(states) = states {
            task["max_states"] = states.into();
        }
        if let Some((cost, never)) = costs {
            let comparison = if never { json!("inf") } else { json!(1) };
            task["costs"] = json!({"membership": cost, "comparison": comparison});
        }
        if let Some(strategy) = strategy {
            task["strategy"] = strategy.into();
        }
        Task::from_json(&task).ok()
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, max_global_rejects: 20_000, ..ProptestConfig::default() })]

    #[test]
    fn a_written_task_is_read_as_the_same(task in tasks()) {
        prop_assert_eq!(&read(&task.to_toml()), &task, "{}", task.to_toml());
    }
}

/// However it is written: a log has it in one way only, and is to be read again.
#[test]
fn a_name_has_sixty_characters_at_most() {
    for (length, fits) in [(60, true), (61, false)] {
        let name = "x".repeat(length);
        for symbol in [json!(name), json!({"name": name})] {
            let read = TaskFile::of_content(&json!({"symbols": [symbol, "b"]}));
            match read {
                Ok(file) => {
                    assert!(fits, "{symbol}");
                    assert_eq!(&self::read(&file.task.to_toml()), &file.task);
                }
                Err(faults) => {
                    assert!(!fits, "{symbol}: {faults:?}");
                    assert!(faults[0].message.contains("at most 60"), "{faults:?}");
                }
            }
        }
    }
}

#[test]
fn a_practice_answer_may_not_contradict_what_is_known() {
    let task = |practice: Value, rest: Value| {
        let mut task = json!({
            "symbols": ["a", "b"],
            "examples": [{"word": ["a"], "label": true}, {"word": ["b"], "label": false}],
            "practice": practice,
        });
        task["practice"]["why"] = "so".into();
        for (key, value) in rest.as_object().unwrap() {
            task[key] = value.clone();
        }
        TaskFile::of_content(&task).map(|_| ())
    };
    let none = json!({});
    let target = json!({"target": "reach a"});
    let prior = json!({"prior": {"holds": ["reach a"]}});
    for (practice, rest, part) in [
        (
            json!({"word": ["a"], "answer": "reject"}),
            &none,
            "examples[0] says that this is acceptable",
        ),
        (
            json!({"first": ["a"], "second": ["b"], "answer": "second"}),
            &none,
            "examples[1] that the second is not",
        ),
        (
            json!({"first": ["a"], "second": ["b"], "answer": "equal"}),
            &none,
            "`equal`",
        ),
        (
            json!({"word": ["b", "b"], "answer": "accept"}),
            &target,
            "`target` says that this is not",
        ),
        (
            json!({"word": [], "answer": "accept"}),
            &prior,
            "`prior` says that this is not",
        ),
    ] {
        let faults = task(practice.clone(), rest.clone()).unwrap_err();
        assert_eq!(faults.len(), 1, "{faults:?}");
        assert_eq!(faults[0].path, "practice.answer");
        assert!(faults[0].message.contains(part), "{practice}: {faults:?}");
    }
    for (practice, rest) in [
        (json!({"word": ["a"], "answer": "accept"}), &none),
        (
            json!({"first": ["a"], "second": ["b"], "answer": "first"}),
            &none,
        ),
        (
            json!({"first": ["b"], "second": ["a"], "answer": "incomparable"}),
            &none,
        ),
        (
            json!({"first": ["b"], "second": [], "answer": "equal"}),
            &target,
        ),
    ] {
        assert_eq!(task(practice, rest.clone()), Ok(()));
    }
}
