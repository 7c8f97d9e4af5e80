//! Forces of a live session: multipliers, reactions told completely (on which body, about which point, in which frame,
//! which of their components are unique), and how they are drawn.

use std::sync::Arc;

use axum::extract::State;
use axum::http::StatusCode;
use serde::{Deserialize, Serialize};
use triad_engine::reaction::report::{About, Component, Convention, ExpressedIn, ReactionReport, Side};
use utoipa::ToSchema;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use super::extract::{Asked, At, Json};
use super::matrices::When;
use crate::app::App;
use crate::problem::{Problem, ProblemDocument};
use crate::session::{Session, SessionState};
use crate::stream::{Arrows, Camera};

pub(super) fn routes() -> OpenApiRouter<App> {
    OpenApiRouter::new()
        .routes(routes!(reactions))
        .routes(routes!(multipliers))
        .routes(routes!(draw))
        .routes(routes!(look_from))
}

/// How reactions are wanted.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Wanted {
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
#[derive(Debug, Serialize, ToSchema)]
pub(super) struct ReactionsView {
    /// Time, s.
    time: f64,
    /// The reactions, joints before drivers.
    reactions: Vec<ReactionView>,
    /// Sets of joints that share redundant rows at this position.
    redundancies: Vec<RedundancyView>,
}

/// The reaction of a joint or driver.
#[derive(Debug, Serialize, ToSchema)]
#[schema(as = CompleteReaction)]
struct ReactionView {
    /// The joint or driver.
    joint: String,
    /// Whether it is a driver.
    driver: bool,
    /// The body that the reaction acts on.
    on: String,
    /// The body that exerts it.
    by: String,
    /// The point about which the moment is taken, in words.
    about: String,
    /// That point in the world, m.
    #[schema(value_type = Vec<f64>)]
    about_at: [f64; 3],
    /// The frame of the components, in words.
    expressed_in: String,
    /// Its axes in the world.
    #[schema(value_type = Vec<Vec<f64>>)]
    axes: [[f64; 3]; 3],
    /// Force, N.
    force: Vec<ComponentView>,
    /// Moment, N m.
    moment: Vec<ComponentView>,
}

/// A component of a force or moment.
#[derive(Debug, Serialize, ToSchema)]
struct ComponentView {
    /// Its value; where it is not unique, that of the smallest multipliers that give the same motion.
    value: f64,
    /// Whether the equations of motion determine it.
    unique: bool,
}

/// A set of joints that share redundant rows.
#[derive(Debug, Serialize, ToSchema)]
struct RedundancyView {
    /// How many rows are too many.
    rows: usize,
    /// The joints and drivers that share them.
    joints: Vec<String>,
    /// Changes of joints that together remove the redundancy, if the usual ones do.
    remedies: Vec<RemedyView>,
}

/// A change of a joint that helps to make reactions unique.
#[derive(Debug, Serialize, ToSchema)]
struct RemedyView {
    /// The joint.
    joint: String,
    /// The type that it would become.
    #[schema(value_type = String)]
    becomes: triad_engine::scene::JointKind,
    /// What it would no longer hold.
    gives_up: String,
}

/// The reactions at the session's time: force and moment of every joint and driver, and which components are unique.
#[utoipa::path(get, path = "/sessions/{id}/reactions", tag = "sessions", params(("id" = String, Path),
    ("on" = Option<String>, Query, description = "On body `i` or on body `j` of each joint", example = "j"),
    ("about" = Option<String>, Query, example = "joint",
        description = "About the `joint`, the `center` of mass of that body, or a point of the world like `0,1,0`"),
    ("in" = Option<String>, Query, example = "world",
        description = "Components in the frame of the `world`, of the `joint`, or of that `body`"),
    ("at" = Option<f64>, Query, description = "A time that the run has passed, s; the present if it is not given")),
    responses((status = 200, description = "One entry a joint or driver", body = ReactionsView),
    (status = 404, description = "No such session", body = ProblemDocument),
    (status = 422, description = "The scene has too many rows to tell which are unique", body = ProblemDocument)))]
async fn reactions(
    State(app): State<App>,
    At(id): At<String>,
    Asked(wanted): Asked<Wanted>,
) -> Result<axum::Json<ReactionsView>, Problem> {
    Ok(axum::Json(reactions_of(&*app.sessions.get(&id)?, wanted).await?))
}

pub(super) async fn reactions_of(session: &Session, wanted: Wanted) -> Result<ReactionsView, Problem> {
    let about = about(wanted.about.as_deref())?;
    let convention = Convention { on: wanted.on, about, expressed_in: wanted.expressed_in };
    let report = session.look(wanted.at, move |run| run.reactions(convention).map_err(Problem::from)).await?;
    Ok(report.into())
}

/// The multiplier of one row.
#[derive(Debug, Serialize, ToSchema)]
struct MultiplierView {
    /// The row.
    label: String,
    /// Its multiplier.
    value: f64,
}

/// The reaction in one joint.
#[derive(Debug, Serialize, ToSchema)]
#[schema(as = ReactionView)]
pub(super) struct JointView {
    /// Name of the joint.
    joint: String,
    /// The multipliers of its rows.
    rows: Vec<MultiplierView>,
    /// Force on the body `on`, N: body j of the joint, or body i if j is the ground.
    #[schema(value_type = Vec<f64>)]
    force_on_j: [f64; 3],
    /// Moment, N m, about the point `at`.
    #[schema(value_type = Vec<f64>)]
    moment_on_j: [f64; 3],
    /// The joint's point in the world, m.
    #[schema(value_type = Vec<f64>)]
    at: [f64; 3],
    /// The body that the force acts on.
    on: String,
    /// The body that exerts it.
    by: String,
    /// The frame of all components.
    expressed_in: String,
}

/// The multipliers and reactions, joint by joint.
#[utoipa::path(get, path = "/sessions/{id}/multipliers", tag = "sessions", params(("id" = String, Path),
    ("at" = Option<f64>, Query, description = "A time that the run has passed, s; the present if it is not given")),
    responses((status = 200, description = "One entry a joint", body = Vec<JointView>)))]
async fn multipliers(
    State(app): State<App>,
    At(id): At<String>,
    Asked(when): Asked<When>,
) -> Result<axum::Json<Vec<JointView>>, Problem> {
    Ok(axum::Json(multipliers_of(&*app.sessions.get(&id)?, when.at).await?))
}

pub(super) async fn multipliers_of(session: &Session, at: Option<f64>) -> Result<Vec<JointView>, Problem> {
    let found = session.look(at, |run| Ok(run.multipliers())).await?;
    let joints = found.into_iter().map(|joint| JointView {
        joint: joint.joint,
        rows: joint
            .rows
            .into_iter()
            .map(|row| MultiplierView { label: row.label, value: row.value })
            .collect(),
        force_on_j: joint.force,
        moment_on_j: joint.moment,
        at: joint.about,
        on: joint.on,
        by: joint.by,
        expressed_in: joint.expressed_in.into(),
    });
    Ok(joints.collect())
}

/// How forces are to be drawn; what is not given stays.
#[derive(Debug, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
struct NewDrawing {
    /// Which, on which body, about which point.
    arrows: Option<Arrows>,
    /// Take the scale of forces from the recording so far.
    #[serde(default)]
    fit: bool,
}

/// Draw forces in another way, in every picture of this session and at all times of its recording.
#[utoipa::path(put, path = "/sessions/{id}/drawing", tag = "sessions", params(("id" = String, Path)),
    request_body = NewDrawing, responses(
    (status = 200, description = "The state with the new drawing", body = SessionState)))]
async fn draw(
    State(app): State<App>,
    At(id): At<String>,
    Json(new): Json<NewDrawing>,
) -> Result<axum::Json<Arc<SessionState>>, Problem> {
    Ok(axum::Json(app.sessions.get(&id)?.draw(new.arrows, new.fit).await?))
}

/// Where the camera is to stand.
#[derive(Debug, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
struct NewCamera {
    /// From where the mechanism is looked at.
    from: Camera,
}

/// Look at the mechanism from another side.
#[utoipa::path(put, path = "/sessions/{id}/camera", tag = "sessions", params(("id" = String, Path)),
    request_body = NewCamera, responses(
    (status = 200, description = "The state with the new camera", body = SessionState)))]
async fn look_from(
    State(app): State<App>,
    At(id): At<String>,
    Json(new): Json<NewCamera>,
) -> Result<axum::Json<Arc<SessionState>>, Problem> {
    Ok(axum::Json(app.sessions.get(&id)?.look_from(new.from).await?))
}

fn about(asked: Option<&str>) -> Result<About, Problem> {
    let text = match asked {
        None | Some("joint") => return Ok(About::JointPoint),
        Some("center") => return Ok(About::CenterOfMass),
        Some(text) => text,
    };
    let numbers: Vec<f64> = text.split(',').filter_map(|part| part.trim().parse().ok()).collect();
    match numbers[..] {
        [x, y, z] if [x, y, z].iter().all(|n: &f64| n.is_finite()) => Ok(About::WorldPoint([x, y, z])),
        _ => Err(Problem::new(
            StatusCode::BAD_REQUEST,
            "unknown-point",
            format!("there is no point \"{text}\" to take moments about"),
            "write joint, center, or three numbers like 0,1,0",
        )),
    }
}

impl From<ReactionReport> for ReactionsView {
    fn from(report: ReactionReport) -> Self {
        let components = |all: [Component; 3]| {
            all.into_iter().map(|c| ComponentView { value: c.value, unique: c.unique }).collect()
        };
        let reactions = report.reactions.into_iter().map(|r| ReactionView {
            joint: r.joint,
            driver: r.driver,
            on: r.on,
            by: r.by,
            about: r.about,
            about_at: r.about_at,
            expressed_in: r.expressed_in,
            axes: r.axes,
            force: components(r.force),
            moment: components(r.moment),
        });
        let redundancies = report.redundancies.into_iter().map(|r| RedundancyView {
            rows: r.rows,
            joints: r.joints,
            remedies: r
                .remedies
                .into_iter()
                .map(|m| RemedyView { joint: m.joint, becomes: m.becomes, gives_up: m.gives_up.to_owned() })
                .collect(),
        });
        Self { time: report.time, reactions: reactions.collect(), redundancies: redundancies.collect() }
    }
}
