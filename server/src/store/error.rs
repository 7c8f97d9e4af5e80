//! Why the gradebook refuses, and what to do.

use std::path::PathBuf;

use axum::http::StatusCode;
use sqlx::postgres::PgDatabaseError;

use super::location::Location;
use crate::policy::Refusal;
use crate::problem::Problem;

/// Why the gradebook could not be opened, read or written.
#[derive(Debug, Clone, thiserror::Error)]
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
    /// The database of a server cannot be opened.
    #[error("cannot open the gradebook at {place}: {cause}")]
    Connect {
        /// Its address, without the password.
        place: String,
        /// What the server or the system said.
        cause: String,
        /// What to try.
        hint: &'static str,
    },
    /// The server of the database does not answer, or has ended the connection.
    #[error("the database server does not answer: {0}")]
    Gone(String),
    /// A text has a character that no text of the server can have: the one with the code 0.
    #[error("the gradebook does not take every character of this: {0}")]
    Letters(String),
    /// What only a gradebook in a file can.
    #[error("a gradebook on a PostgreSQL server is not {0} by this program")]
    FileOnly(&'static str),
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
    /// Another grader has taken over what this one was grading.
    #[error("another grader has taken this over")]
    Fenced,
    /// Earlier submissions of the person to the lesson wait for their verdicts: this one has to wait behind them.
    #[error("earlier answers of the same person wait for their verdicts")]
    Behind,
    /// Attempts of the person wait for their verdicts, and with them all are used.
    #[error("earlier answers to this exercise are still being graded")]
    BeingGraded,
    /// Somebody, or everybody together, has handed in as much as is kept.
    #[error("{0}")]
    QuotaUsed(String),
    /// The exercise cannot be handed in now.
    #[error(transparent)]
    Refused(#[from] Refusal),
    /// Something that points follow from is not as it was when a preview was computed.
    #[error("{0}")]
    OutOfDate(&'static str),
    /// Somebody else has set the policy since it was read.
    #[error("the policy of this lesson was set anew since you read it")]
    PolicyChanged,
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
        if let Some(refused) = error.as_database_error().and_then(|e| e.try_downcast_ref::<PgDatabaseError>())
        {
            return Self::of_server(refused.code(), said);
        }
        let code = error.as_database_error().and_then(sqlx::error::DatabaseError::code);
        // SQLite's extended codes keep the kind of error in their lowest byte: https://sqlite.org/rescode.html
        match code.and_then(|code| code.parse::<u32>().ok()).map(|code| code & 0xff) {
            Some(5 | 6) => Self::Busy,
            Some(8 | 10 | 14) => Self::ReadOnly(said),
            Some(11 | 26) => Self::Damaged(said),
            Some(13) => Self::Full,
            _ if matches!(error, sqlx::Error::PoolTimedOut) => Self::Busy,
            _ if matches!(error, sqlx::Error::Io(_) | sqlx::Error::Tls(_) | sqlx::Error::PoolClosed) => {
                Self::Gone(said)
            }
            _ => Self::Sql(said),
        }
    }
}

/// Code and hint of what keeps a database of a server from being opened.
const CONNECTING: [(&str, &str); 3] = [
    (
        "28",
        "check the user and the password of --database; a password can also stand in ~/.pgpass or PGPASSWORD",
    ),
    ("3D", "make the database first: createdb NAME, with the user of --database as its owner"),
    ("53300", "the server allows no more connections: raise its max_connections, or start fewer programs"),
];

impl StoreError {
    /// The code of a lost claim.
    pub const FENCED: &str = "fenced";

    /// What a server said, by the class of its SQLSTATE: PostgreSQL, appendix A.
    fn of_server(code: &str, said: String) -> Self {
        match code {
            "53100" => Self::Full,
            // No lock in time, two that wait for each other, too many connections: it may pass.
            "55P03" | "40P01" | "40001" | "53300" => Self::Busy,
            "25006" | "42501" => Self::ReadOnly(said),
            "22021" => Self::Letters(said),
            "XX001" | "XX002" => Self::Damaged(said),
            // It is starting, stopping, or has ended the connection.
            "57P01" | "57P02" | "57P03" | "25P03" => Self::Gone(said),
            _ if code.starts_with("08") => Self::Gone(said),
            _ => Self::Sql(said),
        }
    }

    /// The same, told of the server whose tables were to be made.
    pub(super) fn making(self, location: &Location) -> Self {
        let hint = match self {
            Self::ReadOnly(_) => {
                "let the user of --database make tables there: make it the owner of the database"
            }
            Self::Sql(_) => {
                "check that the database has nothing else in it and takes letters of all languages (UTF8)"
            }
            other => return other,
        };
        Self::Connect { place: location.to_string(), cause: self.to_string(), hint }
    }

    /// Why the database of a server could not be opened.
    pub(super) fn connecting(error: &sqlx::Error, location: &Location) -> Self {
        let code = error.as_database_error().and_then(sqlx::error::DatabaseError::code);
        let known =
            CONNECTING.iter().find(|(start, _)| code.as_deref().is_some_and(|code| code.starts_with(start)));
        let hint =
            known.map_or("start PostgreSQL, or check host, port and name of --database", |(_, hint)| hint);
        Self::Connect { place: location.to_string(), cause: error.to_string(), hint }
    }

    /// The same, told of the file that was to be opened.
    pub(super) fn opening(self, path: &std::path::Path) -> Self {
        match self {
            Self::Newer { .. } | Self::Open { .. } | Self::Moved(_) | Self::Foreign(_) | Self::Exists(_) => {
                self
            }
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
            StoreError::Connect { hint, .. } => (FAILED, "database-unreachable", *hint),
            StoreError::Gone(_) => (
                StatusCode::SERVICE_UNAVAILABLE,
                "database-gone",
                "nothing was kept: send again in a moment; if it lasts, look whether PostgreSQL runs",
            ),
            StoreError::Letters(_) => (
                StatusCode::UNPROCESSABLE_ENTITY,
                "unusual-character",
                "leave out the character with the code 0: nobody sees it",
            ),
            StoreError::FileOnly(_) => (
                StatusCode::UNPROCESSABLE_ENTITY,
                "not-a-file",
                "use PostgreSQL's own pg_dump and pg_restore; `triad class export` and `triad class import` move a class",
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
            StoreError::Fenced => {
                (StatusCode::CONFLICT, StoreError::FENCED, "nothing is lost: the other one keeps the verdict")
            }
            StoreError::Behind => {
                (StatusCode::SERVICE_UNAVAILABLE, "behind", "nothing was kept: send it again in a moment")
            }
            StoreError::BeingGraded => (
                StatusCode::CONFLICT,
                "being-graded",
                "your answers stay in this browser: wait for the verdict, then hand them in",
            ),
            StoreError::QuotaUsed(_) => (
                StatusCode::INSUFFICIENT_STORAGE,
                "quota-used",
                "nothing was kept: hand in smaller files, or let the teacher start the server with larger --person-quota \
                 and --quota",
            ),
            StoreError::Refused(refusal) => refused(*refusal),
            StoreError::OutOfDate(_) => (
                StatusCode::CONFLICT,
                "out-of-date",
                "nothing was changed: make the preview anew, then apply it",
            ),
            StoreError::PolicyChanged => (
                StatusCode::CONFLICT,
                "policy-changed",
                "nothing was changed: look at what is set now, then set yours in its place if it is still right",
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
