//! Names of uploaded files lead nowhere: they are keys in the database and never paths.

use std::collections::BTreeSet;
use std::path::Path;

use axum::http::StatusCode;
use serde_json::json;

use crate::parts::{PNG, Parts, SESSIONS, binary, rows};
use crate::site::Site;

/// What lies in a folder.
fn listed(folder: &Path) -> BTreeSet<String> {
    let entries = std::fs::read_dir(folder).unwrap();
    let name = |entry: std::io::Result<std::fs::DirEntry>| entry.unwrap().file_name();
    entries
        .map(|entry| name(entry).to_string_lossy().into_owned())
        .collect()
}

fn recorded(path: &str) -> String {
    let media = json!({"kind": "frames", "paths": [path]});
    json!({"id": "a", "word": ["0"], "media": media}).to_string()
}

#[tokio::test]
async fn names_that_lead_elsewhere_are_refused_and_nothing_is_written() {
    let folder = tempfile::tempdir().unwrap();
    let within = folder.path().join("within");
    std::fs::create_dir(&within).unwrap();
    let database = within.join("a.db");
    let site = Site::at(&database);
    let long = format!("{}.png", "a/".repeat(3000));
    let elsewhere = format!("{}/out.png", folder.path().display());
    for name in [
        "../out.png",
        "../../out.png",
        "a/../../out.png",
        "/out.png",
        "//host/out.png",
        elsewhere.as_str(),
        "..\\\\out.png",
        "a\\\\..\\\\out.png",
        "C:\\\\out.png",
        "C:out.png",
        "./out.png",
        "a//out.png",
        "out\0.png",
        "out.png\0",
        "a\tout.png",
        "..",
        ".",
        long.as_str(),
    ] {
        for line in [recorded(name), recorded("a.png")] {
            let parts = Parts::default().task(&binary()).recordings(&line);
            let reply = parts.media(name, PNG).send(&site, SESSIONS).await;
            assert!(reply.status.is_client_error(), "{name:?}: {}", reply.text);
            assert_eq!(rows(&database), 0, "{name:?}");
        }
    }
    assert_eq!(listed(folder.path()), ["within".to_owned()].into());
    let left = listed(&within);
    assert!(left.iter().all(|name| name.starts_with("a.db")), "{left:?}");
}

/// A name that only looks dangerous is a name like any other: it is never decoded.
#[tokio::test]
async fn a_name_is_taken_as_it_is_written() {
    let folder = tempfile::tempdir().unwrap();
    let within = folder.path().join("within");
    std::fs::create_dir(&within).unwrap();
    let site = Site::at(&within.join("a.db"));
    for (name, address) in [
        ("%2e%2e/out.png", "%252e%252e/out.png"),
        ("..%2fout.png", "..%252fout.png"),
        ("...png", "...png"),
        ("out.png/out.png", "out.png/out.png"),
    ] {
        let parts = Parts::default().task(&binary()).recordings(&recorded(name));
        let reply = parts.media(name, PNG).send(&site, SESSIONS).await;
        assert_eq!(reply.status, StatusCode::CREATED, "{name}: {}", reply.text);
        let id = reply.json()["id"].as_str().unwrap().to_owned();
        let got = site.get(&format!("/sessions/{id}/media/{address}")).await;
        assert_eq!(got.status, StatusCode::OK, "{name}");
        assert_eq!(got.bytes, PNG);
        assert_eq!(got.header("x-content-type-options"), "nosniff");
    }
    assert_eq!(listed(folder.path()), ["within".to_owned()].into());
}

#[tokio::test]
async fn addresses_of_files_lead_to_that_uploads_files_alone() {
    let folder = tempfile::tempdir().unwrap();
    let database = folder.path().join("a.db");
    let site = Site::at(&database);
    let begin = async |name: &str| -> String {
        let parts = Parts::default().task(&binary()).recordings(&recorded(name));
        let reply = parts.media(name, PNG).send(&site, SESSIONS).await;
        assert_eq!(reply.status, StatusCode::CREATED, "{}", reply.text);
        reply.json()["id"].as_str().unwrap().to_owned()
    };
    let (own, other) = (begin("own.png").await, begin("other.png").await);
    let media = |path: &str| format!("/sessions/{own}/media/{path}");
    let there = site.get(&media("own.png")).await;
    assert_eq!((there.status, &there.bytes[..]), (StatusCode::OK, PNG));
    let long = "a".repeat(8000);
    let of_other = format!("../../{other}/media/other.png");
    let encoded = format!("..%2f..%2f{other}%2fmedia%2fother.png");
    for path in [
        "other.png",
        of_other.as_str(),
        encoded.as_str(),
        "../own.png",
        "./own.png",
        "%2e/own.png",
        "%2e%2e/own.png",
        "a/../own.png",
        "a/%2e%2e/own.png",
        "..%5cown.png",
        "own.png%00",
        "%00own.png",
        "own.png/",
        "/own.png",
        "OWN.PNG",
        "own.png%20",
        "../../a.db",
        "..%2f..%2fa.db",
        "..%252f..%252fa.db",
        "/etc/passwd",
        "%2fetc%2fpasswd",
        "file:%2f%2f%2fetc%2fpasswd",
        "recordings",
        "*",
        "%25",
        "%ff",
        long.as_str(),
    ] {
        let reply = site.get(&media(path)).await;
        let said = format!("{path}: {} {}", reply.status, reply.text);
        assert!(
            reply.status == StatusCode::NOT_FOUND || reply.status == StatusCode::BAD_REQUEST,
            "{said}"
        );
        assert!(
            !reply.text.contains("root:") && !reply.text.contains("SQLite"),
            "{said}"
        );
    }
    for path in [
        "../app.css",
        "%2e%2e/app.css",
        "..%2fmain.rs",
        "/etc/passwd",
    ] {
        let reply = site.get(&format!("/static/0/{path}")).await;
        assert_eq!(reply.status, StatusCode::NOT_FOUND, "{path}");
    }
}
