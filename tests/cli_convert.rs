//! `memrep convert` and `memrep equivalent` as a shell sees them.

use std::io::Write as _;
use std::process::{Command, Stdio};

use tempfile::TempDir;

/// An even number of `a`.
const EVEN: &str = r#"{"format":"memrep-dfa","version":1,"name":"even","alphabet":["a","b"],"states":2,"start":0,"accepting":[0],"delta":[[1,0],[0,1]]}
"#;

/// No `a` at all, symbols in another order.
const NONE: &str = r#"{"format":"memrep-dfa","version":1,"alphabet":["b","a"],"states":2,"start":0,"accepting":[0],"delta":[[0,1],[1,1]]}
"#;

/// Even again, with a state too many.
const EVEN_AGAIN: &str = "digraph g {
  __start0 -> x;
  x [shape=doublecircle]; y; z [shape=doublecircle];
  x -> x [label=b]; x -> y [label=a];
  y -> y [label=b]; y -> z [label=a];
  z -> z [label=b]; z -> y [label=a];
}
";

/// What a run of the command left behind.
#[derive(Debug)]
struct Outcome {
    status: Option<i32>,
    stdout: String,
    stderr: String,
}

/// Runs `memrep` in `folder`, with `input` on its standard input.
fn memrep(folder: &TempDir, arguments: &[&str], input: &str) -> Outcome {
    let mut child = Command::new(env!("CARGO_BIN_EXE_memrep"))
        .args(arguments)
        .current_dir(folder.path())
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

/// A folder with these files.
fn folder(files: &[(&str, &str)]) -> TempDir {
    let folder = TempDir::new().unwrap();
    for (name, text) in files {
        std::fs::write(folder.path().join(name), text).unwrap();
    }
    folder
}

fn text(folder: &TempDir, name: &str) -> String {
    std::fs::read_to_string(folder.path().join(name)).unwrap()
}

/// Checks the exit status and what is printed on the standard output.
fn check(folder: &TempDir, arguments: &[&str], status: i32, stdout: &str) {
    let outcome = memrep(folder, arguments, "");
    assert_eq!(outcome.status, Some(status), "{outcome:?}");
    assert_eq!(outcome.stdout, stdout);
}

/// Checks that a command fails with status 2, says `complaint`, and prints
/// nothing on the standard output.
fn check_fails(folder: &TempDir, arguments: &[&str], complaint: &str) {
    let outcome = memrep(folder, arguments, "");
    assert_eq!(outcome.status, Some(2), "{outcome:?}");
    assert_eq!(outcome.stderr, format!("error: {complaint}\n"));
    assert_eq!(outcome.stdout, "");
}

#[test]
fn automata_go_through_every_format_and_back() {
    let folder = folder(&[("even.json", EVEN)]);
    check(&folder, &["convert", "even.json", "even.dot"], 0, "");
    check(&folder, &["convert", "even.dot", "back.json"], 0, "");
    // DOT has no place for the name; one's own file keeps it.
    let nameless = EVEN.replace(r#""name":"even","#, "");
    assert_eq!(text(&folder, "back.json"), nameless);
    let same = ["convert", "even.json", "-", "--to", "json"];
    check(&folder, &same, 0, EVEN);

    check(&folder, &["convert", "even.json", "even.hoa"], 0, "");
    assert!(text(&folder, "even.hoa").starts_with("HOA: v1\n"));
    check(&folder, &["convert", "even.json", "even.svg"], 0, "");
    let svg = text(&folder, "even.svg");
    assert!(svg.contains("<svg") && svg.contains("even"), "{svg}");
    let picture = ["convert", "even.json", "-", "--to", "dot-people"];
    let picture = memrep(&folder, &picture, "");
    assert!(picture.stdout.contains("rankdir"), "{picture:?}");
}

#[test]
fn pipes_need_the_formats_named() {
    let folder = folder(&[]);
    let arguments = ["convert", "-", "-", "--from", "json", "--to", "dot"];
    let outcome = memrep(&folder, &arguments, EVEN);
    assert_eq!(outcome.status, Some(0), "{outcome:?}");
    let accepting = "s0 [label=\"s0\" shape=\"doublecircle\"];";
    assert!(outcome.stdout.contains(accepting), "{outcome:?}");
    check_fails(
        &folder,
        &["convert", "-", "x.json"],
        "-: the extension does not tell the format: name it by `--from FORMAT`",
    );
}

#[test]
fn samples_go_both_ways() {
    let words = "2 2\n1 2 0 1\n-1 0\n";
    let folder = folder(&[("words.abb", words)]);
    check(&folder, &["convert", "words.abb", "words.jsonl"], 0, "");
    assert_eq!(
        text(&folder, "words.jsonl"),
        "{\"word\":[\"0\",\"1\"],\"label\":true}\n{\"word\":[],\"label\":null}\n"
    );
    let back = ["convert", "words.jsonl", "-", "--to", "abb"];
    check(&folder, &back, 0, words);
}

#[test]
fn names_that_abbadingo_loses_are_noted() {
    let folder = folder(&[(
        "words.jsonl",
        "{\"word\":[\"go\",\"stop\"],\"label\":true}\n",
    )]);
    let outcome = memrep(&folder, &["convert", "words.jsonl", "words.abb"], "");
    assert_eq!(outcome.status, Some(0));
    assert_eq!(
        outcome.stderr,
        "note: Abbadingo has no names of symbols, keep these: 0 = go, 1 = stop\n"
    );
    assert_eq!(text(&folder, "words.abb"), "1 2\n1 2 0 1\n");
}

#[test]
fn what_cannot_be_converted_is_said_and_nothing_written() {
    let folder = folder(&[
        ("even.json", EVEN),
        ("preference.jsonl", "{\"worse\":[],\"better\":[\"a\"]}\n"),
        ("even.hoa", "HOA: v1\n"),
        ("even.txt", EVEN),
    ]);
    check_fails(
        &folder,
        &["convert", "preference.jsonl", "out.abb"],
        "cannot write out.abb: item 1 is a preference, and the Abbadingo format has labelled words only: write JSONL instead",
    );
    check_fails(
        &folder,
        &["convert", "even.json", "out.abb"],
        "cannot write out.abb: an automaton cannot be written as a sample (abb): choose json, dot, dot-people, svg or hoa",
    );
    check_fails(
        &folder,
        &["convert", "preference.jsonl", "out.dot"],
        "cannot write out.dot: a sample cannot be written as an automaton (dot): choose abb or jsonl, or find an automaton by `memrep identify`",
    );
    check_fails(
        &folder,
        &["convert", "even.hoa", "out.json"],
        "even.hoa: the format hoa is only written: read json, dot, abb or jsonl",
    );
    check_fails(
        &folder,
        &["convert", "even.txt", "out.json"],
        "even.txt: the extension does not tell the format: name it by `--from FORMAT`",
    );
    for name in ["out.abb", "out.dot", "out.json"] {
        assert!(!folder.path().join(name).exists(), "{name}");
    }
}

#[test]
fn pictures_that_nobody_can_read_are_not_drawn() {
    // Counts `a` up to 29, accepting at the end.
    let rows: Vec<String> = (0..30).map(|q| format!("[{}]", (q + 1).min(29))).collect();
    let chain = format!(
        r#"{{"format":"memrep-dfa","version":1,"alphabet":["a"],"states":30,"start":0,"accepting":[29],"delta":[{}]}}"#,
        rows.join(",")
    );
    let folder = folder(&[("chain.json", &chain)]);
    let outcome = memrep(&folder, &["convert", "chain.json", "chain.svg"], "");
    assert_eq!(outcome.status, Some(2), "{outcome:?}");
    assert!(outcome.stderr.contains("choose dot-people"), "{outcome:?}");
    assert!(!folder.path().join("chain.svg").exists());
}

#[test]
fn bad_files_are_named_with_the_place() {
    let folder = folder(&[
        ("cut.json", &EVEN[..60]),
        ("row.json", &EVEN.replace("[0,1]]", "[0,2]]")),
        (
            "letters.dot",
            "digraph {\n  __start0 -> s;\n  s -> s [label=\"a, b\"];\n}\n",
        ),
    ]);
    std::fs::write(folder.path().join("bytes.abb"), b"1 1\n1 \xff").unwrap();
    check_fails(
        &folder,
        &["convert", "cut.json", "out.dot"],
        "cut.json: line 1, column 60: the text ends within a value: it is cut short",
    );
    check_fails(
        &folder,
        &["convert", "row.json", "out.dot"],
        "row.json: line 1, column 126, `delta[1][1]`: row 1, symbol 1: state 2 does not exist, states are numbered from 0 to 1",
    );
    check_fails(
        &folder,
        &["convert", "letters.dot", "out.json"],
        "letters.dot: line 3, column 17: expected one letter, found \"a, b\": write one edge for each letter",
    );
    check_fails(
        &folder,
        &["convert", "bytes.abb", "out.jsonl"],
        "bytes.abb: line 2, column 3: this is not UTF-8: save the file as UTF-8 text",
    );
    check_fails(
        &folder,
        &["convert", "absent.json", "out.dot"],
        "absent.json: cannot read it: No such file or directory (os error 2)",
    );
    check_fails(
        &folder,
        &["convert", "letters.dot", "out.jsonl", "--from", "abb"],
        "letters.dot: line 1, column 1: expected the number of words, found `digraph`",
    );
    check_fails(
        &folder,
        &["convert", "row.json", "no/such/folder.dot", "--from", "dot"],
        "row.json: line 1, column 1: expected `digraph`, found `{`",
    );
}

#[test]
fn equal_languages_exit_with_0() {
    let folder = folder(&[("even.json", EVEN), ("again.dot", EVEN_AGAIN)]);
    check(
        &folder,
        &["equivalent", "even.json", "again.dot"],
        0,
        "equivalent: both accept the same words\n",
    );
    check(
        &folder,
        &["equivalent", "again.dot", "even.json", "--format", "json"],
        0,
        "{\"equivalent\":true}\n",
    );
}

#[test]
fn different_languages_exit_with_1_and_the_shortest_word() {
    let folder = folder(&[("even.json", EVEN), ("none.json", NONE)]);
    check(
        &folder,
        &["equivalent", "even.json", "none.json"],
        1,
        "different: `a a` is accepted by even.json only\n",
    );
    check(
        &folder,
        &["equivalent", "none.json", "even.json", "--format", "json"],
        1,
        "{\"equivalent\":false,\"word\":[\"a\",\"a\"],\"accepted_by\":\"second\"}\n",
    );
}

#[test]
fn the_empty_word_is_named() {
    let odd = EVEN.replace("\"accepting\":[0]", "\"accepting\":[1]");
    let folder = folder(&[("even.json", EVEN), ("odd.json", &odd)]);
    check(
        &folder,
        &["equivalent", "odd.json", "even.json"],
        1,
        "different: the empty word is accepted by even.json only\n",
    );
}

#[test]
fn what_cannot_be_compared_exits_with_2() {
    let other = EVEN.replace("\"b\"]", "\"c\"]");
    let words = "{\"word\":[\"a\"],\"label\":true}\n";
    let folder = folder(&[
        ("even.json", EVEN),
        ("other.json", &other),
        ("words.jsonl", words),
    ]);
    check_fails(
        &folder,
        &["equivalent", "even.json", "other.json"],
        "even.json has the symbols {a, b} and other.json has {a, c}: give each an edge for every symbol of the other to compare them",
    );
    check_fails(
        &folder,
        &["equivalent", "even.json", "words.jsonl"],
        "words.jsonl: expected an automaton (json or dot), found a sample; `memrep identify` finds the automaton of a sample",
    );
    check_fails(
        &folder,
        &["equivalent", "-", "-"],
        "the standard input holds one automaton: name a file for A or B",
    );
    let outcome = memrep(&folder, &["equivalent", "even.json"], "");
    assert_eq!(outcome.status, Some(2));
}

#[test]
fn help_shows_examples() {
    let folder = folder(&[]);
    for command in ["convert", "equivalent"] {
        let outcome = memrep(&folder, &[command, "--help"], "");
        assert_eq!(outcome.status, Some(0));
        assert!(outcome.stdout.contains("Examples:"), "{outcome:?}");
        assert!(outcome.stdout.contains("Exit status:"), "{outcome:?}");
    }
}
