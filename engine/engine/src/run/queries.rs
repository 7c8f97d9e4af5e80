//! What can be asked of the shown state beyond its frame: Jacobian, accelerations, multipliers and reactions.

use super::Simulation;
use crate::error::EngineError;
use crate::reactions::matrices::{self, Symmetric};
use crate::reactions::report::{Convention, ReactionReport, report};
use crate::reactions::{self, JointMultipliers};
use triad_dynamics::dynamics::elimination::{Accelerations, Multipliers, TwistJacobian};
use triad_dynamics::equations::jacobian::Jacobian;

impl Simulation {
    /// The Jacobian Φ_q at the shown state, rigid-body rows first.
    pub fn jacobian(&self) -> Jacobian {
        Jacobian::new(self.system(), &self.current)
    }

    /// Answers a question about accelerations and multipliers at the shown state. The run's own solver stays as it is,
    /// and its counters.
    fn evaluated<T>(&self, ask: impl FnOnce(&Accelerations) -> T) -> T {
        let mut solver = self.mechanism.elimination.clone();
        let baumgarte = self.mechanism.baumgarte();
        ask(&solver.accelerate(self.system(), &self.current, baumgarte))
    }

    /// Accelerations q̈ at the shown state.
    pub fn accelerations(&self) -> Vec<f64> {
        let mut q_ddot = vec![0.0; self.system().coordinates];
        self.evaluated(|found| found.write(&mut q_ddot));
        q_ddot
    }

    /// Accelerations of the centres of mass at the shown state, in the world, m/s².
    pub fn mass_accelerations(&self) -> Vec<[f64; 3]> {
        let q_ddot = self.accelerations();
        self.system().bodies.iter().map(|body| body.layout.position(&q_ddot).r.into()).collect()
    }

    /// Multipliers λ and reactions of each joint at the shown state.
    pub fn multipliers(&self) -> Vec<JointMultipliers> {
        self.evaluated(|found| reactions::multipliers(&found.multipliers))
    }

    /// The same, read off the series of the last step where the integrator has them: without an evaluation, and as exact
    /// as the tolerance makes the accelerations. For pictures of many moments.
    pub fn multipliers_between_steps(&self) -> Vec<JointMultipliers> {
        let system = self.system();
        let mut jacobian = TwistJacobian::new(system);
        jacobian.fill(system, &self.current);
        match self.integrator.multipliers(system, &self.current, &jacobian) {
            Some(lambda) => {
                reactions::multipliers(&Multipliers::new(system, &self.current, &jacobian, &lambda))
            }
            None => self.multipliers(),
        }
    }

    /// Reactions of joints and drivers at the shown state, with what is unique about them.
    pub fn reactions(&self, convention: Convention) -> Result<ReactionReport, EngineError> {
        Ok(self.evaluated(|found| report(&found.multipliers, convention))?)
    }

    /// The augmented matrix of the equations of motion at the shown state.
    pub fn augmented(&self) -> Symmetric {
        matrices::augmented(self.system(), &self.current)
    }

    /// S, which the solver factors, at the shown state.
    pub fn schur(&self) -> Symmetric {
        matrices::schur(self.system(), &self.current, &mut self.mechanism.elimination.clone())
    }
}
