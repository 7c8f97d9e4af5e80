//! What belongs to a course, table by table.

use serde_json::{Map, Value};
use sqlx::any::{AnyRow, AnyTypeInfoKind};
use sqlx::{Column, Row, ValueRef};

use super::super::error::StoreError;

/// Tables with their rows that belong to the course `$1`, in the order in which they refer to each other.
pub(in crate::store) const OF_COURSE: &[(&str, &str)] = &[
    ("course", "SELECT * FROM course WHERE id = $1"),
    (
        "person",
        "SELECT p.* FROM person p JOIN membership m ON m.person = p.id WHERE m.course = $1 ORDER BY p.id",
    ),
    ("membership", "SELECT * FROM membership WHERE course = $1 ORDER BY person"),
    (
        "identity",
        "SELECT i.* FROM identity i JOIN membership m ON m.person = i.person WHERE m.course = $1 \
         ORDER BY i.kind, i.subject",
    ),
    (
        "lesson_version",
        "SELECT * FROM lesson_version WHERE sha256 IN (SELECT v.lesson_sha256 FROM verdict v \
         JOIN submission s ON s.id = v.submission JOIN assignment a ON a.id = s.assignment WHERE a.course = $1) \
         OR sha256 IN (SELECT lesson_sha256 FROM grading WHERE course = $1) ORDER BY sha256",
    ),
    ("assignment", "SELECT * FROM assignment WHERE course = $1 ORDER BY id"),
    (
        "submission",
        "SELECT s.* FROM submission s JOIN assignment a ON a.id = s.assignment WHERE a.course = $1 \
         ORDER BY s.n",
    ),
    (
        "verdict",
        "SELECT v.* FROM verdict v JOIN submission s ON s.id = v.submission JOIN assignment a ON a.id = s.assignment \
         WHERE a.course = $1 ORDER BY s.n, v.run",
    ),
    ("decision", "SELECT * FROM decision WHERE course = $1 ORDER BY n"),
    (
        "extension",
        "SELECT e.* FROM extension e JOIN assignment a ON a.id = e.assignment WHERE a.course = $1 \
         ORDER BY e.assignment, e.person",
    ),
    ("regrade", "SELECT * FROM regrade WHERE course = $1 ORDER BY n"),
    (
        "regraded",
        "SELECT d.* FROM regraded d JOIN regrade r ON r.id = d.regrade WHERE r.course = $1 \
         ORDER BY d.regrade, d.person",
    ),
    ("prediction", "SELECT * FROM prediction WHERE course = $1 ORDER BY n"),
    ("grading", "SELECT * FROM grading WHERE course = $1 ORDER BY n"),
    ("event", "SELECT * FROM event WHERE course = $1 ORDER BY n"),
    ("lti_platform", "SELECT * FROM lti_platform WHERE course = $1 ORDER BY id"),
    (
        "lti_context",
        "SELECT c.* FROM lti_context c JOIN lti_platform p ON p.id = c.platform WHERE p.course = $1 \
         ORDER BY c.platform, c.context",
    ),
    (
        "lti_column",
        "SELECT c.* FROM lti_column c JOIN lti_platform p ON p.id = c.platform WHERE p.course = $1 \
         ORDER BY c.platform, c.context, c.slug, c.url",
    ),
    (
        "lti_person",
        "SELECT l.* FROM lti_person l JOIN membership m ON m.person = l.person WHERE m.course = $1 \
         ORDER BY l.platform, l.context, l.subject",
    ),
    (
        "lti_score",
        "SELECT s.* FROM lti_score s JOIN lti_platform p ON p.id = s.platform WHERE p.course = $1 \
         ORDER BY s.platform, s.url, s.person",
    ),
];

/// Tables that are not taken along: sessions and the keys to a learning platform are for one server, invitations for one place,
/// what is judged again is asked for anew, servers are where they are, and a room's name is part of an address there.
#[cfg(test)]
pub(in crate::store) const LEFT: &[&str] =
    &["session", "invitation", "lti_key", "lti_nonce", "judging", "node", "room"];

/// A row as JSON, by the names of its columns.
///
/// Errors if something stands in it that no column of ours has.
pub(super) fn as_json(row: &AnyRow) -> Result<Map<String, Value>, StoreError> {
    let value = |index: usize| -> Result<Value, sqlx::Error> {
        let raw = row.try_get_raw(index)?;
        if raw.is_null() {
            return Ok(Value::Null);
        }
        Ok(match raw.type_info().kind() {
            AnyTypeInfoKind::BigInt => Value::from(row.try_get_unchecked::<i64, _>(index)?),
            AnyTypeInfoKind::Double => Value::from(row.try_get_unchecked::<f64, _>(index)?),
            _ => Value::from(row.try_get_unchecked::<String, _>(index)?),
        })
    };
    let named = row.columns().iter().map(|column| Ok((column.name().to_owned(), value(column.ordinal())?)));
    named.collect::<Result<_, sqlx::Error>>().map_err(StoreError::from)
}
