//! What an evaluation has found at a state: accelerations and multipliers. They hold the state, so that it cannot change
//! under them.

use super::{BodySolve, TwistJacobian, natural_acceleration};
use crate::model::BodyRef;
use crate::state::State;
use crate::system::index::{IncidenceId, RowId};
use crate::system::natural::NaturalCoordinates;
use crate::system::row::Form;
use crate::system::{Constraint, System};
use nalgebra::Vector3;

/// Multipliers of all joints and drivers at a state.
#[derive(Clone, Copy, Debug)]
pub struct Multipliers<'a> {
    /// The system.
    pub system: &'a System,
    /// The state.
    pub state: &'a State,
    /// A at that state.
    pub jacobian: &'a TwistJacobian,
    lambda: &'a [f64],
}

impl<'a> Multipliers<'a> {
    /// Of the multipliers of the solver rows, with A at the state.
    pub fn new(system: &'a System, state: &'a State, jacobian: &'a TwistJacobian, lambda: &'a [f64]) -> Self {
        Self { system, state, jacobian, lambda }
    }

    /// λ of the solver rows.
    pub fn solver_rows(&self) -> &'a [f64] {
        self.lambda
    }

    /// λ of the equations of a row, as written: those of a common vector are μ₁ t₁ + μ₂ t₂.
    pub fn of_row(&self, id: RowId) -> Vec<f64> {
        let row = &self.system[id];
        match row.form {
            Form::Coincidence { .. } => self.lambda[row.solver..row.solver + 3].to_vec(),
            Form::CommonVector { .. } => {
                let [t1, t2] = self.jacobian.transverse(id);
                let sum = t1 * self.lambda[row.solver] + t2 * self.lambda[row.solver + 1];
                sum.as_slice().to_vec()
            }
            Form::Product { .. } | Form::Relation { .. } => vec![self.lambda[row.solver]],
        }
    }

    /// Force and moment about the centre of mass, −A_bᵀ λ, of a joint on a body — eq. (9.1).
    pub fn wrench_on(&self, incidence: IncidenceId) -> [Vector3<f64>; 2] {
        let constraint = self.system[incidence].constraint;
        let lambda = &self.lambda[self.system[constraint].solver.clone()];
        let (mut force, mut moment) = ([0.0; 3], [0.0; 3]);
        let rows = self.jacobian.rows_on(self.system, incidence).as_chunks::<6>().0;
        // Of hinges in a plane three rows out of five carry nothing.
        for (a, lambda) in rows.iter().zip(lambda).filter(|(_, lambda)| **lambda != 0.0) {
            for c in 0..3 {
                force[c] -= a[c] * lambda;
                moment[c] -= a[3 + c] * lambda;
            }
        }
        [force.into(), moment.into()]
    }

    /// The reaction of a joint or driver; none where it meets no moving body.
    pub fn joint_wrench(&self, constraint: &Constraint) -> Option<JointWrench> {
        let system = self.system;
        let side = usize::from(constraint.bodies[1] != BodyRef::Ground);
        let BodyRef::Moving(body) = constraint.bodies[side] else { return None };
        let incidence = constraint.incidence_ids().find(|&id| system[id].body == body)?;
        let [force, about_center] = self.wrench_on(incidence);
        let q = &self.state.bodies()[body].q;
        let arm = q.arm(&constraint.points[side]);
        Some(JointWrench { side, force, moment: about_center - arm.cross(&force), about: q.r + arm })
    }
}

/// What a joint or driver does to body j, or to body i if j is the ground.
#[derive(Clone, Copy, Debug)]
pub struct JointWrench {
    /// 0 for body i, 1 for body j.
    pub side: usize,
    /// Force in the world, N.
    pub force: Vector3<f64>,
    /// Moment about the joint's point on that body, N m.
    pub moment: Vector3<f64>,
    /// That point in the world, m.
    pub about: Vector3<f64>,
}

/// Accelerations and multipliers at a state.
#[derive(Clone, Copy, Debug)]
pub struct Accelerations<'a> {
    /// The multipliers.
    pub multipliers: Multipliers<'a>,
    bodies: &'a [BodySolve],
}

impl<'a> Accelerations<'a> {
    pub(super) fn new(multipliers: Multipliers<'a>, bodies: &'a [BodySolve]) -> Self {
        Self { multipliers, bodies }
    }

    /// Q̈ of a body.
    pub fn of_body(&self, body: usize) -> NaturalCoordinates {
        natural_acceleration(&self.bodies[body], &self.multipliers.state.bodies()[body].q)
    }

    /// G of a body, its generalized applied force.
    pub fn force_on(&self, body: usize) -> &'a NaturalCoordinates {
        &self.bodies[body].force
    }

    /// Writes q̈.
    pub fn write(&self, out: &mut [f64]) {
        for (index, body) in self.multipliers.system.bodies.iter().enumerate() {
            body.layout.store(&self.of_body(index), out);
        }
    }
}
