//! Whoever is told that something went wrong here is told a name, and under that name
//! the log has the cause.

use memrep::store::{SessionId, Sqlite, Store};
use serde_json::Value;

use crate::stop::{Line, Server};

/// A path is asked for twice, by a program and by a person: what the API says, and
/// the page.
fn both(server: &Server, session: &SessionId) -> (Value, String) {
    let mut line = Line::to(&server.address).unwrap();
    let api = format!("/api/v1/sessions/{session}/question");
    let (status, told) = line.ask("GET", &api, &Value::Null).unwrap();
    assert_eq!(status, 500, "{told}");
    line.send("GET", &format!("/sessions/{session}"), &Value::Null)
        .unwrap();
    let (status, page) = line.receive().unwrap().unwrap();
    assert_eq!(status, 500, "{page}");
    (told["error"].clone(), page)
}

#[test]
fn the_log_has_the_cause_under_the_name_that_the_page_tells() {
    let folder = tempfile::tempdir().unwrap();
    let database = folder.path().join("a.db");
    let session = SessionId::random().unwrap();
    {
        let store = Sqlite::open(&database).unwrap();
        let unknown = "{\"event\":\"unheard-of\"}";
        store.append(&session, 0, unknown).unwrap();
    }
    let server = Server::start(folder.path(), "warn");
    let unreadable = both(&server, &session);
    // What should not happen: somebody else's hand.
    let connection = rusqlite::Connection::open(&database).unwrap();
    connection
        .execute_batch("ALTER TABLE entries RENAME TO others")
        .unwrap();
    let broken = both(&server, &session);
    connection
        .execute_batch("ALTER TABLE others RENAME TO entries")
        .unwrap();
    drop(connection);
    server.stop();

    let log = std::fs::read_to_string(folder.path().join("log")).unwrap();
    let lines: Vec<Value> = (log.lines())
        .map(|line| serde_json::from_str(line).unwrap_or_else(|e| panic!("{e}: {line}")))
        .collect();
    for ((error, page), code, message, cause) in [
        (unreadable, "log_unreadable", "log unreadable", "unheard-of"),
        (broken, "internal", "request failed", "no such table"),
    ] {
        assert_eq!(error["code"], code, "{error}");
        let of_api = |line: &&Value| line["request"] == error["request"];
        let of_page = |line: &&Value| {
            let name = line["request"].as_str().unwrap_or_default();
            !name.is_empty() && page.contains(name)
        };
        let of_both = [lines.iter().find(of_api), lines.iter().find(of_page)];
        for line in of_both {
            let line = line.unwrap_or_else(|| panic!("{error}\n{page}\n{log}"));
            assert_eq!(line["level"], "error", "{line}");
            assert_eq!(line["message"], message, "{line}");
            let told = line["cause"].as_str().unwrap_or_default();
            assert!(told.contains(cause), "{line}");
        }
        let tells = code == "internal" && page.contains(cause);
        assert!(!tells, "the cause is for the log: {page}");
    }
}
