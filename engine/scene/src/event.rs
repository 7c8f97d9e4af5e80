//! Moments to look for, as their author writes them.

use crate::Triple;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A moment at which a number of the mechanism passes a value. A run tells when, as exactly as it knows the motion.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Event {
    /// Unique name.
    pub name: String,
    /// The number.
    pub of: Quantity,
    /// The value that it passes, m or rad.
    pub value: f64,
    /// In which direction.
    #[serde(default)]
    pub passing: Passing,
    /// Whether the run ends there.
    #[serde(default)]
    pub stop: bool,
}

/// In which direction a number passes a value.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Passing {
    /// In either.
    #[default]
    Either,
    /// From below.
    Upwards,
    /// From above.
    Downwards,
}

/// A number that changes with the motion.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "type", deny_unknown_fields, rename_all = "kebab-case")]
pub enum Quantity {
    /// The coordinate of a point of a body along a direction of the world, m.
    Coordinate {
        /// The body.
        body: String,
        /// The point in the body's frame, m.
        #[serde(default)]
        point: Triple,
        /// The direction; made a unit vector.
        direction: Triple,
    },
    /// The distance of two points, m.
    Distance {
        /// First body, or `ground`.
        body_i: String,
        /// Point in the frame of body i, m.
        #[serde(default)]
        point_i: Triple,
        /// Second body, or `ground`.
        body_j: String,
        /// Point in the frame of body j, m.
        #[serde(default)]
        point_j: Triple,
    },
    /// The angle of a revolute, cylindrical or screw joint from its start, whole turns included, rad.
    Angle {
        /// The joint.
        joint: String,
    },
    /// The displacement of a prismatic, cylindrical or screw joint along its axis, m.
    Slide {
        /// The joint.
        joint: String,
    },
}
