//! The Jacobian matrix of a step, by differences.

use super::Radau;
use super::linear::RateJacobian;
use super::stages::scale;
use crate::integrate::step::StopReason;
use triad_dynamics::ode::OdeSystem;

/// Part of a step at which its Jacobian matrix is taken if none is known before: it differs least from those of all stages there.
const MIDDLE: f64 = 0.5;
/// The same where one is, on open trees: between the two it is nearly linear in time. Where loops are solved for, differences hold what the
/// search leaves, and coordinates are others before long.
const END: f64 = 1.0;

impl Radau {
    /// Columns of ∂η̈/∂(η, η̇) by differences, in the middle of the step that is to come, or at its end, where the last one foresees
    /// it, and where there are states, else at its start.
    pub(super) fn differentiate(&mut self, system: &mut impl OdeSystem) -> Result<(), StopReason> {
        let mut at = self.last.y.clone();
        let follows = system.solves_nothing();
        let part = if follows && self.jacobian.valid { END } else { MIDDLE };
        let start = self.last.t;
        let [mut t, middle] = [part, MIDDLE].map(|part| start + part * self.h);
        let foreseen =
            self.stages.foresee(&self.last, self.h, part, &mut at) && self.differentiate_at(system, t, &at);
        if !foreseen {
            t = start;
            at.copy_from_slice(&self.last.y);
            if !self.differentiate_at(system, t, &at) {
                return Err(self.last.not_finite());
            }
        }
        if follows {
            self.jacobian.take_at(t, middle, self.h);
        }
        (self.jacobian.fresh, self.jacobian.valid) = (true, true);
        self.factors = None;
        Ok(())
    }

    /// The same at (t, x). False if a column is not finite.
    fn differentiate_at(&mut self, system: &mut impl OdeSystem, t: f64, x: &[f64]) -> bool {
        let (n, f) = (x.len(), x.len() / 2);
        let mut at_rest = vec![0.0; n];
        self.trial.copy_from_slice(x);
        system.rhs(t, x, &mut at_rest);
        // Rates first: they leave the positions as they are.
        (f..n).chain(0..f).all(|place| {
            // In the size in which errors are measured: x itself may be rounding of zero.
            let step = f64::EPSILON.sqrt() / scale(place, n, x[place], 1.0);
            self.trial[place] = x[place] + step;
            let step = self.trial[place] - x[place];
            if place < f {
                system.rhs(t, &self.trial, &mut self.trial_rate);
            } else {
                system.rhs_at_rates(t, &self.trial, &mut self.trial_rate);
            }
            self.trial[place] = x[place];
            let RateJacobian { stiffness, damping, .. } = &mut self.jacobian;
            let mut column =
                if place < f { stiffness.column_mut(place) } else { damping.column_mut(place - f) };
            for i in 0..f {
                column[i] = (self.trial_rate[f + i] - at_rest[f + i]) / step;
            }
            column.iter().all(|x| x.is_finite())
        })
    }
}
