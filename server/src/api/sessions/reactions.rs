//! Forces of a live session: multipliers, reactions by every convention (on which body, about which point, in which frame,
//! which of their components are unique), and how they are drawn.

use std::sync::Arc;

use axum::extract::State;
use axum::http::StatusCode;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use triad_engine::reactions::Multiplier;
use triad_engine::reactions::report::{Convention, ExpressedIn, MomentReference, Reaction, Side};
use triad_engine::reactions::uniqueness::Redundancy;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use crate::api::describe::{PROBLEM, Schemas, of};
use crate::api::extract::{Json, PathParameters, QueryParameters};
use crate::api::sessions::matrices::AtTime;
use crate::app::App;
use crate::problem::Problem;
use crate::session::{Session, SessionState};
use crate::stream::{Arrows, Camera};

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

/// How reactions are wanted.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(in crate::api) struct ReactionQuery {
    /// The time, s: one that the run has passed; the present if it is not given.
    #[serde(default)]
    at: Option<f64>,
    /// On body `i` or on body `j` of each joint.
    #[serde(default)]
    on: Side,
    /// About the `joint`, the `center` of mass of that body, or a point of the world like `0,1,0`.
    #[serde(default)]
    about: Option<String>,
    /// Components in the frame of the `world`, of the `joint`, or of that `body`.
    #[serde(default, rename = "in")]
    expressed_in: ExpressedIn,
}

/// Every reaction at one moment.
#[derive(Debug, Serialize, JsonSchema)]
#[schemars(rename = "Reactions")]
pub(in crate::api) struct ReactionsView {
    /// Time, s.
    time: f64,
    /// The reactions, joints before drivers.
    reactions: Vec<Reaction>,
    /// Sets of joints that share redundant rows at this position.
    redundancies: Vec<Redundancy>,
}

/// The reactions at the session's time: force and moment of every joint and driver, and which components are unique.
#[utoipa::path(get, path = "/sessions/{id}/reactions", operation_id = "get_reactions", tag = "sessions", params(("id" = String, Path),
    ("on" = Option<String>, Query, description = "On body `i` or on body `j` of each joint", example = "j"),
    ("about" = Option<String>, Query, example = "joint",
        description = "About the `joint`, the `center` of mass of that body, or a point of the world like `0,1,0`"),
    ("in" = Option<String>, Query, example = "world",
        description = "Components in the frame of the `world`, of the `joint`, or of that `body`"),
    ("at" = Option<f64>, Query, description = "A time that the run has passed, s; the present if it is not given")),
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
    let about = about(wanted.about.as_deref())?;
    let convention = Convention { on: wanted.on, about, expressed_in: wanted.expressed_in };
    let report =
        session.query(wanted.at, move |run| run.reactions(convention).map_err(Problem::from)).await?;
    Ok(ReactionsView { time: report.time, reactions: report.reactions, redundancies: report.redundancies })
}

/// The reaction in one joint.
#[derive(Debug, Serialize, JsonSchema)]
#[schemars(rename = "JointMultipliers")]
pub(in crate::api) struct MultipliersView {
    /// Name of the joint.
    joint: String,
    /// The multipliers of its rows.
    rows: Vec<Multiplier>,
    /// Force on the body `on`, N: body j of the joint, or body i if j is the ground.
    force_on_j: [f64; 3],
    /// Moment, N m, about the point `at`.
    moment_on_j: [f64; 3],
    /// The joint's point in the world, m.
    at: [f64; 3],
    /// The body that the force acts on.
    on: String,
    /// The body that exerts it.
    by: String,
    /// The frame of all components.
    expressed_in: String,
}

/// The multipliers of all joints.
#[derive(Debug, Serialize, JsonSchema)]
pub(in crate::api) struct MultipliersList(Vec<MultipliersView>);

/// The multipliers and reactions, joint by joint.
#[utoipa::path(get, path = "/sessions/{id}/multipliers", operation_id = "get_multipliers", tag = "sessions", params(("id" = String, Path),
    ("at" = Option<f64>, Query, description = "A time that the run has passed, s; the present if it is not given")),
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
    let found = session.query(at, |run| Ok(run.multipliers())).await?;
    let joints = found.into_iter().map(|joint| MultipliersView {
        joint: joint.joint,
        rows: joint.rows,
        force_on_j: joint.force,
        moment_on_j: joint.moment,
        at: joint.about,
        on: joint.on,
        by: joint.by,
        expressed_in: joint.expressed_in.into(),
    });
    Ok(MultipliersList(joints.collect()))
}

/// How forces are to be drawn; what is not given stays.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct NewDrawing {
    /// Which, on which body, about which point.
    arrows: Option<Arrows>,
    /// Take the scale of forces from the recording so far.
    #[serde(default)]
    fit: bool,
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

/// Where the camera is to stand.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct NewCamera {
    /// From where the mechanism is looked at.
    from: Camera,
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

fn about(asked: Option<&str>) -> Result<MomentReference, Problem> {
    let text = match asked {
        None | Some("joint") => return Ok(MomentReference::JointPoint),
        Some("center") => return Ok(MomentReference::CenterOfMass),
        Some(text) => text,
    };
    let numbers: Vec<f64> = text.split(',').filter_map(|part| part.trim().parse().ok()).collect();
    match numbers[..] {
        [x, y, z] if [x, y, z].iter().all(|n: &f64| n.is_finite()) => {
            Ok(MomentReference::WorldPoint([x, y, z]))
        }
        _ => Err(Problem::new(
            StatusCode::BAD_REQUEST,
            "unknown-point",
            format!("there is no point \"{text}\" to take moments about"),
            "write joint, center, or three numbers like 0,1,0",
        )),
    }
}
