//! Why the gradebook refuses, and what to do.

use std::path::PathBuf;

use axum::http::StatusCode;

use crate::policy::Refusal;
use crate::problem::Problem;

/// Why the gradebook could not be opened, read or written.
#[derive(Debug, thiserror::Error)]
pub enum StoreError {
    /// The file is not there, not writable, or not a database.
    #[error("cannot open the database {}: {cause}", path.display())]
    Open {
        /// The file.
        path: PathBuf,
        /// What the system or SQLite said.
        cause: String,
    },
    /// The file was written by a later version of this program.
    #[error("the database has format {found}, this program knows formats up to {known}")]
    Newer {
        /// Format of the file.
        found: i64,
        /// Newest format known here.
        known: i64,
    },
    /// Bytes of the file are not those that were written.
    #[error("the database is damaged: {0}")]
    Damaged(String),
    /// The file at its path is not the one that was opened.
    #[error("the database {} was moved, removed or replaced while it is in use", .0.display())]
    Moved(PathBuf),
    /// Another program holds the file.
    #[error("another program has kept the database locked for some seconds")]
    Busy,
    /// No room is left.
    #[error("there is no room left for the database")]
    Full,
    /// The file or its folder cannot be written.
    #[error("the database cannot be written: {0}")]
    ReadOnly(String),
    /// Another statement failed.
    #[error("the database refused: {0}")]
    Sql(String),
    /// There is a file where one was to be made.
    #[error("there is {} already", .0.display())]
    Exists(PathBuf),
    /// A file that is not what it should be: no copy of a gradebook, or of another course.
    #[error("{0}")]
    Foreign(String),
    /// Another submission of the same person to the lesson came first: the verdict does not know of it.
    #[error("another submission of the same person came first")]
    Overtaken,
    /// Somebody, or everybody together, has handed in as much as is kept.
    #[error("{0}")]
    QuotaUsed(String),
    /// The exercise cannot be handed in now.
    #[error(transparent)]
    Refused(#[from] Refusal),
    /// Something was handed in or regraded since a preview was computed.
    #[error("something was handed in or regraded since this preview was made")]
    OutOfDate,
    /// A later regrade of the same lesson is in force.
    #[error("a later regrade of this lesson is in force")]
    NotLast,
    /// Another person of the course has the name.
    #[error("the name {0} is taken in this course")]
    NameTaken(String),
    /// A course would be left without anybody who may name others.
    #[error("the class would be without an owner")]
    LastOwner,
    /// A person, a submission or a course that is not there.
    #[error("there is no such {0}")]
    Unknown(&'static str),
}

impl From<sqlx::Error> for StoreError {
    fn from(error: sqlx::Error) -> Self {
        let said = error.to_string();
        let code = error.as_database_error().and_then(sqlx::error::DatabaseError::code);
        // SQLite's extended codes keep the kind of error in their lowest byte: https://sqlite.org/rescode.html
        match code.and_then(|code| code.parse::<u32>().ok()).map(|code| code & 0xff) {
            Some(5 | 6) => Self::Busy,
            Some(8 | 10 | 14) => Self::ReadOnly(said),
            Some(11 | 26) => Self::Damaged(said),
            Some(13) => Self::Full,
            _ if matches!(error, sqlx::Error::PoolTimedOut) => Self::Busy,
            _ => Self::Sql(said),
        }
    }
}

impl StoreError {
    /// The same, told of the file that was to be opened.
    pub(super) fn opening(self, path: &std::path::Path) -> Self {
        match self {
            Self::Newer { .. } | Self::Open { .. } | Self::Moved(_) | Self::Foreign(_) => self,
            other => Self::Open { path: path.to_owned(), cause: other.to_string() },
        }
    }
}

/// Status, code and hint of a submission that is refused.
fn refused(refusal: Refusal) -> (StatusCode, &'static str, &'static str) {
    let (code, hint) = match refusal {
        Refusal::NotOpen(_) => ("not-open", "your answers stay in this browser: hand them in then"),
        Refusal::Closed(_) => ("closed", "what you handed in before counts; ask your teacher for more time"),
        Refusal::AttemptsUsed(_) => {
            ("attempts-used", "what you handed in before counts; ask your teacher for another attempt")
        }
        Refusal::TooSoon(_) => ("too-soon", "look through your answers meanwhile: they stay in this browser"),
    };
    (StatusCode::CONFLICT, code, hint)
}

impl From<StoreError> for Problem {
    #[allow(clippy::too_many_lines)] // one table
    fn from(error: StoreError) -> Self {
        const FAILED: StatusCode = StatusCode::INTERNAL_SERVER_ERROR;
        let (status, code, hint) = match &error {
            StoreError::Open { .. } => (
                FAILED,
                "database-unavailable",
                "check that the folder exists and is writable and that the file is whole, restore it from a copy, or name \
                 another file with --database",
            ),
            StoreError::Newer { .. } => {
                (FAILED, "database-newer", "use the newer program, or name another file with --database")
            }
            StoreError::Damaged(_) => (
                FAILED,
                "database-damaged",
                "nothing was kept: stop the server and restore the database from a copy",
            ),
            StoreError::Moved(_) => (
                StatusCode::SERVICE_UNAVAILABLE,
                "database-moved",
                "nothing counts as kept: put the file back with its -wal and -shm, restart the server, then send again",
            ),
            StoreError::Busy => (
                StatusCode::SERVICE_UNAVAILABLE,
                "database-busy",
                "nothing was kept: send again in a moment; if it lasts, end the program that copies or edits the file",
            ),
            StoreError::Full => (
                StatusCode::INSUFFICIENT_STORAGE,
                "disk-full",
                "nothing was kept: make room on the server's disk, then send again",
            ),
            StoreError::ReadOnly(_) => (
                StatusCode::SERVICE_UNAVAILABLE,
                "database-read-only",
                "nothing was kept: make the file and its folder writable for the server, then send again",
            ),
            StoreError::Sql(_) => {
                (FAILED, "database-failed", "nothing was kept: try again, and report it if it comes back")
            }
            StoreError::Exists(_) => (
                StatusCode::CONFLICT,
                "file-exists",
                "nothing is overwritten: give another name, or move the file away first, with its -wal and -shm",
            ),
            StoreError::Foreign(_) => (
                StatusCode::UNPROCESSABLE_ENTITY,
                "foreign-file",
                "nothing was changed: give a file of `triad backup` to `triad restore`, one of `triad class export` to \
                 `triad class import`",
            ),
            StoreError::Overtaken => {
                (StatusCode::SERVICE_UNAVAILABLE, "overtaken", "nothing was kept: send it again in a moment")
            }
            StoreError::QuotaUsed(_) => (
                StatusCode::INSUFFICIENT_STORAGE,
                "quota-used",
                "nothing was kept: hand in smaller files, or let the teacher start the server with larger --person-quota \
                 and --quota",
            ),
            StoreError::Refused(refusal) => refused(*refusal),
            StoreError::OutOfDate => (
                StatusCode::CONFLICT,
                "out-of-date",
                "nothing was changed: make the preview anew, then apply it",
            ),
            StoreError::NotLast => (StatusCode::CONFLICT, "not-the-last", "take the later one back first"),
            StoreError::NameTaken(_) => (
                StatusCode::CONFLICT,
                "name-taken",
                "if it is you, come back with your four words; else add a letter to the name",
            ),
            StoreError::LastOwner => {
                (StatusCode::CONFLICT, "last-owner", "name another owner first, then give up the role")
            }
            StoreError::Unknown(_) => {
                (StatusCode::NOT_FOUND, "unknown-entry", "reload the list; it may have changed")
            }
        };
        Self::new(status, code, error.to_string(), hint)
    }
}
