//! Prescribed motions of a mechanism as their author writes them.

use crate::{Motion, Triple, VectorMotion};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// What moves as prescribed. Points and vectors of bodies are in the frame of their body, those of the ground in the
/// world.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "type", deny_unknown_fields, rename_all = "kebab-case")]
pub enum Driver {
    /// A point of a body follows a path in the world (TP).
    Point {
        /// Unique name.
        name: String,
        /// The body.
        body: String,
        /// The point in the body's frame, m.
        point: Triple,
        /// Its path in the world, m.
        motion: VectorMotion,
    },
    /// A unit vector of a body follows a unit vector of the world (OV).
    Vector {
        /// Unique name.
        name: String,
        /// The body.
        body: String,
        /// The vector in the body's frame; made a unit vector.
        vector: Triple,
        /// Its direction in the world: `fixed` or `turning` unit vectors.
        motion: VectorMotion,
    },
    /// The angle of a revolute or cylindrical joint, from its start, of either sign and any number of turns.
    Angle {
        /// Unique name.
        name: String,
        /// The joint.
        joint: String,
        /// Angle of body j relative to body i about the axis, from that at the start, rad.
        motion: Motion,
    },
    /// The displacement of a prismatic or cylindrical joint along its axis.
    Slide {
        /// Unique name.
        name: String,
        /// The joint.
        joint: String,
        /// Distance from the joint's point on body i to that on body j along the axis, m.
        motion: Motion,
    },
    /// The angle between two vectors through its cosine (AR). It cannot pass 0 or π: there its row vanishes.
    AngleCosine {
        /// Unique name.
        name: String,
        /// First body, or `ground`.
        body_i: String,
        /// Vector in the frame of body i; made a unit vector.
        vector_i: Triple,
        /// Second body, or `ground`.
        body_j: String,
        /// Vector in the frame of body j; made a unit vector.
        vector_j: Triple,
        /// The angle, rad.
        motion: Motion,
    },
    /// The angle between a vector of a body and a moving vector of the world through its cosine (AR*).
    AngleToWorld {
        /// Unique name.
        name: String,
        /// The body.
        body: String,
        /// Vector in the body's frame; made a unit vector.
        vector: Triple,
        /// Vector of the world.
        reference: VectorMotion,
        /// The angle, rad.
        motion: Motion,
    },
}

impl Driver {
    /// Its name.
    pub fn name(&self) -> &str {
        match self {
            Self::Point { name, .. }
            | Self::Vector { name, .. }
            | Self::Angle { name, .. }
            | Self::Slide { name, .. }
            | Self::AngleCosine { name, .. }
            | Self::AngleToWorld { name, .. } => name,
        }
    }
}
