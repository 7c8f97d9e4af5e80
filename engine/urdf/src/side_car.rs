//! What a URDF does not say: starts, loops, drivers, loads.

use std::collections::BTreeMap;
use std::fmt;

use schemars::JsonSchema;
use serde::Deserialize;
use serde::de::{Deserializer, Error, MapAccess, Visitor};
use triad_scene::{Driver, Joint, Load, Settings};

/// What a URDF does not say.
#[derive(Debug, Clone, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
#[schemars(rename = "UrdfSupplement")]
pub struct SideCar {
    /// Whether the root link is the ground or moves freely.
    pub root: Root,
    /// Positions of joints at the start, by name, from the robot's zero, from which drivers, springs, events and tables count as well:
    /// rad or m. One that follows another by `<mimic>` needs none.
    #[serde(deserialize_with = "each_once")]
    pub positions: BTreeMap<String, f64>,
    /// Velocities of joints at the start, by name: rad/s or m/s.
    #[serde(deserialize_with = "each_once")]
    pub velocities: BTreeMap<String, f64>,
    /// Acceleration of gravity, m/s².
    pub gravity: Option<[f64; 3]>,
    /// Joints that close loops; bodies are links, points and axes are given in their frames.
    pub joints: Vec<Joint>,
    /// What moves as prescribed.
    pub drivers: Vec<Driver>,
    /// Forces and moments.
    pub loads: Vec<Load>,
    /// How to run the scene.
    pub simulation: Settings,
}

/// Reads numbers of joints. A joint that stands there twice is refused like any key that does: of a map the last would count, and nobody
/// would be told.
fn each_once<'de, D: Deserializer<'de>>(from: D) -> Result<BTreeMap<String, f64>, D::Error> {
    struct Joints;

    impl<'de> Visitor<'de> for Joints {
        type Value = BTreeMap<String, f64>;

        fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
            f.write_str("a map")
        }

        fn visit_map<A: MapAccess<'de>>(self, mut written: A) -> Result<Self::Value, A::Error> {
            let mut numbers = BTreeMap::new();
            while let Some((joint, number)) = written.next_entry::<String, f64>()? {
                if numbers.contains_key(&joint) {
                    return Err(A::Error::custom(format_args!("duplicate field `{joint}`")));
                }
                numbers.insert(joint, number);
            }
            Ok(numbers)
        }
    }

    from.deserialize_map(Joints)
}

/// What the root link is.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
#[schemars(rename = "UrdfRoot")]
pub enum Root {
    /// Part of the ground.
    #[default]
    Ground,
    /// A body that is free to move.
    Free,
}
