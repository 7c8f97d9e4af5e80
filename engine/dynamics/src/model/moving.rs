//! Velocities of bodies that hang on joints whose drivers start at speed, where all other joints rest.
//!
//! Without them the least change of all velocities would be taken that gives the driven joints their rates, in which others turn as well.

use super::placement::{tree, walk};
use super::{BodyRef, DriverKind, JointGeometry, Model, ModelBody, ModelJoint, ModelStart, meshing};
use nalgebra::Vector3;

/// Part of a rate within which the driver of a joint only repeats what is given of it.
const SAME: f64 = 1e-12;

/// How a body moves.
#[derive(Clone, Copy)]
struct Moving {
    center: Vector3<f64>,
    /// Velocity of the centre of mass, and angular velocity.
    motion: [Vector3<f64>; 2],
    /// Whether given rates say so, whatever is stated for the body.
    given: bool,
    /// Whether drivers say so where nothing is stated.
    driven: bool,
}

impl Model {
    /// Lets the bodies move as drivers of joints and given rates say, all other joints at rest, where they stand now. Returns whether a
    /// driver says more than is given: otherwise nothing changes.
    pub(crate) fn follow_drivers(&mut self) -> bool {
        let (mut starts, mut more) = (self.starts.clone(), false);
        for driver in &self.drivers {
            let (joint, motion, turning) = match &driver.kind {
                DriverKind::Angle { joint, motion } => (*joint, motion, true),
                DriverKind::Slide { joint, motion } => (*joint, motion, false),
                DriverKind::Point { .. }
                | DriverKind::Vector { .. }
                | DriverKind::Cosine { .. }
                | DriverKind::CosineToWorld { .. } => continue,
            };
            // A screw turns as far as it slides.
            let (turning, per_rate) = match self.joints[joint].geometry {
                JointGeometry::Screw { pitch } if !turning && pitch != 0.0 => (true, 1.0 / pitch),
                _ => (turning, 1.0),
            };
            let rate = per_rate * motion.at(0.0)[1];
            let at = starts.iter().position(|start| start.joint == joint).unwrap_or_else(|| {
                starts.push(ModelStart::of(joint));
                starts.len() - 1
            });
            let known = if turning { &mut starts[at].rate } else { &mut starts[at].speed };
            more |= (rate - known.unwrap_or(0.0)).abs() > SAME * rate.abs();
            *known = Some(rate);
        }
        if more {
            meshing::pass_rates_on(&self.joints, &mut starts);
            self.move_bodies(&starts);
        }
        more
    }

    fn move_bodies(&mut self, starts: &[ModelStart]) {
        let (bodies, joints) = (&self.bodies, &self.joints);
        let moves = |starts: &[ModelStart], joint: usize| {
            let start = starts.iter().find(|start| start.joint == joint);
            start.is_some_and(|start| start.rate.is_some() || start.speed.is_some())
        };
        let rest = |center, motion| Moving { center, motion, given: false, driven: false };
        let ground = rest(Vector3::zeros(), [Vector3::zeros(); 2]);
        let tree = tree(bodies.len(), joints, starts);
        let moving = walk(bodies.len(), joints, &tree, ground, |from, child| {
            let body = &bodies[child];
            let stated = rest(body.position, [body.velocity, body.angular_velocity]);
            let Some((index, side, parent)) = from else { return stated };
            let start = starts.iter().find(|start| start.joint == index);
            let moved = Moving {
                center: body.position,
                motion: carried(bodies, &joints[index], start, (side, parent), body),
                given: parent.given || moves(&self.starts, index),
                driven: parent.driven || moves(starts, index),
            };
            let says_nothing = stated.motion.iter().all(|rate| rate.norm() == 0.0);
            if moved.given || (moved.driven && says_nothing) { moved } else { stated }
        });
        for (body, moving) in self.bodies.iter_mut().zip(moving) {
            [body.velocity, body.angular_velocity] = moving.motion;
        }
    }
}

/// The motion of a body on a joint whose body `side`, its parent, moves.
fn carried(
    bodies: &[ModelBody],
    joint: &ModelJoint,
    start: Option<&ModelStart>,
    (side, parent): (usize, Moving),
    body: &ModelBody,
) -> [Vector3<f64>; 2] {
    let [velocity, spin] = parent.motion;
    let along = [velocity + spin.cross(&(body.position - parent.center)), spin];
    let Some(start) = start else { return along };
    let rate = start.rate.unwrap_or(0.0);
    let speed = match joint.geometry {
        JointGeometry::Screw { pitch } => rate * pitch,
        _ => start.speed.unwrap_or(0.0),
    };
    // Body j moves by +, body i by −.
    let sign = if side == 0 { 1.0 } else { -1.0 };
    let (axis, pivot) = match joint.bodies[side] {
        BodyRef::Ground => (joint.axes[side], joint.points[side]),
        BodyRef::Moving(index) => {
            let carrier = &bodies[index];
            (carrier.directors * joint.axes[side], carrier.position + carrier.directors * joint.points[side])
        }
    };
    let turning = axis * (sign * rate);
    let moving = axis * (sign * speed) + turning.cross(&(body.position - pivot));
    [along[0] + moving, along[1] + turning]
}
