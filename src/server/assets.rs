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

const ASSETS: [Asset; 7] = [
    Asset {
        name: "app.css",
        kind: "text/css; charset=utf-8",
        bytes: include_bytes!("../../static/app.css"),
    },
    Asset {
        name: "app.js",
        kind: "text/javascript; charset=utf-8",
        bytes: include_bytes!("../../static/app.js"),
    },
    Asset {
        name: "frames.js",
        kind: "text/javascript; charset=utf-8",
        bytes: include_bytes!("../../static/frames.js"),
    },
    Asset {
        name: "paint.js",
        kind: "text/javascript; charset=utf-8",
        bytes: include_bytes!("../../static/paint.js"),
    },
    Asset {
        name: "studio.js",
        kind: "text/javascript; charset=utf-8",
        bytes: include_bytes!("../../static/studio.js"),
    },
    Asset {
        name: "upload.js",
        kind: "text/javascript; charset=utf-8",
        bytes: include_bytes!("../../static/upload.js"),
    },
    Asset {
        name: "icon.svg",
        kind: "image/svg+xml",
        bytes: include_bytes!("../../static/icon.svg"),
    },
];

/// Changes with any of the files, so that browsers may keep them for ever.
pub(crate) const STAMP: u32 = {
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

/// `GET /static/{name}`.
pub(crate) async fn get(Path(name): Path<String>) -> Result<Response, PageError> {
    let asset = ASSETS
        .iter()
        .find(|asset| asset.name == name)
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
