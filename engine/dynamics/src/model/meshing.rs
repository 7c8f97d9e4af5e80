//! Starts that gears pass on: where one of two coupled joints stands says where the other one does, however many turns that is, and
//! how fast one turns says how fast the other one does.

use super::error::GeometryFault;
use super::{JointGeometry, ModelError, ModelJoint, ModelStart};
use std::f64::consts::PI;

/// Relative difference up to which stated angles fit a gear: what rounding leaves of them.
const FITS: f64 = 1e-9;

/// θ₂ = ratio θ₁ + offset of joint `index`.
#[derive(Clone, Copy)]
struct Mesh {
    index: usize,
    joints: [usize; 2],
    ratio: f64,
    offset: f64,
}

/// Adds the angles and rates that gears give to joints without one, and tells of bodies that are turned away from where they are stated
/// though nothing is given.
///
/// # Errors
///
/// [`ModelError::Geometry`]: angles at the start of two joints, more than half a turn from what a gear says of them.
pub(super) fn pass_on(
    joints: &[ModelJoint],
    starts: &mut Vec<ModelStart>,
    notes: &mut Vec<String>,
) -> Result<(), ModelError> {
    let (meshes, of_joint) = meshes(joints);
    if meshes.is_empty() {
        return Ok(());
    }
    let mut angles: Vec<Option<f64>> = vec![None; joints.len()];
    for start in starts.iter() {
        angles[start.joint] = start.angle;
    }
    let mut reached: Vec<usize> = (0..joints.len()).filter(|&joint| angles[joint].is_some()).collect();
    let mut apart = meshes.iter().filter(|mesh| {
        let [first, second] = mesh.joints.map(|joint| joints[joint].stated);
        (mesh.angle_of_second(first) - second).abs() > FITS * second.abs().max(1.0)
    });
    loop {
        while let Some(joint) = reached.pop() {
            for mesh in &of_joint[joint] {
                reached.extend(mesh.pass(joints, &mut angles)?);
            }
        }
        // Where nothing is given the first joint stays where it is stated.
        let Some(mesh) = apart.find(|mesh| mesh.joints.iter().all(|&joint| angles[joint].is_none())) else {
            break;
        };
        notes.push(mesh.turned(joints));
        angles[mesh.joints[0]] = Some(joints[mesh.joints[0]].stated);
        reached.push(mesh.joints[0]);
    }
    let rates = rates(&of_joint, starts);
    for (joint, (angle, rate)) in angles.into_iter().zip(rates).enumerate() {
        match starts.iter_mut().find(|start| start.joint == joint) {
            Some(start) => (start.angle, start.rate) = (angle, rate),
            None if angle.is_none() && rate.is_none() => {}
            None => starts.push(ModelStart { angle, rate, ..ModelStart::of(joint) }),
        }
    }
    Ok(())
}

/// All gears, and those of each joint.
fn meshes(joints: &[ModelJoint]) -> (Vec<Mesh>, Vec<Vec<Mesh>>) {
    let meshes: Vec<Mesh> = joints
        .iter()
        .enumerate()
        .filter_map(|(index, joint)| {
            let JointGeometry::Gear { joints, ratio, offset } = joint.geometry else { return None };
            Some(Mesh { index, joints, ratio, offset })
        })
        .collect();
    let mut of_joint: Vec<Vec<Mesh>> = vec![Vec::new(); joints.len()];
    for mesh in &meshes {
        mesh.joints.iter().for_each(|&joint| of_joint[joint].push(*mesh));
    }
    (meshes, of_joint)
}

/// Adds the rates alone that gears give to joints without one.
pub(super) fn pass_rates_on(joints: &[ModelJoint], starts: &mut Vec<ModelStart>) {
    let (meshes, of_joint) = meshes(joints);
    if meshes.is_empty() {
        return;
    }
    for (joint, rate) in rates(&of_joint, starts).into_iter().enumerate() {
        match starts.iter_mut().find(|start| start.joint == joint) {
            Some(start) => start.rate = rate,
            None if rate.is_none() => {}
            None => starts.push(ModelStart { rate, ..ModelStart::of(joint) }),
        }
    }
}

/// The rates of all joints, where they are given or gears give them. Without them the velocities nearest to rest would be taken that keep
/// the gears, in which other joints turn as well.
fn rates(of_joint: &[Vec<Mesh>], starts: &[ModelStart]) -> Vec<Option<f64>> {
    let mut rates = vec![None; of_joint.len()];
    for start in starts {
        rates[start.joint] = start.rate;
    }
    let mut reached: Vec<usize> = (0..rates.len()).filter(|&joint| rates[joint].is_some()).collect();
    while let Some(joint) = reached.pop() {
        for mesh in &of_joint[joint] {
            let [first, second] = mesh.joints;
            match (rates[first], rates[second]) {
                (Some(leads), None) => {
                    rates[second] = Some(mesh.ratio * leads);
                    reached.push(second);
                }
                (None, Some(follows)) if mesh.ratio != 0.0 => {
                    rates[first] = Some(follows / mesh.ratio);
                    reached.push(first);
                }
                _ => {}
            }
        }
    }
    rates
}

impl Mesh {
    /// The angle of the second joint for one of the first.
    fn angle_of_second(&self, first: f64) -> f64 {
        self.ratio * first + self.offset
    }

    /// That the second joint is turned to where the first one, which stays as it is stated, says.
    fn turned(&self, joints: &[ModelJoint]) -> String {
        let [first, second] = self.joints.map(|joint| &joints[joint]);
        format!(
            "gear \"{}\": with \"{}\" at {} rad, where it is stated, \"{}\" starts at {} rad, not at the {} rad where its bodies are stated",
            joints[self.index].name,
            first.name,
            first.stated,
            second.name,
            self.angle_of_second(first.stated),
            second.stated
        )
    }

    /// Gives one of the two joints the angle that follows from that of the other. Returns it, if it had none.
    fn pass(&self, joints: &[ModelJoint], angles: &mut [Option<f64>]) -> Result<Option<usize>, ModelError> {
        let [first, second] = self.joints;
        match (angles[first], angles[second]) {
            (Some(leads), Some(follows)) => {
                let told = self.angle_of_second(leads);
                if (follows - told).abs() <= PI {
                    return Ok(None);
                }
                let names = [first, second].map(|joint| &joints[joint].name);
                Err(ModelError::Geometry {
                    element: format!("joint \"{}\"", joints[self.index].name),
                    pointer: format!("/joints/{}", self.index),
                    reason: format!(
                        "with \"{}\" at {leads} rad at the start \"{}\" is at {told} rad, but stands at {follows} rad: leave the \
                         start of one of them out, or give the gear an \"offset\"",
                        names[0], names[1]
                    ),
                    fault: GeometryFault::Other,
                })
            }
            (Some(leads), None) => {
                angles[second] = Some(self.angle_of_second(leads));
                Ok(Some(second))
            }
            (None, Some(follows)) if self.ratio != 0.0 => {
                angles[first] = Some((follows - self.offset) / self.ratio);
                Ok(Some(first))
            }
            (None, _) => Ok(None),
        }
    }
}
