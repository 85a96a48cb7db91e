//! The files that pages load, inside the binary.

use axum::extract::Path;
use axum::http::header::{CACHE_CONTROL, CONTENT_TYPE};
use axum::response::{IntoResponse, Response};

use super::error::{PageError, WebError};

struct Asset {
    name: &'static str,
    kind: &'static str,
    bytes: &'static [u8],
}

const CSS: &str = "text/css; charset=utf-8";
const SCRIPT: &str = "text/javascript; charset=utf-8";

/// Reads a file of the folder at build time.
macro_rules! asset {
    ($name:literal, $kind:expr) => {
        Asset {
            name: $name,
            kind: $kind,
            bytes: include_bytes!(concat!("../../static/", $name)),
        }
    };
}

const ASSETS: &[Asset] = &[
    asset!("app.css", CSS),
    asset!("app.js", SCRIPT),
    asset!("builder.js", SCRIPT),
    asset!("people.js", SCRIPT),
    asset!("player.js", SCRIPT),
    asset!("fold.js", SCRIPT),
    asset!("keys.js", SCRIPT),
    asset!("paint.js", SCRIPT),
    asset!("studio.js", SCRIPT),
    asset!("live.js", SCRIPT),
    asset!("swap.js", SCRIPT),
    asset!("times.js", SCRIPT),
    asset!("tracks.js", SCRIPT),
    asset!("trace.js", SCRIPT),
    asset!("upload.js", SCRIPT),
    asset!("walk.js", SCRIPT),
    asset!("icon.svg", "image/svg+xml"),
];

const STAMP: u32 = {
    // FNV-1a, over all bytes of all files.
    let mut hash: u32 = 0x811c_9dc5;
    let mut file = 0;
    while file < ASSETS.len() {
        let bytes = ASSETS[file].bytes;
        let mut i = 0;
        while i < bytes.len() {
            hash = (hash ^ bytes[i] as u32).wrapping_mul(0x0100_0193);
            i += 1;
        }
        file += 1;
    }
    hash
};

/// Changes with any of the files, so that browsers may keep them for ever.
pub(crate) fn stamp() -> String {
    format!("{STAMP:08x}")
}

/// `GET /static/{stamp}/{name}`. The stamp is a folder, so that what a module
/// imports beside itself has the same stamp; there is no other than ours.
pub(crate) async fn get(
    Path((stamp, name)): Path<(String, String)>,
) -> Result<Response, PageError> {
    let asset = ASSETS
        .iter()
        .find(|asset| asset.name == name && stamp == self::stamp())
        .ok_or(WebError::NoPage)?;
    Ok((
        [
            (CONTENT_TYPE, asset.kind),
            (CACHE_CONTROL, "public, max-age=31536000, immutable"),
        ],
        asset.bytes,
    )
        .into_response())
}

#[cfg(test)]
mod tests {
    use super::ASSETS;

    /// A block that is left open hides all that follows it from the browser.
    #[test]
    fn every_block_of_the_style_sheet_is_closed() {
        let sheet = ASSETS.iter().find(|asset| asset.name == "app.css").unwrap();
        let mut depth = 0;
        for (number, line) in sheet.bytes.split(|byte| *byte == b'\n').enumerate() {
            for byte in line {
                depth += i32::from(*byte == b'{') - i32::from(*byte == b'}');
            }
            assert!((0..=2).contains(&depth), "line {}", number + 1);
        }
        assert_eq!(depth, 0);
    }
}
