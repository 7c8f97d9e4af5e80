//! Grading as the workbench does it.

use crate::refusal::Refusal;
use pyo3::prelude::*;
use serde_json::json;
use std::path::Path;
use std::sync::OnceLock;
use triad_lessons::{Course, Lesson, Submission};

/// The built-in course, read once.
static BUILT_IN: OnceLock<Course> = OnceLock::new();

/// Does something with a course: that in a folder, or the built-in one.
fn with_course<T>(
    folder: Option<&str>,
    then: impl FnOnce(&Course) -> Result<T, Refusal>,
) -> Result<T, Refusal> {
    if let Some(folder) = folder {
        return then(&Course::load(Path::new(folder))?);
    }
    if let Some(course) = BUILT_IN.get() {
        return then(course);
    }
    let course = Course::embedded()?;
    then(BUILT_IN.get_or_init(|| course))
}

/// The lessons of a course, as JSON: what each is called, and the ids of its questions.
#[pyfunction]
pub fn lessons(py: Python<'_>, course: Option<&str>) -> PyResult<String> {
    let told = py.detach(|| {
        with_course(course, |course| {
            let tell = |lesson: &Lesson| {
                let questions = lesson.exercise.questions.iter().map(|question| &question.id);
                json!({
                    "slug": lesson.slug,
                    "title": lesson.summary().title,
                    "questions": questions.collect::<Vec<_>>(),
                })
            };
            Ok(course.lessons().iter().map(tell).collect::<Vec<_>>())
        })
    })?;
    Ok(serde_json::to_string(&told).map_err(Refusal::from)?)
}

/// The verdict on a submission (JSON), with the numbers of its seed or its student.
#[pyfunction]
pub fn grade(py: Python<'_>, course: Option<&str>, lesson: &str, submission: &str) -> PyResult<String> {
    let verdict = py.detach(|| {
        with_course(course, |course| {
            let known = || course.lessons().iter().map(|lesson| lesson.slug.as_str());
            let lesson = course.lesson(lesson).ok_or_else(|| Refusal::unknown("lesson", lesson, known()))?;
            let submission = Submission::from_json(submission)?;
            let seed = submission.seed.as_deref().or(submission.student.as_deref()).unwrap_or_default();
            let lesson = if seed.is_empty() { lesson.for_nobody() } else { lesson.variant(seed)? };
            Ok(triad_lessons::grade(&lesson, &submission)?)
        })
    })?;
    Ok(serde_json::to_string(&verdict).map_err(Refusal::from)?)
}
