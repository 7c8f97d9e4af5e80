//! What integrators offer: as methods for ordinary differential equations, and as integrators of a mechanism.

use super::step::{StepRecord, StopReason};
use super::track::Track;
use std::any::Any;
use std::fmt::Debug;
use triad_dynamics::constraints::mechanism::Mechanism;
use triad_dynamics::dynamics::elimination::{Counters, TwistJacobian};
use triad_dynamics::ode::OdeSystem;
use triad_dynamics::state::{self, State};
use triad_dynamics::system::System;

/// A method for ordinary differential equations ẏ = f(t, y).
pub trait OdeMethod: Clone + Debug + Send + Sync + 'static {
    /// The last step.
    fn last(&self) -> &StepRecord;

    /// Takes one accepted step, not beyond `end`.
    fn step(&mut self, system: &mut impl OdeSystem, end: f64) -> Result<(), StopReason>;

    /// Writes y(t) within the last step.
    fn interpolate(&mut self, system: &mut impl OdeSystem, t: f64, y: &mut [f64]);

    /// Weights of the stages of the last step, less its start, in the polynomial through them at time t, where that says as much as
    /// the method.
    fn stage_weights(&mut self, _: f64) -> Option<&[f64]> {
        None
    }

    /// Integral of [`OdeSystem::power`] from the start of the last step to time t within it, where the method knows it.
    fn work_to(&self, _: f64) -> Option<f64> {
        None
    }

    /// Takes the last step of another run in the same coordinates, with less left to err. False, and nothing has changed, where the
    /// method cannot.
    fn follow(&mut self, _: &mut impl OdeSystem, _: &Self) -> bool {
        false
    }

    /// Size of the next step, s, where the method does not see to breaks of given functions by itself.
    fn next_size(&self) -> Option<f64> {
        None
    }

    /// Takes the last step back. What else belongs to it is for [`OdeMethod::restart`] to renew.
    fn take_back(&mut self);

    /// Goes on from the same state y, written in other coordinates, with the step size that was reached. `step` has the start and
    /// the stages of the last step in these coordinates, or nothing.
    fn restart(&mut self, system: &mut impl OdeSystem, y: &[f64], step: &[Vec<f64>]);
}

/// The last step of an island of the mechanism, as far as it concerns singular configurations.
#[derive(Clone, Copy, Debug)]
pub struct IslandStep<'a> {
    /// The island that took it.
    pub island: usize,
    /// Its start, s.
    pub start: f64,
    /// Its end, s.
    pub end: f64,
    /// Pivot products of the joints at its end, if a factorization there has given them.
    pub pivot_products: Option<&'a [f64]>,
    /// Places of the island's joints and drivers among those of the mechanism, where it is not the whole.
    pub constraints: Option<&'a [usize]>,
    /// How fast the rows turn at its end, 1/s: see [`state::pace`].
    pub pace: f64,
    /// Part of the step within which no singular configuration should lie behind its end: the next step, as long, would see rounding
    /// grow on the way over it by more than the tolerance. Zero where that does not shorten steps.
    pub clearance: f64,
}

/// What a run leaves out because nothing depends on it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SkippedWork {
    /// Bodies that are solved in a plane.
    pub planar_bodies: usize,
    /// Rows of the solver.
    pub rows: usize,
    /// Rows of the solver if all bodies were solved in space.
    pub rows_in_space: usize,
    /// Islands that are solved apart.
    pub islands: usize,
    /// Steps of bodies taken: each step counts once for each body of its island.
    pub body_steps: u64,
    /// The same if all islands took the steps of the busiest.
    pub body_steps_together: u64,
    /// Bodies that are left out because they cannot move.
    pub fixed_bodies: usize,
    /// Bodies that are left out because they move with others that they are rigidly joined to.
    pub merged_bodies: usize,
    /// Bodies that turn about points of the ground, without rows for these.
    pub pivoted_bodies: usize,
    /// Entries of the matrix that were not written again.
    pub constants: u64,
    /// Axes of joints that are kept by rows of common vectors.
    pub axes: usize,
    /// Steps after which the constraints needed no measuring.
    pub checks: u64,
}

/// An integrator of a mechanism.
pub trait Stepper: Debug + Send + Sync {
    /// The last step. Its state is y = (q, q̇).
    fn last(&self) -> &StepRecord;

    /// Takes one accepted step, not beyond `end`.
    fn step(&mut self, mechanism: &mut Mechanism, end: f64) -> Result<(), StopReason>;

    /// Size of the next step, s, as far as it is known, where the method does not see to breaks of given functions by itself.
    fn next_size(&self) -> Option<f64> {
        None
    }

    /// What there is to say of the size of its steps, in a sentence.
    fn told_of_steps(&self) -> Option<String> {
        None
    }

    /// Whether a given function that begins to change shows by itself.
    fn sees_ahead(&self) -> bool {
        false
    }

    /// Writes y(t) within the last step.
    fn interpolate(&mut self, mechanism: &mut Mechanism, t: f64, y: &mut [f64]);

    /// The same by one smooth curve over the whole step, whatever the constraints say.
    fn interpolate_smoothly(&mut self, mechanism: &mut Mechanism, t: f64, y: &mut [f64]) {
        self.interpolate(mechanism, t, y);
    }

    /// The last step as it concerns singular configurations; `None` where it cannot hide any.
    fn island_step<'a>(&'a self, mechanism: &'a Mechanism) -> Option<IslandStep<'a>> {
        let StepRecord { t, y, h, .. } = self.last();
        let pace = state::fastest(&mechanism.system, y);
        let (pivot_products, constraints) = (None, None);
        Some(IslandStep {
            island: 0,
            start: t - h,
            end: *t,
            pivot_products,
            constraints,
            pace,
            clearance: 0.0,
        })
    }

    /// The path of that step, if the method has a way of its own to evaluate states on it.
    fn track(&mut self) -> Option<&mut dyn Track> {
        None
    }

    /// What another run needs to know of this one to take its last step beside it.
    fn leader(&self) -> Option<&dyn Any> {
        None
    }

    /// Takes the last step of another run of the same method beside it, with less left to err. False, and nothing has changed, where
    /// that is not possible.
    fn follow(&mut self, _: &mut Mechanism, _: &dyn Any) -> bool {
        false
    }

    /// Whether the last step can be taken back.
    fn can_retreat(&self) -> bool {
        false
    }

    /// Writes the error of y(t) within the last step, if the method carries it along and knows it.
    fn error(&self, _: &System, _: f64, _: &mut [f64]) -> bool {
        false
    }

    /// When the error that the method carries along became too large to be known, s.
    fn error_lost(&self) -> Option<f64> {
        None
    }

    /// Takes the last step back, so that a shorter one can be taken instead; it then counts as rejected.
    fn retreat(&mut self, _: &mut Mechanism) {}

    /// Whether rows that hardly hold are kept, for methods that do not leave that to the mechanism's solver.
    fn set_resolving(&mut self, _: bool) {}

    /// Whether a joint hardly holds at the end of the last step, for methods that go on otherwise there.
    fn set_loose(&mut self, _: bool) {}

    /// Work of drivers and of loads without potential from the start of the last step to time t within it, J, where the
    /// method knows it.
    fn work_to(&self, _: f64) -> Option<f64> {
        None
    }

    /// Multipliers of the solver rows at a state within the last step, with A there, where the method has them.
    fn multipliers(&self, _: &State, _: &TwistJacobian) -> Option<Vec<f64>> {
        None
    }

    /// Whether the projection of the last step has shown that the constraints are satisfied at its end.
    fn proves_constraints(&mut self) -> bool {
        false
    }

    /// What has been left out so far, where the method knows.
    fn skipped(&self) -> Option<SkippedWork> {
        None
    }

    /// Work and projections that the mechanism does not count.
    fn own_work(&self) -> (Counters, u64) {
        (Counters::default(), 0)
    }

    /// A copy.
    fn boxed(&self) -> Box<dyn Stepper>;
}
