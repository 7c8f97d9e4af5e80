//! Handing in, and looking at what was handed in.

// The documentation macro writes out paths of its own.
#![allow(unused_qualifications)]

use axum::Json as Answer;
use axum::extract::State;
use axum::http::StatusCode;
use axum::response::IntoResponse;
use serde::Deserialize;
use serde_json::{Value, json};
use triad_lessons::Verdict;
use utoipa::IntoParams;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use super::extract::{Asked, At, Json};
use super::lessons;
use crate::app::App;
use crate::problem::{Problem, ProblemDocument};
use crate::store::{Query, Submission};
use crate::{blocking, grading};

/// Longest name of a student, in characters.
const LONGEST_NAME: usize = 100;

pub(super) fn routes() -> OpenApiRouter<App> {
    OpenApiRouter::new().routes(routes!(submit)).routes(routes!(list))
}

/// Hand in answers to a lesson's exercise.
///
/// The verdict has an `id` if the submission was kept. Where an answer cannot be read (text for a number, a unit
/// that does not exist) the verdict says `gradable: false` and what to correct; nothing is kept, no attempt used.
/// Where the author opens the right answers (to those who passed, or after so many attempts), each question has its
/// `reference_html`.
#[utoipa::path(post, path = "/lessons/{slug}/submissions", tag = "submissions", params(("slug" = String, Path)),
    request_body(content = Object, example = json!({"student": "ada", "answers": {"tension": {"value": "29.4", "unit": "N"}}})),
    responses(
    (status = 201, description = "Graded and kept", body = Object),
    (status = 200, description = "Not gradable: says what to correct", body = Object),
    (status = 404, description = "No such lesson", body = ProblemDocument),
    (status = 422, description = "Not a submission", body = ProblemDocument)))]
async fn submit(
    State(app): State<App>,
    At(slug): At<String>,
    Json(body): Json<Value>,
) -> Result<impl IntoResponse, Problem> {
    blocking(move || {
        let lesson = lessons::find(&app, &slug)?;
        let name = body.get("student").and_then(Value::as_str);
        let student = student(name)?;
        let (submission, mut verdict) = grading::grade(lesson, &app.variants, &body.to_string())?;
        let id = uuid::Uuid::new_v4().simple().to_string();
        let submitted_at = format!("{:.3}", jiff::Timestamp::now());
        let gradable = verdict.gradable;
        let described = |verdict: &Verdict| {
            let mut document = serde_json::to_value(verdict).map_err(Problem::internal)?;
            document["student"] = json!(student);
            document["submitted_at"] = json!(submitted_at);
            document["id"] = if gradable { json!(id) } else { Value::Null };
            Ok::<_, Problem>(document)
        };
        // What is kept can be listed by anybody: it goes without the right answers.
        let kept = described(&verdict)?;
        if gradable {
            let attempts = app.store.attempts(&student, &lesson.slug)? + 1;
            grading::open(lesson, &app.variants, &submission, &mut verdict, attempts)?;
        }
        let document = described(&verdict)?;
        if gradable {
            app.store.add(&Submission {
                id: id.clone(),
                lesson: lesson.slug.clone(),
                student: student.clone(),
                submitted_at: submitted_at.clone(),
                answers: serde_json::to_value(&submission.answers).map_err(Problem::internal)?,
                verdict: kept,
            })?;
        }
        let status = if gradable { StatusCode::CREATED } else { StatusCode::OK };
        Ok((status, Answer(document)))
    })
    .await
}

/// Who hands in: a name of reasonable length, without control characters.
fn student(name: Option<&str>) -> Result<String, Problem> {
    let name = name.unwrap_or_default().trim();
    let wrong = if name.is_empty() {
        "the submission does not say whose it is".to_owned()
    } else if name.chars().count() > LONGEST_NAME {
        format!("the student's name has more than {LONGEST_NAME} characters")
    } else if name.chars().any(char::is_control) {
        "the student's name has control characters".to_owned()
    } else {
        return Ok(name.to_owned());
    };
    let hint = r#"add "student": "your name" beside "answers""#;
    Err(Problem::new(StatusCode::UNPROCESSABLE_ENTITY, "invalid-student", wrong.clone(), hint)
        .at("/student", wrong))
}

/// Which submissions to list.
#[derive(Debug, Deserialize, IntoParams)]
#[into_params(parameter_in = Query)]
#[serde(deny_unknown_fields)]
struct Filter {
    /// Only this student's.
    student: Option<String>,
    /// Only for this lesson.
    lesson: Option<String>,
    /// At most so many; 100 if it is not given.
    limit: Option<usize>,
}

/// Files that were handed in are kept, but a list of submissions only tells their lengths.
fn without_files(mut answers: Value) -> Value {
    for answer in answers.as_object_mut().into_iter().flat_map(|map| map.values_mut()) {
        if let Some(length) = answer["file"].as_str().map(str::len) {
            answer["file"] = json!({"bytes": length});
        }
    }
    answers
}

/// Submissions with their verdicts, newest first.
#[utoipa::path(get, path = "/submissions", tag = "submissions", params(Filter), responses(
    (status = 200, description = "The verdicts, and the answers they are about", body = Vec<Object>)))]
async fn list(State(app): State<App>, Asked(filter): Asked<Filter>) -> Result<Answer<Vec<Value>>, Problem> {
    let limit = filter.limit.unwrap_or(100).min(app.limits.submissions);
    let query = Query { student: filter.student, lesson: filter.lesson, limit };
    let found = blocking(move || Ok(app.store.list(&query)?)).await?;
    let documents = found.into_iter().map(|submission| {
        let mut document = submission.verdict;
        document["answers"] = without_files(submission.answers);
        document
    });
    Ok(Answer(documents.collect()))
}
