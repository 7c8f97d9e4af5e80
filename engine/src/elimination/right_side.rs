//! Right-hand sides: the particular accelerations that satisfy the rigid-body rows, the wrenches and γ — eq. (7.1).

use super::Elimination;
use super::state::BodyState;
use crate::lift::Lift;
use crate::model::BodyRef;
use crate::row::Form;
use crate::scene::Coordinates;
use crate::system::System;
use nalgebra::{Matrix3, Vector3};

impl Elimination {
    /// Sets the particular accelerations and the wrenches from the right-hand sides Γ of the rigid-body rows.
    ///
    /// `gamma(q, q̇)` returns the symmetric matrix of those rows of a body: units on the diagonal, right angles off it.
    pub(super) fn set_particular(
        &mut self,
        system: &System,
        velocity_terms: bool,
        gamma: impl Fn(&Lift, &Lift) -> Matrix3<f64>,
    ) {
        for (state, body) in self.bodies.iter_mut().zip(&system.bodies) {
            let g = gamma(&state.q, &state.q_dot);
            let particular = particular_directors(
                body.coordinates,
                &state.q,
                &g,
                |w, a| {
                    if velocity_terms {
                        *w += 2.0 * a.e[0].cross(&a.e[1]);
                    }
                },
                &state.q_dot,
            );
            state.particular = Lift { r: Vector3::zeros(), e: particular };
            let mut moment = Vector3::zeros();
            for k in 0..3 {
                let p = state.force.e[k] - particular[k] * body.ibar[k];
                moment += state.q.e[k].cross(&p);
            }
            state.wrench = [state.force.r, moment];
        }
        for (state, feature) in self.features[..system.moving].iter_mut().zip(&system.features) {
            if let BodyRef::Moving(body) = feature.body {
                state.particular = self.bodies[body].particular.arm(&feature.local);
            }
        }
        for place in system.moving..system.changing {
            let feature = &system.features[place];
            let Some(curve) = feature.curve else { continue };
            let [local, local_rate, local_acceleration] = self.curves[curve];
            let mut particular = Vector3::zeros();
            if let BodyRef::Moving(body) = feature.body {
                let BodyState { q, q_dot, particular: p, .. } = &self.bodies[body];
                particular += p.arm(&local);
                if velocity_terms {
                    particular += q_dot.arm(&local_rate) * 2.0 + q.arm(&local_acceleration);
                }
            } else if velocity_terms {
                particular = local_acceleration;
            }
            self.features[place].particular = particular;
        }
    }

    /// Writes γ' = γ − Φ_Q Q̈ᵖ of the solver rows, γ of a product's velocity terms included if asked for, and of
    /// each equation whatever `shift(Φ, Φ̇)` adds.
    pub(super) fn set_gamma(
        &mut self,
        system: &System,
        velocity_terms: bool,
        shift: impl Fn(f64, f64) -> f64,
    ) {
        for (index, row) in system.rows.iter().enumerate() {
            match row.form {
                Form::Coincidence { a, b } | Form::CommonVector { a, b } => {
                    let (a, b) = (&self.features[a], &self.features[b]);
                    let value = a.value - b.value;
                    let rate = a.rate - b.rate;
                    let gamma =
                        Vector3::from_fn(|k, _| shift(value[k], rate[k])) - (a.particular - b.particular);
                    if matches!(row.form, Form::Coincidence { .. }) {
                        self.gamma[row.solver..row.solver + 3].copy_from_slice(gamma.as_slice());
                    } else {
                        for k in 0..2 {
                            self.gamma[row.solver + k] = self.transverse[index][k].dot(&gamma);
                        }
                    }
                }
                Form::Product { a, b, target } => {
                    let [c, c_rate, c_acceleration] = self.target(target);
                    let product = self.product(a, b);
                    let mut gamma = shift(product.value - c, product.rate - c_rate) - product.particular;
                    if velocity_terms {
                        gamma += c_acceleration - product.curvature;
                    }
                    self.gamma[row.solver] = gamma;
                }
                Form::Relation { .. } => {
                    let relation = self.relation(system, &row.form);
                    let mut gamma = shift(relation.value, relation.rate) - relation.particular;
                    if velocity_terms {
                        gamma -= relation.curvature;
                    }
                    self.gamma[row.solver] = gamma;
                }
            }
        }
    }

    /// Weight of each body and all loads; time, positions and velocities must be in place.
    pub fn set_forces(&mut self, system: &System) {
        let mut forces = std::mem::take(&mut self.forces);
        for (lift, body) in forces.lifts.iter_mut().zip(&system.bodies) {
            *lift = Lift { r: system.model.gravity * body.mass, e: [Vector3::zeros(); 3] };
        }
        for load in &system.loads {
            load.apply(self, self.time, &mut forces);
        }
        for (state, lift) in self.bodies.iter_mut().zip(&forces.lifts) {
            state.force = *lift;
        }
        self.forces = forces;
    }

    pub(super) fn clear_forces(&mut self) {
        for state in &mut self.bodies {
            state.force = Lift::default();
        }
    }
}

/// Symmetric 3 × 3 matrix of entries (k, l), k ≥ l.
pub(super) fn gram(entry: impl Fn(usize, usize) -> f64) -> Matrix3<f64> {
    let (a, b, c) = (entry(1, 0), entry(2, 0), entry(2, 1));
    Matrix3::new(entry(0, 0), a, b, a, entry(1, 1), c, b, c, entry(2, 2))
}

/// ë_l = ½ Σ_k Γ_kl eᵏ with the dual basis eᵏ of the directors — eq. (7.1). For a reduced body only u and v have
/// rows, and ẅ follows from w = u × v; `extra` adds its velocity term.
pub(super) fn particular_directors(
    coordinates: Coordinates,
    q: &Lift,
    gamma: &Matrix3<f64>,
    extra: impl Fn(&mut Vector3<f64>, &Lift),
    q_dot: &Lift,
) -> [Vector3<f64>; 3] {
    let [u, v, w] = q.e;
    let dual = [v.cross(&w), w.cross(&u), u.cross(&v)];
    let half = 0.5 / u.dot(&dual[0]);
    match coordinates {
        Coordinates::Full | Coordinates::Shared => [0, 1, 2]
            .map(|l| (dual[0] * gamma[(0, l)] + dual[1] * gamma[(1, l)] + dual[2] * gamma[(2, l)]) * half),
        Coordinates::Reduced => {
            let [a, b] = [0, 1].map(|l| (dual[0] * gamma[(0, l)] + dual[1] * gamma[(1, l)]) * half);
            let mut c = a.cross(&v) + u.cross(&b);
            extra(&mut c, q_dot);
            [a, b, c]
        }
    }
}
