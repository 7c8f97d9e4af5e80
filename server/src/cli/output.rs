//! Files that commands write.

use std::fmt::Display;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::{fs, io};

use axum::http::StatusCode;

use super::terminal::tell_on_stderr;
use crate::problem::Problem;

/// Stands for standard output, where a text is written.
const STANDARD: &str = "-";

/// What an option writes, or a command reads.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Form {
    /// A text, which may go to standard output.
    Text,
    /// What is no text, or a folder.
    Other,
    /// What is read, and must not be replaced.
    Read,
}

/// Whether a file is standard output.
pub(super) fn is_standard(file: &Path) -> bool {
    file.as_os_str() == STANDARD
}

/// Refuses what would replace one thing by another, or mix two on standard output: called before anything is computed. Each file
/// comes with its option. Where one goes to standard output, what is told goes to the other stream from now on.
pub(super) fn apart(files: &[(&str, Option<&Path>, Form)], json: bool) -> Result<(), Problem> {
    let given = || files.iter().filter_map(|(option, file, form)| Some((*option, (*file)?, *form)));
    let mut standard = None;
    for (option, file, form) in given().filter(|(_, file, form)| *form != Form::Read && is_standard(file)) {
        if form == Form::Other {
            return Err(not_there(option));
        }
        if json {
            let detail = format!("{option} - and --json would both write to standard output");
            return Err(refused("same-file", detail, format!("give {option} a file, or leave --json out")));
        }
        if let Some(other) = standard.replace(option) {
            return Err(same(other, option, file));
        }
    }
    let places: Vec<_> = given()
        .filter(|(_, file, _)| !is_standard(file) && !is_device(file))
        .map(|(option, file, form)| (option, file, form, place(file)))
        .collect();
    for (index, (option, file, form, at)) in places.iter().enumerate() {
        let other = places[..index].iter().find(|(.., before, there)| {
            there == at && [*before, *form].iter().any(|form| *form != Form::Read)
        });
        if let Some((other, _, before, _)) = other {
            return Err(if *before == Form::Read {
                replaces(option, file)
            } else {
                same(other, option, file)
            });
        }
    }
    if standard.is_some() {
        tell_on_stderr();
    }
    Ok(())
}

/// Refuses a folder, archive or gradebook that is to be made on standard output.
pub(super) fn not_standard(option: &str, place: &Path) -> Result<(), Problem> {
    if is_standard(place) { Err(not_there(option)) } else { Ok(()) }
}

fn refused(code: &'static str, detail: String, hint: String) -> Problem {
    Problem::new(StatusCode::UNPROCESSABLE_ENTITY, code, detail, hint)
}

fn not_there(option: &str) -> Problem {
    let detail = format!("{option} - would be standard output, where this is not written");
    refused("no-standard-output", detail, format!("give {option} a name, or ./- if it is to be called so"))
}

fn same(one: &str, other: &str, file: &Path) -> Problem {
    let file = if is_standard(file) { "standard output".to_owned() } else { file.display().to_string() };
    let detail = format!("{one} and {other} would both write {file}, the one over the other");
    refused("same-file", detail, "give each a file of its own".to_owned())
}

fn replaces(option: &str, file: &Path) -> Problem {
    let detail = format!("{option} would replace {}, which is read", file.display());
    refused("same-file", detail, format!("give {option} another file"))
}

/// Whether something is there that is no file, such as /dev/null: nothing is replaced in it.
fn is_device(file: &Path) -> bool {
    fs::metadata(file).is_ok_and(|there| !there.is_file())
}

/// Where a file is or would be, by one name for all ways to it.
fn place(file: &Path) -> PathBuf {
    let of_folder = || {
        let folder = file.parent().filter(|folder| !folder.as_os_str().is_empty());
        Some(fs::canonicalize(folder.unwrap_or(Path::new("."))).ok()?.join(file.file_name()?))
    };
    let there = fs::canonicalize(file).ok().or_else(of_folder);
    there.or_else(|| std::path::absolute(file).ok()).unwrap_or_else(|| file.to_owned())
}

/// Makes the folder of a file, so that work does not begin whose result has no place.
pub(super) fn make_room(file: &Path) -> Result<(), Problem> {
    file.parent().map_or(Ok(()), make_folder)
}

/// Makes a folder and those above it.
pub(super) fn make_folder(folder: &Path) -> Result<(), Problem> {
    fs::create_dir_all(folder).map_err(|error| unwritable(folder, &error))
}

/// Writes a file, and the folders above it; `-` is standard output.
pub(super) fn write(file: &Path, bytes: impl AsRef<[u8]>) -> Result<(), Problem> {
    if is_standard(file) {
        // A reader that has had enough (`| head`) is no error.
        drop(io::stdout().write_all(bytes.as_ref()));
        return Ok(());
    }
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
