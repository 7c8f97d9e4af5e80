//! Reactions of a live session, told completely: on which body, about which point, in which frame, and which of
//! their components are unique.

use axum::extract::State;
use axum::http::StatusCode;
use serde::{Deserialize, Serialize};
use triad_engine::reaction::report::{About, Component, Convention, ExpressedIn, ReactionReport, Side};
use utoipa::ToSchema;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use super::extract::{Asked, At};
use crate::app::App;
use crate::problem::{Problem, ProblemDocument};

pub(super) fn routes() -> OpenApiRouter<App> {
    OpenApiRouter::new().routes(routes!(reactions))
}

/// How reactions are wanted.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Wanted {
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
struct ReactionsView {
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
        description = "Components in the frame of the `world`, of the `joint`, or of that `body`")),
    responses((status = 200, description = "One entry a joint or driver", body = ReactionsView),
    (status = 404, description = "No such session", body = ProblemDocument),
    (status = 422, description = "The scene has too many rows to tell which are unique", body = ProblemDocument)))]
async fn reactions(
    State(app): State<App>,
    At(id): At<String>,
    Asked(wanted): Asked<Wanted>,
) -> Result<axum::Json<ReactionsView>, Problem> {
    let session = app.sessions.get(&id)?;
    let about = about(wanted.about.as_deref())?;
    let convention = Convention { on: wanted.on, about, expressed_in: wanted.expressed_in };
    Ok(axum::Json(session.reactions(convention).await?.into()))
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
