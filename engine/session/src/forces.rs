//! Forces of a run at one moment: multipliers, and reactions by every convention (on which body, about which point, in
//! which frame, which of their components are unique).

use http::StatusCode;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use triad_engine::reactions::Multiplier;
use triad_engine::reactions::report::{Convention, ExpressedIn, MomentReference, Reaction, Side};
use triad_engine::reactions::uniqueness::Redundancy;
use triad_engine::run::StateView;

use crate::refusal::Refusal;

/// How reactions are wanted.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ReactionQuery {
    /// The time, s: one that the run has passed; the present if it is not given.
    #[serde(default)]
    pub at: Option<f64>,
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
pub struct ReactionsView {
    /// Time, s.
    time: f64,
    /// The reactions, joints before drivers.
    reactions: Vec<Reaction>,
    /// Sets of joints that share redundant rows at this position.
    redundancies: Vec<Redundancy>,
}

impl ReactionsView {
    /// Those of a state. Errors if the point is unknown, or the scene too large to tell which are unique.
    pub fn of(run: &StateView, wanted: &ReactionQuery) -> Result<Self, Refusal> {
        let about = about(wanted.about.as_deref())?;
        let convention = Convention { on: wanted.on, about, expressed_in: wanted.expressed_in };
        let report = run.reactions(convention)?;
        Ok(Self { time: report.time, reactions: report.reactions, redundancies: report.redundancies })
    }
}

/// The reaction in one joint.
#[derive(Debug, Serialize, JsonSchema)]
#[schemars(rename = "JointMultipliers")]
pub struct MultipliersView {
    /// Time of the state, s: the latest that is kept and not after the one that was asked for.
    time: f64,
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
pub struct MultipliersList(Vec<MultipliersView>);

impl MultipliersList {
    /// Those of a state.
    pub fn of(run: &StateView) -> Self {
        let time = run.time();
        let joints = run.multipliers().into_iter().map(|joint| MultipliersView {
            time,
            joint: joint.joint,
            rows: joint.rows,
            force_on_j: joint.force,
            moment_on_j: joint.moment,
            at: joint.about,
            on: joint.on,
            by: joint.by,
            expressed_in: joint.expressed_in.into(),
        });
        Self(joints.collect())
    }
}

fn about(asked: Option<&str>) -> Result<MomentReference, Refusal> {
    let text = match asked {
        None | Some("joint") => return Ok(MomentReference::JointPoint),
        Some("center") => return Ok(MomentReference::CenterOfMass),
        Some(text) => text,
    };
    let numbers: Result<Vec<f64>, _> = text.split(',').map(|part| part.trim().parse()).collect();
    match numbers.as_deref() {
        Ok(&[x, y, z]) if [x, y, z].iter().all(|n: &f64| n.is_finite()) => {
            Ok(MomentReference::WorldPoint([x, y, z]))
        }
        _ => Err(Refusal::new(
            StatusCode::BAD_REQUEST,
            "unknown-point",
            format!("there is no point \"{text}\" to take moments about"),
            "write joint, center, or three numbers like 0,1,0",
        )),
    }
}
