//! Bringing a database to the tables of this version.

use sqlx::{AnyConnection, AssertSqlSafe, Row};

use super::database;
use super::error::StoreError;
use super::kind::Kind;
use super::log::{self, Event};
use super::records::{self, SubmissionRow, VerdictRow};
use super::{HOME, now, sql};

/// Format of the database that this program writes.
pub(super) const FORMAT: i64 = 10;

/// Makes the tables, or carries those of earlier formats over, within a transaction: another program that opens the
/// same gradebook meanwhile waits.
pub(super) async fn migrate(transaction: &mut AnyConnection) -> Result<(), StoreError> {
    let found = database::format(transaction).await?;
    if found > FORMAT {
        return Err(StoreError::Newer { found, known: FORMAT });
    }
    database::prepare(transaction).await?;
    if found == 1 {
        make(transaction, &OUT_OF_THE_WAY).await?;
    }
    if found < 2 {
        make(transaction, sql::TABLES).await?;
        make(transaction, sql::RECORDS).await?;
        add_course(transaction, HOME, "At home").await?;
    }
    if found < 3 {
        make(transaction, sql::ADDED).await?;
    }
    if found == 1 {
        carry_over(transaction).await?;
        sqlx::query("DROP TABLE submission_1").execute(&mut *transaction).await?;
    }
    if found < 4 {
        make(transaction, sql::ADDED_4).await?;
    }
    if found < 5 {
        make(transaction, sql::ADDED_5).await?;
    }
    if found < 6 {
        make(transaction, sql::lti::ADDED_6).await?;
    }
    if found < 7 {
        make(transaction, sql::ADDED_7).await?;
    }
    if found < 8 {
        make(transaction, sql::ADDED_8).await?;
    }
    if found < 9 {
        make(transaction, sql::ADDED_9).await?;
    }
    if found < 10 {
        make(transaction, sql::ADDED_10).await?;
    }
    database::set_format(transaction, FORMAT).await
}

/// Makes the tables of format 2, where there are none; whether it did.
#[cfg(test)]
pub(super) async fn make_of_format_2(connection: &mut AnyConnection) -> Result<bool, StoreError> {
    if database::format(connection).await? > 0 {
        return Ok(false);
    }
    database::prepare(connection).await?;
    make(connection, sql::TABLES).await?;
    make(connection, sql::RECORDS).await?;
    add_course(connection, HOME, "At home").await?;
    database::set_format(connection, 2).await?;
    Ok(true)
}

/// Makes tables and triggers, in the words of the database.
async fn make(connection: &mut AnyConnection, statements: &[&str]) -> Result<(), StoreError> {
    let kind = Kind::of(connection);
    for statement in statements {
        sqlx::query(AssertSqlSafe(kind.making(statement))).execute(&mut *connection).await?;
    }
    Ok(())
}

/// Adds a course, if it is not there.
pub(super) async fn add_course(
    connection: &mut AnyConnection,
    id: &str,
    title: &str,
) -> Result<(), StoreError> {
    let add = sqlx::query(sql::ADD_COURSE).bind(id).bind(title).bind(super::random::join_code()?).bind(1);
    add.bind(super::random::token()?).bind(now()).execute(connection).await?;
    Ok(())
}

/// Format 1 had one table, whose indices keep their names.
const OUT_OF_THE_WAY: [&str; 5] = [
    "DROP TRIGGER submission_is_immutable",
    "DROP TRIGGER submission_is_kept",
    "DROP INDEX submission_by_student",
    "DROP INDEX submission_by_lesson",
    "ALTER TABLE submission RENAME TO submission_1",
];

/// Each row of format 1 becomes a submission, its verdict and an event, in the order in which they came.
async fn carry_over(connection: &mut AnyConnection) -> Result<(), StoreError> {
    const ROWS: &str =
        "SELECT id, lesson, student, submitted_at, answers, verdict FROM submission_1 ORDER BY rowid";
    for row in sqlx::query(ROWS).fetch_all(&mut *connection).await? {
        let (id, slug, student): (String, String, String) =
            (row.try_get(0)?, row.try_get(1)?, row.try_get(2)?);
        let (at, answers, body): (String, String, String) =
            (row.try_get(3)?, row.try_get(4)?, row.try_get(5)?);
        let received: i64 = at.parse::<jiff::Timestamp>().map_or(0, jiff::Timestamp::as_millisecond);
        let person = super::submissions::person_of(connection, HOME, &student, received).await?;
        let assignment = super::class::assignments::ensured(connection, HOME, &slug).await?.id;
        let submission = SubmissionRow {
            id,
            assignment,
            person,
            received_at: received,
            student,
            answers,
            request_key: None,
            counted: 1,
        };
        // Format 1 did not keep lessons: what graded these is known by its short fingerprint in the verdict alone.
        let build = serde_json::from_str::<serde_json::Value>(&body).unwrap_or_default();
        let build = build["provenance"]["engine"].as_str().unwrap_or_default().to_owned();
        let verdict = VerdictRow::first(&submission.id, body, String::new(), &build, received);
        let detail = records::seal(&submission, &verdict);
        let event =
            Event { actor: &submission.person, what: "submitted", subject: &submission.id, detail: &detail };
        let n = log::append(connection, HOME, received, &event).await?;
        submission.add(connection, n).await?;
        verdict.add(connection).await?;
    }
    let event = Event { actor: "triad", what: "migrated", subject: HOME, detail: "from format 1" };
    log::append(connection, HOME, now(), &event).await?;
    Ok(())
}
