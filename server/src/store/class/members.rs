//! Who belongs to a course.

use sqlx::AnyConnection;

use crate::store::error::StoreError;
use crate::store::sql;

/// Errors if the person is not in the course.
pub(in crate::store) async fn known(
    connection: &mut AnyConnection,
    course: &str,
    person: &str,
) -> Result<(), StoreError> {
    let find = sqlx::query_as(sql::MEMBER).bind(course).bind(person).fetch_optional(connection).await?;
    let found: Option<(String,)> = find;
    found.map(drop).ok_or(StoreError::Unknown("person in this course"))
}
