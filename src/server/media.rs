//! Pictures and films of a session's recordings, whole or a range of them.

use std::ops::Range;
use std::pin::Pin;
use std::sync::Arc;
use std::task::{Context, Poll};

use axum::body::{Body, Bytes, HttpBody};
use axum::extract::{Path, State};
use axum::http::header::{
    ACCEPT_RANGES, CACHE_CONTROL, CONTENT_LENGTH, CONTENT_RANGE, CONTENT_SECURITY_POLICY,
    CONTENT_TYPE, IF_RANGE, RANGE,
};
use axum::http::{HeaderMap, HeaderValue, StatusCode};
use axum::response::{IntoResponse, Response};
use http_body::{Frame, SizeHint};
use tokio::sync::mpsc::{Receiver, Sender, channel};

use super::AppState;
use super::api::session_id;
use super::error::{PageError, WebError};
use super::upload::RECORDINGS;
use crate::store::{CHUNK, SessionId, Store, StoreError, StoredFile};

/// What was uploaded never changes.
const KEEP: &str = "private, max-age=31536000, immutable";
/// Whoever opens the address of a picture sees that and nothing else, whatever its
/// bytes pretend to be: nothing in it runs, and it loads nothing.
const POLICY: &str = "default-src 'none'; frame-ancestors 'none'; sandbox";
/// Chunks that wait for the network.
const WAITING: usize = 2;

/// `GET /sessions/{id}/media/{*path}`: a file of this session's upload, and of no
/// other.
pub(crate) async fn show(
    State(app): State<AppState>,
    Path((id, path)): Path<(String, String)>,
    headers: HeaderMap,
) -> Result<Response, PageError> {
    Ok(serve(&app, session_id(&id)?, path, &headers).await?)
}

/// A file of this session's upload, or the range of it that the headers ask for.
///
/// # Errors
///
/// If there is no such file.
pub(crate) async fn serve(
    app: &AppState,
    id: SessionId,
    path: String,
    headers: &HeaderMap,
) -> Result<Response, WebError> {
    let file = match path.as_str() {
        RECORDINGS => None,
        _ => app.teaching.file(id, path).await?,
    };
    let file = file.ok_or(WebError::NoPage)?;
    let asked = match headers.get(RANGE) {
        // Nothing here has a name for `If-Range` to compare.
        Some(range) if !headers.contains_key(IF_RANGE) => {
            let range = range.to_str().unwrap_or_default();
            read_range(range, file.size)
        }
        _ => Asked::All,
    };
    let (status, part, told) = match asked {
        Asked::All => (StatusCode::OK, 0..file.size, None),
        Asked::Part(part) => {
            let told = format!("bytes {}-{}/{}", part.start, part.end - 1, file.size);
            (StatusCode::PARTIAL_CONTENT, part, Some(told))
        }
        Asked::Nothing => {
            let told = format!("bytes */{}", file.size);
            return Ok((StatusCode::RANGE_NOT_SATISFIABLE, [(CONTENT_RANGE, told)]).into_response());
        }
    };
    let mut answer = (
        status,
        [
            (CONTENT_TYPE, file.kind.clone()),
            (CONTENT_LENGTH, (part.end - part.start).to_string()),
        ],
        [
            (ACCEPT_RANGES, "bytes"),
            (CACHE_CONTROL, KEEP),
            (CONTENT_SECURITY_POLICY, POLICY),
        ],
        Body::new(Chunks::of(app.teaching.store(), file, part)),
    )
        .into_response();
    if let Some(told) = told.and_then(|told| HeaderValue::from_str(&told).ok()) {
        answer.headers_mut().insert(CONTENT_RANGE, told);
    }
    Ok(answer)
}

/// What a `Range` header asks for.
#[derive(Debug, PartialEq, Eq)]
enum Asked {
    /// The header asks for something that need not be heeded.
    All,
    Part(Range<u64>),
    /// There is nothing in the file there.
    Nothing,
}

/// Reads a header of a single range.
fn read_range(header: &str, size: u64) -> Asked {
    let Some((from, to)) = header
        .strip_prefix("bytes=")
        .filter(|ranges| !ranges.contains(','))
        .and_then(|range| range.split_once('-'))
    else {
        return Asked::All;
    };
    let number = |text: &str| -> Option<Option<u64>> {
        let text = text.trim();
        if text.is_empty() {
            return Some(None);
        }
        text.bytes().all(|b| b.is_ascii_digit()).then_some(())?;
        // What is too large for a number is beyond any file.
        Some(Some(text.parse().unwrap_or(u64::MAX)))
    };
    let part = match (number(from), number(to)) {
        (Some(Some(from)), Some(None)) => from..size,
        (Some(Some(from)), Some(Some(to))) if from <= to => from..to.saturating_add(1).min(size),
        (Some(None), Some(Some(last))) => size.saturating_sub(last)..size,
        _ => return Asked::All,
    };
    if part.start < part.end {
        Asked::Part(part)
    } else {
        Asked::Nothing
    }
}

/// A part of a file, read chunk by chunk as the network takes it.
struct Chunks {
    chunks: Receiver<Result<Bytes, StoreError>>,
    left: u64,
}

impl Chunks {
    fn of(store: Arc<dyn Store>, file: StoredFile, part: Range<u64>) -> Self {
        let (sender, chunks) = channel(WAITING);
        let left = part.end - part.start;
        tokio::spawn(send(store, file, part, sender));
        Self { chunks, left }
    }
}

/// Whoever reads slowly holds a chunk or two, and no thread.
async fn send(
    store: Arc<dyn Store>,
    file: StoredFile,
    mut part: Range<u64>,
    to: Sender<Result<Bytes, StoreError>>,
) {
    let chunk = CHUNK as u64;
    let file = Arc::new(file);
    while part.start < part.end {
        let place = part.start / chunk;
        let (store, file) = (Arc::clone(&store), Arc::clone(&file));
        let reading = tokio::task::spawn_blocking(move || store.chunk(&file, place));
        let Ok(read) = reading.await else {
            return; // The log has the panic, and the client too few bytes.
        };
        let read = read.map(|bytes| {
            let (from, end) = (part.start - place * chunk, part.end - place * chunk);
            let length = bytes.len();
            let within = |at: u64| usize::try_from(at).map_or(length, |at| at.min(length));
            Bytes::from(bytes).slice(within(from)..within(end))
        });
        if let Err(error) = &read {
            tracing::error!(%error, "a file cannot be read");
        }
        let sent = read.as_ref().map_or(0, |bytes| bytes.len() as u64);
        // Nobody listens any more, or there is nothing more to hear.
        if to.send(read).await.is_err() || sent == 0 {
            return;
        }
        part.start += sent;
    }
}

impl HttpBody for Chunks {
    type Data = Bytes;
    type Error = StoreError;

    fn poll_frame(
        mut self: Pin<&mut Self>,
        context: &mut Context<'_>,
    ) -> Poll<Option<Result<Frame<Bytes>, StoreError>>> {
        self.chunks.poll_recv(context).map(|next| {
            next.map(|read| {
                read.map(|bytes| {
                    self.left = self.left.saturating_sub(bytes.len() as u64);
                    Frame::data(bytes)
                })
            })
        })
    }

    fn size_hint(&self) -> SizeHint {
        SizeHint::with_exact(self.left)
    }
}

#[cfg(test)]
mod tests {
    use super::{Asked, read_range};

    #[test]
    fn ranges_are_read_as_the_standard_has_them() {
        for (header, asked) in [
            ("bytes=0-9", Asked::Part(0..10)),
            ("bytes=90-", Asked::Part(90..100)),
            ("bytes=-10", Asked::Part(90..100)),
            ("bytes=-1000", Asked::Part(0..100)),
            ("bytes=90-1000", Asked::Part(90..100)),
            ("bytes=99-99999999999999999999999", Asked::Part(99..100)),
            ("bytes=100-", Asked::Nothing),
            ("bytes=99999999999999999999999-", Asked::Nothing),
            ("bytes=-0", Asked::Nothing),
            ("bytes=9-0", Asked::All),
            ("bytes=0-1,5-6", Asked::All),
            ("bytes=-", Asked::All),
            ("bytes=a-b", Asked::All),
            ("bytes=+1-2", Asked::All),
            ("lines=0-9", Asked::All),
            ("", Asked::All),
        ] {
            assert_eq!(read_range(header, 100), asked, "{header}");
        }
        assert_eq!(read_range("bytes=0-", 0), Asked::Nothing);
    }
}
