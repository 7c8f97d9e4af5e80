//! How lessons are assigned: policies, releases, extensions.

use sqlx::AnyConnection;

use crate::policy::{Extension, Moment, Policy};
use crate::store::error::StoreError;
use crate::store::hash::sha256;
use crate::store::log::{self, Event};
use crate::store::rulings::{self, EXTENDED, HELD_BACK, RELEASED, SET_POLICY, TOOK_BACK};
use crate::store::{Store, identifier, now, sql};

use super::members::known;

/// A lesson as it is assigned.
#[derive(Debug, Clone, PartialEq)]
pub struct Assignment {
    /// Its id.
    pub id: String,
    /// Slug of the lesson.
    pub lesson: String,
    /// What is set.
    pub policy: Policy,
    /// When its results were released, if they were.
    pub released: Option<Moment>,
}

impl Assignment {
    /// A lesson for which nothing was set.
    pub fn of(lesson: &str) -> Self {
        Self { id: String::new(), lesson: lesson.to_owned(), policy: Policy::default(), released: None }
    }

    /// The name of what is set: another policy has another.
    pub fn version(&self) -> String {
        // As JSON it has no maps whose order could differ, and nothing in it fails to be written.
        sha256(&serde_json::to_string(&self.policy).unwrap_or_default())
    }
}

type Row = (String, String, String, Option<i64>);

fn assignment((id, lesson, policy, released): Row) -> Result<Assignment, StoreError> {
    let policy = serde_json::from_str(&policy)
        .map_err(|cause| StoreError::Damaged(format!("the policy of {lesson}: {cause}")))?;
    Ok(Assignment { id, lesson, policy, released: released.map(Moment) })
}

impl Store {
    /// The assignments of a course: of each lesson in which somebody handed in or something was set.
    ///
    /// Errors if the file cannot be read.
    pub async fn assignments(&self, course: &str) -> Result<Vec<Assignment>, StoreError> {
        let rows: Vec<Row> =
            sqlx::query_as(sql::ASSIGNMENTS).bind(course).fetch_all(&self.pools.readers).await?;
        rows.into_iter().map(assignment).collect()
    }

    /// How a lesson is assigned; as every lesson is where nothing was set.
    ///
    /// Errors if the file cannot be read.
    pub async fn assignment(&self, course: &str, lesson: &str) -> Result<Assignment, StoreError> {
        found(&mut *self.pools.readers.acquire().await?, course, lesson).await
    }

    /// Sets the policy of a lesson, in the place of the one that is named, or of whichever there is; the version of the new one.
    ///
    /// Errors if there is another than `before`, or it cannot be written.
    pub async fn set_policy(
        &self,
        course: &str,
        actor: &str,
        lesson: &str,
        policy: &Policy,
        before: Option<&str>,
    ) -> Result<String, StoreError> {
        let text = serde_json::to_string(policy).map_err(|cause| StoreError::Sql(cause.to_string()))?;
        let mut transaction = self.write().await?;
        let event = Event { actor, what: SET_POLICY, subject: lesson, detail: &text };
        log::append(&mut transaction, course, now(), &event).await?;
        let found = ensured(&mut transaction, course, lesson).await?;
        if before.is_some_and(|before| before != found.version()) {
            return Err(StoreError::PolicyChanged);
        }
        sqlx::query(sql::SET_POLICY).bind(&found.id).bind(&text).execute(&mut *transaction).await?;
        transaction.commit().await?;
        Ok(Assignment { policy: policy.clone(), ..found }.version())
    }

    /// Releases the results of a lesson, or takes that back.
    ///
    /// Errors if it cannot be written.
    pub async fn release(
        &self,
        course: &str,
        actor: &str,
        lesson: &str,
        released: bool,
    ) -> Result<(), StoreError> {
        let at = now();
        let mut transaction = self.write().await?;
        let what = if released { RELEASED } else { HELD_BACK };
        log::append(&mut transaction, course, at, &Event { actor, what, subject: lesson, detail: "" })
            .await?;
        let id = ensured(&mut transaction, course, lesson).await?.id;
        let set = sqlx::query(sql::SET_RELEASED).bind(id).bind(released.then_some(at));
        set.execute(&mut *transaction).await?;
        transaction.commit().await
    }

    /// The extensions of a course, or of one person or lesson, with person and lesson.
    ///
    /// Errors if the file cannot be read.
    pub async fn extensions(
        &self,
        course: &str,
        person: Option<&str>,
        lesson: Option<&str>,
    ) -> Result<Vec<(String, String, Extension)>, StoreError> {
        extensions(&mut *self.pools.readers.acquire().await?, course, person, lesson).await
    }

    /// Allows somebody more time or attempts at a lesson, as follows from the policy and what was allowed before; `None` takes it
    /// back. Its `by` and `at` are the actor and now.
    ///
    /// Errors if there is no such person, `change` refuses it, or it cannot be written.
    pub async fn extend<E: From<StoreError>>(
        &self,
        course: &str,
        actor: &str,
        person: &str,
        lesson: &str,
        change: impl FnOnce(&Policy, Option<Extension>) -> Result<Option<Extension>, E>,
    ) -> Result<(), E> {
        let at = now();
        let mut transaction = self.write().await?;
        log::hold(&mut transaction, course).await?;
        known(&mut transaction, course, person).await?;
        let Assignment { id, policy, .. } = ensured(&mut transaction, course, lesson).await?;
        let given = change(&policy, extension_of(&mut transaction, &id, person).await?)?;
        let given = given.as_ref();
        let detail = given.map(|given| (given.until, i64::from(given.attempts), given.reason.as_str()));
        let detail = rulings::extension(lesson, detail).to_string();
        let what = if given.is_some() { EXTENDED } else { TOOK_BACK };
        log::append(&mut transaction, course, at, &Event { actor, what, subject: person, detail: &detail })
            .await?;
        let remove = sqlx::query(sql::REMOVE_EXTENSION).bind(&id).bind(person);
        remove.execute(&mut *transaction).await.map_err(StoreError::from)?;
        if let Some(given) = given {
            let add = sqlx::query(sql::ADD_EXTENSION).bind(&id).bind(person).bind(given.until.map(|at| at.0));
            let add = add.bind(i64::from(given.attempts)).bind(&given.reason).bind(actor).bind(at);
            add.execute(&mut *transaction).await.map_err(StoreError::from)?;
        }
        Ok(transaction.commit().await?)
    }
}

fn extension((until, attempts, reason, by, at): (Option<i64>, i64, String, String, i64)) -> Extension {
    let attempts = u32::try_from(attempts).unwrap_or_default();
    Extension { until: until.map(Moment), attempts, reason, by, at: Moment(at) }
}

/// How a lesson is assigned; as every lesson is where nothing was set.
pub(super) async fn found(
    connection: &mut AnyConnection,
    course: &str,
    lesson: &str,
) -> Result<Assignment, StoreError> {
    let find = sqlx::query_as(sql::ASSIGNMENT).bind(course).bind(lesson);
    let found: Option<Row> = find.fetch_optional(connection).await?;
    found.map_or_else(|| Ok(Assignment::of(lesson)), assignment)
}

/// The extensions of a course, or of one person or lesson, with person and lesson.
pub(super) async fn extensions(
    connection: &mut AnyConnection,
    course: &str,
    person: Option<&str>,
    lesson: Option<&str>,
) -> Result<Vec<(String, String, Extension)>, StoreError> {
    type Row = (String, String, Option<i64>, i64, String, String, i64);
    let list = sqlx::query_as(sql::EXTENSIONS).bind(course).bind(person).bind(lesson);
    let rows: Vec<Row> = list.fetch_all(connection).await?;
    let read = |(person, lesson, until, attempts, reason, by, at): Row| {
        (person, lesson, extension((until, attempts, reason, by, at)))
    };
    Ok(rows.into_iter().map(read).collect())
}

/// What somebody is allowed beyond the others.
pub(in crate::store) async fn extension_of(
    connection: &mut AnyConnection,
    assignment: &str,
    person: &str,
) -> Result<Option<Extension>, StoreError> {
    let find = sqlx::query_as(sql::EXTENSION).bind(assignment).bind(person);
    Ok(find.fetch_optional(connection).await?.map(extension))
}

/// The assignment of a lesson; made when it is first needed.
pub(in crate::store) async fn ensured(
    connection: &mut AnyConnection,
    course: &str,
    slug: &str,
) -> Result<Assignment, StoreError> {
    let add = sqlx::query(sql::ADD_ASSIGNMENT).bind(identifier()).bind(course).bind(slug);
    add.execute(&mut *connection).await?;
    let find = sqlx::query_as(sql::ASSIGNMENT).bind(course).bind(slug);
    assignment(find.fetch_one(&mut *connection).await?)
}
