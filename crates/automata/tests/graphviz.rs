//! Graphviz reads what is written for it: every state, every arrow and every name, also
//! where names are words of its own language.
//!
//! Needs the command `dot`; skipped where there is none, unless `MEMREP_GRAPHVIZ` is
//! set, as `./scripts/test` does.

mod support;

use std::collections::{BTreeMap, BTreeSet};
use std::io::Write as _;
use std::process::{Command, Stdio};

use automata::format::{dot, dot_people};
use automata::{Alphabet, Dfa, StateId};
use rand::RngExt;
use support::{dfa, generator};

const AUTOMATA: usize = 500;

/// Alphabets whose names are words of DOT, of programs or numbers.
fn alphabets() -> [Alphabet; 6] {
    let names: [&[&str]; 6] = [
        &["a", "b"],
        &["node", "edge", "graph", "digraph", "subgraph", "strict"],
        &["s0", "s1", "__start0", "start", "0", "automaton"],
        &["label", "shape", "doublecircle", "otherwise", "any"],
        &["007", "8", "1e5", "0x1", "_", "inf"],
        &[
            "__import__",
            "eval",
            "script",
            "onload",
            "null",
            "E",
            "N",
            "G",
        ],
    ];
    names.map(|names| Alphabet::new(names.iter().copied()).unwrap())
}

/// Has Graphviz lay the graphs out, as often as there are graphs, and tell them in its
/// plain form; none where there is no Graphviz.
fn plain(graphs: &str) -> Option<String> {
    let child = Command::new("dot")
        .arg("-Tplain")
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn();
    let mut child = match child {
        Ok(child) => child,
        Err(error) if std::env::var_os("MEMREP_GRAPHVIZ").is_none() => {
            eprintln!("skipped: cannot start `dot` of Graphviz: {error}");
            return None;
        }
        Err(error) => panic!("cannot start `dot` of Graphviz: {error}"),
    };
    let mut input = child.stdin.take().unwrap();
    let text = graphs.to_owned();
    let writer = std::thread::spawn(move || input.write_all(text.as_bytes()).unwrap());
    let output = child.wait_with_output().unwrap();
    writer.join().unwrap();
    let complaint = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{complaint}");
    assert_eq!(complaint, "", "Graphviz warns of something");
    Some(String::from_utf8(output.stdout).unwrap())
}

/// The fields of a line in Graphviz's plain form, in which quotes hold spaces together.
fn fields(line: &str) -> Vec<String> {
    let (mut fields, mut is_quoted) = (vec![String::new()], false);
    for c in line.chars() {
        match c {
            '"' => is_quoted = !is_quoted,
            ' ' if !is_quoted => fields.push(String::new()),
            c => fields.last_mut().unwrap().push(c),
        }
    }
    fields
}

/// What Graphviz has read.
#[derive(Default)]
struct Graph {
    /// The shape of each node.
    shapes: BTreeMap<String, String>,
    /// From where to where, with what on the arrow.
    arrows: BTreeSet<(String, String, String)>,
}

fn graphs(plain: &str) -> Vec<Graph> {
    let mut graphs = vec![Graph::default()];
    for line in plain.lines() {
        let graph = graphs.last_mut().unwrap();
        let fields = fields(line);
        match fields[0].as_str() {
            "node" => {
                graph.shapes.insert(fields[1].clone(), fields[8].clone());
            }
            "edge" => {
                let points: usize = fields[3].parse().unwrap();
                // Behind the points stands the label with its place, if there is one.
                let label = fields.get(4 + 2 * points);
                let has_label = fields.len() > 6 + 2 * points;
                let label = label.filter(|_| has_label).cloned().unwrap_or_default();
                let (from, to) = (fields[1].clone(), fields[2].clone());
                assert!(graph.arrows.insert((from, to, label)), "twice: {line}");
            }
            "stop" => graphs.push(Graph::default()),
            _ => {}
        }
    }
    graphs.pop();
    graphs
}

fn cases() -> Vec<Dfa> {
    let alphabets = alphabets();
    (0..AUTOMATA)
        .map(|case| {
            let mut random = generator(case as u64);
            let alphabet = &alphabets[random.random_range(0..alphabets.len())];
            dfa(alphabet, 6, &mut random)
        })
        .collect()
}

#[test]
fn graphviz_reads_every_state_and_arrow_of_what_is_for_programs() {
    let cases = cases();
    let texts: Vec<String> = cases.iter().map(|dfa| dot::write(dfa).unwrap()).collect();
    let Some(plain) = plain(&texts.concat()) else {
        return;
    };
    let graphs = graphs(&plain);
    assert_eq!(graphs.len(), AUTOMATA);
    for (case, (dfa, graph)) in cases.iter().zip(&graphs).enumerate() {
        let name = |state: StateId| format!("s{}", state.index());
        let mut shapes = BTreeMap::from([("__start0".to_owned(), "none".to_owned())]);
        let start = ("__start0".to_owned(), name(dfa.start()), String::new());
        let mut arrows = BTreeSet::from([start]);
        for state in dfa.states() {
            let shape = if dfa.is_accepting(state) {
                "doublecircle"
            } else {
                "circle"
            };
            shapes.insert(name(state), shape.to_owned());
            for symbol in dfa.alphabet().symbols() {
                let label = dfa.alphabet().name(symbol).to_owned();
                arrows.insert((name(state), name(dfa.next(state, symbol)), label));
            }
        }
        assert_eq!(graph.shapes, shapes, "automaton {case}");
        assert_eq!(graph.arrows, arrows, "automaton {case}");
    }
}

#[test]
fn graphviz_draws_what_is_for_people() {
    let cases = cases();
    let texts: Vec<String> = cases.iter().map(dot_people::write).collect();
    let Some(plain) = plain(&texts.concat()) else {
        return;
    };
    let graphs = graphs(&plain);
    assert_eq!(graphs.len(), AUTOMATA);
    for (case, (dfa, graph)) in cases.iter().zip(&graphs).enumerate() {
        let live = dfa.live();
        let hides = |q: StateId| live[dfa.start().index()] && !live[q.index()];
        let shown: Vec<StateId> = dfa.states().filter(|&q| !hides(q)).collect();
        let accepting = |q: &&StateId| dfa.is_accepting(**q);
        let rings = graph.shapes.values().filter(|s| *s == "doublecircle");
        assert_eq!(
            rings.count(),
            shown.iter().filter(accepting).count(),
            "{case}"
        );
        assert_eq!(graph.shapes.len(), 1 + shown.len(), "automaton {case}");
        for &state in &shown {
            for symbol in dfa.alphabet().symbols() {
                let next = dfa.next(state, symbol);
                let (from, to) = (state.index().to_string(), next.index().to_string());
                let letter = dfa.alphabet().name(symbol);
                let says = |label: &str| {
                    ["any", "otherwise"].contains(&label) || label.split(", ").any(|l| l == letter)
                };
                let mut arrows = graph.arrows.iter();
                let is_drawn = arrows.any(|(f, t, label)| *f == from && *t == to && says(label));
                assert_eq!(is_drawn, !hides(next), "automaton {case}: {from} {letter}");
            }
        }
    }
}
