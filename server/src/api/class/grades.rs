//! What everybody has reached, and decisions about it.

// The documentation macro writes out paths of its own.
#![allow(unused_qualifications)]

use axum::Json as Answer;
use axum::extract::State;
use axum::http::StatusCode;
use schemars::JsonSchema;
use serde::Deserialize;
use triad_lessons::Lesson;
use utoipa::IntoParams;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use super::assignments::text_of;
use crate::api::describe::{PROBLEM, Schemas, of};
use crate::api::extract::{Json, PathParameters, QueryParameters};
use crate::api::guard::Caller;
use crate::api::lessons;
use crate::api::lessons::submissions::{SubmissionList, listed};
use crate::app::App;
use crate::grades::{GradeTable, possible, table};
use crate::policy::Moment;
use crate::problem::Problem;
use crate::store::{CLASS, DecisionKind, Query, Said};

pub(in crate::api) fn routes(schemas: &mut Schemas) -> OpenApiRouter<App> {
    schemas.answer::<GradeTable>();
    schemas.request::<NewDecision>();
    OpenApiRouter::new().routes(routes!(standings)).routes(routes!(of_person)).routes(routes!(decide))
}

/// What everybody has reached: students by lessons.
#[utoipa::path(get, path = "/standings", operation_id = "get_standings", tag = "class", responses(
    (status = 200, description = "The table", body = ref(of::<GradeTable>()))))]
async fn standings(State(app): State<App>) -> Result<Answer<GradeTable>, Problem> {
    Ok(Answer(table(&app.store, CLASS, &app.course, Moment::now()).await?))
}

/// Which submissions of a person.
#[derive(Debug, Deserialize, IntoParams)]
#[into_params(parameter_in = Query)]
#[serde(deny_unknown_fields)]
struct Wanted {
    /// Only for this lesson.
    lesson: Option<String>,
}

/// What somebody handed in, newest first.
#[utoipa::path(get, path = "/people/{person}/submissions", operation_id = "list_submissions_of", tag = "class",
    params(("person" = String, Path), Wanted), responses(
    (status = 200, description = "Submissions with their verdicts", body = ref(of::<SubmissionList>()))))]
async fn of_person(
    State(app): State<App>,
    PathParameters(person): PathParameters<String>,
    QueryParameters(wanted): QueryParameters<Wanted>,
) -> Result<Answer<SubmissionList>, Problem> {
    let limit = app.limits.submissions;
    let query = Query { course: CLASS.to_owned(), person: Some(person), lesson: wanted.lesson, limit };
    Ok(Answer(listed(app.store.list(&query).await?)))
}

/// A decision about a grade.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct NewDecision {
    /// Slug of the lesson.
    lesson: String,
    /// The explanation that gets the points; left out: the whole lesson.
    #[serde(default)]
    question: Option<String>,
    /// The points that count from now on; null: those that were earned, and an explanation waits again.
    points: Option<f64>,
    /// Why: the student sees it, and so does whoever looks later. May be empty for an explanation.
    reason: String,
}

/// Decide which points count, with a reason. Nothing that was handed in or judged is changed.
#[utoipa::path(post, path = "/people/{person}/decisions", operation_id = "decide", tag = "class", params(("person" = String, Path)),
    request_body(content = ref(of::<NewDecision>()), example = json!({"lesson": "screw", "points": 10, "reason": "right, in another frame"})), responses(
    (status = 201, description = "It counts"),
    (status = 404, description = "No such person, lesson or question", body = ref(PROBLEM)),
    (status = 422, description = "No reason, points that cannot be, or a question that a program judges", body = ref(PROBLEM))))]
async fn decide(
    State(app): State<App>,
    PathParameters(person): PathParameters<String>,
    caller: Caller,
    Json(new): Json<NewDecision>,
) -> Result<StatusCode, Problem> {
    let lesson = lessons::find(&app, &new.lesson)?;
    let (reason, possible) = match &new.question {
        None => (text_of(&new.reason, "/reason")?, possible(lesson)),
        Some(_) if new.reason.trim().is_empty() => (String::new(), of_explanation(lesson, &new)?),
        Some(_) => (text_of(&new.reason, "/reason")?, of_explanation(lesson, &new)?),
    };
    if new.points.is_some_and(|points| !(0.0..=possible).contains(&points)) {
        let wrong = format!("points go from 0 to {possible} here");
        return Err(refused("/points", wrong, "give points within that range"));
    }
    // A zero has no sign.
    let points = new.points.map(|points| points + 0.0);
    let said = match new.question.as_deref() {
        None => Said::points(points, &reason),
        question => Said { kind: DecisionKind::Mark, question, points, text: &reason },
    };
    app.store.decide(CLASS, &caller.member()?.id, &person, &lesson.slug, said).await?;
    Ok(StatusCode::CREATED)
}

/// The points of the explanation that a decision is about.
fn of_explanation(lesson: &Lesson, new: &NewDecision) -> Result<f64, Problem> {
    let id = new.question.as_deref().unwrap_or_default();
    let question = lesson.question(id).ok_or_else(|| lessons::unknown_question(lesson, id))?;
    if question.is_judged_by_people() {
        return Ok(question.points);
    }
    let wrong = format!("the answers to {id} are judged by a program");
    Err(refused("/question", wrong, "decide about the whole lesson: leave out `question`"))
}

fn refused(pointer: &str, wrong: String, hint: &str) -> Problem {
    let problem = Problem::new(StatusCode::UNPROCESSABLE_ENTITY, "invalid-decision", wrong.clone(), hint);
    problem.at(pointer, wrong)
}
