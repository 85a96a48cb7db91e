//! Files of uploads in `PostgreSQL`, cut into chunks.

use deadpool_postgres::{Client, Transaction};
use tokio_postgres::types::ToSql;

use super::fault::fault;
use crate::store::{CHUNK, NewFile, SessionId, StoreError, UploadId, files::fill};

/// Creates a session with an upload, new or there already: all of it, or nothing.
pub(super) async fn begin(
    client: &mut Client,
    session: &SessionId,
    body: &str,
    upload: &UploadId,
    files: Option<&mut dyn Iterator<Item = NewFile<'_>>>,
) -> Result<(), StoreError> {
    let transaction = client.transaction().await.map_err(fault)?;
    let named = upload.to_string();
    if let Some(new) = files {
        insert(&transaction, &named, new).await?;
    } else {
        let known = "SELECT 1 FROM uploads WHERE id = $1";
        let known = transaction.query_opt(known, &[&named]).await;
        if known.map_err(fault)?.is_none() {
            return Err(StoreError::NoUpload { upload: *upload });
        }
    }
    let id = session.to_string();
    let new = "INSERT INTO sessions (id, upload) VALUES ($1, $2) ON CONFLICT DO NOTHING";
    let made = transaction.execute(new, &[&id, &named]).await;
    if made.map_err(fault)? == 0 {
        return Err(StoreError::Taken {
            session: *session,
            seq: 0,
        });
    }
    let first = "INSERT INTO entries (session, seq, body) VALUES ($1, 0, $2)";
    transaction
        .execute(first, &[&id, &body])
        .await
        .map_err(fault)?;
    transaction.commit().await.map_err(fault)
}

async fn insert(
    transaction: &Transaction<'_>,
    upload: &str,
    files: &mut dyn Iterator<Item = NewFile<'_>>,
) -> Result<(), StoreError> {
    let new = "INSERT INTO uploads (id) VALUES ($1)";
    transaction.execute(new, &[&upload]).await.map_err(fault)?;
    let new_file =
        "INSERT INTO files (upload, number, name, kind, size) VALUES ($1, $2, $3, $4, 0)";
    let new_chunk = "INSERT INTO chunks (upload, file, place, bytes) VALUES ($1, $2, $3, $4)";
    let sized = "UPDATE files SET size = $3 WHERE upload = $1 AND number = $2";
    let new_chunk = transaction.prepare_cached(new_chunk).await.map_err(fault)?;
    let mut chunk = vec![0; CHUNK];
    for (number, mut file) in (0_i64..).zip(files) {
        let named: &[&(dyn ToSql + Sync)] = &[&upload, &number, &file.name, &file.kind];
        transaction.execute(new_file, named).await.map_err(fault)?;
        let mut size = 0;
        for place in 0_i64.. {
            let read = fill(&mut file.content, &mut chunk).map_err(|error| StoreError::Unread {
                name: file.name.clone(),
                error,
            })?;
            if read > 0 {
                let bytes = &chunk[..read];
                let piece: &[&(dyn ToSql + Sync)] = &[&upload, &number, &place, &bytes];
                transaction
                    .execute(&new_chunk, piece)
                    .await
                    .map_err(fault)?;
                size += read;
            }
            if read < CHUNK {
                break;
            }
        }
        let size = i64::try_from(size).unwrap_or(i64::MAX);
        let length: &[&(dyn ToSql + Sync)] = &[&upload, &number, &size];
        transaction.execute(sized, length).await.map_err(fault)?;
    }
    Ok(())
}
