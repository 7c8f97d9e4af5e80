//! Files that commands write.

use std::fmt::Display;
use std::fs;
use std::path::Path;

use axum::http::StatusCode;

use crate::problem::Problem;

/// Makes the folder of a file, so that work does not begin whose result has no place.
pub(super) fn make_room(file: &Path) -> Result<(), Problem> {
    file.parent().map_or(Ok(()), make_folder)
}

/// Makes a folder and those above it.
pub(super) fn make_folder(folder: &Path) -> Result<(), Problem> {
    fs::create_dir_all(folder).map_err(|error| unwritable(folder, &error))
}

/// Writes a file, and the folders above it.
pub(super) fn write(file: &Path, bytes: impl AsRef<[u8]>) -> Result<(), Problem> {
    make_room(file)?;
    fs::write(file, bytes).map_err(|error| unwritable(file, &error))
}

pub(super) fn unwritable(path: &Path, error: &impl Display) -> Problem {
    Problem::new(
        StatusCode::INTERNAL_SERVER_ERROR,
        "unwritable-file",
        format!("{} cannot be written: {error}", path.display()),
        "give a file in a folder that you may write to",
    )
}
