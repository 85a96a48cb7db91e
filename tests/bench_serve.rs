//! `memrep bench serve` as a shell sees it: a small crowd at a real server.
#![cfg(feature = "server")]

use std::process::Command;

#[test]
fn a_small_crowd_is_served_and_told_of() {
    let folder = tempfile::tempdir().unwrap();
    let output = Command::new(env!("CARGO_BIN_EXE_memrep"))
        .args([
            "bench",
            "serve",
            "--people",
            "2,6",
            "--think",
            "0.05",
            "--seconds",
            "2",
        ])
        .args(["--tasks", "tomita:1,robot", "--idle", "20", "--out", "."])
        .current_dir(folder.path())
        .output()
        .unwrap();
    let said = String::from_utf8([output.stdout, output.stderr].concat()).unwrap();
    assert!(output.status.success(), "{said}");
    let read = |name: &str| std::fs::read_to_string(folder.path().join(name)).unwrap();
    let (table, page) = (read("serve.csv"), read("serve.md"));
    let mut rows = csv::Reader::from_reader(table.as_bytes());
    let head = rows.headers().unwrap().clone();
    let column = |name: &str| head.iter().position(|known| known == name).unwrap();
    let rows: Vec<csv::StringRecord> = rows.records().map(Result::unwrap).collect();
    assert_eq!(rows.len(), 2);
    for (row, people) in rows.iter().zip(["2", "6"]) {
        let number = |name: &str| row[column(name)].parse::<f64>().unwrap();
        assert_eq!(&row[column("people")], people);
        assert_eq!(&row[column("failed")], "0", "{table}");
        assert!(number("answers") > 5.0, "{table}");
        // Short sessions come to their end, and others begin.
        assert!(number("ended") > 0.0 && number("begun") > 0.0, "{table}");
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
