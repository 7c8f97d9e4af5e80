//! Grades for other programs.

// The documentation macro writes out paths of its own.
#![allow(unused_qualifications)]

use axum::Json as Answer;
use axum::extract::State;
use axum::http::{HeaderName, header};
use axum::response::IntoResponse;
use schemars::JsonSchema;
use serde::Deserialize;
use utoipa::IntoParams;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use crate::api::describe::{PROBLEM, Schemas, of};
use crate::api::extract::{Json, QueryParameters};
use crate::api::guard::Caller;
use crate::app::App;
use crate::grades::{Filled, Format, GradeTable, csv, fill, lines, table};
use crate::policy::Moment;
use crate::problem::Problem;
use crate::store::CLASS;

pub(in crate::api) fn routes(schemas: &mut Schemas) -> OpenApiRouter<App> {
    schemas.request::<CanvasExport>();
    schemas.answer::<Filled>();
    OpenApiRouter::new()
        .routes(routes!(standings_csv))
        .routes(routes!(standings_lines))
        .routes(routes!(fill_canvas))
}

/// For which program.
#[derive(Debug, Deserialize, IntoParams)]
#[into_params(parameter_in = Query)]
#[serde(deny_unknown_fields)]
struct For {
    /// `plain`, `canvas` or `moodle`; `plain` if it is not given.
    #[serde(default, rename = "for")]
    #[param(value_type = Option<String>)]
    format: Format,
}

/// The table as it is now; that it is taken along stands in the log.
async fn taken(app: &App, caller: Caller) -> Result<GradeTable, Problem> {
    let grades = table(&app.store, CLASS, &app.course, Moment::now()).await?;
    app.store.note(CLASS, &caller.member()?.id, "exported", "grades").await?;
    Ok(grades)
}

/// The table of students and lessons as CSV.
#[utoipa::path(get, path = "/standings.csv", operation_id = "get_standings_csv", tag = "class", params(For), responses(
    (status = 200, description = "The table", body = String, content_type = "text/csv"),
    (status = 400, description = "No such format", body = ref(PROBLEM))))]
async fn standings_csv(
    State(app): State<App>,
    caller: Caller,
    QueryParameters(wanted): QueryParameters<For>,
) -> Result<impl IntoResponse, Problem> {
    let course = app.store.course(CLASS).await?;
    let text = csv(&taken(&app, caller).await?, wanted.format, &course.title)?;
    Ok((file("text/csv; charset=utf-8", "attachment; filename=\"grades.csv\""), text))
}

/// The same as lines of JSON: one for each student and lesson in which there is something.
#[utoipa::path(get, path = "/standings.jsonl", operation_id = "get_standings_lines", tag = "class", responses(
    (status = 200, description = "A line of JSON for each", body = String, content_type = "application/jsonl")))]
async fn standings_lines(State(app): State<App>, caller: Caller) -> Result<impl IntoResponse, Problem> {
    let text = lines(&taken(&app, caller).await?)?;
    Ok((file("application/jsonl", "attachment; filename=\"grades.jsonl\""), text))
}

fn file(kind: &'static str, name: &'static str) -> [(HeaderName, &'static str); 2] {
    [(header::CONTENT_TYPE, kind), (header::CONTENT_DISPOSITION, name)]
}

/// A gradebook that Canvas exported.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct CanvasExport {
    /// The file as text.
    file: String,
}

/// Fill what everybody has reached into a gradebook that Canvas exported, to be imported there again: people and assignments keep
/// Canvas's numbers, and only columns in which something changed are given back.
#[utoipa::path(post, path = "/standings/canvas", operation_id = "fill_canvas_export", tag = "class",
    request_body(content = ref(of::<CanvasExport>()), example = json!({"file": "Student,ID,SIS User ID,SIS Login ID,Section,02 Simple pendulum (4711)\n"})), responses(
    (status = 200, description = "The table to import, and what could not be filled in", body = ref(of::<Filled>())),
    (status = 422, description = "Not what Canvas exports", body = ref(PROBLEM))))]
async fn fill_canvas(
    State(app): State<App>,
    caller: Caller,
    Json(sent): Json<CanvasExport>,
) -> Result<Answer<Filled>, Problem> {
    let grades = table(&app.store, CLASS, &app.course, Moment::now()).await?;
    let filled = fill(&sent.file, &grades)?;
    app.store.note(CLASS, &caller.member()?.id, "exported", "grades").await?;
    Ok(Answer(filled))
}
