//! Live sessions: create, read, step, play, pause, reset, delete.

pub(in crate::api) mod changes;
pub(in crate::api) mod matrices;
pub(in crate::api) mod reactions;
pub(in crate::api) mod stream;

use std::sync::Arc;

use axum::extract::State;
use axum::http::{HeaderMap, StatusCode, header};
use axum::response::IntoResponse;
use triad_engine::scene::Scene;
use triad_session::requests::{NewSession, PlayRequest, StepRequest, Stretch};
use triad_session::{SceneSource, SessionState};
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use crate::api::describe::{PROBLEM, Schemas, of};
use crate::api::extract::{Json, PathParameters};
use crate::api::guard::Caller;
use crate::app::App;
use crate::problem::Problem;
use crate::session::{AskedFirst, Session};
use crate::store::{CLASS, Role};
use crate::work::Asker;
use crate::{blocking, scenes};

pub(in crate::api) fn routes(schemas: &mut Schemas) -> OpenApiRouter<App> {
    schemas.request::<NewSession>();
    schemas.request::<StepRequest>();
    schemas.request::<PlayRequest>();
    schemas.answer::<SessionState>();
    OpenApiRouter::new()
        .routes(routes!(create))
        .routes(routes!(show, delete))
        .routes(routes!(step))
        .routes(routes!(play))
        .routes(routes!(pause))
        .routes(routes!(reset))
}

/// Start a live simulation.
#[utoipa::path(post, path = "/sessions", operation_id = "create_session", tag = "sessions", request_body(content = ref(of::<NewSession>())), responses(
    (status = 201, description = "The session, at its start", body = ref(of::<SessionState>()),
        headers(("location" = String, description = "Its address"))),
    (status = 422, description = "The scene was refused", body = ref(PROBLEM)),
    (status = 503, description = "All sessions are in use, or as many as one student may have", body = ref(PROBLEM))))]
async fn create(
    State(app): State<App>,
    caller: Caller,
    Json(wanted): Json<NewSession>,
) -> Result<impl IntoResponse, Problem> {
    let asked = asked_first(&app, &caller, wanted.lesson.as_deref());
    let (_asker, asking) = Asker::new();
    let shared = app.clone();
    let session = blocking(move || {
        let app = shared;
        asking.check()?;
        let (mut scene, source) =
            choose(&app, &caller, wanted.lesson, wanted.seed.as_deref(), wanted.builtin, wanted.scene)?;
        wanted.overrides.apply(&mut scene);
        asking.check()?;
        let written_here = matches!(source, SceneSource::Scene(_));
        // Who teaches shows several things at a time; of students nobody takes the places of all.
        let whose = caller.0.filter(|member| member.role == Role::Student).map(|member| member.id);
        let started = app.sessions.start(scene, &wanted.change, source, whose, &app.limits);
        let session =
            started.map_err(|problem| if written_here { problem.within("/scene") } else { problem })?;
        Ok(Unclaimed { app, session: Some(session) })
    })
    .await?
    .claimed()?;
    if let Some(asked) = asked {
        session.ask_first(asked);
    }
    let state = session.state();
    let mut headers = HeaderMap::new();
    if let Ok(address) = state.links.this.parse() {
        headers.insert(header::LOCATION, address);
    }
    Ok((StatusCode::CREATED, headers, axum::Json(state)))
}

/// A session that was made for a caller who may have left: nobody else knows its name, and it would keep its place until it expires.
struct Unclaimed {
    app: App,
    session: Option<Arc<Session>>,
}

impl Unclaimed {
    fn claimed(mut self) -> Result<Arc<Session>, Problem> {
        self.session.take().ok_or_else(|| Problem::internal("a session is claimed twice"))
    }
}

impl Drop for Unclaimed {
    fn drop(&mut self) {
        if let Some(session) = &self.session {
            drop(self.app.sessions.remove(&session.state().id));
        }
    }
}

/// A student of a class predicts before the run of a lesson that asks for it. Who teaches shows it to others.
fn asked_first(app: &App, caller: &Caller, lesson: Option<&str>) -> Option<AskedFirst> {
    let student = caller.0.as_ref().filter(|member| app.access.is_class() && member.role == Role::Student)?;
    let asking = app.course.lesson(lesson?).filter(|lesson| !lesson.about.predictions.is_empty())?;
    Some(AskedFirst { person: student.id.clone(), lesson: asking.slug.clone() })
}

/// The session, if its run may go on: everything that its lesson asks for before was predicted or skipped.
async fn to_run(app: &App, id: &str) -> Result<Arc<Session>, Problem> {
    let session = app.sessions.get(id)?;
    let Some(AskedFirst { person, lesson }) = session.asked_first() else { return Ok(session) };
    let Some(lesson) = app.course.lesson(lesson) else { return Ok(session) };
    let made = app.store.predictions(CLASS, Some(person), Some(&lesson.slug)).await?;
    let is_missing = |id: &str| !made.iter().any(|one| one.prediction == id);
    let Some(missing) = lesson.about.predictions.iter().find(|one| is_missing(&one.id)) else {
        return Ok(session);
    };
    let detail = format!("the lesson asks what you expect before it runs: {}", missing.id);
    let hint =
        format!("say it or skip it on the page, or by POST /api/v1/lessons/{}/predictions", lesson.slug);
    Err(Problem::new(StatusCode::CONFLICT, "predict-first", detail, hint))
}

fn choose(
    app: &App,
    caller: &Caller,
    lesson: Option<String>,
    seed: Option<&str>,
    builtin: Option<String>,
    scene: Option<serde_json::Value>,
) -> Result<(Scene, SceneSource), Problem> {
    match (lesson, builtin, scene) {
        (Some(slug), None, None) => {
            let lesson = crate::api::lessons::variant(app, &slug, seed, caller)?;
            let scene = Scene::from_json(&lesson.scene.to_string())?;
            Ok((scene, SceneSource::Lesson(slug)))
        }
        (None, Some(name), None) => {
            Ok((scenes::builtin_within(&name, &app.limits)?, SceneSource::Builtin(name)))
        }
        (None, None, Some(value)) => {
            let scene = Scene::from_json(&value.to_string())
                .map_err(|error| Problem::from(error).within("/scene"))?;
            let name = scene.name.clone();
            Ok((scene, SceneSource::Scene(name)))
        }
        _ => Err(Problem::new(
            StatusCode::UNPROCESSABLE_ENTITY,
            "what-to-simulate",
            "a session needs exactly one of `lesson`, `builtin` and `scene`",
            r#"for example {"builtin": "simple-pendulum"}"#,
        )),
    }
}

/// A session's state.
#[utoipa::path(get, path = "/sessions/{id}", operation_id = "get_session", tag = "sessions", params(("id" = String, Path)), responses(
    (status = 200, description = "The state now", body = ref(of::<SessionState>())),
    (status = 404, description = "No such session", body = ref(PROBLEM))))]
async fn show(
    State(app): State<App>,
    PathParameters(id): PathParameters<String>,
) -> Result<axum::Json<Arc<SessionState>>, Problem> {
    Ok(axum::Json(app.sessions.get(&id)?.state()))
}

/// Close a session.
#[utoipa::path(delete, path = "/sessions/{id}", operation_id = "delete_session", tag = "sessions", params(("id" = String, Path)), responses(
    (status = 204, description = "It is closed"),
    (status = 404, description = "No such session", body = ref(PROBLEM))))]
async fn delete(
    State(app): State<App>,
    PathParameters(id): PathParameters<String>,
) -> Result<StatusCode, Problem> {
    app.sessions.remove(&id)?;
    Ok(StatusCode::NO_CONTENT)
}

/// Step a session; it is paused first.
#[utoipa::path(post, path = "/sessions/{id}/step", operation_id = "step_session", tag = "sessions", params(("id" = String, Path)),
    request_body(content = ref(of::<StepRequest>())), responses(
    (status = 200, description = "The state after it", body = ref(of::<SessionState>())),
    (status = 409, description = "The simulation has stopped, or waits for a prediction", body = ref(PROBLEM)),
    (status = 422, description = "The engine could not go on; the last good state is kept", body = ref(PROBLEM))))]
async fn step(
    State(app): State<App>,
    PathParameters(id): PathParameters<String>,
    Json(step): Json<StepRequest>,
) -> Result<axum::Json<Arc<SessionState>>, Problem> {
    let session = to_run(&app, &id).await?;
    let state = match step.asked()? {
        Stretch::Steps(count) => session.steps(count).await?,
        Stretch::Seconds(seconds) => session.seconds(seconds).await?,
    };
    Ok(axum::Json(state))
}

/// Let time run.
#[utoipa::path(post, path = "/sessions/{id}/play", operation_id = "play_session", tag = "sessions", params(("id" = String, Path)),
    request_body(content = ref(of::<PlayRequest>())), responses(
    (status = 200, description = "The state at that moment", body = ref(of::<SessionState>())),
    (status = 409, description = "The simulation has stopped, or waits for a prediction", body = ref(PROBLEM))))]
async fn play(
    State(app): State<App>,
    PathParameters(id): PathParameters<String>,
    Json(play): Json<PlayRequest>,
) -> Result<axum::Json<Arc<SessionState>>, Problem> {
    let session = to_run(&app, &id).await?;
    Ok(axum::Json(session.play(play.asked()?).await?))
}

/// Stop time.
#[utoipa::path(post, path = "/sessions/{id}/pause", operation_id = "pause_session", tag = "sessions", params(("id" = String, Path)), responses(
    (status = 200, description = "The state at that moment", body = ref(of::<SessionState>()))))]
async fn pause(
    State(app): State<App>,
    PathParameters(id): PathParameters<String>,
) -> Result<axum::Json<Arc<SessionState>>, Problem> {
    Ok(axum::Json(app.sessions.get(&id)?.pause().await?))
}

/// Go back to the start; the recording begins anew.
#[utoipa::path(post, path = "/sessions/{id}/reset", operation_id = "reset_session", tag = "sessions", params(("id" = String, Path)), responses(
    (status = 200, description = "The state at the start", body = ref(of::<SessionState>()))))]
async fn reset(
    State(app): State<App>,
    PathParameters(id): PathParameters<String>,
) -> Result<axum::Json<Arc<SessionState>>, Problem> {
    Ok(axum::Json(app.sessions.get(&id)?.reset().await?))
}
