//! Starts that are given by joints: loops are closed with the given angles, displacements and rates held.

use crate::constraints::mechanism::Mechanism;
use crate::constraints::rough;
use crate::model::motion::Curve;
use crate::model::{BodyRef, DriverKind, Model, ModelDriver, ModelJoint, ModelStart};
use crate::newton::{project_velocities, rules};
use crate::state::BodyFrame;
use nalgebra::{Matrix3, Vector3};

/// |Φ| relative to the mechanism's length up to which a start is closed.
const CLOSED: f64 = 1e-9;
/// A given rate that joints change by more than this part of itself is told.
const LARGE_PART: f64 = 0.1;

/// A checked model as a mechanism, and its start y = (q, q̇) as the author gives it by bodies and joints. Where joints give it,
/// loops are closed as far as that can be done with what is given held; what remains open is left to the assembly.
pub fn mechanism(model: Model) -> (Mechanism, Vec<f64>) {
    mechanism_if(model, &|| true)
}

/// As [`mechanism`], as long as that is wanted: otherwise somewhere on the way.
pub fn mechanism_if(mut model: Model, still: &dyn Fn() -> bool) -> (Mechanism, Vec<f64>) {
    if !model.starts.is_empty() {
        close_positions(&mut model, still);
        fit_velocities(&mut model);
        let lost = lost_rates(&model);
        model.notes.extend(lost);
    }
    Mechanism::from_model(model)
}

/// The bodies with their joints alone, and with drivers that hold what is given of a joint: (angle or displacement, rate).
fn held(model: &Model, of: impl Fn(&ModelStart, [f64; 2]) -> [Option<Curve>; 2]) -> Model {
    let mut held = model.clone();
    held.loads.clear();
    held.custom_loads.clear();
    held.events.clear();
    for start in &model.starts {
        let joint = start.joint;
        let is = |kind: &DriverKind, turning: bool| match kind {
            DriverKind::Angle { joint: driven, .. } => turning && *driven == joint,
            DriverKind::Slide { joint: driven, .. } => !turning && *driven == joint,
            DriverKind::Point { .. }
            | DriverKind::Vector { .. }
            | DriverKind::Cosine { .. }
            | DriverKind::CosineToWorld { .. } => false,
        };
        let [angle, slide] = of(start, place(model, &model.joints[joint]));
        let mut hold = |turning: bool, kind: DriverKind| {
            if !model.drivers.iter().any(|driver| is(&driver.kind, turning)) {
                held.drivers.push(ModelDriver { name: model.joints[joint].name.clone(), kind });
            }
        };
        if let Some(motion) = angle {
            hold(true, DriverKind::Angle { joint, motion });
        }
        if let Some(motion) = slide {
            hold(false, DriverKind::Slide { joint, motion });
        }
    }
    held
}

/// Moves the bodies onto the joints, with the given angles and displacements held.
fn close_positions(model: &mut Model, still: &dyn Fn() -> bool) {
    let constant = |value: Option<f64>| value.map(Curve::constant);
    let held = held(model, |start, _| [constant(start.angle), constant(start.slide)]);
    let (mut mechanism, mut y) = Mechanism::from_model(held);
    // A screw goes on from one turn to the next.
    mechanism.state.set_revolutions(mechanism.system.start_angles());
    mechanism.set_state(0.0, &y);
    let length = mechanism.system.length.max(1.0);
    if mechanism.state.position_violation(&mechanism.system) <= f64::EPSILON * length {
        return;
    }
    let (_, _, left) = rough::close(&mut mechanism, &mut y, still);
    // A comparison that is false for NaN as well.
    if left <= CLOSED * length {
        take_over(model, &mechanism, &y, false);
    }
}

/// Makes the velocities fit the joints, with the given rates held.
fn fit_velocities(model: &mut Model) {
    if model.starts.iter().all(|start| start.rate.is_none() && start.speed.is_none()) {
        return;
    }
    let moving = |at: f64, rate: Option<f64>| rate.map(|rate| Curve::Polynomial(vec![at, rate]));
    let held = held(model, |start, [angle, slide]| [moving(angle, start.rate), moving(slide, start.speed)]);
    let (mut mechanism, mut y) = Mechanism::from_model(held);
    mechanism.set_state(0.0, &y);
    mechanism.elimination.set_redundant(true);
    let length = mechanism.system.length;
    project_velocities(&mut mechanism.projectable(&mut y), &rules::ROUGH_VELOCITIES, length);
    if y.iter().all(|number| number.is_finite()) {
        take_over(model, &mechanism, &y, true);
    }
}

/// Writes y = (q, q̇) as the start of the model's bodies: their places, or their velocities.
fn take_over(model: &mut Model, mechanism: &Mechanism, y: &[f64], velocities: bool) {
    let system = &mechanism.system;
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
fn place(model: &Model, joint: &ModelJoint) -> [f64; 2] {
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

/// Rates that were asked for, and that the joints do not allow, in sentences.
fn lost_rates(model: &Model) -> Vec<String> {
    let mut told = Vec::new();
    for start in &model.starts {
        let joint = &model.joints[start.joint];
        let found = rates(model, joint);
        for ((given, found), unit) in [start.rate, start.speed].into_iter().zip(found).zip(["rad/s", "m/s"]) {
            let Some(given) = given else { continue };
            if (found - given).abs() > LARGE_PART * given.abs() {
                told.push(format!(
                    "joint \"{}\": of the {given} {unit} that are given for the start the joints leave {found:.6} {unit}",
                    joint.name
                ));
            }
        }
    }
    told
}
