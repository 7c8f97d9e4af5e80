//! Prescribed motions of a mechanism as their author writes them.

use super::motion::{Motion, VectorMotion};
use crate::handle::{BodyHandle, JointHandle};
use crate::value::Triple;
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
    /// The angle of a revolute or cylindrical joint, of either sign and any number of turns.
    Angle {
        /// Unique name.
        name: String,
        /// The joint.
        joint: String,
        /// Angle of body j relative to body i about the axis, from where the joint's angle is zero, rad.
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
    /// The angle between a vector of a body and a moving vector of the world through its cosine (AR*). It cannot pass 0 or π.
    AngleToWorld {
        /// Unique name.
        name: String,
        /// The body.
        body: String,
        /// Vector in the body's frame; made a unit vector.
        vector: Triple,
        /// Vector of the world; one that is fixed or turns is made a unit vector.
        reference: VectorMotion,
        /// The angle, rad.
        motion: Motion,
    },
}

impl Driver {
    /// A point of a body (in its frame, m) follows a path in the world, m.
    pub fn point(
        name: impl Into<String>,
        body: impl Into<BodyHandle>,
        point: Triple,
        motion: impl Into<VectorMotion>,
    ) -> Self {
        Self::Point { name: name.into(), body: body.into().into(), point, motion: motion.into() }
    }

    /// A unit vector of a body follows a unit vector of the world.
    pub fn vector(
        name: impl Into<String>,
        body: impl Into<BodyHandle>,
        vector: Triple,
        motion: impl Into<VectorMotion>,
    ) -> Self {
        Self::Vector { name: name.into(), body: body.into().into(), vector, motion: motion.into() }
    }

    /// The angle φ of a revolute or cylindrical joint, rad, from its start.
    ///
    /// ```
    /// use triad_scene::{Driver, Motion};
    ///
    /// let motor = Driver::angle("motor", "pin", Motion::ramp(0.0, 3.0));
    /// assert_eq!(motor.name(), "motor");
    /// ```
    pub fn angle(name: impl Into<String>, joint: impl Into<JointHandle>, motion: impl Into<Motion>) -> Self {
        Self::Angle { name: name.into(), joint: joint.into().into(), motion: motion.into() }
    }

    /// The displacement s of a prismatic or cylindrical joint along its axis, m.
    pub fn slide(name: impl Into<String>, joint: impl Into<JointHandle>, motion: impl Into<Motion>) -> Self {
        Self::Slide { name: name.into(), joint: joint.into().into(), motion: motion.into() }
    }

    /// The angle between a vector of each of two bodies, rad, through its cosine: it cannot pass 0 or π.
    pub fn angle_cosine(
        name: impl Into<String>,
        (body_i, vector_i): (impl Into<BodyHandle>, Triple),
        (body_j, vector_j): (impl Into<BodyHandle>, Triple),
        motion: impl Into<Motion>,
    ) -> Self {
        Self::AngleCosine {
            name: name.into(),
            body_i: body_i.into().into(),
            vector_i,
            body_j: body_j.into().into(),
            vector_j,
            motion: motion.into(),
        }
    }

    /// The angle between a vector of a body and a moving vector of the world, rad, through its cosine: it cannot pass 0 or π.
    pub fn angle_to_world(
        name: impl Into<String>,
        body: impl Into<BodyHandle>,
        vector: Triple,
        reference: impl Into<VectorMotion>,
        motion: impl Into<Motion>,
    ) -> Self {
        Self::AngleToWorld {
            name: name.into(),
            body: body.into().into(),
            vector,
            reference: reference.into(),
            motion: motion.into(),
        }
    }

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
