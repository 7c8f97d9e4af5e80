//! The rows of joints on series: what they demand of the next coefficients and the forces that their multipliers make.

use super::points::{NOWHERE, holds_points};
use crate::dynamics::series::bodies::LanePlace;
use crate::dynamics::series::lanes::{Lane, LaneVector, add_dot, dot, scaled};
use crate::system::System;
use crate::system::feature::{Difference, Target};
use crate::system::index::FeatureId;
use crate::system::row::Form;
use nalgebra::Vector3;
use triad_linalg::{BlockCholesky, orthonormal_basis};

/// a − b = 0 for points.
#[derive(Clone, Copy, Debug)]
pub struct Coincidence {
    a: LanePlace,
    b: LanePlace,
    row: usize,
}

/// a − b = 0 for unit vectors, kept across the vector's direction at the point of expansion.
#[derive(Clone, Copy, Debug)]
pub struct CommonVector {
    a: LanePlace,
    b: LanePlace,
    row: usize,
    /// Its place among the system's rows.
    pub index: usize,
    /// The two directions where S was factored last.
    pub across: [[f64; 3]; 2],
    /// The two directions that the series at hand are written in.
    pub expanded: [[f64; 3]; 2],
}

/// L rows x · y − c = 0.
#[derive(Clone, Debug)]
pub struct Product<const L: usize> {
    /// Minuend and subtrahend of x and of y, lane by lane.
    factors: [[[LanePlace; L]; 2]; 2],
    /// Solver rows, as many as there are.
    rows: Vec<usize>,
    constant: Lane<L>,
}

/// All rows, sorted by form, with the series that convolutions need.
#[derive(Clone, Debug)]
pub struct Rows<const L: usize> {
    coincidences: Vec<Coincidence>,
    /// Those that [`super::JointPoints`] do not see to.
    driven: Vec<Coincidence>,
    /// Rows of common vectors.
    pub commons: Vec<CommonVector>,
    products: Vec<Product<L>>,
    /// Coefficients of (x, y) and of λ of each product, `stride` for each.
    factors: Vec<[LaneVector<L>; 2]>,
    lambda: Vec<Lane<L>>,
    stride: usize,
    /// What each solver row demands beyond the unknowns: Σ x(i) · y(n−i), Φ or Φ̇.
    pub extra: Vec<f64>,
}

impl<const L: usize> Rows<L> {
    /// Sorts the rows of a system; `place` tells where features stand, `nowhere` is a feature that is always zero, and `factor`
    /// where solver rows stand.
    pub fn new(
        system: &System,
        place: &[LanePlace],
        nowhere: LanePlace,
        factor: &BlockCholesky,
        stride: usize,
    ) -> Self {
        let mut rows = Self {
            coincidences: Vec::new(),
            driven: Vec::new(),
            commons: Vec::new(),
            products: Vec::new(),
            factors: Vec::new(),
            lambda: Vec::new(),
            stride,
            extra: vec![0.0; factor.numbers() + NOWHERE],
        };
        let at = |f: FeatureId| place[f.index()];
        let pair = |d: Difference| [at(d.plus), d.minus.map_or(nowhere, at)];
        for (index, form) in system.rows.iter().enumerate() {
            let row = factor.places()[form.solver];
            match form.form {
                Form::Coincidence { a, b } => {
                    let coincidence = Coincidence { a: at(a), b: at(b), row };
                    rows.coincidences.push(coincidence);
                    if !holds_points(system, &form.form) {
                        rows.driven.push(coincidence);
                    }
                }
                Form::CommonVector { a, b } => {
                    let (a, b) = (at(a), at(b));
                    let (across, expanded) = ([[0.0; 3]; 2], [[0.0; 3]; 2]);
                    rows.commons.push(CommonVector { a, b, row, index, across, expanded });
                }
                Form::Product { a, b, target } => {
                    let constant = if let Target::Constant(c) = target { c } else { 0.0 };
                    rows.add_product([pair(a), pair(b)], row, constant, nowhere);
                }
                Form::Relation { .. } => {}
            }
        }
        rows.factors = vec![[[[0.0; L]; 3]; 2]; rows.products.len() * stride];
        rows.lambda = vec![[0.0; L]; rows.products.len() * stride];
        rows
    }

    fn add_product(&mut self, factors: [[LanePlace; 2]; 2], row: usize, constant: f64, nowhere: LanePlace) {
        if self.products.last().is_none_or(|p| p.rows.len() == L) {
            let factors = [[[nowhere; L]; 2]; 2];
            self.products.push(Product { factors, rows: Vec::with_capacity(L), constant: [0.0; L] });
        }
        let Some(product) = self.products.last_mut() else { return };
        let lane = product.rows.len();
        product.rows.push(row);
        product.constant[lane] = constant;
        for (own, given) in product.factors.iter_mut().flatten().zip(factors.as_flattened()) {
            own[lane] = *given;
        }
    }

    /// Whether there are rows that need convolutions.
    pub fn curved(&self) -> bool {
        !self.products.is_empty()
    }

    /// Directions across common vectors, from the features' values.
    #[inline(always)]
    pub fn turn_common_vectors(&mut self, values: &[LaneVector<L>]) {
        for row in &mut self.commons {
            let s = Vector3::from(row.a.get(values));
            row.across = orthonormal_basis(&(s / s.norm())).map(Into::into);
        }
    }

    /// Series are expanded in the directions at hand.
    #[inline(always)]
    pub fn keep_directions(&mut self) {
        for row in &mut self.commons {
            row.expanded = row.across;
        }
    }

    /// Stores x and y of order n from the features' coefficients.
    #[inline(always)]
    pub fn store_factors(&mut self, n: usize, values: &[LaneVector<L>]) {
        for (k, product) in self.products.iter().enumerate() {
            self.factors[k * self.stride + n] = product.factors(values);
        }
    }

    /// The extra terms of order n + 2 times κ: κ Σ x(i) · y(n+2−i) without the two ends.
    #[inline(always)]
    pub fn set_convolutions(&mut self, n: usize, kappa: f64) {
        for (k, product) in self.products.iter().enumerate() {
            let series = &self.factors[k * self.stride..(k + 1) * self.stride];
            let mut sum = [0.0; L];
            for i in 1..=n + 1 {
                add_dot(&mut sum, &series[i][0], &series[n + 2 - i][1]);
            }
            for (lane, &row) in product.rows.iter().enumerate() {
                self.extra[row] = kappa * sum[lane];
            }
        }
    }

    /// Generalized forces of order n that multipliers of lower order make.
    #[inline(always)]
    pub fn add_known_forces(&self, n: usize, forces: &mut [LaneVector<L>]) {
        for (k, product) in self.products.iter().enumerate() {
            let series = &self.factors[k * self.stride..(k + 1) * self.stride];
            let lambda = &self.lambda[k * self.stride..(k + 1) * self.stride];
            let mut sum = [[[0.0; L]; 3]; 2];
            for i in 1..=n {
                for side in 0..2 {
                    crate::dynamics::series::lanes::add_scaled(
                        &mut sum[side],
                        &lambda[n - i],
                        &series[i][1 - side],
                    );
                }
            }
            product.add_forces(&sum, forces);
        }
    }

    /// Extra terms Φ of a correction of positions.
    #[inline(always)]
    pub fn set_violation(&mut self, directions: usize, values: &[LaneVector<L>]) {
        self.set_linear(directions, values);
        for (k, product) in self.products.iter().enumerate() {
            let [x, y] = &self.factors[k * self.stride];
            let value = dot(x, y);
            for (lane, &row) in product.rows.iter().enumerate() {
                self.extra[row] = value[lane] - product.constant[lane];
            }
        }
    }

    /// Extra terms Φ̇ of a correction of velocities, from the features' rates.
    #[inline(always)]
    pub fn set_rate_violation(&mut self, directions: usize, values: &[LaneVector<L>]) {
        self.set_linear(directions, values);
        for (k, product) in self.products.iter().enumerate() {
            let [x, y] = &self.factors[k * self.stride];
            let [x_rate, y_rate] = product.factors(values);
            let mut rate = dot(x, &y_rate);
            add_dot(&mut rate, &x_rate, y);
            for (lane, &row) in product.rows.iter().enumerate() {
                self.extra[row] = rate[lane];
            }
        }
    }

    #[inline(always)]
    fn set_linear(&mut self, directions: usize, values: &[LaneVector<L>]) {
        for row in &self.coincidences {
            let (a, b) = (row.a.get(values), row.b.get(values));
            for c in 0..directions {
                self.extra[row.row + c] = a[c] - b[c];
            }
        }
        for row in &self.commons {
            let (a, b) = (row.a.get(values), row.b.get(values));
            for k in 0..2 {
                self.extra[row.row + k] = (0..3).map(|c| row.across[k][c] * (a[c] - b[c])).sum();
            }
        }
    }

    /// Forgets Φ and Φ̇: rows that are linear demand nothing extra of higher orders.
    pub fn clear_extra(&mut self) {
        self.extra.fill(0.0);
    }

    /// What is left of the rows, given the features' part of the unknown.
    #[inline(always)]
    pub fn residual(&self, directions: usize, values: &[LaneVector<L>], out: &mut [f64]) {
        for row in &self.driven {
            let (a, b) = (row.a.get(values), row.b.get(values));
            let extra = &self.extra[row.row..row.row + directions];
            let out = &mut out[row.row..row.row + directions];
            for c in 0..directions {
                out[c] = a[c] - b[c] + extra[c];
            }
        }
        for row in &self.commons {
            let (a, b) = (row.a.get(values), row.b.get(values));
            for k in 0..2 {
                let t = row.across[k];
                let sum = t[0] * (a[0] - b[0]) + t[1] * (a[1] - b[1]) + t[2] * (a[2] - b[2]);
                out[row.row + k] = sum + self.extra[row.row + k];
            }
        }
        for (k, product) in self.products.iter().enumerate() {
            let [x, y] = &self.factors[k * self.stride];
            let [x_new, y_new] = product.factors(values);
            let mut sum = dot(x, &y_new);
            add_dot(&mut sum, &x_new, y);
            for (lane, &row) in product.rows.iter().enumerate() {
                out[row] = sum[lane] + self.extra[row];
            }
        }
    }

    /// Generalized forces of multipliers of the current order.
    #[inline(always)]
    pub fn add_forces(&self, directions: usize, lambda: &[f64], forces: &mut [LaneVector<L>]) {
        for row in &self.driven {
            let lambda = &lambda[row.row..row.row + directions];
            let mut l = [0.0; 3];
            l[..directions].copy_from_slice(lambda);
            row.a.add(forces, [-l[0], -l[1], -l[2]]);
            row.b.add(forces, l);
        }
        for row in &self.commons {
            let l = &lambda[row.row..row.row + 2];
            let [t1, t2] = &row.across;
            let f = [0, 1, 2].map(|c| l[0] * t1[c] + l[1] * t2[c]);
            row.a.add(forces, f.map(|x| -x));
            row.b.add(forces, f);
        }
        for (k, product) in self.products.iter().enumerate() {
            let [x, y] = &self.factors[k * self.stride];
            let own = product.lanes_of(lambda);
            product.add_forces(&[scaled(&own, y), scaled(&own, x)], forces);
        }
    }

    /// Stores the multipliers of order n that convolutions need.
    #[inline(always)]
    pub fn store_multipliers(&mut self, n: usize, lambda: &[f64]) {
        for (k, product) in self.products.iter().enumerate() {
            self.lambda[k * self.stride + n] = product.lanes_of(lambda);
        }
    }

    /// The factors x and y of one product at the point of expansion.
    #[inline(always)]
    pub fn product_factors(&self, k: usize, lane: usize) -> [[f64; 3]; 2] {
        let [x, y] = &self.factors[k * self.stride];
        [x, y].map(|v| [v[0][lane], v[1][lane], v[2][lane]])
    }
}

impl<const L: usize> Product<L> {
    #[inline(always)]
    fn factors(&self, values: &[LaneVector<L>]) -> [LaneVector<L>; 2] {
        let mut out = [[[0.0; L]; 3]; 2];
        for (out, [plus, minus]) in out.iter_mut().zip(&self.factors) {
            for lane in 0..self.rows.len().min(L) {
                let (a, b) = (plus[lane].get(values), minus[lane].get(values));
                for c in 0..3 {
                    out[c][lane] = a[c] - b[c];
                }
            }
        }
        out
    }

    #[inline(always)]
    fn lanes_of(&self, x: &[f64]) -> Lane<L> {
        let mut out = [0.0; L];
        for (out, &row) in out.iter_mut().zip(&self.rows) {
            *out = x[row];
        }
        out
    }

    /// Adds −sum to the forces on the features of x and of y.
    #[inline(always)]
    fn add_forces(&self, sum: &[LaneVector<L>; 2], forces: &mut [LaneVector<L>]) {
        for (sum, [plus, minus]) in sum.iter().zip(&self.factors) {
            for lane in 0..self.rows.len().min(L) {
                let f = [sum[0][lane], sum[1][lane], sum[2][lane]];
                plus[lane].add(forces, f.map(|x| -x));
                minus[lane].add(forces, f);
            }
        }
    }
}
