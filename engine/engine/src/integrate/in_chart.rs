//! Integration in independent coordinates: any method for ordinary differential equations, applied to (η, η̇) of a
//! [`Chart`]. The constraints of position and velocity hold at every stage and at every output.

mod chart;

pub use chart::{Chart, Guess, IndependentCoordinates};

use super::hermite;
use super::power::power;
use super::step::{StepRecord, StopReason};
use super::stepper::{OdeMethod, Stepper};
use triad_dynamics::constraints::mechanism::Mechanism;
use triad_dynamics::ode::OdeSystem;

/// The mechanism in the coordinates of a chart.
struct InCoordinates<'a> {
    mechanism: &'a mut Mechanism,
    chart: &'a Chart,
    guess: &'a mut Guess,
    /// What was found at the stages of an implicit step.
    at_stages: &'a mut Vec<Guess>,
    /// The stage that is evaluated next.
    stage: Option<usize>,
    y: &'a mut [f64],
    rate: &'a mut [f64],
}

impl OdeSystem for InCoordinates<'_> {
    fn rhs(&mut self, t: f64, x: &[f64], rate: &mut [f64]) {
        let f = self.chart.freedoms();
        let found = match self.stage.take().and_then(|stage| self.at_stages.get_mut(stage)) {
            Some(guess) => {
                let found = self.chart.find_state(self.mechanism, t, x, guess, self.y);
                self.guess.share_slowness(guess);
                found
            }
            None => self.chart.find_state(self.mechanism, t, x, self.guess, self.y),
        };
        if !found {
            // A step that leaves the chart is too long.
            rate.fill(f64::NAN);
            return;
        }
        self.mechanism.rhs(t, self.y, self.rate);
        rate[..f].copy_from_slice(&x[f..]);
        self.chart.accelerations(&self.rate[self.mechanism.system.coordinates..], &mut rate[f..]);
    }

    /// A stage is first sought from the one before it, then from where it was found.
    fn begin_stage(&mut self, stage: usize, first: bool) {
        self.stage = Some(stage);
        while self.at_stages.len() <= stage {
            self.at_stages.push(self.guess.clone());
        }
        if first {
            let (before, rest) = self.at_stages.split_at_mut(stage);
            if let Some(guess) = rest.first_mut() {
                guess.copy_from(before.last().unwrap_or(self.guess));
            }
        }
    }

    fn power(&self) -> Option<f64> {
        let Mechanism { system, state, elimination, .. } = &*self.mechanism;
        (!system.is_conservative()).then(|| power(&elimination.last_accelerations(system, state).multipliers))
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
    at_stages: Vec<Guess>,
    last: StepRecord,
    /// State at the start of the last step.
    y_old: Vec<f64>,
    /// x of the chart, a state and a rate of the mechanism.
    x: Vec<f64>,
    y: Vec<f64>,
    rate: Vec<f64>,
}

impl<M: OdeMethod> InChart<M> {
    /// Starts at the consistent state y, about which the chart was taken, with the method that `start` makes.
    pub fn new(
        (chart, mut guess): (Chart, Guess),
        mechanism: &mut Mechanism,
        t: f64,
        y: &[f64],
        start: impl FnOnce(&mut dyn OdeSystem, &[f64]) -> M,
    ) -> Self {
        let mut x = vec![0.0; 2 * chart.freedoms()];
        chart.coordinates(y, &mut x);
        let last = StepRecord::new(t, y);
        let (mut y, mut rate) = (y.to_vec(), y.to_vec());
        let mut at_stages = Vec::new();
        let mut system = InCoordinates {
            mechanism,
            chart: &chart,
            guess: &mut guess,
            at_stages: &mut at_stages,
            stage: None,
            y: &mut y,
            rate: &mut rate,
        };
        let method = start(&mut system, &x);
        Self { method, chart, guess, at_stages, y_old: last.y.clone(), last, x, y, rate }
    }

    /// How often independent coordinates were chosen.
    pub fn choices(&self) -> u64 {
        self.chart.choices
    }

    /// Takes the chart at the current state, and restarts the method if its coordinates are others then. `just_stepped` says that
    /// what was found at stages belongs to the last accepted step.
    fn renew(&mut self, mechanism: &mut Mechanism, just_stepped: bool) -> Result<(), StopReason> {
        let time = self.method.last().t;
        let choices = self.chart.choices;
        if !self.chart.take(mechanism, time, &self.last.y, &mut self.guess) {
            return Err(StopReason::Undetermined { time });
        }
        if self.chart.choices != choices {
            self.chart.coordinates(&self.last.y, &mut self.x);
            let mut step = Vec::new();
            if just_stepped {
                let mut start = vec![0.0; self.x.len()];
                self.chart.coordinates(&self.y_old, &mut start);
                step.push(start);
                step.extend(self.at_stages.iter().map(|stage| self.chart.coordinates_of(stage)));
            }
            let Self { method, chart, guess, at_stages, y, rate, x, .. } = self;
            let mut system = InCoordinates { mechanism, chart, guess, at_stages, stage: None, y, rate };
            method.restart(&mut system, x, &step);
        }
        Ok(())
    }

    fn advance(&mut self, mechanism: &mut Mechanism, end: f64) -> Result<(), StopReason> {
        let Self { method, chart, guess, at_stages, y, rate, .. } = self;
        method.step(&mut InCoordinates { mechanism, chart, guess, at_stages, stage: None, y, rate }, end)
    }

    fn take_step(&mut self, mechanism: &mut Mechanism, end: f64) -> Result<(), StopReason> {
        if self.chart.needs_refresh(&self.guess) {
            self.renew(mechanism, self.method.last().h > 0.0)?;
        }
        self.y_old.copy_from_slice(&self.last.y);
        let mut result = self.advance(mechanism, end);
        if result.is_err() {
            // Another chart may reach where this one ends.
            self.renew(mechanism, false)?;
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
        let Self { method, chart, at_stages, y: scratch, rate, x, .. } = self;
        let guess = &mut guess;
        let mut system = InCoordinates { mechanism, chart, guess, at_stages, stage: None, y: scratch, rate };
        method.interpolate(&mut system, t, x);
        if !chart.find_state(mechanism, t, x, guess, y) {
            self.interpolate_ends(t, y);
        }
    }

    fn work_to(&self, t: f64) -> Option<f64> {
        self.method.work_to(t)
    }

    fn boxed(&self) -> Box<dyn Stepper> {
        Box::new(self.clone())
    }
}
