//! The Jacobian matrix of a step, by differences.

use super::Radau;
use super::linear::RateJacobian;
use super::stages::scale;
use crate::integrate::step::StopReason;
use nalgebra::DVectorViewMut;
use triad_dynamics::ode::{Many, OdeSystem, What};

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
        self.factors.forget();
        Ok(())
    }

    /// The same at (t, x). False if a column is not finite.
    fn differentiate_at(&mut self, system: &mut impl OdeSystem, t: f64, x: &[f64]) -> bool {
        let (n, f) = (x.len(), x.len() / 2);
        if self.evaluate_beside(system, t, x) {
            let Some((at_rest, rates)) = self.beside_states.rates.split_last() else { return false };
            return rates.iter().enumerate().all(|(place, rate)| {
                let step = self.beside_states.states[place][place] - x[place];
                let mut column = self.jacobian.column_mut(place);
                for i in 0..f {
                    column[i] = (rate[f + i] - at_rest[f + i]) / step;
                }
                column.iter().all(|x| x.is_finite())
            });
        }
        let mut at_rest = vec![0.0; n];
        self.trial.copy_from_slice(x);
        system.rhs(t, x, &mut at_rest);
        // Rates first: they leave the positions as they are.
        (f..n).chain(0..f).all(|place| {
            self.trial[place] = x[place] + step_of(place, x);
            let step = self.trial[place] - x[place];
            if place < f {
                system.rhs(t, &self.trial, &mut self.trial_rate);
            } else {
                system.rhs_at_rates(t, &self.trial, &mut self.trial_rate);
            }
            self.trial[place] = x[place];
            let mut column = self.jacobian.column_mut(place);
            for i in 0..f {
                column[i] = (self.trial_rate[f + i] - at_rest[f + i]) / step;
            }
            column.iter().all(|x| x.is_finite())
        })
    }

    /// Evaluates all states at once that are needed for it, (t, x) as the last one, if the system can.
    fn evaluate_beside(&mut self, system: &mut impl OdeSystem, t: f64, x: &[f64]) -> bool {
        let BesideStates { times, states, rates, power } = &mut self.beside_states;
        times.fill(t);
        for (place, state) in states.iter_mut().enumerate() {
            state.copy_from_slice(x);
            if place < x.len() {
                state[place] += step_of(place, x);
            }
        }
        system.rhs_of_many(Many { times, states, rates, power, what: What::Beside })
    }
}

/// States beside a given one, each in another number, and that one; and their ẏ.
#[derive(Clone, Debug)]
pub struct BesideStates {
    times: Vec<f64>,
    states: Vec<Vec<f64>>,
    rates: Vec<Vec<f64>>,
    power: Vec<f64>,
}

impl BesideStates {
    /// Allocates for n numbers.
    pub fn new(n: usize) -> Self {
        let states = vec![vec![0.0; n]; n + 1];
        Self { times: vec![0.0; n + 1], rates: states.clone(), states, power: vec![0.0; n + 1] }
    }
}

/// The step of a difference, in the size in which errors are measured: x itself may be rounding of zero.
fn step_of(place: usize, x: &[f64]) -> f64 {
    f64::EPSILON.sqrt() / scale(place, x.len(), x[place], 1.0)
}

impl RateJacobian {
    /// The column that tells of a number of (η, η̇).
    fn column_mut(&mut self, place: usize) -> DVectorViewMut<'_, f64> {
        let f = self.stiffness.ncols();
        if place < f { self.stiffness.column_mut(place) } else { self.damping.column_mut(place - f) }
    }
}
