//! A recording as a card shows it: its pictures, its film, or its cells drawn.

use automata::Word;

use super::scene::Scene;
use crate::session::Session;
use crate::world::World;
use crate::world::pool::{Media, Recording};

/// A recording on a card. Addresses are below those of the session's files.
pub(crate) struct RecordingView {
    pub(crate) id: String,
    /// Whether more happened than was recorded.
    pub(crate) is_cut: bool,
    /// What there is to see: one of these, or none.
    pub(crate) frames: Vec<String>,
    pub(crate) animation: Option<String>,
    pub(crate) video: Option<String>,
    pub(crate) cells: Option<Scene>,
}

impl RecordingView {
    /// The recording that is shown for the word, where the session's world has any.
    pub(crate) fn shown(word: &Word, session: &Session) -> Option<Self> {
        match session.world()? {
            World::Pool(pool) => pool.recording(word).map(Self::of),
            _ => None,
        }
    }

    fn of(recording: &Recording) -> Self {
        let mut view = Self {
            id: recording.id.clone(),
            is_cut: !recording.complete,
            frames: Vec::new(),
            animation: None,
            video: None,
            cells: None,
        };
        match &recording.media {
            None => {}
            Some(Media::Frames { paths }) => {
                view.frames = paths.iter().map(|path| address(path)).collect();
            }
            Some(Media::Animation { path }) => view.animation = Some(address(path)),
            Some(Media::Video { path }) => view.video = Some(address(path)),
            Some(Media::Cells { cells }) => view.cells = Some(Scene::of_cells(cells)),
        }
        view
    }
}

/// The path as a part of an address.
fn address(path: &str) -> String {
    let mut address = String::with_capacity(path.len());
    for byte in path.bytes() {
        match byte {
            b'a'..=b'z' | b'A'..=b'Z' | b'0'..=b'9' | b'-' | b'.' | b'_' | b'~' | b'/' => {
                address.push(char::from(byte));
            }
            _ => {
                address.push('%');
                let digit = |value: u8| char::from_digit(value.into(), 16).unwrap_or('0');
                address.extend([digit(byte >> 4), digit(byte & 15)]);
            }
        }
    }
    address
}

#[cfg(test)]
mod tests {
    use super::address;

    #[test]
    fn addresses_have_no_other_meaning() {
        assert_eq!(address("run-1/a_0.png"), "run-1/a_0.png");
        assert_eq!(
            address("a b/?#%&\"ä.png"),
            "a%20b/%3f%23%25%26%22%c3%a4.png"
        );
    }
}
