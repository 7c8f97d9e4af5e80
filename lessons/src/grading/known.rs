//! What grading computed before: runs of references, runs with settings, and judgements of work.
//!
//! Many students are asked the same, hand in again what they handed in before, and are graded by two versions of a lesson: what
//! depends on nothing else is computed once. Whatever is found here is what would be computed, to the last bit.

use std::collections::VecDeque;
use std::fmt;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use triad_engine::analysis::Wanted;
use triad_engine::scene::Scene;

use crate::answers::Answer;
use crate::exercise::{QuestionBody, Trajectory};
use crate::files::MeasuredFile;
use crate::scenario::measure::MeasureError;
use crate::tasks::trajectory::ReferenceMotion;
use crate::verdict::feedback::Judgement;

/// References that are kept: some of each lesson of a course.
const REFERENCES: usize = 64;
/// Runs with settings: those of the curves of some questions.
const RUNS: usize = 256;
/// Motions, of some 64 kB each: one for each number that may be drawn.
const MOTIONS: usize = 96;
/// Judgements: the two versions of a lesson ask one after the other, in some threads. An answer may have a megabyte.
const JUDGEMENTS: usize = 16;

/// What grading computed before, for those who grade the same again. It forgets what was not asked for longest.
#[derive(Debug)]
pub struct Known {
    pub(super) references: Kept<(Scene, MeasuredFile), Result<Vec<f64>, MeasureError>>,
    pub(super) runs: Kept<Run, Result<Made, MeasureError>>,
    pub(super) motions: Kept<Trajectory, Result<Arc<ReferenceMotion>, MeasureError>>,
    pub(super) judgements: Kept<Asked, Judgement>,
}

impl Default for Known {
    fn default() -> Self {
        Self {
            references: Kept::new(REFERENCES),
            runs: Kept::new(RUNS),
            motions: Kept::new(MOTIONS),
            judgements: Kept::new(JUDGEMENTS),
        }
    }
}

impl Known {
    /// How much was computed.
    pub fn computed(&self) -> Computed {
        let of = |made: &AtomicUsize| made.load(Ordering::Relaxed);
        Computed {
            references: of(&self.references.made) + of(&self.motions.made),
            runs: of(&self.runs.made),
            judgements: of(&self.judgements.made),
        }
    }
}

/// How much grading computed, and did not know before.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Computed {
    /// Values and motions by tight runs.
    pub references: usize,
    /// Runs with chosen settings.
    pub runs: usize,
    /// Judgements of programs, tables, scenes and settings.
    pub judgements: usize,
}

/// A run with chosen settings.
#[derive(Debug, PartialEq)]
pub(super) struct Run {
    /// The scene with the settings.
    pub scene: Scene,
    /// What is measured at its end.
    pub watch: MeasuredFile,
    /// Evaluations after which it is given up.
    pub most: u64,
}

/// What came of it.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Made {
    pub evaluations: u64,
    /// What was measured; none if it did not come to its end.
    pub value: Option<Vec<f64>>,
    /// How far the constraints are violated at the end.
    pub violation: f64,
}

/// An answer to a question that is answered by work, with all that its judgement depends on.
#[derive(Debug, PartialEq)]
pub(super) struct Asked {
    // First, as it differs most often.
    pub answer: Answer,
    pub note: String,
    /// Of the instances of a program's question; empty for the others.
    pub seed: String,
    pub body: QuestionBody,
}

/// Results by what they were computed from.
pub(super) struct Kept<K, V> {
    most: usize,
    made: AtomicUsize,
    /// The one that was asked for last at the end.
    list: Mutex<VecDeque<(K, V)>>,
}

impl<K: PartialEq, V: Clone> Kept<K, V> {
    fn new(most: usize) -> Self {
        Self { most, made: AtomicUsize::new(0), list: Mutex::default() }
    }

    /// What `make` says of the key, or has said. Nobody waits for another: two who ask at once for what is not known both
    /// compute it. What ends early as it is not wanted any more is not kept.
    pub(super) fn of(&self, key: K, wanted: &Wanted, make: impl FnOnce(&K) -> V) -> V {
        if let Some(found) = self.find(&key) {
            return found;
        }
        self.made.fetch_add(1, Ordering::Relaxed);
        let value = make(&key);
        if wanted.is_still() {
            let mut list = self.list.lock().unwrap_or_else(PoisonError::into_inner);
            if list.len() == self.most {
                list.pop_front();
            }
            list.push_back((key, value.clone()));
        }
        value
    }

    fn find(&self, key: &K) -> Option<V> {
        let mut list = self.list.lock().unwrap_or_else(PoisonError::into_inner);
        let place = list.iter().rposition(|(known, _)| known == key)?;
        let found = list.remove(place)?;
        let value = found.1.clone();
        list.push_back(found);
        Some(value)
    }
}

impl<K, V> fmt::Debug for Kept<K, V> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Kept").field("made", &self.made).finish_non_exhaustive()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeMap;

    use crate::answers::{RunSettings, Submission, TypedValue};
    use crate::exercise::Tuning;
    use crate::{Course, grade_if};

    #[test]
    fn what_was_asked_for_longest_ago_is_forgotten_and_what_ended_early_is_not_kept() {
        let kept: Kept<u32, u32> = Kept::new(2);
        let wanted = Wanted::default();
        let ask = |key: u32| kept.of(key, &wanted, |key| 10 * key);
        let made = || kept.made.load(Ordering::Relaxed);
        assert_eq!((ask(1), ask(2), ask(1), made()), (10, 20, 10, 2));
        // The second was not asked for since.
        assert_eq!((ask(3), ask(1), made()), (30, 10, 3));
        assert_eq!((ask(2), made()), (20, 4));
        let left = Wanted::default();
        let value = kept.of(7, &left, |_| {
            left.no_longer();
            0
        });
        assert_eq!((value, ask(7), made()), (0, 70, 6));
    }

    #[test]
    fn what_all_are_asked_is_computed_once_and_judged_as_if_nothing_were_known() {
        let course = Course::embedded().unwrap();
        let lesson = course.lesson("work-and-precision").unwrap();
        let task = lesson.exercise.questions.iter().find(|q| matches!(q.body, QuestionBody::Tuning(_)));
        let id = &task.unwrap().id;
        let known = Known::default();
        let grade = |seed: &str, settings: &RunSettings| {
            let own = lesson.variant(seed).unwrap();
            let answer = Answer { settings: Some(settings.clone()), ..Answer::default() };
            let answers = BTreeMap::from([(id.clone(), answer)]);
            let submission = Submission { answers, ..Submission::default() };
            let verdict = grade_if(&own, &submission, &known, &Wanted::default()).unwrap();
            assert_eq!(verdict, crate::grade(&own, &submission).unwrap());
            known.computed()
        };
        let Some(QuestionBody::Tuning(Tuning { reference, .. })) = task.map(|q| &q.body) else { panic!() };
        let first = grade("ada", reference);
        assert_eq!((first.references, first.judgements), (1, 1));
        assert_eq!((grade("bob", reference), grade("ada", reference)), (first, first));
        // Those of the curves are known by now.
        let coarse = RunSettings { tolerance: TypedValue::Number(1e-3), ..reference.clone() };
        assert_eq!(grade("cyd", &coarse), Computed { judgements: 2, ..first });
    }
}
