//! `memrep bench serve` as a shell sees it: a small crowd at a real server.
#![cfg(feature = "server")]

use std::path::Path;
use std::process::Command;

/// Runs it in the folder for so long: its table, if all went well.
fn run(folder: &Path, seconds: &str) -> String {
    let output = Command::new(env!("CARGO_BIN_EXE_memrep"))
        .args(["bench", "serve", "--people", "2,6", "--think", "0.05"])
        .args(["--seconds", seconds, "--tasks", "tomita:1,robot"])
        .args(["--idle", "20", "--out", "."])
        .current_dir(folder)
        .output()
        .unwrap();
    let said = String::from_utf8([output.stdout, output.stderr].concat()).unwrap();
    assert!(output.status.success(), "{said}");
    std::fs::read_to_string(folder.join("serve.csv")).unwrap()
}

/// The column of this name, a number for each crowd.
fn column(table: &str, name: &str) -> Vec<f64> {
    let mut rows = csv::Reader::from_reader(table.as_bytes());
    let head = rows.headers().unwrap().clone();
    let place = head.iter().position(|known| known == name).unwrap();
    let rows = rows.records().map(|row| row.unwrap()[place].parse());
    rows.map(Result::unwrap).collect()
}

#[test]
fn a_small_crowd_is_served_and_told_of() {
    let folder = tempfile::tempdir().unwrap();
    // Short sessions come to their end, and others begin: on a slow machine later.
    let enough = |table: &String| {
        let all = |name, least| column(table, name).iter().all(|many| *many > least);
        all("ended", 0.0) && all("begun", 0.0) && all("answers", 5.0)
    };
    let mut tables = ["4", "16", "60"].iter().map(|s| run(folder.path(), s));
    let table = tables.find(enough).expect("no session ends in a minute");
    let read = |name: &str| std::fs::read_to_string(folder.path().join(name)).unwrap();
    let page = read("serve.md");
    assert_eq!(column(&table, "people"), [2.0, 6.0]);
    assert_eq!(column(&table, "failed"), [0.0, 0.0], "{table}");
    for row in 0..2 {
        let number = |name: &str| column(&table, name)[row];
        assert!(number("page_p95_ms") > 0.0, "{table}");
        assert!(number("append_p99_ms") > 0.0, "{table}");
        assert!(number("p50_ms") > 0.0 && number("p50_ms") <= number("p99_ms"));
        assert!(number("p99_ms") <= number("max_ms"));
        if cfg!(target_os = "linux") {
            assert!(
                number("memory") > 1e6 && number("server_cores") > 0.0,
                "{table}"
            );
        }
    }
    assert!(page.contains("`memrep bench serve --people 2,6 "), "{page}");
    assert!(page.contains("## Sessions that nobody teaches") && page.contains("20 sessions"));
    assert!(read("serve.svg").starts_with("<svg "));
}

/// The processes that work in this folder or below.
#[cfg(target_os = "linux")]
fn at_work_in(folder: &Path) -> usize {
    let processes = std::fs::read_dir("/proc").unwrap();
    let places = processes.map(|process| std::fs::read_link(process.unwrap().path().join("cwd")));
    places
        .filter(|place| place.as_ref().is_ok_and(|place| place.starts_with(folder)))
        .count()
}

/// Waits until that many processes work there.
#[cfg(target_os = "linux")]
fn wait_for(many: usize, folder: &Path) {
    let begun = std::time::Instant::now();
    while at_work_in(folder) != many {
        assert!(begun.elapsed().as_secs() < 30, "not {many} at work");
        std::thread::sleep(std::time::Duration::from_millis(50));
    }
}

#[test]
#[cfg(target_os = "linux")]
fn stopped_in_the_middle_it_leaves_nothing_behind() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path().canonicalize().unwrap();
    let mut bench = Command::new(env!("CARGO_BIN_EXE_memrep"))
        .args([
            "bench",
            "serve",
            "--people",
            "2",
            "--seconds",
            "300",
            "--out",
        ])
        .arg(folder.join("out"))
        .env("TMPDIR", &folder)
        .stderr(std::process::Stdio::piped())
        .spawn()
        .unwrap();
    wait_for(1, &folder);
    let process = rustix::process::Pid::from_child(&bench);
    rustix::process::kill_process(process, rustix::process::Signal::TERM).unwrap();
    assert_eq!(bench.wait().unwrap().code(), Some(2));
    wait_for(0, &folder);
    let left: Vec<_> = std::fs::read_dir(&folder)
        .unwrap()
        .map(|file| file.unwrap().file_name())
        .collect();
    assert_eq!(left, ["out"]);
    assert_eq!(std::fs::read_dir(folder.join("out")).unwrap().count(), 0);
}
