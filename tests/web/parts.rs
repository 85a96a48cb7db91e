//! Forms with files, as browsers and scripts send them.

use std::path::Path;

use serde_json::{Value, json};

use crate::site::{Reply, Site};

pub(crate) const BOUNDARY: &str = "----a-boundary-that-nobody-writes";
pub(crate) const PNG: &[u8] = b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR and more of it";
pub(crate) const GIF: &[u8] = b"GIF89a and more of it";

/// A form with files.
#[derive(Clone, Default)]
pub(crate) struct Parts(Vec<u8>);

impl Parts {
    pub(crate) fn part(mut self, name: &str, file: Option<&str>, content: &[u8]) -> Self {
        let file = file.map_or(String::new(), |file| format!("; filename=\"{file}\""));
        let head = format!(
            "--{BOUNDARY}\r\nContent-Disposition: form-data; name=\"{name}\"{file}\r\n\r\n"
        );
        self.0.extend_from_slice(head.as_bytes());
        self.0.extend_from_slice(content);
        self.0.extend_from_slice(b"\r\n");
        self
    }

    pub(crate) fn text(self, name: &str, text: &str) -> Self {
        self.part(name, None, text.as_bytes())
    }

    pub(crate) fn task(self, task: &Value) -> Self {
        self.text("task", &task.to_string())
    }

    pub(crate) fn recordings(self, lines: &str) -> Self {
        self.part("recordings", Some("runs.jsonl"), lines.as_bytes())
    }

    pub(crate) fn media(self, path: &str, content: &[u8]) -> Self {
        self.part("media", Some(path), content)
    }

    pub(crate) fn end(mut self) -> Vec<u8> {
        self.0
            .extend_from_slice(format!("--{BOUNDARY}--\r\n").as_bytes());
        self.0
    }

    pub(crate) async fn send(self, site: &Site, path: &str) -> Reply {
        post(site, path, self.end()).await
    }
}

pub(crate) async fn post(site: &Site, path: &str, body: Vec<u8>) -> Reply {
    let kind = format!("multipart/form-data; boundary={BOUNDARY}");
    site.post_text(path, &kind, body).await
}

pub(crate) const SESSIONS: &str = "/api/v1/sessions";

pub(crate) fn line(id: &str, word: &[&str]) -> String {
    json!({"id": id, "word": word}).to_string() + "\n"
}

pub(crate) fn binary() -> Value {
    json!({"task": {"symbols": ["0", "1"], "world": {"kind": "pool"}}})
}

/// Something that begins as a film.
pub(crate) fn film() -> Vec<u8> {
    let mut film = b"\0\0\0\x20ftypisom\0\0\x02\0isomiso2avc1mp41".to_vec();
    film.extend((0..600_000_u32).map(|i| (i % 253) as u8));
    film
}

/// All words of up to five symbols.
pub(crate) fn all_words() -> String {
    let words = (0..6).flat_map(|length| (0..1_usize << length).map(move |bits| (length, bits)));
    let spell = |(length, bits): (usize, usize)| -> Vec<&str> {
        let bit = |place| if bits >> place & 1 == 1 { "1" } else { "0" };
        (0..length).map(bit).collect()
    };
    let lines = words.map(spell).enumerate();
    lines
        .map(|(number, word)| line(&format!("run-{number}"), &word))
        .collect()
}

/// The number of rows in all tables.
pub(crate) fn rows(path: &Path) -> i64 {
    let connection = rusqlite::Connection::open(path).unwrap();
    let count = |table: &str| -> i64 {
        let sql = format!("SELECT count(*) FROM {table}");
        connection.query_row(&sql, [], |row| row.get(0)).unwrap()
    };
    ["sessions", "entries", "uploads", "files", "chunks"]
        .map(count)
        .iter()
        .sum()
}
