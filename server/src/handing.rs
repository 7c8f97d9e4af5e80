//! Handing in: from what is sent to what is kept, the same in the request and by a grader.

use std::sync::Arc;
use std::time::{Duration, Instant};

use serde::Serialize;
use triad_engine::analysis::Wanted;
use triad_lessons::{Lesson, Submission, Verdict};

use crate::blocking;
use crate::grading;
use crate::metrics::Metrics;
use crate::problem::Problem;
use crate::store::{HandIn, Store, StoredSubmission, Whose};
use crate::variants::Variants;

/// A verdict with what names its submission, as it is kept.
#[derive(Debug, Serialize)]
struct KeptVerdict {
    id: String,
    submitted_at: String,
    #[serde(flatten)]
    verdict: Verdict,
}

/// Who hands in.
#[derive(Debug, Clone)]
pub struct Who {
    /// The course.
    pub course: String,
    /// The person.
    pub whose: Whose,
    /// The person's name.
    pub student: String,
    /// The class decides whose numbers these are; at home the submission says it.
    pub seed: Option<String>,
}

impl Who {
    /// The person's id, where it is known.
    pub fn person(&self) -> Option<String> {
        match &self.whose {
            Whose::Person(id) => Some(id.clone()),
            Whose::Named => None,
        }
    }
}

/// What is handed in, judged for itself.
#[derive(Debug)]
pub struct Judged {
    /// As it is assigned.
    pub lesson: Lesson,
    /// Who hands in.
    pub who: Who,
    /// What the sender calls the request.
    pub key: Option<String>,
    submission: Submission,
    verdict: Verdict,
    /// What the numbers were drawn from.
    pub seed: String,
    took: Duration,
}

impl Judged {
    /// Judges what is handed in: without what came before, and without the right answers.
    ///
    /// Errors if it cannot be read, its seed or the lesson's numbers are refused, or nobody wants it any more.
    pub fn new(
        variants: &Variants,
        lesson: Lesson,
        body: &str,
        who: Who,
        key: Option<String>,
        wanted: &Wanted,
    ) -> Result<Self, Problem> {
        let began = Instant::now();
        let (submission, mut verdict) = grading::grade(&lesson, variants, body, who.seed.as_deref(), wanted)?;
        let took = began.elapsed();
        verdict.student = Some(who.student.clone());
        let seed = verdict.provenance.seed.clone();
        if who.seed.is_some() {
            // It would let others compute these numbers.
            verdict.provenance.seed.clear();
        }
        Ok(Self { lesson, who, key, submission, verdict, seed, took })
    }

    /// Tells of it in the log and among the counters, but for who it is of and what it says.
    pub fn tell(&self, metrics: &Metrics) {
        metrics.graded(&self.lesson.slug, self.took);
        let (lesson, gradable) = (self.lesson.slug.as_str(), self.verdict.gradable);
        let ms = self.took.as_secs_f64() * 1e3;
        tracing::info!(target: "triad", lesson, gradable, ms, "graded");
    }

    /// What is kept of it, after what came before: up to the entry `after` of the log. It came at `received`.
    fn settled(
        &self,
        id: &str,
        received: jiff::Timestamp,
        earlier: Vec<StoredSubmission>,
        after: i64,
    ) -> Result<HandIn, Problem> {
        let Self { lesson, who, key, submission, seed, .. } = self;
        let mut verdict = self.verdict.clone();
        grading::settle(lesson, earlier, submission, &mut verdict)?;
        let counted = verdict.gradable;
        let told = KeptVerdict { id: id.to_owned(), submitted_at: format!("{received:.3}"), verdict };
        Ok(HandIn {
            id: told.id.clone(),
            course: who.course.clone(),
            lesson: lesson.slug.clone(),
            whose: who.whose.clone(),
            student: who.student.clone(),
            seed: seed.clone(),
            received_at: received.as_millisecond(),
            answers: serde_json::to_string(&submission.answers).map_err(Problem::internal)?,
            verdict: serde_json::to_value(told).map_err(Problem::internal)?,
            counted,
            after,
            key: key.clone(),
            bundle: lesson.bundle(),
        })
    }
}

/// Settles what was judged with what its author handed in before. Where another submission of theirs comes before this one is
/// kept, it is not kept (`Overtaken`), and settled again with that one.
///
/// Errors if what came before cannot be read.
pub async fn settled(
    store: &Store,
    judged: &Arc<Judged>,
    id: String,
    received: jiff::Timestamp,
) -> Result<HandIn, Problem> {
    let (earlier, after) = earlier(store, judged).await?;
    let settling = Arc::clone(judged);
    blocking(move || settling.settled(&id, received, earlier, after)).await
}

/// What a student has handed in to the lesson, the oldest first, and the last entry of it in the log.
async fn earlier(store: &Store, judged: &Judged) -> Result<(Vec<StoredSubmission>, i64), Problem> {
    let who = &judged.who;
    let person = match &who.whose {
        Whose::Person(id) => Some(id.clone()),
        Whose::Named => store.person_named(&who.course, &who.student).await?,
    };
    let Some(person) = person else { return Ok((Vec::new(), 0)) };
    Ok(store.earlier(&who.course, &person, &judged.lesson.slug).await?)
}
