//! Judgements by whoever grades: where graders share the gradebook, they judge again what a regrade asks for, after all that
//! students wait for.

use std::collections::{BTreeSet, HashMap};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};

use axum::http::StatusCode;
use tokio::time::sleep;
use triad_lessons::Verdict;

use super::versions::{Lessons, Version};
use crate::problem::Problem;
use crate::store::{NewJudging, Recorded, Store};

/// How long one request waits: less than proxies do, which give up after a minute. What was judged is kept for the next.
const PATIENCE: Duration = Duration::from_secs(50);
/// The pause between two looks.
const LOOK: Duration = Duration::from_millis(100);

/// Verdicts by themselves, by submission and SHA-256 of the lesson.
pub(super) type Judged = HashMap<(String, String), Result<Verdict, String>>;

/// How far a preview is.
#[derive(Debug, Default)]
pub struct Progress {
    pub(super) done: AtomicUsize,
    pub(super) of: AtomicUsize,
}

impl Progress {
    /// Submissions that were graded again, and those that are to be.
    pub fn now(&self) -> (usize, usize) {
        (self.done.load(Ordering::Relaxed), self.of.load(Ordering::Relaxed))
    }
}

/// Has every submission judged by the lesson that judged it, where that can be read, and by the new one.
///
/// Errors if the gradebook does not answer, or it takes too long.
pub(super) async fn by_graders(
    store: &Store,
    records: &[Recorded],
    lessons: &Lessons,
    progress: &Progress,
) -> Result<Judged, Problem> {
    let mut wanted = BTreeSet::new();
    for record in records {
        wanted.insert((record.id.as_str(), lessons.new_for(&record.id).sha256.as_str()));
        if lessons.old.get(&record.lesson_sha256).is_some_and(Option::is_some) {
            wanted.insert((record.id.as_str(), record.lesson_sha256.as_str()));
        }
    }
    let asked: Vec<NewJudging> = wanted
        .iter()
        .map(|(submission, sha256)| NewJudging {
            submission: (*submission).to_owned(),
            lesson_sha256: (*sha256).to_owned(),
        })
        .collect();
    let new = |one: &Version| (one.sha256.clone(), one.lesson.slug.clone(), one.bundle.clone());
    let new: Vec<_> = lessons.new.iter().map(new).collect();
    store.ask_judgings(&new, &asked).await?;
    let lessons: BTreeSet<&str> = wanted.iter().map(|(_, sha256)| *sha256).collect();
    progress.of.store(asked.len(), Ordering::Relaxed);
    let began = Instant::now();
    loop {
        let mut open = 0;
        for sha256 in &lessons {
            open += store.judgings_open(sha256).await?;
        }
        let done = asked.len().saturating_sub(usize::try_from(open).unwrap_or_default());
        progress.done.store(done, Ordering::Relaxed);
        if open == 0 {
            return read(store, &lessons).await;
        }
        if began.elapsed() > PATIENCE {
            return Err(students_first(open, asked.len()));
        }
        sleep(LOOK).await;
    }
}

async fn read(store: &Store, lessons: &BTreeSet<&str>) -> Result<Judged, Problem> {
    let mut judged = Judged::new();
    for sha256 in lessons {
        for one in store.judged(sha256).await? {
            let outcome = match one.told {
                Some(text) => serde_json::from_str(&text).map_err(Problem::internal)?,
                None => Err("its graders ended".to_owned()),
            };
            judged.insert((one.submission, (*sha256).to_owned()), outcome);
        }
    }
    Ok(judged)
}

fn students_first(open: i64, all: usize) -> Problem {
    Problem::new(
        StatusCode::SERVICE_UNAVAILABLE,
        "students-first",
        format!("{open} of {all} judgements are still to be made: what students hand in goes first"),
        "ask again in a minute: what was judged is kept; or let another grader help (triad grader)",
    )
}
