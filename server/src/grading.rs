//! From what a student hands in to a verdict: the same for the page, HTTP and the command line.

use axum::http::StatusCode;
use triad_lessons::GradeError;
use triad_lessons::answers::{Submission, SubmissionError};
use triad_lessons::lesson::Lesson;
use triad_lessons::verdict::Verdict;

use crate::problem::Problem;
use crate::variants::Variants;

impl From<SubmissionError> for Problem {
    fn from(error: SubmissionError) -> Self {
        let status = match &error {
            SubmissionError::Unreadable { .. } => StatusCode::UNPROCESSABLE_ENTITY,
            SubmissionError::TooLarge { .. } => StatusCode::PAYLOAD_TOO_LARGE,
        };
        let problem = Self::new(status, error.code(), error.to_string(), error.hint());
        match error {
            SubmissionError::Unreadable { place, problem: what } if place != "submission" => {
                problem.at(format!("/{}", place.replace(['.', '['], "/").replace(']', "")), what)
            }
            SubmissionError::Unreadable { problem: what, .. } => problem.at("", what),
            SubmissionError::TooLarge { .. } => problem,
        }
    }
}

impl From<GradeError> for Problem {
    fn from(error: GradeError) -> Self {
        let GradeError::UnknownQuestion { id, .. } = &error;
        let pointer = format!("/answers/{id}");
        let detail = error.to_string();
        let hint = "answer only the questions of this lesson, by their ids";
        Self::new(StatusCode::UNPROCESSABLE_ENTITY, error.code(), detail.clone(), hint).at(pointer, detail)
    }
}

/// Reads a submission and grades it with the numbers that it is about: those of its seed if it names one, else the
/// student's own.
///
/// Errors if it cannot be read, or its seed or the lesson's numbers are refused.
pub fn grade(lesson: &Lesson, variants: &Variants, text: &str) -> Result<(Submission, Verdict), Problem> {
    let submission = Submission::from_json(text)?;
    let lesson = variants.of(lesson, seed(&submission))?;
    let verdict = triad_lessons::grade(&lesson, &submission)?;
    Ok((submission, verdict))
}

/// Adds the right answers to a verdict if the author opens them after so many attempts, this one included.
///
/// Errors if the gradebook cannot be read.
pub fn open(
    lesson: &Lesson,
    variants: &Variants,
    submission: &Submission,
    verdict: &mut Verdict,
    attempts: usize,
) -> Result<(), Problem> {
    let lesson = variants.of(lesson, seed(submission))?;
    triad_lessons::open(&lesson, verdict, attempts);
    Ok(())
}

fn seed(submission: &Submission) -> &str {
    submission.seed.as_deref().or(submission.student.as_deref()).unwrap_or_default()
}
