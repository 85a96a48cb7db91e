//! Takes the parts of a form as they come: texts are kept, files go on to the
//! [spool](super::spool).

use std::pin::Pin;
use std::sync::{Arc, Mutex, PoisonError};
use std::task::{Context, Poll};

use automata::Alphabet;
use axum::body::{Body, Bytes, HttpBody};
use axum::extract::multipart::{Field, MultipartError};
use axum::extract::{DefaultBodyLimit, FromRequest, Multipart, Request};
use http_body::Frame;
use tokio::sync::mpsc::{Sender, channel};
use tokio::task::JoinHandle;

use super::spool::{self, Piece, Spool};
use super::{FRAME_LIMIT, MEDIA, RECORDINGS, UPLOAD_LIMIT};
use crate::server::error::WebError;
use crate::server::forms::Form;
use crate::session::Malformed;

/// Pieces that wait for the spool; each is what the network gave at once.
const WAITING: usize = 16;
/// What is read of a refused upload, so that the browser that still sends it hears
/// why: most do not listen before they have sent all.
const DRAIN_LIMIT: u64 = 256 << 20;

/// What a form may have beside files.
pub(super) struct Texts {
    /// Their names.
    pub(super) names: &'static [&'static str],
    /// Their bytes in all.
    pub(super) most: usize,
}

/// What came, and with it the files, unless there were none.
pub(super) type Taken = (Form, Result<Option<Spool>, WebError>);

/// Takes a whole form. `alphabet_of` is asked with the texts before the recordings,
/// which are read over what it gives.
///
/// The texts are given back even where something is wrong: they are shown again.
pub(super) async fn take(
    request: Request,
    texts: &Texts,
    alphabet_of: impl FnMut(&Form) -> Result<Alphabet, WebError>,
) -> Taken {
    let (head, body) = request.into_parts();
    let flow = Arc::new(Mutex::new(Flow {
        body,
        taken: 0,
        is_over: false,
    }));
    let tap = Body::new(Tap(Arc::clone(&flow)));
    let mut request = Request::from_parts(head, tap);
    // The tap has its own.
    DefaultBodyLimit::disable().apply(&mut request);
    let mut taking = Taking {
        form: Vec::new(),
        length: 0,
        files: 0,
        worker: None,
        alphabet_of,
    };
    let taken = taking.all(request, texts).await;
    let result = match taken {
        Ok(()) => taking.end().await,
        Err(Stopped::Here(error)) => Err(error),
        Err(Stopped::InSpool) => match taking.end().await {
            Ok(_) => Err(WebError::internal("the spool ended before the upload")),
            Err(error) => Err(error),
        },
        Err(Stopped::InBody(error)) => Err(if Flow::of(&flow).is_over {
            WebError::UploadTooLarge
        } else {
            let text = error.body_text();
            let told = "the upload broke off, or is no `multipart/form-data`";
            WebError::unread(&error, format!("{told}: {text}"))
        }),
    };
    if result.is_err() {
        taking.worker = None;
        drain(&flow).await;
    }
    (Form::new(taking.form), result)
}

/// Where it stopped.
enum Stopped {
    Here(WebError),
    /// The spool has ended, and says why.
    InSpool,
    InBody(MultipartError),
}

impl From<MultipartError> for Stopped {
    fn from(error: MultipartError) -> Self {
        Self::InBody(error)
    }
}

impl From<WebError> for Stopped {
    fn from(error: WebError) -> Self {
        Self::Here(error)
    }
}

impl From<Malformed> for Stopped {
    fn from(fault: Malformed) -> Self {
        Self::Here(fault.into())
    }
}

struct Taking<F> {
    form: Vec<(String, String)>,
    /// Bytes of texts so far, and of files.
    length: usize,
    files: u64,
    worker: Option<Worker>,
    alphabet_of: F,
}

/// The spool, on a thread where it may block.
struct Worker {
    pieces: Sender<Piece>,
    done: JoinHandle<Result<Spool, WebError>>,
}

impl<F: FnMut(&Form) -> Result<Alphabet, WebError>> Taking<F> {
    async fn all(&mut self, request: Request, texts: &Texts) -> Result<(), Stopped> {
        let parts = Multipart::from_request(request, &()).await;
        let mut parts = parts.map_err(|rejection| WebError::Unreadable(rejection.body_text()))?;
        while let Some(part) = parts.next_field().await? {
            let name = part.name().unwrap_or_default().to_owned();
            if name == RECORDINGS || name == MEDIA {
                self.file(part, &name).await?;
            } else if texts.names.contains(&name.as_str()) {
                self.text(part, name, texts.most).await?;
            } else {
                let known = texts.names.join("`, `");
                let message = format!(
                    "there is no part `{name}`: send `{known}`, `{RECORDINGS}` and `{MEDIA}`"
                );
                return Err(Malformed::new(name, message).into());
            }
        }
        Ok(())
    }

    async fn text(
        &mut self,
        mut part: Field<'_>,
        name: String,
        most: usize,
    ) -> Result<(), Stopped> {
        if self.form.iter().any(|(earlier, _)| *earlier == name) {
            let message = format!("there are several parts `{name}`: send one");
            return Err(Malformed::new(name, message).into());
        }
        let mut bytes = Vec::new();
        while let Some(piece) = part.chunk().await? {
            self.length += piece.len();
            if self.length > most {
                let message = format!("the texts have more than {most} bytes: send less");
                return Err(Malformed::new(name, message).into());
            }
            bytes.extend_from_slice(&piece);
        }
        let text = String::from_utf8(bytes)
            .map_err(|_| Malformed::new(name.as_str(), "this is no text in UTF-8"))?;
        self.form.push((name, text));
        Ok(())
    }

    async fn file(&mut self, mut part: Field<'_>, name: &str) -> Result<(), Stopped> {
        let path = part.file_name().unwrap_or_default().to_owned();
        let mut piece = part.chunk().await?;
        // What a browser sends where no file was chosen.
        if path.is_empty() && piece.as_ref().is_none_or(Bytes::is_empty) {
            return Ok(());
        }
        if name == RECORDINGS {
            let form = Form::new(self.form.clone());
            let alphabet = (self.alphabet_of)(&form)?;
            self.send(Piece::Recordings(alphabet)).await?;
        } else if path.is_empty() {
            let message = "a file came without a name: send its path, as the recordings name it, as its file name";
            return Err(Malformed::new(MEDIA, message).into());
        } else {
            self.send(Piece::Media(path)).await?;
        }
        while let Some(bytes) = piece {
            self.files += bytes.len() as u64;
            if self.files > UPLOAD_LIMIT {
                return Err(WebError::UploadTooLarge.into());
            }
            self.send(Piece::Bytes(bytes)).await?;
            piece = part.chunk().await?;
        }
        Ok(())
    }

    async fn send(&mut self, piece: Piece) -> Result<(), Stopped> {
        let worker = self.worker.get_or_insert_with(|| {
            let (pieces, waiting) = channel(WAITING);
            let done = tokio::task::spawn_blocking(move || spool::fill(waiting));
            Worker { pieces, done }
        });
        (worker.pieces.send(piece).await).map_err(|_| Stopped::InSpool)
    }

    /// All has come: what the spool has.
    async fn end(&mut self) -> Result<Option<Spool>, WebError> {
        let Some(worker) = self.worker.take() else {
            return Ok(None);
        };
        // Where it has ended already it says why.
        let _ = worker.pieces.send(Piece::End).await;
        drop(worker.pieces);
        worker.done.await.map_err(WebError::internal)?.map(Some)
    }
}

/// A body that is read by somebody who may stop, and whose rest is wanted.
struct Flow {
    body: Body,
    taken: u64,
    /// Whether more came than is taken.
    is_over: bool,
}

type Next = Poll<Option<Result<Frame<Bytes>, axum::Error>>>;

impl Flow {
    fn of(flow: &Mutex<Self>) -> std::sync::MutexGuard<'_, Self> {
        flow.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn poll(&mut self, context: &mut Context<'_>, most: u64) -> Next {
        let next = Pin::new(&mut self.body).poll_frame(context);
        if let Poll::Ready(Some(Ok(frame))) = &next {
            self.taken += frame.data_ref().map_or(0, |bytes| bytes.len() as u64);
            if self.taken > most {
                self.is_over = true;
                return Poll::Ready(Some(Err(axum::Error::new("too large"))));
            }
        }
        next
    }
}

struct Tap(Arc<Mutex<Flow>>);

impl HttpBody for Tap {
    type Data = Bytes;
    type Error = axum::Error;

    fn poll_frame(self: Pin<&mut Self>, context: &mut Context<'_>) -> Next {
        Flow::of(&self.0).poll(context, UPLOAD_LIMIT + FRAME_LIMIT)
    }
}

/// Reads what is left, and forgets it.
async fn drain(flow: &Mutex<Flow>) {
    let next = |context: &mut Context<'_>| Flow::of(flow).poll(context, DRAIN_LIMIT);
    while let Some(Ok(_)) = std::future::poll_fn(next).await {}
}
