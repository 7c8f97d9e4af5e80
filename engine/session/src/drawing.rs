//! How a run is wanted drawn: which forces, by which convention, and from where it is looked at.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use triad_engine::reactions::report::Side;

/// Which forces are drawn, and by which convention.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Arrows {
    /// On the first or on the second body of each joint.
    pub on: Side,
    /// About which point: there the force is drawn and the moment taken.
    pub about: MomentPoint,
    /// Which of them.
    pub drawn: DrawnForces,
    /// The joint that is marked, because somebody selected it or its rows.
    pub marked: Option<String>,
}

/// The point about which moments are taken.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum MomentPoint {
    /// The joint's.
    #[default]
    Joint,
    /// The centre of mass of the body that is acted on.
    Center,
}

/// Which forces are drawn.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum DrawnForces {
    /// None.
    None,
    /// Those of every joint.
    #[default]
    All,
    /// That of one joint.
    Joint(String),
    /// All forces on one body, which is cut free.
    Body(String),
}

/// From where the mechanism is looked at.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Camera {
    /// Nearly from the front where it hangs in a vertical x-y plane, from above a corner otherwise.
    #[default]
    Corner,
    /// Against the axis that points forward.
    Front,
    /// Against the x axis.
    Side,
    /// Along gravity.
    Above,
}
