//! Copies of the whole gradebook, made while it is in use, and bringing one back.

use std::fs::{self, File, OpenOptions};
use std::path::{Path, PathBuf};

use serde::Serialize;
use sqlx::AnyConnection;

use super::super::database;
use super::super::error::StoreError;
use super::super::{Store, sql};

/// What was copied, after every record of it was looked at.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub struct Copied {
    /// Submissions in it.
    pub submissions: i64,
    /// Entries of its logs.
    pub events: i64,
    /// Its size.
    pub bytes: u64,
}

impl Store {
    /// Copies the whole gradebook into a new file as it stands at one moment, while others use it, and looks at every record
    /// of the copy.
    ///
    /// Errors if there is such a file, it cannot be written, the copy has a fault, or the gradebook is not a file itself: then
    /// there is none.
    pub async fn backup(&self, to: &Path) -> Result<Copied, StoreError> {
        let Some(place) = &self.place else {
            return Err(StoreError::FileOnly("copied into another file"));
        };
        place.check()?;
        let mut connection = self.pools.readers.acquire().await?;
        copy(&mut connection, to).await
    }
}

/// Makes a gradebook of a copy and looks at every record of it. The copy stays as it is.
///
/// Errors if there is a gradebook already, or the copy is none or has a fault: then nothing is made.
pub async fn restore(from: &Path, to: &Path) -> Result<Copied, StoreError> {
    // A log that an earlier gradebook left there would be taken for this one's.
    for beside in ["-wal", "-shm", "-journal"].map(|ending| named(to, ending)) {
        if beside.exists() {
            return Err(StoreError::Exists(beside));
        }
    }
    // One on a disk that cannot be written needs no log of its own.
    let whole = !named(from, "-wal").exists();
    let opening = |error: StoreError| error.opening(from);
    let absolute = from.canonicalize().map_err(|cause| refused(from, &cause))?;
    let mut connection = database::reading(&absolute, whole).await.map_err(opening)?;
    let format = database::format(&mut connection).await.map_err(opening)?;
    if format == 0 {
        return Err(StoreError::Foreign(format!("{} is no gradebook", from.display())));
    }
    copy(&mut connection, to).await
}

/// Copies the database of a connection into a new file that its owner alone can read.
async fn copy(connection: &mut AnyConnection, to: &Path) -> Result<Copied, StoreError> {
    reserve(to)?;
    let part = named(to, ".part");
    let copied = async {
        reserve(&part)?;
        sqlx::query("VACUUM INTO $1").bind(part.to_string_lossy().into_owned()).execute(connection).await?;
        let copied = looked_at(&part).await?;
        File::open(&part).and_then(|file| file.sync_all()).map_err(|cause| refused(&part, &cause))?;
        // The name was taken above: nobody else's file is replaced.
        fs::rename(&part, to).map_err(|cause| refused(to, &cause))?;
        sync_folder(to);
        Ok(copied)
    }
    .await;
    if copied.is_err() {
        for file in [&part, to] {
            drop(fs::remove_file(file));
        }
    }
    copied
}

/// Opens a copy as it would be used, and looks at everything in it.
async fn looked_at(path: &Path) -> Result<Copied, StoreError> {
    let store = Store::open(path).await?;
    let (whole,): (String,) =
        sqlx::query_as("PRAGMA integrity_check(1)").fetch_one(&store.pools.readers).await?;
    if whole != "ok" {
        return Err(StoreError::Damaged(whole));
    }
    if let Some(fault) = store.faults().await?.into_iter().next() {
        return Err(StoreError::Damaged(fault));
    }
    let (submissions, events) = sqlx::query_as(sql::SIZES).fetch_one(&store.pools.readers).await?;
    store.close().await;
    let bytes = path.metadata().map_or(0, |about| about.len());
    Ok(Copied { submissions, events, bytes })
}

/// Makes an empty file that its owner alone can read.
///
/// Errors if there is one.
fn reserve(path: &Path) -> Result<(), StoreError> {
    let mut options = OpenOptions::new();
    options.write(true).create_new(true);
    #[cfg(unix)]
    std::os::unix::fs::OpenOptionsExt::mode(&mut options, 0o600);
    options.open(path).map(drop).map_err(|cause| refused(path, &cause))
}

fn refused(path: &Path, cause: &std::io::Error) -> StoreError {
    if cause.kind() == std::io::ErrorKind::AlreadyExists {
        return StoreError::Exists(path.to_owned());
    }
    StoreError::Open { path: path.to_owned(), cause: cause.to_string() }
}

/// A path with something behind it.
fn named(path: &Path, ending: &str) -> PathBuf {
    let mut name = path.to_owned().into_os_string();
    name.push(ending);
    name.into()
}

/// Writes a new name through, where the system lets one: elsewhere it does so by itself.
fn sync_folder(file: &Path) {
    let folder = file.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    drop(File::open(folder).and_then(|folder| folder.sync_all()));
}
