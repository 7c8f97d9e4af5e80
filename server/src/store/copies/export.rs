//! A whole course as one file: a line for each row, and a last line that says that it is whole.
//!
//! ```text
//! {"triad":"course","format":3,"course":"class","at":1760000000000}
//! ["course",{"id":"class",…}]
//! ["person",{…}]
//! …
//! {"rows":1234,"sha256":"…"}      of all bytes before this line
//! ```

use axum::body::Bytes;
use futures_util::TryStreamExt;
use serde_json::json;
use sha2::{Digest, Sha256};
use sqlx::AnyConnection;
use tokio::sync::mpsc;

use super::super::error::StoreError;
use super::super::hash::hexadecimal;
use super::super::{Store, now, schema};
use super::tables::{OF_COURSE, as_json};

/// Bytes that are sent at once, at least.
const CHUNK: usize = 1 << 16;

/// Where the bytes of a course go, piece by piece.
pub type Pieces = mpsc::Sender<Result<Bytes, StoreError>>;

impl Store {
    /// Writes a course as it stands at one moment, while others use it. Whoever receives nothing any more ends it.
    ///
    /// Errors if there is no such course or the file cannot be read; what was sent then lacks its last line.
    pub async fn export(&self, course: &str, out: &Pieces) -> Result<(), StoreError> {
        self.course(course).await?;
        let mut connection = self.snapshot().await?;
        rows(&mut connection, course, out).await
    }
}

async fn rows(connection: &mut AnyConnection, course: &str, out: &Pieces) -> Result<(), StoreError> {
    let mut lines = Lines { out, hash: Sha256::new(), chunk: Vec::new() };
    let head = json!({"triad": "course", "format": schema::FORMAT, "course": course, "at": now()});
    lines.add(&head.to_string()).await;
    let mut count = 0_u64;
    for (table, select) in OF_COURSE {
        // One row at a time: some have megabytes.
        let mut found = sqlx::query(*select).bind(course).fetch(&mut *connection);
        while let Some(row) = found.try_next().await? {
            if out.is_closed() {
                return Ok(());
            }
            lines.add(&json!([table, as_json(&row)?]).to_string()).await;
            count += 1;
        }
    }
    let hash = hexadecimal(&lines.hash.clone().finalize());
    lines.add(&json!({"rows": count, "sha256": hash}).to_string()).await;
    lines.send().await;
    Ok(())
}

/// Lines on their way.
struct Lines<'a> {
    out: &'a Pieces,
    hash: Sha256,
    chunk: Vec<u8>,
}

impl Lines<'_> {
    async fn add(&mut self, line: &str) {
        for bytes in [line.as_bytes(), b"\n"] {
            self.hash.update(bytes);
            self.chunk.extend_from_slice(bytes);
        }
        if self.chunk.len() >= CHUNK {
            self.send().await;
        }
    }

    async fn send(&mut self) {
        let chunk = std::mem::take(&mut self.chunk);
        // Nobody receives any more: the loop over the rows ends at its next look.
        drop(self.out.send(Ok(chunk.into())).await);
    }
}
