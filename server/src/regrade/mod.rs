//! Grading again what was handed in, with the lesson that graded it then.

mod told;
mod versions;

mod judged;

mod regrading;

mod preview;

use std::collections::HashMap;

use serde::Serialize;
use serde_json::{Value, json};
use triad_engine::analysis::Wanted;
use triad_lessons::{Lesson, Verdict};

use crate::grading;
use crate::problem::Problem;
use crate::store::{Recorded, Store, StoredSubmission};
use crate::variants::Variants;

pub use judged::Progress;
pub use preview::{Previews, preview};
pub use told::{Changed, Counts, PersonChange, Preview, SubmissionChange};

/// What came of grading a course again.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct Rebuilt {
    /// Verdicts that came out as they are kept, byte for byte.
    pub same: usize,
    /// Verdicts that come out otherwise: this program differs from the one that made them.
    pub changed: Vec<Change>,
    /// Verdicts whose lesson is not kept: those of a gradebook of format 1.
    pub without_lesson: usize,
}

/// A verdict that comes out otherwise.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Change {
    /// The submission.
    pub submission: String,
    /// Slug of the lesson.
    pub lesson: String,
    /// Which program made the verdict.
    pub build: String,
    /// Points then.
    pub before: f64,
    /// Points now; none where this program cannot grade it at all.
    pub now: Option<f64>,
    /// The first thing that differs.
    pub difference: String,
}

/// Grades all submissions of a course again, each with the lesson, the seed and the answers that are kept, and compares.
/// Nothing is written. What was handed in by whoever is erased is not there to be graded.
///
/// Errors if the gradebook cannot be read.
pub async fn check(store: &Store, course: &str) -> Result<Rebuilt, Problem> {
    let mut rebuilt = Rebuilt::default();
    let mut lessons: HashMap<String, Option<Lesson>> = HashMap::new();
    let (variants, wanted) = (Variants::default(), Wanted::default());
    // Earlier submissions decide what a later one can still earn, by the verdicts that were in force when it was judged.
    let mut known: HashMap<(String, String), Vec<StoredSubmission>> = HashMap::new();
    for record in store.judgeable(course, None).await? {
        let all = known.entry((record.person.clone(), record.lesson.clone())).or_default();
        let earlier = replace(all, &record);
        if record.lesson_sha256.is_empty() {
            rebuilt.without_lesson += 1;
            continue;
        }
        if !lessons.contains_key(&record.lesson_sha256) {
            let bundle = store.lesson_version(&record.lesson_sha256).await?;
            lessons.insert(record.lesson_sha256.clone(), Lesson::from_bundle(&bundle).ok());
        }
        let lesson = lessons.get(&record.lesson_sha256).and_then(Option::as_ref);
        let judge =
            |lesson: &Lesson| grading::judge_again(lesson, &variants, &record.answers, &record.seed, &wanted);
        match again(&record, lesson, judge, earlier) {
            // As texts: byte for byte.
            Ok(now) if record.body == format!("{now}") => rebuilt.same += 1,
            now => rebuilt.changed.push(change(&record, now)),
        }
    }
    Ok(rebuilt)
}

/// Puts a verdict into those in force of a person in a lesson, in the order of the submissions; those before it.
fn replace(all: &mut Vec<StoredSubmission>, record: &Recorded) -> Vec<StoredSubmission> {
    let place = all.iter().position(|other| other.id == record.id).unwrap_or(all.len());
    let earlier = all[..place].to_vec();
    match all.get_mut(place) {
        Some(before) => *before = stored(record),
        None => all.push(stored(record)),
    }
    earlier
}

/// The verdict as it would be kept now.
fn again(
    record: &Recorded,
    lesson: Option<&Lesson>,
    judge: impl FnOnce(&Lesson) -> Result<Verdict, String>,
    earlier: Vec<StoredSubmission>,
) -> Result<Value, String> {
    let lesson = lesson.ok_or("this program cannot read the lesson")?;
    let before: Value = serde_json::from_str(&record.body).map_err(|error| error.to_string())?;
    let submission = grading::answered(&record.answers)?;
    let mut verdict = judge(lesson)?;
    verdict.student = before["student"].as_str().map(str::to_owned);
    if before["provenance"]["seed"] == "" {
        // A class does not tell it.
        verdict.provenance.seed.clear();
    }
    let settled = grading::settle(lesson, earlier, &submission, &mut verdict);
    settled.map_err(|problem| problem.to_string())?;
    let mut now = serde_json::to_value(verdict).map_err(|error| error.to_string())?;
    for name in ["id", "submitted_at"] {
        now[name] = before[name].clone();
    }
    Ok(now)
}

/// A record as it was listed when a later submission came.
fn stored(record: &Recorded) -> StoredSubmission {
    StoredSubmission {
        id: record.id.clone(),
        lesson: record.lesson.clone(),
        student: String::new(),
        answers: serde_json::from_str(&record.answers).unwrap_or_default(),
        verdict: serde_json::from_str(&record.body).unwrap_or_default(),
    }
}

fn change(record: &Recorded, now: Result<Value, String>) -> Change {
    let before: Value = serde_json::from_str(&record.body).unwrap_or_default();
    let (points, difference) = match now {
        Ok(now) => (now["earned"].as_f64(), first_difference(&before, &now, "")),
        Err(why) => (None, Some(why)),
    };
    Change {
        submission: record.id.clone(),
        lesson: before["lesson"].as_str().unwrap_or_default().to_owned(),
        build: record.build.clone(),
        before: before["earned"].as_f64().unwrap_or_default(),
        now: points,
        difference: difference.unwrap_or_else(|| "the order of its parts".to_owned()),
    }
}

/// Where two documents differ first, with what stands there.
fn first_difference(before: &Value, now: &Value, place: &str) -> Option<String> {
    match (before, now) {
        (Value::Object(a), Value::Object(b)) => {
            let names = a.keys().chain(b.keys().filter(|name| !a.contains_key(*name)));
            let none = json!(null);
            names.into_iter().find_map(|name| {
                let (a, b) = (a.get(name).unwrap_or(&none), b.get(name).unwrap_or(&none));
                first_difference(a, b, &format!("{place}/{name}"))
            })
        }
        (Value::Array(a), Value::Array(b)) if a.len() == b.len() => {
            let mut pairs = a.iter().zip(b).enumerate();
            pairs.find_map(|(k, (a, b))| first_difference(a, b, &format!("{place}/{k}")))
        }
        (a, b) if a == b => None,
        (a, b) => Some(format!("{place}: {b} instead of {a}")),
    }
}
