//! What was accepted and is not graded yet: a row for each, claimed by one grader at a time.
//!
//! A claim is a lease: whoever does not renew it loses the row to another, and with it the right to close it, which the fence
//! holds. Each start is counted before anything is computed, so that what kills its grader is put aside after three. Closing a
//! claim and keeping the verdict are one transaction.

use std::time::Duration;

use sqlx::AnyConnection;

use super::class::Assignment;
use super::class::assignments::{ensured, extension_of};
use super::database;
use super::error::StoreError;
use super::hash::sha256;
use super::kind::Kind;
use super::submissions::{self, HandIn, Kept, Whose, person_of};
use super::{Store, identifier, log, sql};
use crate::policy::{Moment, admit};

/// A grading that was begun so often and never ended is put aside: it ends its graders.
pub const STARTS: i64 = 3;
/// What a program cannot read is not claimed again so soon, in milliseconds: others look for work as often.
const OTHERS_FIRST: i64 = 1000;
/// Gradings of one person that may wait at a time.
const MOST_OPEN: i64 = 100;

/// What is handed in, before it is graded.
#[derive(Debug, Clone)]
pub struct Accept {
    /// The course.
    pub course: String,
    /// Slug of the lesson.
    pub lesson: String,
    /// Who hands in.
    pub whose: Whose,
    /// The person's name.
    pub student: String,
    /// The submission as it was sent, JSON.
    pub body: String,
    /// What a class draws the numbers from; at home the submission says it.
    pub seed: Option<String>,
    /// What the sender calls this request.
    pub key: Option<String>,
    /// The lesson as [`triad_lessons::Lesson::bundle`] writes it.
    pub bundle: String,
    /// The name of the request with which it came: it stands in the log of whoever grades it.
    pub request: String,
}

/// What came of it.
#[derive(Debug, Clone, PartialEq)]
pub enum Accepted {
    /// It waits, under this id.
    Waiting(String),
    /// An earlier request of the same key was graded.
    Kept(Kept),
}

/// The right to grade one submission, for as long as it is renewed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Claim {
    /// The submission.
    pub id: String,
    /// Which claim of it this is.
    fence: i64,
    /// Its course: held while it is closed.
    course: String,
}

/// A submission that is to be graded.
#[derive(Debug, Clone)]
pub struct Job {
    /// The right to do it.
    pub claim: Claim,
    /// What was accepted, its lesson by SHA-256 in place of the bundle.
    pub accepted: Accept,
    /// SHA-256 of the lesson.
    pub lesson_sha256: String,
    /// When it was handed in.
    pub received_at: i64,
    /// Which start this is; the first is 1.
    pub start: i64,
}

/// Where a submission stands that has no verdict yet.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Waiting {
    /// The person who handed in.
    pub person: String,
    /// How many come before it; `None`: it was put aside.
    pub before: Option<i64>,
}

type Row = (
    String,
    i64,
    i64,
    String,
    String,
    String,
    String,
    String,
    String,
    Option<String>,
    Option<String>,
    String,
    i64,
    String,
);

impl Store {
    /// Takes what is handed in, to be graded in its turn. Attempts are counted with those that wait.
    ///
    /// Errors if the lesson takes nothing more of this person now, or it cannot be written: then nothing is kept.
    pub async fn enqueue(&self, new: &Accept) -> Result<Accepted, StoreError> {
        self.place_is_right()?;
        let mut transaction = self.write().await?;
        let accepted = accept(&mut transaction, new, &self.quotas).await?;
        if matches!(accepted, Accepted::Waiting(_)) {
            self.wake(&mut transaction).await?;
        }
        transaction.commit().await?;
        self.work.notify_one();
        self.place_is_right()?;
        Ok(accepted)
    }

    /// Claims what is next, if anything is. What was claimed and not renewed is claimed again, or put aside where that has
    /// happened too often.
    ///
    /// Errors if it cannot be written.
    pub async fn claim(&self, worker: &str, lease: Duration) -> Result<Option<Job>, StoreError> {
        // Looked at first: in a file a claim waits for those who write.
        let (open,): (i64,) = sqlx::query_as(sql::OPEN_GRADINGS).fetch_one(&self.pools.readers).await?;
        if open == 0 {
            return Ok(None);
        }
        let mut transaction = self.write().await?;
        let at = database::clock(&mut transaction).await?;
        let sweep = sqlx::query(sql::PUT_ASIDE).bind(at).bind(STARTS).execute(&mut *transaction);
        sweep.await?;
        let text = match Kind::of(&transaction) {
            Kind::Sqlite => sql::CLAIM,
            Kind::Postgres => sql::CLAIM_OF_MANY,
        };
        let claim = sqlx::query_as(text).bind(at).bind(STARTS).bind(at + milliseconds(lease)).bind(worker);
        let row: Option<Row> = claim.fetch_optional(&mut *transaction).await?;
        transaction.commit().await?;
        Ok(row.map(job))
    }

    /// Keeps a claim for as long again; false if it is lost.
    ///
    /// Errors if it cannot be written.
    pub async fn renew(&self, claim: &Claim, lease: Duration) -> Result<bool, StoreError> {
        let mut transaction = self.write().await?;
        let until = database::clock(&mut transaction).await? + milliseconds(lease);
        let renew = sqlx::query(sql::RENEW).bind(&claim.id).bind(claim.fence).bind(until);
        let done = renew.execute(&mut *transaction).await?;
        transaction.commit().await?;
        Ok(done.rows_affected() == 1)
    }

    /// Closes a claim with the verdict, in one transaction.
    ///
    /// Errors if the claim is lost (`Fenced`), the verdict does not know of all submissions before it, or it cannot be written.
    pub async fn close_claim(&self, claim: &Claim, new: &HandIn) -> Result<(), StoreError> {
        self.place_is_right()?;
        let mut transaction = self.write().await?;
        log::hold(&mut transaction, &claim.course).await?;
        let close = sqlx::query(sql::CLOSE).bind(&claim.id).bind(claim.fence);
        if close.execute(&mut *transaction).await?.rows_affected() != 1 {
            return Err(StoreError::Fenced);
        }
        submissions::keep_accepted(&mut transaction, new).await?;
        self.tell_verdict(&mut transaction, &claim.id).await?;
        transaction.commit().await?;
        self.verdicts.tell(&claim.id);
        self.place_is_right()
    }

    /// Gives a claim back that could not be graded, to be tried again in a while; after [`STARTS`] it is put aside.
    ///
    /// Errors if it cannot be written.
    pub async fn give_back(&self, job: &Job, why: &str) -> Result<(), StoreError> {
        let mut transaction = self.write().await?;
        let later = database::clock(&mut transaction).await? + (1000 << job.start.clamp(0, 10));
        let state = if job.start < STARTS { "queued" } else { "dead" };
        let back = sqlx::query(sql::GIVE_BACK).bind(&job.claim.id).bind(job.claim.fence).bind(state);
        back.bind(later).bind(why).bind(job.start).execute(&mut *transaction).await?;
        transaction.commit().await
    }

    /// Leaves a submission to a program that can read it: it was not begun, and waits a moment so that another comes first.
    ///
    /// Errors if it cannot be written: then it is claimed again as the lease ends.
    pub async fn leave(&self, job: &Job, why: &str) -> Result<(), StoreError> {
        let mut transaction = self.write().await?;
        let later = database::clock(&mut transaction).await? + OTHERS_FIRST;
        let back = sqlx::query(sql::GIVE_BACK).bind(&job.claim.id).bind(job.claim.fence).bind("queued");
        back.bind(later).bind(why).bind(job.start - 1).execute(&mut *transaction).await?;
        transaction.commit().await
    }

    /// Where a submission stands that waits for its verdict; `None` where none of that id does.
    ///
    /// Errors if it cannot be read.
    pub async fn waiting(&self, id: &str) -> Result<Option<Waiting>, StoreError> {
        let find = sqlx::query_as(sql::PLACE).bind(id).fetch_optional(&self.pools.readers).await?;
        Ok(find.map(|(person, state, before): (String, String, i64)| Waiting {
            person,
            before: (state != "dead").then_some(before),
        }))
    }

    /// How many gradings wait or are under way, and how many were put aside.
    ///
    /// Errors if it cannot be read.
    pub async fn gradings(&self) -> Result<(i64, i64), StoreError> {
        Ok(sqlx::query_as(sql::GRADINGS).fetch_one(&self.pools.readers).await?)
    }

    /// Puts what was put aside back into the queue; how many.
    ///
    /// Errors if it cannot be written.
    pub async fn grade_again(&self) -> Result<u64, StoreError> {
        let mut transaction = self.write().await?;
        let again = sqlx::query(sql::GRADE_AGAIN).execute(&mut *transaction).await?;
        transaction.commit().await?;
        Ok(again.rows_affected())
    }
}

pub(super) fn milliseconds(time: Duration) -> i64 {
    i64::try_from(time.as_millis()).unwrap_or(i64::MAX / 2)
}

fn job(row: Row) -> Job {
    let (
        id,
        fence,
        start,
        course,
        lesson,
        person,
        student,
        body,
        lesson_sha256,
        key,
        seed,
        _,
        received_at,
        request,
    ) = row;
    let accepted = Accept {
        course: course.clone(),
        lesson,
        whose: Whose::Person(person),
        student,
        body,
        seed,
        key,
        bundle: String::new(),
        request,
    };
    Job { claim: Claim { id, fence, course }, accepted, lesson_sha256, received_at, start }
}

async fn accept(
    connection: &mut AnyConnection,
    new: &Accept,
    quotas: &super::Quotas,
) -> Result<Accepted, StoreError> {
    log::hold(connection, &new.course).await?;
    let at = database::clock(connection).await?;
    let person = match &new.whose {
        Whose::Person(id) => id.clone(),
        Whose::Named => person_of(connection, &new.course, &new.student, at).await?,
    };
    let Assignment { id: assignment, policy, .. } = ensured(connection, &new.course, &new.lesson).await?;
    if let Some(key) = &new.key {
        if let Some(kept) = submissions::of_key(connection, &assignment, &person, key).await? {
            return Ok(Accepted::Kept(kept));
        }
        let find = sqlx::query_as(sql::GRADING_BY_KEY).bind(&assignment).bind(&person).bind(key);
        let found: Option<(String,)> = find.fetch_optional(&mut *connection).await?;
        if let Some((id,)) = found {
            return Ok(Accepted::Waiting(id));
        }
    }
    let mut made = submissions::attempts(connection, &assignment, &person).await?;
    let extension = extension_of(connection, &assignment, &person).await?;
    admit(&policy, extension.as_ref(), &made, true, Moment(at))?;
    let open: Vec<(i64,)> =
        sqlx::query_as(sql::OPEN_OF).bind(&assignment).bind(&person).fetch_all(&mut *connection).await?;
    made.extend(open.iter().map(|(at,)| Moment(*at)));
    // Those that wait may turn out not to count: then the next is taken.
    admit(&policy, extension.as_ref(), &made, true, Moment(at)).map_err(|_| StoreError::BeingGraded)?;
    quotas.check_person(connection, &person, new.body.len()).await?;
    let next = sqlx::query_as(sql::NEXT_GRADING).bind(&new.course).bind(&person).fetch_one(&mut *connection);
    let (n, fair): (i64, i64) = next.await?;
    if fair >= MOST_OPEN {
        return Err(StoreError::QuotaUsed(format!(
            "{fair} submissions of this person wait for their verdicts"
        )));
    }
    let (id, lesson) = (identifier(), sha256(&new.bundle));
    let add = sqlx::query(sql::ADD_LESSON).bind(&lesson).bind(&new.lesson).bind(&new.bundle);
    add.bind(at).execute(&mut *connection).await?;
    let add = sqlx::query(sql::ADD_GRADING).bind(&id).bind(&new.course).bind(&assignment).bind(&person);
    let add = add.bind(n).bind(at).bind(&new.student).bind(&new.body).bind(&new.key).bind(&new.seed);
    add.bind(&lesson).bind(fair).bind(&new.request).execute(&mut *connection).await?;
    Ok(Accepted::Waiting(id))
}
