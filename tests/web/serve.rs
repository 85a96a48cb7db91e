//! The `serve` command: it starts, refuses, stops, and loses nothing when it is
//! killed.

use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::path::Path;
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};

use serde_json::{Value, json};

struct Server {
    child: Child,
    address: String,
}

fn command(database: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_memrep"));
    command
        .arg("serve")
        .args(arguments)
        .arg("--database")
        .arg(database)
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped());
    command
}

impl Server {
    fn start(database: &Path) -> Self {
        Self::start_with(database, &[])
    }

    fn start_with(database: &Path, more: &[&str]) -> Self {
        let arguments = [&["--addr", "127.0.0.1:0"], more].concat();
        let mut child = command(database, &arguments).spawn().unwrap();
        let mut line = String::new();
        BufReader::new(child.stdout.as_mut().unwrap())
            .read_line(&mut line)
            .unwrap();
        let address = line
            .trim()
            .strip_prefix("memrep is at http://")
            .and_then(|rest| rest.strip_suffix('/'))
            .unwrap_or_else(|| panic!("no address: {line}"))
            .to_owned();
        Self { child, address }
    }

    /// What comes back to this request, headers and all.
    fn exchange(&self, head: &str, headers: &str, body: &str) -> String {
        let mut stream = TcpStream::connect(&self.address).unwrap();
        let length = body.len();
        write!(
            stream,
            "{head} HTTP/1.1\r\nHost: {}\r\nConnection: close\r\nContent-Length: {length}\r\n{headers}\r\n{body}",
            self.address
        )
        .unwrap();
        let mut text = String::new();
        stream.read_to_string(&mut text).unwrap();
        text
    }

    fn ask(&self, method: &str, path: &str, body: &Value) -> (u16, String) {
        let mut stream = TcpStream::connect(&self.address).unwrap();
        let body = if body.is_null() {
            String::new()
        } else {
            body.to_string()
        };
        write!(
            stream,
            "{method} {path} HTTP/1.1\r\nHost: {}\r\nConnection: close\r\nContent-Type: application/json\r\nContent-Length: {}\r\n\r\n{body}",
            self.address,
            body.len()
        )
        .unwrap();
        let mut text = String::new();
        stream.read_to_string(&mut text).unwrap();
        let status = text.split(' ').nth(1).unwrap().parse().unwrap();
        let body = text.split_once("\r\n\r\n").unwrap().1;
        (status, body.to_owned())
    }

    fn json(&self, method: &str, path: &str, body: &Value) -> Value {
        let (status, text) = self.ask(method, path, body);
        assert!(status < 300, "{status}: {text}");
        serde_json::from_str(&text).unwrap()
    }

    fn signal(&self, name: &str) {
        let done = Command::new("kill")
            .args([&format!("-{name}"), &self.child.id().to_string()])
            .status()
            .unwrap();
        assert!(done.success());
    }
}

impl Drop for Server {
    fn drop(&mut self) {
        // Already gone where a test has waited for it.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

fn refused(mut command: Command) -> String {
    let Output { status, stderr, .. } = command.output().unwrap();
    assert_eq!(status.code(), Some(2));
    String::from_utf8(stderr).unwrap()
}

#[test]
fn killed_at_any_moment_it_goes_on_where_it_was() {
    let folder = tempfile::tempdir().unwrap();
    let database = folder.path().join("a.db");
    let mut server = Server::start(&database);
    let created = server.json("POST", "/api/v1/sessions", &json!({"task": "tomita:6"}));
    let session = format!("/api/v1/sessions/{}", created["id"].as_str().unwrap());
    let mut question = server.json("GET", &format!("{session}/question"), &Value::Null);
    let mut answered = 0;
    for round in 0..6 {
        for _ in 0..=round {
            let said = match question["kind"].as_str().unwrap() {
                "membership" => "reject",
                "comparison" => "equal",
                _ => break,
            };
            let answer = json!({"question": question["number"], "answer": said});
            question = server.json("POST", &format!("{session}/answers"), &answer);
            answered += 1;
        }
        server.signal("KILL");
        server.child.wait().unwrap();
        server = Server::start(&database);
        let again = server.json("GET", &format!("{session}/question"), &Value::Null);
        assert_eq!(again, question);
    }
    let (_, log) = server.ask("GET", &format!("{session}/log"), &Value::Null);
    assert_eq!(log.matches("\"event\":\"answered\"").count(), answered);
}

#[test]
fn it_stops_when_told_to() {
    let folder = tempfile::tempdir().unwrap();
    for signal in ["TERM", "INT"] {
        let mut server = Server::start(&folder.path().join("a.db"));
        // A connection that stays open must not hold it up.
        let idle = TcpStream::connect(&server.address).unwrap();
        server.ask("GET", "/", &Value::Null);
        server.signal(signal);
        let begun = Instant::now();
        let status = loop {
            if let Some(status) = server.child.try_wait().unwrap() {
                break status;
            }
            assert!(
                begun.elapsed() < Duration::from_secs(20),
                "{signal}: still there"
            );
            std::thread::sleep(Duration::from_millis(20));
        };
        assert!(status.success(), "{signal}: {status}");
        drop(idle);
    }
}

#[test]
fn what_it_cannot_do_it_says_with_the_way_out() {
    let folder = tempfile::tempdir().unwrap();
    let server = Server::start(&folder.path().join("a.db"));
    let other = folder.path().join("b.db");
    let taken = refused(command(&other, &["--addr", &server.address]));
    assert!(
        taken.contains("is in use") && taken.contains("--addr"),
        "{taken}"
    );
    assert!(!other.exists(), "a server that cannot start leaves no file");
    let public = refused(command(&other, &["--addr", "0.0.0.0:0"]));
    assert!(
        public.contains("no owner's password") && public.contains("memrep password"),
        "{public}"
    );
    for proxied in [
        ["--origin", "https://teach.example.org"].as_slice(),
        &["--behind-proxy"],
    ] {
        let arguments = [&["--addr", "127.0.0.1:0"], proxied].concat();
        let unlocked = refused(command(&other, &arguments));
        assert!(unlocked.contains("no owner's password"), "{unlocked}");
    }
    assert!(!other.exists(), "nor does one that nobody may reach");
    let text = folder.path().join("notes.txt");
    std::fs::write(
        &text,
        "not a database, and long enough to be seen as none ".repeat(20),
    )
    .unwrap();
    let foreign = refused(command(&text, &["--addr", "127.0.0.1:0"]));
    assert!(
        foreign.contains("not an SQLite file") && foreign.contains("--database"),
        "{foreign}"
    );
    let inside = refused(command(folder.path(), &["--addr", "127.0.0.1:0"]));
    assert!(inside.contains("it is a folder"), "{inside}");
    let usage = refused(command(&other, &["--addr", "somewhere"]));
    assert!(usage.contains("--addr"), "{usage}");
}

/// `memrep password` with this on its standard input.
fn password(database: &Path, arguments: &[&str], typed: &str) -> Output {
    let mut child = Command::new(env!("CARGO_BIN_EXE_memrep"))
        .arg("password")
        .args(arguments)
        .arg("--database")
        .arg(database)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    child
        .stdin
        .take()
        .unwrap()
        .write_all(typed.as_bytes())
        .unwrap();
    child.wait_with_output().unwrap()
}

#[test]
fn a_password_is_piped_in_and_opens_the_way_for_other_machines() {
    let folder = tempfile::tempdir().unwrap();
    let database = folder.path().join("a.db");
    for (typed, why) in [("", "fewer than 8"), ("1234567\n", "fewer than 8")] {
        let refused = password(&database, &[], typed);
        assert_eq!(refused.status.code(), Some(2));
        let told = String::from_utf8(refused.stderr).unwrap();
        assert!(told.contains(why), "{told}");
    }
    let none = password(&database, &["--remove"], "");
    assert_eq!(none.status.code(), Some(2));
    let told = String::from_utf8(none.stderr).unwrap();
    assert!(told.contains("no such database"), "{told}");
    assert!(!database.exists(), "nothing is made to remove from");
    let set = password(&database, &[], "correct horse battery\n");
    assert!(
        set.status.success(),
        "{}",
        String::from_utf8_lossy(&set.stderr)
    );
    #[cfg(target_os = "linux")]
    {
        // It is set, also where that cannot be said.
        let full = std::fs::File::options().write(true).open("/dev/full");
        let mut unheard = Command::new(env!("CARGO_BIN_EXE_memrep"))
            .args(["password", "--database"])
            .arg(&database)
            .stdin(Stdio::piped())
            .stdout(full.unwrap())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let mut input = unheard.stdin.take().unwrap();
        input.write_all(b"correct horse battery\n").unwrap();
        drop(input);
        let unheard = unheard.wait_with_output().unwrap();
        let told = String::from_utf8(unheard.stderr).unwrap();
        assert!(
            unheard.status.success() && told.contains("it is done, but"),
            "{told}"
        );
    }
    let origin = ["--origin", "https://teach.example.org"];
    let server = Server::start_with(&database, &origin);
    let (status, _) = server.ask("GET", "/api/v1/sessions", &Value::Null);
    assert_eq!(status, 401);
    // Removed while the server is public, it is closed rather than open.
    assert!(password(&database, &["--remove"], "").status.success());
    std::thread::sleep(Duration::from_millis(1100));
    let (status, body) = server.ask("GET", "/api/v1/sessions", &Value::Null);
    assert_eq!(status, 403, "{body}");
    assert!(body.contains("no_password"), "{body}");
    let again = password(&database, &["--remove"], "");
    assert!(again.status.success());
    let told = String::from_utf8(again.stdout).unwrap();
    assert!(told.contains("nothing was changed"), "{told}");
}

#[test]
fn no_password_and_no_key_is_ever_in_the_log() {
    const PASSWORD: &str = "correct-horse-battery";
    const WRONG: &str = "wrong-horse-battery";
    let folder = tempfile::tempdir().unwrap();
    let database = folder.path().join("a.db");
    assert!(password(&database, &[], PASSWORD).status.success());
    let mut server = Server::start_with(
        &database,
        &["--log", "trace,tower_http::csrf::service=trace,hyper=trace"],
    );
    let form = "Content-Type: application/x-www-form-urlencoded\r\n";
    server.exchange("POST /sign-in", form, &format!("password={WRONG}"));
    let signed = server.exchange("POST /sign-in", form, &format!("password={PASSWORD}"));
    let cookie = signed
        .split("set-cookie: memrep=")
        .nth(1)
        .expect("a cookie");
    let key = cookie.split(';').next().unwrap().to_owned();
    let json = format!("Content-Type: application/json\r\nAuthorization: Bearer {key}\r\n");
    let last = |reply: &str| -> Value {
        serde_json::from_str(reply.split_once("\r\n\r\n").unwrap().1)
            .unwrap_or_else(|error| panic!("{error}: {reply}"))
    };
    let made = server.exchange("POST /api/v1/sessions", &json, "{\"task\":\"tomita:4\"}");
    let id = last(&made)["id"].as_str().unwrap().to_owned();
    let people = format!("POST /api/v1/sessions/{id}/people");
    let invited = last(&server.exchange(&people, &json, "{\"name\":\"Ada\"}"));
    let link = invited["link"].as_str().unwrap();
    let entered = server.exchange(&format!("POST {link}"), form, "");
    let theirs = entered
        .split("set-cookie: memrep-")
        .nth(1)
        .expect("a cookie");
    let theirs = theirs.split(';').next().unwrap().split('=').nth(1).unwrap();
    server.exchange(&format!("GET /api/v1{link}"), "", "");
    server.exchange("GET /answer/zz", "", "");
    server.signal("TERM");
    server.child.wait().unwrap();
    let mut log = String::new();
    let mut told = server.child.stderr.take().unwrap();
    told.read_to_string(&mut log).unwrap();
    assert!(log.contains("the owner signed in"), "{log}");
    assert!(log.contains("a sign-in failed"), "{log}");
    let invitation = link.rsplit('/').next().unwrap();
    for secret in [PASSWORD, WRONG, &key, theirs, invitation] {
        assert!(secret.len() > 15 && !log.contains(secret), "{log}");
    }
}
