//! What has come of an upload, in a file without a name: it is gone with the
//! process, whatever happens.

use std::collections::HashSet;
use std::fs::File;
use std::io::{BufWriter, Read, Seek, SeekFrom, Write};

use automata::Alphabet;
use axum::body::Bytes;
use tokio::sync::mpsc::Receiver;

use super::check;
use super::{MEDIA, RECORDINGS};
use crate::server::error::WebError;
use crate::session::Malformed;
use crate::store::NewFile;
use crate::world::pool::{Pool, PoolError, PoolReader};

/// The media type of recordings.
const LINES: &str = "application/jsonl";
/// The bytes of a file that tell its type.
const HEAD: usize = 512;

/// What comes, in order.
pub(super) enum Piece {
    /// A file of recordings begins, over this alphabet.
    Recordings(Alphabet),
    /// A file of this name begins.
    Media(String),
    /// The next of the file that has begun.
    Bytes(Bytes),
    /// That was all.
    End,
}

/// A whole upload whose files fit each other.
pub(super) struct Spool {
    file: File,
    /// The recordings first.
    files: Vec<Spooled>,
    /// What was recorded.
    pub(super) pool: Pool,
}

/// A file in the spool.
pub(super) struct Spooled {
    pub(super) name: String,
    kind: &'static str,
    at: u64,
    length: u64,
}

/// Takes all pieces.
pub(super) fn fill(mut pieces: Receiver<Piece>) -> Result<Spool, WebError> {
    let file = tempfile::tempfile().map_err(WebError::internal)?;
    let mut filling = Filling {
        file: BufWriter::new(file),
        at: 0,
        reader: None,
        lines: None,
        media: Vec::new(),
        names: HashSet::new(),
        open: None,
    };
    loop {
        match pieces.blocking_recv() {
            Some(Piece::Recordings(alphabet)) => {
                filling.close()?;
                filling.open_recordings(alphabet)?;
            }
            Some(Piece::Media(name)) => {
                filling.close()?;
                filling.open_media(name)?;
            }
            Some(Piece::Bytes(bytes)) => filling.write(&bytes)?,
            Some(Piece::End) => {
                filling.close()?;
                return filling.finish();
            }
            // Whoever sent them has stopped, and knows why.
            None => return Err(WebError::Unreadable("the upload broke off".to_owned())),
        }
    }
}

struct Filling {
    file: BufWriter<File>,
    at: u64,
    reader: Option<PoolReader>,
    lines: Option<Spooled>,
    media: Vec<Spooled>,
    names: HashSet<String>,
    open: Option<Open>,
}

/// A file that comes.
struct Open {
    /// None for recordings.
    name: Option<String>,
    at: u64,
    head: Vec<u8>,
}

fn in_recordings(error: &PoolError) -> WebError {
    Malformed::new(RECORDINGS, error.to_string()).into()
}

impl Filling {
    fn open_recordings(&mut self, alphabet: Alphabet) -> Result<(), WebError> {
        if self.reader.is_some() {
            let message = "there are two files of recordings: send one, of all lines";
            return Err(Malformed::new(RECORDINGS, message).into());
        }
        self.reader = Some(PoolReader::new(alphabet));
        self.open(None);
        Ok(())
    }

    fn open_media(&mut self, name: String) -> Result<(), WebError> {
        if !self.names.insert(name.clone()) {
            let message = format!("`{name}` came twice: send every file once");
            return Err(Malformed::new(MEDIA, message).into());
        }
        self.open(Some(name));
        Ok(())
    }

    fn open(&mut self, name: Option<String>) {
        self.open = Some(Open {
            name,
            at: self.at,
            head: Vec::new(),
        });
    }

    fn write(&mut self, bytes: &[u8]) -> Result<(), WebError> {
        self.file.write_all(bytes).map_err(WebError::internal)?;
        self.at += bytes.len() as u64;
        match (&mut self.open, &mut self.reader) {
            (Some(Open { name: None, .. }), Some(reader)) => {
                reader.feed(bytes).map_err(|error| in_recordings(&error))
            }
            (Some(open), _) => {
                let missing = HEAD - open.head.len();
                open.head
                    .extend_from_slice(&bytes[..bytes.len().min(missing)]);
                Ok(())
            }
            (None, _) => Ok(()),
        }
    }

    fn close(&mut self) -> Result<(), WebError> {
        let Some(open) = self.open.take() else {
            return Ok(());
        };
        let spooled = |name, kind| Spooled {
            name,
            kind,
            at: open.at,
            length: self.at - open.at,
        };
        match open.name {
            None => self.lines = Some(spooled(RECORDINGS.to_owned(), LINES)),
            Some(name) => {
                let kind = check::kind(&name, &open.head)?;
                self.media.push(spooled(name, kind));
            }
        }
        Ok(())
    }

    fn finish(self) -> Result<Spool, WebError> {
        let (Some(reader), Some(lines)) = (self.reader, self.lines) else {
            let message = "pictures and films came without recordings that name them: send the recordings too";
            return Err(Malformed::new(RECORDINGS, message).into());
        };
        let pool = reader.finish().map_err(|error| in_recordings(&error))?;
        check::all_are_here(&pool, &self.names, &self.media)?;
        let file = self.file.into_inner().map_err(WebError::internal)?;
        let files = std::iter::once(lines).chain(self.media).collect();
        Ok(Spool { file, files, pool })
    }
}

/// The bytes of one file.
struct Part<'a> {
    file: &'a File,
    at: u64,
    left: u64,
}

impl Read for Part<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        let most = usize::try_from(self.left).map_or(buffer.len(), |left| left.min(buffer.len()));
        self.file.seek(SeekFrom::Start(self.at))?;
        let read = self.file.read(&mut buffer[..most])?;
        self.at += read as u64;
        self.left -= read as u64;
        Ok(read)
    }
}

/// The files of a spool, one after the other: the store keeps them.
pub(super) struct Contents<'a> {
    file: &'a File,
    files: std::slice::Iter<'a, Spooled>,
}

impl<'a> Iterator for Contents<'a> {
    type Item = NewFile<'a>;

    fn next(&mut self) -> Option<NewFile<'a>> {
        let Spooled {
            name,
            kind,
            at,
            length,
        } = self.files.next()?;
        Some(NewFile {
            name: name.clone(),
            kind: (*kind).to_owned(),
            content: Box::new(Part {
                file: self.file,
                at: *at,
                left: *length,
            }),
        })
    }
}

impl Spool {
    /// The pool, and the rest with the files.
    pub(super) fn split(self) -> (Pool, Files) {
        let Self { file, files, pool } = self;
        (pool, Files { file, files })
    }
}

/// The files of a whole upload.
pub(crate) struct Files {
    file: File,
    files: Vec<Spooled>,
}

impl Files {
    pub(crate) fn contents(&self) -> impl Iterator<Item = NewFile<'_>> {
        Contents {
            file: &self.file,
            files: self.files.iter(),
        }
    }
}
