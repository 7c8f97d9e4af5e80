//! How much is kept, of each person and in all: a disk that somebody fills on purpose would keep nobody's work.

use sqlx::AnyConnection;

use super::error::StoreError;
use super::file::Place;
use super::sql;

/// Bounds of what is kept.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Quotas {
    /// Submissions of one person in all lessons.
    pub person_submissions: u64,
    /// Bytes of one person's answers, files among them.
    pub person_bytes: u64,
    /// Bytes of the whole gradebook.
    pub file_bytes: u64,
}

impl Default for Quotas {
    fn default() -> Self {
        // A term of thirty lessons takes some hundred submissions and some megabytes.
        Self { person_submissions: 5000, person_bytes: 64 << 20, file_bytes: 16 << 30 }
    }
}

impl Quotas {
    /// Errors if the gradebook is as large as it may become.
    pub(super) fn check_file(&self, place: Option<&Place>) -> Result<(), StoreError> {
        let bytes = place.map_or(0, Place::bytes);
        if bytes < self.file_bytes {
            return Ok(());
        }
        Err(StoreError::QuotaUsed(format!(
            "the gradebook has {} MB, as many as it may have",
            self.file_bytes >> 20
        )))
    }

    /// Errors if the person has handed in as much as is kept of one, with `more` bytes.
    pub(super) async fn check_person(
        &self,
        connection: &mut AnyConnection,
        person: &str,
        more: usize,
    ) -> Result<(), StoreError> {
        let kept = sqlx::query_as(sql::KEPT_OF_PERSON).bind(person);
        let (count, bytes): (i64, i64) = kept.fetch_one(connection).await?;
        let after = bytes.unsigned_abs().saturating_add(more as u64);
        if count.unsigned_abs() < self.person_submissions && after <= self.person_bytes {
            return Ok(());
        }
        Err(StoreError::QuotaUsed(format!(
            "{count} submissions of this person take {} MB: {} and {} MB are kept of one",
            bytes >> 20,
            self.person_submissions,
            self.person_bytes >> 20
        )))
    }
}
