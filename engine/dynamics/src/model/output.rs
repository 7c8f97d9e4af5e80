//! Chosen outputs name what the scene has.

use super::{ModelError, ModelJoint};
use crate::scene::{JointKind, Output, OutputKind, Scene};
use triad_scene::text::nearest_name;

/// Joints whose body j turns about the axis by an angle that is measured.
pub const WITH_ANGLE: [JointKind; 3] = [JointKind::Revolute, JointKind::Cylindrical, JointKind::Screw];
/// Joints whose body j moves along the axis by a distance that is measured.
pub const WITH_SLIDE: [JointKind; 3] = [JointKind::Prismatic, JointKind::Cylindrical, JointKind::Screw];

impl ModelJoint {
    /// Whether its angle is measured.
    pub fn has_angle(&self) -> bool {
        WITH_ANGLE.contains(&self.kind())
    }

    /// Whether its slide is measured.
    pub fn has_slide(&self) -> bool {
        WITH_SLIDE.contains(&self.kind())
    }
}

/// Checks that each output that is wanted of one element names one.
pub(super) fn check(scene: &Scene) -> Result<(), ModelError> {
    for (index, output) in scene.simulation.outputs.iter().enumerate() {
        let Some(of) = &output.of else { continue };
        let known = named(scene, output.kind);
        if known.contains(&of.as_str()) {
            continue;
        }
        let reason = if known.is_empty() {
            format!("there is nothing that {} could be wanted of by name", output.kind)
        } else {
            let guess = nearest_name(of, known.into_iter());
            let guess = guess.map_or_else(String::new, |name| format!("; did you mean \"{name}\"?"));
            format!("the scene has nothing called \"{of}\" there{guess}")
        };
        return Err(ModelError::Geometry {
            element: format!("output \"{output}\""),
            pointer: format!("/simulation/outputs/{index}"),
            reason,
        });
    }
    Ok(())
}

/// Names of what an output can be wanted of.
fn named(scene: &Scene, kind: OutputKind) -> Vec<&str> {
    let joints = || scene.joints.iter().map(|joint| joint.name.as_str());
    let drivers = || scene.drivers.iter().map(crate::scene::Driver::name);
    match kind {
        OutputKind::Bodies | OutputKind::Frames | OutputKind::Accelerations => {
            scene.bodies.iter().map(|body| body.name.as_str()).collect()
        }
        OutputKind::Reactions => joints().chain(drivers()).collect(),
        OutputKind::Drivers => drivers().collect(),
        OutputKind::Joints => joints().collect(),
        OutputKind::Loads => scene.loads.iter().map(crate::scene::Load::name).collect(),
        OutputKind::Markers => scene.markers.iter().map(|marker| marker.name.as_str()).collect(),
        OutputKind::Energy | OutputKind::Balance | OutputKind::Violations | OutputKind::Errors => Vec::new(),
    }
}

/// Whether a joint's angle and slide are wanted.
pub fn wants_joint(outputs: &[Output], joint: &str) -> bool {
    let of_joints = outputs.iter().filter(|output| output.kind == OutputKind::Joints);
    of_joints.into_iter().any(|output| output.of.as_deref().is_none_or(|of| of == joint))
}
