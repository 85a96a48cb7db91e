//! What there is to see of a recording.

use serde::Deserialize;

/// The most pictures of a recording, and the most cells.
const MOST: usize = 1001;
/// The most rows and the most columns that cells may lie in.
const WIDEST: u16 = 200;
/// The longest path of a file, in bytes.
const LONGEST_PATH: usize = 255;

const PICTURES: &[&str] = &["png", "jpg", "jpeg", "webp"];
const ANIMATIONS: &[&str] = &["gif", "png", "apng", "webp"];
const VIDEOS: &[&str] = &["mp4", "webm"];

/// What there is to see of a recording. Paths are relative to the upload.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize)]
#[serde(
    tag = "kind",
    rename_all = "lowercase",
    deny_unknown_fields,
    expecting = "an object with its `kind`: frames, animation or video"
)]
pub enum Media {
    /// Pictures that are shown one after the other: PNG, JPEG or WebP.
    Frames {
        /// Where they are, in order; at least one.
        paths: Vec<String>,
    },
    /// One picture that moves: GIF, APNG or WebP.
    Animation {
        /// Where it is.
        path: String,
    },
    /// A film: MP4 or `WebM`.
    Video {
        /// Where it is.
        path: String,
    },
    /// Cells of a grid to draw, each as row and column from 0.
    Cells {
        /// One after the other, the first before the first step; at least one.
        cells: Vec<[u16; 2]>,
    },
}

/// Why media cannot be shown: where in it, and what to do.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("`{field}`: {message}")]
pub struct MediaError {
    /// The path of the field: `media.paths[2]`.
    pub field: String,
    /// What is wrong, and what is expected.
    pub message: String,
}

impl Media {
    /// Whether all of it can be shown.
    ///
    /// # Errors
    ///
    /// If a file is of a type that cannot be shown as this kind, its path leads
    /// out of the upload, or there is nothing or too much to see.
    pub fn check(&self) -> Result<(), MediaError> {
        let amount = |field: &str, amount: usize| {
            (1..=MOST).contains(&amount).then_some(()).ok_or_else(|| {
                let message = format!("it has {amount} entries: give 1 to {MOST}");
                wrong(field, message)
            })
        };
        match self {
            Self::Frames { paths } => {
                amount("media.paths", paths.len())?;
                let mut numbered = paths.iter().enumerate();
                numbered.try_for_each(|(place, path)| {
                    check_path(&format!("media.paths[{place}]"), path, "picture", PICTURES)
                })
            }
            Self::Animation { path } => check_path("media.path", path, "animation", ANIMATIONS),
            Self::Video { path } => check_path("media.path", path, "video", VIDEOS),
            Self::Cells { cells } => {
                amount("media.cells", cells.len())?;
                let sides = [0, 1].map(|side| extent(cells, side));
                if sides.iter().all(|(_, length)| *length <= WIDEST.into()) {
                    return Ok(());
                }
                let [(_, rows), (_, columns)] = sides;
                let message = format!(
                    "the cells lie in {rows} rows and {columns} columns: at most {WIDEST} of each can be drawn"
                );
                Err(wrong("media.cells", message))
            }
        }
    }

    /// The files that it needs, each with the path of the field that names it.
    pub fn named(&self) -> impl Iterator<Item = (String, &str)> {
        let listed = matches!(self, Self::Frames { .. });
        self.files().enumerate().map(move |(place, path)| {
            let field = if listed {
                format!("media.paths[{place}]")
            } else {
                "media.path".to_owned()
            };
            (field, path)
        })
    }

    /// The files that it needs.
    pub fn files(&self) -> impl Iterator<Item = &str> {
        let paths = match self {
            Self::Frames { paths } => paths.as_slice(),
            Self::Animation { path } | Self::Video { path } => std::slice::from_ref(path),
            Self::Cells { .. } => &[],
        };
        paths.iter().map(String::as_str)
    }
}

/// The least of the cells' rows (side 0) or columns (side 1), and how many there are
/// from it to the greatest.
pub fn extent(cells: &[[u16; 2]], side: usize) -> (u16, u32) {
    let places = || cells.iter().map(|cell| cell[side]);
    let (least, most) = (places().min().unwrap_or(0), places().max().unwrap_or(0));
    (least, u32::from(most - least) + 1)
}

fn wrong(field: &str, message: String) -> MediaError {
    MediaError {
        field: field.to_owned(),
        message,
    }
}

fn check_path(field: &str, path: &str, what: &str, types: &[&str]) -> Result<(), MediaError> {
    let plain = path
        .chars()
        .all(|c| !c.is_control() && !matches!(c, '\\' | ':'));
    let inside = path
        .split('/')
        .all(|part| !part.is_empty() && part != "." && part != "..");
    if !plain || !inside || path.len() > LONGEST_PATH {
        let message = format!(
            "{path:?} is no path within the upload: give one like `run1/frame.png`, with at most {LONGEST_PATH} characters and without `..`, `:` or a `/` at its start"
        );
        return Err(wrong(field, message));
    }
    let name = path.rsplit('/').next().unwrap_or(path);
    let ending = name.rsplit_once('.').map(|(_, ending)| ending);
    let known = |ending: &str| types.contains(&ending.to_ascii_lowercase().as_str());
    if ending.is_some_and(known) {
        return Ok(());
    }
    let message = format!(
        "`{path}` is no {what} that a browser shows: give a file that ends in .{}",
        types.join(", .")
    );
    Err(wrong(field, message))
}
