//! Versions of lessons, as they were when they graded something.

use std::sync::PoisonError;

use triad_lessons::Lesson;

use super::error::StoreError;
use super::hash::sha256;
use super::{Store, now, sql};

impl Store {
    /// The lesson of that SHA-256, as it was when it graded something.
    ///
    /// Errors if it is not kept or the file cannot be read.
    pub async fn lesson_version(&self, sha256: &str) -> Result<String, StoreError> {
        let found = sqlx::query_as(sql::LESSON).bind(sha256).fetch_optional(&self.pools.readers).await?;
        found.map(|(bundle,)| bundle).ok_or(StoreError::Unknown("version of a lesson"))
    }

    /// The versions of a lesson that are kept, as bundles, the earliest first.
    ///
    /// Errors if the file cannot be read.
    pub async fn lesson_versions(&self, slug: &str) -> Result<Vec<String>, StoreError> {
        let list = sqlx::query_as(sql::LESSON_VERSIONS).bind(slug);
        let found: Vec<(String,)> = list.fetch_all(&self.pools.readers).await?;
        Ok(found.into_iter().map(|(bundle,)| bundle).collect())
    }

    /// Keeps a version of a lesson before anything is handed in.
    ///
    /// Errors if it cannot be written.
    pub async fn keep_lesson(&self, slug: &str, bundle: &str) -> Result<(), StoreError> {
        let mut transaction = self.write().await?;
        let add = sqlx::query(sql::ADD_LESSON).bind(sha256(bundle)).bind(slug).bind(bundle);
        add.bind(now()).execute(&mut *transaction).await?;
        transaction.commit().await
    }

    /// What share of its points was enough to pass the lesson of that SHA-256; none where it is not kept, as in format 1, or
    /// this program cannot read it.
    ///
    /// Errors if the file cannot be read.
    pub async fn pass_mark(&self, sha256: &str) -> Result<Option<f64>, StoreError> {
        if sha256.is_empty() {
            return Ok(None);
        }
        let known = self.pass_marks.lock().unwrap_or_else(PoisonError::into_inner).get(sha256).copied();
        if let Some(known) = known {
            return Ok(known);
        }
        let found = sqlx::query_as(sql::LESSON).bind(sha256).fetch_optional(&self.pools.readers).await?;
        let Some((bundle,)): Option<(String,)> = found else { return Ok(None) };
        let read = move || Lesson::from_bundle(&bundle).ok().map(|lesson| lesson.exercise.pass_mark);
        let reading = tokio::task::spawn_blocking(read).await;
        let mark = reading.map_err(|cause| StoreError::Damaged(cause.to_string()))?;
        let mut known = self.pass_marks.lock().unwrap_or_else(PoisonError::into_inner);
        known.insert(sha256.to_owned(), mark);
        Ok(mark)
    }
}
