//! Increments of natural coordinates under the constraints of one position, with residuals taken at another: what
//! discretizations need that multiply Φ_Qᵀ of the start of a step and close Φ at its end — eq. (10.8).

use super::Elimination;
use super::right_side::{gram, particular_directors};
use crate::model::BodyRef;
use crate::scene::Coordinates;
use crate::state::{Residual, State};
use crate::system::System;
use crate::system::index::{FeatureId, RowId};
use crate::system::natural::NaturalCoordinates;
use crate::system::row::Form;
use nalgebra::{Matrix3, Vector3};

impl Elimination {
    /// Solves M Δ + Φ_Qᵀ μ = P, Φ_Q Δ = r with M, Φ_Q and the factor of this position, all bodies taken as full ones.
    ///
    /// P is given body by body, r by the residuals of rows and, for the rigid-body rows, by the directors of `other`
    /// (their lengths and angles, or the rates of these). Read the increment with [`Self::solution`].
    pub fn increment(
        &mut self,
        system: &System,
        state: &State,
        forces: &[NaturalCoordinates],
        other: &State,
        of_rates: bool,
        rows: &[Residual],
    ) {
        for (index, (solve, body)) in self.bodies.iter_mut().zip(&system.bodies).enumerate() {
            let (at, there) = (&state.bodies()[index], &other.bodies()[index]);
            let (e, e_dot) = (&there.q.e, &there.q_dot.e);
            let open = gram(|k, l| {
                if of_rates {
                    -(e[k].dot(&e_dot[l]) + e[l].dot(&e_dot[k]))
                } else {
                    (if k == l { 1.0 } else { 0.0 }) - e[k].dot(&e[l])
                }
            });
            let particular = particular_directors(Coordinates::Full, &at.q, &open, |_, _| {}, &at.q_dot);
            solve.particular = NaturalCoordinates { r: Vector3::zeros(), e: particular };
            let force = &forces[index];
            let moment: Vector3<f64> =
                (0..3).map(|k| at.q.e[k].cross(&(force.e[k] - particular[k] * body.ibar[k]))).sum();
            solve.wrench = [force.r, moment];
            solve.at_zero = Vector3::zeros();
        }
        for place in 0..system.changing {
            let BodyRef::Moving(body) = system.features[place].body else {
                self.particular[place] = Vector3::zeros();
                continue;
            };
            let local = state.feature_local(system, FeatureId(place));
            self.particular[place] = self.bodies[body].particular.arm(&local);
        }
        for (index, (row, r)) in system.rows.iter().zip(rows).enumerate() {
            match row.form {
                Form::Coincidence { a, b } | Form::CommonVector { a, b } => {
                    let gamma = r - (self.particular[a.index()] - self.particular[b.index()]);
                    if matches!(row.form, Form::Coincidence { .. }) {
                        self.gamma[row.solver..row.solver + 3].copy_from_slice(gamma.as_slice());
                    } else {
                        for k in 0..2 {
                            self.gamma[row.solver + k] =
                                self.jacobian.transverse(RowId(index))[k].dot(&gamma);
                        }
                    }
                }
                Form::Product { a, b, .. } => {
                    self.gamma[row.solver] = r[0] - self.particular_product(state, a, b);
                }
                Form::Relation { .. } => {
                    self.gamma[row.solver] = r[0] - self.particular_relation(system, state, &row.form);
                }
            }
        }
        self.solve(system);
    }

    /// Puts the generalized force of a unit force along a load's coordinate in place of all applied forces. Returns the
    /// stiffness and damping of its law, or `None` for a load without one.
    pub fn set_unit_load(&mut self, system: &System, state: &State, load: usize) -> Option<(f64, f64)> {
        self.forces.bodies.fill(NaturalCoordinates::default());
        let law = system.loads[load].linearized(system, state, &mut self.forces);
        self.take_forces();
        law
    }

    /// Acceleration of a load's coordinate under a unit force along it, 1/kg or 1/(kg m²), with the factor at hand.
    pub fn mobility(&mut self, system: &System, state: &State, load: usize) -> Option<f64> {
        self.set_unit_load(system, state, load)?;
        let forces: Vec<NaturalCoordinates> = self.bodies.iter().map(|solve| solve.force).collect();
        self.set_particular(system, state, false, |_, _| Matrix3::zeros());
        self.gamma.fill(0.0);
        self.solve(system);
        let along = |(body, force): (usize, &NaturalCoordinates)| force.dot(&self.solution(state, body));
        Some(forces.iter().enumerate().map(along).sum())
    }
}
