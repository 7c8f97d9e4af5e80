//! The gradebook: submissions and their verdicts in one SQLite file.

mod schema;

use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use axum::http::StatusCode;
use rusqlite::Connection;
use serde_json::Value;

use crate::problem::Problem;

/// Why the gradebook could not be opened, read or written.
#[derive(Debug, thiserror::Error)]
pub enum StoreError {
    /// The file is not there, not writable, or not a database.
    #[error("cannot open the database {}: {cause}", path.display())]
    Open {
        /// The file.
        path: PathBuf,
        /// What SQLite said.
        cause: rusqlite::Error,
    },
    /// The file was written by a later version of this program.
    #[error("the database has format {found}, this program knows formats up to {known}")]
    Newer {
        /// Format of the file.
        found: i64,
        /// Newest format known here.
        known: i64,
    },
    /// A statement failed.
    #[error("the database refused: {0}")]
    Sql(#[from] rusqlite::Error),
    /// A stored document is not JSON.
    #[error("submission {id} is damaged: {cause}")]
    Damaged {
        /// The submission.
        id: String,
        /// What the reader said.
        cause: serde_json::Error,
    },
}

impl From<StoreError> for Problem {
    fn from(error: StoreError) -> Self {
        let status = StatusCode::INTERNAL_SERVER_ERROR;
        let (code, hint) = match &error {
            StoreError::Open { .. } => (
                "database-unavailable",
                "check that the folder exists and is writable, or name another file with --database",
            ),
            StoreError::Newer { .. } => {
                ("database-newer", "use the newer program, or name another file with --database")
            }
            StoreError::Sql(_) => ("database-failed", "check that the disk is not full, then try again"),
            StoreError::Damaged { .. } => {
                ("database-damaged", "restore the database file from a copy; other submissions are unharmed")
            }
        };
        Self::new(status, code, error.to_string(), hint)
    }
}

/// A submission as it is kept.
#[derive(Debug, Clone, PartialEq)]
pub struct StoredSubmission {
    /// Its name.
    pub id: String,
    /// Slug of the lesson.
    pub lesson: String,
    /// Who handed it in.
    pub student: String,
    /// When, RFC 3339 in UTC.
    pub submitted_at: String,
    /// What was handed in.
    pub answers: Value,
    /// What it earned, with the provenance of the grading.
    pub verdict: Value,
}

/// Which submissions to list.
#[derive(Debug, Clone, Default)]
pub struct Query {
    /// Only this student's.
    pub student: Option<String>,
    /// Only for this lesson.
    pub lesson: Option<String>,
    /// At most so many, newest first.
    pub limit: usize,
}

/// The gradebook. Calls block on the disk: from async code, use `spawn_blocking`.
#[derive(Debug)]
pub struct Store {
    connection: Mutex<Connection>,
}

impl Store {
    /// Opens the file, making it if it is not there, and brings its tables up to date.
    ///
    /// Errors if it cannot be opened, is no database, or is of a later version.
    pub fn open(path: &Path) -> Result<Self, StoreError> {
        let connection =
            Connection::open(path).map_err(|cause| StoreError::Open { path: path.to_owned(), cause })?;
        Self::prepare(connection).map_err(|error| match error {
            StoreError::Sql(cause) => StoreError::Open { path: path.to_owned(), cause },
            other => other,
        })
    }

    /// A gradebook that is forgotten when it is dropped.
    ///
    /// Errors if SQLite refuses it.
    pub fn in_memory() -> Result<Self, StoreError> {
        Self::prepare(Connection::open_in_memory()?)
    }

    fn prepare(mut connection: Connection) -> Result<Self, StoreError> {
        connection.busy_timeout(Duration::from_secs(5))?;
        // Answers with the mode that it took; an in-memory database keeps its own.
        connection.query_row("PRAGMA journal_mode = WAL", [], |_| Ok(()))?;
        connection.pragma_update(None, "synchronous", "FULL")?;
        schema::migrate(&mut connection)?;
        Ok(Self { connection: Mutex::new(connection) })
    }

    fn lock(&self) -> MutexGuard<'_, Connection> {
        // Each statement is a transaction of its own, so a panic elsewhere leaves nothing half-written.
        self.connection.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Keeps a submission; it can neither be changed nor removed.
    ///
    /// Errors if it cannot be written.
    pub fn add(&self, submission: &StoredSubmission) -> Result<(), StoreError> {
        self.lock().execute(
            "INSERT INTO submission (id, lesson, student, submitted_at, answers, verdict) \
             VALUES (?1, ?2, ?3, ?4, ?5, ?6)",
            (
                &submission.id,
                &submission.lesson,
                &submission.student,
                &submission.submitted_at,
                submission.answers.to_string(),
                submission.verdict.to_string(),
            ),
        )?;
        Ok(())
    }

    /// How often a student has handed in a lesson.
    ///
    /// Errors if the file cannot be read.
    pub fn attempts(&self, student: &str, lesson: &str) -> Result<usize, StoreError> {
        let connection = self.lock();
        let mut statement = connection
            .prepare_cached("SELECT COUNT(*) FROM submission WHERE student = ?1 AND lesson = ?2")?;
        let count: i64 = statement.query_row((student, lesson), |row| row.get(0))?;
        Ok(usize::try_from(count).unwrap_or_default())
    }

    /// Lists submissions, newest first.
    ///
    /// Errors if the file cannot be read.
    pub fn list(&self, query: &Query) -> Result<Vec<StoredSubmission>, StoreError> {
        let connection = self.lock();
        let mut statement = connection.prepare_cached(
            "SELECT id, lesson, student, submitted_at, answers, verdict FROM submission \
             WHERE (?1 IS NULL OR student = ?1) AND (?2 IS NULL OR lesson = ?2) \
             ORDER BY submitted_at DESC, rowid DESC LIMIT ?3",
        )?;
        let limit = i64::try_from(query.limit).unwrap_or(i64::MAX);
        let rows = statement.query_map((&query.student, &query.lesson, limit), |row| {
            Ok((row.get(0)?, row.get(1)?, row.get(2)?, row.get(3)?, row.get(4)?, row.get(5)?))
        })?;
        let mut found = Vec::new();
        for row in rows {
            let (id, lesson, student, submitted_at, answers, verdict): (_, _, _, _, String, String) = row?;
            let id: String = id;
            let parse = |text: &str| {
                serde_json::from_str(text).map_err(|cause| StoreError::Damaged { id: id.clone(), cause })
            };
            let (answers, verdict) = (parse(&answers)?, parse(&verdict)?);
            found.push(StoredSubmission { id, lesson, student, submitted_at, answers, verdict });
        }
        Ok(found)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn submission(id: &str, student: &str) -> StoredSubmission {
        StoredSubmission {
            id: id.into(),
            lesson: "pendulum".into(),
            student: student.into(),
            submitted_at: format!("2025-01-01T00:00:0{id}Z"),
            answers: json!({"q": {"value": "0.1"}}),
            verdict: json!({"earned": 0.1}),
        }
    }

    #[test]
    fn what_was_handed_in_survives_a_restart_unchanged() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join("grades.db");
        let store = Store::open(&path).expect("opens");
        store.add(&submission("1", "ada")).expect("adds");
        store.add(&submission("2", "emmy")).expect("adds");
        drop(store);

        let store = Store::open(&path).expect("opens again");
        let all = store.list(&Query { limit: 10, ..Query::default() }).expect("lists");
        assert_eq!(all, [submission("2", "emmy"), submission("1", "ada")], "newest first");
        let ada = Query { student: Some("ada".into()), limit: 10, ..Query::default() };
        assert_eq!(store.list(&ada).expect("lists"), [submission("1", "ada")]);
        let attempts = |student, lesson| store.attempts(student, lesson).expect("counts");
        assert_eq!(
            [attempts("ada", "pendulum"), attempts("ada", "chain"), attempts("eve", "pendulum")],
            [1, 0, 0]
        );
    }

    #[test]
    fn submissions_can_be_neither_changed_nor_removed() {
        let store = Store::in_memory().expect("opens");
        store.add(&submission("1", "ada")).expect("adds");
        assert!(store.add(&submission("1", "eve")).is_err(), "an id is used once");
        assert!(store.lock().execute("UPDATE submission SET student = 'eve'", []).is_err());
        assert!(store.lock().execute("DELETE FROM submission", []).is_err());
    }

    #[test]
    fn a_database_of_a_later_version_is_refused() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join("grades.db");
        let store = Store::open(&path).expect("opens");
        store.lock().pragma_update(None, "user_version", 99).expect("pragma");
        drop(store);
        assert!(matches!(Store::open(&path), Err(StoreError::Newer { found: 99, known: 1 })));
    }

    #[test]
    fn a_file_that_is_no_database_is_refused_by_name() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join("notes.txt");
        std::fs::write(&path, "not a database, but long enough to be read as one".repeat(40))
            .expect("writes");
        let error = Store::open(&path).expect_err("refused");
        assert!(error.to_string().contains("notes.txt"), "{error}");
    }
}
