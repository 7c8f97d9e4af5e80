//! Matrices of a live session: the Jacobian, the augmented matrix and S, with names, values and fill.

use axum::extract::State;
use triad_engine::reactions::matrices::Symmetric;
use triad_engine::run::StateView;
use triad_session::matrices::{JacobianView, SymmetricView};
use triad_session::requests::AtTime;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use crate::api::describe::{PROBLEM, Schemas, of};
use crate::api::extract::{PathParameters, QueryParameters};
use crate::app::App;
use crate::problem::Problem;
use crate::session::Session;

pub(in crate::api) fn routes(schemas: &mut Schemas) -> OpenApiRouter<App> {
    schemas.answer::<JacobianView>();
    schemas.answer::<SymmetricView>();
    OpenApiRouter::new().routes(routes!(jacobian)).routes(routes!(augmented)).routes(routes!(schur))
}

/// The Jacobian.
#[utoipa::path(get, path = "/sessions/{id}/jacobian", operation_id = "get_jacobian", tag = "sessions", params(("id" = String, Path),
    ("at" = Option<f64>, Query, description = "A time that the run has passed, s: the latest state that is kept and not after it answers, and tells its time. The present if it is not given")),
    responses((status = 200, description = "Pattern and values", body = ref(of::<JacobianView>())),
    (status = 422, description = "The state of that time is not kept", body = ref(PROBLEM))))]
async fn jacobian(
    State(app): State<App>,
    PathParameters(id): PathParameters<String>,
    QueryParameters(when): QueryParameters<AtTime>,
) -> Result<axum::Json<JacobianView>, Problem> {
    Ok(axum::Json(jacobian_of(&*app.sessions.get(&id)?, when.at).await?))
}

pub(in crate::api) async fn jacobian_of(session: &Session, at: Option<f64>) -> Result<JacobianView, Problem> {
    session.query(at, |run| Ok(JacobianView::of(run))).await
}

/// The augmented matrix of the equations of motion, with the fill of eliminating coordinates first.
#[utoipa::path(get, path = "/sessions/{id}/augmented", operation_id = "get_augmented_matrix", tag = "sessions", params(("id" = String, Path),
    ("at" = Option<f64>, Query, description = "A time that the run has passed, s: the latest state that is kept and not after it answers, and tells its time. The present if it is not given")),
    responses((status = 200, description = "Pattern and values", body = ref(of::<SymmetricView>())),
    (status = 422, description = "It is too large, or the state of that time is not kept", body = ref(PROBLEM))))]
#[allow(
    clippy::redundant_closure_for_method_calls,
    reason = "the method itself is not general enough in its lifetime"
)]
async fn augmented(
    State(app): State<App>,
    PathParameters(id): PathParameters<String>,
    QueryParameters(when): QueryParameters<AtTime>,
) -> Result<axum::Json<SymmetricView>, Problem> {
    Ok(axum::Json(symmetric_of(&*app.sessions.get(&id)?, when.at, |state| state.augmented()).await?))
}

/// The matrix S that the solver factors, in its order of elimination, with the fill of its factor.
#[utoipa::path(get, path = "/sessions/{id}/schur", operation_id = "get_schur_complement", tag = "sessions", params(("id" = String, Path),
    ("at" = Option<f64>, Query, description = "A time that the run has passed, s: the latest state that is kept and not after it answers, and tells its time. The present if it is not given")),
    responses((status = 200, description = "Pattern and values", body = ref(of::<SymmetricView>())),
    (status = 422, description = "It is too large, or the state of that time is not kept", body = ref(PROBLEM))))]
#[allow(
    clippy::redundant_closure_for_method_calls,
    reason = "the method itself is not general enough in its lifetime"
)]
async fn schur(
    State(app): State<App>,
    PathParameters(id): PathParameters<String>,
    QueryParameters(when): QueryParameters<AtTime>,
) -> Result<axum::Json<SymmetricView>, Problem> {
    Ok(axum::Json(symmetric_of(&*app.sessions.get(&id)?, when.at, |state| state.schur()).await?))
}

pub(in crate::api) async fn symmetric_of(
    session: &Session,
    at: Option<f64>,
    matrix: fn(&StateView) -> Symmetric,
) -> Result<SymmetricView, Problem> {
    session.query(at, move |run| Ok(SymmetricView::of(run, matrix)?)).await
}
