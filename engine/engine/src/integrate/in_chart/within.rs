//! A method for ordinary differential equations, applied to (η, η̇) of a [`Chart`].

mod between;

use super::chart::Chart;
use super::guess::Guess;
use crate::integrate::power::{load_power, power};
use crate::integrate::step::{StepRecord, StopReason};
use crate::integrate::stepper::{OdeMethod, Stepper};
use std::fmt::Debug;
use triad_dynamics::constraints::mechanism::Mechanism;
use triad_dynamics::ode::{Many, OdeSystem, What};
use triad_dynamics::system::System;

/// The mechanism in the coordinates of a chart.
struct InCoordinates<'a> {
    mechanism: &'a mut Mechanism,
    chart: &'a mut Chart,
    guess: &'a mut Guess,
    /// What was found at the stages of an implicit step.
    at_stages: &'a mut Vec<Guess>,
    /// The stage that is evaluated next.
    stage: Option<usize>,
    /// The stage that was evaluated last.
    at: Option<usize>,
    /// What was found at the start of the last step, when states between its ends are asked for: each is sought from where it is nearest.
    start: Option<&'a Guess>,
    /// Whether the last evaluation found a state, which is in place then.
    found: bool,
}

impl<'a> InCoordinates<'a> {
    fn new(
        mechanism: &'a mut Mechanism,
        (chart, guess, at_stages): (&'a mut Chart, &'a mut Guess, &'a mut Vec<Guess>),
    ) -> Self {
        Self { mechanism, chart, guess, at_stages, stage: None, at: None, start: None, found: true }
    }

    /// Puts the mechanism into the state x and returns whether there is one; the search begins where the stage was found before.
    fn find(&mut self, t: f64, x: &[f64]) -> bool {
        let Self { mechanism, chart, at_stages, guess, .. } = self;
        self.at = self.stage.take().filter(|stage| *stage < at_stages.len());
        self.found = if let Some(at_stage) = self.at.and_then(|stage| at_stages.get_mut(stage)) {
            let found = chart.find_state(mechanism, t, x, at_stage);
            guess.share_slowness(at_stage);
            found
        } else {
            self.go_to_nearest(x);
            self.chart.find_state(self.mechanism, t, x, self.guess)
        };
        self.found
    }

    /// Between the ends of the last step, takes what was found nearest to x for the guess.
    fn go_to_nearest(&mut self, x: &[f64]) {
        let Some(start) = self.start else { return };
        let eta = &x[..self.chart.freedoms()];
        for known in self.at_stages.iter().chain([start]) {
            if known.distance(eta) < self.guess.distance(eta) {
                self.guess.copy_from(known);
            }
        }
    }

    /// The rate of x at the state in place; `moved` says that the positions are others than last time.
    fn write_rate(&mut self, x: &[f64], moved: bool, rate: &mut [f64]) {
        let guess = self.at.and_then(|stage| self.at_stages.get(stage)).unwrap_or(self.guess);
        let f = self.chart.freedoms();
        rate[..f].copy_from_slice(&x[f..]);
        self.chart.accelerate(self.mechanism, guess, moved, &mut rate[f..]);
    }
}

impl OdeSystem for InCoordinates<'_> {
    fn rhs(&mut self, t: f64, x: &[f64], rate: &mut [f64]) {
        if !self.find(t, x) {
            // A step that leaves the chart is too long.
            rate.fill(f64::NAN);
            return;
        }
        self.write_rate(x, true, rate);
    }

    fn rhs_at_rates(&mut self, _: f64, x: &[f64], rate: &mut [f64]) {
        self.at = None;
        if !self.found || !self.chart.find_velocity(self.mechanism, &x[self.chart.freedoms()..], self.guess) {
            rate.fill(f64::NAN);
            return;
        }
        self.write_rate(x, false, rate);
    }

    fn rhs_of_many(&mut self, mut of: Many) -> bool {
        let Mechanism { system, elimination, .. } = &mut *self.mechanism;
        if !self.chart.evaluate_many(system, &mut of) {
            return false;
        }
        let (beside, found) = (of.what == What::Beside, of.what == What::FoundStages);
        elimination.counters.evaluations += if found { 1 } else { of.states.len() as u64 };
        for (stage, state) in of.states.iter().enumerate().filter(|_| !beside) {
            if self.at_stages.len() <= stage {
                self.at_stages.push(self.guess.clone());
            }
            self.chart.note(state, &mut self.at_stages[stage]);
        }
        true
    }

    fn reach(&mut self, t: f64, x: &[f64]) -> bool {
        self.find(t, x)
    }

    fn power_at(&mut self, t: f64, x: &[f64]) -> Option<f64> {
        if !self.find(t, x) {
            return None;
        }
        let Mechanism { system, state, elimination, .. } = &mut *self.mechanism;
        if !follows_reactions(system) {
            return Some(load_power(system, state));
        }
        Some(power(&elimination.accelerate(system, state, (0.0, 0.0)).multipliers))
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

    fn slidings(&mut self, t: f64, x: &[f64], out: &mut Vec<i8>) {
        out.clear();
        if self.mechanism.system.loads.iter().any(|load| load.dry_friction().is_some()) && self.find(t, x) {
            let Mechanism { system, state, .. } = &*self.mechanism;
            out.extend(system.loads.iter().filter_map(|load| load.sliding(state)));
        }
    }

    fn solves_nothing(&self) -> bool {
        self.chart.numbers.are_all_free()
    }

    fn next_break(&self, t: f64) -> f64 {
        self.mechanism.system.next_break(t)
    }

    fn magnification(&self) -> f64 {
        let guess = self.at.and_then(|stage| self.at_stages.get(stage)).unwrap_or(self.guess);
        self.chart.magnification(guess)
    }

    fn power(&self) -> Option<f64> {
        let Mechanism { system, state, elimination, .. } = &*self.mechanism;
        (!system.is_conservative()).then(|| {
            if follows_reactions(system) {
                power(&elimination.last_accelerations(system, state).multipliers)
            } else {
                load_power(system, state)
            }
        })
    }

    fn knows_turns(&self) -> bool {
        self.mechanism.knows_turns()
    }

    /// Of all its mass, moving as fast as it does, and lifted.
    fn energy_of(&self, error: f64) -> f64 {
        let Mechanism { system, state, .. } = &*self.mechanism;
        let mass = system.model.mass();
        let speed = (2.0 * state.kinetic_energy(system) / mass).sqrt() + error;
        mass * (speed + system.model.gravity.norm() * system.length) * error
    }

    fn after_step(&mut self, _: f64, _: &mut [f64], _: &mut [f64]) {
        // The end of the step was evaluated last: its angles are in place.
        if let Some(end) = self.at.and_then(|stage| self.at_stages.get(stage)) {
            self.guess.copy_from(end);
        }
        // Drivers may have led far from where the chart was taken.
        self.at_stages.iter_mut().for_each(|stage| stage.settle(self.guess));
        self.guess.settle_here();
        self.mechanism.state.commit_motion();
        self.chart.commit(self.guess);
    }
}

/// Whether something that changes the energy follows from reactions.
fn follows_reactions(system: &System) -> bool {
    !(system.model.drivers.is_empty() && system.frictions.is_empty())
}

/// How a method is started.
pub trait Start: Clone + Debug + Send + Sync + 'static {
    /// The method.
    type Method: OdeMethod;

    /// Starts it at (t, x).
    fn start(&self, system: &mut dyn OdeSystem, t: f64, x: &[f64]) -> Self::Method;
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
    guess_old: Guess,
    /// x of the chart.
    x: Vec<f64>,
}

impl<M: OdeMethod> InChart<M> {
    /// Starts at the consistent state y, about which the chart was taken.
    pub fn new(
        (mut chart, mut guess): (Chart, Guess),
        mechanism: &mut Mechanism,
        t: f64,
        y: &[f64],
        start: &impl Start<Method = M>,
    ) -> Self {
        let mut x = vec![0.0; 2 * chart.freedoms()];
        chart.coordinates(&guess, &mut x);
        let (last, guess_old) = (StepRecord::new(t, y), guess.clone());
        let mut at_stages = Vec::new();
        let mut system = InCoordinates::new(mechanism, (&mut chart, &mut guess, &mut at_stages));
        let method = start.start(&mut system, t, &x);
        Self { method, chart, guess, at_stages, y_old: y.to_vec(), guess_old, last, x }
    }

    /// Takes the chart at the current state, and restarts the method if its coordinates are others then. `just_stepped` says that
    /// what was found at stages belongs to the last accepted step.
    fn renew(&mut self, mechanism: &mut Mechanism, just_stepped: bool) -> Result<(), StopReason> {
        let time = self.method.last().t;
        let before = self.chart.clone();
        if !self.chart.take(mechanism, time, &self.last.y, &mut self.guess) {
            return Err(StopReason::Undetermined { time });
        }
        if self.chart.choices != before.choices {
            self.chart.coordinates(&self.guess, &mut self.x);
            let known = std::iter::once(&self.guess_old).chain(&self.at_stages).filter(|_| just_stepped);
            let step: Vec<Vec<f64>> = known.map(|found| self.chart.translate(&before, found)).collect();
            let Self { method, chart, guess, at_stages, x, .. } = self;
            let mut system = InCoordinates::new(mechanism, (chart, guess, at_stages));
            method.restart(&mut system, x, &step);
        }
        Ok(())
    }

    /// Returns whether the end of the step was found.
    fn advance(&mut self, mechanism: &mut Mechanism, end: f64) -> Result<bool, StopReason> {
        let Self { method, chart, guess, at_stages, .. } = self;
        let mut system = InCoordinates::new(mechanism, (chart, guess, at_stages));
        method.step(&mut system, end)?;
        Ok(system.found)
    }

    fn take_step(&mut self, mechanism: &mut Mechanism, end: f64) -> Result<(), StopReason> {
        if self.chart.needs_refresh(&self.guess) {
            self.renew(mechanism, self.method.last().h > 0.0)?;
        }
        self.y_old.copy_from_slice(&self.last.y);
        self.guess_old.copy_from(&self.guess);
        let mut result = self.advance(mechanism, end);
        if result.is_err() {
            // Another chart may reach where this one ends.
            self.guess.copy_from(&self.guess_old);
            self.renew(mechanism, false)?;
            self.guess_old.copy_from(&self.guess);
            result = self.advance(mechanism, end);
        }
        let &StepRecord { t: time, h: step, .. } = self.method.last();
        match result {
            Ok(true) => {
                write_state(mechanism, &mut self.last.y);
                Ok(())
            }
            // A result that is not finite means that no state was found: far from the position of the chart, or at it.
            Ok(false) | Err(StopReason::NotFinite { .. }) if step > 0.0 => {
                Err(StopReason::NoConvergence { time, step })
            }
            Ok(false) | Err(StopReason::NotFinite { .. }) => Err(StopReason::Undetermined { time }),
            Err(reason) => Err(reason),
        }
    }

    /// Takes the last step of another run, in the coordinates of that one's chart. False, and nothing has changed but perhaps
    /// those, where that is not possible.
    pub fn follow_step(&mut self, mechanism: &mut Mechanism, other: &Self) -> bool {
        if !self.chart.is_same(&other.chart) && !self.adopt(mechanism, &other.chart) {
            return false;
        }
        let Self { method, chart, guess, at_stages, guess_old, .. } = self;
        guess_old.copy_from(guess);
        let mut system = InCoordinates::new(mechanism, (chart, guess, at_stages));
        if !method.follow(&mut system, &other.method) {
            return false;
        }
        self.y_old.copy_from_slice(&self.last.y);
        write_state(mechanism, &mut self.last.y);
        self.take_over_record();
        true
    }

    /// Takes another chart of the same kind for its own.
    fn adopt(&mut self, mechanism: &mut Mechanism, other: &Chart) -> bool {
        let Some(chart) = other.adopted(&self.chart, &mut self.guess, &mut self.x) else { return false };
        self.chart = chart;
        let Self { method, chart, guess, at_stages, x, .. } = self;
        at_stages.clear();
        let mut system = InCoordinates::new(mechanism, (chart, guess, at_stages));
        method.restart(&mut system, x, &[]);
        true
    }

    fn take_over_record(&mut self) {
        let StepRecord { t, t_old, h, steps, .. } = *self.method.last();
        self.last = StepRecord { t, t_old, h, steps, y: std::mem::take(&mut self.last.y) };
    }
}

impl<M: OdeMethod> Stepper for InChart<M> {
    fn last(&self) -> &StepRecord {
        &self.last
    }

    fn step(&mut self, mechanism: &mut Mechanism, end: f64) -> Result<(), StopReason> {
        let result = self.take_step(mechanism, end);
        self.take_over_record();
        result
    }

    fn interpolate(&mut self, mechanism: &mut Mechanism, t: f64, y: &mut [f64]) {
        if self.last.has_ended(t) {
            y.copy_from_slice(&self.last.y);
            return;
        }
        if !self.find_between(mechanism, t, y) && !self.interpolate_beside(mechanism, t, y) {
            self.interpolate_smoothly(mechanism, t, y);
        }
    }

    /// By one polynomial through what was found at all stages, or at the ends, instead of a solution for each time: near a
    /// singular position that may be on another branch than the next, or there is none.
    fn interpolate_smoothly(&mut self, mechanism: &mut Mechanism, t: f64, y: &mut [f64]) {
        let Self { method, chart, at_stages, guess_old, .. } = self;
        chart.tell(mechanism, t, guess_old);
        let stages = method.stage_weights(t).filter(|weights| weights.len() == at_stages.len());
        let placed = stages.is_some_and(|weights| {
            chart.place_between(mechanism, guess_old, weights.iter().copied().zip(&*at_stages))
        });
        if placed {
            write_state(mechanism, y);
        } else {
            self.interpolate_ends(t, y);
        }
    }

    fn work_to(&self, t: f64) -> Option<f64> {
        self.method.work_to(t)
    }

    fn can_retreat(&self) -> bool {
        self.last.h > 0.0
    }

    fn retreat(&mut self, mechanism: &mut Mechanism) {
        self.method.take_back();
        self.last.take_back();
        let Self { method, chart, guess, guess_old, at_stages, last, y_old, x } = self;
        last.y.copy_from_slice(y_old);
        guess.copy_from(guess_old);
        chart.tell(mechanism, last.t, guess);
        mechanism.set_state(last.t, y_old);
        mechanism.state.commit_motion();
        // Where no chart can be taken, the next step says so.
        chart.take(mechanism, last.t, y_old, guess);
        chart.commit(guess);
        chart.coordinates(guess, x);
        let mut system = InCoordinates::new(mechanism, (chart, guess, at_stages));
        method.restart(&mut system, x, &[]);
    }

    fn next_size(&self) -> Option<f64> {
        self.method.next_size()
    }

    fn boxed(&self) -> Box<dyn Stepper> {
        Box::new(self.clone())
    }
}

/// Writes the state in place.
fn write_state(mechanism: &Mechanism, y: &mut [f64]) {
    let Mechanism { system, state, .. } = mechanism;
    let (q, q_dot) = y.split_at_mut(system.coordinates);
    for (body, at) in system.bodies.iter().zip(state.bodies()) {
        body.layout.store(&at.q, q);
        body.layout.store(&at.q_dot, q_dot);
    }
}
