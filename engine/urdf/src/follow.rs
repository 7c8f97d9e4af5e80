//! Joints at the start: as the side-car says, and those that follow others as `<mimic>` says.

use std::collections::BTreeMap;

use crate::omissions::UrdfError;
use crate::read::{Robot, UrdfJoint};

/// Relative difference up to which a follower's number of the side-car agrees with that of its leader: data are often
/// printed with six digits.
const AGREES: f64 = 1e-6;

/// Positions or velocities of joints.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum StartOf {
    /// Angles and displacements, which have an offset from their leader's.
    Positions,
    /// Their rates, which have none.
    Velocities,
}

/// The numbers of all joints that have one other than zero, by name. What the side-car says of a follower must agree with
/// its leader.
pub(super) fn starts(
    robot: &Robot,
    given: &BTreeMap<String, f64>,
    of: StartOf,
) -> Result<BTreeMap<String, f64>, UrdfError> {
    let joints: BTreeMap<&str, &UrdfJoint> =
        robot.joints.iter().map(|joint| (joint.name.as_str(), joint)).collect();
    let mut numbers = given.clone();
    for joint in &robot.joints {
        let number = number_of(joint, &joints, given, of, robot.joints.len())?;
        numbers.insert(joint.name.clone(), number);
    }
    Ok(numbers)
}

/// The number of a joint; `most` is how many leaders it may have one behind the other.
fn number_of(
    joint: &UrdfJoint,
    joints: &BTreeMap<&str, &UrdfJoint>,
    given: &BTreeMap<String, f64>,
    of: StartOf,
    most: usize,
) -> Result<f64, UrdfError> {
    let own = given.get(&joint.name).copied();
    let followed = joint.mimic.as_ref().and_then(|(leader, ..)| joints.get(leader.as_str()));
    let (Some((name, factor, offset)), Some(leader)) = (&joint.mimic, followed) else {
        return Ok(own.unwrap_or(0.0));
    };
    if most == 0 {
        let what = format!("joint {} follows itself by way of {name}", joint.name);
        let hint = "one joint of the ring must follow no other";
        return Err(UrdfError::Wrong { line: joint.line, what, hint });
    }
    let leads = number_of(leader, joints, given, of, most - 1)?;
    let (offset, word) = match of {
        StartOf::Positions => (*offset, "position"),
        StartOf::Velocities => (0.0, "velocity"),
    };
    let number = factor * leads + offset;
    match own {
        Some(own) if (own - number).abs() > AGREES * own.abs().max(number.abs()).max(1.0) => {
            let what = format!(
                "joint {} has the {word} {own} in the side-car, but as it follows {name} it has {factor} · {leads} + {offset} = {number}",
                joint.name
            );
            let hint = "leave it out of the side-car: it follows from that of its leader";
            Err(UrdfError::Wrong { line: joint.line, what, hint })
        }
        _ => Ok(number),
    }
}
