//! The correction of all stages by an iteration of Newton's method — eq. (10.6): with the factors of one Jacobian matrix, and once more
//! with what those of the stages have beside it, as far as that is linear in time.

use super::Stages;
use crate::integrate::radau::blocks::{NONE, Pair, add_product, less_product};
use crate::integrate::radau::factors::Factors;
use crate::integrate::radau::linear::RateJacobian;
use pulp::{Arch, Simd, WithSimd};

/// Finds a correction, for stages of a step from the time `start`.
struct Correct<'a> {
    stages: &'a mut Stages,
    start: f64,
    jacobian: &'a RateJacobian,
    factors: &'a mut Factors,
}

impl WithSimd for Correct<'_> {
    type Output = f64;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> f64 {
        let Self { stages, start, jacobian, factors } = self;
        let Stages { blocks, f, w, forward, changed, updates, scale, .. } = stages;
        let (groups, h) = (blocks.groups, factors.h);
        let rows = forward.chunks_exact_mut(groups).zip(w.chunks_exact(groups));
        // What the stages lack, f − A⁻¹ z / h.
        for (number, (row, w)) in rows.enumerate() {
            blocks.turn(f, number, row);
            // The large part last: it is rounded once.
            for (sum, (mu, w)) in row.iter_mut().zip(factors.mu().iter().zip(w)) {
                *sum = less_product(*sum, mu, w);
            }
        }
        let correction = updates.next();
        correction.copy_from_slice(forward);
        factors.solve(jacobian, correction);
        if let Some((at, change)) = jacobian.change() {
            changed.fill(NONE);
            for (matrix, rows) in change.iter().zip(correction.chunks_exact(changed.len())) {
                for group in 0..groups {
                    add_product((matrix.as_slice(), matrix.nrows()), rows, (group, groups), changed);
                }
            }
            let (_, rates) = forward.split_at_mut(changed.len());
            for (row, changed) in rates.chunks_exact_mut(groups).zip(changed.chunks_exact(groups)) {
                blocks.add_along([start - at, h], changed, row);
            }
            correction.copy_from_slice(forward);
            factors.solve(jacobian, correction);
        }
        updates.improve(scale, groups)
    }
}

/// Applies the improved correction.
struct Apply<'a>(&'a mut Stages);

impl WithSimd for Apply<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Stages { blocks, z, w, updates, .. } = self.0;
        for (w, correction) in w.as_flattened_mut().iter_mut().zip(updates.last().as_flattened()) {
            for (w, correction) in w.iter_mut().zip(correction) {
                *w += correction;
            }
        }
        for (number, row) in w.chunks_exact(blocks.groups).enumerate() {
            blocks.turn_back(row, number, z);
        }
    }
}

/// w = T⁻¹ z.
struct TurnOver<'a>(&'a mut Stages);

impl WithSimd for TurnOver<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Stages { blocks, z, w, .. } = self.0;
        for (number, row) in w.chunks_exact_mut(blocks.groups).enumerate() {
            blocks.turn(z, number, row);
        }
    }
}

/// (μ I − J)⁻¹ x with the real μ.
struct Filter<'a>(&'a mut [Pair], &'a RateJacobian, &'a mut Factors, &'a mut [f64]);

impl WithSimd for Filter<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self(rows, jacobian, factors, x) = self;
        rows.fill(NONE);
        let groups = factors.mu().len();
        for (row, x) in rows.iter_mut().step_by(groups).zip(&*x) {
            row[0][0] = *x;
        }
        factors.solve(jacobian, rows);
        for (row, x) in rows.iter().step_by(groups).zip(x) {
            *x = row[0][0];
        }
    }
}

impl Stages {
    /// Finds the correction of w, and its size.
    pub(super) fn correct(&mut self, start: f64, jacobian: &RateJacobian, factors: &mut Factors) -> f64 {
        Arch::new().dispatch(Correct { stages: self, start, jacobian, factors })
    }

    /// Applies the improved correction.
    pub(super) fn apply(&mut self) {
        Arch::new().dispatch(Apply(self));
    }

    /// w = T⁻¹ z.
    pub(super) fn turn_over(&mut self) {
        Arch::new().dispatch(TurnOver(self));
    }

    /// x ← (μ I − J)⁻¹ x with the real μ.
    pub fn filter(&mut self, jacobian: &RateJacobian, factors: &mut Factors, x: &mut [f64]) {
        Arch::new().dispatch(Filter(&mut self.forward, jacobian, factors, x));
    }
}
