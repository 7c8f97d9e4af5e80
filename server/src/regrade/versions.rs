//! The versions of a lesson that a regrade judges by.

use std::collections::HashMap;

use triad_lessons::Lesson;
use triad_lessons::files::OpensFile;

use crate::store::Recorded;
use crate::store::hash::sha256;

/// The lessons that judged, and the one that is to.
pub struct Lessons {
    /// By SHA-256; none where this program cannot read it.
    pub old: HashMap<String, Option<Lesson>>,
    /// The new one, as it is told of now, and as it was told of when something was handed in.
    pub new: Vec<Version>,
    /// Which of them judges a submission.
    then: HashMap<String, usize>,
}

/// A lesson as a gradebook keeps it.
pub struct Version {
    pub lesson: Lesson,
    /// As [`Lesson::bundle`] writes it.
    pub bundle: String,
    pub sha256: String,
}

impl Version {
    fn of(lesson: Lesson) -> Self {
        let bundle = lesson.bundle();
        Self { sha256: sha256(&bundle), bundle, lesson }
    }
}

impl Lessons {
    /// The new lesson is as it is assigned now. What was told of a submission when it was handed in decides its points, whatever
    /// was set since: the first lesson that judged it says what that was.
    pub fn new(old: HashMap<String, Option<Lesson>>, new: Lesson, records: &[Recorded]) -> Self {
        let mut lessons = Self { old, new: vec![Version::of(new)], then: HashMap::new() };
        for record in records {
            if lessons.then.contains_key(&record.id) {
                continue;
            }
            let first = lessons.old.get(&record.lesson_sha256).and_then(Option::as_ref);
            let (opens, held) = first.map_or_else(|| lessons.now(), |first| (first.opens, first.held));
            let found =
                lessons.new.iter().position(|one| (one.lesson.opens, one.lesson.held) == (opens, held));
            let at = found.unwrap_or_else(|| {
                let mut lesson = lessons.new[0].lesson.clone();
                (lesson.opens, lesson.held) = (opens, held);
                lessons.new.push(Version::of(lesson));
                lessons.new.len() - 1
            });
            lessons.then.insert(record.id.clone(), at);
        }
        lessons
    }

    fn now(&self) -> (OpensFile, bool) {
        (self.new[0].lesson.opens, self.new[0].lesson.held)
    }

    /// The new lesson that judges a submission.
    pub fn new_for(&self, submission: &str) -> &Version {
        &self.new[self.then.get(submission).copied().unwrap_or(0)]
    }
}
