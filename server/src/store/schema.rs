//! The tables, and the steps that bring an older database up to date.

use rusqlite::Connection;

use super::StoreError;

/// One entry per version, in order; a database at version `k` has had the first `k` applied.
const STEPS: [&str; 1] = ["
    CREATE TABLE submission (
        id            TEXT PRIMARY KEY NOT NULL,
        lesson        TEXT NOT NULL,
        student       TEXT NOT NULL,
        submitted_at  TEXT NOT NULL,
        answers       TEXT NOT NULL,
        verdict       TEXT NOT NULL
    ) STRICT;
    CREATE INDEX submission_by_student ON submission (student, lesson, submitted_at);
    CREATE INDEX submission_by_lesson ON submission (lesson, submitted_at);
    -- What a student handed in is a record: it is added to, never changed.
    CREATE TRIGGER submission_is_immutable BEFORE UPDATE ON submission
        BEGIN SELECT RAISE(ABORT, 'submissions are immutable'); END;
    CREATE TRIGGER submission_is_kept BEFORE DELETE ON submission
        BEGIN SELECT RAISE(ABORT, 'submissions are kept'); END;
"];

/// Brings the database to the newest version, each step in a transaction of its own.
pub(super) fn migrate(connection: &mut Connection) -> Result<(), StoreError> {
    let found: i64 = connection.query_row("PRAGMA user_version", [], |row| row.get(0))?;
    let known = i64::try_from(STEPS.len()).unwrap_or(i64::MAX);
    if found > known {
        return Err(StoreError::Newer { found, known });
    }
    for (version, step) in (1_i64..).zip(STEPS) {
        if version > found {
            let transaction = connection.transaction()?;
            transaction.execute_batch(step)?;
            transaction.pragma_update(None, "user_version", version)?;
            transaction.commit()?;
        }
    }
    Ok(())
}
