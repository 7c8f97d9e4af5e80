//! A run as a table: the outputs that are chosen, at equal intervals, as CSV.

use std::sync::Arc;
use std::time::{Duration, Instant};

use axum::extract::State;
use axum::http::{StatusCode, header};
use axum::response::IntoResponse;
use schemars::JsonSchema;
use serde::Deserialize;
use serde_json::Value;
use triad_engine::analysis::Wanted;
use triad_engine::run::{Outputs, Simulation};
use triad_engine::scene::{Output, OutputTimes, Scene};
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use crate::api::describe::{PROBLEM, Schemas, of};
use crate::api::extract::Json;
use crate::app::App;
use crate::problem::Problem;
use crate::session;
use crate::table::{TextTable, with_errors};

/// Numbers that a table over HTTP may have: some 60 MB of text.
const MAX_NUMBERS: f64 = 3e6;
/// Integrator steps between two looks at the clock.
const PIECE: u64 = 64;

pub(in crate::api) fn routes(schemas: &mut Schemas) -> OpenApiRouter<App> {
    schemas.request::<TableRequest>();
    OpenApiRouter::new().routes(routes!(table))
}

/// A scene to run, and what to write of it.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct TableRequest {
    /// The scene; its schema is at /api/v1/schema/scene.
    #[schemars(with = "Scene")]
    scene: Value,
    /// The columns, instead of those that the scene chooses.
    #[serde(default)]
    outputs: Vec<Output>,
    /// Time between rows, s, instead of the scene's.
    every: Option<f64>,
    /// End of the run, s, instead of the scene's.
    until: Option<f64>,
}

/// A run of the scene from its start as a table: CSV with a row of names, a row of units, and one for each output time.
#[utoipa::path(post, path = "/analyses/table", operation_id = "run_to_table", tag = "analyses", request_body(content = ref(of::<TableRequest>())), responses(
    (status = 200, description = "The table", body = String, content_type = "text/csv"),
    (status = 422, description = "The scene cannot be run to its end, or the table would be too long", body = ref(PROBLEM))))]
async fn table(
    State(app): State<App>,
    Json(asked): Json<TableRequest>,
) -> Result<impl IntoResponse, Problem> {
    let work = Arc::clone(&app.work);
    let job = move |wanted: &Wanted| {
        let mut scene = Scene::from_json(&asked.scene.to_string())?;
        session::bounded(&scene, &app.limits)?;
        let settings = &mut scene.simulation;
        settings.every = asked.every.unwrap_or(settings.every);
        settings.duration = asked.until.unwrap_or(settings.duration);
        let chosen = !asked.outputs.is_empty();
        if chosen {
            settings.outputs = asked.outputs;
        }
        with_errors(
            settings,
            chosen,
            "leave \"error_estimate\": false out of the scene, or errors out of the outputs",
        )?;
        written(&scene, app.limits.command_time, wanted)
    };
    let text = work.run(job).await?;
    Ok(([(header::CONTENT_TYPE, "text/csv; charset=utf-8")], text))
}

/// Runs a scene to its end, and writes its table, as long as it is wanted.
fn written(scene: &Scene, time: Duration, wanted: &Wanted) -> Result<Vec<u8>, Problem> {
    let mut run = Simulation::new(scene)?;
    let outputs = Outputs::new(&run);
    let times = scene.simulation.output_times();
    let numbers = (times.intervals() + 1.0) * (outputs.columns().len() + 1) as f64;
    if numbers > MAX_NUMBERS {
        return Err(Problem::new(
            StatusCode::UNPROCESSABLE_ENTITY,
            "table-too-long",
            format!("the table would have {numbers:.0} numbers, more than {MAX_NUMBERS}"),
            "choose fewer outputs or a larger interval, or write it on the command line: triad run SCENE --out FILE.csv",
        ));
    }
    let mut table = TextTable::new(Vec::new(), &run, &outputs).map_err(Problem::internal)?;
    let mut row = Vec::new();
    along(&mut run, &times, time, wanted, |run| {
        row.clear();
        row.push(run.time());
        outputs.write(run, &mut row);
        table.row(&row).map_err(Problem::internal)
    })?;
    table.finish().map_err(Problem::internal)
}

/// Looks at a run at the times of its outputs, from its start to its end, as long as it is wanted and within the time of a request.
pub(in crate::api) fn along(
    run: &mut Simulation,
    times: &OutputTimes,
    time: Duration,
    wanted: &Wanted,
    mut look: impl FnMut(&Simulation) -> Result<(), Problem>,
) -> Result<(), Problem> {
    let began = Instant::now();
    let mut index = 0;
    loop {
        let next = times.at(index);
        while !run.advance_towards(next, PIECE)? {
            in_time(began, time, run.reached(), wanted)?;
        }
        look(run)?;
        if run.finished() {
            return Ok(());
        }
        in_time(began, time, run.time(), wanted)?;
        index += 1;
    }
}

fn in_time(began: Instant, most: Duration, reached: f64, wanted: &Wanted) -> Result<(), Problem> {
    wanted.check()?;
    if began.elapsed() > most { Err(too_slow(reached)) } else { Ok(()) }
}

fn too_slow(time: f64) -> Problem {
    Problem::new(
        StatusCode::UNPROCESSABLE_ENTITY,
        "time-limit",
        format!("the server's time for one request was used up at t = {time:.6} s"),
        "ask for an earlier end or a looser tolerance, or run it on the command line: triad run SCENE --out FILE.csv",
    )
}
