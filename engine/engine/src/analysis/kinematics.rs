//! Kinematic analysis of driven mechanisms, and the forces that drive them.
//!
//! With a driver for each degree of freedom, positions follow from Φ(q, t) = 0 by Newton-Raphson, velocities from
//! Φ_q q̇ = ν and accelerations from Φ_q q̈ = γ; rows that repeat others are met in the sense of least squares. The
//! multipliers of the equations of motion are then those of inverse dynamics: what joints and drivers have to exert.

use super::{AnalysisError, Stage};
use crate::reactions::report::{Convention, ReactionReport, report};
use crate::scene::Scene;
use nalgebra::Vector3;
use schemars::JsonSchema;
use serde::Serialize;
use triad_dynamics::dynamics::elimination::{Accelerations, ProjectableState};
use triad_dynamics::newton::{project_positions, project_velocities, rules};
use triad_dynamics::state::BodyFrame;
use triad_dynamics::system::index::ConstraintId;

/// Violation, relative to the mechanism's length, above which a position counts as not reached.
const MAX_VIOLATION: f64 = 1e-9;
/// Greatest number of positions of one analysis.
const MAX_POSITIONS: usize = 100_000;

/// A driven mechanism at one moment.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct KinematicState {
    /// Time, s.
    pub time: f64,
    /// Positions and velocities of the bodies.
    pub bodies: Vec<BodyFrame>,
    /// Accelerations of their centres of mass, m/s².
    pub accelerations: Vec<[f64; 3]>,
    /// Angular accelerations, rad/s².
    pub angular_accelerations: Vec<[f64; 3]>,
    /// What joints and drivers have to exert.
    pub reactions: ReactionReport,
}

/// A driven motion.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct Kinematics {
    /// The positions, in the order of time.
    pub states: Vec<KinematicState>,
    /// Newton-Raphson steps in all.
    pub iterations: usize,
}

/// Follows the drivers of a scene over its duration, at the interval of its settings.
///
/// # Errors
///
/// [`AnalysisError`]: a scene that is free to move, or drivers that ask for what the joints do not allow, with the time.
///
/// ```
/// use triad_engine::{analysis::kinematics, prelude::*};
///
/// let mut scene = Scene::new("crank").duration(1.0);
/// let crank = scene.add(Body::rod("crank", 1.0, [0.0; 3], [1.0, 0.0, 0.0]));
/// let hinge = scene.add(Joint::revolute("hinge", Ground, &crank).at([0.0; 3]).about([0.0, 0.0, 1.0]));
/// scene.add(Driver::angle("motor", &hinge, Motion::ramp(0.0, 3.0)));
/// let motion = kinematics(&scene, triad_engine::reactions::report::Convention::default())?;
/// assert!((motion.states[0].bodies[0].angular_velocity[2] - 3.0).abs() < 1e-9);
/// # Ok::<(), triad_engine::analysis::AnalysisError>(())
/// ```
pub fn kinematics(scene: &Scene, convention: Convention) -> Result<Kinematics, AnalysisError> {
    let mut stage = Stage::new(scene)?;
    let freedoms = stage.tangent().ncols();
    if freedoms > 0 {
        return Err(AnalysisError::Free { freedoms });
    }
    let settings = &scene.simulation;
    let mut states = Vec::new();
    let mut iterations = 0;
    let mut last = 0.0;
    let mut acceleration = vec![0.0; stage.q.len()];
    while states.len() < MAX_POSITIONS {
        let time = (states.len() as f64 * settings.every).min(settings.duration);
        // The next position is near the one that the last accelerations lead to.
        let h = time - last;
        for ((q, v), a) in stage.q.iter_mut().zip(&stage.q_dot).zip(&acceleration) {
            *q += h * (v + 0.5 * h * a);
        }
        stage.time = time;
        iterations += positions(&mut stage)?;
        velocities(&mut stage);
        let found = stage.accelerate();
        found.write(&mut acceleration);
        let reactions = report(&found.multipliers, convention);
        let (linear, angular) = accelerations(&found);
        states.push(KinematicState {
            time,
            bodies: stage.frames(),
            accelerations: linear,
            angular_accelerations: angular,
            reactions: reactions.map_err(crate::EngineError::from)?,
        });
        if time >= settings.duration {
            break;
        }
        last = time;
    }
    Ok(Kinematics { states, iterations })
}

/// Newton-Raphson to Φ(q, t) = 0. Returns the number of steps.
fn positions(stage: &mut Stage) -> Result<usize, AnalysisError> {
    let (time, length) = (stage.time, stage.mechanism.system.length);
    let mut on = stage.projectable();
    on.state.set_time(on.system, time);
    on.state.set_positions(on.system, on.q);
    let steps = project_positions(&mut on, &rules::KINEMATICS_POSITIONS, length).corrections;
    let ProjectableState { system, state, .. } = on;
    let open = state.position_violation(system);
    // A comparison that is false for NaN as well.
    let closed = open <= MAX_VIOLATION * system.length.max(1.0);
    if !closed {
        let open = triad_dynamics::constraints::violation::measure(system, state);
        let (id, violation) = open.constraints.first().copied().unwrap_or((ConstraintId(0), open.relative));
        let origin = system.constraints.get(id.index()).map_or_else(String::new, |worst| worst.name.clone());
        return Err(AnalysisError::Unreachable { time, origin, violation });
    }
    state.commit_revolutions();
    Ok(steps)
}

/// Φ_q q̇ = ν at the positions that were found.
fn velocities(stage: &mut Stage) {
    let length = stage.mechanism.system.length;
    let mut on = stage.projectable();
    on.state.set_velocities(on.system, on.q_dot);
    project_velocities(&mut on, &rules::KINEMATICS_VELOCITIES, length);
}

/// Accelerations of the centres of mass and angular accelerations.
fn accelerations(found: &Accelerations) -> (Vec<[f64; 3]>, Vec<[f64; 3]>) {
    let (mut linear, mut angular) = (Vec::new(), Vec::new());
    for (index, state) in found.multipliers.state.bodies().iter().enumerate() {
        let second = found.of_body(index);
        // α = ½ Σ e_k × ë_k, as Σ ė_k × ė_k = 0 — eq. (6.4).
        let alpha: Vector3<f64> =
            (0..3).map(|k| state.q.e[k].cross(&second.e[k])).sum::<Vector3<f64>>() * 0.5;
        linear.push(second.r.into());
        angular.push(alpha.into());
    }
    (linear, angular)
}
