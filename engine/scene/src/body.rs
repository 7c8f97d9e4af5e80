//! Bodies as their author writes them.

use crate::{Triple, is_default};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Which generalized coordinates describe a body.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Coordinates {
    /// One point and three unit vectors: 12 coordinates (r, u, v, w), six rigid-body rows.
    #[default]
    Full,
    /// One point and two unit vectors: 9 coordinates (r, u, v), w = u × v, three rigid-body rows.
    Reduced,
    /// As full, but each revolute joint between such bodies (or such a body and the ground) whose axis is a director
    /// of both lets them share it, whatever `rows` it names: the axis has no row, the director is written once.
    Shared,
}

/// A rigid body.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Body {
    /// Unique name.
    pub name: String,
    /// Mass, kg; positive.
    pub mass: f64,
    /// Inertia about the centre of mass; without it the body is a point mass.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub inertia: Option<Inertia>,
    /// Centre of mass in the body's frame, m.
    #[serde(default, skip_serializing_if = "is_default")]
    pub center_of_mass: Triple,
    /// Position of the body's reference point in the world, m.
    #[serde(default)]
    pub position: Triple,
    /// Orientation of the body's frame in the world.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub orientation: Option<Orientation>,
    /// Velocity of the reference point in the world frame, m/s.
    #[serde(default, skip_serializing_if = "is_default")]
    pub velocity: Triple,
    /// Angular velocity in the world frame, rad/s.
    #[serde(default, skip_serializing_if = "is_default")]
    pub angular_velocity: Triple,
    /// Coordinates of this body, if not those of the scene.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub coordinates: Option<Coordinates>,
    /// What to draw; no influence on the motion.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub shape: Vec<Shape>,
}

/// Inertia about the centre of mass along the axes of the body's frame, kg m².
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub enum Inertia {
    /// The body's frame lies along the principal axes: their three moments.
    Principal(Triple),
    /// The full symmetric tensor; the engine finds the principal axes.
    Tensor([Triple; 3]),
}

/// Orientation of a body's frame in the world.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Orientation {
    /// First director u (with `v`); made orthonormal if it is nearly so.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub u: Option<Triple>,
    /// Second director v (with `u`).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub v: Option<Triple>,
    /// Third director w, if it is stated: then it must be u × v.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub w: Option<Triple>,
    /// Unit quaternion, scalar first, body to world.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub quaternion: Option<[f64; 4]>,
    /// Axis of a rotation (with `angle`).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub axis: Option<Triple>,
    /// Angle of the rotation about `axis`, rad.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub angle: Option<f64>,
}

/// A primitive drawn in a body's frame, lengths in m.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", deny_unknown_fields, rename_all = "kebab-case")]
pub enum Shape {
    /// A round bar between two points.
    Rod {
        /// One end.
        from: Triple,
        /// The other end.
        to: Triple,
        /// Radius.
        radius: f64,
    },
    /// A ball.
    Sphere {
        /// Centre.
        center: Triple,
        /// Radius.
        radius: f64,
    },
    /// A box along the axes of the body's frame.
    Box {
        /// Centre.
        center: Triple,
        /// Full edge lengths.
        size: Triple,
    },
}
