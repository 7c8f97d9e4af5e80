//! What everybody has reached, and what people decided about it.

use sqlx::SqliteConnection;

use super::error::StoreError;
use super::log::{self, Event};
use super::submissions::assignment;
use super::{Store, identifier, now, sql};

/// What a person has reached in a lesson.
#[derive(Debug, Clone, PartialEq)]
pub struct Standing {
    /// The person's id.
    pub person: String,
    /// Slug of the lesson.
    pub lesson: String,
    /// Submissions that count as attempts.
    pub attempts: i64,
    /// Most points of an attempt.
    pub best: f64,
    /// Points that can be earned.
    pub possible: f64,
    /// Whether an attempt was enough to pass.
    pub passed: bool,
    /// When the last submission came, in milliseconds since 1970.
    pub last: i64,
}

/// What somebody decided about a person's work in a lesson; later decisions replace earlier ones.
#[derive(Debug, Clone, PartialEq)]
pub struct Decision {
    /// The person whom it is about.
    pub person: String,
    /// Slug of the lesson.
    pub lesson: String,
    /// The points that count instead; `None`: those that were earned.
    pub points: Option<f64>,
    /// Why.
    pub reason: String,
    /// Name of who decided.
    pub by: String,
    /// When, in milliseconds since 1970.
    pub at: i64,
}

impl Store {
    /// What everybody has reached in every lesson in which they handed in.
    ///
    /// Errors if the file cannot be read.
    pub async fn standings(&self, course: &str) -> Result<Vec<Standing>, StoreError> {
        let rows: Vec<(String, String, i64, f64, f64, i64, i64)> =
            sqlx::query_as(sql::STANDINGS).bind(course).fetch_all(&self.readers).await?;
        let standing = |(person, lesson, attempts, best, possible, passed, last)| Standing {
            person,
            lesson,
            attempts,
            best,
            possible,
            passed: passed == 1,
            last,
        };
        Ok(rows.into_iter().map(standing).collect())
    }

    /// All decisions of a course, in the order in which they were made.
    ///
    /// Errors if the file cannot be read.
    pub async fn decisions(&self, course: &str) -> Result<Vec<Decision>, StoreError> {
        let rows: Vec<(String, String, Option<f64>, String, String, i64)> =
            sqlx::query_as(sql::DECISIONS).bind(course).fetch_all(&self.readers).await?;
        let decision =
            |(person, lesson, points, reason, by, at)| Decision { person, lesson, points, reason, by, at };
        Ok(rows.into_iter().map(decision).collect())
    }

    /// Writes down a decision: points that count instead of those that were earned, or `None` to take such a decision back.
    ///
    /// Errors if there is no such person or it cannot be written.
    pub async fn decide(
        &self,
        course: &str,
        actor: &str,
        person: &str,
        lesson: &str,
        points: Option<f64>,
        reason: &str,
    ) -> Result<(), StoreError> {
        let mut transaction = self.write().await?;
        decide(&mut transaction, course, actor, person, lesson, points, reason).await?;
        transaction.commit().await
    }
}

async fn decide(
    connection: &mut SqliteConnection,
    course: &str,
    actor: &str,
    person: &str,
    lesson: &str,
    points: Option<f64>,
    reason: &str,
) -> Result<(), StoreError> {
    let at = now();
    let detail = serde_json::json!([lesson, points, reason]).to_string();
    let event = Event { actor, what: "decided about", subject: person, detail: &detail };
    let n = log::append(connection, course, at, &event).await?;
    super::people::known(connection, course, person).await?;
    let (assignment, _) = assignment(connection, course, lesson).await?;
    let add = sqlx::query(sql::ADD_DECISION).bind(identifier()).bind(course).bind(n).bind("points");
    let add = add.bind(person).bind(assignment).bind(points).bind(reason).bind(actor).bind(at);
    add.execute(connection).await?;
    Ok(())
}
