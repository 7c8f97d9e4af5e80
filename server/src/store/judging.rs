//! What is judged again: for a regrade, by whoever grades, after all that students wait for.
//!
//! A judgement follows from the submission, the lesson and the program alone: who does it twice writes the same, so that a claim
//! needs no fence, and what one regrade asked for serves the next.

use std::time::Duration;

use super::database;
use super::error::StoreError;
use super::kind::Kind;
use super::queue::{STARTS, milliseconds};
use super::{Store, sql};

/// Judgements that nobody asked for since, are forgotten: milliseconds, a day.
const KEPT: i64 = 86_400_000;

/// What is to be judged again.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct NewJudging {
    /// The submission.
    pub submission: String,
    /// SHA-256 of the lesson that is to judge it.
    pub lesson_sha256: String,
}

/// What was claimed to be judged again.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Judging {
    /// The submission.
    pub submission: String,
    /// SHA-256 of the lesson that is to judge it.
    pub lesson_sha256: String,
    /// Which start this is; the first is 1.
    start: i64,
    /// What was handed in, as JSON.
    pub answers: String,
    /// What its numbers were drawn from.
    pub seed: String,
}

/// What came of it: `None` where its graders ended three times.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Outcome {
    /// The submission.
    pub submission: String,
    /// What the grader wrote.
    pub told: Option<String>,
}

impl Store {
    /// Asks for judgements by this program, unless they are there, and once more for those that were put aside; `lessons` are those that may not be kept yet, with SHA-256,
    /// slug and bundle.
    ///
    /// Errors if it cannot be written.
    pub async fn ask_judgings(
        &self,
        lessons: &[(String, String, String)],
        wanted: &[NewJudging],
    ) -> Result<(), StoreError> {
        let mut transaction = self.write().await?;
        let at = database::clock(&mut transaction).await?;
        sqlx::query(sql::FORGET_JUDGED).bind(at - KEPT).execute(&mut *transaction).await?;
        for (sha256, slug, bundle) in lessons {
            let add = sqlx::query(sql::ADD_LESSON).bind(sha256).bind(slug).bind(bundle);
            add.bind(at).execute(&mut *transaction).await?;
        }
        for one in wanted {
            let add = sqlx::query(sql::ADD_JUDGING).bind(&one.submission).bind(&one.lesson_sha256);
            add.bind(crate::BUILD).bind(at).execute(&mut *transaction).await?;
        }
        self.wake(&mut transaction).await?;
        transaction.commit().await?;
        self.work.notify_one();
        Ok(())
    }

    /// Claims what is to be judged again by this program, if no student waits or `all_the_same`; at most so many.
    ///
    /// Errors if it cannot be written.
    pub async fn claim_judgings(
        &self,
        lease: Duration,
        most: i64,
        all_the_same: bool,
    ) -> Result<Vec<Judging>, StoreError> {
        let (open,): (i64,) = sqlx::query_as(sql::OPEN_JUDGINGS)
            .bind(crate::BUILD)
            .bind(STARTS)
            .fetch_one(&self.pools.readers)
            .await?;
        if open == 0 {
            return Ok(Vec::new());
        }
        let mut transaction = self.write().await?;
        let at = database::clock(&mut transaction).await?;
        let wait = sqlx::query_as(sql::STUDENTS_WAIT).bind(at).bind(STARTS).fetch_one(&mut *transaction);
        let (waiting,): (i64,) = wait.await?;
        if waiting > 0 && !all_the_same {
            return Ok(Vec::new());
        }
        let text = match Kind::of(&transaction) {
            Kind::Sqlite => sql::CLAIM_JUDGINGS,
            Kind::Postgres => sql::CLAIM_JUDGINGS_OF_MANY,
        };
        let claim = sqlx::query_as(text).bind(crate::BUILD).bind(at).bind(STARTS);
        let claim = claim.bind(at + milliseconds(lease)).bind(most);
        let rows: Vec<(String, String, i64, String, String)> = claim.fetch_all(&mut *transaction).await?;
        transaction.commit().await?;
        let read = |(submission, lesson_sha256, start, answers, seed)| Judging {
            submission,
            lesson_sha256,
            start,
            answers,
            seed,
        };
        Ok(rows.into_iter().map(read).collect())
    }

    /// Whether a student waits whose submission nobody grades yet.
    ///
    /// Errors if it cannot be read.
    pub async fn students_wait(&self) -> Result<bool, StoreError> {
        let mut connection = self.pools.readers.acquire().await?;
        let at = database::clock(&mut connection).await?;
        let count = sqlx::query_as(sql::STUDENTS_WAIT).bind(at).bind(STARTS).fetch_one(&mut *connection);
        let (waiting,): (i64,) = count.await?;
        Ok(waiting > 0)
    }

    /// Keeps what came of those that were judged, and leaves the others to whoever claims them next.
    ///
    /// Errors if it cannot be written.
    pub async fn keep_judgings(
        &self,
        judged: &[(Judging, String)],
        left: &[Judging],
    ) -> Result<(), StoreError> {
        let mut transaction = self.write().await?;
        for (one, outcome) in judged {
            let keep = sqlx::query(sql::KEEP_JUDGING).bind(&one.submission).bind(&one.lesson_sha256);
            keep.bind(crate::BUILD).bind(outcome).execute(&mut *transaction).await?;
        }
        for one in left {
            let leave = sqlx::query(sql::LEAVE_JUDGING).bind(&one.submission).bind(&one.lesson_sha256);
            leave.bind(crate::BUILD).bind(one.start).execute(&mut *transaction).await?;
        }
        transaction.commit().await
    }

    /// How many of this program's judgements by a lesson are still to be made.
    ///
    /// Errors if they cannot be read.
    pub async fn judgings_open(&self, lesson_sha256: &str) -> Result<i64, StoreError> {
        let mut connection = self.pools.readers.acquire().await?;
        let at = database::clock(&mut connection).await?;
        let count =
            sqlx::query_as(sql::JUDGINGS_OPEN).bind(lesson_sha256).bind(crate::BUILD).bind(STARTS).bind(at);
        let (open,): (i64,) = count.fetch_one(&mut *connection).await?;
        Ok(open)
    }

    /// What this program's judgements by a lesson came to, as far as they are done.
    ///
    /// Errors if they cannot be read.
    pub async fn judged(&self, lesson_sha256: &str) -> Result<Vec<Outcome>, StoreError> {
        let mut connection = self.pools.readers.acquire().await?;
        let at = database::clock(&mut connection).await?;
        let list = sqlx::query_as(sql::JUDGED).bind(lesson_sha256).bind(crate::BUILD).bind(STARTS).bind(at);
        let rows: Vec<(String, Option<String>)> = list.fetch_all(&mut *connection).await?;
        Ok(rows.into_iter().map(|(submission, told)| Outcome { submission, told }).collect())
    }
}
