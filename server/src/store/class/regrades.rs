//! Regrades: new verdicts on what was handed in, all at once, and all taken back at once.

use std::collections::BTreeMap;

use serde_json::Value;
use sqlx::AnyConnection;

use crate::policy::{Extension, Moment, Policy};
use crate::store::error::StoreError;
use crate::store::hash::sha256;
use crate::store::log::{self, Event};
use crate::store::records::{self, SubmissionRow, VerdictRow};
use crate::store::{Store, identifier, now, sql};

use super::assignments::{ensured, extensions, found};

/// A regrade that is to be applied.
#[derive(Debug, Clone)]
pub struct NewRegrade {
    /// The course.
    pub course: String,
    /// Slug of the lesson.
    pub lesson: String,
    /// Who asks for it.
    pub actor: String,
    /// What counts: `replace` or `better`.
    pub choice: &'static str,
    /// Why: students see it.
    pub reason: String,
    /// The lessons that graded, as bundles: first as it is assigned now.
    pub bundles: Vec<String>,
    /// How many verdicts the course's assignment had when it was computed, on whoever is not erased: if there are others, it is out
    /// of date.
    pub verdicts: usize,
    /// What was set, allowed and decided when it was computed: if it is something else, it is out of date too.
    pub ruled: Ruled,
    /// The new verdicts, in the order in which the submissions came.
    pub new: Vec<NewVerdict>,
    /// Points of each person before and after.
    pub people: Vec<(String, f64, f64)>,
}

/// What points follow from in a lesson besides verdicts, as far as people who teach say it.
#[derive(Debug, Clone, PartialEq)]
pub struct Ruled {
    /// The place in the log of the last decision about points, those of explanations included; 0 where there is none.
    decided: i64,
    /// What is set.
    policy: Policy,
    /// What is allowed beyond that, by person.
    extensions: BTreeMap<String, Extension>,
}

impl Ruled {
    /// What is said of it now that was not `before`.
    fn since(&self, before: &Self) -> Option<&'static str> {
        if self.decided != before.decided {
            return Some("points were decided since this preview was made");
        }
        if self.policy != before.policy {
            return Some("the policy was set anew since this preview was made");
        }
        (self.extensions != before.extensions)
            .then_some("an extension was given or taken back since this preview was made")
    }
}

/// A new verdict on a submission.
#[derive(Debug, Clone)]
pub struct NewVerdict {
    /// The submission.
    pub submission: String,
    /// SHA-256 of the lesson that graded it.
    pub lesson_sha256: String,
    /// What is told, as it is kept.
    pub body: String,
}

/// A regrade that was applied.
#[derive(Debug, Clone, PartialEq)]
pub struct RegradeRow {
    /// Its id.
    pub id: String,
    /// Slug of the lesson.
    pub lesson: String,
    /// What counted: `replace` or `better`.
    pub choice: String,
    /// Why.
    pub reason: String,
    /// Name of who asked for it.
    pub by: String,
    /// When.
    pub at: Moment,
    /// When it was taken back.
    pub undone: Option<Moment>,
}

/// What a regrade changed for somebody.
#[derive(Debug, Clone, PartialEq)]
pub struct Regraded {
    /// The regrade.
    pub regrade: String,
    /// The person's id.
    pub person: String,
    /// Points before.
    pub before: f64,
    /// Points after.
    pub after: f64,
}

/// A verdict of a submission: the first, or one of a regrade.
#[derive(Debug, Clone, PartialEq)]
pub struct VerdictHistory {
    /// The person who handed in.
    pub person: String,
    /// Slug of the lesson.
    pub lesson: String,
    /// 0 for the first; each regrade, and taking it back, adds one.
    pub run: i64,
    /// When it was given.
    pub at: Moment,
    /// What was told.
    pub body: Value,
}

impl Store {
    /// Applies a regrade in one transaction; its id.
    ///
    /// Errors if something was handed in, regraded, decided, set or allowed since it was computed, or it cannot be written: then
    /// nothing is changed.
    pub async fn regrade(&self, new: &NewRegrade) -> Result<String, StoreError> {
        let (id, at) = (identifier(), now());
        let mut transaction = self.write().await?;
        let assignment = ensured(&mut transaction, &new.course, &new.lesson).await?.id;
        let detail = serde_json::json!([id, new.choice, new.reason, new.new.len()]).to_string();
        let event = Event { actor: &new.actor, what: "regrade of", subject: &new.lesson, detail: &detail };
        let n = log::append(&mut transaction, &new.course, at, &event).await?;
        let count = sqlx::query_as(sql::VERDICT_COUNT).bind(&assignment).bind(&new.course);
        let count = count.fetch_one(&mut *transaction);
        let (verdicts,): (i64,) = count.await?;
        if usize::try_from(verdicts) != Ok(new.verdicts) {
            return Err(StoreError::OutOfDate(
                "something was handed in or regraded since this preview was made",
            ));
        }
        if let Some(what) = ruled(&mut transaction, &new.course, &new.lesson).await?.since(&new.ruled) {
            return Err(StoreError::OutOfDate(what));
        }
        for bundle in &new.bundles {
            let add = sqlx::query(sql::ADD_LESSON).bind(sha256(bundle)).bind(&new.lesson).bind(bundle);
            add.bind(at).execute(&mut *transaction).await?;
        }
        let lesson = new.bundles.first().map(|bundle| sha256(bundle)).unwrap_or_default();
        let add = sqlx::query(sql::ADD_REGRADE).bind(&id).bind(&new.course).bind(n).bind(&assignment);
        let add = add.bind(new.choice).bind(&new.reason).bind(&lesson).bind(&new.actor).bind(at);
        let verdicts = i64::try_from(new.new.len()).unwrap_or(i64::MAX);
        add.bind(verdicts).execute(&mut *transaction).await?;
        for verdict in &new.new {
            let before = latest(&mut transaction, &verdict.submission).await?;
            let next = VerdictRow {
                run: before.run + 1,
                seed: before.seed,
                ..VerdictRow::first(
                    &verdict.submission,
                    verdict.body.clone(),
                    verdict.lesson_sha256.clone(),
                    crate::BUILD,
                    at,
                )
            };
            append(&mut transaction, &new.course, &new.actor, next).await?;
        }
        for (person, before, after) in &new.people {
            let add = sqlx::query(sql::ADD_REGRADED).bind(&id).bind(person).bind(before).bind(after);
            add.execute(&mut *transaction).await?;
        }
        transaction.commit().await?;
        Ok(id)
    }

    /// What people who teach have set, allowed and decided in a lesson.
    ///
    /// Errors if the file cannot be read.
    pub async fn ruled(&self, course: &str, lesson: &str) -> Result<Ruled, StoreError> {
        ruled(&mut *self.snapshot().await?, course, lesson).await
    }

    /// Takes a regrade back: the verdicts of before hold again, and what was said meanwhile is kept.
    ///
    /// Errors if there is none, it is undone, or a later one of the same lesson is not.
    pub async fn undo_regrade(&self, course: &str, actor: &str, id: &str) -> Result<(), StoreError> {
        let at = now();
        let mut transaction = self.write().await?;
        let event = Event { actor, what: "took back the regrade", subject: id, detail: "" };
        log::append(&mut transaction, course, at, &event).await?;
        let find = sqlx::query_as(sql::LAST_REGRADE).bind(course).bind(id);
        let found: Option<(i64, i64, String)> = find.fetch_optional(&mut *transaction).await?;
        let (n, verdicts, last) = found.ok_or(StoreError::Unknown("regrade that is in force"))?;
        if last != id {
            return Err(StoreError::NotLast);
        }
        let made = sqlx::query_as(sql::VERDICTS_OF_REGRADE).bind(course).bind(n).bind(verdicts);
        let made: Vec<(String, i64)> = made.fetch_all(&mut *transaction).await?;
        for (submission, run) in made {
            let find = sqlx::query_as(sql::VERDICT_OF_RUN).bind(&submission).bind(run - 1);
            let before: VerdictRow = find.fetch_one(&mut *transaction).await?;
            let newest = latest(&mut transaction, &submission).await?.run;
            append(&mut transaction, course, actor, VerdictRow { run: newest + 1, made_at: at, ..before })
                .await?;
        }
        let set = sqlx::query(sql::SET_UNDONE).bind(id).bind(actor).bind(at);
        set.execute(&mut *transaction).await?;
        transaction.commit().await
    }

    /// The regrades of a course, the latest first.
    ///
    /// Errors if the file cannot be read.
    pub async fn regrades(&self, course: &str) -> Result<Vec<RegradeRow>, StoreError> {
        type Row = (String, String, String, String, String, i64, Option<i64>);
        let rows: Vec<Row> =
            sqlx::query_as(sql::REGRADES).bind(course).fetch_all(&self.pools.readers).await?;
        let read = |(id, lesson, choice, reason, by, at, undone): Row| RegradeRow {
            id,
            lesson,
            choice,
            reason,
            by,
            at: Moment(at),
            undone: undone.map(Moment),
        };
        Ok(rows.into_iter().map(read).collect())
    }

    /// What regrades changed, for one person or for all.
    ///
    /// Errors if the file cannot be read.
    pub async fn regraded(&self, course: &str, person: Option<&str>) -> Result<Vec<Regraded>, StoreError> {
        let list = sqlx::query_as(sql::REGRADED).bind(course).bind(person);
        let rows: Vec<(String, String, f64, f64)> = list.fetch_all(&self.pools.readers).await?;
        let read = |(regrade, person, before, after)| Regraded { regrade, person, before, after };
        Ok(rows.into_iter().map(read).collect())
    }

    /// Every verdict that a submission was given, the first at the beginning.
    ///
    /// Errors if there is no such submission in the course.
    pub async fn verdicts_of(
        &self,
        course: &str,
        submission: &str,
    ) -> Result<Vec<VerdictHistory>, StoreError> {
        type Row = (String, String, i64, i64, String);
        let list = sqlx::query_as(sql::VERDICTS_GIVEN).bind(course).bind(submission);
        let rows: Vec<Row> = list.fetch_all(&self.pools.readers).await?;
        if rows.is_empty() {
            return Err(StoreError::Unknown("submission"));
        }
        let read = |(person, lesson, run, at, body): Row| {
            let body = serde_json::from_str(&body).map_err(|cause| StoreError::Damaged(cause.to_string()))?;
            Ok(VerdictHistory { person, lesson, run, at: Moment(at), body })
        };
        rows.into_iter().map(read).collect()
    }
}

async fn ruled(connection: &mut AnyConnection, course: &str, lesson: &str) -> Result<Ruled, StoreError> {
    let last = sqlx::query_as(sql::LAST_DECISION).bind(course).bind(lesson);
    let (decided,): (i64,) = last.fetch_one(&mut *connection).await?;
    let policy = found(connection, course, lesson).await?.policy;
    let extensions = extensions(connection, course, None, Some(lesson)).await?;
    let extensions = extensions.into_iter().map(|(person, _, given)| (person, given)).collect();
    Ok(Ruled { decided, policy, extensions })
}

async fn latest(connection: &mut AnyConnection, submission: &str) -> Result<VerdictRow, StoreError> {
    let find = sqlx::query_as(sql::VERDICT_IN_FORCE).bind(submission).fetch_optional(connection).await?;
    find.ok_or(StoreError::Unknown("submission"))
}

/// Adds a verdict that follows others, with its place in the log.
async fn append(
    connection: &mut AnyConnection,
    course: &str,
    actor: &str,
    mut verdict: VerdictRow,
) -> Result<(), StoreError> {
    let told: Value =
        serde_json::from_str(&verdict.body).map_err(|cause| StoreError::Damaged(cause.to_string()))?;
    verdict.counted = Some(i64::from(told["gradable"] == true));
    let find = sqlx::query_as(sql::SUBMISSION).bind(&verdict.submission).fetch_one(&mut *connection).await?;
    let submission: SubmissionRow = find;
    let detail = records::seal(&submission, &verdict);
    let event = Event { actor, what: "regraded", subject: &submission.id, detail: &detail };
    verdict.n = log::append(connection, course, verdict.made_at, &event).await?;
    verdict.add(connection).await
}
