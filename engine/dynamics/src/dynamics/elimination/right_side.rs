//! Right-hand sides: the particular accelerations that satisfy the rigid-body rows, the wrenches and γ — eq. (7.1).

use super::{BodySolve, Elimination};
use crate::model::BodyRef;
use crate::scene::Coordinates;
use crate::state::{BodyState, State};
use crate::system::feature::Difference;
use crate::system::index::RowId;
use crate::system::natural::NaturalCoordinates;
use crate::system::row::Form;
use crate::system::{Row, System};
use nalgebra::{Matrix3, Vector3};

impl Elimination {
    /// Sets the particular accelerations and the wrenches (F, T) from the right-hand sides Γ of the rigid-body rows — eq. (7.5).
    ///
    /// `gamma(q, q̇)` returns the symmetric matrix of those rows of a body: units on the diagonal, right angles off it.
    pub(super) fn set_particular(
        &mut self,
        system: &System,
        state: &State,
        velocity_terms: bool,
        gamma: impl Fn(&NaturalCoordinates, &NaturalCoordinates) -> Matrix3<f64>,
    ) {
        let bodies = system.bodies.iter().zip(state.bodies());
        for (solve, (body, at)) in self.bodies.iter_mut().zip(bodies) {
            let g = gamma(&at.q, &at.q_dot);
            let particular = particular_directors(
                body.coordinates,
                &at.q,
                &g,
                |w, a| {
                    if velocity_terms {
                        *w += 2.0 * a.e[0].cross(&a.e[1]);
                    }
                },
                &at.q_dot,
            );
            let force = solve.force;
            solve.begin(&force, particular, &body.ibar, &at.q);
            let reduced = body.coordinates == Coordinates::Reduced;
            let turns = velocity_terms && reduced && body.regularizing_inertia > 0.0;
            let turned = |k: usize| at.q.e[k].cross(&particular[k]) * -0.5;
            solve.at_zero = if turns { (0..3).map(turned).sum() } else { Vector3::zeros() };
        }
        for (particular, feature) in self.particular[..system.moving].iter_mut().zip(&system.features) {
            if let BodyRef::Moving(body) = feature.body {
                *particular = self.bodies[body].particular.arm(&feature.local);
            }
        }
        for place in system.moving..system.changing {
            let feature = &system.features[place];
            let Some(curve) = feature.curve else { continue };
            let [local, local_rate, local_acceleration] = state.curve(curve);
            let mut particular = Vector3::zeros();
            if let BodyRef::Moving(body) = feature.body {
                let BodyState { q, q_dot } = &state.bodies()[body];
                particular += self.bodies[body].particular.arm(&local);
                if velocity_terms {
                    particular += q_dot.arm(&local_rate) * 2.0 + q.arm(&local_acceleration);
                }
            } else if velocity_terms {
                particular = local_acceleration;
            }
            self.particular[place] = particular;
        }
    }

    /// Writes γ' = γ − Φ_Q Q̈ᵖ of the solver rows — eq. (7.3) —, γ of a product's velocity terms included if asked for, and of
    /// each equation whatever `shift(Φ, Φ̇)` adds.
    pub(super) fn set_gamma(
        &mut self,
        system: &System,
        state: &State,
        velocity_terms: bool,
        shift: impl Fn(f64, f64) -> f64,
    ) {
        for (index, row) in system.rows.iter().enumerate() {
            match row.form {
                Form::Coincidence { a, b } | Form::CommonVector { a, b } => {
                    let value = state.feature_value(a) - state.feature_value(b);
                    let rate = state.feature_rate(a) - state.feature_rate(b);
                    let gamma = Vector3::from_fn(|k, _| shift(value[k], rate[k]))
                        - (self.particular[a.index()] - self.particular[b.index()]);
                    self.write_vector(RowId(index), row, &gamma);
                }
                Form::Product { a, b, target } => {
                    let [c, c_rate, c_acceleration] = state.target(target);
                    let product = state.product(a, b);
                    let mut gamma = shift(product.value - c, product.rate - c_rate)
                        - self.particular_product(state, a, b);
                    if velocity_terms {
                        gamma += c_acceleration - product.curvature;
                    }
                    self.gamma[row.solver] = gamma;
                }
                Form::Relation { .. } => {
                    let relation = state.relation(&row.form);
                    let mut gamma = shift(relation.value, relation.rate)
                        - self.particular_relation(system, state, &row.form);
                    if velocity_terms {
                        gamma -= relation.curvature;
                    }
                    self.gamma[row.solver] = gamma;
                }
            }
        }
    }

    /// Writes γ' of a row whose Φ is a vector.
    pub(super) fn write_vector(&mut self, index: RowId, row: &Row, gamma: &Vector3<f64>) {
        if matches!(row.form, Form::Coincidence { .. }) {
            self.gamma[row.solver..row.solver + 3].copy_from_slice(gamma.as_slice());
        } else {
            for k in 0..2 {
                self.gamma[row.solver + k] = self.jacobian.transverse(index)[k].dot(gamma);
            }
        }
    }

    /// The second derivative of a · b along Q̈ᵖ.
    pub(super) fn particular_product(&self, state: &State, a: Difference, b: Difference) -> f64 {
        let (x, y) = (a.of(|f| state.feature_value(f)), b.of(|f| state.feature_value(f)));
        let (xp, yp) = (a.of(|f| self.particular[f.index()]), b.of(|f| self.particular[f.index()]));
        x.dot(&yp) + xp.dot(&y)
    }

    /// The second derivative of the left side of a relation along Q̈ᵖ.
    pub(super) fn particular_relation(&self, system: &System, state: &State, form: &Form) -> f64 {
        let mut sum = 0.0;
        let Form::Relation { angles, slide, .. } = *form else { return sum };
        for (angle, factor) in angles.into_iter().flatten() {
            let features = system.angles[angle].features();
            let gradient = &state.angles()[angle].gradient;
            let particular: f64 =
                features.iter().zip(gradient).map(|(&f, g)| g.dot(&self.particular[f.index()])).sum();
            sum += factor * particular;
        }
        if let Some((a, b, factor)) = slide {
            sum += factor * self.particular_product(state, a, b);
        }
        sum
    }

    /// Weight of each body and all loads at a state.
    pub fn set_forces(&mut self, system: &System, state: &State) {
        self.forces.evaluate(system, state);
        self.take_forces();
    }

    /// Takes the applied forces over to the bodies.
    pub(super) fn take_forces(&mut self) {
        for (solve, force) in self.bodies.iter_mut().zip(&self.forces.bodies) {
            solve.force = *force;
        }
    }

    pub(super) fn clear_forces(&mut self) {
        for solve in &mut self.bodies {
            solve.force = NaturalCoordinates::default();
        }
    }
}

impl BodySolve {
    /// Begins with particular directors, and the wrench of a generalized force less their inertia at a position.
    pub(super) fn begin(
        &mut self,
        force: &NaturalCoordinates,
        particular: [Vector3<f64>; 3],
        ibar: &Vector3<f64>,
        q: &NaturalCoordinates,
    ) {
        let p = |k: usize| force.e[k] - particular[k] * ibar[k];
        let moment = (0..3).map(|k| q.e[k].cross(&p(k))).sum();
        self.particular = NaturalCoordinates { r: Vector3::zeros(), e: particular };
        self.wrench = [force.r, moment];
    }
}

/// What directors lack of unit length and right angles.
pub(super) fn stretch(NaturalCoordinates { e, .. }: &NaturalCoordinates) -> Matrix3<f64> {
    gram(|k, l| if k == l { 1.0 } else { 0.0 } - e[k].dot(&e[l]))
}

/// Less the rates of their lengths and right angles.
pub(super) fn stretching(q: &NaturalCoordinates, q_dot: &NaturalCoordinates) -> Matrix3<f64> {
    gram(|k, l| -(q.e[k].dot(&q_dot.e[l]) + q.e[l].dot(&q_dot.e[k])))
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
    q: &NaturalCoordinates,
    gamma: &Matrix3<f64>,
    extra: impl Fn(&mut Vector3<f64>, &NaturalCoordinates),
    q_dot: &NaturalCoordinates,
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
