//! What grading computed before: runs of references, runs with settings, and judgements of work.
//!
//! Many students are asked the same, hand in again what they handed in before, and are graded by two versions of a lesson: what
//! depends on nothing else is computed once. Whatever is found here is what would be computed, to the last bit.

use std::collections::{BTreeMap, VecDeque};
use std::fmt;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use triad_engine::analysis::Wanted;
use triad_engine::scene::Scene;

use crate::answers::Answer;
use crate::exercise::{ModelTask, QuestionBody, Trajectory};
use crate::files::MeasuredFile;
use crate::scenario::measure::MeasureError;
use crate::tasks::authors_model::AuthorsModel;
use crate::tasks::harmonic::Waves;
use crate::tasks::trajectory::ReferenceMotion;
use crate::tasks::wrong_motions::{self, Shown};
use crate::verdict::feedback::{Judgement, MotionFinding};

/// References that are kept: some of each lesson of a course.
const REFERENCES: usize = 64;
/// Runs with settings: those of the curves of some questions.
const RUNS: usize = 256;
/// Motions, of some 64 kB each: one for each number that may be drawn.
const MOTIONS: usize = 96;
/// Motions that mistakes lead to, of some 6 kB each: five for each number that may be drawn.
const SHOWN: usize = 512;
/// Harmonic motions at the times of a table, of 4 MB: most students write a row at the same times.
const WAVES: usize = 2;
/// Judgements: the two versions of a lesson ask one after the other, in some threads. An answer may have a megabyte.
const JUDGEMENTS: usize = 16;

/// What grading computed before, for those who grade the same again. It forgets what was not asked for longest.
#[derive(Debug)]
pub struct Known {
    pub(super) references: Kept<(Scene, MeasuredFile), Result<Vec<f64>, MeasureError>>,
    pub(super) runs: Kept<Run, Result<Made, MeasureError>>,
    pub(super) motions: Kept<Trajectory, Result<Arc<ReferenceMotion>, MeasureError>>,
    pub(super) models: Kept<ModelTask, Result<Arc<AuthorsModel>, MeasureError>>,
    pub(super) judgements: Kept<Asked, Judgement>,
    findings: Kept<(Looked, Vec<Vec<f64>>), MotionFinding>,
    shown: Kept<Looked, Shown>,
    waves: Kept<Vec<f64>, Arc<Waves>>,
}

impl Default for Known {
    fn default() -> Self {
        Self {
            references: Kept::new(REFERENCES),
            runs: Kept::new(RUNS),
            motions: Kept::new(MOTIONS),
            models: Kept::new(REFERENCES),
            judgements: Kept::new(JUDGEMENTS),
            findings: Kept::new(JUDGEMENTS),
            shown: Kept::new(SHOWN),
            waves: Kept::new(WAVES),
        }
    }
}

impl Known {
    /// How much was computed.
    pub fn computed(&self) -> Computed {
        let of = |made: &AtomicUsize| made.load(Ordering::Relaxed);
        Computed {
            references: of(&self.references.made) + of(&self.motions.made) + of(&self.models.made),
            runs: of(&self.runs.made),
            judgements: of(&self.judgements.made),
            mistaken: of(&self.shown.made),
            waves: of(&self.waves.made),
        }
    }

    /// What a scene shows of what a question asks for, at the times of a table.
    pub(super) fn shown(&self, task: &Trajectory, scene: &Scene, times: &[f64], wanted: &Wanted) -> Shown {
        let run = |at: &Looked| wrong_motions::run(&at.scene, &at.columns, at.end, &at.times, wanted);
        self.shown.of(Looked::new(task, scene, times), wanted, run)
    }

    /// What `look` finds off with a table, or has found: the points that it earns have no part in it.
    pub(super) fn finding(
        &self,
        task: &Trajectory,
        times: &[f64],
        given: &[Vec<f64>],
        wanted: &Wanted,
        look: impl Fn(&[f64], &[Vec<f64>]) -> MotionFinding,
    ) -> MotionFinding {
        let key = (Looked::new(task, &task.scene, times), given.to_vec());
        self.findings.of(key, wanted, |(at, given)| look(&at.times, given))
    }

    /// Harmonic motions at the times of a table.
    pub(super) fn waves(&self, times: &[f64], wanted: &Wanted) -> Arc<Waves> {
        self.waves.of(times.to_vec(), wanted, |times| Arc::new(Waves::new(times)))
    }
}

/// How much grading computed, and did not know before.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Computed {
    /// Values and motions by tight runs, and what authors' scenes show.
    pub references: usize,
    /// Runs with chosen settings.
    pub runs: usize,
    /// Judgements of programs, tables, scenes and settings.
    pub judgements: usize,
    /// Runs of scenes with a mistake in them.
    pub mistaken: usize,
    /// Harmonic motions for the times of tables.
    pub waves: usize,
}

/// A scene that a table is compared with, and where.
#[derive(Debug, PartialEq)]
struct Looked {
    scene: Scene,
    columns: BTreeMap<String, MeasuredFile>,
    end: f64,
    times: Vec<f64>,
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
    /// Of the instances of a program's question; empty for the others.
    pub seed: String,
    pub body: QuestionBody,
}

impl Looked {
    fn new(task: &Trajectory, scene: &Scene, times: &[f64]) -> Self {
        Self { scene: scene.clone(), columns: task.columns.clone(), end: task.end, times: times.to_vec() }
    }
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
    use std::fmt::Write as _;

    use crate::answers::{RunSettings, Submission, TypedValue};
    use crate::exercise::Tuning;
    use crate::{Course, grade_while};

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
    fn wrong_tables_of_the_same_numbers_share_the_motions_of_mistakes() {
        let course = Course::embedded().unwrap();
        let lesson = course.lesson("verification").unwrap();
        let known = Known::default();
        let table = |swing: f64| {
            let mut text = "t,x,y\n".to_owned();
            for k in 0..=400 {
                let t = f64::from(k) / 40.0;
                let (x, y) = (-libm::cos(2.0 * t) - swing * t, -swing * libm::sin(t * t));
                let _ = writeln!(text, "{t},{x},{y}");
            }
            text
        };
        let grade = |swing: f64| {
            let answer = Answer { file: Some(table(swing)), ..Answer::default() };
            let answers = BTreeMap::from([("your-run".to_owned(), answer)]);
            let submission = Submission { answers, ..Submission::default() };
            let verdict = grade_while(lesson, &submission, &known, &Wanted::default()).unwrap();
            assert_eq!(verdict, crate::grade(lesson, &submission).unwrap());
            known.computed()
        };
        let first = grade(0.3);
        let once = Computed { references: 1, runs: 0, judgements: 1, mistaken: 5, waves: 1 };
        assert_eq!(first, once);
        assert_eq!(grade(0.4), Computed { judgements: 2, ..once });
        assert_eq!(grade(0.3), Computed { judgements: 2, ..once });
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
            let verdict = grade_while(&own, &submission, &known, &Wanted::default()).unwrap();
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
