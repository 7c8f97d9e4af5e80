//! The recurrence over the orders: from all coefficients before them to Q_(n+2) and λ_n.

use super::answer::Answer;
use super::lanes::{raise_whole, times};
use super::recurrence::acceleration_factor;
use super::regularization::{InertiaRegularization, Regularizing, Stage};
use super::{Bodies, Series};
use pulp::{Simd, WithSimd};
use triad_linalg::{fma, larger};

/// Iterative refinements of a solution with the factor of a regularized S, which take its effect out again.
const REFINEMENTS: usize = 2;

impl<const L: usize, B: Bodies<L>> Series<L, B> {
    /// Expands the motion about the state up to Q_order and λ_(order−2), with the present factor of S, or up to the
    /// first order that is `enough`. Returns the order.
    #[inline(always)]
    pub fn expand<S: Simd>(&mut self, simd: S, order: usize, enough: impl Fn(&Self, usize) -> bool) -> usize {
        self.begin_expansion(simd);
        let order = order.min(self.stride - 1);
        let first = usize::from(self.recall_evaluation());
        for n in first..order.max(2) - 1 {
            self.solve_order(simd, n);
            if enough(self, n + 2) {
                return n + 2;
            }
        }
        order
    }

    /// Takes over the state as the terms of orders 0 and 1.
    #[inline(always)]
    pub fn begin_expansion<S: Simd>(&mut self, simd: S) {
        for (b, state) in self.state.iter().enumerate() {
            self.q[b * self.stride..b * self.stride + 2].copy_from_slice(state);
        }
        if self.needs_values {
            self.place_values();
            self.store_values(simd, 0);
            self.points.take_factors(self.rows.numbers(), &self.rows.commons);
            self.values_of(|state, _| state[1]);
            self.set_ground(false);
            self.prepare_prescribed(1, 1.0);
            self.prescribed.add_known(1.0, &mut self.values);
            self.store_values(simd, 1);
        } else if self.points.has_vectors() {
            // Products would ask for values.
            self.points.take_factors(&[], &self.rows.commons);
        }
        self.rows.clear_extra();
        self.rows.keep_directions();
        self.counters.evaluations += 1;
    }

    /// Q_(n+2) of bodies that have nothing to do with each other. Returns whether it is known.
    #[inline(always)]
    fn solve_alone<S: Simd>(&mut self, simd: S, n: usize) -> bool {
        let mut largest = [0.0; 4];
        let mut rest = &mut self.q[..];
        for bundle in &mut self.bundles {
            let (q, others) = rest.split_at_mut(self.stride);
            rest = others;
            let Some(next) = bundle.alone(simd, q, n) else { return false };
            // Before it is stored: numbers stored one by one are slow to read back in one piece.
            for next in B::fours(&next) {
                raise_whole(simd, &mut largest, next);
            }
            q[n + 2] = next;
        }
        self.sizes[n + 2] = largest.into_iter().fold(0.0, larger);
        true
    }

    /// Q_(n+2) and λ_n from all coefficients before them — eq. (11.2).
    #[inline(always)]
    pub(super) fn solve_order<S: Simd>(&mut self, simd: S, n: usize) {
        if self.is_bare() && self.regularization.is_none() && self.solve_alone(simd, n) {
            return;
        }
        let kappa = acceleration_factor(n);
        let over_kappa = 1.0 / kappa;
        let needs_values = self.needs_values;
        let mut regularization = self.regularization.take();
        if let Some(regularization) = &mut regularization {
            simd.vectorize(Regularizing { series: self, regularization, n, stage: Stage::Prepare });
        }
        for bundle in &mut self.bundles {
            bundle.clear_force();
            if n == 0 {
                bundle.add_weight();
            }
        }
        if needs_values {
            self.demand(simd, n, kappa);
            self.set_known_forces(simd, n);
        }
        // No chunks: their number would be found by divisions.
        let (mut rest, mut rest_of_p) = (&self.q[..], &self.p[..]);
        for bundle in &mut self.bundles {
            let ((q, others), (p, others_of_p)) =
                (rest.split_at(self.stride), rest_of_p.split_at(self.stride));
            (rest, rest_of_p) = (others, others_of_p);
            bundle.begin(simd, &q[0], &B::gram(simd, q, n + 2, kappa), B::moment(simd, q, p, n));
        }
        if needs_values {
            self.prepare_prescribed(n + 2, kappa);
        }
        if let Some(regularization) = &mut regularization {
            simd.vectorize(Regularizing { series: self, regularization, n, stage: Stage::TurnOn });
        }
        self.solve(simd, regularization.as_deref_mut(), n);
        if let Some(regularization) = &mut regularization {
            simd.vectorize(Regularizing { series: self, regularization, n, stage: Stage::Store });
        }
        self.regularization = regularization;
        let mut largest = [0.0; 4];
        for (b, bundle) in self.bundles.iter().enumerate() {
            let at = b * self.stride + n;
            take_solution::<S, L, B>(simd, bundle, over_kappa, &mut self.q[at + 2], &mut largest);
            self.p[at] = bundle.director_forces(simd);
        }
        self.sizes[n + 2] = largest.into_iter().fold(0.0, larger);
        if needs_values {
            let rows = self.correction.len();
            let lambda = &self.lambda[n * rows..(n + 1) * rows];
            self.rows.store_multipliers(n, lambda);
            self.angles.store_multipliers(n, lambda);
            for b in 0..self.bundles.len() {
                for &slot in self.points.convolved(b) {
                    self.values[slot] = B::value(&self.slots[slot], &self.q[b * self.stride + n + 2]);
                }
            }
            self.prescribed.add_known(over_kappa, &mut self.values);
            self.store_values(simd, n + 2);
        }
    }

    /// Whether no row and no load asks for any feature: nothing but bodies on pivots of the ground, and free ones.
    #[inline(always)]
    pub(super) fn is_bare(&self) -> bool {
        self.schur.factor.numbers() == 0 && !self.needs_values
    }

    /// Takes over coefficient m of all features.
    #[inline(always)]
    fn store_values<S: Simd>(&mut self, simd: S, m: usize) {
        self.rows.store_factors(m, &self.values);
        self.angles.store(simd, m, &self.values);
        self.loads.store(m, &self.values, &self.angles.list);
    }

    /// Adds the joints' forces to the solutions that bodies have without them; λ goes to order n.
    #[inline(always)]
    pub(super) fn solve<S: Simd>(
        &mut self,
        simd: S,
        regularization: Option<&mut InertiaRegularization<L, B>>,
        n: usize,
    ) {
        let rows = self.correction.len();
        if self.schur.factor.numbers() == 0 && regularization.is_none() {
            return;
        }
        if self.points.has_others() {
            self.set_ground(false);
        }
        self.answer(simd);
        self.lambda[n * rows..(n + 1) * rows].copy_from_slice(&self.correction);
        if let Some(regularization) = regularization {
            // Moments over δ are large, and so is their rounding beside what joints leave of them.
            self.refine(simd, n);
            simd.vectorize(Regularizing { series: self, regularization, n, stage: Stage::Return });
        }
        for _ in 0..self.refinements() {
            self.refine(simd, n);
        }
        if self.points.has_others() && !self.prescribed.is_empty() {
            let lambda = std::mem::take(&mut self.lambda);
            self.set_multipliers_forces(&lambda[n * rows..(n + 1) * rows]);
            self.lambda = lambda;
            self.prescribed.add_forces(n, &self.forces);
        }
    }

    /// Adds to the solution of order n what answers to what rounding has left of the rows.
    #[inline(always)]
    pub(super) fn refine<S: Simd>(&mut self, simd: S, n: usize) {
        simd.vectorize(Answer(self));
        let rows = self.correction.len();
        for (lambda, correction) in self.lambda[n * rows..(n + 1) * rows].iter_mut().zip(&self.correction) {
            *lambda += correction;
        }
    }

    /// How often a solution is refined.
    #[inline(always)]
    pub(super) fn refinements(&self) -> usize {
        let refines = self.regularized || self.pivots.small || (self.resolving && !self.corrects_only);
        if refines { REFINEMENTS } else { 0 }
    }

    /// Moves the point of expansion to the series' value after h, with terms up to order `order`.
    #[inline(always)]
    pub fn advance(&mut self, h: f64, order: usize) {
        self.angles.advance(h, order);
        for (b, state) in self.state.iter_mut().enumerate() {
            *state = horner::<L, B>(&self.q[b * self.stride..=b * self.stride + order], h);
        }
    }
}

/// Takes over what a bundle has found, times 1/κ, as its next coefficient, and raises the largest numbers to those in it: four at a
/// time, whatever they belong to.
#[inline(always)]
fn take_solution<S: Simd, const L: usize, B: Bodies<L>>(
    simd: S,
    bundle: &B,
    over_kappa: f64,
    next: &mut B::Natural,
    largest: &mut [f64; 4],
) {
    for (q, a) in B::fours_mut(next).iter_mut().zip(B::fours(bundle.solution())) {
        *q = times(a, &[over_kappa; 4]);
        raise_whole(simd, largest, q);
    }
}

/// Value and derivative of a polynomial Σ Q_k τᵏ — eq. (11.1).
#[inline(always)]
fn horner<const L: usize, B: Bodies<L>>(coefficients: &[B::Natural], tau: f64) -> [B::Natural; 2] {
    let mut state = [B::ZERO; 2];
    let [value, rate] = &mut state;
    let (value, rate) = (B::lanes_mut(value), B::lanes_mut(rate));
    for coefficient in coefficients.iter().rev() {
        for ((value, rate), c) in value.iter_mut().zip(rate.iter_mut()).zip(B::lanes(coefficient)) {
            for l in 0..L {
                rate[l] = fma(rate[l], tau, value[l]);
                value[l] = fma(value[l], tau, c[l]);
            }
        }
    }
    state
}

/// The same on its own, to be compiled for each set of vector instructions.
pub(super) struct Value<'a, const L: usize, B: Bodies<L>> {
    pub coefficients: &'a [B::Natural],
    pub tau: f64,
}

impl<const L: usize, B: Bodies<L>> WithSimd for Value<'_, L, B> {
    type Output = [B::Natural; 2];

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> [B::Natural; 2] {
        horner::<L, B>(self.coefficients, self.tau)
    }
}
