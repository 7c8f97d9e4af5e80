//! Analyses of a scene other than running it: assembly, kinematics with inverse dynamics, static equilibrium, modes.

use std::sync::Arc;

use axum::extract::State;
use axum::http::StatusCode;
use schemars::JsonSchema;
use serde::Deserialize;
use serde::Serialize;
use serde_json::Value;
use triad_engine::analysis::{
    self, AnalysisError, Assembly, Equilibrium, Kinematics, Modes, ModesAbout, Wanted,
};
use triad_engine::reactions::report::Convention;
use triad_engine::scene::Scene;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use crate::api::describe::{PROBLEM, Schemas, of};
use crate::api::extract::Json;
use crate::app::App;
use crate::limits::Limits;
use crate::problem::Problem;
use crate::session;

/// Output times that a kinematic analysis over HTTP may have.
const MAX_TIMES: f64 = 5_001.0;

pub(in crate::api) fn routes(schemas: &mut Schemas) -> OpenApiRouter<App> {
    schemas.request::<AnalysisRequest>();
    schemas.answer::<Assembly>();
    schemas.answer::<Kinematics>();
    schemas.answer::<Equilibrium>();
    schemas.answer::<Modes>();
    OpenApiRouter::new()
        .routes(routes!(assembly))
        .routes(routes!(kinematics))
        .routes(routes!(equilibrium))
        .routes(routes!(modes))
}

/// A scene to analyse.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct AnalysisRequest {
    /// The scene; its schema is at /api/v1/schema/scene.
    #[schemars(with = "Scene")]
    scene: Value,
    /// Modes about the `equilibrium` near the start, or about the `start` itself.
    #[serde(default)]
    about: ModesAbout,
    /// Bodies that an assembly must not move.
    #[serde(default)]
    pinned: Vec<String>,
}

/// Consistent positions and velocities from a rough start.
#[utoipa::path(post, path = "/analyses/assembly", operation_id = "assemble_scene", tag = "analyses", request_body(content = ref(of::<AnalysisRequest>())), responses(
    (status = 200, description = "Where each body came to lie, and how far it was moved", body = ref(of::<Assembly>())),
    (status = 422, description = "The scene cannot be assembled", body = ref(PROBLEM))))]
async fn assembly(
    State(app): State<App>,
    Json(asked): Json<AnalysisRequest>,
) -> Result<axum::Json<Value>, Problem> {
    analyse(app, asked, |scene, asked, wanted| analysis::assemble_while(scene, &asked.pinned, wanted)).await
}

/// Positions, velocities, accelerations and driving forces of a scene whose drivers leave it no freedom.
#[utoipa::path(post, path = "/analyses/kinematics", operation_id = "analyse_kinematics", tag = "analyses", request_body(content = ref(of::<AnalysisRequest>())), responses(
    (status = 200, description = "One state for each output time, with the reactions of joints and drivers",
        body = ref(of::<Kinematics>())),
    (status = 422, description = "The scene is free to move, or too long", body = ref(PROBLEM))))]
async fn kinematics(
    State(app): State<App>,
    Json(asked): Json<AnalysisRequest>,
) -> Result<axum::Json<Value>, Problem> {
    analyse(app, asked, |scene, _, wanted| analysis::kinematics_while(scene, Convention::default(), wanted))
        .await
}

/// A position of rest near the start, whether it is stable, and the reactions there.
#[utoipa::path(post, path = "/analyses/equilibrium", operation_id = "find_equilibrium", tag = "analyses", request_body(content = ref(of::<AnalysisRequest>())), responses(
    (status = 200, description = "The position and its reactions", body = ref(of::<Equilibrium>())),
    (status = 422, description = "No position of rest was found", body = ref(PROBLEM))))]
async fn equilibrium(
    State(app): State<App>,
    Json(asked): Json<AnalysisRequest>,
) -> Result<axum::Json<Value>, Problem> {
    analyse(app, asked, |scene, _, wanted| analysis::equilibrium_while(scene, wanted)).await
}

/// Small motions about a position: frequencies, damping and shapes.
#[utoipa::path(post, path = "/analyses/modes", operation_id = "find_modes", tag = "analyses", request_body(content = ref(of::<AnalysisRequest>())), responses(
    (status = 200, description = "The modes, slowest first", body = ref(of::<Modes>())),
    (status = 422, description = "The scene has no modes there", body = ref(PROBLEM))))]
async fn modes(
    State(app): State<App>,
    Json(asked): Json<AnalysisRequest>,
) -> Result<axum::Json<Value>, Problem> {
    analyse(app, asked, |scene, asked, wanted| analysis::modes_while(scene, asked.about, wanted)).await
}

async fn analyse<T: Serialize>(
    app: App,
    asked: AnalysisRequest,
    run: impl FnOnce(&Scene, &AnalysisRequest, &Wanted) -> Result<T, AnalysisError> + Send + 'static,
) -> Result<axum::Json<Value>, Problem> {
    let work = Arc::clone(&app.work);
    let job = move |wanted: &Wanted| {
        let scene = Scene::from_json(&asked.scene.to_string())?;
        session::bounded(&scene, &Limits { bodies: app.limits.analysed_bodies, ..(*app.limits).clone() })?;
        let times = scene.simulation.output_times().intervals();
        if times > MAX_TIMES {
            let detail = format!("the scene asks for {times:.0} output times, more than {MAX_TIMES}");
            return Err(Problem::new(
                StatusCode::UNPROCESSABLE_ENTITY,
                "too-many-times",
                detail.clone(),
                "choose a larger simulation.every or a shorter simulation.duration",
            )
            .at("/simulation/every", detail));
        }
        let found = run(&scene, &asked, wanted)?;
        serde_json::to_value(found).map(axum::Json).map_err(Problem::internal)
    };
    work.run(job).await
}
