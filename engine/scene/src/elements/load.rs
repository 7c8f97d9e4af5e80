//! Forces and moments as their author writes them.

use super::motion::{Motion, VectorMotion};
use crate::handle::{BodyHandle, JointHandle};
use crate::value::Triple;
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

/// Friction along one freedom of a joint: −(viscous ẋ + (coulomb + coefficient · radius · N) tanh(ẋ / smoothing)), where the
/// joint's own reaction presses with N.
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
    /// Coefficient of friction between the parts that the joint's reaction presses together.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub coefficient: f64,
    /// Radius of the pin, m: needed with a coefficient about an axis, unknown along one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub radius: Option<f64>,
    /// Distance of the two ends at which the parts touch, m, with the joint's point on body j (on body i where j is the ground)
    /// half-way: moments across the axis then press as well. Without it, forces across the axis alone.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub guide: Option<f64>,
}

impl Friction {
    /// Viscous (N s/m or N m s/rad) and Coulomb friction (N or N m), smoothed below 1 mm/s or 1 mrad/s.
    pub fn new(viscous: f64, coulomb: f64) -> Self {
        Self { viscous, coulomb, smoothing: default_smoothing(), coefficient: 0.0, radius: None, guide: None }
    }

    /// Dry friction that the reaction of its joint loads, with this coefficient; about an axis it needs a [`Friction::radius`]
    /// — eq. (6.11).
    ///
    /// ```
    /// use triad_scene::{Friction, Load};
    ///
    /// let bearing = Load::turning_friction("bearing", "pin", Friction::dry(0.1).radius(0.01).guide(0.04));
    /// assert_eq!(bearing.name(), "bearing");
    /// ```
    pub fn dry(coefficient: f64) -> Self {
        Self { coefficient, ..Self::new(0.0, 0.0) }
    }

    /// The radius of the pin, m.
    #[must_use]
    pub fn radius(self, radius: f64) -> Self {
        Self { radius: Some(radius), ..self }
    }

    /// The distance of the ends at which the parts touch, m.
    #[must_use]
    pub fn guide(self, guide: f64) -> Self {
        Self { guide: Some(guide), ..self }
    }
}

/// Left out of what is written, so that a scene without it keeps its fingerprint.
#[allow(clippy::trivially_copy_pass_by_ref, reason = "as serde calls it")]
fn is_zero(x: &f64) -> bool {
    *x == 0.0
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

/// Loads add up: a joint with a spring, a motor and friction has three of them.
impl Load {
    /// A force, N, at a point of a body (in its frame, m); it keeps its direction in the world, or turns with the body — eq. (6.7).
    ///
    /// ```
    /// use triad_scene::{Load, LoadFrame};
    ///
    /// let thrust = Load::force("thrust", "rocket", [0.0, 0.0, -1.0], [0.0, 0.0, 30.0], LoadFrame::Body);
    /// assert_eq!(thrust.name(), "thrust");
    /// ```
    pub fn force(
        name: impl Into<String>,
        body: impl Into<BodyHandle>,
        point: Triple,
        force: impl Into<VectorMotion>,
        frame: LoadFrame,
    ) -> Self {
        Self::Force { name: name.into(), body: body.into().into(), point, force: force.into(), frame }
    }

    /// A moment τ, N m, on a body — eq. (6.8).
    pub fn moment(
        name: impl Into<String>,
        body: impl Into<BodyHandle>,
        moment: impl Into<VectorMotion>,
        frame: LoadFrame,
    ) -> Self {
        Self::Moment { name: name.into(), body: body.into().into(), moment: moment.into(), frame }
    }

    /// A spring and a damper between a point of each of two bodies (in their frames, m), without force at the length of
    /// the start: stiffness k in N/m, damping d in N s/m — eq. (6.9).
    ///
    /// ```
    /// use triad_scene::{Ground, Load};
    ///
    /// let spring = Load::spring("s", (Ground, [0.0; 3]), ("mass", [0.0; 3]), 100.0, 0.5).free_length(0.2);
    /// assert!(matches!(spring, Load::Spring { free_length: Some(0.2), .. }));
    /// ```
    pub fn spring(
        name: impl Into<String>,
        (body_i, point_i): (impl Into<BodyHandle>, Triple),
        (body_j, point_j): (impl Into<BodyHandle>, Triple),
        stiffness: f64,
        damping: f64,
    ) -> Self {
        Self::Spring {
            name: name.into(),
            body_i: body_i.into().into(),
            point_i,
            body_j: body_j.into().into(),
            point_j,
            stiffness,
            free_length: None,
            damping,
            force: None,
        }
    }

    /// A spring and a damper about a revolute or cylindrical joint: k in N m/rad, d in N m s/rad — eq. (6.9).
    pub fn torsion(
        name: impl Into<String>,
        joint: impl Into<JointHandle>,
        stiffness: f64,
        damping: f64,
    ) -> Self {
        Self::about(name, joint, [stiffness, damping], None, None)
    }

    /// A spring and a damper along a prismatic or cylindrical joint: k in N/m, d in N s/m — eq. (6.9).
    pub fn slider(
        name: impl Into<String>,
        joint: impl Into<JointHandle>,
        stiffness: f64,
        damping: f64,
    ) -> Self {
        Self::along(name, joint, [stiffness, damping], None)
    }

    /// A motor about a revolute or cylindrical joint: its torque on body j, N m.
    ///
    /// ```
    /// use triad_scene::{Load, Motion};
    ///
    /// let motor = Load::motor("motor", "elbow", Motion::sine(2.0, 3.0));
    /// assert!(matches!(motor, Load::Torsion { torque: Some(_), .. }));
    /// ```
    pub fn motor(name: impl Into<String>, joint: impl Into<JointHandle>, torque: impl Into<Motion>) -> Self {
        Self::about(name, joint, [0.0; 2], Some(torque.into()), None)
    }

    /// Friction about a revolute or cylindrical joint — eq. (6.9).
    pub fn turning_friction(
        name: impl Into<String>,
        joint: impl Into<JointHandle>,
        friction: Friction,
    ) -> Self {
        Self::about(name, joint, [0.0; 2], None, Some(friction))
    }

    /// Friction along a prismatic or cylindrical joint — eq. (6.9).
    pub fn sliding_friction(
        name: impl Into<String>,
        joint: impl Into<JointHandle>,
        friction: Friction,
    ) -> Self {
        Self::along(name, joint, [0.0; 2], Some(friction))
    }

    /// A load about a joint, with stiffness and damping.
    fn about(
        name: impl Into<String>,
        joint: impl Into<JointHandle>,
        [stiffness, damping]: [f64; 2],
        torque: Option<Motion>,
        friction: Option<Friction>,
    ) -> Self {
        let (name, joint) = (name.into(), joint.into().into());
        Self::Torsion { name, joint, stiffness, free_angle: 0.0, damping, torque, friction }
    }

    /// A load along a joint, with stiffness and damping.
    fn along(
        name: impl Into<String>,
        joint: impl Into<JointHandle>,
        [stiffness, damping]: [f64; 2],
        friction: Option<Friction>,
    ) -> Self {
        let (name, joint) = (name.into(), joint.into().into());
        Self::Slider { name, joint, stiffness, free_length: 0.0, damping, force: None, friction }
    }

    /// The length of a spring or slider without force, m; other loads have none and stay as they are.
    #[must_use]
    pub fn free_length(mut self, length: f64) -> Self {
        match &mut self {
            Self::Spring { free_length, .. } => *free_length = Some(length),
            Self::Slider { free_length, .. } => *free_length = length,
            Self::Force { .. } | Self::Moment { .. } | Self::Torsion { .. } => {}
        }
        self
    }

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
