//! Too much, too slowly, and too many at once, over real connections: each is refused
//! for itself, and the server goes on.

use std::io::{BufRead as _, BufReader, Read as _, Write as _};
use std::net::{SocketAddr, TcpStream};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::sync::Arc;
use std::time::{Duration, Instant};

use memrep::server::{AppState, Limits, run};
use memrep::store::Sqlite;
use serde_json::json;
use tokio::net::TcpListener;
use tokio::sync::oneshot::{Sender, channel};
use tokio::task::JoinHandle;

use crate::parts::{BOUNDARY, PNG, Parts, SESSIONS, binary};

const FORM: &str = "application/x-www-form-urlencoded";
const JSON: &str = "application/json";

/// Short ones, so that a test need not wait.
const SHORT: Limits = Limits {
    connections: 64,
    head: Duration::from_millis(400),
    body: Duration::from_millis(400),
    upload: Duration::from_millis(400),
    stays: Duration::from_millis(400),
};

/// A server in this process.
struct Near {
    address: SocketAddr,
    stop: Sender<()>,
    over: JoinHandle<()>,
}

impl Near {
    async fn start(limits: Limits) -> Self {
        let store = Arc::new(Sqlite::in_memory().unwrap());
        let listener = TcpListener::bind("127.0.0.1:0").await.unwrap();
        let address = listener.local_addr().unwrap();
        let (stop, stopped) = channel();
        let state = AppState::new(store).with_limits(limits);
        let over = tokio::spawn(run(listener, state, async {
            let _ = stopped.await;
        }));
        Self {
            address,
            stop,
            over,
        }
    }

    async fn stop(self) {
        self.stop.send(()).unwrap();
        self.over.await.unwrap();
    }

    /// On a thread of its own, as whoever asks elsewhere is.
    async fn with<T: Send + 'static>(
        &self,
        ask: impl FnOnce(SocketAddr) -> T + Send + 'static,
    ) -> T {
        let address = self.address;
        tokio::task::spawn_blocking(move || ask(address))
            .await
            .unwrap()
    }
}

fn connect(address: SocketAddr) -> TcpStream {
    let stream = TcpStream::connect(address).unwrap();
    let wait = Some(Duration::from_secs(60));
    stream.set_read_timeout(wait).unwrap();
    stream
}

fn head(path: &str, kind: &str, length: usize) -> String {
    format!(
        "POST {path} HTTP/1.1\r\nHost: localhost\r\nContent-Type: {kind}\r\nContent-Length: {length}\r\n\r\n"
    )
}

/// All that comes until the connection ends, or as much as has come when it breaks.
fn heard(stream: &mut TcpStream) -> String {
    let mut heard = Vec::new();
    let _ = stream.read_to_end(&mut heard);
    String::from_utf8(heard).unwrap()
}

fn status_of(heard: &str) -> u16 {
    let status = heard.split(' ').nth(1);
    status.map_or(0, |status| status.parse().unwrap())
}

/// The status of what comes back to this request.
fn posted(address: SocketAddr, path: &str, kind: &str, body: &[u8]) -> u16 {
    let mut stream = connect(address);
    let head = head(path, kind, body.len()).replace("\r\n\r\n", "\r\nConnection: close\r\n\r\n");
    stream.write_all(head.as_bytes()).unwrap();
    // Whoever is refused need not be heard to the end.
    let _ = stream.write_all(body);
    status_of(&heard(&mut stream))
}

fn healthy(address: SocketAddr) -> bool {
    let mut stream = connect(address);
    stream
        .write_all(b"GET /healthz HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n")
        .unwrap();
    heard(&mut stream).ends_with("ok\n")
}

/// One more byte than may come is refused, and not one less.
#[tokio::test(flavor = "multi_thread", worker_threads = 2)]
async fn a_body_of_exactly_the_limit_passes_and_a_byte_more_does_not() {
    let near = Near::start(Limits::default()).await;
    near.with(|address| {
        for (path, kind, limit, frame) in [
            ("/sessions", FORM, 64 << 10, ("title=", "")),
            ("/sign-in", FORM, 64 << 10, ("password=", "")),
            ("/api/v1/sessions", JSON, 2 << 20, ("{\"task\":\"", "\"}")),
            (
                "/api/v1/sign-in",
                JSON,
                64 << 10,
                ("{\"password\":\"", "\"}"),
            ),
        ] {
            let body = |length: usize| {
                let filled = "a".repeat(length - frame.0.len() - frame.1.len());
                [frame.0, &filled, frame.1].concat()
            };
            let exact = posted(address, path, kind, body(limit).as_bytes());
            assert!(
                (400..500).contains(&exact) && exact != 413,
                "{path}: {exact}"
            );
            let over = posted(address, path, kind, body(limit + 1).as_bytes());
            assert_eq!(over, 413, "{path}");
        }
    })
    .await;
    near.stop().await;
}

#[tokio::test(flavor = "multi_thread", worker_threads = 2)]
async fn a_body_that_comes_too_slowly_is_given_up() {
    let near = Near::start(SHORT).await;
    near.with(|address| {
        let multipart = format!("multipart/form-data; boundary={BOUNDARY}");
        let begun = Parts::default().task(&binary()).end();
        for (path, kind, body) in [
            ("/studio", FORM, &b"title=a"[..]),
            (
                "/api/v1/sessions/00000000000000000000000000000000/people",
                JSON,
                b"{\"name\":",
            ),
            ("/api/v1/sessions", JSON, b"{"),
            (SESSIONS, &multipart, &begun[..begun.len() - 20]),
            ("/sessions", &multipart, b"--"),
        ] {
            let from = Instant::now();
            let mut stream = connect(address);
            let head = head(path, kind, 10_000);
            stream.write_all(head.as_bytes()).unwrap();
            stream.write_all(body).unwrap();
            // It does not help to send a little now and then.
            let mut dribble = stream.try_clone().unwrap();
            let dribbling = std::thread::spawn(move || {
                for _ in 0..60 {
                    std::thread::sleep(Duration::from_millis(40));
                    if dribble.write_all(b" ").is_err() {
                        return true;
                    }
                }
                false
            });
            let heard = heard(&mut stream);
            let took = from.elapsed();
            assert_eq!(status_of(&heard), 408, "{path} {kind}: {heard}");
            assert!(heard.contains("took too long to arrive"), "{heard}");
            assert!(took < Duration::from_secs(2), "{path}: {took:?}");
            assert!(dribbling.join().unwrap(), "the connection has ended");
        }
        assert!(healthy(address));
    })
    .await;
    near.stop().await;
}

/// Half a head, a head by the byte, and none at all, at first or after a request.
#[tokio::test(flavor = "multi_thread", worker_threads = 2)]
async fn whoever_does_not_say_what_they_want_is_let_go() {
    let near = Near::start(SHORT).await;
    near.with(|address| {
        let whole = "GET /healthz HTTP/1.1\r\nHost: localhost\r\n\r\n";
        for (sent, ends) in [
            ("", ""),
            ("GET / HTTP/1.1\r\nHost: localhost\r\nX-Slow: ", ""),
            (whole, "ok\n"),
        ] {
            let from = Instant::now();
            let mut stream = connect(address);
            stream.write_all(sent.as_bytes()).unwrap();
            let mut dribble = stream.try_clone().unwrap();
            let dribbling = std::thread::spawn(move || {
                for _ in 0..40 {
                    std::thread::sleep(Duration::from_millis(40));
                    if sent.ends_with(' ') && dribble.write_all(b"a").is_err() {
                        return;
                    }
                }
            });
            let heard = heard(&mut stream);
            assert!(heard.ends_with(ends), "{sent:?}: {heard}");
            assert!(!ends.is_empty() || heard.is_empty(), "{sent:?}: {heard}");
            let took = from.elapsed();
            assert!(took < Duration::from_millis(1500), "{sent:?}: {took:?}");
            assert!(took > Duration::from_millis(300), "{sent:?}: {took:?}");
            dribbling.join().unwrap();
        }
        // A head may be long, but not that long.
        let mut stream = connect(address);
        let long = format!(
            "GET / HTTP/1.1\r\nHost: localhost\r\nX: {}\r\n\r\n",
            "a".repeat(70_000)
        );
        let _ = stream.write_all(long.as_bytes());
        assert_eq!(status_of(&heard(&mut stream)), 431);
        assert!(healthy(address));
    })
    .await;
    near.stop().await;
}

#[tokio::test(flavor = "multi_thread", worker_threads = 2)]
async fn who_finds_no_place_is_told_so_and_comes_in_once_there_is_one() {
    let limits = Limits {
        connections: 3,
        ..Limits::default()
    };
    let near = Near::start(limits).await;
    near.with(|address| {
        let ask = |stream: &mut TcpStream| {
            stream
                .write_all(b"GET /sign-in HTTP/1.1\r\nHost: localhost\r\n\r\n")
                .unwrap();
            let mut first = [0; 12];
            stream.read_exact(&mut first).unwrap();
            status_of(&String::from_utf8_lossy(&first))
        };
        let mut held: Vec<TcpStream> = (0..3).map(|_| connect(address)).collect();
        for stream in &mut held {
            assert_ne!(ask(stream), 503);
        }
        for _ in 0..3 {
            let mut stream = connect(address);
            stream
                .write_all(b"GET / HTTP/1.1\r\nHost: localhost\r\n\r\n")
                .unwrap();
            let heard = heard(&mut stream);
            assert_eq!(status_of(&heard), 503, "{heard}");
            assert!(heard.contains("\r\nRetry-After: 10\r\n"), "{heard}");
            assert!(heard.contains("Too many connections"), "{heard}");
        }
        held.pop();
        let from = Instant::now();
        while ask(&mut connect(address)) == 503 {
            assert!(
                from.elapsed() < Duration::from_secs(5),
                "the place stays taken"
            );
            std::thread::sleep(Duration::from_millis(20));
        }
    })
    .await;
    near.stop().await;
}

/// The program itself, as a process of its own.
struct Far {
    child: Child,
    address: SocketAddr,
}

impl Far {
    fn start(folder: &Path) -> Self {
        let mut child = Command::new(env!("CARGO_BIN_EXE_memrep"))
            .args(["serve", "--addr", "127.0.0.1:0", "--database", "a.db"])
            .current_dir(folder)
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        let mut line = String::new();
        let out = child.stdout.as_mut().unwrap();
        BufReader::new(out).read_line(&mut line).unwrap();
        let address = line.trim().strip_prefix("memrep is at http://").unwrap();
        let address = address.trim_end_matches('/').parse().unwrap();
        Self { child, address }
    }

    /// The most memory that it ever had, in MiB.
    fn peak(&self) -> u64 {
        let path = format!("/proc/{}/status", self.child.id());
        let status = std::fs::read_to_string(path).unwrap();
        let peak = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
        let peak = peak.unwrap().trim().trim_end_matches(" kB");
        peak.parse::<u64>().unwrap() >> 10
    }
}

impl Drop for Far {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// Lets this process have a thousand connections: many systems begin with 1,024 files.
fn allow_many_files() {
    use rustix::process::{Resource, getrlimit, setrlimit};
    let mut limit = getrlimit(Resource::Nofile);
    limit.current = limit.maximum;
    setrlimit(Resource::Nofile, limit).unwrap();
}

/// A thousand who say nothing more: after half a head, after half a body, after a whole
/// request, and in the middle of following a session.
#[test]
#[cfg(target_os = "linux")]
fn with_a_thousand_connections_open_it_answers_and_stays_below_256_mib() {
    allow_many_files();
    let folder = tempfile::tempdir().unwrap();
    let far = Far::start(folder.path());
    let body = json!({"task": "tomita:1"}).to_string();
    let mut stream = connect(far.address);
    let request = head(SESSIONS, JSON, body.len()) + &body;
    let request = request.replacen("\r\n\r\n", "\r\nConnection: close\r\n\r\n", 1);
    stream.write_all(request.as_bytes()).unwrap();
    let created = heard(&mut stream);
    let id = created.split("\"id\":\"").nth(1).unwrap();
    let id = id.split('"').next().unwrap();
    let live = format!("GET /sessions/{id}/live HTTP/1.1\r\nHost: localhost\r\n\r\n");
    let long = "a".repeat(30_000);
    let half_head = format!("GET / HTTP/1.1\r\nHost: localhost\r\nX-Long: {long}");
    let half_body = head("/studio", FORM, 64 << 10) + "title=" + &long;
    let whole = "GET / HTTP/1.1\r\nHost: localhost\r\n\r\n".to_owned();
    let kinds = [half_head, half_body, whole, live];
    let begun = Instant::now();
    let mut held: Vec<TcpStream> = (0..1000)
        .map(|number| {
            let mut stream = connect(far.address);
            stream.write_all(kinds[number % 4].as_bytes()).unwrap();
            stream
        })
        .collect();
    for stream in held.iter_mut().skip(3).step_by(4) {
        let mut first = [0; 12];
        stream.read_exact(&mut first).unwrap();
        assert_eq!(&first, b"HTTP/1.1 200");
    }
    let opened = begun.elapsed();
    let asked = Instant::now();
    assert!(healthy(far.address));
    let (answered, peak) = (asked.elapsed(), far.peak());
    println!("1,000 open after {opened:?}; health after {answered:?}; at most {peak} MiB");
    assert!(
        opened < Duration::from_secs(9),
        "some have ended already: {opened:?}"
    );
    assert!(answered < Duration::from_secs(2), "{answered:?}");
    assert!(peak < 256, "{peak} MiB");
}

/// 64 MiB of files come through while memory stays small; a byte more is refused.
#[test]
#[cfg(target_os = "linux")]
fn an_upload_of_exactly_64_mib_streams_through_and_a_byte_more_does_not() {
    let folder = tempfile::tempdir().unwrap();
    let far = Far::start(folder.path());
    let line = json!({"id": "a", "word": ["0"], "media": {"kind": "frames", "paths": ["a.png"]}});
    let line = line.to_string();
    let send = |over: usize| {
        // What is around the file, which need not be in memory here either.
        let whole = Parts::default().task(&binary()).recordings(&line);
        let whole = whole.media("a.png", PNG).end();
        let end = whole.windows(PNG.len()).position(|part| part == PNG);
        let (before, after) = whole.split_at(end.unwrap() + PNG.len());
        let rest = (64 << 20) - line.len() - PNG.len() + over;
        let kind = format!("multipart/form-data; boundary={BOUNDARY}");
        let head = head(SESSIONS, &kind, whole.len() + rest);
        let head = head.replace("\r\n\r\n", "\r\nConnection: close\r\n\r\n");
        let mut stream = connect(far.address);
        stream.write_all(head.as_bytes()).unwrap();
        stream.write_all(before).unwrap();
        std::io::copy(&mut std::io::repeat(0).take(rest as u64), &mut stream).unwrap();
        stream.write_all(after).unwrap();
        heard(&mut stream)
    };
    let over = send(1);
    assert_eq!(status_of(&over), 413, "{over}");
    assert!(over.contains("64 MiB"), "{over}");
    let exact = send(0);
    assert_eq!(status_of(&exact), 201, "{exact}");
    let peak = far.peak();
    println!("64 MiB came through with at most {peak} MiB of memory");
    assert!(peak < 128, "{peak} MiB");
}
