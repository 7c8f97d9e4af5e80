//! Where a scenario shows a value.

use schemars::JsonSchema;
use serde::Deserialize;

/// Where the scenario shows a value: a count, the energy, a body's motion or a joint's reaction.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MeasuredFile {
    /// Time, s.
    #[serde(default)]
    pub time: f64,
    /// A count of the whole scene.
    pub count: Option<CountKind>,
    /// The energy of the whole scene, J.
    #[serde(default)]
    pub energy: bool,
    /// A body, with `motion`.
    pub body: Option<String>,
    /// What of the body, in the ground frame.
    pub motion: Option<MotionKind>,
    /// With position or velocity: a point other than the centre of mass, by its lengths along u, v, w from there, m.
    pub point: Option<[f64; 3]>,
    /// A joint, with `force_on` or `moment_on`.
    pub joint: Option<String>,
    /// The body, or `ground`, on which the joint's force acts.
    pub force_on: Option<String>,
    /// The body, or `ground`, on which the joint's moment about its point acts.
    pub moment_on: Option<String>,
    /// One component or the size instead of the whole vector.
    pub component: Option<Component>,
}

/// A count of a scene.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum CountKind {
    /// Coordinates less rank.
    DegreesOfFreedom,
    /// Independent rows.
    Rank,
    /// All rows.
    Rows,
    /// All coordinates.
    Coordinates,
    /// Entries in the pattern of the Jacobian.
    JacobianEntries,
    /// Evaluations that the run has taken.
    Evaluations,
}

/// What of a body's motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum MotionKind {
    /// Position of the centre of mass.
    Position,
    /// Velocity of the centre of mass.
    Velocity,
    /// Angular velocity.
    AngularVelocity,
    /// Director u.
    U,
    /// Director v.
    V,
    /// Director w.
    W,
}

/// A component of a vector, or its size.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Component {
    /// Along x.
    X,
    /// Along y.
    Y,
    /// Along z.
    Z,
    /// The length of the vector.
    Size,
}
