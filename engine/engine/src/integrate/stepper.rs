//! What every integrator of a mechanism can do.

use super::taylor::Saved;
use super::{Explicit, Steps, Stop, Taylor};
use crate::run::singularity::Stepped;
use std::fmt::Debug;
use triad_dynamics::constraints::mechanism::Mechanism;
use triad_dynamics::dynamics::elimination::{Counters, TwistJacobian};
use triad_dynamics::state::{self, State};
use triad_dynamics::system::System;

/// An integrator of a mechanism and its last step.
pub trait Stepper: Debug + Send + Sync {
    /// End of the last step, s.
    fn time(&self) -> f64;

    /// State y = (q, q̇) at the end of the last step.
    fn state(&self) -> &[f64];

    /// Size of the last accepted step, s.
    fn last_step(&self) -> f64;

    /// Steps so far.
    fn steps(&self) -> Steps;

    /// Takes one accepted step, not beyond `end`.
    fn step(&mut self, mechanism: &mut Mechanism, end: f64) -> Result<(), Stop>;

    /// Writes y(t) within the last step.
    fn interpolate(&mut self, mechanism: &mut Mechanism, t: f64, y: &mut [f64]);

    /// The last step as it concerns singular positions; nothing where it cannot hide any.
    fn stepped<'a>(&'a self, mechanism: &'a Mechanism) -> Option<Stepped<'a>> {
        Some(Stepped {
            part: 0,
            start: self.time() - self.last_step(),
            end: self.time(),
            holds: None,
            pace: state::fastest(&mechanism.system, self.state()),
        })
    }

    /// How firmly each joint holds at time t within that step, if the method has a way of its own to find it.
    fn holds_inside(&mut self, _: f64) -> Option<&[f64]> {
        None
    }

    /// Writes y(t) within the step that [`Stepper::stepped`] tells of.
    fn write_part(&mut self, mechanism: &mut Mechanism, t: f64, y: &mut [f64]) {
        self.interpolate(mechanism, t, y);
    }

    /// Work of drivers and of loads without potential from the start of the last step to time t within it, J, where the
    /// method knows it.
    fn work_to(&self, _: f64) -> Option<f64> {
        None
    }

    /// Multipliers of the solver rows at a state within the last step, with A there, where the method has them.
    fn multipliers(&self, _: &System, _: &State, _: &TwistJacobian) -> Option<Vec<f64>> {
        None
    }

    /// Whether the last step has shown by itself that the constraints hold at its end.
    fn proves_constraints(&mut self) -> bool {
        false
    }

    /// What has been left out so far, where the method knows.
    fn saved(&self) -> Option<Saved> {
        None
    }

    /// Work and projections that the mechanism does not count.
    fn own_work(&self) -> (Counters, u64) {
        (Counters::default(), 0)
    }

    /// A copy.
    fn boxed(&self) -> Box<dyn Stepper>;
}

impl Stepper for Explicit {
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
    fn step(&mut self, mechanism: &mut Mechanism, end: f64) -> Result<(), Stop> {
        self.step(mechanism, end)
    }
    fn interpolate(&mut self, mechanism: &mut Mechanism, t: f64, y: &mut [f64]) {
        self.interpolate(mechanism, t, y);
    }
    fn stepped<'a>(&'a self, mechanism: &'a Mechanism) -> Option<Stepped<'a>> {
        Some(Stepped {
            part: 0,
            start: self.time() - self.last_step(),
            end: self.time(),
            // Its last evaluation was at the end of the step.
            holds: Some(mechanism.elimination.holds()),
            pace: state::fastest(&mechanism.system, self.state()),
        })
    }
    fn boxed(&self) -> Box<dyn Stepper> {
        Box::new(self.clone())
    }
}

impl Stepper for Taylor {
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
    fn step(&mut self, mechanism: &mut Mechanism, end: f64) -> Result<(), Stop> {
        Taylor::step(self, &mechanism.system, end)?;
        if !mechanism.system.angles.is_empty() {
            mechanism.set_state(Taylor::time(self), Taylor::state(self));
            mechanism.state.commit_revolutions();
        }
        Ok(())
    }
    fn proves_constraints(&mut self) -> bool {
        Taylor::proves_constraints(self)
    }
    fn saved(&self) -> Option<Saved> {
        Some(Taylor::saved(self))
    }
    fn multipliers(&self, system: &System, state: &State, jacobian: &TwistJacobian) -> Option<Vec<f64>> {
        Taylor::multipliers(self, system, state, jacobian)
    }
    fn work_to(&self, t: f64) -> Option<f64> {
        Some(Taylor::work_to(self, t))
    }
    fn interpolate(&mut self, mechanism: &mut Mechanism, t: f64, y: &mut [f64]) {
        Taylor::interpolate(self, &mechanism.system, t, y);
    }
    fn stepped<'a>(&'a self, mechanism: &'a Mechanism) -> Option<Stepped<'a>> {
        Taylor::stepped(self, &mechanism.system)
    }
    fn holds_inside(&mut self, t: f64) -> Option<&[f64]> {
        Some(Taylor::holds_inside(self, t))
    }
    fn write_part(&mut self, mechanism: &mut Mechanism, t: f64, y: &mut [f64]) {
        Taylor::write_part(self, &mechanism.system, t, y);
    }
    fn own_work(&self) -> (Counters, u64) {
        (self.counters(), self.projections)
    }
    fn boxed(&self) -> Box<dyn Stepper> {
        Box::new(self.clone())
    }
}

/// An integrator that could not start: its first step tells why.
#[derive(Clone, Debug)]
pub(super) struct Halted {
    pub t: f64,
    pub y: Vec<f64>,
    pub stop: Stop,
}

impl Stepper for Halted {
    fn time(&self) -> f64 {
        self.t
    }
    fn state(&self) -> &[f64] {
        &self.y
    }
    fn last_step(&self) -> f64 {
        0.0
    }
    fn steps(&self) -> Steps {
        Steps::default()
    }
    fn step(&mut self, _: &mut Mechanism, _: f64) -> Result<(), Stop> {
        Err(self.stop)
    }
    fn interpolate(&mut self, _: &mut Mechanism, _: f64, y: &mut [f64]) {
        y.copy_from_slice(&self.y);
    }
    fn boxed(&self) -> Box<dyn Stepper> {
        Box::new(self.clone())
    }
}
