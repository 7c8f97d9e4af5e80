//! The correction of all stages by an iteration of Newton's method — eq. (10.6): with the factors of one Jacobian matrix, and once more
//! with what those of the stages have beside it, as far as that is linear in time.

use super::{Stages, combine, rows};
use crate::integrate::radau::linear::{Factors, RateJacobian};
use crate::integrate::step::StepRecord;
use nalgebra::Complex;

impl Stages {
    /// Finds the correction of w.
    pub(super) fn correct(&mut self, last: &StepRecord, jacobian: &RateJacobian, factors: &mut Factors) {
        self.turn_defects(factors.h);
        self.beyond.iter_mut().for_each(|beyond| beyond.fill(0.0));
        self.solve_blocks(jacobian, factors);
        if jacobian.changes() {
            self.find_beyond(last, jacobian, factors.h);
            self.solve_blocks(jacobian, factors);
        }
    }

    /// What the stages lack, f − A⁻¹ z / h, in the coordinates of w.
    fn turn_defects(&mut self, h: f64) {
        let Self { method, f, w, forward, .. } = self;
        combine(&method.t_inverse, &rows(f), forward);
        for (x, w) in forward[0].iter_mut().zip(&w[0]) {
            *x -= method.tables.real / h * w;
        }
        for (place, eigenvalue) in method.tables.pairs.iter().enumerate() {
            let (k, mu) = (1 + 2 * place, eigenvalue / h);
            for i in 0..w[k].len() {
                let product = mu * Complex::new(w[k][i], w[k + 1][i]);
                forward[k][i] -= product.re;
                forward[k + 1][i] -= product.im;
            }
        }
    }

    /// What is beyond the common matrix at the stages, times the correction in the making.
    fn find_beyond(&mut self, last: &StepRecord, jacobian: &RateJacobian, h: f64) {
        let Self { method, f, changed, beyond, trial, updates, .. } = self;
        // f itself has been used: here it holds the correction of z.
        combine(&method.t, &updates.next().chunks_exact(trial.len()), f);
        for ((node, _), (z, changed)) in method.tables.nodes.iter().zip(f.iter().zip(&mut *changed)) {
            jacobian.changed(last.t + node * h, z, changed);
        }
        combine(&method.t_inverse, &rows(changed), beyond);
    }

    /// The correction by the common matrix, of what the stages lack and what is beyond it.
    fn solve_blocks(&mut self, jacobian: &RateJacobian, factors: &mut Factors) {
        let Self { method, forward, beyond, updates, trial, .. } = self;
        let (tables, n) = (method.tables, trial.len());
        let correction = updates.next();
        for (out, (forward, beyond)) in correction.chunks_exact_mut(n).zip(forward.iter().zip(beyond)) {
            out.copy_from_slice(forward);
            out[n / 2..].iter_mut().zip(beyond).for_each(|(out, beyond)| *out += *beyond);
        }
        let (real, pairs) = correction.split_at_mut(n);
        factors.solve_real(jacobian, tables, real);
        for (place, pair) in pairs.chunks_exact_mut(2 * n).enumerate() {
            factors.solve_pair(jacobian, tables, place, pair.split_at_mut(n).into());
        }
    }
}
