//! Integration in independent coordinates: any method for ordinary differential equations, applied to (η, η̇) of a
//! [`Chart`]. The constraints of position and velocity hold at every stage and at every output.

use super::chart::{Chart, Choice};
use super::{Explicit, Plant, Radau, Stepper, Steps, Stop};
use std::fmt::Debug;
use triad_dynamics::constraints::mechanism::Mechanism;

/// A method for ordinary differential equations ẋ = f(t, x), x = (η, η̇).
pub trait Method: Clone + Debug + Send + Sync + 'static {
    /// End of the last step.
    fn time(&self) -> f64;
    /// State at the end of the last step.
    fn state(&self) -> &[f64];
    /// Size of the last step.
    fn last_step(&self) -> f64;
    /// Steps so far.
    fn steps(&self) -> Steps;
    /// Takes one accepted step, not beyond `end`.
    fn step(&mut self, plant: &mut impl Plant, end: f64) -> Result<(), Stop>;
    /// Writes x(t) within the last step.
    fn interpolate(&mut self, plant: &mut impl Plant, t: f64, x: &mut [f64]);
    /// Goes on from the same state in other coordinates.
    fn restart(&mut self, plant: &mut impl Plant, x: &[f64]);
}

macro_rules! method {
    ($name:ident) => {
        impl Method for $name {
            fn time(&self) -> f64 {
                self.time()
            }
            fn state(&self) -> &[f64] {
                self.state()
            }
            fn last_step(&self) -> f64 {
                self.last_step()
            }
            fn steps(&self) -> Steps {
                self.steps
            }
            fn step(&mut self, plant: &mut impl Plant, end: f64) -> Result<(), Stop> {
                self.step(plant, end)
            }
            fn interpolate(&mut self, plant: &mut impl Plant, t: f64, x: &mut [f64]) {
                self.interpolate(plant, t, x);
            }
            fn restart(&mut self, plant: &mut impl Plant, x: &[f64]) {
                self.restart(plant, x);
            }
        }
    };
}

method!(Explicit);
method!(Radau);

/// The mechanism in a chart.
struct Charted<'a> {
    mechanism: &'a mut Mechanism,
    chart: &'a mut Chart,
    y: &'a mut [f64],
    rate: &'a mut [f64],
}

impl Plant for Charted<'_> {
    fn rate(&mut self, t: f64, x: &[f64], rate: &mut [f64]) {
        let f = self.chart.freedoms();
        if !self.chart.lift(self.mechanism, t, x, self.y) {
            // A step that leaves the chart is too long.
            rate.fill(f64::NAN);
            return;
        }
        self.mechanism.rate(t, self.y, self.rate);
        rate[..f].copy_from_slice(&x[f..]);
        self.chart.accelerations(&self.rate[self.mechanism.system.coordinates..], &mut rate[f..]);
    }

    fn settle(&mut self, _: f64, _: &mut [f64], _: &mut [f64]) {
        // The end of the step was evaluated last: its angles are in place.
        self.mechanism.state.commit_revolutions();
    }
}

/// A method, the chart it works in, and the state of the mechanism.
#[derive(Clone, Debug)]
pub struct InChart<M> {
    method: M,
    chart: Chart,
    y: Vec<f64>,
    /// State at the start of the last step.
    y_old: Vec<f64>,
    /// x of the chart, a state and a rate of the mechanism.
    x: Vec<f64>,
    lifted: Vec<f64>,
    rate: Vec<f64>,
}

impl<M: Method> InChart<M> {
    /// Starts at the consistent state y with the method that `start` makes.
    pub fn new(
        choice: Choice,
        mechanism: &mut Mechanism,
        t: f64,
        y: &[f64],
        start: impl FnOnce(&mut dyn Plant, &[f64]) -> M,
    ) -> Result<Self, Stop> {
        let undetermined = Stop::Undetermined { time: t };
        let mut chart = Chart::new(choice, mechanism, t, y).ok_or(undetermined)?;
        if chart.freedoms() == 0 {
            return Err(undetermined);
        }
        let mut x = vec![0.0; 2 * chart.freedoms()];
        chart.coordinates(y, &mut x);
        let (mut lifted, mut rate) = (y.to_vec(), y.to_vec());
        let mut plant = Charted { mechanism, chart: &mut chart, y: &mut lifted, rate: &mut rate };
        let method = start(&mut plant, &x);
        Ok(Self { method, chart, y: y.to_vec(), y_old: y.to_vec(), x, lifted, rate })
    }

    /// How often independent coordinates were chosen.
    pub fn choices(&self) -> u64 {
        self.chart.choices
    }

    /// Takes the chart at the state in hand, and tells the method if its coordinates are others then.
    fn renew(&mut self, mechanism: &mut Mechanism) -> Result<(), Stop> {
        let time = self.method.time();
        let choices = self.chart.choices;
        if !self.chart.take(mechanism, time, &self.y) {
            return Err(Stop::Undetermined { time });
        }
        if self.chart.choices != choices {
            self.chart.coordinates(&self.y, &mut self.x);
            let Self { method, chart, lifted, rate, x, .. } = self;
            method.restart(&mut Charted { mechanism, chart, y: lifted, rate }, x);
        }
        Ok(())
    }
}

impl<M: Method> Stepper for InChart<M> {
    fn time(&self) -> f64 {
        self.method.time()
    }

    fn state(&self) -> &[f64] {
        &self.y
    }

    fn last_step(&self) -> f64 {
        self.method.last_step()
    }

    fn steps(&self) -> Steps {
        self.method.steps()
    }

    fn step(&mut self, mechanism: &mut Mechanism, end: f64) -> Result<(), Stop> {
        if self.chart.is_worn() {
            self.renew(mechanism)?;
        }
        self.y_old.copy_from_slice(&self.y);
        let mut result = self.advance(mechanism, end);
        if result.is_err() {
            // Another chart may reach where this one ends.
            self.renew(mechanism)?;
            result = self.advance(mechanism, end);
        }
        let Self { method, chart, y, .. } = self;
        let (time, step) = (method.time(), method.last_step());
        match result {
            Ok(()) if chart.lift(mechanism, time, method.state(), y) => Ok(()),
            // What is not finite is a state that no lift has reached, in the chart of another position or in its own.
            Ok(()) | Err(Stop::NotFinite { .. }) if step > 0.0 => Err(Stop::NoConvergence { time, step }),
            Ok(()) | Err(Stop::NotFinite { .. }) => Err(Stop::Undetermined { time }),
            result => result,
        }
    }

    fn interpolate(&mut self, mechanism: &mut Mechanism, t: f64, y: &mut [f64]) {
        if t >= self.method.time() || self.method.last_step() == 0.0 {
            y.copy_from_slice(&self.y);
            return;
        }
        let mark = self.chart.mark();
        let Self { method, chart, lifted, rate, x, .. } = self;
        method.interpolate(&mut Charted { mechanism, chart, y: lifted, rate }, t, x);
        if !self.chart.lift(mechanism, t, &self.x, y) {
            self.between(t, y);
        }
        self.chart.come_back(mark);
    }

    fn boxed(&self) -> Box<dyn Stepper> {
        Box::new(self.clone())
    }
}

impl<M: Method> InChart<M> {
    /// The state at time t within the last step from those at its ends: by cubics, where no lift converges because the
    /// mechanism is about singular.
    fn between(&self, t: f64, y: &mut [f64]) {
        let n = y.len() / 2;
        let h = self.method.last_step();
        let s = 1.0 + (t - self.method.time()) / h;
        for i in 0..n {
            let (from, to) = (self.y_old[n + i], self.y[n + i]);
            let mean = (self.y[i] - self.y_old[i]) / h;
            let (c2, c3) = (3.0 * mean - 2.0 * from - to, from + to - 2.0 * mean);
            y[i] = self.y_old[i] + h * s * (from + s * (c2 + s * c3));
            y[n + i] = from + s * (2.0 * c2 + s * 3.0 * c3);
        }
    }

    fn advance(&mut self, mechanism: &mut Mechanism, end: f64) -> Result<(), Stop> {
        let Self { method, chart, lifted, rate, .. } = self;
        method.step(&mut Charted { mechanism, chart, y: lifted, rate }, end)
    }
}
