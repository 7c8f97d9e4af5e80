//! Robots described in URDF, read as scenes.
//!
//! URDF describes a tree; loops are closed by a side-car: JSON with joints, drivers and loads in the words of a scene,
//! whose bodies are the robot's links. What a scene cannot express is reported with its line, never dropped in silence.

mod omissions;

mod side_car;

mod read;

mod follow;

mod placed;

mod attached;

mod convert;

pub use omissions::{MAX_LINKS, MAX_TEXT, OmittedItem, UrdfError};
pub use side_car::{Root, SideCar};

use triad_scene::Scene;

/// A scene made from a URDF, and what was left behind.
#[derive(Debug, Clone)]
pub struct Imported {
    /// The scene.
    pub scene: Scene,
    /// What could not be carried over, in the order of the file.
    pub left_out: Vec<OmittedItem>,
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
    import_while(text, side_car, &|| true)
}

/// As [`import`], as long as it is wanted.
///
/// # Errors
///
/// As [`import`], and [`UrdfError::NoLongerWanted`].
pub fn import_while(
    text: &str,
    side_car: &SideCar,
    wanted: &dyn Fn() -> bool,
) -> Result<Imported, UrdfError> {
    if text.len() > MAX_TEXT {
        return Err(UrdfError::TooLong { bytes: text.len() });
    }
    let mut left_out = Vec::new();
    let robot = read::robot(text, &mut left_out, wanted)?;
    let scene = convert::scene(&robot, side_car, &mut left_out, wanted)?;
    left_out.sort_by_key(|item| item.line);
    Ok(Imported { scene, left_out })
}
