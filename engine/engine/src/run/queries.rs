//! What can be computed from the current state: short for the same method of [`Simulation::state`].

use super::{Frame, MarkerFrame, Simulation, StateView};
use crate::error::EngineError;
use crate::reactions::report::{Convention, ReactionReport};
use crate::reactions::{self, JointMultipliers};
use std::borrow::Cow;
use triad_dynamics::constraints::violation;
use triad_dynamics::dynamics::elimination::{Multipliers, TwistJacobian};
use triad_dynamics::equations::jacobian::Jacobian;

impl Simulation {
    /// The current state, with all that can be computed from it.
    pub fn state(&self) -> StateView<'_> {
        StateView::new(self, Cow::Borrowed(&self.current))
    }

    /// All bodies: [`StateView::frame`].
    pub fn frame(&self) -> Frame {
        self.state().frame()
    }

    /// Positions and velocities of the markers: [`StateView::markers`].
    pub fn markers(&self) -> Vec<MarkerFrame> {
        self.state().markers()
    }

    /// Accelerations of the markers, m/s²: [`StateView::marker_accelerations`].
    pub fn marker_accelerations(&self) -> Vec<[f64; 3]> {
        self.state().marker_accelerations()
    }

    /// The constraint Jacobian Φ_q: [`StateView::jacobian`].
    pub fn jacobian(&self) -> Jacobian {
        self.state().jacobian()
    }

    /// Accelerations q̈: [`StateView::accelerations`].
    pub fn accelerations(&self) -> Vec<f64> {
        self.state().accelerations()
    }

    /// Accelerations of the centres of mass, m/s²: [`StateView::mass_accelerations`].
    pub fn mass_accelerations(&self) -> Vec<[f64; 3]> {
        self.state().mass_accelerations()
    }

    /// Multipliers λ and reactions of each joint and driver: [`StateView::multipliers`].
    pub fn multipliers(&self) -> Vec<JointMultipliers> {
        self.state().multipliers()
    }

    /// The same, read off the series of the last step where the integrator has them: without an evaluation, and as exact
    /// as the tolerance makes the accelerations. For pictures of many moments.
    pub fn multipliers_between_steps(&self) -> Vec<JointMultipliers> {
        let system = self.system();
        let state = self.current.state(system);
        let mut jacobian = TwistJacobian::new(system);
        jacobian.fill(system, state);
        match self.integrator.multipliers(state, &jacobian) {
            Some(lambda) => reactions::multipliers(&Multipliers::new(system, state, &jacobian, &lambda)),
            None => self.multipliers(),
        }
    }

    /// Reactions of joints and drivers with what is unique about them: [`StateView::reactions`].
    ///
    /// # Errors
    ///
    /// [`EngineError::Uniqueness`] where it cannot be decided which of them are unique.
    pub fn reactions(&self, convention: Convention) -> Result<ReactionReport, EngineError> {
        self.state().reactions(convention)
    }

    /// Whether rows depend on each other, so that not all reactions are unique: [`Simulation::reactions`] tells which are.
    pub fn is_redundant(&self) -> bool {
        self.mechanism.elimination.is_redundant()
    }

    /// How far the current state is from its constraints Φ = 0, each row relative to its size.
    pub fn violation(&self) -> violation::ConstraintViolation {
        violation::measure(self.system(), self.current.state(self.system()))
    }
}
