//! The table that a question asks for, written of a run of the student's own scene.

// The documentation macro writes out paths of its own.
#![allow(unused_qualifications)]

use std::fmt::Write as _;
use std::sync::Arc;

use axum::extract::State;
use axum::http::{StatusCode, header};
use axum::response::IntoResponse;
use schemars::JsonSchema;
use serde::Deserialize;
use serde_json::Value;
use triad_engine::analysis::Wanted;
use triad_engine::run::Simulation;
use triad_engine::scene::{OutputTimes, Scene};
use triad_lessons::grading::AskedTable;
use triad_lessons::lesson::Lesson;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use super::{find, not_asked};
use crate::api::describe::{PROBLEM, Schemas, of};
use crate::api::extract::{Json, PathParameters};
use crate::api::scenes::table::along;
use crate::app::App;
use crate::problem::Problem;
use crate::session;

pub(super) fn routes(schemas: &mut Schemas) -> OpenApiRouter<App> {
    schemas.request::<OwnRun>();
    OpenApiRouter::new().routes(routes!(asked_table))
}

/// A run of one's own.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct OwnRun {
    /// The scene as it is to be run; its schema is at /api/v1/schema/scene.
    #[schemars(with = "Scene")]
    scene: Value,
}

/// The table that a question asks for, of a run of one's own scene from its start: what may be handed in, right or wrong.
#[utoipa::path(post, path = "/lessons/{slug}/questions/{id}/table", operation_id = "run_to_asked_table", tag = "lessons",
    params(("slug" = String, Path), ("id" = String, Path)), request_body(content = ref(of::<OwnRun>())), responses(
    (status = 200, description = "The table, with the columns that the question names", body = String, content_type = "text/csv"),
    (status = 404, description = "No such lesson, or no such question that asks for a table", body = ref(PROBLEM)),
    (status = 422, description = "The scene cannot be run to the table's end, or lacks what a column is about", body = ref(PROBLEM))))]
async fn asked_table(
    State(app): State<App>,
    PathParameters((slug, id)): PathParameters<(String, String)>,
    Json(asked): Json<OwnRun>,
) -> Result<impl IntoResponse, Problem> {
    table_of(find(&app, &slug)?, &id)?;
    let work = Arc::clone(&app.work);
    let job = move |wanted: &Wanted| {
        let table = table_of(find(&app, &slug)?, &id)?;
        let mut scene = Scene::from_json(&asked.scene.to_string())?;
        session::bounded(&scene, &app.limits)?;
        scene.simulation.duration = table.end();
        let times = OutputTimes::new(table.interval(scene.simulation.every), table.end());
        let mut text = table.names() + "\n";
        along(&mut Simulation::new(&scene)?, &times, app.limits.command_time, wanted, |run| {
            // The shortest digits that are read back as the same numbers.
            let _ = write!(text, "{}", run.time());
            for value in table.row(&scene, run).map_err(not_measured)? {
                let _ = write!(text, ",{value}");
            }
            text.push('\n');
            Ok(())
        })?;
        Ok(text)
    };
    Ok(([(header::CONTENT_TYPE, "text/csv; charset=utf-8")], work.run(job).await?))
}

fn table_of<'a>(lesson: &'a Lesson, id: &str) -> Result<AskedTable<'a>, Problem> {
    let remedy = "tables belong to questions of kind trajectory";
    lesson.asked_table(id).ok_or_else(|| not_asked(lesson, id, "no-table-asked", "a table", remedy))
}

fn not_measured(error: impl std::fmt::Display) -> Problem {
    Problem::new(
        StatusCode::UNPROCESSABLE_ENTITY,
        "not-measured",
        format!("the run does not show what the table is about: {error}"),
        "keep the names of the bodies and joints that the question names",
    )
}
