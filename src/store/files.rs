//! Files of uploads in `SQLite`, cut into chunks.

use std::io::{ErrorKind, Read};

use rusqlite::{Connection, OptionalExtension, Transaction, params};

use super::{CHUNK, NewFile, SessionId, StoreError, StoredFile, UploadId};

/// Puts a new upload with these files into the database.
pub(super) fn insert(
    transaction: &Transaction<'_>,
    upload: &UploadId,
    files: &mut dyn Iterator<Item = NewFile<'_>>,
) -> Result<(), StoreError> {
    let id = upload.to_string();
    transaction.execute("INSERT INTO uploads (id) VALUES (?1)", [&id])?;
    let mut new_file = transaction.prepare(
        "INSERT INTO files (upload, number, name, kind, size) VALUES (?1, ?2, ?3, ?4, 0)",
    )?;
    let mut new_chunk = transaction
        .prepare("INSERT INTO chunks (upload, file, place, bytes) VALUES (?1, ?2, ?3, ?4)")?;
    let mut sized =
        transaction.prepare("UPDATE files SET size = ?3 WHERE upload = ?1 AND number = ?2")?;
    let mut chunk = vec![0; CHUNK];
    for (number, mut file) in (0_u32..).zip(files) {
        new_file.execute(params![id, number, file.name, file.kind])?;
        let mut size = 0;
        for place in 0_i64.. {
            let read = fill(&mut file.content, &mut chunk).map_err(|error| StoreError::Unread {
                name: file.name.clone(),
                error,
            })?;
            if read > 0 {
                new_chunk.execute(params![id, number, place, &chunk[..read]])?;
                size += read;
            }
            if read < CHUNK {
                break;
            }
        }
        sized.execute(params![id, number, i64::try_from(size).unwrap_or(i64::MAX)])?;
    }
    Ok(())
}

/// As many bytes as there are, up to the buffer's length.
pub(super) fn fill(from: &mut impl Read, buffer: &mut [u8]) -> std::io::Result<usize> {
    let mut filled = 0;
    while filled < buffer.len() {
        match from.read(&mut buffer[filled..]) {
            Ok(0) => break,
            Ok(read) => filled += read,
            Err(error) if error.kind() == ErrorKind::Interrupted => {}
            Err(error) => return Err(error),
        }
    }
    Ok(filled)
}

/// Whether there is such an upload.
pub(super) fn has(connection: &Connection, upload: &UploadId) -> Result<bool, StoreError> {
    let found = connection
        .prepare_cached("SELECT 1 FROM uploads WHERE id = ?1")?
        .exists([upload.to_string()])?;
    Ok(found)
}

/// The upload of a session.
pub(super) fn of_session(
    connection: &Connection,
    session: &SessionId,
) -> Result<Option<UploadId>, StoreError> {
    let found: Option<Option<String>> = connection
        .prepare_cached("SELECT upload FROM sessions WHERE id = ?1")?
        .query_row([session.to_string()], |row| row.get(0))
        .optional()?;
    found
        .flatten()
        .map(|id| {
            id.parse()
                .map_err(|_| rusqlite::Error::InvalidColumnName(id).into())
        })
        .transpose()
}

/// A file by its name.
pub(super) fn find(
    connection: &Connection,
    upload: &UploadId,
    name: &str,
) -> Result<Option<StoredFile>, StoreError> {
    let found = connection
        .prepare_cached("SELECT number, kind, size FROM files WHERE upload = ?1 AND name = ?2")?
        .query_row(params![upload.to_string(), name], |row| {
            Ok(StoredFile {
                upload: *upload,
                number: row.get(0)?,
                kind: row.get(1)?,
                size: row.get::<_, i64>(2)?.cast_unsigned(),
            })
        })
        .optional()?;
    Ok(found)
}

/// A piece of a file.
pub(super) fn chunk(
    connection: &Connection,
    file: &StoredFile,
    place: u64,
) -> Result<Vec<u8>, StoreError> {
    let place = i64::try_from(place).unwrap_or(i64::MAX);
    let found = connection
        .prepare_cached("SELECT bytes FROM chunks WHERE upload = ?1 AND file = ?2 AND place = ?3")?
        .query_row(
            params![file.upload.to_string(), file.number, place],
            |row| row.get(0),
        )
        .optional()?;
    Ok(found.unwrap_or_default())
}
