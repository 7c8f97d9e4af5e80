//! Lessons with the numbers of one student, made once and kept for a while, and what grading computed of them.

use std::collections::{HashMap, VecDeque};
use std::sync::{Arc, Mutex, PoisonError};

use axum::http::StatusCode;
use triad_lessons::files::OpensFile;
use triad_lessons::seed::{SeedError, checked};
use triad_lessons::{Known, Lesson, VariantError};

use crate::problem::Problem;

/// Lessons that are kept.
const KEPT: usize = 256;

/// The lessons of students who were here last.
#[derive(Debug, Default)]
pub struct Variants {
    kept: Mutex<Kept>,
    /// What grading computed before.
    pub known: Known,
}

/// Slug and hash of a lesson, the hash of the version that deals, the seed, what opens right answers, and whether verdicts are held
/// back.
type Key = (String, String, String, String, OpensFile, bool);

#[derive(Debug, Default)]
struct Kept {
    lessons: HashMap<Key, Arc<Lesson>>,
    order: VecDeque<Key>,
}

impl Variants {
    /// The lesson with the numbers of a seed: a student's name, or a seed that was chosen. Empty: everybody's.
    ///
    /// Errors if the seed is refused or the lesson has no numbers for it.
    pub fn of(&self, lesson: &Lesson, seed: &str) -> Result<Arc<Lesson>, Problem> {
        let seed = checked(seed)?;
        let seed = seed.as_str();
        if seed.is_empty() {
            return Ok(Arc::new(lesson.for_nobody()));
        }
        // A lesson that was edited since has another hash.
        let (slug, hash, dealer) = (lesson.slug.clone(), lesson.hash.clone(), lesson.dealer_hash());
        let key = (slug, hash, dealer.to_owned(), seed.to_owned(), lesson.opens, lesson.held);
        let kept = self.lock().lessons.get(&key).cloned();
        if let Some(lesson) = kept {
            return Ok(lesson);
        }
        let made = Arc::new(lesson.variant(seed)?);
        let mut kept = self.lock();
        if kept.lessons.insert(key.clone(), made.clone()).is_none() {
            kept.order.push_back(key);
        }
        while kept.order.len() > KEPT {
            if let Some(oldest) = kept.order.pop_front() {
                kept.lessons.remove(&oldest);
            }
        }
        Ok(made)
    }

    fn lock(&self) -> std::sync::MutexGuard<'_, Kept> {
        self.kept.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl From<SeedError> for Problem {
    fn from(error: SeedError) -> Self {
        let hint = "use the student's name";
        Self::new(StatusCode::UNPROCESSABLE_ENTITY, "invalid-seed", error.to_string(), hint)
    }
}

impl From<VariantError> for Problem {
    fn from(error: VariantError) -> Self {
        let hint = "this is the author's mistake, not yours: run `triad lesson check`";
        Self::new(StatusCode::INTERNAL_SERVER_ERROR, error.code(), error.to_string(), hint)
    }
}
