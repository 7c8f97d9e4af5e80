//! The rows of joints on series: what they demand of the next coefficients and the forces that their multipliers make.

use super::commons::CommonVector;
use super::points::{NOWHERE, holds_points};
use super::vectors::{held_products, index, is_held};
use crate::dynamics::series::bodies::LanePlace;
use crate::dynamics::series::lanes::{Lane, LaneVector, add_dot, add_scaled, dot, plus, scaled, sum};
use crate::dynamics::series::recurrence::for_folded;
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

/// L rows x · y − c = 0.
#[derive(Clone, Debug)]
pub struct Product<const L: usize> {
    /// Where the first numbers of the minuend and of the subtrahend of x and of y stand among those of all features, lane by lane.
    factors: [[[u32; L]; 2]; 2],
    /// Whether x and y have subtrahends.
    differs: [bool; 2],
    /// Solver rows, as many as there are.
    rows: Vec<usize>,
    constant: Lane<L>,
    /// Whether [`super::JointPoints`] does not see to them, as something in them moves as prescribed.
    driven: bool,
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
    /// Those of the second kind of multipliers, if there are any: see [`Self::exchange_multipliers`].
    others: Vec<Lane<L>>,
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
            others: Vec::new(),
            stride,
            extra: vec![0.0; factor.numbers() + NOWHERE],
        };
        let at = |f: FeatureId| place[f.index()];
        let mut held = held_products(system, L).into_iter();
        let pair = |d: Difference| [at(d.plus), d.minus.map_or(nowhere, at)];
        for form in &system.rows {
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
                    let (solver, driven) = (form.solver, !is_held(system, &form.form));
                    rows.commons.push(CommonVector { a, b, row, solver, driven, across, expanded });
                }
                Form::Product { a, b, target } => {
                    let constant = if let Target::Constant(c) = target { c } else { 0.0 };
                    let driven = held.next() != Some(true);
                    rows.add_product([pair(a), pair(b)], row, constant, (nowhere, driven));
                }
                Form::Relation { .. } => {}
            }
        }
        rows.factors = vec![[[[0.0; L]; 3]; 2]; rows.products.len() * stride];
        rows.lambda = vec![[0.0; L]; rows.products.len() * stride];
        if system.regularizes_inertia() {
            rows.others.clone_from(&rows.lambda);
        }
        rows
    }

    fn add_product(
        &mut self,
        factors: [[LanePlace; 2]; 2],
        row: usize,
        constant: f64,
        (nowhere, driven): (LanePlace, bool),
    ) {
        let number = |place: LanePlace| index(place.slot * 3 * L + place.lane);
        if self.products.last().is_none_or(|p| p.rows.len() == L) {
            self.products.push(Product {
                factors: [[[number(nowhere); L]; 2]; 2],
                differs: [false; 2],
                rows: Vec::with_capacity(L),
                constant: [0.0; L],
                driven,
            });
        }
        let Some(product) = self.products.last_mut() else { return };
        let lane = product.rows.len();
        product.rows.push(row);
        product.constant[lane] = constant;
        for (own, given) in product.factors.iter_mut().flatten().zip(factors.as_flattened()) {
            own[lane] = number(*given);
        }
        for (differs, [_, minus]) in product.differs.iter_mut().zip(factors) {
            *differs |= minus.slot != nowhere.slot;
        }
    }

    /// Whether there are rows that need convolutions.
    pub fn curved(&self) -> bool {
        !self.products.is_empty()
    }

    /// The numbers of all factors.
    #[inline(always)]
    pub fn numbers(&self) -> &[f64] {
        self.factors.as_flattened().as_flattened().as_flattened()
    }

    /// Directions across common vectors, from the features' values.
    #[inline(always)]
    pub fn turn_common_vectors(&mut self, values: &[LaneVector<L>]) {
        for row in &mut self.commons {
            let s = Vector3::from(row.a.get(values));
            row.across = orthonormal_basis(&s).map(Into::into);
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
            let series = &self.factors[k * self.stride + 1..k * self.stride + n + 2];
            // For each component on its own, so that no sum waits for another.
            let mut sums = [[0.0; L]; 3];
            for_folded!(series, series, [x, _], [_, y] => {
                for c in 0..3 {
                    sums[c] = plus(&x[c], &y[c], &sums[c]);
                }
            });
            let [first, second, third] = &sums;
            let all = sum(&sum(first, second), third);
            for (all, &row) in all.iter().zip(&product.rows) {
                self.extra[row] = kappa * all;
            }
        }
    }

    /// Generalized forces of order n that multipliers of lower order make.
    #[inline(always)]
    pub fn add_known_forces(&self, n: usize, forces: &mut [LaneVector<L>]) {
        for (k, product) in self.products.iter().enumerate() {
            let series = &self.factors[k * self.stride + 1..=k * self.stride + n];
            let lambda = &self.lambda[k * self.stride..k * self.stride + n];
            let mut sum = [[[0.0; L]; 3]; 2];
            let [on_x, on_y] = &mut sum;
            for_folded!(series, lambda, [x, y], lambda => {
                add_scaled(on_x, lambda, y);
                add_scaled(on_y, lambda, x);
            });
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
        for row in self.commons.iter().filter(|row| row.driven) {
            let (a, b) = (row.a.get(values), row.b.get(values));
            for k in 0..2 {
                let t = row.across[k];
                let sum = t[0] * (a[0] - b[0]) + t[1] * (a[1] - b[1]) + t[2] * (a[2] - b[2]);
                out[row.row + k] = sum + self.extra[row.row + k];
            }
        }
        for (k, product) in self.products.iter().enumerate().filter(|(_, product)| product.driven) {
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
        for row in self.commons.iter().filter(|row| row.driven) {
            let l = &lambda[row.row..row.row + 2];
            let [t1, t2] = &row.across;
            let f = [0, 1, 2].map(|c| l[0] * t1[c] + l[1] * t2[c]);
            row.a.add(forces, f.map(|x| -x));
            row.b.add(forces, f);
        }
        for (k, product) in self.products.iter().enumerate().filter(|(_, product)| product.driven) {
            let [x, y] = &self.factors[k * self.stride];
            let own = product.lanes_of(lambda);
            product.add_forces(&[scaled(&own, y), scaled(&own, x)], forces);
        }
    }

    /// Has the second kind of multipliers in the place of the first, or the first in theirs again.
    pub fn exchange_multipliers(&mut self) {
        std::mem::swap(&mut self.lambda, &mut self.others);
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
        let numbers = values.as_flattened().as_flattened();
        let mut out = [[[0.0; L]; 3]; 2];
        for ((out, [plus, minus]), differs) in out.iter_mut().zip(&self.factors).zip(self.differs) {
            for (lane, &at) in plus.iter().enumerate() {
                let Some(x) = numbers.get(at as usize..=at as usize + 2 * L) else { continue };
                for c in 0..3 {
                    out[c][lane] = x[c * L];
                }
            }
            for (lane, &at) in minus.iter().enumerate().filter(|_| differs) {
                let Some(x) = numbers.get(at as usize..=at as usize + 2 * L) else { continue };
                for c in 0..3 {
                    out[c][lane] -= x[c * L];
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
        let numbers = forces.as_flattened_mut().as_flattened_mut();
        let used = self.rows.len();
        for ((sum, [plus, minus]), differs) in sum.iter().zip(&self.factors).zip(self.differs) {
            for (lane, &at) in plus.iter().enumerate().take(used) {
                let Some(x) = numbers.get_mut(at as usize..=at as usize + 2 * L) else { continue };
                for c in 0..3 {
                    x[c * L] -= sum[c][lane];
                }
            }
            for (lane, &at) in minus.iter().enumerate().take(if differs { used } else { 0 }) {
                let Some(x) = numbers.get_mut(at as usize..=at as usize + 2 * L) else { continue };
                for c in 0..3 {
                    x[c * L] += sum[c][lane];
                }
            }
        }
    }
}
