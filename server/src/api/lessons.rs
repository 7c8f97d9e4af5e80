//! Lessons, as students may see them.

use axum::Json as Answer;
use axum::extract::State;
use axum::http::StatusCode;
use serde::Serialize;
use triad_lessons::course::CourseError;
use triad_lessons::lesson::{Lesson, LessonSummary, LessonView};
use utoipa::ToSchema;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use super::extract::At;
use crate::app::App;
use crate::problem::{Problem, ProblemDocument, suggest};

pub(super) fn routes() -> OpenApiRouter<App> {
    OpenApiRouter::new().routes(routes!(list)).routes(routes!(show)).routes(routes!(hint))
}

impl From<CourseError> for Problem {
    fn from(error: CourseError) -> Self {
        Self::new(
            StatusCode::UNPROCESSABLE_ENTITY,
            error.code(),
            format!("the course was refused: {error}"),
            "correct that file, then run `triad lesson check`",
        )
    }
}

/// The lesson of that name.
pub(super) fn find<'a>(app: &'a App, name: &str) -> Result<&'a Lesson, Problem> {
    app.course.lesson(name).ok_or_else(|| unknown(&app.course, name))
}

/// The answer to the name of a lesson that does not exist.
pub(crate) fn unknown(course: &triad_lessons::Course, name: &str) -> Problem {
    Problem::new(
        StatusCode::NOT_FOUND,
        "unknown-lesson",
        format!("there is no lesson called \"{name}\""),
        suggest(name, course.lessons().iter().map(|lesson| lesson.slug.as_str())),
    )
}

/// The lessons, in the order of the course.
#[utoipa::path(get, path = "/lessons", tag = "lessons", responses(
    (status = 200, description = "Slug, number, title, summary, minutes and objectives of each", body = Vec<Object>)))]
async fn list(State(app): State<App>) -> Answer<Vec<LessonSummary>> {
    Answer(app.course.lessons().iter().map(Lesson::summary).collect())
}

/// A lesson: its text, its scenario and its exercise, without the answers.
#[utoipa::path(get, path = "/lessons/{slug}", tag = "lessons", params(("slug" = String, Path)), responses(
    (status = 200, description = "The lesson", body = Object),
    (status = 404, description = "No such lesson", body = ProblemDocument)))]
async fn show(State(app): State<App>, At(slug): At<String>) -> Result<Answer<LessonView>, Problem> {
    Ok(Answer(find(&app, &slug)?.public_view()))
}

/// One hint.
#[derive(Debug, Serialize, ToSchema)]
struct Hint {
    /// Its text.
    html: String,
}

/// A hint to a question; the first is number 1.
#[utoipa::path(get, path = "/lessons/{slug}/questions/{id}/hints/{k}", tag = "lessons",
    params(("slug" = String, Path), ("id" = String, Path), ("k" = usize, Path)), responses(
    (status = 200, description = "The hint", body = Hint),
    (status = 404, description = "No such lesson, question or hint", body = ProblemDocument)))]
async fn hint(
    State(app): State<App>,
    At((slug, id, k)): At<(String, String, usize)>,
) -> Result<Answer<Hint>, Problem> {
    let lesson = find(&app, &slug)?;
    let question = lesson.question(&id).ok_or_else(|| {
        Problem::new(
            StatusCode::NOT_FOUND,
            "unknown-question",
            format!("the lesson {slug} has no question called \"{id}\""),
            suggest(&id, lesson.exercise.questions.iter().map(|question| question.id.as_str())),
        )
    })?;
    let html = lesson.hint_html(&id, k).ok_or_else(|| {
        Problem::new(
            StatusCode::NOT_FOUND,
            "unknown-hint",
            format!("question {id} has {} hints, there is no number {k}", question.hints.len()),
            "hints are counted from 1",
        )
    })?;
    Ok(Answer(Hint { html }))
}
