//! Handing in, and looking at what was handed in.

// The documentation macro writes out paths of its own.
#![allow(unused_qualifications)]

use std::collections::BTreeMap;

use axum::Json as Answer;
use axum::extract::State;
use axum::http::StatusCode;
use axum::response::IntoResponse;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};
use triad_lessons::Verdict;
use triad_lessons::answers::{RunSettings, TypedValue};
use utoipa::IntoParams;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use crate::api::describe::{PROBLEM, Schemas, of};
use crate::api::extract::{Json, PathParameters, QueryParameters};
use crate::api::lessons;
use crate::app::App;
use crate::problem::Problem;
use crate::store::{Query, StoredSubmission};
use crate::{blocking, grading};

/// Longest name of a student, in characters.
const MAX_NAME_LENGTH: usize = 100;

pub(in crate::api) fn routes(schemas: &mut Schemas) -> OpenApiRouter<App> {
    schemas.request::<triad_lessons::Submission>();
    schemas.answer::<GradedSubmission>();
    schemas.answer::<SubmissionList>();
    OpenApiRouter::new().routes(routes!(submit)).routes(routes!(list))
}

/// The verdict of a submission.
#[derive(Debug, Serialize, JsonSchema)]
struct GradedSubmission {
    /// Its name; null where nothing was graded, hence nothing kept.
    id: Option<String>,
    /// When it came, RFC 3339 in UTC.
    submitted_at: String,
    /// What it earned.
    #[serde(flatten)]
    verdict: Verdict,
}

/// Hand in answers to a lesson's exercise.
///
/// The verdict has an `id` if the submission was kept. Where an answer cannot be read (text for a number, a unit
/// that does not exist) the verdict says `gradable: false` and what to correct; nothing is kept, no attempt used.
/// Where the author opens the right answers (to those who passed, or after so many attempts), each question has its
/// `reference_html`.
#[utoipa::path(post, path = "/lessons/{slug}/submissions", operation_id = "submit_answers", tag = "submissions", params(("slug" = String, Path)),
    request_body(content = ref(of::<triad_lessons::Submission>()), example = json!({"student": "ada", "answers": {"tension": {"value": "29.4", "unit": "N"}}})),
    responses(
    (status = 201, description = "Graded and kept", body = ref(of::<GradedSubmission>())),
    (status = 200, description = "Not gradable: says what to correct", body = ref(of::<GradedSubmission>())),
    (status = 404, description = "No such lesson", body = ref(PROBLEM)),
    (status = 422, description = "Not a submission", body = ref(PROBLEM))))]
async fn submit(
    State(app): State<App>,
    PathParameters(slug): PathParameters<String>,
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
        verdict.student = Some(student.clone());
        let described = |verdict: &Verdict| {
            let graded = GradedSubmission {
                id: gradable.then(|| id.clone()),
                submitted_at: submitted_at.clone(),
                verdict: verdict.clone(),
            };
            serde_json::to_value(graded).map_err(Problem::internal)
        };
        // What is kept can be listed by anybody: it goes without the right answers.
        let kept = described(&verdict)?;
        if gradable {
            let attempts = app.store.attempts(&student, &lesson.slug)? + 1;
            grading::open(lesson, &app.variants, &submission, &mut verdict, attempts)?;
        }
        let document = described(&verdict)?;
        if gradable {
            app.store.add(&StoredSubmission {
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
    } else if name.chars().count() > MAX_NAME_LENGTH {
        format!("the student's name has more than {MAX_NAME_LENGTH} characters")
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
            answer["file"] = json!(KeptFile { bytes: length });
        }
    }
    answers
}

/// A submission that is kept, with its verdict.
#[derive(Debug, Serialize, JsonSchema)]
struct KeptSubmission {
    /// What was handed in, by the question's id.
    #[schemars(with = "BTreeMap<String, KeptAnswer>")]
    answers: Value,
    /// The verdict, as it was given.
    #[serde(flatten)]
    #[schemars(with = "GradedSubmission")]
    verdict: Value,
}

/// The answer to one question, as it is kept.
#[derive(Serialize, JsonSchema)]
struct KeptAnswer {
    /// A number, a list of numbers, or a formula, as typed.
    #[serde(skip_serializing_if = "Option::is_none")]
    value: Option<TypedValue>,
    /// The unit of the value, as typed.
    #[serde(skip_serializing_if = "Option::is_none")]
    unit: Option<String>,
    /// The id of the option that was chosen.
    #[serde(skip_serializing_if = "Option::is_none")]
    choice: Option<String>,
    /// The file that was handed in.
    #[serde(skip_serializing_if = "Option::is_none")]
    file: Option<KeptFile>,
    /// The settings of a run.
    #[serde(skip_serializing_if = "Option::is_none")]
    settings: Option<RunSettings>,
}

/// A file that was handed in.
#[derive(Debug, Serialize, JsonSchema)]
struct KeptFile {
    /// Its length.
    bytes: usize,
}

/// Submissions, newest first.
#[derive(Debug, Serialize, JsonSchema)]
struct SubmissionList(Vec<KeptSubmission>);

/// Submissions with their verdicts, newest first.
#[utoipa::path(get, path = "/submissions", operation_id = "list_submissions", tag = "submissions", params(Filter), responses(
    (status = 200, description = "The verdicts, and the answers they are about", body = ref(of::<SubmissionList>()))))]
async fn list(
    State(app): State<App>,
    QueryParameters(filter): QueryParameters<Filter>,
) -> Result<Answer<SubmissionList>, Problem> {
    let limit = filter.limit.unwrap_or(100).min(app.limits.submissions);
    let query = Query { student: filter.student, lesson: filter.lesson, limit };
    let found = blocking(move || Ok(app.store.list(&query)?)).await?;
    let kept = found.into_iter().map(|submission| KeptSubmission {
        answers: without_files(submission.answers),
        verdict: submission.verdict,
    });
    Ok(Answer(SubmissionList(kept.collect())))
}
