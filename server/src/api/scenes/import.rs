//! Robots described in URDF, as scenes.

use std::sync::Arc;

use axum::extract::State;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use triad_engine::analysis::Wanted;
use triad_engine::scene::Scene;
use triad_urdf::{OmittedItem, SideCar};
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use crate::api::describe::{PROBLEM, Schemas, of};
use crate::api::extract::Json;
use crate::app::App;
use crate::problem::Problem;
use crate::session;

pub(in crate::api) fn routes(schemas: &mut Schemas) -> OpenApiRouter<App> {
    schemas.request::<UrdfImport>();
    schemas.answer::<ImportedRobot>();
    OpenApiRouter::new().routes(routes!(import))
}

/// A robot to be imported.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct UrdfImport {
    /// The text of the URDF.
    urdf: String,
    /// What it does not say: joints that close loops, positions at the start, drivers, loads, settings.
    #[serde(default)]
    with: SideCar,
}

/// A robot as a scene.
#[derive(Debug, Serialize, JsonSchema)]
struct ImportedRobot {
    /// The scene; its schema is at /api/v1/schema/scene.
    #[schemars(with = "Scene")]
    scene: Value,
    /// What could not be carried over.
    left_out: Vec<OmittedItem>,
}

/// Read a URDF as a scene, and tell what could not be carried over.
#[utoipa::path(post, path = "/import/urdf", operation_id = "import_urdf", tag = "scenes", request_body(content = ref(of::<UrdfImport>())), responses(
    (status = 200, description = "The scene and what was left out", body = ref(of::<ImportedRobot>())),
    (status = 413, description = "The text is too long", body = ref(PROBLEM)),
    (status = 422, description = "It is no robot, with the line", body = ref(PROBLEM))))]
async fn import(
    State(app): State<App>,
    Json(robot): Json<UrdfImport>,
) -> Result<axum::Json<ImportedRobot>, Problem> {
    let work = Arc::clone(&app.work);
    let job = move |wanted: &Wanted| {
        let imported = triad_urdf::import_while(&robot.urdf, &robot.with, &|| wanted.is_still())?;
        session::bounded(&imported.scene, &app.limits)?;
        let scene = serde_json::to_value(&imported.scene).map_err(Problem::internal)?;
        Ok(axum::Json(ImportedRobot { scene, left_out: imported.left_out }))
    };
    work.run(job).await
}
