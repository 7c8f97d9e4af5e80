//! What a URDF does not say: starts, loops, drivers, loads.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::Deserialize;
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
    pub positions: BTreeMap<String, f64>,
    /// Velocities of joints at the start, by name: rad/s or m/s.
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
