//! Handing in, and what was handed in.

use std::collections::HashSet;

use serde_json::Value;
use sqlx::AnyConnection;

use super::class::Assignment;
use super::class::assignments::{ensured, extension_of};
use super::database::readable;
use super::error::StoreError;
use super::hash::sha256;
use super::log::{self, Event};
use super::quotas::Quotas;
use super::records::{self, SubmissionRow, VerdictRow};
use super::{Store, identifier, names, now, sql};
use crate::policy::{Moment, admit};

/// A submission as it is kept.
#[derive(Debug, Clone, PartialEq)]
pub struct StoredSubmission {
    /// Its name.
    pub id: String,
    /// Slug of the lesson.
    pub lesson: String,
    /// Who handed it in, as the person was called then.
    pub student: String,
    /// What was handed in.
    pub answers: Value,
    /// What it earned, with the provenance of the grading: the latest verdict.
    pub verdict: Value,
}

/// Which submissions to list.
#[derive(Debug, Clone, Default)]
pub struct Query {
    /// Of this course.
    pub course: String,
    /// Only this person's, by id.
    pub person: Option<String>,
    /// Only for this lesson.
    pub lesson: Option<String>,
    /// At most so many, newest first.
    pub limit: usize,
}

/// Who hands in.
#[derive(Debug, Clone)]
pub enum Whose {
    /// Somebody who is known, by id.
    Person(String),
    /// Whoever types the name: at home.
    Named,
}

/// What is handed in and what it earned.
#[derive(Debug, Clone)]
pub struct HandIn {
    /// A name that was never used before.
    pub id: String,
    /// The course.
    pub course: String,
    /// Slug of the lesson.
    pub lesson: String,
    /// Who hands in.
    pub whose: Whose,
    /// The person's name.
    pub student: String,
    /// When it came, in milliseconds since 1970.
    pub received_at: i64,
    /// The answers as JSON.
    pub answers: String,
    /// The verdict as it is to be kept.
    pub verdict: Value,
    /// What the numbers were drawn from: not always what the verdict tells.
    pub seed: String,
    /// Whether it counts as an attempt: not if an answer could not be read.
    pub counted: bool,
    /// The entry in the log of the person's last submission to the lesson that the verdict knows of; 0 if of none.
    pub after: i64,
    /// What the sender calls this request: the same name again is the same submission.
    pub key: Option<String>,
    /// The lesson that graded it, as [`triad_lessons::Lesson::bundle`] writes it.
    pub bundle: String,
}

/// What is needed to judge a submission again, and what was said of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Recorded {
    /// The submission.
    pub id: String,
    /// Who handed it in, by id.
    pub person: String,
    /// Slug of the lesson.
    pub lesson: String,
    /// What was handed in, as JSON.
    pub answers: String,
    /// The verdict as it is kept.
    pub body: String,
    /// SHA-256 of the lesson that graded it; empty where it was not kept.
    pub lesson_sha256: String,
    /// What its numbers were drawn from.
    pub seed: String,
    /// The program that graded it.
    pub build: String,
    /// When it was handed in.
    pub at: Moment,
}

/// Id, person, lesson, answers, verdict, SHA-256 of the lesson, seed, program, when.
type RecordedRow = (String, String, String, String, String, String, String, String, i64);

fn recorded((id, person, lesson, answers, body, lesson_sha256, seed, build, at): RecordedRow) -> Recorded {
    Recorded { id, person, lesson, answers, body, lesson_sha256, seed, build, at: Moment(at) }
}

/// What was kept.
#[derive(Debug, Clone, PartialEq)]
pub struct Kept {
    /// How many attempts the person has used, this one included.
    pub attempts: usize,
    /// The verdict that is kept, of an earlier request if this one repeats it.
    pub verdict: Value,
}

impl Store {
    /// Keeps a submission with its verdict, or finds the one that an earlier request of the same key kept. Attempts are
    /// counted in the same transaction.
    ///
    /// Errors if all attempts are used, the verdict does not know of all submissions before it, a quota is used, or it cannot
    /// be written: then nothing is kept.
    pub async fn hand_in(&self, new: &HandIn) -> Result<Kept, StoreError> {
        self.place_is_right()?;
        self.quotas.check_file(self.place.as_ref())?;
        let kept = self.together.keep(&self.pools.writer, self.quotas, new.clone()).await?;
        // A file that was moved away meanwhile has taken the submission with it.
        self.place_is_right()?;
        Ok(kept)
    }

    /// What a person has handed in to a lesson, the oldest first, and the entry of the last of them in the log.
    ///
    /// Errors if the file cannot be read.
    pub async fn earlier(
        &self,
        course: &str,
        person: &str,
        lesson: &str,
    ) -> Result<(Vec<StoredSubmission>, i64), StoreError> {
        self.place_is_right()?;
        // Asked for first: what comes between the two is then found out as the next submission is kept.
        let last = sqlx::query_as(sql::LAST_SUBMISSION).bind(course).bind(lesson).bind(person);
        let (last,): (i64,) = last.fetch_one(&self.pools.readers).await?;
        let mut found = self
            .list(&Query {
                course: course.to_owned(),
                person: Some(person.to_owned()),
                lesson: Some(lesson.to_owned()),
                limit: usize::MAX,
            })
            .await?;
        found.reverse();
        Ok((found, last))
    }

    /// The id of the person of that name, if there is one.
    ///
    /// Errors if the file cannot be read.
    pub async fn person_named(&self, course: &str, name: &str) -> Result<Option<String>, StoreError> {
        let find = sqlx::query_as(sql::MEMBER_BY_NAME).bind(course).bind(names::key(name));
        let found: Option<(String,)> = find.fetch_optional(&self.pools.readers).await?;
        Ok(found.map(|(id,)| id))
    }

    /// Lists submissions, newest first. Rows that cannot be read are left out and named in the server's log.
    ///
    /// Errors if the file cannot be read.
    pub async fn list(&self, query: &Query) -> Result<Vec<StoredSubmission>, StoreError> {
        let limit = i64::try_from(query.limit).unwrap_or(i64::MAX);
        let statement = query.person.as_ref().map_or(sql::SUBMISSIONS, |_| sql::SUBMISSIONS_OF);
        let list = sqlx::query_as(statement).bind(&query.course).bind(&query.person);
        let rows: Vec<(String, String, String, String, String)> =
            readable(list.bind(&query.lesson).bind(limit), &self.pools.readers).await?;
        let read = |(id, lesson, student, answers, verdict): (String, String, String, String, String)| {
            let parsed = (serde_json::from_str(&answers), serde_json::from_str(&verdict));
            let (Ok(answers), Ok(verdict)) = parsed else {
                tracing::error!(target: "triad", %id, "a submission is damaged: restore the database from a copy");
                return None;
            };
            Some(StoredSubmission { id, lesson, student, answers, verdict })
        };
        // Files make them large: whoever hands in does not wait for their reading.
        let reading = tokio::task::spawn_blocking(move || rows.into_iter().filter_map(read).collect());
        reading.await.map_err(|cause| StoreError::Damaged(cause.to_string()))
    }

    /// A submission with its person, by id.
    ///
    /// Errors if it cannot be read.
    pub async fn submission(
        &self,
        course: &str,
        id: &str,
    ) -> Result<Option<(String, StoredSubmission)>, StoreError> {
        type Row = (String, String, String, String, String, String);
        let find = sqlx::query_as(sql::IN_FORCE).bind(course).bind(id);
        let found: Option<Row> = find.fetch_optional(&self.pools.readers).await?;
        let Some((id, lesson, student, answers, verdict, person)) = found else { return Ok(None) };
        let read =
            |text: &str| serde_json::from_str(text).map_err(|cause| StoreError::Damaged(cause.to_string()));
        let (answers, verdict) = (read(&answers)?, read(&verdict)?);
        Ok(Some((person, StoredSubmission { id, lesson, student, answers, verdict })))
    }

    /// Every verdict of a course, or of one lesson, with what it is about, in the order in which they were given.
    ///
    /// Errors if the file cannot be read.
    pub async fn recorded(&self, course: &str, lesson: Option<&str>) -> Result<Vec<Recorded>, StoreError> {
        let list = sqlx::query_as(sql::REBUILDABLE).bind(course).bind(lesson);
        let rows: Vec<RecordedRow> = readable(list, &self.pools.readers).await?;
        Ok(rows.into_iter().map(recorded).collect())
    }

    /// As [`Store::recorded`], of whoever is not erased: what they handed in can be judged again.
    ///
    /// Errors if the file cannot be read.
    pub async fn judgeable(&self, course: &str, lesson: Option<&str>) -> Result<Vec<Recorded>, StoreError> {
        let mut records = self.recorded(course, lesson).await?;
        let list = sqlx::query_as(sql::ERASED_PEOPLE).bind(course);
        let erased: Vec<(String,)> = list.fetch_all(&self.pools.readers).await?;
        let erased: HashSet<String> = erased.into_iter().map(|(person,)| person).collect();
        records.retain(|record| !erased.contains(&record.person));
        Ok(records)
    }

    /// Verdicts in force on what was handed in to a course after a moment, the oldest first; what was handed in, often files, is not read.
    ///
    /// Errors if the file cannot be read.
    pub async fn recent(&self, course: &str, after: Moment) -> Result<Vec<Recorded>, StoreError> {
        // The log has the moments in order, so that only its end is read.
        let last = sqlx::query_as(sql::EVENT_UNTIL).bind(course).bind(after.0);
        let last: Option<(i64,)> = last.fetch_optional(&self.pools.readers).await?;
        let list = sqlx::query_as(sql::RECENT).bind(course).bind(last.map_or(0, |(n,)| n));
        let rows: Vec<RecordedRow> = readable(list, &self.pools.readers).await?;
        Ok(rows.into_iter().map(recorded).collect())
    }
}

/// Keeps it, unless an earlier request of the same key did: then nothing that was done for it is wanted.
pub(super) async fn keep(
    connection: &mut AnyConnection,
    new: &HandIn,
    quotas: &Quotas,
) -> Result<(Kept, bool), StoreError> {
    log::hold(connection, &new.course).await?;
    let person = person(connection, new).await?;
    let Assignment { id: assignment, policy, .. } = ensured(connection, &new.course, &new.lesson).await?;
    if let Some(key) = &new.key
        && let Some(kept) = of_key(connection, &assignment, &person, key).await?
    {
        return Ok((kept, false));
    }
    let made = attempts(connection, &assignment, &person).await?;
    let extension = extension_of(connection, &assignment, &person).await?;
    admit(&policy, extension.as_ref(), &made, new.counted, Moment(new.received_at))?;
    quotas.check_person(connection, &person, new.answers.len()).await?;
    let waits = sqlx::query_as(sql::OPEN_OF).bind(&assignment).bind(&person).fetch_optional(&mut *connection);
    let waits: Option<(i64,)> = waits.await?;
    if waits.is_some() {
        return Err(StoreError::Behind);
    }
    write(connection, new, &assignment, &person).await?;
    let attempts = made.len() + usize::from(new.counted);
    Ok((Kept { attempts, verdict: new.verdict.clone() }, true))
}

/// Keeps what was admitted when it was accepted.
pub(super) async fn keep_accepted(connection: &mut AnyConnection, new: &HandIn) -> Result<(), StoreError> {
    let person = person(connection, new).await?;
    let assignment = ensured(connection, &new.course, &new.lesson).await?.id;
    write(connection, new, &assignment, &person).await
}

async fn person(connection: &mut AnyConnection, new: &HandIn) -> Result<String, StoreError> {
    match &new.whose {
        Whose::Person(id) => Ok(id.clone()),
        Whose::Named => person_of(connection, &new.course, &new.student, new.received_at).await,
    }
}

/// Writes a submission with its verdict and its entry in the log, if the verdict knows of all before it.
async fn write(
    connection: &mut AnyConnection,
    new: &HandIn,
    assignment: &str,
    person: &str,
) -> Result<(), StoreError> {
    let last = sqlx::query_as(sql::LAST_SUBMISSION).bind(&new.course).bind(&new.lesson).bind(person);
    let (last,): (i64,) = last.fetch_one(&mut *connection).await?;
    if last != new.after {
        return Err(StoreError::Overtaken);
    }
    let submission = SubmissionRow {
        id: new.id.clone(),
        assignment: assignment.to_owned(),
        person: person.to_owned(),
        received_at: new.received_at,
        student: new.student.clone(),
        answers: new.answers.clone(),
        request_key: new.key.clone(),
        counted: i64::from(new.counted),
    };
    let lesson = sha256(&new.bundle);
    let mut verdict =
        VerdictRow::first(&new.id, new.verdict.to_string(), lesson.clone(), crate::BUILD, now());
    verdict.seed.clone_from(&new.seed);
    let detail = records::seal(&submission, &verdict);
    let event = Event { actor: person, what: "submitted", subject: &new.id, detail: &detail };
    let n = log::append(connection, &new.course, new.received_at, &event).await?;
    let add = sqlx::query(sql::ADD_LESSON).bind(lesson).bind(&new.lesson).bind(&new.bundle);
    add.bind(now()).execute(&mut *connection).await?;
    submission.add(connection, n).await?;
    verdict.add(connection).await
}

/// When the attempts of a person at a lesson were made, by the verdicts in force.
pub(super) async fn attempts(
    connection: &mut AnyConnection,
    assignment: &str,
    person: &str,
) -> Result<Vec<Moment>, StoreError> {
    let list = sqlx::query_as(sql::ATTEMPTS).bind(assignment).bind(person);
    let made: Vec<(i64,)> = list.fetch_all(connection).await?;
    Ok(made.into_iter().map(|(at,)| Moment(at)).collect())
}

/// What an earlier request of the same key kept, if one did.
pub(super) async fn of_key(
    connection: &mut AnyConnection,
    assignment: &str,
    person: &str,
    key: &str,
) -> Result<Option<Kept>, StoreError> {
    let find = sqlx::query_as(sql::BY_KEY).bind(assignment).bind(person).bind(key);
    let earlier: Option<(String, i64)> = find.fetch_optional(&mut *connection).await?;
    let Some((id, n)) = earlier else { return Ok(None) };
    repeated(connection, assignment, person, &id, n).await.map(Some)
}

/// What an earlier request of the same key kept.
async fn repeated(
    connection: &mut AnyConnection,
    assignment: &str,
    person: &str,
    id: &str,
    n: i64,
) -> Result<Kept, StoreError> {
    let count = sqlx::query_as(sql::ATTEMPTS_UNTIL).bind(assignment).bind(person).bind(n);
    let (used,): (i64,) = count.fetch_one(&mut *connection).await?;
    let (body,): (String,) = sqlx::query_as(sql::LATEST_VERDICT).bind(id).fetch_one(&mut *connection).await?;
    let verdict = serde_json::from_str(&body).map_err(|cause| StoreError::Damaged(cause.to_string()))?;
    Ok(Kept { attempts: usize::try_from(used).unwrap_or_default(), verdict })
}

/// The person of that name; at home whoever types a name is known by it from then on.
pub(super) async fn person_of(
    connection: &mut AnyConnection,
    course: &str,
    name: &str,
    at: i64,
) -> Result<String, StoreError> {
    let key = names::key(name);
    let find = sqlx::query_as(sql::MEMBER_BY_NAME).bind(course).bind(&key);
    let found: Option<(String,)> = find.fetch_optional(&mut *connection).await?;
    if let Some((id,)) = found {
        return Ok(id);
    }
    let id = identifier();
    let add = sqlx::query(sql::ADD_PERSON).bind(&id).bind(name).bind(at);
    add.execute(&mut *connection).await?;
    let add = sqlx::query(sql::ADD_MEMBER).bind(course).bind(&id).bind("student").bind(key).bind(name);
    add.bind(at).execute(&mut *connection).await?;
    Ok(id)
}
