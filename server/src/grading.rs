//! From what a student hands in to a verdict: the same for the page, HTTP and the command line.

use std::collections::BTreeMap;

use axum::http::StatusCode;
use triad_engine::analysis::{AnalysisError, Wanted};
use triad_lessons::answers::{Answer, Submission, SubmissionError};
use triad_lessons::lesson::Lesson;
use triad_lessons::verdict::Verdict;
use triad_lessons::{Attempt, GradeError};

use crate::problem::Problem;
use crate::store::StoredSubmission;
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
        let GradeError::UnknownQuestion { id, .. } = &error else {
            return AnalysisError::NoLongerWanted.into();
        };
        let pointer = format!("/answers/{id}");
        let detail = error.to_string();
        let hint = "answer only the questions of this lesson, by their ids";
        Self::new(StatusCode::UNPROCESSABLE_ENTITY, error.code(), detail.clone(), hint).at(pointer, detail)
    }
}

/// Reads a submission and grades it with the numbers that it is about: those of its seed if it names one, else the
/// student's own. A class gives the seed, whatever the submission says.
///
/// Errors if it cannot be read, its seed or the lesson's numbers are refused, or nobody wants the verdict any more.
pub fn grade(
    lesson: &Lesson,
    variants: &Variants,
    text: &str,
    given: Option<&str>,
    wanted: &Wanted,
) -> Result<(Submission, Verdict), Problem> {
    let submission = Submission::from_json(text)?;
    let lesson = variants.of(lesson, given.unwrap_or_else(|| submission.numbers_of()))?;
    let verdict = triad_lessons::grade_while(&lesson, &submission, &variants.known, wanted)?;
    Ok((submission, verdict))
}

/// Judges what is kept of a submission by itself, without what came before; a class's seed is not told.
///
/// Errors, with a sentence, if the lesson or this program cannot judge it, or nobody wants to know any more.
pub fn judge_again(
    lesson: &Lesson,
    variants: &Variants,
    answers: &str,
    seed: &str,
    wanted: &Wanted,
) -> Result<Verdict, String> {
    let submission = answered(answers)?;
    let own = variants.of(lesson, seed).map_err(|problem| problem.to_string())?;
    triad_lessons::grade_while(&own, &submission, &variants.known, wanted).map_err(|error| error.to_string())
}

/// The answers that are kept of a submission.
///
/// Errors, with a sentence, if this program cannot read them.
pub fn answered(answers: &str) -> Result<Submission, String> {
    Submission::from_json(&format!("{{\"answers\":{answers}}}")).map_err(|error| error.to_string())
}

/// Puts what a student's earlier submissions to the lesson, the oldest first, decide into the verdict of one more.
///
/// Errors if one that is kept cannot be read.
pub fn settle(
    lesson: &Lesson,
    earlier: Vec<StoredSubmission>,
    submission: &Submission,
    verdict: &mut Verdict,
) -> Result<(), Problem> {
    let read = |kept: StoredSubmission| {
        let answers: BTreeMap<String, Answer> =
            serde_json::from_value(kept.answers).map_err(Problem::internal)?;
        let verdict: Verdict = serde_json::from_value(kept.verdict).map_err(Problem::internal)?;
        Ok((answers, verdict))
    };
    let earlier = earlier.into_iter().map(read).collect::<Result<Vec<_>, Problem>>()?;
    let earlier: Vec<Attempt> =
        earlier.iter().map(|(answers, verdict)| Attempt { answers, verdict }).collect();
    triad_lessons::settle(lesson, &earlier, &submission.answers, verdict);
    Ok(())
}
