//! The file that a student hands in, and its verdict: the same as from the server and from the command line.

use std::fs;
use std::io::Read;
use std::path::{Path, PathBuf};

use thiserror::Error;
use triad_lessons::answers::SubmissionError;
use triad_lessons::seed::{self, SeedError};
use triad_lessons::{GradeError, Lesson, Submission, VariantError, Verdict};

/// The file that is looked for first; a single file with this ending does as well.
pub const FILE: &str = "answers.json";
/// Bytes that are read of a file: one more than a submission may have, so that it is refused as too large.
const MOST: u64 = (4 << 20) + 1;

/// Why there is no verdict on what was handed in; the student's to mend, but for the last.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum HandInError {
    /// No file, or several of which none is the one.
    #[error("hand in one file, {FILE}; found: {found}")]
    NoFile {
        /// The names of what there is.
        found: String,
    },
    /// A file that cannot be read as text.
    #[error("{name} cannot be read: {problem}")]
    Unreadable {
        /// The file.
        name: String,
        /// What is wrong.
        problem: String,
    },
    /// Not a submission.
    #[error("{0}\n{hint}", hint = .0.hint())]
    Submission(#[from] SubmissionError),
    /// The name in it is none.
    #[error("{0}; use your name")]
    Seed(#[from] SeedError),
    /// An answer to what was not asked.
    #[error("{0}; answer only the questions of this lesson, by their ids")]
    Question(#[from] GradeError),
    /// Answers to somebody else's numbers.
    #[error(
        "these are answers to the numbers of {given}; yours are those of {own}: type that as your name in Triad, answer, and \
         save the answers again"
    )]
    NotYours {
        /// Whose numbers were answered.
        given: String,
        /// Whose would be right.
        own: String,
    },
    /// The lesson has no numbers for this seed.
    #[error("{0}; this is not your mistake: tell your instructor")]
    Variant(#[from] VariantError),
}

/// The student's file in a folder.
///
/// Errors if it is not clear which it is.
pub fn file_in(folder: &Path) -> Result<PathBuf, HandInError> {
    // Only files themselves: a link could lead to what is not the student's to read.
    let is_file = |path: &Path| path.symlink_metadata().is_ok_and(|about| about.is_file());
    let named = folder.join(FILE);
    if is_file(&named) {
        return Ok(named);
    }
    let entries = fs::read_dir(folder).into_iter().flatten().filter_map(Result::ok);
    let mut files: Vec<PathBuf> = entries.map(|entry| entry.path()).filter(|path| is_file(path)).collect();
    files.sort();
    let json = |path: &&PathBuf| path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("json"));
    let mut fitting = files.iter().filter(json);
    match (fitting.next(), fitting.next()) {
        (Some(one), None) => Ok(one.clone()),
        _ => Err(HandInError::NoFile { found: listed(&files) }),
    }
}

/// The names of files, as many as fit into a sentence.
fn listed(files: &[PathBuf]) -> String {
    const MOST_NAMES: usize = 8;
    let names =
        files.iter().filter_map(|path| path.file_name()).map(|name| name.to_string_lossy().into_owned());
    let mut names: Vec<String> = names.take(MOST_NAMES).collect();
    match files.len() {
        0 => return "nothing".to_owned(),
        more if more > MOST_NAMES => names.push(format!("and {} more", more - MOST_NAMES)),
        _ => {}
    }
    names.join(", ")
}

/// The text of a file.
///
/// Errors if it cannot be read or is no text.
pub fn text(file: &Path) -> Result<String, HandInError> {
    let mut bytes = Vec::new();
    let unreadable = |problem: String| HandInError::Unreadable {
        name: file.file_name().unwrap_or_default().to_string_lossy().into_owned(),
        problem,
    };
    fs::File::open(file)
        .and_then(|file| file.take(MOST).read_to_end(&mut bytes))
        .map_err(|error| unreadable(error.to_string()))?;
    String::from_utf8(bytes).map_err(|_| unreadable("it is not text in UTF-8".to_owned()))
}

/// Grades a submission with the numbers of `given`; without it those of the submission's seed, or else its student's.
///
/// Errors if it cannot be read or answers what is not asked.
pub fn grade(lesson: &Lesson, text: &str, given: Option<&str>) -> Result<Verdict, HandInError> {
    let submission = Submission::from_json(text)?;
    let seed = seed::checked(given.unwrap_or_else(|| submission.numbers_of()))?;
    Ok(triad_lessons::grade(&lesson.of_seed(&seed)?, &submission)?)
}

/// Grades a submission with the numbers of one of these addresses, which it must name.
///
/// Errors as [`grade`] does, and if it is about the numbers of somebody else.
pub fn grade_of(lesson: &Lesson, text: &str, addresses: &[String]) -> Result<Verdict, HandInError> {
    let submission = Submission::from_json(text)?;
    let given = seed::checked(submission.numbers_of())?;
    // Letters in other cases would give other numbers: nobody is to choose among them.
    let own: Vec<String> = addresses.iter().map(|address| address.trim().to_lowercase()).collect();
    if own.contains(&given) {
        return grade(lesson, text, None);
    }
    let given = if given.is_empty() { "everybody".to_owned() } else { given };
    Err(HandInError::NotYours { given, own: own.join(" or ") })
}
