//! Forces of a live session: multipliers, reactions by every convention (on which body, about which point, in which frame,
//! which of their components are unique), and how they are drawn.

use std::sync::Arc;

use axum::extract::State;
use triad_session::SessionState;
use triad_session::forces::{MultipliersList, ReactionQuery, ReactionsView};
use triad_session::requests::{AtTime, NewCamera, NewDrawing};
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use crate::api::describe::{PROBLEM, Schemas, of};
use crate::api::extract::{Json, PathParameters, QueryParameters};
use crate::app::App;
use crate::problem::Problem;
use crate::session::Session;

pub(in crate::api) fn routes(schemas: &mut Schemas) -> OpenApiRouter<App> {
    schemas.answer::<ReactionsView>();
    schemas.answer::<MultipliersList>();
    schemas.request::<NewDrawing>();
    schemas.request::<NewCamera>();
    schemas.answer::<SessionState>();
    OpenApiRouter::new()
        .routes(routes!(reactions))
        .routes(routes!(multipliers))
        .routes(routes!(draw))
        .routes(routes!(look_from))
}

/// The reactions at the session's time: force and moment of every joint and driver, and which components are unique.
#[utoipa::path(get, path = "/sessions/{id}/reactions", operation_id = "get_reactions", tag = "sessions", params(("id" = String, Path),
    ("on" = Option<String>, Query, description = "On body `i` or on body `j` of each joint", example = "j"),
    ("about" = Option<String>, Query, example = "joint",
        description = "About the `joint`, the `center` of mass of that body, or a point of the world like `0,1,0`"),
    ("in" = Option<String>, Query, example = "world",
        description = "Components in the frame of the `world`, of the `joint`, or of that `body`"),
    ("at" = Option<f64>, Query, description = "A time that the run has passed, s: the latest state that is kept and not after it answers, and tells its time. The present if it is not given")),
    responses((status = 200, description = "One entry a joint or driver", body = ref(of::<ReactionsView>())),
    (status = 404, description = "No such session", body = ref(PROBLEM)),
    (status = 422, description = "The scene has too many rows to tell which are unique", body = ref(PROBLEM))))]
async fn reactions(
    State(app): State<App>,
    PathParameters(id): PathParameters<String>,
    QueryParameters(wanted): QueryParameters<ReactionQuery>,
) -> Result<axum::Json<ReactionsView>, Problem> {
    Ok(axum::Json(reactions_of(&*app.sessions.get(&id)?, wanted).await?))
}

pub(in crate::api) async fn reactions_of(
    session: &Session,
    wanted: ReactionQuery,
) -> Result<ReactionsView, Problem> {
    session.query(wanted.at, move |run| Ok(ReactionsView::of(run, &wanted)?)).await
}

/// The multipliers and reactions, joint by joint.
#[utoipa::path(get, path = "/sessions/{id}/multipliers", operation_id = "get_multipliers", tag = "sessions", params(("id" = String, Path),
    ("at" = Option<f64>, Query, description = "A time that the run has passed, s: the latest state that is kept and not after it answers, and tells its time. The present if it is not given")),
    responses((status = 200, description = "One entry a joint", body = ref(of::<MultipliersList>()))))]
async fn multipliers(
    State(app): State<App>,
    PathParameters(id): PathParameters<String>,
    QueryParameters(when): QueryParameters<AtTime>,
) -> Result<axum::Json<MultipliersList>, Problem> {
    Ok(axum::Json(multipliers_of(&*app.sessions.get(&id)?, when.at).await?))
}

pub(in crate::api) async fn multipliers_of(
    session: &Session,
    at: Option<f64>,
) -> Result<MultipliersList, Problem> {
    session.query(at, |run| Ok(MultipliersList::of(run))).await
}

/// Draw forces in another way, in every picture of this session and at all times of its recording.
#[utoipa::path(put, path = "/sessions/{id}/drawing", operation_id = "set_drawing", tag = "sessions", params(("id" = String, Path)),
    request_body(content = ref(of::<NewDrawing>())), responses(
    (status = 200, description = "The state with the new drawing", body = ref(of::<SessionState>()))))]
async fn draw(
    State(app): State<App>,
    PathParameters(id): PathParameters<String>,
    Json(new): Json<NewDrawing>,
) -> Result<axum::Json<Arc<SessionState>>, Problem> {
    Ok(axum::Json(app.sessions.get(&id)?.draw(new.arrows, new.fit).await?))
}

/// Look at the mechanism from another side.
#[utoipa::path(put, path = "/sessions/{id}/camera", operation_id = "set_camera", tag = "sessions", params(("id" = String, Path)),
    request_body(content = ref(of::<NewCamera>())), responses(
    (status = 200, description = "The state with the new camera", body = ref(of::<SessionState>()))))]
async fn look_from(
    State(app): State<App>,
    PathParameters(id): PathParameters<String>,
    Json(new): Json<NewCamera>,
) -> Result<axum::Json<Arc<SessionState>>, Problem> {
    Ok(axum::Json(app.sessions.get(&id)?.look_from(new.from).await?))
}
