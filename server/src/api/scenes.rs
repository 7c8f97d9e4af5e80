//! Built-in scenes, the check of a scene, and the schema of scenes.

use axum::Json as Answer;
use axum::extract::State;
use serde::Serialize;
use serde_json::Value;
use triad_engine::catalogue;
use triad_engine::check::CheckReport;
use triad_engine::scene::{self, Scene};
use utoipa::ToSchema;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use super::extract::{At, Json};
use crate::app::App;
use crate::problem::{Problem, ProblemDocument};
use crate::{blocking, scenes, session};

pub(super) fn routes() -> OpenApiRouter<App> {
    OpenApiRouter::new()
        .routes(routes!(list))
        .routes(routes!(show))
        .routes(routes!(check))
        .routes(routes!(schema))
}

/// A built-in scene.
#[derive(Debug, Serialize, ToSchema)]
struct SceneEntry {
    /// Name to run it by.
    name: &'static str,
    /// What it is.
    summary: &'static str,
}

/// The built-in scenes.
#[utoipa::path(get, path = "/scenes", tag = "scenes", responses(
    (status = 200, description = "Names and summaries", body = Vec<SceneEntry>)))]
async fn list() -> Answer<Vec<SceneEntry>> {
    let entries = catalogue::ENTRIES.iter();
    Answer(entries.map(|entry| SceneEntry { name: entry.name, summary: entry.summary }).collect())
}

/// A built-in scene, as its author would write it.
#[utoipa::path(get, path = "/scenes/{name}", tag = "scenes",
    params(("name" = String, Path, example = "n-four-bar:2")), responses(
    (status = 200, description = "The scene", body = Object),
    (status = 404, description = "No such scene", body = ProblemDocument)))]
async fn show(State(app): State<App>, At(name): At<String>) -> Result<Answer<Scene>, Problem> {
    blocking(move || scenes::builtin_within(&name, &app.limits)).await.map(Answer)
}

/// What a scene amounts to.
#[derive(Debug, Serialize, ToSchema)]
struct CheckView {
    /// Name of the scene.
    name: String,
    /// Moving bodies.
    bodies: usize,
    /// Generalized coordinates.
    coordinates: usize,
    /// Constraint rows.
    rows: usize,
    /// Rank of the rows.
    rank: usize,
    /// Degrees of freedom.
    degrees_of_freedom: usize,
    /// Dependent rows, joint by joint.
    redundant: Vec<RedundantView>,
    /// What was found or corrected.
    notes: Vec<String>,
}

/// Dependent rows of a joint.
#[derive(Debug, Serialize, ToSchema)]
struct RedundantView {
    /// The joint.
    joint: String,
    /// Its dependent rows.
    rows: Vec<String>,
}

impl From<CheckReport> for CheckView {
    fn from(report: CheckReport) -> Self {
        let redundant = report.redundant.into_iter().map(|r| RedundantView { joint: r.joint, rows: r.rows });
        Self {
            name: report.name,
            bodies: report.bodies,
            coordinates: report.coordinates,
            rows: report.rows,
            rank: report.rank,
            degrees_of_freedom: report.degrees_of_freedom,
            redundant: redundant.collect(),
            notes: report.notes,
        }
    }
}

/// Check a scene: bodies, coordinates, rows, rank, degrees of freedom, redundant rows.
#[utoipa::path(post, path = "/check", tag = "scenes", request_body = Object, responses(
    (status = 200, description = "What the scene amounts to", body = CheckView),
    (status = 413, description = "The text is too long", body = ProblemDocument),
    (status = 422, description = "The scene was refused", body = ProblemDocument)))]
async fn check(State(app): State<App>, Json(value): Json<Value>) -> Result<Answer<CheckView>, Problem> {
    blocking(move || {
        let scene = Scene::from_json(&value.to_string())?;
        session::bounded(&scene, &app.limits)?;
        Ok(Answer(triad_engine::check::check(&scene)?.into()))
    })
    .await
}

/// The JSON Schema of a scene.
#[utoipa::path(get, path = "/schema/scene", tag = "scenes", responses(
    (status = 200, description = "The schema", body = Object)))]
async fn schema() -> Answer<Value> {
    Answer(scene::schema())
}
