//! The real binary as a process of its own, spoken to over HTTP; and people with a
//! script who answer its questions.

use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::path::Path;
use std::process::{Child, Command, Output, Stdio};
use std::time::Duration;

use serde_json::{Value, json};

/// The binary with these arguments.
pub(crate) fn memrep(arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_memrep"));
    command.args(arguments).env_remove("MEMREP_DATABASE");
    command
}

/// Runs a command that is to succeed: its output.
pub(crate) fn done(command: &mut Command) -> String {
    let Output {
        status,
        stdout,
        stderr,
    } = command.output().unwrap();
    let stderr = String::from_utf8_lossy(&stderr);
    assert!(status.success(), "{status}: {stderr}");
    String::from_utf8(stdout).unwrap()
}

/// Runs a command that is to be refused: what it says.
pub(crate) fn refused(command: &mut Command) -> String {
    let output = command.output().unwrap();
    assert_eq!(output.status.code(), Some(2), "{output:?}");
    String::from_utf8(output.stderr).unwrap()
}

/// A server, which goes when this does.
pub(crate) struct Server {
    pub(crate) child: Child,
    pub(crate) address: String,
}

/// What the server answered.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Reply {
    pub(crate) status: u16,
    pub(crate) body: String,
}

impl Reply {
    pub(crate) fn json(&self) -> Value {
        serde_json::from_str(&self.body).unwrap_or_else(|e| panic!("{e}: {}", self.body))
    }
}

impl Server {
    /// One over this database, a path or an address.
    pub(crate) fn over(database: &str) -> Self {
        Self::start(memrep(&[]), database)
    }

    pub(crate) fn at(database: &Path) -> Self {
        Self::over(database.to_str().unwrap())
    }

    /// One that `command` starts once it has the usual arguments.
    pub(crate) fn start(mut command: Command, database: &str) -> Self {
        command
            .args(["serve", "--addr", "127.0.0.1:0", "--log", "off"])
            .args(["--database", database])
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped());
        let mut child = command.spawn().unwrap();
        let mut line = String::new();
        let mut out = BufReader::new(child.stdout.as_mut().unwrap());
        out.read_line(&mut line).unwrap();
        let address = line
            .trim()
            .strip_prefix("memrep is at http://")
            .and_then(|rest| rest.strip_suffix('/'));
        let Some(address) = address.map(str::to_owned) else {
            let mut why = String::new();
            let _ = child.stderr.as_mut().unwrap().read_to_string(&mut why);
            panic!("no server: {line}{why}");
        };
        Self { child, address }
    }

    /// Ends it at once, with no word of warning.
    pub(crate) fn kill(&mut self) {
        self.child.kill().unwrap();
        self.child.wait().unwrap();
    }

    pub(crate) fn ask(&self, method: &str, path: &str, body: &Value) -> Reply {
        ask(&self.address, method, path, body).unwrap_or_else(|| panic!("{path}: no reply"))
    }

    pub(crate) fn json(&self, method: &str, path: &str, body: &Value) -> Value {
        let reply = self.ask(method, path, body);
        assert!(reply.status < 300, "{path}: {reply:?}");
        reply.json()
    }
}

impl Drop for Server {
    fn drop(&mut self) {
        // Already gone where a test has killed it.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// Sends a request, with JSON or the text of a form; none unless the whole of the reply came back.
pub(crate) fn ask(address: &str, method: &str, path: &str, body: &Value) -> Option<Reply> {
    let mut stream = TcpStream::connect(address).ok()?;
    stream
        .set_read_timeout(Some(Duration::from_secs(60)))
        .unwrap();
    let (kind, body) = match body {
        Value::Null => ("application/json", String::new()),
        Value::String(form) => ("application/x-www-form-urlencoded", form.clone()),
        json => ("application/json", json.to_string()),
    };
    write!(
        stream,
        "{method} {path} HTTP/1.1\r\nHost: {address}\r\nConnection: close\r\nContent-Type: {kind}\r\nContent-Length: {}\r\n\r\n{body}",
        body.len()
    )
    .ok()?;
    let mut text = String::new();
    stream.read_to_string(&mut text).ok()?;
    let status = text.split(' ').nth(1)?.parse().ok()?;
    let (head, body) = text.split_once("\r\n\r\n")?;
    // Killed while it wrote, the server leaves less than it promised.
    let promised = head.lines().find_map(|line| {
        let (name, value) = line.split_once(": ")?;
        name.eq_ignore_ascii_case("content-length")
            .then(|| value.parse::<usize>().ok())?
    })?;
    (promised == body.len()).then(|| Reply {
        status,
        body: body.to_owned(),
    })
}

/// What somebody answers who accepts words without `000` (Tomita's fourth language);
/// none where nothing is asked.
pub(crate) fn answer(question: &Value) -> Option<Value> {
    let accepts = |word: &Value| {
        let symbols = word.as_array().unwrap().iter();
        let spelled: String = symbols.filter_map(Value::as_str).collect();
        !spelled.contains("000")
    };
    let number = &question["number"];
    let said = match question["kind"].as_str()? {
        "membership" if accepts(&question["word"]) => "accept",
        "membership" => "reject",
        "comparison" => match (accepts(&question["first"]), accepts(&question["second"])) {
            (true, false) => "first",
            (false, true) => "second",
            _ => "equal",
        },
        "equivalence" => {
            let rule = automata::format::json::read(&question["hypothesis"].to_string());
            let rule = rule.unwrap().dfa;
            let wrong = ["000", "1000", "0001", "11000", "100", "0010", "00100", "1"]
                .map(|word| word.split("").filter(|s| !s.is_empty()).collect::<Vec<_>>());
            let mut wrong = wrong.iter().filter(|word| {
                let read = rule.alphabet().word(word.iter().copied()).unwrap();
                rule.accepts(&read) != accepts(&json!(word))
            });
            let Some(word) = wrong.next() else {
                return Some(json!({"question": number, "answer": "correct"}));
            };
            let label = accepts(&json!(word));
            return Some(
                json!({"question": number, "answer": "counterexample", "word": word, "label": label}),
            );
        }
        _ => return None,
    };
    Some(json!({"question": number, "answer": said}))
}

/// The entries of a log in which somebody answered: question and reply.
pub(crate) fn answers_in(log: &str) -> Vec<Value> {
    let entries = log.lines().map(|line| {
        let entry: Value = serde_json::from_str(line).unwrap();
        entry
    });
    let answered = entries.filter(|entry| entry["event"] == "answered");
    answered.collect()
}

/// Whether every page of the database is sound.
pub(crate) fn assert_sound(database: &Path) {
    let connection = rusqlite::Connection::open(database).unwrap();
    connection.busy_timeout(Duration::from_secs(5)).unwrap();
    let found: String = connection
        .query_row("PRAGMA integrity_check", [], |row| row.get(0))
        .unwrap();
    assert_eq!(found, "ok");
}
