//! Assembly: consistent positions and velocities from a rough start.

use super::AnalysisError;
use crate::error::EngineError;
use crate::scene::{Ground, Joint, Scene};
use nalgebra::{Matrix3, Rotation3, UnitQuaternion, Vector3};
use schemars::JsonSchema;
use serde::Serialize;
use triad_dynamics::constraints::ConstraintError;
use triad_dynamics::constraints::mechanism::Mechanism;
use triad_dynamics::dynamics::elimination::ProjectableState;
use triad_dynamics::model::Model;
use triad_dynamics::newton::{Projectable, project_positions, project_velocities, rules};
use triad_dynamics::system::System;

/// How much heavier a body is made that is to keep its velocity.
const HEAVY: f64 = 1e8;
/// Longest step of Newton's method, m or, of directors, without a unit: a rotation that is cut short stays near a rotation only
/// if the step is short.
const MAX_STEP: f64 = 0.3;

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
}

/// Closes all joints with the least mass-weighted motion, however rough the start, and then makes the velocities fit.
/// Bodies named in `pinned` stay where they are, and keep their velocities as far as the joints allow.
///
/// # Errors
///
/// [`AnalysisError`]: a scene that cannot be, joints that cannot be closed, or a body that cannot be kept in place.
pub fn assemble(scene: &Scene, pinned: &[String]) -> Result<Assembly, AnalysisError> {
    let mut held = scene.clone();
    for (index, name) in pinned.iter().enumerate() {
        let Some(body) = scene.bodies.iter().find(|body| body.name == *name) else {
            return Err(AnalysisError::Pinned {
                body: name.clone(),
                reason: "there is no such body".to_owned(),
            });
        };
        let mut pin = Joint::fixed(format!("keep {name} ({index})"), Ground, name);
        (pin.point, pin.axis) = (Some(body.position), Some([0.0, 0.0, 1.0]));
        held.joints.push(pin);
    }
    let (mut mechanism, mut y) = Mechanism::from_model(Model::new(&held).map_err(EngineError::from)?);
    mechanism.set_state(0.0, &y);
    let (violation, iterations, left) = close(&mut mechanism, &mut y);
    // A comparison that is false for NaN as well.
    let closed = left <= 1e-9 * mechanism.system.length.max(1.0);
    if !closed {
        let open = triad_dynamics::constraints::violation::measure(&mechanism.system, &mechanism.state);
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
    Ok(Assembly { bodies: velocities(scene, pinned, y)?, iterations, violation, left })
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

/// A rough start, which is moved onto the constraints by steps no longer than [`MAX_STEP`].
struct Damped<'a> {
    on: ProjectableState<'a>,
    /// q before a step.
    from: Vec<f64>,
}

impl Projectable for Damped<'_> {
    fn linearize(&mut self) {
        self.on.linearize();
    }

    /// q ← q + min(1, MAX_STEP/|Δq|) Δq; the size of the whole Δq.
    fn correct_positions(&mut self) -> f64 {
        let ProjectableState { system, state, elimination, q, .. } = &mut self.on;
        self.from.copy_from_slice(q);
        let step = elimination.correct_positions(system, state, q);
        let part = if step > MAX_STEP { MAX_STEP / step } else { 1.0 };
        for (q, from) in q.iter_mut().zip(&self.from) {
            *q = from + part * (*q - from);
        }
        state.set_positions(system, q);
        step
    }

    fn correct_velocities(&mut self) -> f64 {
        self.on.correct_velocities()
    }
}

/// Newton's method with short steps. Returns the violation at the start, the steps taken and what is left.
fn close(mechanism: &mut Mechanism, y: &mut [f64]) -> (f64, usize, f64) {
    mechanism.elimination.set_redundant(true);
    let violation = mechanism.state.position_violation(&mechanism.system);
    let length = mechanism.system.length;
    let from = vec![0.0; mechanism.system.coordinates];
    let mut damped = Damped { on: mechanism.projectable(y), from };
    let projected = project_positions(&mut damped, &rules::ROUGH_POSITIONS, length);
    (violation, projected.corrections, mechanism.state.position_violation(&mechanism.system))
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
