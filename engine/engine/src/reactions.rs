//! Reactions of joints from their multipliers — THEORY section 9.
//!
//! With M q̈ + Φ_qᵀ λ = g, the force that constraints exert is −Φ_qᵀ λ. Pushed through the rigid motion of a body it is
//! a force and a moment, whatever rows the joint is made of. Multipliers of rigid-body rows are internal to the
//! coordinates and never shown as reactions.

pub mod matrices;
pub mod uniqueness;

pub mod report;
mod rigid;

pub use rigid::{RigidMultipliers, rigid_multipliers};

use schemars::JsonSchema;
use serde::Serialize;
use triad_dynamics::dynamics::elimination::{JointWrench, Multipliers};
use triad_dynamics::model::BodyRef;
use triad_dynamics::system::row::equation_labels;

/// One multiplier λ of eq. (6.6) with the label of its equation.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct Multiplier {
    /// Label of the equation within its joint.
    pub label: String,
    /// λ, in N for a row in metres, in N m for a row of unit vectors.
    pub value: f64,
}

/// Multipliers λ of a joint or driver and the reaction that they make — eq. (9.1): vectors in the world.
///
/// ```
/// use triad_engine::prelude::*;
///
/// let mut scene = Scene::new("hanging").gravity([0.0, 0.0, -9.81]);
/// let ball = scene.add(Body::sphere("ball", 2.0, 0.1, [0.0; 3]));
/// scene.add(Joint::spherical("hook", Ground, &ball).at([0.0, 0.0, 0.5]));
/// let hook = &Simulation::new(&scene)?.multipliers()[0];
/// assert_eq!((hook.on.as_str(), hook.by.as_str(), hook.rows.len()), ("ball", "ground", 3));
/// // The rows say P_i − P_j = 0: λ is the force on body j, the ball.
/// assert!((hook.force[2] - 2.0 * 9.81).abs() < 1e-12 && hook.rows[2].value == hook.force[2]);
/// # Ok::<(), EngineError>(())
/// ```
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct JointMultipliers {
    /// The joint or driver.
    pub joint: String,
    /// Its multipliers λ, in the order of its equations.
    pub rows: Vec<Multiplier>,
    /// The body that the reaction acts on: body j, or body i if j is the ground.
    pub on: String,
    /// The body that exerts it.
    pub by: String,
    /// Force f on that body, N.
    pub force: [f64; 3],
    /// Moment τ on that body about the joint's point, N m.
    pub moment: [f64; 3],
    /// The joint's point on that body in the world, m.
    pub about: [f64; 3],
    /// Frame of the components: `world`.
    pub expressed_in: &'static str,
}

/// Multipliers and reactions of all joints and drivers.
#[doc(hidden)]
pub fn multipliers(at: &Multipliers) -> Vec<JointMultipliers> {
    let system = at.system;
    let name = |body: BodyRef| match body {
        BodyRef::Ground => crate::scene::GROUND.to_owned(),
        BodyRef::Moving(body) => system.model.bodies[body].name.clone(),
    };
    let mut joints = Vec::with_capacity(system.constraints.len());
    for constraint in &system.constraints {
        let rows = constraint
            .row_ids()
            .flat_map(|id| {
                let row = &system[id];
                let labels = equation_labels(row.label, row.form.equations());
                labels.into_iter().zip(at.of_row(id))
            })
            .map(|(label, value)| Multiplier { label, value })
            .collect();
        let Some(JointWrench { side, force, moment, about }) = at.joint_wrench(constraint) else { continue };
        joints.push(JointMultipliers {
            joint: constraint.name.clone(),
            rows,
            on: name(constraint.bodies[side]),
            by: name(constraint.bodies[1 - side]),
            force: force.into(),
            moment: moment.into(),
            about: about.into(),
            expressed_in: "world",
        });
    }
    joints
}
