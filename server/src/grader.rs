//! Grading what waits: the loop of `triad grader`, and of each server for what it could not answer at once.

use std::collections::HashMap;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use axum::http::StatusCode;
use tokio::sync::{Semaphore, SemaphorePermit};
use tokio::time::sleep;
use tracing::Instrument;
use triad_engine::analysis::Wanted;
use triad_lessons::Lesson;

use crate::blocking;
use crate::grading;
use crate::handing::{self, Judged, Who};
use crate::metrics::Metrics;
use crate::problem::Problem;
use crate::store::{Claim, Job, Judging, Store, StoreError, identifier};
use crate::variants::Variants;

/// How long a claim holds, unless it is renewed. A grader that ends holds up what it had for as long.
pub const LEASE: Duration = Duration::from_secs(15);
/// How long a grader waits where the database does not answer.
const PAUSE: Duration = Duration::from_millis(500);
/// Lessons that are kept: as many as a course has.
const LESSONS: usize = 64;
/// What is claimed at once of what is judged again: most take milliseconds, and a claim as long.
const BATCH: i64 = 8;
/// How long such a claim holds, in leases: it is not renewed.
const BATCH_LEASE: u32 = 4;

/// Grades what waits in a gradebook, so much at a time.
#[derive(Debug)]
pub struct Grader {
    store: Arc<Store>,
    variants: Arc<Variants>,
    metrics: Arc<Metrics>,
    lessons: Mutex<HashMap<String, Lesson>>,
    slots: Arc<Semaphore>,
    lease: Duration,
    name: String,
}

/// A lesson that this program cannot read. During a deployment it is one that a newer server took: it is left to newer graders.
const UNREADABLE: &str = "lesson-unreadable";

/// Something to do.
enum Task {
    Grade(Box<Job>),
    Again(Vec<Judging>),
}

impl Grader {
    /// A grader of a gradebook with a name that no other has.
    pub fn new(
        store: Arc<Store>,
        variants: Arc<Variants>,
        metrics: Arc<Metrics>,
        slots: usize,
        lease: Duration,
    ) -> Arc<Self> {
        let name = format!("{} {}", std::process::id(), identifier());
        let (lessons, slots) = (Mutex::default(), Arc::new(Semaphore::new(slots)));
        Arc::new(Self { store, variants, metrics, lessons, slots, lease, name })
    }

    /// Grades for ever. What is under way as this is dropped goes on to its end.
    pub async fn run(self: Arc<Self>) {
        loop {
            let Ok(mut bell) = self.store.bell().await else {
                sleep(PAUSE).await;
                continue;
            };
            while let Ok(place) = Arc::clone(&self.slots).acquire_owned().await {
                match self.next().await {
                    Ok(Some(task)) => {
                        let grader = Arc::clone(&self);
                        tokio::spawn(async move {
                            grader.work(task).await;
                            drop(place);
                        });
                    }
                    Ok(None) => {
                        drop(place);
                        bell.rings().await;
                    }
                    Err(error) => {
                        drop(place);
                        tracing::error!(target: "triad", "cannot look for work: {error}");
                        sleep(PAUSE).await;
                        break;
                    }
                }
            }
        }
    }

    /// What is to be done next: what students wait for, and else what is judged again.
    async fn next(&self) -> Result<Option<Task>, StoreError> {
        if let Some(job) = self.store.claim(&self.name, self.lease).await? {
            return Ok(Some(Task::Grade(Box::new(job))));
        }
        let again = self.store.claim_judgings(self.lease * BATCH_LEASE, BATCH, false).await?;
        Ok((!again.is_empty()).then_some(Task::Again(again)))
    }

    async fn work(self: &Arc<Self>, task: Task) {
        match task {
            Task::Grade(job) => {
                // The request with which it came, in the log of whoever grades it.
                let id = job.accepted.request.clone();
                let span = tracing::error_span!(target: "triad", "grading", id = id.as_str());
                self.grade(*job).instrument(span).await;
            }
            Task::Again(batch) => {
                // What cannot be kept now is claimed again when the lease ends.
                if let Err(problem) = self.judge_batch(batch, false).await {
                    tracing::error!(target: "triad", code = problem.code(), "could not be judged again");
                }
            }
        }
    }

    /// Judges again what is asked for until nothing is left to begin, whether students wait or not: for a program that is nobody's
    /// server.
    ///
    /// Errors if the database does not answer.
    pub async fn judge_again(self: &Arc<Self>) -> Result<(), Problem> {
        loop {
            let place = Arc::clone(&self.slots).acquire_owned().await.map_err(Problem::internal)?;
            let batch = self.store.claim_judgings(self.lease * BATCH_LEASE, BATCH, true).await?;
            if batch.is_empty() {
                return Ok(());
            }
            let grader = Arc::clone(self);
            tokio::spawn(async move {
                drop(grader.judge_batch(batch, true).await);
                drop(place);
            });
        }
    }

    /// Judges one after the other. As soon as a student waits, the rest is left; `all_the_same`: it is not.
    async fn judge_batch(self: &Arc<Self>, batch: Vec<Judging>, all_the_same: bool) -> Result<(), Problem> {
        let mut judged = Vec::with_capacity(batch.len());
        let mut left = batch.into_iter();
        for one in left.by_ref() {
            let lesson = self.lesson(&one.lesson_sha256).await?;
            let grader = Arc::clone(self);
            let outcome = blocking(move || {
                let (answers, wanted) = (&one.answers, Wanted::default());
                let outcome = grading::judge_again(&lesson, &grader.variants, answers, &one.seed, &wanted);
                Ok((one, serde_json::to_string(&outcome).map_err(Problem::internal)?))
            });
            judged.push(outcome.await?);
            if !all_the_same && self.store.students_wait().await? {
                break;
            }
        }
        Ok(self.store.keep_judgings(&judged, left.as_slice()).await?)
    }

    /// Waits until nothing is under way any more; nothing is begun afterwards.
    pub async fn finish(&self, slots: usize) {
        let all = u32::try_from(slots).unwrap_or(u32::MAX);
        drop(self.slots.acquire_many(all).await.map(SemaphorePermit::forget));
    }

    async fn grade(self: &Arc<Self>, job: Job) {
        let keeps = Arc::clone(self);
        let claim = job.claim.clone();
        let renewing = tokio::spawn(async move { keeps.renew(&claim).await });
        let judged = self.judge(&job).await;
        let closed = match judged {
            Ok(judged) => {
                judged.tell(&self.metrics);
                self.close(&job, &Arc::new(judged)).await
            }
            Err(problem) => Err(problem),
        };
        renewing.abort();
        if let Err(problem) = closed {
            // What is wrong may quote the submission: it stands beside it in the gradebook.
            let (id, code) = (job.claim.id.as_str(), problem.code());
            tracing::error!(target: "triad", submission = id, start = job.start, code, "could not be graded");
            // Where this fails too, the lease ends by itself.
            drop(if code == UNREADABLE {
                self.store.leave(&job, &problem.to_string()).await
            } else {
                self.store.give_back(&job, &problem.to_string()).await
            });
        }
    }

    async fn renew(&self, claim: &Claim) {
        loop {
            sleep(self.lease / 4).await;
            if let Ok(false) = self.store.renew(claim, self.lease).await {
                return;
            }
        }
    }

    async fn judge(self: &Arc<Self>, job: &Job) -> Result<Judged, Problem> {
        let lesson = self.lesson(&job.lesson_sha256).await?;
        let accepted = job.accepted.clone();
        let who = Who {
            course: accepted.course,
            whose: accepted.whose,
            student: accepted.student,
            seed: accepted.seed,
        };
        let grader = Arc::clone(self);
        let judge = move || {
            // It is handed in: who sent it need not wait for it.
            let wanted = Wanted::default();
            Judged::new(&grader.variants, lesson, &accepted.body, who, accepted.key, &wanted)
        };
        blocking(judge).await
    }

    /// Closes the claim with the verdict; while the database does not answer, again.
    async fn close(&self, job: &Job, judged: &Arc<Judged>) -> Result<(), Problem> {
        let received = jiff::Timestamp::from_millisecond(job.received_at).map_err(Problem::internal)?;
        loop {
            let closed = match handing::settled(&self.store, judged, job.claim.id.clone(), received).await {
                Ok(new) => self.store.close_claim(&job.claim, &new).await.map_err(Problem::from),
                Err(problem) => Err(problem),
            };
            match closed {
                // Another one has it: what it writes is the same.
                Err(problem) if problem.code() == StoreError::FENCED => return Ok(()),
                Err(problem) if matches!(problem.code(), "database-gone" | "database-busy" | "overtaken") => {
                    sleep(PAUSE).await;
                }
                other => return other,
            }
        }
    }

    /// The lesson with which something was handed in.
    async fn lesson(&self, sha256: &str) -> Result<Lesson, Problem> {
        if let Some(lesson) = self.lessons().get(sha256) {
            return Ok(lesson.clone());
        }
        let bundle = self.store.lesson_version(sha256).await?;
        let lesson = Lesson::from_bundle(&bundle).map_err(|error| {
            let hint = "a grader of the version that took the submission reads it: is one running?";
            Problem::new(StatusCode::INTERNAL_SERVER_ERROR, UNREADABLE, error.to_string(), hint)
        })?;
        let mut kept = self.lessons();
        if kept.len() >= LESSONS {
            kept.clear();
        }
        kept.insert(sha256.to_owned(), lesson.clone());
        Ok(lesson)
    }

    fn lessons(&self) -> std::sync::MutexGuard<'_, HashMap<String, Lesson>> {
        self.lessons.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::expect_used)] // a test that cannot go on says so

    use super::*;
    use crate::store::{Accept, HOME, STARTS, Whose};

    /// A grader of the version before meets a lesson of the next one: as often as it comes, it is not put aside.
    #[tokio::test]
    async fn a_lesson_of_another_version_is_left_to_graders_of_that_version() {
        let store = Arc::new(Store::in_memory());
        let grader = Grader::new(Arc::clone(&store), Arc::default(), Arc::default(), 1, LEASE);
        let accept = Accept {
            course: HOME.into(),
            lesson: "pendulum".into(),
            whose: Whose::Named,
            student: "Ada".into(),
            body: "{}".into(),
            seed: None,
            key: None,
            bundle: r#"{"written by": "a later version"}"#.into(),
            request: "a request".into(),
        };
        store.enqueue(&accept).await.expect("takes it");
        let job = store.claim("grader", LEASE).await.expect("claims").expect("one");
        // Had it been begun, and ended its grader, as often as may be.
        let job = Job { start: STARTS, ..job };
        grader.grade(job.clone()).await;
        assert_eq!(store.gradings().await.expect("counts"), (1, 0), "it waits");
        assert!(store.claim("grader", LEASE).await.expect("claims").is_none(), "others come first");
    }
}
