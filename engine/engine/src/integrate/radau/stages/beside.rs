//! The stages of a step that another run has taken with fewer of them.

use super::{DIVERGING, DIVERGING_AT_FIRST, ROUNDING, Stages, combine, rows};
use crate::integrate::radau::factors::Factors;
use crate::integrate::radau::linear::RateJacobian;
use crate::integrate::step::StepRecord;
use nalgebra::DMatrix;
use triad_dynamics::ode::OdeSystem;

/// What Newton's method may leave of the difference of two runs: a part of its first correction within the step, and a part of the
/// difference at its end; and its iterations at most. What is left adds up, and where a load is stiff a little of it makes more: ten
/// times as much is a fifth cheaper, but then half of the estimates of a governor that starts from rest are not within a factor of three.
const LEFT_WITHIN: f64 = 1e-3;
const LEFT_AT_END: f64 = 1e-2;
/// The same as a part of the tolerance of this run: as the difference grows with the time, more would be another error in each step.
const LEFT: f64 = 1e-2;
/// The least that can be asked for: rounding is near.
const LEAST: f64 = 1e-12;
const MOST_BESIDE: usize = 8;

impl Stages {
    /// Solves for the stages of a step that another run has taken with stages of its own, from the polynomial through those: what
    /// is left to find is the difference of the two. `between` has the weights of the other's stages for each of these, `end` is
    /// where the other one came to. False if it is not found.
    pub fn solve_beside(
        &mut self,
        system: &mut impl OdeSystem,
        last: &StepRecord,
        (jacobian, factors): (&RateJacobian, &mut Factors),
        (other, between, end): (&Self, &DMatrix<f64>, &[f64]),
        tolerance: f64,
    ) -> bool {
        let enough = (LEFT * tolerance).max(LEAST);
        combine(between, &rows(&other.z_old), &mut self.z);
        self.turn_over();
        self.set_scale(last, 1.0);
        self.updates.restart();
        let (mut first, mut before) = (0.0, 0.0f64);
        for iteration in 0..MOST_BESIDE {
            let Some(size) = self.find_correction(system, last, (jacobian, factors), iteration == 0) else {
                return false;
            };
            if let Some(reached) = self.z.last() {
                self.trial.copy_from_slice(reached);
            }
            self.apply();
            let rate = size / before;
            if iteration == 0 {
                first = size;
            } else if rate.is_nan() || rate >= DIVERGING_AT_FIRST {
                return false;
            } else if rate < DIVERGING {
                let left = rate / (1.0 - rate);
                if left * size <= enough.min(LEFT_WITHIN * first)
                    && self.knows_difference(last, end, left, enough)
                {
                    return true;
                }
            }
            if size <= ROUNDING.0 {
                return true;
            }
            before = size.max(f64::MIN_POSITIVE);
        }
        false
    }

    /// Whether the part `left` of the last correction of the end, which was `trial` before, is small beside its difference from the other
    /// run's, in coordinates and in rates.
    fn knows_difference(&self, last: &StepRecord, end: &[f64], left: f64, enough: f64) -> bool {
        let Some(z) = self.z.last() else { return false };
        let f = z.len() / 2;
        [0..f, f..2 * f].into_iter().all(|half| {
            let (mut corrected, mut apart) = (0.0, 0.0);
            for i in half {
                let (change, difference) = (z[i] - self.trial[i], last.y[i] + z[i] - end[i]);
                let squares = [change, difference].map(|x| x * self.scale[i] * (x * self.scale[i]));
                corrected += squares[0];
                apart += squares[1];
            }
            left * corrected.sqrt() <= (LEFT_AT_END * apart.sqrt()).min(enough * (f as f64).sqrt())
        })
    }
}
