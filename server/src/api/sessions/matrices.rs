//! Matrices of a live session: the Jacobian, the augmented matrix and S, with names, values and fill.

use axum::extract::State;
use axum::http::StatusCode;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use triad_engine::analysis::check::dependent_sets;
use triad_engine::reactions::matrices::{EntryKind, Symmetric};
use triad_engine::run::StateView;
use triad_engine::system::index::EquationId;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use crate::api::describe::{PROBLEM, Schemas, of};
use crate::api::extract::{PathParameters, QueryParameters};
use crate::app::App;
use crate::problem::Problem;
use crate::session::Session;

/// Rows of the largest matrix that is sent in full.
const MAX_ROWS: usize = 3_000;
/// Largest number of entries that is sent.
const MAX_PLACES: usize = 60_000;

pub(in crate::api) fn routes(schemas: &mut Schemas) -> OpenApiRouter<App> {
    schemas.answer::<JacobianView>();
    schemas.answer::<SymmetricView>();
    OpenApiRouter::new().routes(routes!(jacobian)).routes(routes!(augmented)).routes(routes!(schur))
}

/// The time that something is wanted for.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(in crate::api) struct AtTime {
    /// One that the run has passed, s; the present if it is not given.
    #[serde(default)]
    pub at: Option<f64>,
}

/// The Jacobian of the constraints: a sparse matrix whose rows and columns have names.
#[derive(Debug, Serialize, JsonSchema)]
#[schemars(rename = "Jacobian")]
pub(in crate::api) struct JacobianView {
    /// Time, s.
    time: f64,
    /// What each row is: its joint or body, and the row.
    rows: Vec<String>,
    /// What each column is: its body, and the coordinate.
    columns: Vec<String>,
    /// Row, column, value, and whether the entry never changes; entries that are not listed are zero by structure.
    entries: Vec<(usize, usize, f64, bool)>,
    /// Rank near the start.
    rank: usize,
    /// Rows of which some say again what others say.
    redundant: Vec<RedundantSet>,
}

/// Rows of one form of which some say again what others say.
#[derive(Debug, Serialize, JsonSchema)]
struct RedundantSet {
    /// The rows, as indices.
    rows: Vec<usize>,
    /// How many of them are too many.
    dependent: usize,
}

/// The Jacobian.
#[utoipa::path(get, path = "/sessions/{id}/jacobian", operation_id = "get_jacobian", tag = "sessions", params(("id" = String, Path),
    ("at" = Option<f64>, Query, description = "A time that the run has passed, s; the present if it is not given")),
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
    session
        .query(at, |run| {
            let time = run.time();
            let sets = dependent_sets(run.system(), run.rank());
            let redundant = sets
                .into_iter()
                .map(|set| RedundantSet {
                    rows: set.equations.into_iter().map(EquationId::index).collect(),
                    dependent: set.dependent,
                })
                .collect();
            let system = run.system();
            let freedoms = 6 * system.bodies.len() - run.rank().rank;
            let rank = system.coordinates - freedoms;
            let found = run.jacobian();
            Ok(JacobianView {
                time,
                rows: found.rows.clone(),
                columns: found.columns.clone(),
                entries: found.entries.iter().map(|e| (e.row, e.column, e.value, e.constant)).collect(),
                rank,
                redundant,
            })
        })
        .await
}

/// A symmetric matrix: what stands on and below its diagonal.
#[derive(Debug, Serialize, JsonSchema)]
#[schemars(rename = "SymmetricMatrix")]
pub(in crate::api) struct SymmetricView {
    /// Time, s.
    time: f64,
    /// What each row is, and each column alike.
    names: Vec<String>,
    /// Row, column, value, and what it is: `own`, `constant`, `changing` or `fill`.
    places: Vec<(usize, usize, f64, EntryKind)>,
    /// Places on or below the diagonal that a factorization fills.
    fill: usize,
}

/// The augmented matrix of the equations of motion, with the fill of eliminating coordinates first.
#[utoipa::path(get, path = "/sessions/{id}/augmented", operation_id = "get_augmented_matrix", tag = "sessions", params(("id" = String, Path),
    ("at" = Option<f64>, Query, description = "A time that the run has passed, s; the present if it is not given")),
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
    ("at" = Option<f64>, Query, description = "A time that the run has passed, s; the present if it is not given")),
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
    session
        .query(at, move |run| {
            let system = run.system();
            let rows = system.coordinates + system.rigid_rows + system.equations;
            if rows > MAX_ROWS {
                return Err(too_large(&format!("{rows} rows, more than {MAX_ROWS}")));
            }
            let found = matrix(run);
            if found.places.len() > MAX_PLACES {
                return Err(too_large(&format!("{} places, more than {MAX_PLACES}", found.places.len())));
            }
            let fill = found.fill();
            let places = found.places.iter().map(|p| (p.row, p.column, p.value, p.part)).collect();
            Ok(SymmetricView { time: run.time(), names: found.names, places, fill })
        })
        .await
}

fn too_large(how: &str) -> Problem {
    Problem::new(
        StatusCode::UNPROCESSABLE_ENTITY,
        "matrix-too-large",
        format!("the matrix is too large for a picture: it has {how}"),
        "look at the Jacobian, or at a smaller mechanism of the same kind",
    )
}
