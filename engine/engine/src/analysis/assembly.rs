//! Assembly: consistent positions and velocities from a rough start.

use super::{AnalysisError, Wanted};
use crate::error::EngineError;
use crate::scene::{Body, Joint, Scene};
use nalgebra::{Matrix3, Rotation3, UnitQuaternion, Vector3};
use schemars::JsonSchema;
use serde::Serialize;
use triad_dynamics::constraints::mechanism::Mechanism;
use triad_dynamics::constraints::{ConstraintError, quoted};
use triad_dynamics::constraints::{rough, start, violation};
use triad_dynamics::model::{BodyRef, JointGeometry, Model, ModelJoint};
use triad_dynamics::newton::{project_velocities, rules};
use triad_dynamics::system::System;

/// How much heavier a body is made that is to keep its velocity.
const HEAVY: f64 = 1e8;
/// Angle, rad, by which a joint that counts from elsewhere is told: less are the digits of a stated position.
const COUNTED_ELSEWHERE: f64 = 1e-6;

/// A body's place after assembly, in the terms in which its author writes it.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct Placement {
    /// The body.
    pub body: String,
    /// Position of its reference point, m.
    pub position: [f64; 3],
    /// Orientation of its frame, unit quaternion with the scalar first.
    pub quaternion: [f64; 4],
    /// Velocity of its reference point, m/s.
    pub velocity: [f64; 3],
    /// Angular velocity in the world, rad/s.
    pub angular_velocity: [f64; 3],
    /// How far its centre of mass was moved, m.
    pub moved: f64,
    /// How far it was turned, rad.
    pub turned: f64,
}

/// What assembly did.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct Assembly {
    /// The bodies, in the scene's order.
    pub bodies: Vec<Placement>,
    /// Newton steps.
    pub iterations: usize,
    /// Largest violation of positions at the given start, m.
    #[serde(rename = "opening")]
    pub violation: f64,
    /// Largest violation that is left, m.
    pub left: f64,
    /// What has to be known of the result.
    pub notes: Vec<String>,
}

/// Closes all joints with the least mass-weighted motion, however rough the start, and then makes the velocities fit.
/// Bodies named in `pinned` stay where they are, and keep their velocities as far as the joints allow.
///
/// # Errors
///
/// [`AnalysisError`]: a scene that cannot be, joints that cannot be closed, or a body that cannot be kept in place.
pub fn assemble(scene: &Scene, pinned: &[String]) -> Result<Assembly, AnalysisError> {
    assemble_while(scene, pinned, &Wanted::default())
}

/// As [`assemble`], as long as it is wanted.
///
/// # Errors
///
/// As [`assemble`], and [`AnalysisError::NoLongerWanted`].
pub fn assemble_while(scene: &Scene, pinned: &[String], wanted: &Wanted) -> Result<Assembly, AnalysisError> {
    let mut model = Model::new(scene).map_err(EngineError::from)?;
    for (index, name) in pinned.iter().enumerate() {
        let Some(place) = model.bodies.iter().position(|body| body.name == *name) else {
            return Err(AnalysisError::Pinned {
                body: name.clone(),
                reason: "there is no such body".to_owned(),
            });
        };
        let pin = pin(format!("keep {name} ({index})"), place, &model);
        model.joints.push(pin);
    }
    let (mut mechanism, mut y) = start::mechanism(model);
    mechanism.set_state(0.0, &y);
    let (violation, iterations, left) = rough::close(&mut mechanism, &mut y, &|| wanted.is_still());
    wanted.check()?;
    if !violation::is_closed(&mechanism.system, &mechanism.state) {
        let open = violation::measure(&mechanism.system, &mechanism.state);
        let violation = open.relative;
        if let Some(body) = pinned.first() {
            let reason = format!("then the joints stay open by {violation:.3e}");
            return Err(AnalysisError::Pinned { body: body.clone(), reason });
        }
        let (joint, with) = open.names(&mechanism.system);
        let pointer = open.pointer(&mechanism.system);
        let moved = placements(&mechanism, &y).iter().fold(0.0f64, |a, p| a.max(p.moved));
        return Err(
            EngineError::from(ConstraintError::Assembly { joint, with, pointer, violation, moved }).into()
        );
    }
    mechanism.set_state(0.0, &y);
    let notes = lengths_from_positions(scene).into_iter().chain(counted_angles(&mechanism)).collect();
    Ok(Assembly { bodies: velocities(scene, pinned, y)?, iterations, violation, left, notes })
}

/// Tells the joints whose points are given in the world, of bodies with two or more of them: between these nothing is ever open,
/// and the distance is what the stated positions make it.
fn lengths_from_positions(scene: &Scene) -> Option<String> {
    let stated = |joint: &&Joint| joint.point.is_some() || joint.points.is_some();
    let joints: Vec<&Joint> = scene.joints.iter().filter(stated).collect();
    let meets = |joint: &Joint, body: &Body| joint.body_i == body.name || joint.body_j == body.name;
    let links: Vec<&Body> = scene
        .bodies
        .iter()
        .filter(|body| joints.iter().filter(|joint| meets(joint, body)).count() > 1)
        .collect();
    let names: Vec<String> = joints
        .iter()
        .filter(|joint| links.iter().any(|link| meets(joint, link)))
        .map(|joint| joint.name.clone())
        .collect();
    (!names.is_empty()).then(|| {
        format!(
            "the points of {} are given in the world: links between them are as long as the stated positions make them, and \
             rounded positions make wrong lengths; only point_i and point_j keep lengths",
            quoted(&names)
        )
    })
}

/// Tells the joints whose angles are counted by loads, gears, events or tables, and would be counted from elsewhere in a scene with the
/// assembled positions.
fn counted_angles(Mechanism { system, state, .. }: &Mechanism) -> Vec<String> {
    let joints = &system.model.joints;
    let counted = system.angle_joints.iter().zip(state.angles()).filter_map(|(name, angle)| {
        let joint = joints.iter().find(|joint| joint.name == *name)?;
        let revolute = matches!(joint.geometry, JointGeometry::Revolute { .. });
        ((angle.value - joint.stated).abs() > COUNTED_ELSEWHERE && revolute).then_some((name, angle.value))
    });
    let told = |(name, angle): (&String, f64)| {
        format!(
            "the angle of joint \"{name}\" is {angle} rad here: with these positions give it \"stated_angle\": {angle} and no angle in its \
             \"start\", or loads, gears and events count from elsewhere"
        )
    };
    counted.map(told).collect()
}

/// A joint that fixes a body to the ground where it starts.
fn pin(name: String, place: usize, model: &Model) -> ModelJoint {
    let body = &model.bodies[place];
    let [x, y, z] = [Vector3::x(), Vector3::y(), Vector3::z()];
    let on_body = |v: &Vector3<f64>| body.directors.tr_mul(v);
    ModelJoint {
        name,
        geometry: JointGeometry::Fixed,
        bodies: [BodyRef::Ground, BodyRef::Moving(place)],
        points: [body.position, Vector3::zeros()],
        axes: [z, on_body(&z)],
        cross: [[x, y], [on_body(&x), on_body(&y)]],
        stated: 0.0,
    }
}

/// Makes the velocities of consistent positions fit; pinned bodies weigh so much that they hardly yield.
fn velocities(scene: &Scene, pinned: &[String], mut y: Vec<f64>) -> Result<Vec<Placement>, AnalysisError> {
    let mut model = Model::new(scene).map_err(EngineError::from)?;
    for body in model.bodies.iter_mut().filter(|body| pinned.contains(&body.name)) {
        body.principal = body.principal.map(|i| (i + 1e-3 * body.mass) * HEAVY);
        body.mass *= HEAVY;
    }
    let mut mechanism = Mechanism::new(System::new(model));
    mechanism.set_state(0.0, &y);
    mechanism.elimination.set_redundant(true);
    let length = mechanism.system.length;
    project_velocities(&mut mechanism.projectable(&mut y), &rules::ROUGH_VELOCITIES, length);
    Ok(placements(&mechanism, &y))
}

fn placements(mechanism: &Mechanism, y: &[f64]) -> Vec<Placement> {
    let system = &mechanism.system;
    let (q, q_dot) = y.split_at(system.coordinates);
    let list = system.bodies.iter().zip(&system.model.bodies).map(|(body, model)| {
        let at = body.layout.position(q);
        let rate = body.layout.velocity(&at, q_dot);
        let directors = Matrix3::from_columns(&at.e);
        let omega: Vector3<f64> = (0..3).map(|k| at.e[k].cross(&rate.e[k])).sum::<Vector3<f64>>() * 0.5;
        let frame = directors * model.principal_axes.transpose();
        let arm = frame * model.center_of_mass;
        let rotation = |m: Matrix3<f64>| Rotation3::from_matrix_unchecked(m);
        let quaternion = UnitQuaternion::from_rotation_matrix(&rotation(frame));
        // By its sine as well: the arc cosine of a trace that rounding lets pass three is no number.
        let turned =
            UnitQuaternion::from_rotation_matrix(&rotation(directors * model.directors.transpose())).angle();
        Placement {
            body: model.name.clone(),
            position: (at.r - arm).into(),
            quaternion: [quaternion.w, quaternion.i, quaternion.j, quaternion.k],
            velocity: (rate.r - omega.cross(&arm)).into(),
            angular_velocity: omega.into(),
            moved: (at.r - model.position).norm(),
            turned,
        }
    });
    list.collect()
}
