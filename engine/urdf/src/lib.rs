//! Robots described in URDF, read as scenes.
//!
//! URDF describes a tree; loops are closed by a side-car: JSON with joints, drivers and loads in the words of a scene,
//! whose bodies are the robot's links. What a scene cannot express is reported with its line, never dropped in silence.

mod read;

mod convert;

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use triad_scene::{Driver, Joint, Load, Scene, Settings};

/// Bytes of a URDF.
pub const MAX_TEXT: usize = 4 << 20;
/// Links of a robot.
pub const MAX_LINKS: usize = 2_000;

/// What a URDF does not say.
#[derive(Debug, Clone, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
#[schemars(rename = "UrdfSupplement")]
pub struct SideCar {
    /// Whether the root link is the ground or moves freely.
    pub root: Root,
    /// Positions of joints at the start, by name: rad or m.
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

/// A scene made from a URDF, and what was left behind.
#[derive(Debug, Clone)]
pub struct Imported {
    /// The scene.
    pub scene: Scene,
    /// What could not be carried over, in the order of the file.
    pub left_out: Vec<LeftOut>,
}

/// Something that could not be carried over.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, JsonSchema)]
pub struct LeftOut {
    /// Its line in the URDF.
    pub line: u32,
    /// What it belongs to, such as `joint elbow`.
    pub of: String,
    /// What is missing, and what it means.
    pub what: String,
}

/// Why a URDF is no robot that can be simulated.
#[derive(Debug, thiserror::Error)]
pub enum UrdfError {
    /// More text than is read.
    #[error("the URDF has {bytes} bytes, more than {MAX_TEXT}")]
    TooLong {
        /// Its size.
        bytes: usize,
    },
    /// Not XML.
    #[error("line {line}: this is not XML: {cause}")]
    Xml {
        /// Where.
        line: u32,
        /// What the reader says.
        cause: String,
    },
    /// An element or attribute is missing, or says something that it cannot.
    #[error("line {line}: {what}")]
    Wrong {
        /// Where.
        line: u32,
        /// What.
        what: String,
        /// What to try.
        hint: &'static str,
    },
    /// The side-car names something that is not there.
    #[error("the side-car names {what} \"{name}\", which the URDF does not have")]
    Unknown {
        /// What kind of thing.
        what: &'static str,
        /// Its name.
        name: String,
        /// Names that there are.
        known: Vec<String>,
    },
}

/// Reads a URDF, with what a side-car adds.
///
/// # Errors
///
/// [`UrdfError`]: a text that is too long, no XML, or no robot, with the line and what to try.
///
/// ```
/// use triad_urdf::{SideCar, import};
///
/// let urdf = r#"
///     <robot name="arm">
///       <link name="base"/>
///       <link name="upper"><inertial>
///         <mass value="2"/><inertia ixx="0.1" iyy="0.1" izz="0.01" ixy="0" ixz="0" iyz="0"/>
///       </inertial></link>
///       <joint name="shoulder" type="continuous">
///         <parent link="base"/><child link="upper"/><origin xyz="0 0 0.5"/><axis xyz="0 1 0"/>
///       </joint>
///     </robot>"#;
/// let robot = import(urdf, &SideCar::default())?;
/// assert_eq!(robot.scene.bodies[0].position, [0.0, 0.0, 0.5]);
/// assert_eq!(robot.scene.joints[0].body_i, "ground");
/// assert!(robot.left_out.is_empty());
/// # Ok::<(), triad_urdf::UrdfError>(())
/// ```
pub fn import(text: &str, side_car: &SideCar) -> Result<Imported, UrdfError> {
    if text.len() > MAX_TEXT {
        return Err(UrdfError::TooLong { bytes: text.len() });
    }
    let mut left_out = Vec::new();
    let robot = read::robot(text, &mut left_out)?;
    let scene = convert::scene(&robot, side_car, &mut left_out)?;
    left_out.sort_by_key(|left| left.line);
    Ok(Imported { scene, left_out })
}
