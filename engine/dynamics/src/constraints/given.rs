//! What is given of joints for the start, and what an assembled start has of it.

use crate::model::{BodyRef, DriverKind, Model, ModelDriver, ModelJoint, driven_instead};
use crate::state::{self, BodyFrame, nearest};
use crate::system::System;
use nalgebra::{Matrix3, Vector3};

/// What is given of a joint and differs from the assembled start by more than this part of itself, or of the mechanism's measure, is
/// told: the rest is rounding of what was given.
const ROUNDED: f64 = 1e-6;
/// Rates up to which a start rests, rad/s, or lengths of the mechanism in a second.
const AT_REST: f64 = 1e-9;

/// The driver of a joint's angle, or of its displacement.
pub(super) fn driver_of(model: &Model, joint: usize, turning: bool) -> Option<&ModelDriver> {
    model.drivers.iter().find(|driver| match driver.kind {
        DriverKind::Angle { joint: driven, .. } => turning && driven == joint,
        DriverKind::Slide { joint: driven, .. } => !turning && driven == joint,
        DriverKind::Point { .. }
        | DriverKind::Vector { .. }
        | DriverKind::Cosine { .. }
        | DriverKind::CosineToWorld { .. } => false,
    })
}

/// Writes y = (q, q̇) as the start of the model's bodies: their places, or their velocities.
pub(super) fn take_over(model: &mut Model, system: &System, y: &[f64], velocities: bool) {
    let (q, q_dot) = y.split_at(system.coordinates);
    for (body, described) in model.bodies.iter_mut().zip(&system.bodies) {
        let at = described.layout.position(q);
        let frame = BodyFrame::new(&at, &described.layout.velocity(&at, q_dot));
        if velocities {
            (body.velocity, body.angular_velocity) = (frame.velocity.into(), frame.angular_velocity.into());
        } else {
            body.position = frame.position.into();
            body.directors = Matrix3::from_columns(&[frame.u, frame.v, frame.w].map(Vector3::from));
        }
    }
}

/// A point or a vector of a body at the start, in the world.
fn in_world(model: &Model, body: BodyRef, local: &Vector3<f64>, point: bool) -> Vector3<f64> {
    match body {
        BodyRef::Ground => *local,
        BodyRef::Moving(body) => {
            let body = &model.bodies[body];
            let turned = body.directors * local;
            if point { body.position + turned } else { turned }
        }
    }
}

/// Angle and displacement of a joint at the start.
pub(super) fn place(model: &Model, joint: &ModelJoint) -> [f64; 2] {
    let [i, j] = joint.bodies;
    let b = in_world(model, j, &joint.cross[1][0], false);
    let [x, y] = joint.cross[0].map(|a| in_world(model, i, &a, false).dot(&b));
    let [from, to] = [0, 1].map(|side| in_world(model, joint.bodies[side], &joint.points[side], true));
    [libm::atan2(y, x), in_world(model, i, &joint.axes[0], false).dot(&(to - from))]
}

/// The rates of a joint at the start, of its angle and of its displacement.
fn rates(model: &Model, joint: &ModelJoint) -> [f64; 2] {
    let axis = in_world(model, joint.bodies[0], &joint.axes[0], false);
    let points = [0, 1].map(|side| in_world(model, joint.bodies[side], &joint.points[side], true));
    let motions = [0, 1].map(|side| match joint.bodies[side] {
        BodyRef::Ground => [Vector3::zeros(); 2],
        BodyRef::Moving(index) => {
            let body = &model.bodies[index];
            let arm = points[side] - body.position;
            [body.velocity + body.angular_velocity.cross(&arm), body.angular_velocity]
        }
    });
    let [[from, first], [to, second]] = motions;
    let slide = axis.dot(&(to - from)) + first.cross(&axis).dot(&(points[1] - points[0]));
    [axis.dot(&(second - first)), slide]
}

/// What was given of joints for the start and the assembled one, y = (q, q̇), does not have, in sentences.
pub(super) fn lost(system: &System, y: &[f64]) -> Vec<String> {
    if system.model.starts.is_empty() {
        return Vec::new();
    }
    let mut model = system.model.clone();
    take_over(&mut model, system, y, false);
    take_over(&mut model, system, y, true);
    let (length, pace) = (system.length, state::fastest(system, y));
    let mut told = Vec::new();
    for start in &model.starts {
        let joint = &model.joints[start.joint];
        let ([angle, slide], [rate, speed]) = (place(&model, joint), rates(&model, joint));
        for (given, found, unit, measure, turning) in [
            (start.angle, angle, "rad", 1.0, true),
            (start.slide, slide, "m", length, false),
            (start.rate, rate, "rad/s", pace.max(AT_REST / ROUNDED), true),
            (start.speed, speed, "m/s", pace.max(AT_REST / ROUNDED) * length, false),
        ] {
            let Some(given) = given else { continue };
            let found = if unit == "rad" { nearest(found, given) } else { found };
            let off = (found - given).abs();
            if off <= ROUNDED * measure.max(given.abs()) || !off.is_finite() {
                continue;
            }
            let (name, found) = (&joint.name, up_to(found, off));
            told.push(match driver_of(&model, start.joint, turning) {
                Some(driver) => driven_instead(name, given, &driver.name, found, unit),
                None => format!(
                    "joint \"{name}\": {given} {unit} are given for the start, but all that is given together leaves {found} {unit}"
                ),
            });
        }
    }
    told
}

/// A number with the digits that tell it from another one that is so far off.
fn up_to(number: f64, off: f64) -> String {
    let (mut digits, mut shown) = (4, off);
    while shown < 1.0 && digits < 15 {
        (digits, shown) = (digits + 1, 10.0 * shown);
    }
    let text = format!("{number:.digits$}");
    let short = if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { &text };
    if short == "-0" { "0".to_owned() } else { short.to_owned() }
}
