//! The file of the gradebook, and whether it is still where it was.

use std::fs::OpenOptions;
use std::path::{Path, PathBuf};

use super::error::StoreError;

/// A file as the system knows it, whatever its name.
#[cfg(unix)]
type Identity = (u64, u64);
/// Elsewhere an open file can be neither moved nor removed: that it exists is enough.
#[cfg(not(unix))]
type Identity = bool;

/// The database file and its log of changes that are not yet in it. What is written after one of them was moved away would
/// be gone at the next start.
#[derive(Debug)]
pub(super) struct Place {
    path: PathBuf,
    files: Vec<(PathBuf, Option<Identity>)>,
}

impl Place {
    /// Makes the file if it is not there, readable by its owner alone: it holds names and grades.
    ///
    /// Errors if it cannot be made or found.
    pub(super) fn prepare(path: &Path) -> Result<PathBuf, StoreError> {
        let refused =
            |cause: std::io::Error| StoreError::Open { path: path.to_owned(), cause: cause.to_string() };
        let mut options = OpenOptions::new();
        options.read(true).write(true).create(true).truncate(false);
        #[cfg(unix)]
        std::os::unix::fs::OpenOptionsExt::mode(&mut options, 0o600);
        drop(options.open(path).map_err(refused)?);
        path.canonicalize().map_err(refused)
    }

    /// Remembers the files of an open database.
    pub(super) fn remember(path: PathBuf) -> Self {
        let mut log = path.clone().into_os_string();
        log.push("-wal");
        let files = [path.clone(), log.into()].map(|file| (file.clone(), identity(&file)));
        Self { path, files: files.to_vec() }
    }

    /// Bytes of the database, what is still in its log among them.
    pub(super) fn bytes(&self) -> u64 {
        self.files.iter().filter_map(|(file, _)| file.metadata().ok()).map(|about| about.len()).sum()
    }

    /// Errors if a file is no longer the one that was opened.
    pub(super) fn check(&self) -> Result<(), StoreError> {
        let same = self.files.iter().all(|(file, before)| identity(file) == *before);
        if same { Ok(()) } else { Err(StoreError::Moved(self.path.clone())) }
    }
}

#[cfg(unix)]
fn identity(path: &Path) -> Option<Identity> {
    use std::os::unix::fs::MetadataExt;
    path.metadata().ok().map(|about| (about.dev(), about.ino()))
}

#[cfg(not(unix))]
fn identity(path: &Path) -> Option<Identity> {
    path.exists().then_some(true)
}
