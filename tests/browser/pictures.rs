//! The pictures of the README, made where `MEMREP_SCREENSHOTS` names a folder.

use std::path::PathBuf;

use fantoccini::Client;

use crate::page::{Page, script};

/// What a picture in a README may weigh, in bytes.
const HEAVIEST: usize = 200_000;

/// The width and height of a picture in pixels.
const SIZE: (u32, u32) = (1280, 960);

/// The pictures that are still to be taken, by the page that they show.
pub(crate) struct Album {
    folder: Option<PathBuf>,
    missing: Vec<&'static str>,
}

impl Album {
    /// Takes all, if they are wished for; the page then gets their size.
    pub(crate) async fn wished(client: &Client) -> Self {
        let Some(folder) = std::env::var_os("MEMREP_SCREENSHOTS").map(PathBuf::from) else {
            return Self {
                folder: None,
                missing: Vec::new(),
            };
        };
        std::fs::create_dir_all(&folder).unwrap();
        // A window is larger than its page by a frame that nobody knows before.
        let (width, height) = SIZE;
        client.set_window_size(width, height).await.unwrap();
        let frame = script(client, "return [innerWidth, innerHeight];").await;
        let frame: (u32, u32) = serde_json::from_value(frame).unwrap();
        client
            .set_window_size(2 * width - frame.0, 2 * height - frame.1)
            .await
            .unwrap();
        Self {
            folder: Some(folder),
            missing: vec!["question", "equivalence", "result"],
        }
    }

    /// Takes a picture of the page, if it is one of those that are missing; a rule
    /// only if it is the right one.
    pub(crate) async fn see(&mut self, client: &Client, page: &Page, right: bool) {
        let Some(folder) = &self.folder else { return };
        let long = |word: &String| word.split_whitespace().count() > 1;
        let name = match page.kind.as_str() {
            "comparison" if page.words.iter().all(long) => "question",
            "equivalence" if right => "equivalence",
            "done" => "result",
            _ => return,
        };
        let Some(place) = self.missing.iter().position(|missing| *missing == name) else {
            return;
        };
        self.missing.remove(place);
        // A focus ring is no part of a picture.
        script(client, "document.activeElement.blur(); scrollTo(0, 0)").await;
        let picture = client.screenshot().await.unwrap();
        assert!(picture.len() < HEAVIEST, "{name}: {}", picture.len());
        std::fs::write(folder.join(format!("{name}.png")), picture).unwrap();
    }

    /// All that were wished for are there.
    pub(crate) fn is_complete(&self) {
        assert!(self.missing.is_empty(), "no picture of {:?}", self.missing);
    }
}
