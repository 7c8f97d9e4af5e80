//! States between the ends of a step.

use super::{InChart, InCoordinates, write_state};
use crate::integrate::hermite;
use crate::integrate::step::StepRecord;
use crate::integrate::stepper::OdeMethod;
use triad_dynamics::constraints::mechanism::Mechanism;

/// Parts of a step beside a time without a state at which one is looked for.
const BESIDE: [f64; 3] = [1e-4, 1e-3, 1e-2];

impl<M: OdeMethod> InChart<M> {
    /// Finds the state at time t within the last step. False if there is none with these independent coordinates.
    pub(super) fn find_between(&mut self, mechanism: &mut Mechanism, t: f64, y: &mut [f64]) -> bool {
        // The guess of the run stays as it is: outputs between steps must not change the run.
        let mut guess = self.guess.clone();
        let Self { method, chart, guess_old, at_stages, x, .. } = self;
        let mut system = InCoordinates::new(mechanism, (chart, &mut guess, at_stages));
        system.start = Some(guess_old);
        method.interpolate(&mut system, t, x);
        let found = system.find(t, x);
        if found {
            write_state(mechanism, y);
        }
        found
    }

    /// The state at a time at which none is found, as in a singular position, from two that are found beside it. False if they are too
    /// far apart.
    pub(super) fn interpolate_beside(&mut self, mechanism: &mut Mechanism, t: f64, y: &mut [f64]) -> bool {
        let (mut before, mut after) = (y.to_vec(), y.to_vec());
        let StepRecord { t: end, h, .. } = self.last;
        BESIDE.into_iter().any(|part| {
            let [from, to] = [(t - part * h).max(end - h), (t + part * h).min(end)];
            let found = self.find_between(mechanism, from, &mut before)
                && (self.last.has_ended(to) || self.find_between(mechanism, to, &mut after));
            if self.last.has_ended(to) {
                after.copy_from_slice(&self.last.y);
            }
            if found {
                cubic([&before, &after], to - from, (t - from) / (to - from), y);
            }
            found
        })
    }

    /// The state at time t within the last step from those at its ends.
    pub(super) fn interpolate_ends(&self, t: f64, y: &mut [f64]) {
        let StepRecord { t: end, y: y_new, h, .. } = &self.last;
        cubic([&self.y_old, y_new], *h, 1.0 + (t - end) / h, y);
    }
}

/// The state at a part of the time between two, by cubics.
fn cubic(ends: [&[f64]; 2], h: f64, part: f64, y: &mut [f64]) {
    let n = y.len() / 2;
    for i in 0..n {
        let [from, to] = ends.map(|y| [y[i], y[n + i]]);
        (y[i], y[n + i]) = hermite::cubic(from, to, h, part);
    }
}
