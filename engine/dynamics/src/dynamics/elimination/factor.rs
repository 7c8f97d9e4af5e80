//! S = A D⁻¹ Aᵀ and its factor — eq. (7.6).

use super::{Elimination, REGULARIZATION};
use crate::dynamics::blocks::{add_block, add_square};
use crate::state::State;
use crate::system::System;
use crate::system::index::SolverRow;
use crate::system::natural::NaturalCoordinates;
use nalgebra::{Matrix3, Vector3};

impl Elimination {
    /// Builds A, S and its factor at the positions of a state.
    pub fn linearize(&mut self, system: &System, state: &State) {
        self.set_up(system, state);
        self.regularized = self.redundant && !self.resolving;
        let epsilon = if self.regularized { REGULARIZATION } else { 0.0 };
        self.assemble(system);
        let smallest = self.factor.factor(epsilon, 0.0);
        self.counters.factorizations += 1;
        if self.pivots.are_lost(smallest, self.resolving) && !self.regularized {
            self.regularized = true;
            self.assemble(system);
            self.factor.factor(REGULARIZATION, 0.0);
            self.counters.factorizations += 1;
        }
    }

    /// Builds A alone at the positions of a state.
    pub fn fill_rows(&mut self, system: &System, state: &State) {
        self.jacobian.fill(system, state);
    }

    /// The solver rows that depend on others at the positions of a state, by the pivots of S below the part `least` of its
    /// diagonal — eq. (8.1). The factor is left without these rows.
    pub fn dependent_rows(&mut self, system: &System, state: &State, least: f64) -> Vec<SolverRow> {
        self.set_up(system, state);
        self.assemble(system);
        self.factor.dependent_rows(least).into_iter().map(SolverRow).collect()
    }

    /// The least relative pivot above `least` of the last factorization.
    pub fn least_pivot(&self, least: f64) -> f64 {
        let pivots = self.factor.relative_pivots().iter();
        pivots.filter(|pivot| **pivot > least).fold(f64::INFINITY, |smallest, pivot| smallest.min(*pivot))
    }

    /// Factors S of the last positions without the given rows.
    pub fn factor_without(&mut self, system: &System, rows: &[SolverRow]) {
        self.factor.leave_out(rows.iter().map(|row| row.index()));
        self.assemble(system);
        self.factor.factor(0.0, 0.0);
    }

    /// From now on each factorization keeps its pivot products.
    pub fn keep_pivot_products(&mut self) {
        self.factor.keep_pivot_products();
    }

    /// The pivot products of the joints at the positions of a state: see [`triad_linalg::BlockCholesky::pivot_products`]. The factor is
    /// none to solve with.
    pub fn pivot_products_at(&mut self, system: &System, state: &State) -> &[f64] {
        self.set_up(system, state);
        self.assemble(system);
        self.factor.factor(0.0, 0.0);
        self.factor.pivot_products()
    }

    /// Which joints take part where rows of `joints` nearly depend on others, at the positions of
    /// [`Elimination::pivot_products_at`]: see [`triad_linalg::BlockCholesky::raise_shares`].
    pub fn raise_shares(&mut self, joints: &[(usize, f64)], shares: &mut [f64]) {
        self.factor.raise_shares(joints, shares);
    }

    pub(super) fn set_up(&mut self, system: &System, state: &State) {
        self.jacobian.fill(system, state);
        let bodies = system.bodies.iter().zip(state.bodies());
        for (solve, (body, at)) in self.bodies.iter_mut().zip(bodies) {
            solve.inverse = inverse_inertia(&at.q, &body.ibar, body.regularizing_inertia);
        }
        self.scale_blocks(system);
    }

    fn scale_blocks(&mut self, system: &System) {
        for incidence in &system.incidences {
            let inverse = &self.bodies[incidence.body].inverse;
            let inverse_mass = 1.0 / system.bodies[incidence.body].mass;
            let range = incidence.offset..incidence.offset + 6 * incidence.rows;
            let a = self.jacobian.a[range.clone()].as_chunks::<6>().0;
            for (a, b) in a.iter().zip(self.b[range].as_chunks_mut::<6>().0) {
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
        for product in &self.products {
            let (left, right) = (&system.incidences[product.left], &system.incidences[product.right]);
            let a = self.jacobian.a[left.offset..left.offset + 6 * left.rows].as_chunks::<6>().0;
            let b = self.b[right.offset..right.offset + 6 * right.rows].as_chunks::<6>().0;
            let out = &mut values[product.offset..];
            match (left.rows, right.rows) {
                // Balls.
                (3, 3) => add_square::<3, 4, 6>(a, b, out),
                _ => add_block(a, b, out),
            }
        }
    }
}

/// Inverse of I_g = Σ Ī_k (|e_k|² I − e_k e_kᵀ), with `regularization` added to its diagonal.
pub(super) fn inverse_inertia(
    q: &NaturalCoordinates,
    ibar: &Vector3<f64>,
    regularization: f64,
) -> Matrix3<f64> {
    let mut inertia = Matrix3::from_diagonal_element(regularization);
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
