//! A scene exactly as its author wrote it.
//!
//! Nothing here is checked beyond its type: that is the work of [`crate::model::Model`]. Unknown keys are
//! refused, so that a misspelt key cannot silently mean its default. SI units, radians, right-handed axes.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Largest number of bodies that a scene may have.
pub const MAX_BODIES: usize = 5_000;
/// Largest number of joints, drivers or loads that a scene may have (each).
pub const MAX_JOINTS: usize = 20_000;
/// Largest text of a scene, in bytes.
pub const MAX_TEXT: usize = 16 << 20;

/// Name of the fixed body that every scene has.
pub const GROUND: &str = "ground";

/// A vector of three numbers.
pub type Triple = [f64; 3];

/// A mechanism, its surroundings and how to run it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Scene {
    /// Short name in lower case, used in file names and addresses.
    pub name: String,
    /// Title for people.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub title: String,
    /// What the scene shows and where its data come from.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub description: String,
    /// Acceleration of gravity in the world frame, m/s².
    #[serde(default = "standard_gravity")]
    pub gravity: Triple,
    /// Coordinates of every body that does not choose for itself.
    #[serde(default, skip_serializing_if = "is_default")]
    pub coordinates: Coordinates,
    /// The moving bodies.
    pub bodies: Vec<Body>,
    /// The joints.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub joints: Vec<Joint>,
    /// How to run the scene.
    #[serde(default, skip_serializing_if = "is_default")]
    pub simulation: Settings,
}

fn standard_gravity() -> Triple {
    [0.0, 0.0, -9.81]
}

fn is_default<T: Default + PartialEq>(value: &T) -> bool {
    *value == T::default()
}

/// Which generalized coordinates describe a body.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Coordinates {
    /// One point and three unit vectors: 12 coordinates (r, u, v, w), six rigid-body rows.
    #[default]
    Full,
    /// One point and two unit vectors: 9 coordinates (r, u, v), w = u × v, three rigid-body rows.
    Reduced,
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

/// What a joint is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum JointKind {
    /// A common point.
    Spherical,
    /// A common point and a common axis.
    Revolute,
    /// A common point and two perpendicular axes, one in each body.
    Universal,
}

/// How the axis of a revolute joint is written.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum AxisRows {
    /// Two perpendicularity rows (CAR): no dependent row.
    #[default]
    #[serde(rename = "cp-2car")]
    TwoCar,
    /// One common vector (CV): three rows, of which one is dependent, as the formulation first writes it.
    #[serde(rename = "cp-cv")]
    Cv,
}

/// A joint between two bodies, or between a body and the ground.
///
/// Its points and axes are given in the world at the start (`point`, `axis`, `axes`) or in the frames of the two
/// bodies (`point_i`, `point_j`, `axis_i`, `axis_j`; for the ground this is the world).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Joint {
    /// Unique name.
    pub name: String,
    /// What it is.
    #[serde(rename = "type")]
    pub kind: JointKind,
    /// First body, or `ground`.
    pub body_i: String,
    /// Second body, or `ground`.
    pub body_j: String,
    /// Common point in the world at the start, m.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub point: Option<Triple>,
    /// Point in the frame of body i, m.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub point_i: Option<Triple>,
    /// Point in the frame of body j, m.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub point_j: Option<Triple>,
    /// Common axis in the world at the start.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub axis: Option<Triple>,
    /// Two axes in the world at the start: the first fixed in body i, the second in body j.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub axes: Option<[Triple; 2]>,
    /// Axis in the frame of body i.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub axis_i: Option<Triple>,
    /// Axis in the frame of body j.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub axis_j: Option<Triple>,
    /// Which rows hold the axis of a revolute joint.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rows: Option<AxisRows>,
}

/// How to run a scene.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Settings {
    /// End of the run, s.
    pub duration: f64,
    /// Interval of output, s.
    pub every: f64,
    /// Integrator.
    pub integrator: IntegratorKind,
    /// Relative and absolute tolerance of the step control.
    pub tolerance: f64,
    /// What keeps the constraints satisfied.
    pub stabilization: Stabilization,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            duration: 10.0,
            every: 0.01,
            integrator: IntegratorKind::default(),
            tolerance: 1e-9,
            stabilization: Stabilization::default(),
        }
    }
}

/// Integrators by name.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum IntegratorKind {
    /// Explicit Runge-Kutta of order 8 by Dormand and Prince, with dense output of order 7.
    #[default]
    Dop853,
}

/// What keeps the constraints satisfied during a run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", deny_unknown_fields, rename_all = "kebab-case")]
pub enum Stabilization {
    /// After each step the state is projected onto the position and velocity constraints.
    #[default]
    Projection,
    /// Baumgarte: γ is replaced by γ − 2α(Φ_q q̇ − ν) − β²Φ.
    Baumgarte {
        /// α, 1/s.
        alpha: f64,
        /// β, 1/s.
        beta: f64,
    },
}

/// Why a text is not a scene.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SceneError {
    /// The text is too long to be read.
    #[error("the scene's text has {bytes} bytes, more than the {MAX_TEXT} that are read")]
    TooLong {
        /// Its length.
        bytes: usize,
    },
    /// Not JSON, an unknown key, or a value of the wrong type.
    #[error("{path} (line {line}, column {column}): {reason}")]
    Syntax {
        /// Where, as a path of keys.
        path: String,
        /// The same place as a JSON pointer.
        pointer: String,
        /// Line, from 1.
        line: usize,
        /// Column, from 1.
        column: usize,
        /// What is wrong.
        reason: String,
    },
    /// More bodies, joints, drivers or loads than allowed.
    #[error("{what}: {count} are more than the {limit} that a scene may have")]
    TooMany {
        /// Which list.
        what: &'static str,
        /// How many there are.
        count: usize,
        /// How many there may be.
        limit: usize,
    },
}

impl Scene {
    /// Reads a scene from JSON.
    pub fn from_json(text: &str) -> Result<Self, SceneError> {
        if text.len() > MAX_TEXT {
            return Err(SceneError::TooLong { bytes: text.len() });
        }
        let mut reader = serde_json::Deserializer::from_str(text);
        let scene: Self = serde_path_to_error::deserialize(&mut reader).map_err(|e| syntax_error(&e))?;
        reader.end().map_err(|e| plain_error(&e, "/"))?;
        scene.check_sizes()?;
        Ok(scene)
    }

    /// The scene as JSON, indented.
    pub fn to_json(&self) -> String {
        serde_json::to_string_pretty(self).unwrap_or_default()
    }

    fn check_sizes(&self) -> Result<(), SceneError> {
        let lists = [("bodies", self.bodies.len(), MAX_BODIES), ("joints", self.joints.len(), MAX_JOINTS)];
        match lists.into_iter().find(|(_, count, limit)| count > limit) {
            Some((what, count, limit)) => Err(SceneError::TooMany { what, count, limit }),
            None => Ok(()),
        }
    }
}

fn syntax_error(error: &serde_path_to_error::Error<serde_json::Error>) -> SceneError {
    let path = error.path().to_string();
    let pointer: String = error
        .path()
        .iter()
        .map(|segment| match segment {
            serde_path_to_error::Segment::Seq { index } => format!("/{index}"),
            serde_path_to_error::Segment::Map { key } => format!("/{key}"),
            serde_path_to_error::Segment::Enum { variant } => format!("/{variant}"),
            serde_path_to_error::Segment::Unknown => String::new(),
        })
        .collect();
    match plain_error(error.inner(), &pointer) {
        SceneError::Syntax { pointer, line, column, reason, .. } => {
            let path = if path == "." { "scene".to_owned() } else { path };
            SceneError::Syntax { path, pointer, line, column, reason }
        }
        other => other,
    }
}

fn plain_error(error: &serde_json::Error, pointer: &str) -> SceneError {
    let text = error.to_string();
    let reason = text.rsplit_once(" at line ").map_or(text.clone(), |(reason, _)| reason.to_owned());
    SceneError::Syntax {
        path: "scene".to_owned(),
        pointer: pointer.to_owned(),
        line: error.line(),
        column: error.column(),
        reason,
    }
}

/// The JSON Schema of a scene, generated from the types that read it.
pub fn schema() -> serde_json::Value {
    schemars::schema_for!(Scene).into()
}
