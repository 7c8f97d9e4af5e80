//! What may be done to a live session's scene: look at it, change its numbers, drag a body.

use std::sync::Arc;

use axum::extract::State;
use axum::http::StatusCode;
use triad_session::SessionState;
use triad_session::change::{Drag, SceneChange, SessionScene};
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use crate::api::describe::{PROBLEM, Schemas, of};
use crate::api::extract::{Json, PathParameters};
use crate::app::App;
use crate::problem::Problem;

pub(in crate::api) fn routes(schemas: &mut Schemas) -> OpenApiRouter<App> {
    schemas.answer::<SessionScene>();
    schemas.request::<SceneChange>();
    schemas.request::<Drag>();
    schemas.answer::<SessionState>();
    OpenApiRouter::new().routes(routes!(scene)).routes(routes!(change)).routes(routes!(drag, release))
}

/// A session's scene as it is now, its parameters, and the scene before any change.
#[utoipa::path(get, path = "/sessions/{id}/scene", operation_id = "get_session_scene", tag = "sessions", params(("id" = String, Path)), responses(
    (status = 200, description = "Scene and parameters", body = ref(of::<SessionScene>())),
    (status = 404, description = "No such session", body = ref(PROBLEM))))]
async fn scene(
    State(app): State<App>,
    PathParameters(id): PathParameters<String>,
) -> Result<axum::Json<SessionScene>, Problem> {
    Ok(axum::Json(app.sessions.get(&id)?.scene().await?))
}

/// Change parameters or other numbers of a session's scene; the run starts over or goes on.
#[utoipa::path(post, path = "/sessions/{id}/parameters", operation_id = "change_session", tag = "sessions", params(("id" = String, Path)),
    request_body(content = ref(of::<SceneChange>())), responses(
    (status = 200, description = "The state with the new numbers", body = ref(of::<SessionState>())),
    (status = 409, description = "The simulation has stopped and cannot go on", body = ref(PROBLEM)),
    (status = 422, description = "The numbers were refused; the run is as it was", body = ref(PROBLEM))))]
async fn change(
    State(app): State<App>,
    PathParameters(id): PathParameters<String>,
    Json(change): Json<SceneChange>,
) -> Result<axum::Json<Arc<SessionState>>, Problem> {
    let session = app.sessions.get(&id)?;
    if change.is_empty() {
        return Err(Problem::new(
            StatusCode::UNPROCESSABLE_ENTITY,
            "nothing-to-change",
            "the request names neither values nor places",
            r#"for example {"values": {"mass": 2}} or {"places": {"/bodies/0/mass": 2}}"#,
        ));
    }
    Ok(axum::Json(session.change(change).await?))
}

/// Drag a body by a spring to one of its points; the run goes on.
#[utoipa::path(put, path = "/sessions/{id}/pull", operation_id = "drag_body", tag = "sessions", params(("id" = String, Path)),
    request_body(content = ref(of::<Drag>())), responses(
    (status = 200, description = "The state with the spring", body = ref(of::<SessionState>())),
    (status = 422, description = "The body cannot be dragged so", body = ref(PROBLEM))))]
async fn drag(
    State(app): State<App>,
    PathParameters(id): PathParameters<String>,
    Json(drag): Json<Drag>,
) -> Result<axum::Json<Arc<SessionState>>, Problem> {
    Ok(axum::Json(app.sessions.get(&id)?.drag(Some(drag)).await?))
}

/// Let the dragged body go; the run goes on.
#[utoipa::path(delete, path = "/sessions/{id}/pull", operation_id = "release_body", tag = "sessions", params(("id" = String, Path)), responses(
    (status = 200, description = "The state without the spring", body = ref(of::<SessionState>()))))]
async fn release(
    State(app): State<App>,
    PathParameters(id): PathParameters<String>,
) -> Result<axum::Json<Arc<SessionState>>, Problem> {
    Ok(axum::Json(app.sessions.get(&id)?.drag(None).await?))
}
