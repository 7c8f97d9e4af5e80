//! Numbers of a scene that its author offers to be changed.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Largest number of parameters that a scene may have.
pub const MAX_PARAMETERS: usize = 100;

/// A number of the scene that the author offers to be changed while it runs.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Parameter {
    /// Unique name, used in addresses.
    pub name: String,
    /// Name for people.
    pub label: String,
    /// Where its number stands in the scene; several places if they change together.
    pub pointer: Places,
    /// Least value.
    pub low: f64,
    /// Greatest value.
    pub high: f64,
    /// Between two values of a slider.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub step: Option<f64>,
    /// Unit, for people.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub unit: Option<String>,
    /// What happens to a run whose value is changed.
    #[serde(default)]
    pub on_change: OnChange,
}

/// One place or several.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum Places {
    /// One place.
    One(Place),
    /// Several places that hold the same value, each times its factor.
    Several(Vec<Place>),
}

/// A place in the scene.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum Place {
    /// A JSON pointer like `/bodies/0/mass`.
    Plain(String),
    /// A number that is a multiple of the parameter.
    Scaled {
        /// A JSON pointer.
        pointer: String,
        /// The number there is the parameter times this factor.
        factor: f64,
    },
}

/// What happens to a run when a parameter changes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum OnChange {
    /// It starts over.
    #[default]
    Restart,
    /// It goes on from where it stands, its velocities made consistent.
    Continue,
}

impl Place {
    /// The JSON pointer.
    pub fn pointer(&self) -> &str {
        match self {
            Self::Plain(pointer) | Self::Scaled { pointer, .. } => pointer,
        }
    }

    /// The number there is the parameter times this factor.
    pub fn factor(&self) -> f64 {
        match self {
            Self::Plain(_) => 1.0,
            Self::Scaled { factor, .. } => *factor,
        }
    }
}

impl Parameter {
    /// All places where its number stands.
    pub fn places(&self) -> &[Place] {
        match &self.pointer {
            Places::One(place) => std::slice::from_ref(place),
            Places::Several(places) => places,
        }
    }
}
