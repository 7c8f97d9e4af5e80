//! The program that grades without a server: `triad-grade`, as it runs on every Linux.

use std::fs;
use std::io::Read;
use std::path::{Path, PathBuf};

use axum::http::StatusCode;
use flate2::read::ZlibDecoder;

use crate::problem::Problem;

/// Its name.
pub(super) const NAME: &str = "triad-grade";
/// The target that it is built for.
const TARGET: &str = "x86_64-unknown-linux-musl";
/// The program as a release carries it, packed; empty where none was at hand when this one was built.
static PACKED: &[u8] = include_bytes!(concat!(env!("OUT_DIR"), "/triad-grade.z"));

/// The program: the one that is named, else one that lies beside this program or where Cargo puts it, else the one within.
///
/// Errors if there is none, or the one that is named needs libraries of the machine.
pub(super) fn find(named: Option<&Path>) -> Result<Vec<u8>, Problem> {
    if let Some(path) = named {
        let bytes = fs::read(path).map_err(|error| {
            let detail = format!("{} cannot be read: {error}", path.display());
            Problem::new(StatusCode::UNPROCESSABLE_ENTITY, "no-such-file", detail, how_to_get())
        })?;
        return match fault(&bytes) {
            None => Ok(bytes),
            Some(why) => Err(Problem::new(
                StatusCode::UNPROCESSABLE_ENTITY,
                "not-portable",
                format!("{} {why}", path.display()),
                how_to_get(),
            )),
        };
    }
    let found =
        places().into_iter().filter_map(|path| fs::read(path).ok()).find(|bytes| fault(bytes).is_none());
    if let Some(bytes) = found {
        return Ok(bytes);
    }
    let mut within = Vec::new();
    ZlibDecoder::new(PACKED).read_to_end(&mut within).map_err(Problem::internal)?;
    if within.is_empty() {
        return Err(Problem::new(
            StatusCode::UNPROCESSABLE_ENTITY,
            "no-grader",
            format!(
                "the program {NAME} is not at hand: this build of triad carries none, and none lies beside it"
            ),
            how_to_get(),
        ));
    }
    Ok(within)
}

/// Beside this program, and where Cargo builds for another target.
fn places() -> Vec<PathBuf> {
    let own = std::env::current_exe().unwrap_or_default();
    let folder = own.parent().unwrap_or(Path::new("."));
    let built = folder.join("..").join(TARGET).join("release").join(NAME);
    vec![folder.join(NAME), built]
}

fn how_to_get() -> String {
    format!(
        "rustup target add {TARGET}; cargo build --release --target {TARGET} -p {NAME}; then run this again, or name the \
         program with --program"
    )
}

/// What keeps a program from running on every Linux for this processor.
fn fault(program: &[u8]) -> Option<&'static str> {
    /// A program for 64-bit x86, as its first bytes say: the machine's number stands at byte 18.
    const AMD64: u8 = 62;
    if !program.starts_with(b"\x7fELF\x02\x01") || program.get(18) != Some(&AMD64) {
        return Some("is no program for Linux on x86-64");
    }
    // The image of a course may have an older C library than this machine.
    let holds = |word: &[u8]| program.windows(word.len()).any(|part| part == word);
    (holds(b"GLIBC_2.") || holds(b"/ld-linux-x86-64"))
        .then_some("needs the C library of the machine it runs on")
}

#[cfg(test)]
mod tests {
    use super::fault;

    #[test]
    fn only_programs_without_libraries_are_packed() {
        let program = |rest: &[u8]| {
            let mut bytes = b"\x7fELF\x02\x01\x01".to_vec();
            bytes.resize(18, 0);
            bytes.push(62);
            bytes.extend_from_slice(rest);
            bytes
        };
        assert_eq!(fault(&program(b"\0 code")), None);
        assert!(fault(&program(b"\0memcpy\0GLIBC_2.14\0")).is_some_and(|why| why.contains("C library")));
        assert!(fault(&program(b"/lib64/ld-linux-x86-64.so.2")).is_some());
        assert!(fault(b"#!/bin/sh").is_some() && fault(b"").is_some());
        let own = std::fs::read(std::env::current_exe().expect("this test has a file")).expect("readable");
        assert_eq!(fault(&own).is_some(), !cfg!(target_env = "musl"));
    }
}
