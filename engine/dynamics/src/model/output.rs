//! Chosen outputs name what the scene has.

use super::error::{GeometryFault, NamedElement};
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
        let element = format!("output \"{output}\"");
        let pointer = format!("/simulation/outputs/{index}");
        let Some((what, known)) = named(scene, output.kind) else {
            let reason = format!("there is nothing that {} could be wanted of by name", output.kind);
            return Err(ModelError::Geometry { element, pointer, reason, fault: GeometryFault::Other });
        };
        if known.contains(&of.as_str()) {
            continue;
        }
        let nearest = nearest_name(of, known.into_iter());
        return Err(ModelError::UnknownName { element, pointer, what, name: of.clone(), nearest });
    }
    Ok(())
}

/// What an output can be wanted of, if it can, and the names of those.
fn named(scene: &Scene, kind: OutputKind) -> Option<(NamedElement, Vec<&str>)> {
    let joints = || scene.joints.iter().map(|joint| joint.name.as_str());
    let drivers = || scene.drivers.iter().map(crate::scene::Driver::name);
    Some(match kind {
        OutputKind::Bodies | OutputKind::Frames | OutputKind::Accelerations => {
            (NamedElement::Body, scene.bodies.iter().map(|body| body.name.as_str()).collect())
        }
        OutputKind::Reactions => (NamedElement::JointOrDriver, joints().chain(drivers()).collect()),
        OutputKind::Drivers => (NamedElement::Driver, drivers().collect()),
        OutputKind::Joints => (NamedElement::Joint, joints().collect()),
        OutputKind::Loads => (NamedElement::Load, scene.loads.iter().map(crate::scene::Load::name).collect()),
        OutputKind::Markers => {
            (NamedElement::Marker, scene.markers.iter().map(|marker| marker.name.as_str()).collect())
        }
        OutputKind::Energy | OutputKind::Balance | OutputKind::Violations | OutputKind::Errors => {
            return None;
        }
    })
}

/// Whether a joint's angle and slide are wanted.
pub fn wants_joint(outputs: &[Output], joint: &str) -> bool {
    let of_joints = outputs.iter().filter(|output| output.kind == OutputKind::Joints);
    of_joints.into_iter().any(|output| output.of.as_deref().is_none_or(|of| of == joint))
}
