//! What the end-to-end tests share. The tests themselves are in `tests/tests/`, one file a subject.
//!
//! Nothing here is part of the product; a helper that cannot go on panics with the reason.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, clippy::missing_panics_doc)]

pub mod accuracy;
#[cfg(unix)]
pub mod cable;
#[cfg(target_os = "linux")]
pub mod network;
#[cfg(unix)]
pub mod postgres;
pub mod probe;
pub mod vitals;

pub mod program;
pub mod random;
pub mod reference;
pub mod reviewed;

pub mod options;
#[cfg(target_os = "linux")]
pub mod park;
pub mod refusals;

pub mod lecture;
pub mod load;
pub mod person;

use std::path::PathBuf;

/// The repository.
pub fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).parent().unwrap().to_path_buf()
}
