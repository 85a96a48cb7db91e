//! The real server as its own process, on a database of its own.

use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};

use tempfile::TempDir;

/// A running server with its database.
pub(crate) struct House {
    folder: TempDir,
    server: Server,
    more: &'static [&'static str],
}

struct Server {
    child: Child,
    address: String,
}

impl House {
    /// On a fresh database.
    pub(crate) fn build() -> Self {
        Self::build_with(&[])
    }

    /// On a fresh database, with these arguments more.
    pub(crate) fn build_with(more: &'static [&'static str]) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let server = Server::start(&database(folder.path()), more);
        Self {
            folder,
            server,
            more,
        }
    }

    /// The address of the page at `path`, which begins with a slash.
    pub(crate) fn at(&self, path: &str) -> String {
        format!("{}{path}", self.server.address)
    }

    /// Kills the server without a warning and starts another on its database.
    pub(crate) fn strike(&mut self) {
        self.server.kill();
        self.server = Server::start(&database(self.folder.path()), self.more);
    }
}

fn database(folder: &Path) -> PathBuf {
    folder.join("memrep.db")
}

impl Server {
    fn start(database: &Path, more: &[&str]) -> Self {
        let mut child = Command::new(env!("CARGO_BIN_EXE_memrep"))
            .args(["serve", "--addr", "127.0.0.1:0", "--database"])
            .arg(database)
            .args(more)
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .spawn()
            .unwrap();
        let mut lines = BufReader::new(child.stdout.take().unwrap()).lines();
        let address = lines
            .by_ref()
            .map_while(Result::ok)
            .find_map(|line| {
                let at = line.find("http://")?;
                Some(line[at..].trim_end_matches('/').to_owned())
            })
            .expect("the server says where it is");
        // It must be able to write what else it has to say.
        std::thread::spawn(move || lines.for_each(drop));
        Self { child, address }
    }

    /// SIGKILL.
    fn kill(&mut self) {
        self.child.kill().unwrap();
        self.child.wait().unwrap();
    }
}

impl Drop for Server {
    fn drop(&mut self) {
        // Already gone where it was killed.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}
