//! Built-in scenes, the check of a scene, and the schema of scenes.

pub(in crate::api) mod analyses;
pub(in crate::api) mod import;
pub(in crate::api) mod motion;
pub(in crate::api) mod table;

use std::sync::Arc;

use axum::Json as Answer;
use axum::extract::State;
use schemars::JsonSchema;
use serde::Serialize;
use serde_json::Value;
use triad_engine::analysis::Wanted;
use triad_engine::analysis::check::{CheckReport, check_while};
use triad_engine::catalogue;
use triad_engine::scene::{self, Scene};
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use crate::api::describe::{PROBLEM, Schemas, of};
use crate::api::extract::{Json, PathParameters};
use crate::app::App;
use crate::problem::Problem;
use crate::{blocking, scenes, session};

pub(in crate::api) fn routes(schemas: &mut Schemas) -> OpenApiRouter<App> {
    schemas.answer::<SceneList>();
    schemas.request::<Scene>();
    schemas.answer::<CheckReport>();
    schemas.answer::<SceneSchema>();
    OpenApiRouter::new()
        .routes(routes!(list))
        .routes(routes!(show))
        .routes(routes!(check))
        .routes(routes!(schema))
}

/// A built-in scene.
#[derive(Debug, Serialize, JsonSchema)]
struct SceneEntry {
    /// Name to run it by.
    name: &'static str,
    /// What it is.
    summary: &'static str,
}

/// The built-in scenes.
#[derive(Debug, Serialize, JsonSchema)]
struct SceneList(Vec<SceneEntry>);

/// The built-in scenes.
#[utoipa::path(get, path = "/scenes", operation_id = "list_scenes", tag = "scenes", responses(
    (status = 200, description = "Names and summaries", body = ref(of::<SceneList>()))))]
async fn list() -> Answer<SceneList> {
    let entries = catalogue::ENTRIES.iter();
    Answer(SceneList(entries.map(|entry| SceneEntry { name: entry.name, summary: entry.summary }).collect()))
}

/// A built-in scene, as its author would write it.
#[utoipa::path(get, path = "/scenes/{name}", operation_id = "get_scene", tag = "scenes",
    params(("name" = String, Path, example = "n-four-bar:2")), responses(
    (status = 200, description = "The scene", body = ref(of::<Scene>())),
    (status = 404, description = "No such scene", body = ref(PROBLEM))))]
async fn show(
    State(app): State<App>,
    PathParameters(name): PathParameters<String>,
) -> Result<Answer<Scene>, Problem> {
    blocking(move || scenes::builtin_within(&name, &app.limits)).await.map(Answer)
}

/// Check a scene: bodies, coordinates, rows, rank, degrees of freedom, redundant rows.
#[utoipa::path(post, path = "/check", operation_id = "check_scene", tag = "scenes", request_body(content = ref(of::<Scene>())), responses(
    (status = 200, description = "What the scene amounts to", body = ref(of::<CheckReport>())),
    (status = 413, description = "The text is too long", body = ref(PROBLEM)),
    (status = 422, description = "The scene was refused", body = ref(PROBLEM))))]
async fn check(State(app): State<App>, Json(value): Json<Value>) -> Result<Answer<CheckReport>, Problem> {
    let work = Arc::clone(&app.work);
    let job = move |wanted: &Wanted| {
        let scene = Scene::from_json(&value.to_string())?;
        session::bounded(&scene, &app.limits)?;
        Ok(Answer(check_while(&scene, wanted)?))
    };
    work.run(job).await
}

/// A JSON Schema.
#[derive(Debug, Serialize, JsonSchema)]
struct SceneSchema(#[schemars(with = "serde_json::Map<String, Value>")] Value);

/// The JSON Schema of a scene.
#[utoipa::path(get, path = "/schema/scene", operation_id = "get_scene_schema", tag = "scenes", responses(
    (status = 200, description = "The schema", body = ref(of::<SceneSchema>()))))]
async fn schema() -> Answer<SceneSchema> {
    Answer(SceneSchema(scene::schema()))
}
