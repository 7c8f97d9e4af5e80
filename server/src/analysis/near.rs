//! How near wrong answers were, found once: what was handed in does not change.

use std::collections::HashMap;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};

use triad_lessons::answers::Answer;
use triad_lessons::{Lesson, near};

use super::work::Work;
use crate::problem::Problem;
use crate::variants::Variants;

/// Wrong answers within so many tolerances are almost right.
const ALMOST: f64 = 3.0;
/// Answers that are remembered, of some hundred bytes each: those of a class of 300 to some questions.
const KEPT: usize = 50_000;

/// Hash of the lesson, question and submission.
type Key = (String, String, String);

/// Which wrong answers are almost right.
#[derive(Debug, Default)]
pub struct Near {
    kept: Mutex<HashMap<Key, bool>>,
    drawn: AtomicUsize,
}

impl Near {
    /// Whether one of the wrong answers of a student is almost right. The student's numbers are drawn only for answers that were
    /// not looked at before.
    ///
    /// Errors if they cannot be drawn.
    pub(super) fn almost(
        &self,
        lesson: &Lesson,
        variants: &Variants,
        question: &str,
        work: &Work,
    ) -> Result<bool, Problem> {
        let mut own = None;
        let mut any = false;
        for one in work.judged().filter(|one| one.wrong().is_some()) {
            let key = (lesson.hash.clone(), question.to_owned(), one.submission.clone());
            let known = self.lock().get(&key).copied();
            if let Some(known) = known {
                any |= known;
                continue;
            }
            if own.is_none() {
                self.drawn.fetch_add(1, Ordering::Relaxed);
                own = Some(variants.of(lesson, &work.seed)?);
            }
            let answer = serde_json::from_value::<Answer>(one.answer.clone()).ok();
            let apart = own.as_ref().zip(answer).and_then(|(own, answer)| near(own, question, &answer));
            let is_near = apart.is_some_and(|tolerances| tolerances <= ALMOST);
            self.keep(key, is_near);
            any |= is_near;
        }
        Ok(any)
    }

    /// For how many looks numbers of a student were asked for.
    pub fn drawn(&self) -> usize {
        self.drawn.load(Ordering::Relaxed)
    }

    fn keep(&self, key: Key, is_near: bool) {
        let mut kept = self.lock();
        // It is found again as it is looked for.
        if kept.len() >= KEPT {
            kept.clear();
        }
        kept.insert(key, is_near);
    }

    fn lock(&self) -> MutexGuard<'_, HashMap<Key, bool>> {
        self.kept.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
