//! What another version of a lesson would make of what was handed in: looked at before it counts.
//!
//! Each submission is graded twice. First with the lesson that graded it: what differs then is this program's doing, and is
//! shown apart. Then with the new one, after the new verdicts on what the same person handed in before.

use std::collections::{BTreeMap, HashMap, VecDeque};
use std::sync::atomic::Ordering;
use std::sync::{Arc, Mutex, PoisonError, Weak};
use std::time::Instant;

use serde_json::Value;
use triad_lessons::Lesson;

use super::judged::{Progress, by_graders};
use super::regrading::{Graded, Judges, Regrading};
use super::told::{Changed, Counts, PersonChange, Preview};
use super::versions::Lessons;
use crate::aside;
use crate::grades::{Book, Entry, assigned, stands};
use crate::policy::Moment;
use crate::problem::Problem;
use crate::store::{Assignment, NewRegrade, NewVerdict, Recorded, Ruled, Store, StoreError};
use crate::variants::Variants;
use crate::work::Asker;

/// Previews that are kept until they are applied: one that is pushed out is made anew.
const KEPT: usize = 8;
/// Bars of a histogram.
const BARS: u32 = 10;

/// A preview with all that is needed to apply it.
#[derive(Debug)]
pub struct PreparedRegrade {
    /// What is shown.
    pub shown: Preview,
    people: Vec<(PersonChange, Vec<Graded>)>,
    /// The lessons that graded, as bundles: first as it is assigned now.
    bundles: Vec<String>,
    verdicts: usize,
    ruled: Ruled,
    /// What this program computed for it: none where graders did.
    pub made: triad_lessons::Computed,
}

/// Previews that are being made, and those that were made and not applied yet.
#[derive(Debug, Default)]
pub struct Previews {
    kept: Mutex<VecDeque<Arc<PreparedRegrade>>>,
    /// By lesson; of two of one lesson the later is told of.
    coming: Mutex<HashMap<String, Weak<Progress>>>,
}

impl Previews {
    /// A preview of a lesson that begins; it is told of until it is dropped.
    pub fn begin(&self, lesson: &str) -> Arc<Progress> {
        let progress = Arc::new(Progress::default());
        let mut coming = self.coming.lock().unwrap_or_else(PoisonError::into_inner);
        coming.retain(|_, one| one.strong_count() > 0);
        coming.insert(lesson.to_owned(), Arc::downgrade(&progress));
        progress
    }

    /// How far the preview of a lesson is, if one is being made.
    pub fn progress(&self, lesson: &str) -> Option<(usize, usize)> {
        let coming = self.coming.lock().unwrap_or_else(PoisonError::into_inner);
        Some(coming.get(lesson)?.upgrade()?.now())
    }

    /// Keeps one.
    pub fn keep(&self, computed: PreparedRegrade) -> Arc<PreparedRegrade> {
        let computed = Arc::new(computed);
        let mut kept = self.kept.lock().unwrap_or_else(PoisonError::into_inner);
        kept.push_back(Arc::clone(&computed));
        while kept.len() > KEPT {
            kept.pop_front();
        }
        computed
    }

    /// The one of that name.
    ///
    /// Errors if it is not kept any more.
    pub fn get(&self, id: &str) -> Result<Arc<PreparedRegrade>, Problem> {
        let kept = self.kept.lock().unwrap_or_else(PoisonError::into_inner);
        let found = kept.iter().find(|one| one.shown.id == id).cloned();
        Ok(found.ok_or(StoreError::Unknown("preview of a regrade, or it is too old"))?)
    }
}

impl PreparedRegrade {
    /// The verdicts of a submission before and after.
    ///
    /// Errors if it is not among those that were graded again.
    pub fn verdicts(&self, submission: &str) -> Result<(Value, Option<Value>), Problem> {
        let all = self.people.iter().flat_map(|(_, graded)| graded);
        let one = all.into_iter().find(|one| one.record.id == submission);
        let one = one.ok_or(StoreError::Unknown("submission in this regrade"))?;
        Ok((serde_json::from_str(&one.record.body).map_err(Problem::internal)?, one.body.clone()))
    }

    /// What is written to apply it: for everybody, or (`better`) for those alone who do not lose by it, neither now nor by a
    /// verdict that may count later: a decision can be taken back, and more time be given.
    pub fn applied(&self, course: &str, actor: &str, better: bool, reason: &str) -> NewRegrade {
        let chosen = self
            .people
            .iter()
            .filter(|(one, graded)| !better || one.keeps() && !graded.iter().any(Graded::lowers));
        let chosen: Vec<_> = chosen.filter(|(one, _)| !one.submissions.is_empty()).collect();
        let new = chosen.iter().flat_map(|(_, graded)| graded).filter_map(|one| {
            let body = one.body.as_ref()?.to_string();
            let lesson_sha256 = one.version.clone();
            Some(NewVerdict { submission: one.record.id.clone(), lesson_sha256, body })
        });
        NewRegrade {
            course: course.to_owned(),
            lesson: self.shown.lesson.clone(),
            actor: actor.to_owned(),
            choice: if better { "better" } else { "replace" },
            reason: reason.to_owned(),
            bundles: self.bundles.clone(),
            verdicts: self.verdicts,
            ruled: self.ruled.clone(),
            new: new.collect(),
            people: chosen.iter().map(|(one, _)| (one.person.clone(), one.before, one.after)).collect(),
        }
    }
}

/// Grades everything that was handed in to a lesson again, and says under a new name what would change. Nothing of the course is
/// written.
///
/// Errors if the gradebook cannot be read.
pub async fn preview(
    store: &Store,
    id: String,
    course: &str,
    lesson: &Lesson,
    progress: Arc<Progress>,
) -> Result<PreparedRegrade, Problem> {
    let started = Instant::now();
    // Asked for first: what is said meanwhile is then found out as the regrade is applied.
    let ruled = store.ruled(course, &lesson.slug).await?;
    let book = Book::open(store, course, None, Some(&lesson.slug)).await?;
    let assignment = book.assignment(&lesson.slug).cloned().unwrap_or_else(|| Assignment::of(&lesson.slug));
    let new = assigned(lesson, &assignment.policy);
    let records = store.judgeable(course, Some(&lesson.slug)).await?;
    let mut old = HashMap::new();
    for record in &records {
        if !record.lesson_sha256.is_empty() && !old.contains_key(&record.lesson_sha256) {
            let bundle = store.lesson_version(&record.lesson_sha256).await?;
            old.insert(record.lesson_sha256.clone(), Lesson::from_bundle(&bundle).ok());
        }
    }
    let names: HashMap<String, String> =
        store.people(course).await?.into_iter().map(|person| (person.id, person.name)).collect();
    let (verdicts, slug) = (records.len(), lesson.slug.clone());
    let lessons = Lessons::new(old, new, &records);
    let bundles = lessons.new.iter().map(|one| one.bundle.clone()).collect();
    let judges = if store.is_shared() {
        Judges::Graders(by_graders(store, &records, &lessons, &progress).await?)
    } else {
        progress.of.store(verdicts, Ordering::Relaxed);
        Judges::Here(progress)
    };
    // Whoever leaves drops the asker.
    let (_asker, wanted) = Asker::new();
    let again = move || {
        let regrading = Regrading { lessons, judges, variants: Variants::default(), wanted: &wanted };
        let graded = regrading.everybody(&by_person(records));
        wanted.check()?;
        Ok((graded, regrading.variants.known.computed()))
    };
    let (graded, made) = aside::run(again).await?;
    let now = Moment::now();
    let mut people: Vec<(PersonChange, Vec<Graded>)> = graded
        .into_iter()
        .map(|graded| (person_change(&book, &assignment, lesson, &names, &graded, now), graded))
        .collect();
    people.sort_by(|a, b| a.0.name.cmp(&b.0.name));
    let mut shown = summary(&people, crate::grades::possible(lesson));
    (shown.id, shown.lesson) = (id, slug);
    let all = people.iter().flat_map(|(_, graded)| graded);
    shown.of_other_versions = all.filter(|one| one.record.lesson_sha256 != one.version).count();
    shown.seconds = started.elapsed().as_secs_f64();
    Ok(PreparedRegrade { shown, people, bundles, verdicts, ruled, made })
}

/// What each person was told, in the order of the log.
fn by_person(records: Vec<Recorded>) -> Vec<Vec<Recorded>> {
    let mut all: BTreeMap<String, Vec<Recorded>> = BTreeMap::new();
    for record in records {
        all.entry(record.person.clone()).or_default().push(record);
    }
    all.into_values().collect()
}

fn person_change(
    book: &Book,
    assignment: &Assignment,
    lesson: &Lesson,
    names: &HashMap<String, String>,
    graded: &[Graded],
    now: Moment,
) -> PersonChange {
    let person = graded.first().map(|one| one.record.person.clone()).unwrap_or_default();
    let entry = book.of(&person, &lesson.slug).cloned().unwrap_or_default();
    let mut next = entry.clone();
    for handed in &mut next.handed {
        let new = graded.iter().find(|one| one.record.id == handed.id).and_then(|one| one.body.as_ref());
        if let Some(new) = new {
            handed.earned = new["earned"].as_f64().unwrap_or_default();
            handed.judged = new["gradable"] == true;
            handed.pass = None;
        }
    }
    let stands = |entry: &Entry| stands(assignment, entry, lesson, now);
    let (before, after) = (stands(&entry), stands(&next));
    let touched = graded.iter().map(|one| &one.change);
    let touched = touched.filter(|one| one.changed != Changed::Same || one.program.is_some());
    PersonChange {
        name: names.get(&person).cloned().unwrap_or_default(),
        before: before.score.points,
        after: after.score.points,
        passed: [before.score.passed, after.score.passed],
        attempts: [before.turn.attempts, after.turn.attempts],
        submissions: touched.cloned().collect(),
        person,
    }
}

fn summary(people: &[(PersonChange, Vec<Graded>)], possible: f64) -> Preview {
    let mut counts = Counts::default();
    for one in people.iter().flat_map(|(_, graded)| graded) {
        let count = match one.change.changed {
            Changed::Same => &mut counts.same,
            Changed::Words => &mut counts.words,
            Changed::Up => &mut counts.up,
            Changed::Down => &mut counts.down,
            Changed::Gradable => &mut counts.gradable,
            Changed::Failed => &mut counts.failed,
        };
        *count += 1;
        counts.program += usize::from(one.change.program.is_some());
    }
    let histogram = |points: fn(&PersonChange) -> f64| {
        let mut bars = vec![0; BARS as usize];
        for (one, _) in people {
            // Whoever has all points stands in the last bar; at most 10, so nothing is cut off.
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
            let bar = (points(one) / possible * f64::from(BARS)).clamp(0.0, f64::from(BARS - 1)) as usize;
            bars[bar] += 1;
        }
        bars
    };
    Preview {
        id: String::new(),
        lesson: String::new(),
        submissions: people.iter().map(|(_, graded)| graded.len()).sum(),
        of_other_versions: 0,
        counts,
        histogram_before: histogram(|one| one.before),
        histogram_after: histogram(|one| one.after),
        people: people.iter().map(|(one, _)| one.clone()).filter(|one| !one.submissions.is_empty()).collect(),
        seconds: 0.0,
    }
}
