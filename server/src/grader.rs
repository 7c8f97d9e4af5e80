//! Grading what waits: the loop of `triad grader`, and of each server for what it could not answer at once.

use std::collections::HashMap;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use tokio::sync::{Semaphore, SemaphorePermit};
use tokio::time::sleep;
use triad_lessons::Lesson;

use crate::blocking;
use crate::handing::{self, Judged, Who};
use crate::metrics::Metrics;
use crate::problem::Problem;
use crate::store::{Claim, Job, Store, StoreError, identifier};
use crate::variants::Variants;

/// How long a claim holds, unless it is renewed. A grader that ends holds up what it had for as long.
pub const LEASE: Duration = Duration::from_secs(15);
/// How long a grader waits where the database does not answer.
const PAUSE: Duration = Duration::from_millis(500);
/// Lessons that are kept: as many as a course has.
const LESSONS: usize = 64;

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
                match self.store.claim(&self.name, self.lease).await {
                    Ok(Some(job)) => {
                        let grader = Arc::clone(&self);
                        tokio::spawn(async move {
                            grader.grade(job).await;
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
            drop(self.store.give_back(&job, &problem.to_string()).await);
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
        blocking(move || Judged::new(&grader.variants, lesson, &accepted.body, who, accepted.key)).await
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
        let lesson = Lesson::from_bundle(&bundle).map_err(Problem::internal)?;
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
