//! What is read takes at most ten times its size in memory: the real program over files
//! of 16 MiB, or as large as a task can be.
#![cfg(target_os = "linux")]

use std::fmt::Write as _;
use std::io::{BufWriter, Write as _};
use std::path::Path;
use std::process::{Command, Stdio};

use memrep::learner::Reply;
use memrep::session::{Decision, Event, Session, Setup, ready};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use wait4::Wait4 as _;

const SIZE: usize = 16 << 20;

/// Of memory for each byte of the file.
const MOST: f64 = 10.0;

/// Writes lines until there are enough; this process is to stay small, for its size
/// counts as the least of its children's.
fn fill(path: &Path, head: &str, most: usize, mut line: impl FnMut(usize, &mut String)) {
    let mut file = BufWriter::new(std::fs::File::create(path).unwrap());
    file.write_all(head.as_bytes()).unwrap();
    let (mut size, mut text) = (head.len(), String::new());
    for number in 0.. {
        text.clear();
        line(number, &mut text);
        size += text.len();
        if size > most {
            break;
        }
        file.write_all(text.as_bytes()).unwrap();
    }
    file.flush().unwrap();
}

/// Adds to a file.
fn append(path: &Path, text: &str) {
    let mut file = std::fs::File::options().append(true).open(path).unwrap();
    file.write_all(text.as_bytes()).unwrap();
}

/// Runs the program in this folder, where it reads `input`, of which it makes sense.
fn check(folder: &Path, input: &str, args: &[&str]) {
    run(folder, input, args, 0);
}

/// Runs it to this exit status; what it complains of.
fn run(folder: &Path, input: &str, args: &[&str], status: i32) -> String {
    let mut child = Command::new(env!("CARGO_BIN_EXE_memrep"))
        .args(args)
        .current_dir(folder)
        .stdout(Stdio::null())
        .stderr(std::fs::File::create(folder.join("complaint")).unwrap())
        .spawn()
        .unwrap();
    let used = child.wait4().unwrap();
    let complaint = std::fs::read_to_string(folder.join("complaint")).unwrap();
    let complaint: String = complaint.chars().take(300).collect();
    assert_eq!(used.status.code(), Some(status), "{args:?}: {complaint}");
    let size = std::fs::metadata(folder.join(input)).unwrap().len();
    let share = used.rusage.maxrss as f64 / size as f64;
    println!(
        "{input}: {:.1} MiB, {share:.1} times in memory",
        size as f64 / f64::from(1 << 20)
    );
    assert!(
        share < MOST,
        "{input} of {size} bytes took {share:.1} times as much"
    );
    complaint
}

fn word(random: &mut ChaCha8Rng, symbols: &[&str], between: &str) -> String {
    let length = random.random_range(0..30);
    let word: Vec<&str> = (0..length)
        .map(|_| symbols[random.random_range(0..symbols.len())])
        .collect();
    word.join(between)
}

#[test]
fn samples_are_read_in_little_memory() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let random = &mut ChaCha8Rng::seed_from_u64(1);
    fill(&folder.join("a.jsonl"), "", SIZE, |number, line| {
        let word = word(random, &["\"a\"", "\"b\""], ",");
        let label = number % 3 == 0;
        writeln!(line, "{{\"word\":[{word}],\"label\":{label}}}").unwrap();
    });
    check(folder, "a.jsonl", &["convert", "a.jsonl", "out.jsonl"]);
    let count = SIZE / 70;
    let head = format!("{count} 2\n");
    fill(&folder.join("a.abb"), &head, 2 * SIZE, |number, line| {
        if number < count {
            let word = ["0 1 1 0"; 8].join(" ");
            writeln!(line, "{} 32 {word}", number % 2).unwrap();
        } else {
            *line = " ".repeat(2 * SIZE);
        }
    });
    check(folder, "a.abb", &["convert", "a.abb", "out.abb"]);
}

#[test]
fn automata_are_read_in_little_memory() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let states = 600_000;
    let head = format!(
        "{{\"format\":\"memrep-dfa\",\"version\":1,\"alphabet\":[\"a\",\"b\",\"c\"],\"states\":{states},\"start\":0,\"accepting\":[1],\"delta\":["
    );
    let file = folder.join("a.json");
    fill(&file, &head, 2 * SIZE, |number, line| {
        let next = |by: usize| (number * by + 1) % states;
        let comma = if number == 0 { "" } else { "," };
        if number < states {
            write!(line, "{comma}[{},{},{}]", next(1), next(3), next(7)).unwrap();
        } else {
            *line = " ".repeat(2 * SIZE);
        }
    });
    append(&file, "]}");
    check(folder, "a.json", &["convert", "a.json", "out.json"]);

    let states = 90_000;
    let file = folder.join("a.dot");
    let head = "digraph a {\n  __start0 [label=\"\" shape=\"none\"];\n";
    fill(&file, head, 2 * SIZE, |number, line| {
        if number < states {
            writeln!(line, "  s{number} [label=\"s{number}\" shape=\"circle\"];").unwrap();
            for (letter, by) in [("a", 1), ("b", 3), ("c", 7)] {
                let next = (number * by + 1) % states;
                writeln!(line, "  s{number} -> s{next} [label=\"{letter}\"];").unwrap();
            }
        } else {
            *line = " ".repeat(2 * SIZE);
        }
    });
    append(&file, "  __start0 -> s0;\n}\n");
    check(folder, "a.dot", &["convert", "a.dot", "out.json"]);
}

/// What is parsed takes many times its size, so that only what is small is.
#[test]
fn task_files_that_are_too_large_are_refused_before_they_are_parsed() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    for (name, head, entry) in [
        (
            "a.toml",
            "symbols = [\"go\"]\n",
            "[[examples]]\nword = [\"go\"]\nlabel = true\n",
        ),
        (
            "a.json",
            "{\"symbols\": [\"go\"], \"examples\": [\n",
            "{\"word\": [\"go\"]},\n",
        ),
    ] {
        fill(&folder.join(name), head, SIZE, |_, line| {
            line.push_str(entry);
        });
        let complaint = run(folder, name, &["task", "check", name], 2);
        assert!(complaint.contains(":1:1: this has"), "{complaint}");
        assert!(complaint.contains("at most 4194304"), "{complaint}");
    }
}

#[test]
fn recordings_are_read_in_little_memory() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let random = &mut ChaCha8Rng::seed_from_u64(3);
    fill(&folder.join("runs.jsonl"), "", SIZE, |number, line| {
        let first = word(random, &["\"a\"", "\"b\""], ",");
        let rest = "\"a\",\"b\"".to_owned() + &",\"b\"".repeat(28);
        let between = if first.is_empty() { "" } else { "," };
        writeln!(
            line,
            "{{\"id\":\"run {number}\",\"word\":[{first}{between}{rest}]}}"
        )
        .unwrap();
    });
    let task = "symbols = [\"a\", \"b\"]\n[world]\nkind = \"pool\"\nrecordings = \"runs.jsonl\"\n";
    std::fs::write(folder.join("a.toml"), task).unwrap();
    check(folder, "runs.jsonl", &["task", "check", "a.toml"]);
}

#[test]
fn logs_are_read_in_little_memory() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let created = Session::created(ready("tomita:1").unwrap(), Setup::default());
    let mut session = Session::replay(std::slice::from_ref(&created)).unwrap();
    // A question put and skipped; that taken back, and the next one put.
    let asked = session.think().unwrap();
    session.apply(&asked).unwrap();
    let Ok(Decision::Append(skipped)) = session.answer(1, &Reply::Skip) else {
        panic!("{:?}", session.position());
    };
    session.apply(&skipped).unwrap();
    let Ok(Decision::Append(undone)) = session.undo() else {
        panic!("{:?}", session.position());
    };
    let body = |event: &Event| serde_json::to_string(event).unwrap();
    let (asked, skipped, undone) = (body(&asked), body(&skipped), body(&undone));
    let line = |seq: usize, body: &str| {
        let at = "2026-01-31T12:00:00.000Z";
        format!("{{\"seq\":{seq},\"at\":\"{at}\",{}\n", &body[1..])
    };
    let head = line(0, &body(&created));
    fill(&folder.join("log.jsonl"), &head, SIZE, |place, text| {
        let number = format!("\"number\":{}", place / 3 + 1);
        let body = [&asked, &skipped, &undone][place % 3];
        *text = line(place + 1, &body.replace("\"number\":1", &number));
    });
    check(folder, "log.jsonl", &["replay", "--fold", "log.jsonl"]);
}
