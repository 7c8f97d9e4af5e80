//! What is never changed: rows of submissions, predictions and verdicts, with a hash over all that they say.

use serde_json::{Value, json};
use sqlx::any::AnyRow;
use sqlx::{AnyConnection, FromRow, Row};

use super::error::StoreError;
use super::hash::sha256;
use super::sql;

/// A submission as its row says it, but for its place in the log.
#[derive(Debug, Clone)]
pub(super) struct SubmissionRow {
    pub(super) id: String,
    pub(super) assignment: String,
    pub(super) person: String,
    pub(super) received_at: i64,
    pub(super) student: String,
    pub(super) answers: String,
    pub(super) request_key: Option<String>,
    /// 1 if it counts as an attempt.
    pub(super) counted: i64,
}

impl FromRow<'_, AnyRow> for SubmissionRow {
    fn from_row(row: &AnyRow) -> Result<Self, sqlx::Error> {
        Ok(Self {
            id: row.try_get("id")?,
            assignment: row.try_get("assignment")?,
            person: row.try_get("person")?,
            received_at: row.try_get("received_at")?,
            student: row.try_get("student")?,
            answers: row.try_get("answers")?,
            request_key: row.try_get("request_key")?,
            counted: row.try_get("counted")?,
        })
    }
}

impl SubmissionRow {
    /// A hash over all of it.
    pub(super) fn hash(&self) -> String {
        let Self { id, assignment, person, received_at, student, answers, request_key, counted } = self;
        let all = json!([id, assignment, person, received_at, student, answers, request_key, counted]);
        sha256(&all.to_string())
    }

    /// Adds it as the entry `n` of its course's log says.
    pub(super) async fn add(&self, connection: &mut AnyConnection, n: i64) -> Result<(), StoreError> {
        let add = sqlx::query(sql::ADD_SUBMISSION).bind(&self.id).bind(&self.assignment).bind(&self.person);
        let add = add.bind(n).bind(self.received_at).bind(&self.student).bind(&self.answers);
        add.bind(&self.request_key).bind(self.counted).execute(connection).await?;
        Ok(())
    }
}

/// A prediction as its row says it, but for its place in the log.
#[derive(Debug, Clone)]
pub(super) struct PredictionRow {
    pub(super) course: String,
    pub(super) person: String,
    pub(super) slug: String,
    pub(super) prediction: String,
    /// None was made where this is `None`.
    pub(super) choice: Option<String>,
    pub(super) why: String,
    pub(super) given_at: i64,
}

impl FromRow<'_, AnyRow> for PredictionRow {
    fn from_row(row: &AnyRow) -> Result<Self, sqlx::Error> {
        Ok(Self {
            course: row.try_get("course")?,
            person: row.try_get("person")?,
            slug: row.try_get("slug")?,
            prediction: row.try_get("prediction")?,
            choice: row.try_get("choice")?,
            why: row.try_get("why")?,
            given_at: row.try_get("given_at")?,
        })
    }
}

impl PredictionRow {
    /// What the log calls it.
    pub(super) fn subject(&self) -> String {
        format!("{}/{}", self.slug, self.prediction)
    }

    /// A hash over all of it.
    pub(super) fn hash(&self) -> String {
        let Self { course, person, slug, prediction, choice, why, given_at } = self;
        sha256(&json!([course, person, slug, prediction, choice, why, given_at]).to_string())
    }

    /// Adds it as the entry `n` of its course's log says.
    pub(super) async fn add(&self, connection: &mut AnyConnection, n: i64) -> Result<(), StoreError> {
        let add = sqlx::query(sql::ADD_PREDICTION).bind(&self.course).bind(&self.person).bind(&self.slug);
        let add = add.bind(&self.prediction).bind(&self.choice).bind(&self.why).bind(n).bind(self.given_at);
        add.execute(connection).await?;
        Ok(())
    }
}

/// A verdict as its row says it.
#[derive(Debug, Clone)]
pub(super) struct VerdictRow {
    pub(super) submission: String,
    /// 0 for the first; each regrade adds one.
    pub(super) run: i64,
    /// What was told, as JSON, without the right answers.
    pub(super) body: String,
    /// The lesson that graded it.
    pub(super) lesson_sha256: String,
    /// The program that graded it.
    pub(super) build: String,
    pub(super) seed: String,
    /// The numbers that were drawn, as JSON.
    pub(super) parameters: String,
    pub(super) earned: f64,
    pub(super) possible: f64,
    /// 1 if it was enough to pass.
    pub(super) passed: i64,
    pub(super) made_at: i64,
    /// Its place in the log where it is not the submission's, else 0.
    pub(super) n: i64,
    /// 1 if the submission counts as an attempt by this verdict; `None` where the submission itself says it.
    pub(super) counted: Option<i64>,
}

impl FromRow<'_, AnyRow> for VerdictRow {
    fn from_row(row: &AnyRow) -> Result<Self, sqlx::Error> {
        Ok(Self {
            submission: row.try_get("submission")?,
            run: row.try_get("run")?,
            body: row.try_get("body")?,
            lesson_sha256: row.try_get("lesson_sha256")?,
            build: row.try_get("build")?,
            seed: row.try_get("seed")?,
            parameters: row.try_get("parameters")?,
            earned: row.try_get("earned")?,
            possible: row.try_get("possible")?,
            passed: row.try_get("passed")?,
            made_at: row.try_get("made_at")?,
            n: row.try_get("n")?,
            counted: row.try_get("counted")?,
        })
    }
}

impl VerdictRow {
    /// The first verdict on a submission, from what was told.
    pub(super) fn first(
        submission: &str,
        body: String,
        lesson_sha256: String,
        build: &str,
        made_at: i64,
    ) -> Self {
        let told: Value = serde_json::from_str(&body).unwrap_or_default();
        let about = &told["provenance"];
        Self {
            submission: submission.to_owned(),
            run: 0,
            lesson_sha256,
            build: build.to_owned(),
            seed: about["seed"].as_str().unwrap_or_default().to_owned(),
            parameters: about["parameters"].to_string(),
            earned: told["earned"].as_f64().unwrap_or_default(),
            possible: told["possible"].as_f64().unwrap_or_default(),
            passed: i64::from(told["passed"] == true),
            made_at,
            body,
            n: 0,
            counted: None,
        }
    }

    /// A hash over all of it but its place in the log.
    pub(super) fn hash(&self) -> String {
        let Self { submission, run, body, lesson_sha256, build, seed, parameters, .. } = self;
        let Self { earned, possible, passed, made_at, counted, .. } = self;
        let who = [submission, body, lesson_sha256, build, seed, parameters];
        let all = match counted {
            None => json!([who, run, earned, possible, passed, made_at]),
            Some(counted) => json!([who, run, earned, possible, passed, made_at, counted]),
        };
        sha256(&all.to_string())
    }

    /// Adds it.
    pub(super) async fn add(&self, connection: &mut AnyConnection) -> Result<(), StoreError> {
        let add = sqlx::query(sql::ADD_VERDICT).bind(&self.submission).bind(self.run).bind(&self.body);
        let add = add.bind(&self.lesson_sha256).bind(&self.build).bind(&self.seed).bind(&self.parameters);
        let add = add.bind(self.earned).bind(self.possible).bind(self.passed).bind(self.made_at);
        let add = add.bind(self.n).bind(self.counted);
        add.execute(connection).await?;
        Ok(())
    }
}

/// What the log says of a submission and of each of its verdicts.
pub(super) fn seal(submission: &SubmissionRow, verdict: &VerdictRow) -> String {
    format!("{} {}", submission.hash(), verdict.hash())
}
