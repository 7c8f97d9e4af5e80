//! Recorded runs of the built-in scenes and of the lessons' scenes, and the pictures of all of them.

use std::collections::BTreeMap;

use axum::body::Bytes;
use axum::extract::State;
use axum::http::{HeaderMap, HeaderValue, StatusCode, header};
use axum::response::{IntoResponse, Response};
use schemars::JsonSchema;
use serde::Serialize;
use triad_engine::analysis::Wanted;
use triad_engine::catalogue;
use triad_engine::scene::Scene;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use crate::api::describe::{PROBLEM, Schemas, of};
use crate::api::extract::PathParameters;
use crate::app::App;
use crate::limits::Limits;
use crate::motion::{self, Motion};
use crate::page::reads_gzip;
use crate::problem::Problem;
use crate::scenes;

/// A browser asks anew after so many seconds: lessons may be edited while the server runs.
const FRESH: &str = "public, max-age=300";
/// The number that stands for N of a family, for its picture.
const OF_FAMILY: &str = "2";

pub(in crate::api) fn routes(schemas: &mut Schemas) -> OpenApiRouter<App> {
    schemas.answer::<Motion>();
    schemas.answer::<Pictures>();
    OpenApiRouter::new().routes(routes!(of_scene)).routes(routes!(of_lesson)).routes(routes!(pictures))
}

/// The first five seconds of a built-in scene's run, in numbers: for a picture that plays without a session.
#[utoipa::path(get, path = "/scenes/{name}/motion", operation_id = "get_scene_motion", tag = "scenes",
    params(("name" = String, Path, example = "spatial-slider-crank")), responses(
    (status = 200, description = "The motion", body = ref(of::<Motion>())),
    (status = 404, description = "No such scene", body = ref(PROBLEM)),
    (status = 422, description = "The scene has too many bodies", body = ref(PROBLEM))))]
async fn of_scene(
    State(app): State<App>,
    PathParameters(name): PathParameters<String>,
    headers: HeaderMap,
) -> Result<Response, Problem> {
    let scene = scenes::builtin_within(&name, &app.limits)?;
    let found = filmed(&app, &format!("scene {name}"), scene).await?;
    sent(&found, &headers)
}

/// The first five seconds of a lesson's mechanism, with the numbers that everybody sees.
#[utoipa::path(get, path = "/lessons/{slug}/motion", operation_id = "get_lesson_motion", tag = "lessons",
    params(("slug" = String, Path)), responses(
    (status = 200, description = "The motion", body = ref(of::<Motion>())),
    (status = 404, description = "No such lesson", body = ref(PROBLEM))))]
async fn of_lesson(
    State(app): State<App>,
    PathParameters(slug): PathParameters<String>,
    headers: HeaderMap,
) -> Result<Response, Problem> {
    let lesson = crate::api::lessons::find(&app, &slug)?;
    let scene = scene_of(&app, lesson)?;
    let found = filmed(&app, &format!("lesson {} {}", lesson.slug, lesson.hash), scene).await?;
    sent(&found, &headers)
}

/// The scenes at their starts: what a list of them shows.
#[derive(Debug, Serialize, JsonSchema)]
struct Pictures {
    /// Of the built-in scenes, by the names to run them by.
    scenes: BTreeMap<String, Motion>,
    /// Of the lessons, by their slugs.
    lessons: BTreeMap<String, Motion>,
}

/// All built-in scenes and all lessons' mechanisms at their starts, to be drawn.
#[utoipa::path(get, path = "/pictures", operation_id = "get_pictures", tag = "scenes", responses(
    (status = 200, description = "Motions of one frame each", body = ref(of::<Pictures>()))))]
async fn pictures(State(app): State<App>, headers: HeaderMap) -> Result<Response, Problem> {
    let hashes: Vec<&str> = app.course.lessons().iter().map(|lesson| lesson.hash.as_str()).collect();
    let name = format!("pictures {}", hashes.concat());
    let shared = app.clone();
    let make = move |wanted: &Wanted| {
        let names = catalogue::ENTRIES.iter().map(|entry| entry.name.replace(":N", &format!(":{OF_FAMILY}")));
        let scenes = names.filter_map(|name| {
            let picture = motion::picture(&scenes::builtin(&name).ok()?).ok()?;
            wanted.is_still().then_some((name, picture))
        });
        // A lesson whose mechanism cannot be assembled has no picture.
        let lessons = shared.course.lessons().iter().filter_map(|lesson| {
            let scene = scene_of(&shared, lesson).ok().filter(|_| wanted.is_still())?;
            Some((lesson.slug.clone(), motion::picture(&scene).ok()?))
        });
        let pictures = Pictures { scenes: scenes.collect(), lessons: lessons.collect() };
        wanted.check()?;
        Ok(pictures)
    };
    sent(&app.motions.of(&name, &app.work, make).await?, &headers)
}

fn scene_of(app: &App, lesson: &triad_lessons::Lesson) -> Result<Scene, Problem> {
    Ok(Scene::from_json(&app.variants.of(lesson, "")?.scene.to_string())?)
}

async fn filmed(app: &App, name: &str, scene: Scene) -> Result<Bytes, Problem> {
    few_enough(&scene, &app.limits)?;
    let time = app.limits.command_time;
    app.motions.of(name, &app.work, move |wanted| motion::of(&scene, time, wanted)).await
}

/// Everybody may ask, signed in or not: for a run that costs little.
fn few_enough(scene: &Scene, limits: &Limits) -> Result<(), Problem> {
    if scene.bodies.len() <= limits.analysed_bodies {
        return Ok(());
    }
    Err(Problem::new(
        StatusCode::UNPROCESSABLE_ENTITY,
        "scene-too-large",
        format!(
            "the scene has {} bodies, recorded runs have at most {}",
            scene.bodies.len(),
            limits.analysed_bodies
        ),
        "open the scene and run it",
    ))
}

fn sent(packed: &Bytes, request: &HeaderMap) -> Result<Response, Problem> {
    let mut headers = HeaderMap::new();
    headers.insert(header::CONTENT_TYPE, HeaderValue::from_static("application/json"));
    headers.insert(header::CACHE_CONTROL, HeaderValue::from_static(FRESH));
    headers.insert(header::VARY, HeaderValue::from_static("accept-encoding"));
    if !reads_gzip(request) {
        return Ok((headers, motion::unpacked(packed)?).into_response());
    }
    headers.insert(header::CONTENT_ENCODING, HeaderValue::from_static("gzip"));
    Ok((headers, packed.clone()).into_response())
}
