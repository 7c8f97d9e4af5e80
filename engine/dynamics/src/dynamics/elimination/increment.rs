//! Increments of natural coordinates under the constraints of one position, with residuals taken at another: what
//! discretizations need that multiply Φ_Qᵀ of the start of a step and close Φ at its end — eq. (10.8).

use super::Elimination;
use super::right_side::{particular_directors, stretch, stretching};
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
            let open = if of_rates { stretching(&there.q, &there.q_dot) } else { stretch(&there.q) };
            let particular = particular_directors(Coordinates::Full, &at.q, &open, |_, _| {}, &at.q_dot);
            solve.begin(&forces[index], particular, &body.ibar, &at.q);
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
                    self.write_vector(RowId(index), row, &gamma);
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
