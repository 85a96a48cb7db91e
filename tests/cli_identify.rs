//! `memrep identify` as a shell sees it.

use std::io::Write as _;
use std::process::{Command, Stdio};

use automata::Dfa;
use automata::format::json;

/// An even number of `a`, said by labels and preferences.
const EVEN: &str = r#"{"word":[],"label":true}
{"word":["a"],"label":false}

{"worse":["a","a","a"],"better":["a"]}
{"equal":[["b"],[]]}
{"worse":["b"],"better":["a","b","a"]}
{"equal":[["a"],["a","b"]]}
{"word":["b","b"],"label":null}
"#;

/// What a run of the command left behind.
#[derive(Debug)]
struct Outcome {
    status: Option<i32>,
    stdout: String,
    stderr: String,
}

/// Runs `memrep identify` with `input` on its standard input.
fn identify(arguments: &[&str], input: &str) -> Outcome {
    let mut child = Command::new(env!("CARGO_BIN_EXE_memrep"))
        .arg("identify")
        .args(arguments)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    // A command that reads nothing may be gone before the pipe is written.
    let _ = child.stdin.take().unwrap().write_all(input.as_bytes());
    let output = child.wait_with_output().unwrap();
    Outcome {
        status: output.status.code(),
        stdout: String::from_utf8(output.stdout).unwrap(),
        stderr: String::from_utf8(output.stderr).unwrap(),
    }
}

fn automata(outcome: &Outcome) -> Vec<Dfa> {
    assert_eq!(outcome.status, Some(0), "{outcome:?}");
    (outcome.stdout.lines())
        .map(|line| json::read(line).unwrap().dfa)
        .collect()
}

#[test]
fn every_solver_finds_the_automaton_of_labels_and_preferences() {
    for solver in ["auto", "enumerate", "varisat", "batsat"] {
        let arguments = [
            "-", "--from", "jsonl", "--format", "json", "--solver", solver,
        ];
        let found = automata(&identify(&arguments, EVEN));
        assert_eq!(found.len(), 1, "{solver}");
        let dfa = &found[0];
        assert_eq!(dfa.size(), 2);
        for (word, accepted) in [("", true), ("a", false), ("aba", true), ("bab", false)] {
            let names: Vec<String> = word.chars().map(String::from).collect();
            let word = dfa.alphabet().word(names).unwrap();
            assert_eq!(dfa.accepts(&word), accepted, "{solver}");
        }
    }
}

#[test]
fn the_table_is_for_people() {
    let outcome = identify(&["-", "--from", "jsonl"], EVEN);
    assert_eq!(outcome.status, Some(0), "{outcome:?}");
    assert_eq!(outcome.stderr, "", "nobody looks at the progress");
    insta::assert_snapshot!(outcome.stdout, @r#"
    The smallest automaton has 2 states, and no other has as few.

         |  a  b
    >* 0 |  1  0
       1 |  0  1

    > the state to start in   * accepting
    "#);
}

#[test]
fn several_automata_are_different_and_as_many_as_there_are() {
    let sample = "3 2\n1 0\n0 1 0\n-1 2 0 0\n";
    let run = |count| {
        let arguments = ["-", "--from", "abb", "--count", count, "--format", "json"];
        automata(&identify(&arguments, sample))
    };
    // Two states: δ(0, 0) leads to the other, three edges are free.
    let all = run("100");
    assert_eq!(all.len(), 8);
    for (place, dfa) in all.iter().enumerate() {
        assert!(
            all[..place]
                .iter()
                .all(|other| !dfa.is_equivalent(other).unwrap())
        );
    }
    let some = run("3");
    assert_eq!(some.len(), 3);
    assert!(some.iter().all(|dfa| all.contains(dfa)));
}

#[test]
fn a_contradiction_is_told_by_its_lines() {
    let contradictory = format!("{EVEN}{}\n", r#"{"word":["a","b","a"],"label":false}"#);
    let outcome = identify(&["-", "--from", "jsonl"], &contradictory);
    assert_eq!(outcome.status, Some(1), "{outcome:?}");
    insta::assert_snapshot!(outcome.stdout, @r#"
    No automaton of any size: these lines contradict each other. They accept a word that is no better than one that they reject.
      line 1: {"word":[],"label":true}
      line 5: {"equal":[["b"],[]]}
      line 6: {"worse":["b"],"better":["a","b","a"]}
      line 9: {"word":["a","b","a"],"label":false}
    Without any one of them, the others can hold.
    "#);
    let outcome = identify(
        &["-", "--from", "jsonl", "--format", "json"],
        &contradictory,
    );
    assert_eq!(outcome.status, Some(1), "{outcome:?}");
    insta::assert_snapshot!(outcome.stdout, @r#"{"contradiction":{"lines":[1,5,6,9],"minimal":true,"cause":"membership"}}"#);
}

/// No order agrees, and yet an automaton does: both are told.
#[test]
fn a_circle_of_preferences_is_told_beside_the_automaton() {
    let circle = |last: &str| {
        let lines = [
            r#"{"word":["a"],"label":true}"#,
            r#"{"worse":["a"],"better":["b"]}"#,
            r#"{"worse":["b"],"better":["a","b"]}"#,
            last,
        ];
        identify(&["-", "--from", "jsonl"], &lines.join("\n"))
    };
    let outcome = circle(r#"{"worse":["a","b"],"better":["a"]}"#);
    assert_eq!(outcome.status, Some(0), "{outcome:?}");
    insta::assert_snapshot!(outcome.stderr, @r#"
    warning: no order agrees with these lines. Followed round, they say that something is better than itself. What is found treats them all alike.
      line 2: {"worse":["a"],"better":["b"]}
      line 3: {"worse":["b"],"better":["a","b"]}
      line 4: {"worse":["a","b"],"better":["a"]}
    "#);
    let outcome = circle(r#"{"equal":[["a"],["b"]]}"#);
    assert_eq!(outcome.status, Some(0), "{outcome:?}");
    insta::assert_snapshot!(outcome.stderr, @r#"
    warning: no order agrees with these lines. They say of the same two words that they are equally good, and that one is better. What is found treats them all alike.
      line 2: {"worse":["a"],"better":["b"]}
      line 4: {"equal":[["a"],["b"]]}
    "#);
}

#[test]
fn a_bound_that_is_too_small_is_told_with_its_lines() {
    let sample = "\n4 1\n1 0\n0 1 0\n\n0 2 0 0\n1 3 0 0 0\n";
    let outcome = identify(&["-", "--from", "abb", "--max-states", "2"], sample);
    assert_eq!(outcome.status, Some(1), "{outcome:?}");
    insta::assert_snapshot!(outcome.stdout, @r#"
    No automaton with 2 states or fewer: these lines together need more. Raise `--max-states`, or drop one of them.
      line 4: 0 1 0
      line 7: 1 3 0 0 0
    Without any one of them, the others can hold.
    "#);
    let arguments = [
        "-",
        "--from",
        "abb",
        "--max-states",
        "2",
        "--format",
        "json",
    ];
    let outcome = identify(&arguments, sample);
    insta::assert_snapshot!(outcome.stdout, @r#"{"contradiction":{"lines":[4,7],"minimal":true,"max_states":2,"cause":"states"}}"#);
    let outcome = identify(&["-", "--from", "abb", "--max-states", "3"], sample);
    assert_eq!(outcome.status, Some(0), "{outcome:?}");
}

#[test]
fn a_budget_that_ends_is_no_answer() {
    let sample = "4 1\n1 0\n0 1 0\n0 2 0 0\n1 3 0 0 0\n";
    let outcome = identify(&["-", "--from", "abb", "--budget", "3"], sample);
    assert_eq!(outcome.status, Some(1), "{outcome:?}");
    insta::assert_snapshot!(outcome.stdout, @"The budget ended: an automaton needs 3 states or more. Give more steps by `--budget`.");
    let arguments = ["-", "--from", "abb", "--budget", "3", "--format", "json"];
    let outcome = identify(&arguments, sample);
    insta::assert_snapshot!(outcome.stdout, @r#"{"over_budget":{"at_least":3}}"#);
}

#[test]
fn bad_input_is_said_with_its_place() {
    let cases: &[(&[&str], &str, &str)] = &[
        (&["-"], "", "the extension does not tell the format"),
        (&["missing.abb"], "", "missing.abb: cannot read it"),
        (
            &["-", "--from", "abb"],
            "1 1\n2 0\n",
            "line 2, column 1: expected a label",
        ),
        (&["-", "--from", "jsonl"], "{\"word\":[1]}\n", "line 1"),
        (
            &["task.json"],
            "",
            "expected a sample (abb or jsonl), not the format json",
        ),
        (
            &["-", "--from", "abb", "--max-states", "0"],
            "",
            "expected at least 1",
        ),
        (
            &["-", "--from", "abb", "--count", "some"],
            "",
            "expected a whole number",
        ),
        (
            &["-", "--from", "abb", "--solver", "magic"],
            "",
            "invalid value 'magic'",
        ),
    ];
    for (arguments, input, expected) in cases {
        let outcome = identify(arguments, input);
        assert_eq!(outcome.status, Some(2), "{arguments:?}: {outcome:?}");
        assert!(
            outcome.stderr.contains(expected),
            "{arguments:?}: {outcome:?}"
        );
        assert_eq!(outcome.stdout, "");
    }
}

#[test]
fn help_shows_examples() {
    let outcome = identify(&["--help"], "");
    assert_eq!(outcome.status, Some(0));
    assert!(outcome.stdout.contains("memrep identify words.abb"));
    assert!(outcome.stdout.contains("Exit status"));
}
