//! A scene exactly as its author wrote it.
//!
//! Nothing here is checked beyond its type: that is the work of the engine's `Model`. Unknown keys are
//! refused, so that a misspelt key cannot silently mean its default. SI units, radians, right-handed axes.

mod body;
pub mod catalogue;
mod driver;
mod error;
mod event;
mod joint;
mod load;
mod motion;
mod parameter;
mod settings;
pub mod text;

pub use body::{Body, Coordinates, Inertia, Orientation, Shape};
pub use driver::Driver;
pub use error::SceneError;
pub use event::{Event, Passing, Quantity};
pub use joint::{AxisRows, Joint, JointKind};
pub use load::{Friction, Load, LoadFrame};
pub use motion::{Motion, VectorMotion};
pub use parameter::{MAX_PARAMETERS, OnChange, Parameter, Place, Places, WrittenScene};
pub use settings::{IntegratorKind, Settings, Skip, Stabilization};

use error::{plain_error, syntax_error};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Largest number of bodies that a scene may have.
pub const MAX_BODIES: usize = 5_000;
/// Largest number of joints, drivers or loads that a scene may have (each).
pub const MAX_JOINTS: usize = 20_000;
/// Largest number of events that a scene may look for.
pub const MAX_EVENTS: usize = 1_000;
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
    /// What moves as prescribed.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub drivers: Vec<Driver>,
    /// Forces and moments besides gravity.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub loads: Vec<Load>,
    /// Moments to look for.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub events: Vec<Event>,
    /// How to run the scene.
    #[serde(default, skip_serializing_if = "is_default")]
    pub simulation: Settings,
    /// Numbers of the scene that may be changed while it runs.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub parameters: Vec<Parameter>,
}

fn standard_gravity() -> Triple {
    [0.0, 0.0, -9.81]
}

fn is_default<T: Default + PartialEq>(value: &T) -> bool {
    *value == T::default()
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

    /// A number that tells scenes apart, to say which one a result belongs to: FNV-1a of its JSON, 64 bits in
    /// hexadecimal digits.
    pub fn fingerprint(&self) -> String {
        let hash = self.to_json().bytes().fold(0xcbf2_9ce4_8422_2325_u64, |hash, byte| {
            (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
        });
        format!("{hash:016x}")
    }

    fn check_sizes(&self) -> Result<(), SceneError> {
        let lists = [
            ("bodies", self.bodies.len(), MAX_BODIES),
            ("joints", self.joints.len(), MAX_JOINTS),
            ("drivers", self.drivers.len(), MAX_JOINTS),
            ("loads", self.loads.len(), MAX_JOINTS),
            ("events", self.events.len(), MAX_EVENTS),
            ("parameters", self.parameters.len(), MAX_PARAMETERS),
        ];
        match lists.into_iter().find(|(_, count, limit)| count > limit) {
            Some((what, count, limit)) => Err(SceneError::TooMany { what, count, limit }),
            None => Ok(()),
        }
    }
}

/// The JSON Schema of a scene, generated from the types that read it.
pub fn schema() -> serde_json::Value {
    schemars::schema_for!(Scene).into()
}
