//! A class keeps the numbers that it was dealt, whatever is mended in its lessons afterwards.

use std::collections::HashMap;

use triad_lessons::{Course, Lesson};

use crate::problem::Problem;
use crate::store::Store;

/// The course as it deals in this class: each lesson draws from the version that dealt here first, as long as both have the same
/// ranges. A lesson that deals here for the first time is kept, for the versions that come after it.
///
/// Errors if the gradebook cannot be read or written.
pub async fn as_before(store: &Store, course: Course) -> Result<Course, Problem> {
    let mut first: HashMap<String, Lesson> = HashMap::new();
    for lesson in course.lessons().iter().chain(course.others()) {
        if !lesson.has_variants() {
            continue;
        }
        let kept = store.lesson_versions(&lesson.slug).await?;
        match kept.iter().find_map(|bundle| dealer(bundle, lesson)) {
            Some(earlier) => drop(first.insert(lesson.slug.clone(), earlier)),
            None => store.keep_lesson(&lesson.slug, &lesson.bundle()).await?,
        }
    }
    Ok(course.with_lessons(|lesson| match first.get(&lesson.slug) {
        Some(earlier) => lesson.dealing_as(earlier),
        None => lesson,
    }))
}

/// A kept version, if it deals from the same ranges and this program can read it.
fn dealer(bundle: &str, lesson: &Lesson) -> Option<Lesson> {
    let is_this = serde_json::from_str::<Version>(bundle).is_ok_and(|version| version.hash == lesson.hash);
    if is_this {
        // It has been read already, and reading takes a while.
        return Some(lesson.clone());
    }
    Lesson::from_bundle(bundle).ok().filter(|earlier| earlier.deals_from_the_same(lesson))
}

/// What of a bundle tells the version.
#[derive(serde::Deserialize)]
struct Version {
    hash: String,
}
