//! Robots described in URDF, as scenes.

use axum::extract::State;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use triad_urdf::SideCar;
use utoipa::ToSchema;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use super::extract::Json;
use crate::app::App;
use crate::problem::{Problem, ProblemDocument};
use crate::{blocking, session};

pub(super) fn routes() -> OpenApiRouter<App> {
    OpenApiRouter::new().routes(routes!(import))
}

/// A robot to be imported.
#[derive(Debug, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
struct Robot {
    /// The text of the URDF.
    urdf: String,
    /// What it does not say: joints that close loops, positions at the start, drivers, loads, settings.
    #[serde(default)]
    #[schema(value_type = Object)]
    with: SideCar,
}

/// Something that could not be carried over.
#[derive(Debug, Serialize, ToSchema)]
struct LeftOut {
    /// Its line in the URDF.
    line: u32,
    /// What it belongs to, such as `joint elbow`.
    of: String,
    /// What is missing, and what it means.
    what: String,
}

impl From<triad_urdf::LeftOut> for LeftOut {
    fn from(triad_urdf::LeftOut { line, of, what }: triad_urdf::LeftOut) -> Self {
        Self { line, of, what }
    }
}

/// A robot as a scene.
#[derive(Debug, Serialize, ToSchema)]
struct ImportedView {
    /// The scene; its schema is at /api/v1/schema/scene.
    #[schema(value_type = Object)]
    scene: Value,
    /// What could not be carried over.
    left_out: Vec<LeftOut>,
}

/// Read a URDF as a scene, and tell what could not be carried over.
#[utoipa::path(post, path = "/import/urdf", tag = "scenes", request_body = Robot, responses(
    (status = 200, description = "The scene and what was left out", body = ImportedView),
    (status = 413, description = "The text is too long", body = ProblemDocument),
    (status = 422, description = "It is no robot, with the line", body = ProblemDocument)))]
async fn import(
    State(app): State<App>,
    Json(robot): Json<Robot>,
) -> Result<axum::Json<ImportedView>, Problem> {
    blocking(move || {
        let imported = triad_urdf::import(&robot.urdf, &robot.with)?;
        session::bounded(&imported.scene, &app.limits)?;
        let scene = serde_json::to_value(&imported.scene).map_err(Problem::internal)?;
        let left_out = imported.left_out.into_iter().map(LeftOut::from).collect();
        Ok(axum::Json(ImportedView { scene, left_out }))
    })
    .await
}
