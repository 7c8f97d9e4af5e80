//! Integration in independent coordinates: any method for ordinary differential equations, applied to (η, η̇) of a
//! [`Chart`]. The constraints of position and velocity hold at every stage and at every output.

mod chart;

pub use chart::{Chart, Guess, IndependentCoordinates};

use super::hermite;
use super::step::{StepRecord, StopReason};
use super::stepper::{OdeMethod, Stepper};
use triad_dynamics::constraints::mechanism::Mechanism;
use triad_dynamics::ode::OdeSystem;

/// The mechanism in the coordinates of a chart.
struct InCoordinates<'a> {
    mechanism: &'a mut Mechanism,
    chart: &'a Chart,
    guess: &'a mut Guess,
    y: &'a mut [f64],
    rate: &'a mut [f64],
}

impl OdeSystem for InCoordinates<'_> {
    fn rhs(&mut self, t: f64, x: &[f64], rate: &mut [f64]) {
        let f = self.chart.freedoms();
        if !self.chart.find_state(self.mechanism, t, x, self.guess, self.y) {
            // A step that leaves the chart is too long.
            rate.fill(f64::NAN);
            return;
        }
        self.mechanism.rhs(t, self.y, self.rate);
        rate[..f].copy_from_slice(&x[f..]);
        self.chart.accelerations(&self.rate[self.mechanism.system.coordinates..], &mut rate[f..]);
    }

    fn after_step(&mut self, _: f64, _: &mut [f64], _: &mut [f64]) {
        // The end of the step was evaluated last: its angles are in place.
        self.mechanism.state.commit_revolutions();
    }
}

/// A method, the chart it works in, and the state of the mechanism.
#[derive(Clone, Debug)]
pub struct InChart<M> {
    method: M,
    chart: Chart,
    guess: Guess,
    last: StepRecord,
    /// State at the start of the last step.
    y_old: Vec<f64>,
    /// x of the chart, a state and a rate of the mechanism.
    x: Vec<f64>,
    y: Vec<f64>,
    rate: Vec<f64>,
}

impl<M: OdeMethod> InChart<M> {
    /// Starts at the consistent state y with the method that `start` makes.
    ///
    /// # Errors
    ///
    /// [`StopReason::Undetermined`]: the free motions cannot be determined there, or nothing is free to move.
    pub fn new(
        coordinates: IndependentCoordinates,
        mechanism: &mut Mechanism,
        t: f64,
        y: &[f64],
        start: impl FnOnce(&mut dyn OdeSystem, &[f64]) -> M,
    ) -> Result<Self, StopReason> {
        let undetermined = StopReason::Undetermined { time: t };
        let (chart, mut guess) = Chart::new(coordinates, mechanism, t, y).ok_or(undetermined)?;
        if chart.freedoms() == 0 {
            return Err(undetermined);
        }
        let mut x = vec![0.0; 2 * chart.freedoms()];
        chart.coordinates(y, &mut x);
        let last = StepRecord::new(t, y);
        let (mut y, mut rate) = (y.to_vec(), y.to_vec());
        let mut system =
            InCoordinates { mechanism, chart: &chart, guess: &mut guess, y: &mut y, rate: &mut rate };
        let method = start(&mut system, &x);
        Ok(Self { method, chart, guess, y_old: last.y.clone(), last, x, y, rate })
    }

    /// How often independent coordinates were chosen.
    pub fn choices(&self) -> u64 {
        self.chart.choices
    }

    /// Takes the chart at the current state, and restarts the method if its coordinates are others then.
    fn renew(&mut self, mechanism: &mut Mechanism) -> Result<(), StopReason> {
        let time = self.method.last().t;
        let choices = self.chart.choices;
        if !self.chart.take(mechanism, time, &self.last.y, &mut self.guess) {
            return Err(StopReason::Undetermined { time });
        }
        if self.chart.choices != choices {
            self.chart.coordinates(&self.last.y, &mut self.x);
            let Self { method, chart, guess, y, rate, x, .. } = self;
            method.restart(&mut InCoordinates { mechanism, chart, guess, y, rate }, x);
        }
        Ok(())
    }

    fn advance(&mut self, mechanism: &mut Mechanism, end: f64) -> Result<(), StopReason> {
        let Self { method, chart, guess, y, rate, .. } = self;
        method.step(&mut InCoordinates { mechanism, chart, guess, y, rate }, end)
    }

    fn take_step(&mut self, mechanism: &mut Mechanism, end: f64) -> Result<(), StopReason> {
        if self.guess.needs_refresh() {
            self.renew(mechanism)?;
        }
        self.y_old.copy_from_slice(&self.last.y);
        let mut result = self.advance(mechanism, end);
        if result.is_err() {
            // Another chart may reach where this one ends.
            self.renew(mechanism)?;
            result = self.advance(mechanism, end);
        }
        let Self { method, chart, guess, last, .. } = self;
        let &StepRecord { t: time, h: step, y: ref x, .. } = method.last();
        match result {
            Ok(()) if chart.find_state(mechanism, time, x, guess, &mut last.y) => Ok(()),
            // A result that is not finite means that no state was found: far from the position of the chart, or at it.
            Ok(()) | Err(StopReason::NotFinite { .. }) if step > 0.0 => {
                Err(StopReason::NoConvergence { time, step })
            }
            Ok(()) | Err(StopReason::NotFinite { .. }) => Err(StopReason::Undetermined { time }),
            result => result,
        }
    }

    /// The state at time t within the last step from those at its ends: by cubics, where no state with the interpolated
    /// coordinates is found because the mechanism is near a singular configuration.
    fn interpolate_ends(&self, t: f64, y: &mut [f64]) {
        let n = y.len() / 2;
        let StepRecord { t: end, y: y_new, h, .. } = &self.last;
        let s = 1.0 + (t - end) / h;
        for i in 0..n {
            let ends = [&self.y_old, y_new].map(|y| [y[i], y[n + i]]);
            (y[i], y[n + i]) = hermite::cubic(ends[0], ends[1], *h, s);
        }
    }
}

impl<M: OdeMethod> Stepper for InChart<M> {
    fn last(&self) -> &StepRecord {
        &self.last
    }

    fn step(&mut self, mechanism: &mut Mechanism, end: f64) -> Result<(), StopReason> {
        let result = self.take_step(mechanism, end);
        let StepRecord { t, t_old, h, steps, .. } = *self.method.last();
        self.last = StepRecord { t, t_old, h, steps, y: std::mem::take(&mut self.last.y) };
        result
    }

    fn interpolate(&mut self, mechanism: &mut Mechanism, t: f64, y: &mut [f64]) {
        if self.last.has_ended(t) {
            y.copy_from_slice(&self.last.y);
            return;
        }
        // The guess of the run stays as it is: outputs between steps must not change the run.
        let mut guess = self.guess.clone();
        let Self { method, chart, y: scratch, rate, x, .. } = self;
        let mut system = InCoordinates { mechanism, chart, guess: &mut guess, y: scratch, rate };
        method.interpolate(&mut system, t, x);
        if !chart.find_state(mechanism, t, x, &mut guess, y) {
            self.interpolate_ends(t, y);
        }
    }

    fn boxed(&self) -> Box<dyn Stepper> {
        Box::new(self.clone())
    }
}
