//! Increments of lifted coordinates under the constraints of one position, with residuals taken at another: what
//! discretizations need that multiply Φ_Qᵀ of the start of a step and close Φ at its end — eq. (10.7).

use super::Elimination;
use super::right_side::{gram, particular_directors};
use crate::lift::Lift;
use crate::model::BodyRef;
use crate::row::Form;
use crate::scene::Coordinates;
use crate::system::System;
use nalgebra::{Matrix3, Vector3};

/// What is left of a row's Φ or Φ̇; rows of one equation use the first component.
pub type Residual = Vector3<f64>;

impl Elimination {
    /// Takes over positions that are given body by body; the third director of a reduced body need not be a product.
    pub fn place_lifted(&mut self, system: &System, positions: &[Lift]) {
        for (state, q) in self.bodies.iter_mut().zip(positions) {
            state.q = *q;
        }
        self.place_features(system);
    }

    /// Takes over velocities that are given body by body; positions must be in place.
    pub fn set_lifted_velocity(&mut self, system: &System, velocities: &[Lift]) {
        for (state, q_dot) in self.bodies.iter_mut().zip(velocities) {
            state.q_dot = *q_dot;
        }
        self.set_feature_rates(system);
    }

    /// −Φ of each row, or −Φ̇.
    pub fn residuals(&self, system: &System, of_rates: bool, out: &mut [Residual]) {
        let pick = |value: f64, rate: f64| Vector3::new(-if of_rates { rate } else { value }, 0.0, 0.0);
        for (out, row) in out.iter_mut().zip(&system.rows) {
            *out = match row.form {
                Form::Coincidence { a, b } | Form::CommonVector { a, b } => {
                    let (a, b) = (&self.features[a], &self.features[b]);
                    if of_rates { b.rate - a.rate } else { b.value - a.value }
                }
                Form::Product { a, b, target } => {
                    let product = self.product(a, b);
                    let [c, c_rate, _] = self.target(target);
                    pick(product.value - c, product.rate - c_rate)
                }
                Form::Relation { .. } => {
                    let relation = self.relation(system, &row.form);
                    pick(relation.value, relation.rate)
                }
            };
        }
    }

    /// Solves M Δ + Φ_Qᵀ μ = P, Φ_Q Δ = r with M, Φ_Q and the factor of this position, all bodies taken as full ones.
    ///
    /// P is given body by body, r by the residuals of rows and, for the rigid-body rows, by the directors of `other`
    /// (their lengths and angles, or the rates of these). Read the solution with [`Self::lifted_solution`].
    pub fn increment(
        &mut self,
        system: &System,
        forces: &[Lift],
        other: &Self,
        of_rates: bool,
        rows: &[Residual],
    ) {
        for (index, (state, body)) in self.bodies.iter_mut().zip(&system.bodies).enumerate() {
            let there = &other.bodies[index];
            let (e, e_dot) = (&there.q.e, &there.q_dot.e);
            let open = gram(|k, l| {
                if of_rates {
                    -(e[k].dot(&e_dot[l]) + e[l].dot(&e_dot[k]))
                } else {
                    (if k == l { 1.0 } else { 0.0 }) - e[k].dot(&e[l])
                }
            });
            let particular =
                particular_directors(Coordinates::Full, &state.q, &open, |_, _| {}, &state.q_dot);
            state.particular = Lift { r: Vector3::zeros(), e: particular };
            let force = &forces[index];
            let moment: Vector3<f64> =
                (0..3).map(|k| state.q.e[k].cross(&(force.e[k] - particular[k] * body.ibar[k]))).sum();
            state.wrench = [force.r, moment];
        }
        for place in 0..system.changing {
            let BodyRef::Moving(body) = system.features[place].body else {
                self.features[place].particular = Vector3::zeros();
                continue;
            };
            let local = self.feature_local(system, place);
            self.features[place].particular = self.bodies[body].particular.arm(&local);
        }
        for (index, (row, r)) in system.rows.iter().zip(rows).enumerate() {
            match row.form {
                Form::Coincidence { a, b } | Form::CommonVector { a, b } => {
                    let gamma = r - (self.features[a].particular - self.features[b].particular);
                    if matches!(row.form, Form::Coincidence { .. }) {
                        self.gamma[row.solver..row.solver + 3].copy_from_slice(gamma.as_slice());
                    } else {
                        for k in 0..2 {
                            self.gamma[row.solver + k] = self.transverse[index][k].dot(&gamma);
                        }
                    }
                }
                Form::Product { a, b, .. } => {
                    self.gamma[row.solver] = r[0] - self.product(a, b).particular;
                }
                Form::Relation { .. } => {
                    self.gamma[row.solver] = r[0] - self.relation(system, &row.form).particular;
                }
            }
        }
        self.solve(system);
    }

    /// Puts the generalized force of a unit force along a load's coordinate in place of all applied forces. Returns the
    /// stiffness and damping of its law, or `None` for a load without one; positions and velocities must be in place.
    pub fn set_unit_load(&mut self, system: &System, load: usize) -> Option<(f64, f64)> {
        let mut forces = std::mem::take(&mut self.forces);
        forces.lifts.fill(Lift::default());
        let law = system.loads[load].linearized(self, &mut forces);
        for (state, lift) in self.bodies.iter_mut().zip(&forces.lifts) {
            state.force = *lift;
        }
        self.forces = forces;
        law
    }

    /// Acceleration of a load's coordinate under a unit force along it, 1/kg or 1/(kg m²), with the factor at hand.
    pub fn mobility(&mut self, system: &System, load: usize) -> Option<f64> {
        self.set_unit_load(system, load)?;
        let forces: Vec<Lift> = self.bodies.iter().map(|state| state.force).collect();
        self.set_particular(system, false, |_, _| Matrix3::zeros());
        self.gamma.fill(0.0);
        self.solve(system);
        Some(forces.iter().enumerate().map(|(body, force)| force.dot(&self.lifted_solution(body))).sum())
    }
}
