//! `memrep bench` as a shell sees it: tiny runs of every experiment.

use std::path::Path;
use std::process::Command;

use tempfile::TempDir;

/// Runs `memrep bench` and returns its exit status, with what it said.
fn bench(folder: &TempDir, arguments: &str) -> (Option<i32>, String) {
    let output = Command::new(env!("CARGO_BIN_EXE_memrep"))
        .arg("bench")
        .args(arguments.split_whitespace())
        .current_dir(folder.path())
        .output()
        .unwrap();
    let said = [output.stdout, output.stderr].concat();
    (output.status.code(), String::from_utf8(said).unwrap())
}

fn read(folder: &TempDir, file: impl AsRef<Path>) -> String {
    let path = folder.path().join(file);
    std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// The page without its section on times, which varies.
fn page(folder: &TempDir, file: &str) -> String {
    let text = read(folder, file);
    let (lasting, times) = text.split_once("\n## CPU time").unwrap();
    assert!(times.contains("varies from run to run"));
    lasting.to_owned()
}

/// Runs it twice, the second time on one thread, and checks that all files are
/// the same; returns the lines of the table and the page.
fn check(name: &str, arguments: &str, status: i32) -> (Vec<Vec<String>>, String) {
    let folder = tempfile::tempdir().unwrap();
    for (out, threads) in [("one", 2), ("two", 1)] {
        let arguments = format!("{name} {arguments} --out {out} --threads {threads}");
        let (code, said) = bench(&folder, &arguments);
        assert_eq!(code, Some(status), "{said}");
    }
    for extension in ["csv", "svg"] {
        let file = |out: &str| read(&folder, format!("{out}/{name}.{extension}"));
        assert_eq!(file("one"), file("two"));
    }
    let text = page(&folder, &format!("one/{name}.md"));
    assert_eq!(text, page(&folder, &format!("two/{name}.md")));
    assert!(text.contains(&format!("\n`memrep bench {name} ")), "{text}");
    assert!(read(&folder, format!("one/{name}.svg")).starts_with("<svg "));
    let table = read(&folder, format!("one/{name}.csv"));
    let lines = table
        .lines()
        .map(|line| line.split(',').map(String::from).collect());
    (lines.collect(), text)
}

fn column(lines: &[Vec<String>], name: &str) -> Vec<String> {
    let place = lines[0].iter().position(|column| column == name).unwrap();
    lines[1..].iter().map(|line| line[place].clone()).collect()
}

#[test]
fn tomita_is_the_same_for_the_same_seed() {
    let (lines, page) = check("tomita", "--trials 2 --strategy thesis,membership", 0);
    assert_eq!(lines.len(), 1 + 7 * 5 * 2 * 2);
    assert!(
        column(&lines, "equivalent")
            .iter()
            .all(|cell| cell == "true")
    );
    assert!(page.starts_with("# Tomita's seven languages"));
    assert!(page.contains("140 of 140 runs ended equivalent"));
    // Table 5.1's first cell, with Table 5.2's variance.
    assert!(
        page.contains("| tomita:1 | 1 | 3.1 (0.13) + 1.4 (0.75) |"),
        "{page}"
    );
    // All-in cost is what the columns say it is.
    let all = |name: &str| -> Vec<f64> {
        let cells = column(&lines, name);
        cells
            .iter()
            .map(|cell| cell.parse().unwrap_or(f64::INFINITY))
            .collect()
    };
    let (cost, all_in) = (all("cost"), all("all_in_cost"));
    let (price, m, p, e) = (
        all("membership_cost"),
        all("membership"),
        all("comparison"),
        all("equivalence"),
    );
    for run in 0..cost.len() {
        assert!((cost[run] - (price[run] * m[run] + p[run])).abs() < 1e-9);
        assert!((all_in[run] - (cost[run] + 4.0 * price[run] * e[run])).abs() < 1e-9);
    }
}

#[test]
fn bayes_takes_part() {
    let arguments = "--targets 1 --trials 1 --costs 8 --strategy thesis,bayes";
    let (lines, page) = check("random", arguments, 0);
    assert_eq!(lines.len(), 1 + 2);
    assert!(
        page.contains(" --costs 8 --strategy bayes,thesis`"),
        "{page}"
    );
    assert!(
        page.contains("a geometric mean over the one target"),
        "{page}"
    );
}

#[test]
fn modulo_zeros_and_the_robot() {
    let (lines, page) = check("modulo", "--trials 1 --strategy thesis,membership", 0);
    assert_eq!(lines.len(), 1 + 4 * 5 * 2);
    assert!(
        page.contains("| modulo:40 | 8 | 11.3 + 31.4 / 22.6 |"),
        "{page}"
    );

    let (lines, page) = check("zeros", "--trials 1 --costs 1,none --strategy thesis", 0);
    assert_eq!(lines.len(), 1 + 4 * 2);
    assert_eq!(column(&lines, "comparison_cost")[..2], ["1", "inf"]);
    assert!(page.contains("| zeros:1 | 1 | 7.3 + 3.1 |"), "{page}");

    let (lines, page) = check("robot", "--trials 2 --strategy thesis", 0);
    // Alone, with RY known, and in a room as well.
    assert_eq!(lines.len(), 1 + 3 * 5 * 2);
    assert!(page.contains("random preference order"), "{page}");
    assert!(page.contains("Nothing was run beside `thesis`"), "{page}");
    assert!(page.contains("2.03 comparisons"), "{page}");
}

#[test]
fn drawn_targets_are_counted_by_size() {
    for (name, family) in [("random", "random:2"), ("tasks", "task:2")] {
        let arguments = "--targets 3 --trials 1 --seed 7 --strategy thesis,membership";
        let (lines, page) = check(name, arguments, 0);
        assert_eq!(lines.len(), 1 + 3 * 5 * 2);
        assert!(column(&lines, "target").contains(&family.to_owned()));
        assert!(column(&lines, "seed").iter().all(|seed| seed == "7"));
        assert!(page.contains("seeds 7 to 7."), "{page}");
        assert!(page.contains(" states | 1 | thesis |"), "{page}");
    }
}

/// Wrong answers do not fail the experiment, and the clean runs are its measure.
#[test]
fn noise_is_told_from_clean_runs() {
    let (lines, page) = check("noise", "--trials 1 --errors 0,5 --strategy thesis", 0);
    assert_eq!(lines.len(), 1 + 7 * 2);
    assert!(
        page.contains("7 of 7 runs without wrong answers ended equivalent"),
        "{page}"
    );
    assert!(
        page.contains("| 0 % | thesis | 100.0 % | 100.0 % | 1.00 | 1.00 | 0.0 |"),
        "{page}"
    );
    let dropped = column(&lines, "dropped");
    assert!(dropped.iter().any(|dropped| dropped != "0"));
}

#[test]
fn refuses_what_it_cannot_run() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("file"), "").unwrap();
    let cases = [
        ("tomita --trials 0", "--trials"),
        ("tomita --strategy nobody", "possible values"),
        ("tomita --targets 3", "--targets"),
        ("tomita --strategy bayes-robust", "takes part in `tomita`"),
        ("noise --aalpy python3", "leave it out"),
        ("noise --costs 1,2", "give one"),
        ("zeros --costs 0", "give whole numbers from 1"),
        (
            "random --targets 1 --trials 1 --out file",
            "cannot make this folder",
        ),
        (
            "zeros --trials 1 --strategy thesis --aalpy /nowhere/python",
            "/nowhere/python: cannot run this Python",
        ),
    ];
    for (arguments, message) in cases {
        let (code, said) = bench(&folder, arguments);
        assert_eq!(code, Some(2), "{arguments}: {said}");
        assert!(said.contains(message), "{arguments}: {said}");
    }
}

/// L*, KV and L# of `AALpy` beside ours, in a Python that has it.
#[test]
fn rivals_ask_what_they_are_known_to_ask() {
    let Some(python) = std::env::var_os("MEMREP_PYTHON") else {
        eprintln!("skipped: set MEMREP_PYTHON to a Python that has the package aalpy");
        return;
    };
    let python = python.to_str().unwrap();
    let arguments =
        format!("--trials 1 --counterexample shortest --strategy thesis --aalpy {python}");
    let (lines, page) = check("tomita", &arguments, 0);
    assert_eq!(lines.len(), 1 + 7 * 5 * (1 + 3));
    let counts = |rival: &str| -> Vec<(String, String)> {
        let runs = lines
            .iter()
            .filter(|l| l[3] == rival && l[4] == "1" && l[5] == "1");
        runs.map(|l| (l[9].clone(), l[11].clone())).collect()
    };
    // Counted by hand from a run of the library: a word is charged once, and
    // neither the empty word nor a counterexample is charged.
    let expected = |pairs: [(u32, u32); 3]| pairs.map(|(m, e)| (m.to_string(), e.to_string()));
    assert_eq!(
        counts("lstar")[..2],
        expected([(4, 1), (9, 2), (0, 0)])[..2]
    );
    assert_eq!(counts("kv")[..2], expected([(3, 2), (7, 3), (0, 0)])[..2]);
    assert!(
        page.contains("## Costs over those of `KV (AALpy)`"),
        "{page}"
    );
    // With random counterexamples the same seed gives the same words too.
    let arguments = format!("--targets 2 --trials 2 --strategy thesis --aalpy {python}");
    check("random", &arguments, 0);
}

/// All concepts end learned, and the page has the exchange of Fig. 5.3.
#[test]
fn monotone_predicates() {
    let arguments = "--targets 6 --trials 1 --costs 1,4,none";
    let (rows, page) = check("monotone", arguments, 0);
    assert_eq!(
        rows.len(),
        1 + 6 * 5 * 3,
        "six concepts, five contenders, three costs"
    );
    assert_eq!(
        rows[0][..3],
        ["target", "size", "dimensions"].map(String::from)
    );
    let column = |name: &str| rows[0].iter().position(|column| column == name).unwrap();
    for row in &rows[1..] {
        assert_eq!(row[column("equivalent")], "true", "{row:?}");
        if row[column("comparison_cost")] == "inf" || row[column("contender")] == "membership" {
            assert_eq!(row[column("comparison")], "0", "{row:?}");
        }
    }
    assert!(page.contains("removing one membership query adds 2.4 queries on average"));
    assert!(page.contains("| C = 1 to 4 |"));
    let folder = tempfile::tempdir().unwrap();
    let (status, said) = bench(&folder, "monotone --aalpy python3");
    assert_eq!(status, Some(2));
    assert!(said.contains("these rivals learn automata"), "{said}");
}
