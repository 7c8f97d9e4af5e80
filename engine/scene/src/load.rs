//! Forces and moments as their author writes them.

use crate::{Motion, Triple, VectorMotion};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The frame in which a force or a moment is given.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum LoadFrame {
    /// It keeps its direction in the world.
    #[default]
    World,
    /// It turns with the body.
    Body,
}

/// Friction along one freedom of a joint: −(viscous ẋ + coulomb tanh(ẋ / smoothing)).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Friction {
    /// Viscous coefficient, N s/m or N m s/rad.
    #[serde(default)]
    pub viscous: f64,
    /// Coulomb friction at full sliding, N or N m.
    #[serde(default)]
    pub coulomb: f64,
    /// Velocity at which Coulomb friction has reached three quarters, m/s or rad/s.
    #[serde(default = "default_smoothing")]
    pub smoothing: f64,
}

fn default_smoothing() -> f64 {
    1e-3
}

/// A force or moment besides gravity.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "type", deny_unknown_fields, rename_all = "kebab-case")]
pub enum Load {
    /// A force at a point of a body.
    Force {
        /// Unique name.
        name: String,
        /// The body.
        body: String,
        /// The point in the body's frame, m.
        #[serde(default)]
        point: Triple,
        /// The force, N.
        force: VectorMotion,
        /// Frame of the force.
        #[serde(default)]
        frame: LoadFrame,
    },
    /// A moment on a body.
    Moment {
        /// Unique name.
        name: String,
        /// The body.
        body: String,
        /// The moment, N m.
        moment: VectorMotion,
        /// Frame of the moment.
        #[serde(default)]
        frame: LoadFrame,
    },
    /// A spring, a damper and an actuator between two points: pulls them together with
    /// stiffness (l − free_length) + damping l̇ + force(t).
    Spring {
        /// Unique name.
        name: String,
        /// First body, or `ground`.
        body_i: String,
        /// Point in the frame of body i, m.
        point_i: Triple,
        /// Second body, or `ground`.
        body_j: String,
        /// Point in the frame of body j, m.
        point_j: Triple,
        /// Stiffness, N/m.
        #[serde(default)]
        stiffness: f64,
        /// Length without force, m; without it, the length at the start.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        free_length: Option<f64>,
        /// Damping, N s/m.
        #[serde(default)]
        damping: f64,
        /// Pull of the actuator, N.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        force: Option<Motion>,
    },
    /// A spring, a damper, a motor and friction about a revolute or cylindrical joint: on body j acts
    /// −stiffness (θ − free_angle) − damping θ̇ + torque(t) + friction about the axis, θ from the start.
    Torsion {
        /// Unique name.
        name: String,
        /// The joint.
        joint: String,
        /// Stiffness, N m/rad.
        #[serde(default)]
        stiffness: f64,
        /// Angle without moment, rad.
        #[serde(default)]
        free_angle: f64,
        /// Damping, N m s/rad.
        #[serde(default)]
        damping: f64,
        /// Torque of the motor, N m.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        torque: Option<Motion>,
        /// Friction.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        friction: Option<Friction>,
    },
    /// The same along a prismatic or cylindrical joint: on body j acts −stiffness (s − free_length) − damping ṡ +
    /// force(t) + friction along the axis, s from the joint's point on body i to that on body j.
    Slider {
        /// Unique name.
        name: String,
        /// The joint.
        joint: String,
        /// Stiffness, N/m.
        #[serde(default)]
        stiffness: f64,
        /// Displacement without force, m.
        #[serde(default)]
        free_length: f64,
        /// Damping, N s/m.
        #[serde(default)]
        damping: f64,
        /// Force of the actuator, N.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        force: Option<Motion>,
        /// Friction.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        friction: Option<Friction>,
    },
}

impl Load {
    /// Its name.
    pub fn name(&self) -> &str {
        match self {
            Self::Force { name, .. }
            | Self::Moment { name, .. }
            | Self::Spring { name, .. }
            | Self::Torsion { name, .. }
            | Self::Slider { name, .. } => name,
        }
    }
}
