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
    let mut numbers = BTreeMap::new();
    for joint in &robot.joints {
        // Those who follow one another are as many as the file says: they are gone through one by one, each of them once.
        let mut row = vec![joint];
        let mut last = joint;
        while let Some(next) = leader(last, &joints).filter(|next| !numbers.contains_key(&next.name)) {
            if row.len() > robot.joints.len() {
                return Err(ring(last));
            }
            row.push(next);
            last = next;
        }
        for joint in row.into_iter().rev() {
            let number = number(joint, leader(joint, &joints), &numbers, given, of)?;
            numbers.insert(joint.name.clone(), number);
        }
    }
    Ok(numbers)
}

/// The joint that another one follows, if the robot has it.
fn leader<'a>(joint: &UrdfJoint, joints: &BTreeMap<&str, &'a UrdfJoint>) -> Option<&'a UrdfJoint> {
    joint.mimic.as_ref().and_then(|(leader, ..)| joints.get(leader.as_str()).copied())
}

fn ring(joint: &UrdfJoint) -> UrdfError {
    let by = joint.mimic.as_ref().map_or("", |(leader, ..)| leader.as_str());
    UrdfError::Wrong {
        line: joint.line,
        what: format!("joint {} follows itself by way of {by}", joint.name),
        hint: "one joint of the ring must follow no other",
    }
}

/// The number of a joint, of whose leader it is known.
fn number(
    joint: &UrdfJoint,
    leader: Option<&UrdfJoint>,
    known: &BTreeMap<String, f64>,
    given: &BTreeMap<String, f64>,
    of: StartOf,
) -> Result<f64, UrdfError> {
    let own = given.get(&joint.name).copied();
    let (Some((name, factor, offset)), Some(leader)) = (&joint.mimic, leader) else {
        return Ok(own.unwrap_or(0.0));
    };
    let leads = known.get(&leader.name).copied().unwrap_or(0.0);
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

#[cfg(test)]
mod tests {
    use std::fmt::Write;

    use super::*;
    use crate::{MAX_LINKS, SideCar, import, import_while};

    /// A row of links, each on the one before, whose joints follow the one that `leader` says.
    fn robot(links: usize, leader: impl Fn(usize) -> Option<usize>) -> String {
        let mut text = "<robot name=\"row\"><link name=\"0\"/>".to_owned();
        for k in 1..links {
            let inertia = "<inertia ixx=\"1\" iyy=\"1\" izz=\"1\" ixy=\"0\" ixz=\"0\" iyz=\"0\"/>";
            let before = k - 1;
            let follows = leader(k).map(|leader| format!("<mimic joint=\"j{leader}\"/>")).unwrap_or_default();
            write!(
                text,
                "<link name=\"{k}\"><inertial><mass value=\"1\"/>{inertia}</inertial></link>\n\
                 <joint name=\"j{k}\" type=\"continuous\"><parent link=\"{before}\"/><child link=\"{k}\"/>{follows}</joint>"
            )
            .expect("a text");
        }
        text + "</robot>"
    }

    #[test]
    fn as_many_as_there_are_follow_one_another() {
        let with = SideCar { velocities: [("j1".to_owned(), 0.5)].into(), ..SideCar::default() };
        let found = import(&robot(MAX_LINKS, |k| (k > 1).then(|| k - 1)), &with).expect("a robot");
        let spins: Vec<f64> = found.scene.bodies.iter().map(|body| body.angular_velocity[0]).collect();
        assert_eq!(spins.len(), MAX_LINKS - 1);
        assert!(spins.iter().zip(1..).all(|(spin, k)| *spin == 0.5 * f64::from(k)), "each adds its own");
    }

    #[test]
    fn joints_that_follow_each_other_in_a_ring_are_refused_with_the_line_of_one_of_them() {
        let error = import(&robot(5, |k| Some(if k == 3 { 2 } else { k + 1 })), &SideCar::default());
        let UrdfError::Wrong { line, what, .. } = error.expect_err("a ring") else { panic!("another error") };
        assert!((3..=4).contains(&line) && what.contains("follows itself by way of"), "{line}: {what}");
    }

    #[test]
    fn a_robot_is_read_on_as_long_as_somebody_waits() {
        let (text, asked) = (robot(200, |_| None), std::cell::Cell::new(0));
        let leaves_after = |most: usize| {
            asked.set(0);
            import_while(&text, &SideCar::default(), &|| {
                asked.set(asked.get() + 1);
                asked.get() <= most
            })
        };
        assert!(leaves_after(usize::MAX).is_ok());
        let all = asked.get();
        // While it is read, and while it is made.
        for most in [0, 1, 150, all - 1] {
            assert!(matches!(leaves_after(most), Err(UrdfError::NoLongerWanted)), "{most} of {all}");
            assert_eq!(asked.get(), most + 1);
        }
        assert!(all >= 3 * 200, "{all}");
    }

    #[test]
    fn what_is_left_out_has_its_line_however_much_it_is() {
        let many = 90_000;
        let text = format!("<robot name=\"r\"><link name=\"l\"/>{}</robot>", "\n<x/>".repeat(many));
        let found = import(&text, &SideCar::default()).expect("a robot");
        assert!(found.left_out.iter().map(|item| item.line as usize).eq(2..many + 2));
    }
}
