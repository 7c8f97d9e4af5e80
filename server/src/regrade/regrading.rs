//! All submissions to a lesson graded again, with the lesson that graded them and with a new version of it.

use std::collections::BTreeMap;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use serde_json::Value;
use triad_engine::analysis::Wanted;
use triad_lessons::{Lesson, Verdict};

use super::judged::{Judged, Progress};
use super::told::{Changed, SubmissionChange};
use super::versions::Lessons;
use super::{again, first_difference, replace, stored};
use crate::grading;
use crate::store::{Recorded, StoredSubmission};
use crate::variants::Variants;

/// A submission that was graded again.
#[derive(Debug, Clone)]
pub struct Graded {
    pub record: Recorded,
    pub change: SubmissionChange,
    pub body: Option<Value>,
    /// SHA-256 of the lesson that graded it.
    pub version: String,
}

impl Graded {
    /// Whether the new verdict is worse than the one in force.
    pub fn lowers(&self) -> bool {
        let Some(new) = &self.body else { return false };
        let kept: Value = serde_json::from_str(&self.record.body).unwrap_or_default();
        points(new) < points(&kept) || kept["gradable"] == true && new["gradable"] != true
    }
}

/// Who judges.
pub enum Judges {
    /// This program, beside those who answer.
    Here(Arc<Progress>),
    /// Graders have.
    Graders(Judged),
}

/// A lesson being graded again. It ends early where nobody wants it any more.
pub struct Regrading<'a> {
    pub lessons: Lessons,
    pub judges: Judges,
    /// Of both versions, by all threads: what the change of the lesson does not touch is computed once.
    pub variants: Variants,
    pub wanted: &'a Wanted,
}

impl Regrading<'_> {
    /// Grades again, each person by one thread: what came before decides what a later submission earns.
    pub fn everybody(&self, people: &[Vec<Recorded>]) -> Vec<Vec<Graded>> {
        let next = AtomicUsize::new(0);
        let threads = std::thread::available_parallelism().map_or(1, usize::from).min(people.len().max(1));
        let work = || {
            let mut done = Vec::new();
            while let Some(records) =
                people.get(next.fetch_add(1, Ordering::Relaxed)).filter(|_| self.wanted.is_still())
            {
                done.push(self.person(records));
                if let Judges::Here(progress) = &self.judges {
                    progress.done.fetch_add(records.len(), Ordering::Relaxed);
                }
            }
            done
        };
        std::thread::scope(|scope| {
            // They step back as the thread does that starts them.
            let started: Vec<_> = (0..threads).map(|_| scope.spawn(work)).collect();
            // Nobody is left out in silence: what fails in one fails the preview.
            started
                .into_iter()
                .flat_map(|thread| thread.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)))
                .collect()
        })
    }

    fn person(&self, records: &[Recorded]) -> Vec<Graded> {
        let old = &self.lessons.old;
        let mut known: Vec<StoredSubmission> = Vec::new();
        let mut graded: Vec<Graded> = Vec::new();
        for record in records {
            let earlier = replace(&mut known, record);
            let sha256 = record.lesson_sha256.as_str();
            let lesson = old.get(sha256).and_then(Option::as_ref);
            let judge = |lesson: &Lesson| self.judge(record, lesson, sha256);
            let control = (!sha256.is_empty()).then(|| again(record, lesson, judge, earlier));
            let place = graded.iter().position(|one| one.record.id == record.id).unwrap_or(graded.len());
            let told: Vec<StoredSubmission> = graded[..place].iter().map(newly_stored).collect();
            let new = self.lessons.new_for(&record.id);
            let judge = |lesson: &Lesson| self.judge(record, lesson, &new.sha256);
            let now = again(record, Some(&new.lesson), judge, told).ok();
            let change = submission_change(record, control, now.as_ref());
            let one = Graded { record: record.clone(), change, body: now, version: new.sha256.clone() };
            match graded.get_mut(place) {
                Some(before) => *before = one,
                None => graded.push(one),
            }
        }
        graded
    }

    fn judge(&self, record: &Recorded, lesson: &Lesson, sha256: &str) -> Result<Verdict, String> {
        match &self.judges {
            Judges::Here(_) => {
                grading::judge_again(lesson, &self.variants, &record.answers, &record.seed, self.wanted)
            }
            Judges::Graders(judged) => {
                let found = judged.get(&(record.id.clone(), sha256.to_owned()));
                found.cloned().unwrap_or_else(|| Err("no grader has judged it".to_owned()))
            }
        }
    }
}

/// A submission with its new verdict, or with the one of before where there is none.
fn newly_stored(one: &Graded) -> StoredSubmission {
    let before = stored(&one.record);
    StoredSubmission { verdict: one.body.clone().unwrap_or(before.verdict), ..before }
}

fn submission_change(
    record: &Recorded,
    control: Option<Result<Value, String>>,
    now: Option<&Value>,
) -> SubmissionChange {
    let kept: Value = serde_json::from_str(&record.body).unwrap_or_default();
    let program = match &control {
        Some(Ok(control)) if record.body.as_str() == control.to_string().as_str() => None,
        Some(Ok(control)) => first_difference(&kept, control, ""),
        Some(Err(why)) => Some(why.clone()),
        None => None,
    };
    // What the lesson changes is what differs between two runs of this program.
    let before = control.and_then(Result::ok).unwrap_or(kept);
    let changed = match now {
        None => Changed::Failed,
        Some(now) if before["gradable"] != now["gradable"] => Changed::Gradable,
        Some(now) if points(now) > points(&before) => Changed::Up,
        Some(now) if points(now) < points(&before) => Changed::Down,
        Some(now) if without_version(&before) == without_version(now) => Changed::Same,
        Some(_) => Changed::Words,
    };
    SubmissionChange {
        id: record.id.clone(),
        at: record.at,
        changed,
        before: points(&before),
        after: now.map(points),
        misconceptions: now.map(|now| misconceptions(&before, now)).unwrap_or_default(),
        program,
    }
}

fn points(verdict: &Value) -> f64 {
    verdict["earned"].as_f64().unwrap_or_default()
}

/// A verdict without what names the version of the lesson.
fn without_version(verdict: &Value) -> Value {
    let mut bare = verdict.clone();
    bare["provenance"]["lesson_hash"] = Value::Null;
    bare
}

fn misconceptions(before: &Value, now: &Value) -> BTreeMap<String, [String; 2]> {
    let of = |verdict: &Value| -> BTreeMap<String, String> {
        let all = verdict["questions"].as_array().into_iter().flatten();
        let one = |q: &Value| {
            (
                q["id"].as_str().unwrap_or_default().to_owned(),
                q["slip"].as_str().unwrap_or_default().to_owned(),
            )
        };
        all.map(one).collect()
    };
    let (mut before, now) = (of(before), of(now));
    let pairs = now.into_iter().map(|(id, now)| (before.remove(&id).unwrap_or_default(), (id, now)));
    pairs.filter(|(before, (_, now))| before != now).map(|(before, (id, now))| (id, [before, now])).collect()
}
