//! The log of a course: who did what, each entry with a hash over itself and the entry before.

use sqlx::AnyConnection;

use super::error::StoreError;
use super::hash::sha256;
use super::sql;

/// What the log says where somebody's data were erased.
pub(super) const ERASED: &str = "erased";

/// Something that somebody did.
#[derive(Debug, Clone, Copy)]
pub(super) struct Event<'a> {
    /// Who: a person's id, or `triad` for the program itself.
    pub(super) actor: &'a str,
    /// A verb in the past tense.
    pub(super) what: &'a str,
    /// The id of what it was done to.
    pub(super) subject: &'a str,
    /// What is worth knowing later.
    pub(super) detail: &'a str,
}

/// Holds the course until the end of the transaction: what looks before it writes finds what others wrote at the same time.
pub(super) async fn hold(connection: &mut AnyConnection, course: &str) -> Result<(), StoreError> {
    sqlx::query(sql::HOLD_COURSE).bind(course).execute(connection).await?;
    Ok(())
}

/// Adds an entry; its number. The course is held until the end of the transaction, so that whatever follows in it is done
/// by one at a time.
pub(super) async fn append(
    connection: &mut AnyConnection,
    course: &str,
    at: i64,
    event: &Event<'_>,
) -> Result<i64, StoreError> {
    let next = sqlx::query_as(sql::NEXT_EVENT).bind(course).fetch_optional(&mut *connection).await?;
    let (n, before): (i64, String) = next.ok_or(StoreError::Unknown("course"))?;
    let hash = link(&before, course, n, at, event);
    let add = sqlx::query(sql::ADD_EVENT).bind(course).bind(n).bind(at).bind(event.actor).bind(event.what);
    add.bind(event.subject).bind(event.detail).bind(&hash).execute(&mut *connection).await?;
    sqlx::query(sql::SET_CHAIN).bind(course).bind(&hash).execute(&mut *connection).await?;
    Ok(n)
}

/// The hash of an entry, from that of the entry before.
pub(super) fn link(before: &str, course: &str, n: i64, at: i64, event: &Event<'_>) -> String {
    let Event { actor, what, subject, detail } = event;
    // As JSON no two entries have the same text.
    sha256(&serde_json::json!([before, course, n, at, actor, what, subject, detail]).to_string())
}
