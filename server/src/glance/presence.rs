//! Who was here a moment ago, and in which lesson. It is kept in memory alone: nobody's hours are recorded.

use std::collections::HashMap;
use std::sync::{Mutex, PoisonError};

use crate::policy::Moment;

/// When somebody last asked this server for something, and in which lesson.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Seen {
    /// When.
    pub at: Moment,
    /// Slug of the lesson that they last read, answered or tried.
    pub lesson: Option<String>,
}

/// Who was here, by person.
#[derive(Debug, Default)]
pub struct Presence(Mutex<HashMap<String, Seen>>);

impl Presence {
    /// Notes that somebody is here; without a lesson they are where they were.
    pub fn note(&self, person: &str, lesson: Option<&str>, at: Moment) {
        let mut all = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let seen = all.entry(person.to_owned()).or_insert(Seen { at, lesson: None });
        seen.at = at;
        if let Some(lesson) = lesson.filter(|lesson| seen.lesson.as_deref() != Some(lesson)) {
            seen.lesson = Some(lesson.to_owned());
        }
    }

    /// Who was here since a moment; who was not is forgotten.
    pub fn since(&self, at: Moment) -> HashMap<String, Seen> {
        let mut all = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        all.retain(|_, seen| seen.at >= at);
        all.clone()
    }
}

/// The lesson that an address of the interface is about.
pub fn lesson_of(path: &str) -> Option<&str> {
    path.strip_prefix("/api/v1/lessons/")?.split('/').next().filter(|slug| !slug.is_empty())
}
