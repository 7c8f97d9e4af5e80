//! `[question.diagram]`: a body cut free.

use schemars::JsonSchema;
use serde::Deserialize;

use crate::answers::diagram::{ArrowKind, Axis};

/// Bodies cut free, at one moment, seen along an axis.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DiagramFile {
    /// The scene; without it, scene.json.
    pub scene: Option<String>,
    /// The bodies that are cut free, each drawn by itself.
    pub bodies: Vec<String>,
    /// The moment that is shown, s.
    #[serde(default)]
    pub time: f64,
    /// The axis that points out of the picture. Seen along z, x points to the right and y up; along y, x to the right and
    /// z up; along x, y to the right and z up.
    #[serde(default = "out_of_the_page")]
    pub view: Axis,
    /// Points where nothing acts, to be chosen by mistake.
    #[serde(default)]
    pub points: Vec<EmptyPointFile>,
    /// Arrows that may be drawn or left out, of either sense: what a joint could transmit, but does not at this moment.
    #[serde(default)]
    pub allowed: Vec<AllowedArrowFile>,
}

fn out_of_the_page() -> Axis {
    Axis::Z
}

/// A point of a body where nothing acts.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct EmptyPointFile {
    /// Its name, unlike that of a joint.
    pub name: String,
    /// The body.
    pub body: String,
    /// Its place: lengths along u, v, w from the centre of mass, m.
    pub point: [f64; 3],
}

/// An arrow that counts neither way.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct AllowedArrowFile {
    /// Force or moment.
    pub kind: ArrowKind,
    /// The joint or driver.
    pub at: String,
    /// Along or about which axis.
    pub axis: Axis,
}
