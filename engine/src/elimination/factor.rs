//! The twist Jacobian A, S = A D⁻¹ Aᵀ and its factor at the positions that are in place — eq. (7.4).

use super::{Elimination, NEAR_SINGULAR, REGULARIZATION};
use crate::lift::Lift;
use crate::row::Form;
use crate::system::{NO_INCIDENCE, Row, System};
use nalgebra::{Matrix3, Vector3};
use triad_linalg::block_cholesky::stride;
use triad_linalg::orthonormal_basis;

impl Elimination {
    /// Builds A, S and its factor at the current positions.
    pub fn linearize(&mut self, system: &System) {
        self.set_up(system);
        self.regularized = self.redundant;
        let epsilon = if self.redundant { REGULARIZATION } else { 0.0 };
        self.assemble(system);
        let smallest = self.factor.factor(epsilon, 0.0);
        self.counters.factorizations += 1;
        if !self.redundant && smallest < NEAR_SINGULAR {
            self.regularized = true;
            self.assemble(system);
            self.factor.factor(REGULARIZATION, 0.0);
            self.counters.factorizations += 1;
        }
    }

    /// Relative pivots of S at the current positions, with dependent rows dropped: (solver row, pivot). The factor is
    /// none to solve with.
    pub fn pivots(&mut self, system: &System, skip: f64) -> Vec<(usize, f64)> {
        self.set_up(system);
        self.assemble(system);
        self.factor.factor(0.0, skip);
        self.factor.relative_pivots().iter().copied().enumerate().collect()
    }

    /// From now on keeps how firmly joints hold.
    pub fn keep_holds(&mut self) {
        self.factor.keep_pivot_products();
    }

    /// How firmly each joint holds at the current positions: see [`triad_linalg::BlockCholesky::pivot_products`]. The factor is
    /// none to solve with.
    pub fn holds_here(&mut self, system: &System) -> &[f64] {
        self.set_up(system);
        self.assemble(system);
        self.factor.factor(0.0, 0.0);
        self.factor.pivot_products()
    }

    fn set_up(&mut self, system: &System) {
        self.fill_blocks(system);
        for (state, body) in self.bodies.iter_mut().zip(&system.bodies) {
            state.inverse = inverse_inertia(&state.q, &body.ibar, body.lent);
        }
        self.scale_blocks(system);
    }

    pub(super) fn fill_blocks(&mut self, system: &System) {
        self.a.fill(0.0);
        for (index, row) in system.rows.iter().enumerate() {
            match row.form {
                Form::Coincidence { a, b } => {
                    for k in 0..3 {
                        let g = Vector3::ith(k, 1.0);
                        self.add_gradient(system, row, k, 0, a, &g);
                        self.add_gradient(system, row, k, 1, b, &-g);
                    }
                }
                Form::CommonVector { a, b } => {
                    self.transverse[index] = orthonormal_basis(&self.features[a].value.normalize());
                    for k in 0..2 {
                        let t = self.transverse[index][k];
                        self.add_gradient(system, row, k, 0, a, &t);
                        self.add_gradient(system, row, k, 1, b, &-t);
                    }
                }
                Form::Product { a, b, .. } => {
                    let (x, y) = (self.difference(a, |f| f.value), self.difference(b, |f| f.value));
                    let mut place = 0;
                    for (difference, g) in [(a, y), (b, x)] {
                        self.add_gradient(system, row, 0, place, difference.plus, &g);
                        place += 1;
                        if let Some(minus) = difference.minus {
                            self.add_gradient(system, row, 0, place, minus, &-g);
                            place += 1;
                        }
                    }
                }
                Form::Relation { angles, slide, .. } => {
                    let mut place = 0;
                    for (angle, factor) in angles.into_iter().flatten() {
                        let gradient = self.angles[angle].gradient;
                        for (feature, g) in system.angles[angle].features().into_iter().zip(gradient) {
                            self.add_gradient(system, row, 0, place, feature, &(g * factor));
                            place += 1;
                        }
                    }
                    if let Some((a, b, factor)) = slide {
                        let (x, y) = (self.difference(a, |f| f.value), self.difference(b, |f| f.value));
                        for (difference, g) in [(a, y * factor), (b, x * factor)] {
                            self.add_gradient(system, row, 0, place, difference.plus, &g);
                            place += 1;
                            if let Some(minus) = difference.minus {
                                self.add_gradient(system, row, 0, place, minus, &-g);
                                place += 1;
                            }
                        }
                    }
                }
            }
        }
    }

    /// Adds the row gᵀ C of one feature, in twist form (g, arm × g) — eq. (7.4).
    fn add_gradient(
        &mut self,
        system: &System,
        row: &Row,
        k: usize,
        place: usize,
        feature: usize,
        g: &Vector3<f64>,
    ) {
        let incidence = row.incidence[place];
        if incidence == NO_INCIDENCE {
            return;
        }
        let at = system.incidences[incidence].offset + 6 * (row.local + k);
        let moment = self.features[feature].arm.cross(g);
        let block = &mut self.a[at..at + 6];
        if system.features[feature].point {
            for c in 0..3 {
                block[c] += g[c];
            }
        }
        for c in 0..3 {
            block[3 + c] += moment[c];
        }
    }

    fn scale_blocks(&mut self, system: &System) {
        for incidence in &system.incidences {
            let inverse = &self.bodies[incidence.body].inverse;
            let inverse_mass = 1.0 / system.bodies[incidence.body].mass;
            let range = incidence.offset..incidence.offset + 6 * incidence.rows;
            for (a, b) in self.a[range.clone()].chunks_exact(6).zip(self.b[range].chunks_exact_mut(6)) {
                let moment = inverse * Vector3::new(a[3], a[4], a[5]);
                for c in 0..3 {
                    b[c] = a[c] * inverse_mass;
                    b[3 + c] = moment[c];
                }
            }
        }
    }

    fn assemble(&mut self, system: &System) {
        self.factor.clear();
        let values = self.factor.values_mut();
        for contribution in &self.contributions {
            let (left, right) =
                (&system.incidences[contribution.left], &system.incidences[contribution.right]);
            let a = &self.a[left.offset..left.offset + 6 * left.rows];
            let b = &self.b[right.offset..right.offset + 6 * right.rows];
            let target = &mut values[contribution.slot.offset..];
            for (a, out) in a.chunks_exact(6).zip(target.chunks_exact_mut(stride(right.rows))) {
                for (b, out) in b.chunks_exact(6).zip(out) {
                    *out += a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
                }
            }
        }
    }
}

/// Inverse of I_g = Σ Ī_k (|e_k|² I − e_k e_kᵀ), with `lent` added to its diagonal.
fn inverse_inertia(q: &Lift, ibar: &Vector3<f64>, lent: f64) -> Matrix3<f64> {
    let mut inertia = Matrix3::from_diagonal_element(lent);
    for k in 0..3 {
        let e = q.e[k];
        let trace = ibar[k] * e.norm_squared();
        inertia += Matrix3::from_diagonal_element(trace) - e * e.transpose() * ibar[k];
    }
    let [a, b, c] = [0, 1, 2].map(|k| inertia.column(k).into_owned());
    let (bc, ca, ab) = (b.cross(&c), c.cross(&a), a.cross(&b));
    let scale = 1.0 / a.dot(&bc);
    // Rows of the inverse of a matrix with columns a, b, c; it is symmetric.
    Matrix3::from_columns(&[bc * scale, ca * scale, ab * scale])
}
